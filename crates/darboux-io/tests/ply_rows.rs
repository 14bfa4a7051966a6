//! Binary rows of a PLY are copied where they have the usual layout, and read number by number elsewhere:
//! both ways give one model.
#![cfg(feature = "ply")]

use darboux_io::LoadOptions;
use darboux_io::gltf::Document;

/// A strip of triangles and quads with normals and UVs.
struct Strip {
    /// The corners of each face.
    faces: Vec<Vec<i64>>,
}

const COLUMNS: usize = 9;

impl Strip {
    /// Alternating rows of quads that are cut (`true`) or whole.
    fn new(is_cut: impl Fn(usize) -> bool) -> Self {
        let mut faces = Vec::new();
        for column in 0..COLUMNS as i64 - 1 {
            let [a, b, c, d] = [2 * column, 2 * column + 2, 2 * column + 3, 2 * column + 1];
            if is_cut(column as usize) {
                faces.extend([vec![a, b, c], vec![a, c, d]]);
            } else {
                faces.push(vec![a, b, c, d]);
            }
        }
        Self { faces }
    }

    /// The properties in this order, each with its type; `lists` are the types of a face's list.
    fn ply(
        &self,
        properties: &[(&str, &str)],
        lists: (&str, &str),
        is_big: bool,
        extra: Option<&str>,
    ) -> Vec<u8> {
        let endian = if is_big { "big" } else { "little" };
        let mut head = format!("ply\nformat binary_{endian}_endian 1.0\nelement vertex {}\n", 2 * COLUMNS);
        for (name, kind) in properties {
            head += &format!("property {kind} {name}\n");
        }
        head += &format!(
            "element face {}\nproperty list {} {} vertex_indices\n",
            self.faces.len(),
            lists.0,
            lists.1
        );
        if let Some(kind) = extra {
            head += &format!("property {kind} quality\n");
        }
        head += "end_header\n";
        let mut bytes = head.into_bytes();
        let mut push = |number: f64, kind: &str| {
            macro_rules! push {
                ($type:ty) => {{
                    let number = number as $type;
                    bytes.extend(if is_big { number.to_be_bytes() } else { number.to_le_bytes() });
                }};
            }
            match kind {
                "uchar" => push!(u8),
                "ushort" => push!(u16),
                "int" => push!(i32),
                "uint" => push!(u32),
                "float" => push!(f32),
                _ => push!(f64),
            }
        };
        for vertex in 0..2 * COLUMNS {
            let (x, y) = ((vertex / 2) as f64, (vertex % 2) as f64);
            for (name, kind) in properties {
                let value = match *name {
                    "x" => x,
                    "y" => y,
                    "z" => 0.125 * x * y,
                    "nx" => 0.5,
                    "ny" => 0.25 * y,
                    "nz" => 0.75,
                    "s" => x / 8.0,
                    "t" => y / 2.0,
                    _ => 7.0,
                };
                push(value, kind);
            }
        }
        for face in &self.faces {
            push(face.len() as f64, lists.0);
            face.iter().for_each(|&corner| push(corner as f64, lists.1));
            if let Some(kind) = extra {
                push(3.0, kind);
            }
        }
        bytes
    }
}

fn open(bytes: Vec<u8>) -> Result<Document, String> {
    Document::from_bytes("a.ply", bytes, None, &LoadOptions::default()).map_err(|error| error.to_string())
}

/// Index list, positions, normals and UVs, as they are stored.
type Arrays = (Vec<u32>, Vec<[f32; 3]>, Vec<[f32; 3]>, Vec<[f32; 2]>);

fn arrays(bytes: Vec<u8>) -> Arrays {
    let document = open(bytes).unwrap();
    let primitive = &document.json()["meshes"][0]["primitives"][0];
    let accessor = |name: &str| primitive["attributes"][name].as_u64().unwrap() as usize;
    let indices = document.indices(primitive["indices"].as_u64().unwrap() as usize).unwrap();
    let vectors = |name: &str| document.vectors::<3>(accessor(name)).unwrap().into_owned();
    let uvs = document.vectors::<2>(accessor("TEXCOORD_0")).unwrap().into_owned();
    (indices.into_u32(), vectors("POSITION"), vectors("NORMAL"), uvs)
}

const USUAL: [(&str, &str); 8] = [
    ("x", "float"),
    ("y", "float"),
    ("z", "float"),
    ("nx", "float"),
    ("ny", "float"),
    ("nz", "float"),
    ("s", "float"),
    ("t", "float"),
];

#[test]
fn all_layouts_give_one_model() {
    let cuts: [fn(usize) -> bool; 5] =
        [|_| true, |_| false, |column| column < 4, |column| column != 3, |column| column > 4];
    for is_cut in cuts {
        let strip = Strip::new(is_cut);
        // Big-endian files are read number by number.
        let expected = arrays(strip.ply(&USUAL, ("uchar", "int"), true, None));
        assert_eq!(expected.0.len(), 6 * (COLUMNS - 1));
        let mut turned = USUAL;
        turned.reverse();
        let mut doubles = USUAL;
        doubles[1].1 = "double";
        doubles[6].1 = "double";
        let mut others = USUAL.to_vec();
        others.insert(2, ("confidence", "ushort"));
        // Where a property occurs twice, the first counts.
        others.push(("nz", "uchar"));
        for properties in [&USUAL[..], &turned, &doubles, &others] {
            for lists in [("uchar", "int"), ("uchar", "uint"), ("uint", "int"), ("uchar", "ushort")] {
                for extra in [None, Some("uchar")] {
                    let found = arrays(strip.ply(properties, lists, false, extra));
                    assert!(found == expected, "{properties:?}, {lists:?}, {extra:?}");
                }
            }
        }
    }
}

/// A negative index, and one that no vertex has, in the first, a middle and the last face.
#[test]
fn indices_of_nothing_are_refused() {
    for place in [0, 7, 15] {
        for (wrong, kind) in [(-1, "int"), (18, "int"), (18, "uint"), (4_294_967_295, "uint")] {
            let mut strip = Strip::new(|_| true);
            strip.faces[place][1] = wrong;
            let sentences = [false, true]
                .map(|is_big| open(strip.ply(&USUAL, ("uchar", kind), is_big, None)).unwrap_err());
            assert_eq!(sentences[0], sentences[1], "both byte orders");
            let expected = match (wrong, kind) {
                (-1, "int") => "has the index -1, but indices begin at 0; export the file again",
                _ => "but there are 18; export the file again",
            };
            assert!(sentences[0].contains(expected), "{}", sentences[0]);
        }
    }
}

#[test]
fn faces_that_are_cut_off_are_counted() {
    let whole = Strip::new(|column| column < 4).ply(&USUAL, ("uchar", "int"), false, None);
    for cut in [1, 17, 18, 40, 60, 90] {
        let error = open(whole[..whole.len() - cut].to_vec()).unwrap_err();
        assert!(
            error.starts_with("a.ply: face ") && error.contains("is missing, cut off or no number"),
            "{error}"
        );
    }
}
