//! A low and a high plate in a folder, and what tests read from the outputs of a bake.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::common::{Run, darboux, text};

/// A square plate over [0, 1] x [0, 1] with heights at x = 0 and x = 1, as the bytes of a GLB.
pub fn plate(heights: [f32; 2], attributes: &[&str], scale: f32) -> Vec<u8> {
    named_plate(heights, attributes, scale, "plate")
}

/// As [`plate`], with a name of its node.
pub fn named_plate(heights: [f32; 2], attributes: &[&str], scale: f32, name: &str) -> Vec<u8> {
    let places = [[0.0f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let positions: Vec<f32> = places.iter().flat_map(|p| [p[0], p[1], heights[p[0] as usize]]).collect();
    let normals: Vec<f32> = places.iter().flat_map(|_| [0.0, 0.0, 1.0]).collect();
    let uvs: Vec<f32> = places.iter().flat_map(|p| [p[0], 1.0 - p[1]]).collect();
    let mut bytes: Vec<u8> = Vec::new();
    let mut views = Vec::new();
    // Against the UVs, so that they are told from computed ones.
    let tangents: Vec<f32> = places.iter().flat_map(|_| [0.0, 1.0, 0.0, 1.0]).collect();
    for floats in [&positions, &normals, &uvs, &tangents] {
        views.push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": 4 * floats.len()}));
        bytes.extend(floats.iter().flat_map(|x| x.to_le_bytes()));
    }
    views.push(json!({"buffer": 0, "byteOffset": bytes.len(), "byteLength": 12}));
    bytes.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
    let all = json!({"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2, "TANGENT": 3});
    let kept: serde_json::Map<String, Value> =
        attributes.iter().map(|&name| (name.to_owned(), all[name].clone())).collect();
    let json = json!({
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": name, "mesh": 0, "scale": [scale, scale, scale]}],
        "meshes": [{"primitives": [{"attributes": kept, "indices": 4}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, heights[0].min(heights[1])], "max": [1, 1, heights[0].max(heights[1])]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 3, "componentType": 5126, "count": 4, "type": "VEC4"},
            {"bufferView": 4, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": views,
        "buffers": [{"byteLength": bytes.len()}],
    });
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut glb = b"glTF\x02\0\0\0".to_vec();
    glb.extend(((28 + text.len() + bytes.len()) as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &bytes)] {
        glb.extend((chunk.len() as u32).to_le_bytes());
        glb.extend(kind);
        glb.extend(chunk);
    }
    glb
}

pub const FULL: [&str; 3] = ["POSITION", "NORMAL", "TEXCOORD_0"];

/// A folder with a flat low model and a high model whose roof rises by one half.
pub struct Pair {
    pub folder: tempfile::TempDir,
}

impl Pair {
    pub fn new() -> Self {
        let pair = Self { folder: tempfile::tempdir().expect("a folder") };
        fs::write(pair.path("low.glb"), plate([0.0, 0.0], &FULL, 1.0)).expect("a file");
        fs::write(pair.path("high.glb"), plate([0.0, 0.5], &["POSITION"], 1.0)).expect("a file");
        pair
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn bake(&self, more: &[&str]) -> Run {
        let [low, high, map] = ["low.glb", "high.glb", "map.png"].map(|name| self.path(name));
        let all = [
            "bake",
            text(&low),
            "--high",
            text(&high),
            "-o",
            text(&map),
            "--size",
            "16",
            "--cage-offset",
            "1",
        ];
        darboux(&[&all, more].concat())
    }

    /// The channels of the first texel of a PNG, from 0 to 1, and its bits per channel.
    pub fn texel(&self, name: &str) -> (Vec<f64>, u8) {
        let file = std::io::BufReader::new(fs::File::open(self.path(name)).expect("a map"));
        let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
        let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
        let info = reader.next_frame(&mut bytes).expect("texels");
        let samples = info.color_type.samples();
        match info.bit_depth {
            png::BitDepth::Sixteen => {
                let words = bytes.as_chunks::<2>().0[..samples].iter();
                (words.map(|&word| f64::from(u16::from_be_bytes(word)) / 65535.0).collect(), 16)
            }
            _ => (bytes[..samples].iter().map(|&byte| f64::from(byte) / 255.0).collect(), 8),
        }
    }
}

pub fn near(a: &[f64], b: &[f64], by: f64) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= by)
}

/// The pixels of an RGB picture with 8 bits.
pub fn rgb(path: &Path) -> Vec<[u8; 3]> {
    image::open(path).expect("a picture").to_rgb8().pixels().map(|pixel| pixel.0).collect()
}

/// A GLB with its JSON edited.
pub fn edited(glb: &[u8], edit: impl FnOnce(&mut Value)) -> Vec<u8> {
    let length = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    let mut json: Value = serde_json::from_slice(&glb[20..20 + length]).expect("JSON");
    edit(&mut json);
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let rest = &glb[20 + length..];
    let mut out = b"glTF\x02\0\0\0".to_vec();
    out.extend(((20 + text.len() + rest.len()) as u32).to_le_bytes());
    out.extend((text.len() as u32).to_le_bytes());
    out.extend(b"JSON");
    [out, text, rest.to_vec()].concat()
}

/// The JSON of a GLB.
pub fn json_of(path: &Path) -> Value {
    let glb = fs::read(path).expect("a model");
    let length = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    serde_json::from_slice(&glb[20..20 + length]).expect("JSON")
}

/// The codes of a grey PNG of 8 bits.
pub fn grey(path: &Path) -> Vec<u8> {
    let file = std::io::BufReader::new(fs::File::open(path).expect("a map"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut bytes).expect("texels");
    bytes
}

/// A high model whose material has colour, roughness, metalness and light.
pub fn painted_high(pair: &Pair) {
    let high = edited(&plate([0.0, 0.0], &["POSITION"], 1.0), |json| {
        json["meshes"][0]["primitives"][0]["material"] = 0.into();
        json["materials"] = json!([{
            "name": "paint",
            "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 1], "roughnessFactor": 0.25, "metallicFactor": 0.75},
            "emissiveFactor": [1, 1, 0.5],
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}},
        }]);
        json["extensionsUsed"] = json!(["KHR_materials_emissive_strength"]);
    });
    fs::write(pair.path("high.glb"), high).expect("a file");
}

/// A plate whose normal map shows its UVs at half their size.
pub fn half_size_plate() -> Vec<u8> {
    edited(&plate([0.0, 0.0], &FULL, 1.0), |json| {
        json["meshes"][0]["primitives"][0]["material"] = 0.into();
        let transform = json!({"KHR_texture_transform": {"scale": [0.5, 0.5]}});
        json["materials"] = json!([{"normalTexture": {"index": 0, "extensions": transform}}]);
        json["textures"] = json!([{}]);
        json["extensionsUsed"] = json!(["KHR_texture_transform"]);
    })
}

/// A plate that leans along both axes of the image, as an OBJ.
pub const LEANING: &str = "v 0 0 0\nv 1 0 0.5\nv 1 1 0.2\nv 0 1 -0.3\nf 1 2 3 4\n";
