//! Estimates the memory that processing a file takes from what its head declares, before it is read.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use darboux_io::image::PngImage;
use serde::Deserialize;
use serde::de::IgnoredAny;

/// The largest peaks measured (`normals`), per byte of a model without compression.
const PER_BYTE: u64 = 10;

/// What processing an empty file takes, about.
const BASE: u64 = 16 << 20;

/// What processing a corner of a face takes, and what a primitive does, as darboux-io counts them.
const PER_CORNER: u64 = 64;
const PER_PRIMITIVE: u64 = 4096;

/// The largest peaks measured are 18 (`convert`, 16 bits; `check --fix` of 8 bits takes 13), per texel of a
/// PNG.
const PER_TEXEL: u64 = 20;

/// The most bytes of JSON that are read for an estimate.
const MOST_JSON: u64 = 4 << 20;

/// The most bytes that darboux-io permits by default for a file of this size with its buffers.
fn limit_of(size: u64) -> u64 {
    size.saturating_mul(64).saturating_add(256 << 20)
}

/// The bytes that processing a file takes at most. Where its head does not tell, that is the default limit.
/// A glTF whose JSON is long or cannot be read takes all memory, since its buffers are not known.
pub fn of_file(path: &Path) -> u64 {
    of_model(path, true)
}

/// As [`of_file`]. `decodes_images`: whether the images of a model are decoded, into sizes that its head does
/// not tell; else they are counted in its bytes alone.
pub fn of_model(path: &Path, decodes_images: bool) -> u64 {
    let Head { files, beside } = head(path, decodes_images);
    let size = path.metadata().map_or(0, |metadata| metadata.len()).saturating_add(files);
    let plain = size.saturating_mul(PER_BYTE).saturating_add(BASE);
    let limit = plain.max(limit_of(size));
    beside.map_or(limit, |beside| plain.saturating_add(beside).min(limit))
}

/// As [`of_file`], of standard input.
pub fn of_stream() -> u64 {
    limit_of(0)
}

/// What the head of a file tells.
struct Head {
    /// The bytes of its buffers that are not in the file, or encoded.
    files: u64,
    /// What it needs beyond its bytes and those of its buffers; none if the head does not tell.
    beside: Option<u64>,
}

fn head(path: &Path, decodes_images: bool) -> Head {
    let other = Head { files: 0, beside: None };
    let Some(metadata) = path.metadata().ok().filter(std::fs::Metadata::is_file) else { return other };
    let Ok(mut file) = File::open(path) else { return other };
    let mut head = [0; 26];
    if file.read_exact(&mut head).is_err() {
        return other;
    }
    let number =
        |at: usize| u64::from(u32::from_be_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]));
    if PngImage::is_png(&head) {
        let texels = number(16).saturating_mul(number(20));
        return Head { beside: Some(texels.saturating_mul(PER_TEXEL)), ..other };
    }
    let (start, length) = if head.starts_with(b"glTF") {
        (20, u32::from_le_bytes([head[12], head[13], head[14], head[15]]).into())
    } else if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gltf")) {
        (0, metadata.len())
    } else {
        return other;
    };
    let declared = declared(&mut file, start, length);
    declared.map_or(Head { files: u64::MAX, beside: None }, |declared| declared.head(decodes_images))
}

/// What the JSON in a range of a file declares; none if it is long or cannot be read. One is read at a time:
/// no job has taken memory for it.
fn declared(file: &mut File, start: u64, length: u64) -> Option<Declared> {
    static READING: Mutex<()> = Mutex::new(());
    if length > MOST_JSON {
        return None;
    }
    let _reading = READING.lock().unwrap_or_else(PoisonError::into_inner);
    file.seek(SeekFrom::Start(start)).ok()?;
    let mut text = Vec::new();
    file.take(length).read_to_end(&mut text).ok()?;
    serde_json::from_slice(&text).ok()
}

/// What counts of a glTF.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
#[derive(Default)]
struct Declared {
    accessors: Vec<Accessor>,
    meshes: Vec<Mesh>,
    nodes: Vec<Node>,
    buffers: Vec<Buffer>,
    buffer_views: Vec<BufferView>,
    images: Vec<IgnoredAny>,
}

#[derive(Deserialize)]
struct Accessor {
    count: u64,
}

#[derive(Deserialize)]
struct Mesh {
    primitives: Vec<Primitive>,
}

#[derive(Deserialize)]
struct Primitive {
    attributes: Attributes,
    indices: Option<usize>,
    #[serde(default)]
    targets: Vec<IgnoredAny>,
    #[serde(default)]
    extensions: Extensions,
}

#[derive(Deserialize)]
#[serde(rename_all = "UPPERCASE")]
struct Attributes {
    position: Option<usize>,
}

#[derive(Deserialize)]
struct Node {
    mesh: Option<usize>,
    #[serde(default)]
    extensions: Extensions,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Buffer {
    #[serde(default)]
    byte_length: u64,
    uri: Option<IgnoredAny>,
}

#[derive(Deserialize)]
struct BufferView {
    #[serde(default)]
    extensions: Extensions,
}

/// The extensions whose data has a size that is not in the JSON.
#[derive(Deserialize, Default)]
#[serde(default)]
struct Extensions {
    #[serde(rename = "KHR_draco_mesh_compression")]
    draco: Option<IgnoredAny>,
    #[serde(rename = "EXT_meshopt_compression")]
    meshopt: Option<IgnoredAny>,
    #[serde(rename = "KHR_meshopt_compression")]
    khr_meshopt: Option<IgnoredAny>,
    #[serde(rename = "EXT_mesh_gpu_instancing")]
    instances: Option<IgnoredAny>,
}

impl Extensions {
    fn are_known(&self) -> bool {
        let Self { draco, meshopt, khr_meshopt, instances } = self;
        [draco, meshopt, khr_meshopt, instances].into_iter().all(Option::is_none)
    }
}

impl Declared {
    fn head(&self, decodes_images: bool) -> Head {
        let buffers = self.buffers.iter().filter(|buffer| buffer.uri.is_some());
        let files = buffers.map(|buffer| buffer.byte_length).fold(0, u64::saturating_add);
        Head { files, beside: self.is_complete(decodes_images).then(|| self.bytes_of_meshes()) }
    }

