//! `darboux.h` as a C compiler understands it, against the Rust it was generated from: every size, offset and number.

use std::fs;
use std::mem::{align_of, offset_of, size_of};
use std::process::Command;

use darboux_c::*;

use crate::support::{Link, build, folder, has, repository, run};

/// A name that C can print a number for, and the number in Rust.
type Fact = (String, usize);

macro_rules! facts_of_structs {
    ($($name:ident { $($field:ident),* $(,)? })*) => {
        fn facts_of_structs() -> Vec<Fact> {
            let mut facts = Vec::new();
            $(
                facts.push((format!("sizeof({})", stringify!($name)), size_of::<$name>()));
                facts.push((format!("alignof_({})", stringify!($name)), align_of::<$name>()));
                $(
                    let offset = offset_of!($name, $field);
                    facts.push((format!("offsetof({}, {})", stringify!($name), stringify!($field)), offset));
                )*
            )*
            facts
        }

        const STRUCTS: &[(&str, usize)] = &[$((stringify!($name), [$(stringify!($field)),*].len())),*];
    };
}

facts_of_structs! {
    darboux_mesh {
        size, vertex_count, positions, position_stride, normals, normal_stride, uvs, uv_stride, indices_u32, indices_u16,
        index_count, faces, face_sizes, face_count,
    }
    darboux_tangent_options { size, method, mode, threshold, scratch }
    darboux_report {
        size, triangles, unsupported_faces, degenerate_triangles, uv_degenerate_triangles, non_finite_corners,
        repaired_corners, mixed_sign_faces, mirrored_edges, split_vertices, merged_vertices,
    }
    darboux_frame { tangent, bitangent, magnitude, sign }
    darboux_vertex_split { vertex_count, tangent_of_vertex, source_of_vertex, index_count, indices }
    darboux_normal_split { vertex_count, normal_of_vertex, source_of_vertex, index_count, indices }
    darboux_normal_options { size, shading, weight, crease, seams }
    darboux_normal_report { size, faces, degenerate_faces, repaired_corners, creased_edges }
    darboux_tangent_difference {
        size, corners, identical, sign_flips, without_angle, mean, min, median, p95, max, histogram, worst_count, worst_corners,
        worst_angles,
    }
    darboux_uv_fidelity { size, mean, root_mean_square, area, left_out }
    darboux_convention { size, right, up, front, winding, uv_origin, tangent, bitangent, sign }
    darboux_frame_arrays {
        size, count, normals, normal_stride, tangents, tangent_stride, out_normals, out_normal_stride, out_tangents,
        out_tangent_stride,
    }
    darboux_skin {
        size, bones, bone_count, bone_stride, column_stride, influence_count, joints, joint_stride, weights, weight_stride,
    }
}

macro_rules! facts_of_enums {
    ($($rust:ident as $c:literal { $($variant:ident = $suffix:literal),* $(,)? })*) => {
        fn facts_of_enums() -> Vec<Fact> {
            vec![$($((format!("{}_{}", $c, $suffix), $rust::$variant as usize)),*),*]
        }
    };
}

facts_of_enums! {
    darboux_status as "DARBOUX_STATUS" {
        Ok = "OK", NullPointer = "NULL_POINTER", StructSize = "STRUCT_SIZE", UnknownValue = "UNKNOWN_VALUE",
        Stride = "STRIDE", Alignment = "ALIGNMENT", TooLarge = "TOO_LARGE", Length = "LENGTH", Index = "INDEX",
        Faces = "FACES", TooLate = "TOO_LATE", Internal = "INTERNAL", Axes = "AXES",
        Threads = "THREADS",
    }
    MethodCode as "DARBOUX_METHOD" {
        Mikktspace = "MIKKTSPACE", AngleArea = "ANGLE_AREA", Lengyel = "LENGYEL", LengyelPerVertex = "LENGYEL_PER_VERTEX",
        Average = "AVERAGE", Area = "AREA", Face = "FACE", FromNormal = "FROM_NORMAL",
    }
    ModeCode as "DARBOUX_MODE" { Repaired = "REPAIRED", Reference = "REFERENCE", Corrected = "CORRECTED" }
    FacesCode as "DARBOUX_FACES" { Triangles = "TRIANGLES", Quads = "QUADS", Mixed = "MIXED" }
    ShadingCode as "DARBOUX_SHADING" { Smooth = "SMOOTH", Flat = "FLAT" }
    NormalWeightCode as "DARBOUX_NORMAL_WEIGHT" { Angle = "ANGLE", Area = "AREA", AngleArea = "ANGLE_AREA" }
    SmoothingSeamsCode as "DARBOUX_SMOOTHING_SEAMS" { Ignored = "IGNORED", Respected = "RESPECTED" }
    TangentEncodingCode as "DARBOUX_TANGENT_ENCODING" {
        Snorm8 = "SNORM8", Snorm10 = "SNORM10", Snorm16 = "SNORM16", Octahedral = "OCTAHEDRAL", Diamond = "DIAMOND",
    }
    AxisCode as "DARBOUX_AXIS" {
        Default = "DEFAULT", X = "X", MinusX = "MINUS_X", Y = "Y", MinusY = "MINUS_Y", Z = "Z", MinusZ = "MINUS_Z",
    }
    WindingCode as "DARBOUX_WINDING" { CounterClockwise = "COUNTER_CLOCKWISE", Clockwise = "CLOCKWISE" }
    UvOriginCode as "DARBOUX_UV_ORIGIN" { TopLeft = "TOP_LEFT", BottomLeft = "BOTTOM_LEFT" }
    TangentDirectionCode as "DARBOUX_TANGENT_DIRECTION" { Right = "RIGHT", Left = "LEFT" }
    BitangentDirectionCode as "DARBOUX_BITANGENT_DIRECTION" { Up = "UP", Down = "DOWN" }
    SignRuleCode as "DARBOUX_SIGN_RULE" {
        NormalCrossTangent = "NORMAL_CROSS_TANGENT", TangentCrossNormal = "TANGENT_CROSS_NORMAL",
    }
    ProgramCode as "DARBOUX_PROGRAM" {
        Gltf = "GLTF", Opengl = "OPENGL", Directx = "DIRECTX", Blender = "BLENDER", Unity = "UNITY", Unreal = "UNREAL",
        Godot = "GODOT", Threejs = "THREEJS", Maya = "MAYA", Max = "MAX",
    }
}

