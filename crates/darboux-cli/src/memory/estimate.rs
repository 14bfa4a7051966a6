//! Estimates the memory that processing a file takes from what its head declares, before it is read.

use std::collections::BTreeMap;
use std::fmt;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use darboux_io::LoadOptions;
use darboux_io::gltf::file_of_uri;
use darboux_io::image::PngImage;
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny, MapAccess, Visitor};

use crate::model_json::ModelJson;
use crate::regular_file::{Links, open_regular};

/// The largest peaks measured (`normals`), per byte of a model without compression.
const PER_BYTE: u64 = 10;

/// The largest peaks measured are 33, per byte of JSON (lists of 0).
const PER_BYTE_OF_JSON: u64 = 36;

/// What processing an empty file takes, about.
const BASE: u64 = 16 << 20;

/// What processing a corner of a face takes, what a primitive does, and a UV that is read, as darboux-io
/// counts them.
const PER_CORNER: u64 = 64;
const PER_PRIMITIVE: u64 = 4096;
const PER_UV: u64 = 8;

/// The largest peaks measured are 18 (`convert`, 16 bits; `check --fix` of 8 bits takes 13), per texel of a
/// PNG.
const PER_TEXEL: u64 = 20;

/// The most bytes that darboux-io permits by default for a file of this size with its buffers.
fn limit_of(size: u64) -> u64 {
    size.saturating_mul(64).saturating_add(256 << 20)
}

/// The bytes that processing a file takes at most. Where its head does not tell, that is the default limit.
/// A glTF whose JSON is long or cannot be read takes all memory, since its buffers are not known.
pub fn of_file(path: &Path, options: &LoadOptions) -> u64 {
    of_model(path, options, true)
}

/// As [`of_file`]. `decodes_images`: whether the images of a model are decoded, into sizes that its head does
/// not tell; else they are counted in its bytes alone.
pub fn of_model(path: &Path, options: &LoadOptions, decodes_images: bool) -> u64 {
    let Head { json, buffers, beside } = head(path, options, decodes_images);
    let size = path.metadata().map_or(0, |metadata| metadata.len());
    let others = size.saturating_sub(json).saturating_add(buffers.kept);
    let of_bytes = json.saturating_mul(PER_BYTE_OF_JSON).saturating_add(others.saturating_mul(PER_BYTE));
    let plain = of_bytes.saturating_add(BASE);
    let limit = plain.max(limit_of(size.saturating_add(buffers.named)));
    beside.map_or(limit, |beside| plain.saturating_add(beside).min(limit))
}

/// As [`of_file`], of standard input.
pub fn of_stream() -> u64 {
    limit_of(0)
}

/// What the head of a file shows.
#[derive(Default)]
struct Head {
    /// The bytes of its JSON.
    json: u64,
    buffers: BufferSizes,
    /// The memory besides the bytes of the file and of its buffers; none if the head does not show it.
    beside: Option<u64>,
}

/// The bytes of buffers that are not in the file, or encoded. A file counts as a whole, because all of it is
/// read and written.
#[derive(Default)]
struct BufferSizes {
    /// Each file counts once.
    kept: u64,
    /// Each file counts for every buffer that names it, as darboux-io counts it for the default limit.
    named: u64,
}

fn head(path: &Path, options: &LoadOptions, decodes_images: bool) -> Head {
    let Ok(mut file) = open_regular(path, File::options().read(true), Links::Follow) else {
        return Head::default();
    };
    if let Some(texels) = texels_of_png(&mut file) {
        return Head { beside: Some(texels.saturating_mul(PER_TEXEL)), ..Head::default() };
    }
    let (json, declared) = match declared(&mut file, path) {
        Ok(Some(found)) => found,
        Ok(None) => return Head::default(),
        Err(Unknown) => {
            let buffers = BufferSizes { kept: u64::MAX, named: u64::MAX };
            return Head { buffers, ..Head::default() };
        }
    };
    Head {
        json,
        buffers: declared.sizes_of_buffers(|uri| file_of_uri(path, uri, options)),
        beside: declared.is_complete(decodes_images).then(|| declared.bytes_of_meshes()),
    }
}

/// The texels that the head of a PNG declares; none for other files.
fn texels_of_png(file: &mut File) -> Option<u64> {
    let mut head = [0; 26];
    file.read_exact(&mut head).ok()?;
    let number =
        |at: usize| u64::from(u32::from_be_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]));
    PngImage::is_png(&head).then(|| number(16).saturating_mul(number(20)))
}

/// The JSON of a glTF is long or cannot be read.
struct Unknown;

