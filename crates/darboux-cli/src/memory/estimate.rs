//! Estimates the memory that processing a file takes from what its head declares, before it is read.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

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

/// The most bytes that darboux-io permits by default for a file of this size.
fn limit_of(size: u64) -> u64 {
    (256 << 20) + size.saturating_mul(64)
}

/// The bytes that processing a file takes at most. Where its head does not tell, that is the
/// default limit.
pub fn of_file(path: &Path) -> u64 {
    let size = path.metadata().map_or(0, |metadata| metadata.len());
    let plain = size.saturating_mul(PER_BYTE).saturating_add(BASE);
    match needed_beside(path) {
        Some(more) => plain.saturating_add(more).min(plain.max(limit_of(size))),
        None => plain.max(limit_of(size)),
    }
}

/// As [`of_file`], of standard input.
pub fn of_stream() -> u64 {
    limit_of(0)
}

/// What a file declares to need beyond its bytes. None: its head does not tell.
fn needed_beside(path: &Path) -> Option<u64> {
    let metadata = path.metadata().ok().filter(std::fs::Metadata::is_file)?;
    let mut file = File::open(path).ok()?;
    let mut head = [0; 26];
    file.read_exact(&mut head).ok()?;
    let number =
        |at: usize| u64::from(u32::from_be_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]));
    if PngImage::is_png(&head) {
        let texels = number(16).saturating_mul(number(20));
        return Some(texels.saturating_mul(PER_TEXEL));
    }
    let text = if head.starts_with(b"glTF") {
        let length = u32::from_le_bytes([head[12], head[13], head[14], head[15]]);
        file.seek(SeekFrom::Start(20)).ok()?;
        let mut text = Vec::new();
        file.take(length.into()).read_to_end(&mut text).ok()?;
        text
    } else if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gltf")) {
        file.seek(SeekFrom::Start(0)).ok()?;
        let mut text = Vec::new();
        file.take(metadata.len()).read_to_end(&mut text).ok()?;
        text
    } else {
        return None;
    };
    let text = String::from_utf8(text).ok()?;
    // Compression is declared with the parts that have it.
    let is_compressed = text.contains("_compression");
    serde_json::from_str::<Declared>(&text).ok()?.bytes().filter(|_| !is_compressed)
}

/// What counts of a glTF.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
#[derive(Default)]
struct Declared {
    accessors: Vec<Accessor>,
    meshes: Vec<Mesh>,
    buffers: Vec<Buffer>,
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
}

#[derive(Deserialize)]
#[serde(rename_all = "UPPERCASE")]
struct Attributes {
    position: Option<usize>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Buffer {
    #[serde(default)]
    byte_length: u64,
    uri: Option<IgnoredAny>,
}

impl Declared {
    /// None: there are images, which are decoded to sizes that are not written here.
    fn bytes(&self) -> Option<u64> {
        if !self.images.is_empty() {
            return None;
        }
        let count = |accessor: Option<usize>| {
            accessor.and_then(|index| self.accessors.get(index)).map_or(0, |accessor| accessor.count)
        };
        let of_primitive = |primitive: &Primitive| {
            let corners = count(primitive.indices).max(count(primitive.attributes.position));
            corners.saturating_mul(PER_CORNER).saturating_add(PER_PRIMITIVE)
        };
        let primitives = self.meshes.iter().flat_map(|mesh| &mesh.primitives).map(of_primitive);
        let files = self.buffers.iter().filter(|buffer| buffer.uri.is_some());
        let files = files.map(|buffer| buffer.byte_length.saturating_mul(PER_BYTE));
        Some(primitives.chain(files).fold(0, u64::saturating_add))
    }
}
