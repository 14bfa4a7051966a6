//! ABI tests: every size, offset and constant of `darboux.h`, as a C compiler computes it, equals the value
//! in Rust and the committed value in `abi.txt`.

use std::collections::HashSet;
use std::fs;
use std::mem::{align_of, offset_of, size_of};
use std::process::Command;
use std::ptr::{null, null_mut};

use darboux_c::*;

use crate::agreement::{default_options, empty_mesh};
use crate::support::{Link, build, folder, has, repository, run, source};

/// A C expression with an integer value, and its value in Rust.
type CExpression = (String, usize);

macro_rules! facts_of_structs {
    ($($name:ident { $($field:ident),* $(,)? })*) => {
        fn facts_of_structs() -> Vec<CExpression> {
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
    darboux_tangent_options { size, method, mode, threshold, reserved }
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
    darboux_uv_fidelity { size, mean, root_mean_square, area, unmeasured_triangles }
    darboux_map_judgement {
        size, verdict, confidence, correlation, z_score, log_energy_ratio, mean_length, texels, background, not_unit,
        negative_z, grey, not_normal,
    }
    darboux_recipe_match {
        method, mode, flips_v, writing, bits, from_quads, corners, identical, close, sign_flips, worst,
    }
    darboux_convention { size, right, up, front, winding, uv_origin, tangent, bitangent, sign }
    darboux_frame_arrays {
        size, count, normals, normal_stride, tangents, tangent_stride, out_normals, out_normal_stride, out_tangents,
        out_tangent_stride,
    }
    darboux_skin {
        size, bones, bone_count, bone_stride, column_stride, influence_count, joints, joint_stride, weights, weight_stride,
    }
}

/// The constants of the header's enumerations, which is generated from those in Rust.
fn facts_of_enums() -> Vec<CExpression> {
    let constants = header();
    let constants = constants.lines().filter_map(|line| line.trim().strip_suffix(','));
    let constants = constants.filter(|line| line.starts_with("DARBOUX_"));
    let with_number = constants.filter_map(|line| line.split_once(" = "));
    with_number.map(|(name, number)| (name.to_owned(), number.parse().expect("a number"))).collect()
}

fn header() -> String {
    fs::read_to_string(repository().join("bindings/c/include/darboux.h")).expect("the header")
}

/// The values in Rust equal the committed ones, and the values of a C compiler equal those in Rust.
#[test]
fn c_and_rust_agree() {
    let sizes = [
        "method",
        "mode",
        "map_verdict",
        "recipe_writing",
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
    let facts: Vec<CExpression> =
        facts_of_structs().into_iter().chain(facts_of_enums()).chain(enums).collect();
    let mut text = String::from(
        "#include <stdio.h>\n#include \"darboux.h\"\n\
         #ifdef __cplusplus\n#define alignof_ alignof\n#else\n#define alignof_ _Alignof\n#endif\n\
         int main(void) {\n",
    );
    for (name, _) in &facts {
        text += &format!("  printf(\"{name} %u\\n\", (unsigned)({name}));\n");
    }
    text += "  return 0;\n}\n";
    let found: String = facts.iter().map(|(name, number)| format!("{name} {number}\n")).collect();
    let committed = fs::read_to_string(source("abi.txt")).expect("the table");
    if cfg!(target_pointer_width = "64") && found != committed {
        let file = folder().join("abi.txt");
        fs::write(&file, &found).expect("a file");
        let file = file.display();
        panic!(
            "programs that were compiled before would break; if that is meant: cp {file} bindings/c/tests/c/abi.txt"
        );
    }
    if !has("gcc") || !has("g++") {
        return;
    }
    for (standard, extension) in [("c11", "c"), ("c++11", "cpp")] {
        let file = folder().join(format!("facts.{extension}"));
        fs::write(&file, &text).expect("a file");
        let program = build(&format!("facts-{standard}"), standard, &[file], &[], Link::Static);
        let printed = String::from_utf8(run(&mut Command::new(program)).stdout).expect("text");
        assert_eq!(printed, found, "{standard}");
    }
}

/// The list above contains every struct and field of the header.
#[test]
fn nothing_is_left_out() {
    let header = header();
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

/// A call whose only variable argument is the value of an enumeration. Returns its status.
type EnumCall = fn(u32) -> darboux_status;

/// Every enumeration, with all functions and fields that take it.
const ENUM_CALLS: &[(&str, EnumCall)] = &[
    ("DARBOUX_METHOD", |method| tangents(0, darboux_tangent_options { method, ..default_options() })),
    ("DARBOUX_MODE", |mode| tangents(0, darboux_tangent_options { mode, ..default_options() })),
    ("DARBOUX_FACES", |faces| tangents(faces, default_options())),
    ("DARBOUX_SHADING", |shading| normals(darboux_normal_options { shading, ..NORMALS })),
    ("DARBOUX_NORMAL_WEIGHT", |weight| normals(darboux_normal_options { weight, ..NORMALS })),
    ("DARBOUX_SMOOTHING_SEAMS", |seams| normals(darboux_normal_options { seams, ..NORMALS })),
    ("DARBOUX_TANGENT_ENCODING", |encoding| {
        let (vector, mut code) = ([0.0f32, 0.0, 1.0, 1.0], [0u64]);
        let (from, to) = (vector.as_ptr(), code.as_mut_ptr().cast());
        // SAFETY: a tangent has at most 8 bytes in every encoding.
        unsafe { darboux_encode_tangents(encoding, 1, from, 0, from, 0, to, 0) }
    }),
    ("DARBOUX_TANGENT_ENCODING", |encoding| {
        let (vector, code, mut out) = ([0.0f32, 0.0, 1.0], [0u64], [0.0f32; 4]);
        // SAFETY: as above.
        unsafe {
            let (normal, code) = (vector.as_ptr(), code.as_ptr().cast());
            darboux_decode_tangents(encoding, 1, normal, 0, code, 0, out.as_mut_ptr(), 0)
        }
    }),
    ("DARBOUX_AXIS", |right| convention(|it| (it.right, it.up, it.front) = along(right))),
    ("DARBOUX_AXIS", |up| convention(|it| (it.up, it.front, it.right) = along(up))),
    ("DARBOUX_AXIS", |front| convention(|it| (it.front, it.right, it.up) = along(front))),
    ("DARBOUX_WINDING", |winding| convention(|it| it.winding = winding)),
    ("DARBOUX_UV_ORIGIN", |uv_origin| convention(|it| it.uv_origin = uv_origin)),
    ("DARBOUX_TANGENT_DIRECTION", |tangent| convention(|it| it.tangent = tangent)),
    ("DARBOUX_BITANGENT_DIRECTION", |bitangent| convention(|it| it.bitangent = bitangent)),
    ("DARBOUX_SIGN_RULE", |sign| convention(|it| it.sign = sign)),
    ("DARBOUX_PROGRAM", |program| {
        // SAFETY: the convention is writable.
        unsafe { darboux_convention_of(program, &mut no_convention()) }
    }),
];

const NORMALS: darboux_normal_options =
    darboux_normal_options { size: 0, shading: 0, weight: 0, crease: 0.0, seams: 0 };

/// One face of three or four corners.
fn one_face(faces: u32, run: impl Fn(&darboux_mesh, usize) -> darboux_status) -> darboux_status {
    let (positions, uvs) = ([[0.0f32; 3]; 4], [[0.0f32; 2]; 4]);
    let corners = if faces == FacesCode::Quads as u32 { 4 } else { 3 };
    let sizes = [corners as u32];
    let is_mixed = faces == FacesCode::Mixed as u32;
    let mesh = darboux_mesh {
        vertex_count: corners,
        positions: positions.as_ptr().cast(),
        normals: positions.as_ptr().cast(),
        uvs: uvs.as_ptr().cast(),
        faces,
        face_sizes: if is_mixed { sizes.as_ptr() } else { null() },
        face_count: is_mixed.into(),
        ..empty_mesh()
    };
    run(&mesh, corners)
}

fn tangents(faces: u32, options: darboux_tangent_options) -> darboux_status {
    one_face(faces, |mesh, corners| {
        let mut out = [[0.0f32; 4]; 4];
        // SAFETY: all pointers refer to arrays of the given lengths.
        unsafe {
            darboux_generate_tangents(mesh, &options, null(), out.as_mut_ptr().cast(), corners, 0, null_mut())
        }
    })
}

fn normals(options: darboux_normal_options) -> darboux_status {
    one_face(0, |mesh, corners| {
        let mut out = [[0.0f32; 3]; 4];
        // SAFETY: as above.
        unsafe {
            darboux_generate_normals(mesh, &options, null(), out.as_mut_ptr().cast(), corners, 0, null_mut())
        }
    })
}

fn no_convention() -> darboux_convention {
    darboux_convention {
        size: 0,
        right: 0,
        up: 0,
        front: 0,
        winding: 0,
        uv_origin: 0,
        tangent: 0,
        bitangent: 0,
        sign: 0,
    }
}

fn convention(change: impl Fn(&mut darboux_convention)) -> darboux_status {
    let (mut asked, mut out) = (no_convention(), no_convention());
    change(&mut asked);
    // SAFETY: both structs are valid, and the second is writable.
    unsafe { darboux_convention_generated(&asked, &mut out) }
}

/// An axis (or an invalid value) and two axes perpendicular to it and to each other; the default axes for 0.
fn along(axis: u32) -> (u32, u32, u32) {
    use AxisCode::{Default, X, Y, Z};
    match (axis.max(1) - 1) / 2 {
        _ if axis == Default as u32 => (0, 0, 0),
        0 => (axis, Y as u32, Z as u32),
        1 => (axis, Z as u32, X as u32),
        _ => (axis, X as u32, Y as u32),
    }
}

/// Every value of every enumeration is accepted, and the next value is rejected.
#[test]
fn every_number_has_a_meaning() {
    let lists: HashSet<String> = facts_of_enums().into_iter().map(|(name, _)| list_of(&name)).collect();
    let asked: HashSet<String> = ENUM_CALLS.iter().map(|(list, _)| (*list).to_owned()).collect();
    let returned = RETURNED.map(str::to_owned);
    assert_eq!(lists, asked.into_iter().chain(returned).collect());
    for (list, ask) in ENUM_CALLS {
        let numbers = facts_of_enums().into_iter().filter(|(name, _)| list_of(name) == *list);
        let numbers: Vec<u32> = numbers.map(|(_, number)| number as u32).collect();
        for &number in &numbers {
            assert_eq!(ask(number), darboux_status::Ok, "{list} {number}");
        }
        let beyond = numbers.iter().max().expect("a number") + 1;
        for number in [beyond, beyond + 1, u32::MAX] {
            assert_eq!(ask(number), darboux_status::UnknownValue, "{list} {number}");
        }
    }
}

/// Enumerations that functions return only.
const RETURNED: [&str; 3] = ["DARBOUX_STATUS", "DARBOUX_MAP_VERDICT", "DARBOUX_RECIPE_WRITING"];

/// The enumeration of a constant.
fn list_of(name: &str) -> String {
    let lists = ENUM_CALLS.iter().map(|(list, _)| *list).chain(RETURNED);
    let longest = lists.filter(|list| name.starts_with(&format!("{list}_"))).max_by_key(|list| list.len());
    longest.unwrap_or(name).to_owned()
}
