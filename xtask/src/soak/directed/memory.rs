//! Small files that ask for much memory.

use serde_json::{Value, json};

use crate::soak::case::{Case, Make};
use crate::soak::inputs::images::{BUMPS_JPEG, BUMPS_WEBP, flat_png};
use crate::soak::inputs::model::{Builder, Mesh, glb};
use crate::soak::random::Random;

pub const CASES: &[(&str, Make)] = &[
    ("a flat image", |random| Ok(flat_image(random))),
    ("strips over the same bytes", |random| Ok(strips(random))),
    ("views over one meshopt stream", |random| Ok(meshopt_views(random))),
    ("many empty primitives", |random| Ok(empty_primitives(random))),
    ("accessors without bytes", |random| Ok(zeros(random))),
    ("many morph targets over the same bytes", |random| Ok(morph_targets(random))),
    ("deep JSON", |random| Ok(deep_json(random))),
    ("white space that would be repeated", |random| Ok(white_space(random))),
    ("few triangles each of many shared vertices", |random| Ok(shared_vertices(random))),
    ("data of a mesh or a skin in many nodes", |random| Ok(shared_by_nodes(random))),
    ("a large normal map in a small file", |random| Ok(large_map(random))),
    ("a deep tree of nodes", |random| Ok(deep_nodes(random))),
];

pub const OF_PICTURES: &[(&str, Make)] = &[
    ("an OBJ of many objects", |random| Ok(obj_objects(random))),
    ("a mesh in many nodes", |random| Ok(many_nodes(random))),
    ("a texture that claims to be large", |random| large_texture(random)),
];

const REFUSED: &[i32] = &[1];

fn flat_image(random: &mut Random) -> Case {
    let side = 8000 + random.below(4000) as u32;
    let words = ["convert", "flat.png", "--from", "gltf", "--to", "directx", "-o", "out.png"];
    Case::new(words).file("flat.png", flat_png(side)).expects(REFUSED, "--memory-limit")
}

/// Strips whose indices are parts of one list, each one index further.
fn strips(random: &mut Random) -> Case {
    let (count, length) = (2000, 300_000);
    let mut builder = Builder::default();
    let whole = builder.primitive(&Mesh::square(1.0));
    let view = builder.view(&vec![0; 4 * (count + length)]);
    let mut strip = |number: usize| {
        let mut strip = whole.clone();
        strip["mode"] = json!(5);
        strip["indices"] = json!(builder.accessor(json!({
            "bufferView": view, "byteOffset": 4 * number, "componentType": 5125, "count": length, "type": "SCALAR",
        })));
        strip
    };
    let strips = (0..count).map(&mut strip).collect();
    let file = builder.glb(strips, Value::Null);
    let words: &[&str] = random.pick(&[
        &["normals", "strips.glb", "--overwrite"],
        &["tangents", "strips.glb"],
        &["inspect", "strips.glb"],
    ]);
    Case::new(words.iter().copied()).file("strips.glb", file).expects(REFUSED, "--memory-limit")
}

/// A meshopt stream of vertices that are all zero is itself all zero after its first byte.
fn meshopt_views(random: &mut Random) -> Case {
    let count = 8 << 20;
    let blocks = count / 256;
    let mut stream = vec![0; 1 + 16 * blocks + 32];
    stream[0] = 0xA0;
    let length = 4 * count;
    let view = |index: usize| {
        let compressed = json!({
            "buffer": 0, "byteOffset": 0, "byteLength": stream.len(), "byteStride": 4, "count": count, "mode": "ATTRIBUTES",
        });
        json!({
            "buffer": 1, "byteOffset": index * length, "byteLength": length,
            "extensions": { "EXT_meshopt_compression": compressed },
        })
    };
    let views = 31;
    let accessor = |view: usize| {
        let kind = if view % 3 == 2 { "VEC2" } else { "VEC3" };
        json!({ "bufferView": view, "componentType": 5120, "normalized": true, "count": 999, "type": kind })
    };
    let primitive = |i: usize| {
        let attributes = json!({ "POSITION": 3 * i, "NORMAL": 3 * i + 1, "TEXCOORD_0": 3 * i + 2 });
        json!({ "attributes": attributes })
    };
    let extensions = ["EXT_meshopt_compression", "KHR_mesh_quantization"];
    let document = json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": extensions,
        "extensionsRequired": extensions,
        "buffers": [
            { "byteLength": stream.len() },
            { "byteLength": views * length, "extensions": { "EXT_meshopt_compression": { "fallback": true } } },
        ],
        "bufferViews": (0..views).map(view).collect::<Vec<_>>(),
        "accessors": (0..views).map(accessor).collect::<Vec<_>>(),
        "meshes": [{ "primitives": (0..views / 3).map(primitive).collect::<Vec<_>>() }],
    });
    let file = glb(document.to_string().as_bytes(), &stream);
    let words: &[&str] = random.pick(&[
        &["tangents", "views.glb"],
        &["normals", "views.glb", "--overwrite"],
        &["inspect", "views.glb"],
    ]);
    Case::new(words.iter().copied()).file("views.glb", file).expects(REFUSED, "--memory-limit")
}