/// The bytes of the JSON of a glTF, and what it declares; none for other files. One is read at a time: no job
/// has taken memory for it.
fn declared(file: &mut File, path: &Path) -> Result<Option<(u64, Declared)>, Unknown> {
    static READING: Mutex<()> = Mutex::new(());
    let _reading = READING.lock().unwrap_or_else(PoisonError::into_inner);
    match ModelJson::of(file, path) {
        ModelJson::Text(text) => match serde_json::from_slice(&text) {
            Ok(declared) => Ok(Some((text.len() as u64, declared))),
            Err(_) => Err(Unknown),
        },
        ModelJson::Unread => Err(Unknown),
        ModelJson::Absent => Ok(None),
    }
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
    mode: Option<u64>,
    #[serde(default)]
    targets: Vec<IgnoredAny>,
    #[serde(default)]
    extensions: Extensions,
}

/// The accessors of positions and of UV sets.
struct Attributes {
    position: Option<usize>,
    uvs: Vec<usize>,
}

impl<'de> Deserialize<'de> for Attributes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AttributesVisitor;

        impl<'de> Visitor<'de> for AttributesVisitor {
            type Value = Attributes;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Attributes, A::Error> {
                let mut attributes = Attributes { position: None, uvs: Vec::new() };
                while let Some(semantic) = map.next_key::<String>()? {
                    match semantic.as_str() {
                        "POSITION" => attributes.position = map.next_value()?,
                        uvs if uvs.starts_with("TEXCOORD_") => attributes.uvs.push(map.next_value()?),
                        _ => drop(map.next_value::<IgnoredAny>()?),
                    }
                }
                // Semantics may share an accessor, which is read once.
                attributes.uvs.sort_unstable();
                attributes.uvs.dedup();
                Ok(attributes)
            }
        }

        deserializer.deserialize_map(AttributesVisitor)
    }
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
    uri: Option<String>,
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
    /// `file_of_uri`: the file that may be read for a URI.
    fn sizes_of_buffers(&self, file_of_uri: impl Fn(&str) -> Option<PathBuf>) -> BufferSizes {
        // A URI is looked up once, however many buffers have it: how many that are, and their bytes.
        let mut uris: BTreeMap<&str, (u64, u64)> = BTreeMap::new();
        for buffer in &self.buffers {
            let Some(uri) = &buffer.uri else { continue };
            let (count, bytes) = uris.entry(uri).or_default();
            (*count, *bytes) = (*count + 1, buffer.byte_length.max(*bytes));
        }
        /// Looking up more takes longer than processing the file alone.
        const MOST_URIS: usize = 1000;
        if uris.len() > MOST_URIS {
            return BufferSizes { kept: u64::MAX, named: u64::MAX };
        }
        let mut sizes = BufferSizes::default();
        let mut files: BTreeMap<PathBuf, u64> = BTreeMap::new();
        for (uri, (count, bytes)) in uris {
            let file = file_of_uri(uri);
            let size =
                file.as_ref().and_then(|file| file.metadata().ok()).map_or(0, |metadata| metadata.len());
            let size = size.max(bytes);
            sizes.named = sizes.named.saturating_add(size.saturating_mul(count));
            match file {
                Some(file) => {
                    let kept = files.entry(file).or_default();
                    *kept = size.max(*kept);
                }
                None => sizes.kept = sizes.kept.saturating_add(size.saturating_mul(count)),
            }
        }
        sizes.kept = files.into_values().fold(sizes.kept, u64::saturating_add);
        sizes
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
        let of_corners = |primitive: &Primitive| {
            let listed = count(primitive.indices).max(count(primitive.attributes.position));
            // Each element of a strip or a fan ends a triangle.
            let corners = match primitive.mode {
                Some(5 | 6) => listed.saturating_mul(3),
                _ => listed,
            };
            let shapes = 1 + primitive.targets.len() as u64;
            corners.saturating_mul(PER_CORNER).saturating_mul(shapes).saturating_add(PER_PRIMITIVE)
        };
        // The vertices that a primitive uses are read once, however many places it has.
        let of_uvs = |primitive: &Primitive| {
            let Primitive { attributes, indices, .. } = primitive;
            let vertices =
                count(attributes.position).min(indices.map_or(u64::MAX, |indices| count(Some(indices))));
            vertices.saturating_mul(attributes.uvs.len() as u64).saturating_mul(PER_UV)
        };
        let sum = |mesh: &Mesh, of: &dyn Fn(&Primitive) -> u64| {
            mesh.primitives.iter().map(of).fold(0, u64::saturating_add)
        };
        let of_mesh = |(mesh, places): (&Mesh, u64)| {
            sum(mesh, &of_corners).saturating_mul(places.max(1)).saturating_add(sum(mesh, &of_uvs))
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
        of_gltf_beside(&[], &LoadOptions::default(), text)
    }

    /// As [`of_gltf`], with files of these sizes at paths relative to its folder.
    fn of_gltf_beside(files: &[(&str, u64)], options: &LoadOptions, text: &str) -> (u64, u64) {
        let outside = tempfile::tempdir().expect("a folder");
        let folder = outside.path().join("models");
        fs::create_dir(&folder).expect("a folder");
        for (name, size) in files {
            File::create(folder.join(name)).and_then(|file| file.set_len(*size)).expect("a file");
        }
        let path = folder.join("m.gltf");
        fs::write(&path, text).expect("a file");
        (of_file(&path, options), text.len() as u64)
    }

    fn of_primitives(primitive: &str, members: &str) -> (u64, u64) {
        of_gltf(&format!(
            r#"{{"accessors":[{{"count":1000}},{{"count":300}}],"meshes":[{{"primitives":[{primitive}]}}]{members}}}"#
        ))
    }

    /// A file with `beside` bytes that its JSON declares.
    fn declares((estimate, size): (u64, u64), files: u64, beside: u64) {
        assert_eq!(estimate, BASE + PER_BYTE_OF_JSON * size + PER_BYTE * files + beside);
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
    fn uv_sets_are_counted_once_for_each_accessor_and_vertex_that_is_used() {
        let uvs = |sets: &str, more: &str| {
            of_primitives(
                &format!(r#"{{"attributes":{{"POSITION":0{sets}}}{more}}}"#),
                r#","nodes":[{"mesh":0}]"#,
            )
        };
        let once = PER_PRIMITIVE + 1000 * PER_CORNER;
        declares(uvs(r#","TEXCOORD_0":1"#, ""), 0, once + 8 * 1000);
        declares(
            uvs(r#","TEXCOORD_0":1,"TEXCOORD_1":1,"TEXCOORD_2":0,"NORMAL":1"#, ""),
            0,
            once + 2 * 8 * 1000,
        );
        declares(uvs(r#","TEXCOORD_0":1,"TEXCOORD_1":0"#, r#","indices":1"#), 0, once + 2 * 8 * 300);
        let places = r#","nodes":[{"mesh":0},{"mesh":0},{"mesh":0}]"#;
        let primitive = r#"{"attributes":{"POSITION":0,"TEXCOORD_0":1}}"#;
        declares(of_primitives(primitive, places), 0, 3 * once + 8 * 1000);
    }

    /// Each element of a strip or a fan but two ends a triangle.
    #[test]
    fn strips_and_fans_have_three_corners_for_each_element() {
        let of_mode = |mode: u32| {
            let primitive = format!(r#"{{"attributes":{{"POSITION":0}},"mode":{mode}}}"#);
            of_primitives(&primitive, "")
        };
        declares(of_mode(4), 0, PER_PRIMITIVE + 1000 * PER_CORNER);
        for mode in [5, 6] {
            declares(of_mode(mode), 0, PER_PRIMITIVE + 3 * 1000 * PER_CORNER);
        }
    }

    #[test]
    fn a_file_of_buffers_counts_as_a_whole_and_once() {
        let files = [("a.bin", 5000), ("b c.bin", 700), ("../outside.bin", 90_000)];
        let default = LoadOptions::default();
        let text = |buffers: &str| format!(r#"{{"buffers":[{buffers}]}}"#);
        let of = |buffers: &str, options| of_gltf_beside(&files, options, &text(buffers));
        declares(of(r#"{"byteLength":36,"uri":"a.bin"}"#, &default), 5000, 0);
        declares(of(r#"{"byteLength":5001,"uri":"a.bin"}"#, &default), 5001, 0);
        let many = r#"{"byteLength":36,"uri":"a.bin"},{"uri":"a.bin"},{"uri":"./a.bin"},{"byteLength":1,"uri":"b%20c.bin"}"#;
        declares(of(many, &default), 5700, 0);
        has_the_limit(
            of_gltf_beside(&files, &default, &format!(r#"{{"images":[{{}}],"buffers":[{many}]}}"#)),
            15_700,
        );
        declares(
            of(r#"{"byteLength":8,"uri":"none.bin"},{"byteLength":9,"uri":"data:,x"}"#, &default),
            17,
            0,
        );
        let outside = r#"{"byteLength":36,"uri":"../outside.bin"}"#;
        declares(of(outside, &default), 36, 0);
        declares(of(outside, &default.with_allow_outside(true)), 90_000, 0);
    }

    #[test]
    fn the_bytes_of_a_glb_after_its_json_count_less() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("m.glb");
        let head = b"glTF\x02\0\0\0\x1C\x10\0\0\x04\0\0\0JSON{  }\0\x10\0\0BIN\0";
        fs::write(&path, [&head[..], &[0; 4096]].concat()).expect("a file");
        let others = head.len() as u64 - 4 + 4096;
        declares((of_file(&path, &LoadOptions::default()), 4), others, 0);
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
        let options = LoadOptions::default();
        has_the_limit((of_model(&path, &options, true), text.len() as u64), 1000);
        declares((of_model(&path, &options, false), text.len() as u64), 1000, 0);
    }

    #[test]
    fn a_long_json_takes_all_memory() {
        let long = " ".repeat(4 * MEBIBYTE as usize);
        assert_eq!(of_gltf(&format!("{{{long}}}")).0, u64::MAX);
        assert_eq!(of_gltf(r#"{"accessors": [{}], "no": "count"}"#).0, u64::MAX);
    }
}
