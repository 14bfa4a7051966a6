//! The files that are damaged: models of the repository and of a folder, and made ones for formats without a
//! sample there.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::corpus;
use super::images::{self, BUMPS_JPEG, BUMPS_PNG, BUMPS_WEBP};
use super::model::{Builder, Mesh};
use crate::run::{files_below, root};
use crate::soak::random::Random;

/// A readable file, and the files beside it that it refers to.
pub struct Seed {
    /// Its name without folder.
    pub name: PathBuf,
    pub bytes: Vec<u8>,
    pub companions: Vec<(PathBuf, Vec<u8>)>,
}

/// The extensions of files that the command reads. Where it does not read one yet, it says so.
const READ: [&str; 13] =
    ["gltf", "glb", "vrm", "obj", "ply", "stl", "fbx", "png", "jpg", "jpeg", "webp", "tga", "ktx2"];

/// Files larger than this are left out: damage to small ones finds as much in less time.
const MAX_SIZE: usize = 400_000;

/// All seeds, in an order that does not change. Errors: a file cannot be read or made.
pub fn all(models: Option<&Path>) -> Result<Vec<Seed>, String> {
    let mut seeds = in_folder(&root().join("assets"))?;
    if let Some(models) = models {
        seeds.extend(in_folder(models)?);
    }
    for images in ["ktx2", "rasters"] {
        seeds.extend(in_folder(&root().join("crates/darboux-io/tests").join(images))?);
    }
    seeds.extend(of_corpus()?);
    seeds.extend(made()?);
    Ok(seeds)
}

impl Seed {
    fn new(name: &str, bytes: Vec<u8>) -> Self {
        Self { name: name.into(), bytes, companions: Vec::new() }
    }

    fn with(mut self, name: &str, bytes: impl Into<Vec<u8>>) -> Self {
        self.companions.push((name.into(), bytes.into()));
        self
    }

    /// The extension in lower case.
    pub fn extension(&self) -> String {
        self.name.extension().unwrap_or_default().to_string_lossy().to_lowercase()
    }
}

/// The models and images of a folder, each with the other files of its folder.
fn in_folder(folder: &Path) -> Result<Vec<Seed>, String> {
    let read = |path: &PathBuf| {
        fs::read(path).map_err(|error| format!("{} cannot be read: {error}", path.display()))
    };
    let files = files_below(folder)?;
    let mut seeds = Vec::new();
    for path in &files {
        let kind = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let is_small = fs::metadata(path).is_ok_and(|file| file.len() <= MAX_SIZE as u64);
        if !is_small || !READ.contains(&&*kind) {
            continue;
        }
        let mut seed = Seed { name: name_of(path), bytes: read(path)?, companions: Vec::new() };
        if ["gltf", "obj"].contains(&&*kind) {
            let beside = files.iter().filter(|file| file.parent() == path.parent() && *file != path);
            for file in
                beside.filter(|file| fs::metadata(file).is_ok_and(|file| file.len() <= MAX_SIZE as u64))
            {
                seed.companions.push((name_of(file), read(file)?));
            }
        }
        seeds.push(seed);
    }
    Ok(seeds)
}

fn name_of(path: &Path) -> PathBuf {
    path.file_name().unwrap_or_default().into()
}

fn of_corpus() -> Result<Vec<Seed>, String> {
    let mut seeds = Vec::new();
    for path in files_below(&root().join("conformance/cases"))? {
        let text = fs::read_to_string(&path)
            .map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
        if let Some(mesh) = corpus::mesh(&text) {
            seeds.push(Seed {
                name: name_of(&path.with_extension("glb")),
                bytes: mesh.glb(),
                companions: Vec::new(),
            });
        }
    }
    Ok(seeds)
}

fn made() -> Result<Vec<Seed>, String> {
    let mut random = Random::new(0, 0);
    let mut seeds = vec![Seed::new("grid.glb", Mesh::grid(40).glb()), sparse(), obj()];
    seeds.extend(scans());
    seeds.push(Seed::new("grid.vrm", Mesh::grid(8).glb()));
    seeds.push(Seed::new("bumps.jpeg", BUMPS_JPEG.into()));
    seeds.push(Seed::new("bumps.webp", BUMPS_WEBP.into()));
    for number in 0..12 {
        seeds.push(Seed::new(&format!("map{number}.png"), images::any_png(&mut random)?));
    }
    for (kind, image) in [("png", BUMPS_PNG), ("jpeg", BUMPS_JPEG), ("webp", BUMPS_WEBP)] {
        seeds.push(Seed::new(&format!("embedded-{kind}.glb"), textured(kind, image)));
    }
    Ok(seeds)
}

/// A square with an embedded normal map.
fn textured(kind: &str, image: &[u8]) -> Vec<u8> {
    let mut builder = Builder::default();
    let mut primitive = builder.primitive(&Mesh::square(1.0));
    primitive["material"] = json!(0);
    let view = builder.view(image);
    let members = json!({
        "materials": [{ "normalTexture": { "index": 0 } }],
        "textures": [{ "source": 0 }],
        "images": [{ "bufferView": view, "mimeType": format!("image/{kind}") }],
    });
    builder.glb(vec![primitive], members)
}