fn empty_primitives(random: &mut Random) -> Case {
    let count = 300_000 + random.below(300_000);
    let primitives = vec![r#"{"attributes":{}}"#; count].join(",");
    let text = format!(r#"{{"asset":{{"version":"2.0"}},"meshes":[{{"primitives":[{primitives}]}}]}}"#);
    let command = random.pick(&["tangents", "normals", "inspect"]);
    Case::new([command, "many.gltf"]).file("many.gltf", text).expects(REFUSED, "--memory-limit")
}

/// Accessors without a buffer view are zeros of any count.
fn zeros(random: &mut Random) -> Case {
    let count = 1u64 << (20 + random.below(30));
    let accessor = |kind: &str| json!({ "componentType": 5126, "count": count, "type": kind });
    let attributes = json!({ "POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 1 });
    let document = json!({
        "asset": { "version": "2.0" },
        "accessors": [accessor("VEC3"), accessor("VEC2")],
        "meshes": [{ "primitives": vec![json!({ "attributes": attributes }); 1 + random.below(3)] }],
    });
    let command = random.pick(&["tangents", "normals", "inspect"]);
    Case::new([command, "zeros.gltf"]).file("zeros.gltf", document.to_string())
}

fn morph_targets(random: &mut Random) -> Case {
    let mut builder = Builder::default();
    let mesh = Mesh::grid(60);
    let mut primitive = builder.primitive(&mesh);
    let offsets = builder.vectors(&mesh.normals);
    let count = 1000 + random.below(4000);
    primitive["targets"] = json!(vec![json!({ "POSITION": offsets, "NORMAL": offsets }); count]);
    let file = builder.glb(vec![primitive], Value::Null);
    let command = random.pick(&["tangents", "normals"]);
    Case::new([command, "morphs.glb", "--overwrite"]).file("morphs.glb", file)
}

fn deep_json(random: &mut Random) -> Case {
    let depth = 1 << (7 + random.below(12));
    let (open, close) = random.pick(&[("[", "]"), (r#"{"a":"#, "}")]);
    let inner = if open == "[" { "" } else { "1" };
    let extras = format!("{}{inner}{}", open.repeat(depth), close.repeat(depth));
    let text = format!(r#"{{"asset":{{"version":"2.0"}},"extras":{extras}}}"#);
    let command = random.pick(&["tangents", "inspect"]);
    Case::new([command, "deep.gltf"]).file("deep.gltf", text)
}

/// The indentation of the first line is long, or numbers are nested deeply.
fn white_space(random: &mut Random) -> Case {
    let square = super::names::square_gltf();
    let text = if random.one_in(2) {
        format!("{{\n{}{}", " ".repeat(random.size(18)), &square[1..])
    } else {
        let numbers = "0,".repeat(random.size(17));
        format!("{{\n  \"extras\":{}{numbers}0{},{}", "[".repeat(90), "]".repeat(90), &square[1..])
    };
    Case::new(["tangents", "in.gltf", "-o", "out.gltf"]).file("in.gltf", text).expects(&[0], "")
}

/// Primitives of one triangle each, over the vertices of a grid.
fn shared_vertices(random: &mut Random) -> Case {
    let mesh = Mesh::grid(100);
    let mut builder = Builder::default();
    let whole = builder.primitive(&mesh);
    let view = builder.view(&mesh.indices.iter().flat_map(|index| index.to_le_bytes()).collect::<Vec<_>>());
    let triangle = |number: usize, builder: &mut Builder| {
        let accessor = json!({
            "bufferView": view, "byteOffset": 12 * number, "componentType": 5125, "count": 3, "type": "SCALAR",
        });
        let mut triangle = whole.clone();
        triangle["indices"] = json!(builder.accessor(accessor));
        triangle
    };
    let count = 500 + random.below(1500);
    let triangles = (0..count).map(|number| triangle(number, &mut builder)).collect();
    let file = builder.glb(triangles, Value::Null);
    let words: &[&str] = random.pick(&[
        &["convert", "in.glb", "--from", "gltf", "--to", "gltf", "-o", "out.obj"],
        &["convert", "in.glb", "--from", "gltf", "--to", "gltf", "-o", "out.ply"],
        &["check", "in.glb"],
        &["tangents", "in.glb"],
        &["normals", "in.glb", "--overwrite"],
    ]);
    Case::new(words.iter().copied()).file("in.glb", file)
}

/// Many nodes share the weights and primitives of a mesh, and many skins the matrices of joints.
fn shared_by_nodes(random: &mut Random) -> Case {
    let count = 1000 + random.below(10_000);
    let mut builder = Builder::default();
    let mut primitive = builder.primitive(&Mesh::square(1.0));
    let matrices = vec![0; 64 * count];
    let view = builder.view(&matrices);
    let accessor = builder
        .accessor(json!({ "bufferView": view, "componentType": 5126, "count": count, "type": "MAT4" }));
    let points = random.one_in(2);
    primitive["mode"] = json!(if points { 0 } else { 4 });
    let primitives = vec![primitive; if points { 2000 } else { 1 }];
    let mesh = json!({ "primitives": primitives, "weights": vec![1; count] });
    let nodes: Vec<Value> = match random.below(3) {
        0 => (0..count).map(|_| json!({ "mesh": 0 })).collect(),
        1 => (0..count).map(|skin| json!({ "mesh": 0, "skin": skin })).collect(),
        _ => (0..count).map(|_| json!({ "mesh": 0, "skin": 0 })).collect(),
    };
    let skins = vec![json!({ "joints": [0], "inverseBindMatrices": accessor }); count];
    let members = json!({
        "meshes": [mesh], "nodes": nodes, "skins": skins, "scenes": [{ "nodes": (0..count).collect::<Vec<_>>() }],
    });
    let file = builder.glb(Vec::new(), members);
    let words: &[&str] = random.pick(&[
        &["convert", "in.glb", "--from", "gltf", "--to", "gltf", "-o", "out.obj"],
        &["convert", "in.glb", "--from", "gltf", "--to", "gltf", "-o", "out.ply"],
        &["check", "in.glb"],
        &["inspect", "in.glb"],
    ]);
    Case::new(words.iter().copied()).file("in.glb", file)
}

/// An image of one colour, which compresses a thousand times.
fn large_map(random: &mut Random) -> Case {
    let png = flat_png(5000 + random.below(11_000) as u32);
    let words: &[&str] = random.pick(&[
        &["check", "map.png"],
        &["check", "map.png", "--memory-limit", "64"],
        &["check", "map.png", "--fix", "-o", "out.png"],
        &[
            "bake",
            "in.glb",
            "--high",
            "in.glb",
            "--size",
            "8",
            "--skew",
            "map.png",
            "--cage-offset",
            "1",
            "-o",
            "out.png",
        ],
    ]);
    Case::new(words.iter().copied()).file("map.png", png).file("in.glb", Mesh::square(1.0).glb())
}

/// A chain of nodes, and in one of two cases a ring.
fn deep_nodes(random: &mut Random) -> Case {
    let count = 20_000 + random.below(20_000);
    let end = if random.one_in(2) { json!({ "mesh": 0 }) } else { json!({ "children": [0] }) };
    let nodes: Vec<Value> =
        (1..count).map(|next| json!({ "children": [next], "rotation": [0, 0, 0, 1] })).chain([end]).collect();
    let mut builder = Builder::default();
    let primitive = builder.primitive(&Mesh::square(1.0));
    let file = builder.glb(vec![primitive], json!({ "nodes": nodes }));
    let words: &[&str] = random.pick(&[
        &["convert", "deep.glb", "--from", "unity", "--to", "gltf"],
        &["tangents", "deep.glb"],
        &["render", "deep.glb", "-o", "picture.png", "--size", "64x48"],
    ]);
    Case::new(words.iter().copied()).file("deep.glb", file)
}

fn obj_objects(random: &mut Random) -> Case {
    let count = 60_000 + random.below(60_000);
    let objects: String = (0..count).map(|i| format!("o {i}\nf 1 1 1\n")).collect();
    Case::new(["render", "many.obj", "-o", "picture.png", "--size", "64x48"])
        .file("many.obj", format!("v 0 0 0\n{objects}"))
}

fn many_nodes(random: &mut Random) -> Case {
    let count = 10_000 + random.below(20_000);
    let mut builder = Builder::default();
    let primitive = builder.primitive(&Mesh::grid(40));
    let members = json!({
        "nodes": vec![json!({ "mesh": 0 }); count],
        "scenes": [{ "nodes": (0..count).collect::<Vec<_>>() }],
    });
    Case::new(["render", "nodes.glb", "-o", "picture.png", "--size", "64x48"])
        .file("nodes.glb", builder.glb(vec![primitive], members))
}

/// A square whose normal map has a head that claims a large image.
fn large_texture(random: &mut Random) -> Result<Case, String> {
    let image = match random.below(3) {
        0 => {
            let mut jpeg = BUMPS_JPEG.to_vec();
            // Marker, length, precision, then height and width.
            let frame =
                jpeg.windows(2).position(|pair| pair == [0xFF, 0xC0]).ok_or("a JPEG without a frame")?;
            jpeg[frame + 5..frame + 9].fill(0xFF);
            jpeg
        }
        1 => {
            let mut webp = BUMPS_WEBP.to_vec();
            // The head of lossless data begins with a signature byte; 14 bits of width and of height follow.
            let head = webp.windows(4).position(|four| four == b"VP8L").ok_or("a WebP of another kind")?;
            webp[head + 9..head + 12].fill(0xFF);
            webp
        }
        _ => flat_png(8000),
    };
    let mut builder = Builder::default();
    let mut primitive = builder.primitive(&Mesh::square(1.0));
    primitive["material"] = json!(0);
    let view = builder.view(&image);
    let members = json!({
        "materials": [{ "normalTexture": { "index": 0 } }],
        "textures": [{ "source": 0 }],
        "images": [{ "bufferView": view }],
    });
    Ok(Case::new(["render", "large.glb", "-o", "picture.png", "--size", "64x48"])
        .file("large.glb", builder.glb(vec![primitive], members)))
}