    /// Whether all that needs memory has its size in the JSON. Images have it elsewhere.
    fn is_complete(&self, decodes_images: bool) -> bool {
        (self.images.is_empty() || !decodes_images)
            && self.buffer_views.iter().all(|view| view.extensions.are_known())
            && self.nodes.iter().all(|node| node.extensions.are_known())
            && self.meshes.iter().flat_map(|mesh| &mesh.primitives).all(|part| part.extensions.are_known())
    }

    /// What the primitives take, with their morph targets, at all places of their meshes.
    fn bytes_of_meshes(&self) -> u64 {
        let mut places = vec![0u64; self.meshes.len()];
        for mesh in self.nodes.iter().filter_map(|node| node.mesh) {
            places.get_mut(mesh).into_iter().for_each(|places| *places += 1);
        }
        let count = |accessor: Option<usize>| {
            accessor.and_then(|index| self.accessors.get(index)).map_or(0, |accessor| accessor.count)
        };
        let of_primitive = |primitive: &Primitive| {
            let corners = count(primitive.indices).max(count(primitive.attributes.position));
            let shapes = 1 + primitive.targets.len() as u64;
            corners.saturating_mul(PER_CORNER).saturating_mul(shapes).saturating_add(PER_PRIMITIVE)
        };
        let of_mesh = |(mesh, places): (&Mesh, u64)| {
            let once = mesh.primitives.iter().map(of_primitive).fold(0, u64::saturating_add);
            once.saturating_mul(places.max(1))
        };
        self.meshes.iter().zip(places).map(of_mesh).fold(0, u64::saturating_add)
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    const MEBIBYTE: u64 = 1 << 20;

    /// The estimate of a `.gltf`, and its size.
    fn of_gltf(text: &str) -> (u64, u64) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("m.gltf");
        fs::write(&path, text).expect("a file");
        (of_file(&path), text.len() as u64)
    }

    fn of_primitives(primitive: &str, members: &str) -> (u64, u64) {
        of_gltf(&format!(
            r#"{{"accessors":[{{"count":1000}},{{"count":300}}],"meshes":[{{"primitives":[{primitive}]}}]{members}}}"#
        ))
    }

    /// A file with `beside` bytes that its JSON declares.
    fn declares((estimate, size): (u64, u64), files: u64, beside: u64) {
        assert_eq!(estimate, BASE + PER_BYTE * (size + files) + beside);
    }

    fn has_the_limit((estimate, size): (u64, u64), files: u64) {
        assert_eq!(estimate, 256 * MEBIBYTE + 64 * (size + files));
    }

    #[test]
    fn places_and_morph_targets_are_counted() {
        let once = PER_PRIMITIVE + 1000 * PER_CORNER;
        let primitive = r#"{"attributes":{"POSITION":0},"indices":1}"#;
        declares(of_primitives(primitive, ""), 0, once);
        declares(of_primitives(primitive, r#","nodes":[{"mesh":0},{},{"mesh":0},{"mesh":7}]"#), 0, 2 * once);
        let targets = r#"{"attributes":{"POSITION":0},"targets":[{},{},{}]}"#;
        declares(of_primitives(targets, ""), 0, once + 3 * 1000 * PER_CORNER);
    }

    #[test]
    fn the_limit_counts_buffers() {
        let buffers = r#","buffers":[{"byteLength":40000000,"uri":"a.bin"},{"byteLength":5}]"#;
        let many = format!(r#"{{"attributes":{{"POSITION":0}},"targets":[{}{{}}]}}"#, "{},".repeat(100_000));
        has_the_limit(of_primitives(&many, buffers), 40_000_000);
        declares(of_primitives("", buffers), 40_000_000, 0);
    }

    #[test]
    fn compressed_data_and_images_have_the_limit() {
        let draco = r#"{"attributes":{},"extensions":{"KHR_draco_mesh\u005fcompression":{}}}"#;
        has_the_limit(of_primitives(draco, ""), 0);
        let view = r#","bufferViews":[{"extensions":{"EXT_meshopt_compression":{}}}]"#;
        has_the_limit(of_primitives("", view), 0);
        has_the_limit(of_primitives("", r#","images":[{"uri":"a_compression.png"}]"#), 0);
        declares(of_primitives("", r#","extras":"_compression""#), 0, 0);
    }

    #[test]
    fn images_that_are_not_decoded_are_among_the_bytes() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("m.gltf");
        let text = r#"{"images":[{"uri":"a.png"}],"buffers":[{"byteLength":1000,"uri":"a.bin"}]}"#;
        fs::write(&path, text).expect("a file");
        has_the_limit((of_model(&path, true), text.len() as u64), 1000);
        declares((of_model(&path, false), text.len() as u64), 1000, 0);
    }

    #[test]
    fn a_long_json_takes_all_memory() {
        let long = " ".repeat(4 * MEBIBYTE as usize);
        assert_eq!(of_gltf(&format!("{{{long}}}")).0, u64::MAX);
        assert_eq!(of_gltf(r#"{"accessors": [{}], "no": "count"}"#).0, u64::MAX);
    }
}