fn header() -> String {
    fs::read_to_string(repository().join("bindings/c/include/darboux.h")).expect("the header")
}

#[test]
fn c_and_rust_agree() {
    if !has("gcc") || !has("g++") {
        return;
    }
    let sizes = [
        "method",
        "mode",
        "faces",
        "shading",
        "normal_weight",
        "smoothing_seams",
        "tangent_encoding",
        "axis",
        "winding",
        "uv_origin",
        "tangent_direction",
        "bitangent_direction",
        "sign_rule",
        "program",
        "status",
    ];
    let enums = sizes.map(|name| (format!("sizeof(darboux_{name})"), size_of::<u32>()));
    let facts: Vec<Fact> = facts_of_structs().into_iter().chain(facts_of_enums()).chain(enums).collect();
    let mut text = String::from(
        "#include <stdio.h>\n#include \"darboux.h\"\n\
         #ifdef __cplusplus\n#define alignof_ alignof\n#else\n#define alignof_ _Alignof\n#endif\n\
         int main(void) {\n",
    );
    for (name, _) in &facts {
        text += &format!("  printf(\"{name} %u\\n\", (unsigned)({name}));\n");
    }
    text += "  return 0;\n}\n";
    let expected: String = facts.iter().map(|(name, number)| format!("{name} {number}\n")).collect();
    for (standard, extension) in [("c11", "c"), ("c++11", "cpp")] {
        let file = folder().join(format!("facts.{extension}"));
        fs::write(&file, &text).expect("a file");
        let program = build(&format!("facts-{standard}"), standard, &[file], &[], Link::Static);
        let printed = String::from_utf8(run(&mut Command::new(program)).stdout).expect("text");
        assert_eq!(printed, expected, "{standard}");
    }
}

/// The lists above have everything that the header has.
#[test]
fn nothing_is_left_out() {
    let header = header();
    let numbers = header.lines().filter(|line| line.starts_with("  DARBOUX_") && line.contains(" = "));
    assert_eq!(numbers.count(), facts_of_enums().len());
    let structs: Vec<&str> =
        header.split("typedef struct ").skip(1).filter(|rest| rest.contains(" {\n")).collect();
    let with_body = structs.iter().filter(|rest| rest.lines().next().is_some_and(|line| line.ends_with('{')));
    let mut found: Vec<(&str, usize)> = with_body
        .map(|rest| {
            let body = rest.split("\n}").next().expect("an end");
            let fields =
                body.lines().skip(1).filter(|line| !line.contains("///") && line.ends_with(';')).count();
            (rest.split(' ').next().expect("a name"), fields)
        })
        .collect();
    let mut listed = STRUCTS.to_vec();
    found.sort_unstable();
    listed.sort_unstable();
    assert_eq!(found, listed);
}

/// A number beyond a list is an error, so no value of Rust's was forgotten in the conversions.
#[test]
fn every_number_has_a_meaning() {
    let positions = [[0.0f32; 3]; 3];
    let uvs = [[0.0f32; 2]; 3];
    let mesh = darboux_mesh {
        vertex_count: 3,
        positions: positions.as_ptr().cast(),
        normals: positions.as_ptr().cast(),
        uvs: uvs.as_ptr().cast(),
        ..crate::agreement::empty_mesh()
    };
    let count_of =
        |list: &str| facts_of_enums().iter().filter(|(name, _)| name.starts_with(list)).count() as u32;
    let run = |method, mode| {
        let mut options = crate::agreement::default_options();
        (options.method, options.mode) = (method, mode);
        let mut out = [[0.0f32; 4]; 3];
        // SAFETY: all pointers are to arrays of the lengths given.
        unsafe {
            darboux_generate_tangents(&mesh, &options, out.as_mut_ptr().cast(), 3, 0, std::ptr::null_mut())
        }
    };
    let methods = count_of("DARBOUX_METHOD_");
    (0..methods).for_each(|method| assert_eq!(run(method, 0), darboux_status::Ok));
    assert_eq!(run(methods, 0), darboux_status::UnknownValue);
    let modes = count_of("DARBOUX_MODE_");
    (0..modes).for_each(|mode| assert_eq!(run(0, mode), darboux_status::Ok));
    assert_eq!(run(0, modes), darboux_status::UnknownValue);
}