/// A square with sparse positions, morph targets and a skin.
fn sparse() -> Seed {
    let mut builder = Builder::default();
    let mut primitive = builder.primitive(&Mesh::square(1.0));
    let [places, values] = [builder.view(&[0, 0, 2, 0]), builder.view(&[0; 24])];
    let target = builder.accessor(json!({
        "componentType": 5126, "count": 4, "type": "VEC3",
        "sparse": {
            "count": 2,
            "indices": { "bufferView": places, "componentType": 5123 },
            "values": { "bufferView": values },
        },
    }));
    primitive["targets"] = json!([{ "POSITION": target }]);
    let joints = builder.view(&[0; 16]);
    let joints =
        builder.accessor(json!({ "bufferView": joints, "componentType": 5121, "count": 4, "type": "VEC4" }));
    primitive["attributes"]["JOINTS_0"] = json!(joints);
    primitive["attributes"]["WEIGHTS_0"] = json!(builder.vectors(&[[1.0, 0.0, 0.0, 0.0]; 4]));
    let members = json!({ "skins": [{ "joints": [0] }], "nodes": [{ "mesh": 0, "skin": 0, "rotation": [0, 0, 0, 1] }] });
    Seed::new("sparse.glb", builder.glb(vec![primitive], members))
}

/// A square in OBJ, with a library and images of both kinds.
fn obj() -> Seed {
    let text = "mtllib square.mtl\no square\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 \
         0\nvt 1 1\nvt 0 1\n\
                vn 0 0 1\nusemtl a\nf 1/1/1 2/2/1 3/3/1 4/4/1\nusemtl b\ng part\nf 1//1 2//1 3//1\nl 1 2\np \
                1\n";
    let library = "newmtl a\nKd 1 0.5 0.2\nmap_Kd color.jpg\nnorm normal.png\nnewmtl b\nmap_Bump -bm 0.5 \
         normal.png\nd 0.5\nillum 2\n";
    Seed::new("square.obj", text.into())
        .with("square.mtl", library)
        .with("color.jpg", BUMPS_JPEG)
        .with("normal.png", BUMPS_PNG)
}

/// A square in PLY and STL, as text and binary.
fn scans() -> [Seed; 4] {
    let mesh = Mesh::square(1.0);
    let floats = |vector: &[f32]| vector.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    let header = |format: &str| {
        let vertex: String = ["x", "y", "z", "nx", "ny", "nz", "s", "t"]
            .map(|name| format!("property float {name}\n"))
            .concat();
        format!(
            "ply\nformat {format} 1.0\ncomment made\nelement vertex 4\n{vertex}element face 2\nproperty list \
             uchar int vertex_indices\nend_header\n"
        )
    };
    let vertices = || (0..4).map(|i| [&mesh.positions[i][..], &mesh.normals[i], &mesh.uvs[i]].concat());
    let mut ply = header("ascii");
    vertices().for_each(|vertex| {
        ply += &format!("{}\n", vertex.iter().map(f32::to_string).collect::<Vec<_>>().join(" "))
    });
    ply += "3 0 1 2\n3 0 2 3\n";
    let mut binary_ply = header("binary_little_endian").into_bytes();
    vertices().for_each(|vertex| binary_ply.extend(floats(&vertex)));
    let mut stl = "solid made\n".to_owned();
    let mut binary_stl = [&[0; 80][..], &2u32.to_le_bytes()].concat();
    for triangle in mesh.indices.chunks(3) {
        binary_ply.push(3);
        binary_ply.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
        stl += "facet normal 0 0 1\nouter loop\n";
        binary_stl.extend(floats(&[0.0, 0.0, 1.0]));
        for position in triangle.iter().map(|&index| mesh.positions[index as usize]) {
            stl += &format!("vertex {} {} {}\n", position[0], position[1], position[2]);
            binary_stl.extend(floats(&position));
        }
        stl += "endloop\nendfacet\n";
        binary_stl.extend([0; 2]);
    }
    stl += "endsolid made\n";
    [
        Seed::new("text.ply", ply.into()),
        Seed::new("binary.ply", binary_ply),
        Seed::new("text.stl", stl.into()),
        Seed::new("binary.stl", binary_stl),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_has_a_seed() {
        let seeds = all(None).expect("seeds");
        for kind in ["gltf", "glb", "vrm", "obj", "ply", "stl", "fbx", "png", "jpeg", "webp", "tga", "ktx2"] {
            assert!(seeds.iter().any(|seed| seed.extension() == kind), "{kind}");
        }
        let names: Vec<_> = seeds.iter().map(|seed| seed.name.display().to_string()).collect();
        for name in ["draco.glb", "meshopt.glb", "quantised-sparse.glb", "embedded-webp.glb", "sliver.glb"] {
            assert!(names.iter().any(|other| other == name), "{name} in {names:?}");
        }
    }
}
