//! The two containers of glTF: JSON text, and GLB with a header and chunks.

use std::ops::Range;

use super::segments::{self, Segment};
use crate::error::ContentError;

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = 0x4E4F_534A;
const BIN: u32 = 0x004E_4942;
const BOM: &[u8] = b"\xEF\xBB\xBF";

/// The ranges of a file's parts.
#[derive(Clone, Debug)]
pub struct Container {
    /// Whether the file is a GLB.
    pub is_glb: bool,
    /// The JSON text, without its byte order mark and padding.
    pub json: Range<usize>,
    /// The content of the binary chunk.
    pub bin: Option<Range<usize>>,
    /// The type and content of other chunks.
    pub other_chunks: Vec<(u32, Range<usize>)>,
}

impl Container {
    /// Finds the parts of a file. Its first bytes decide between the containers.
    pub fn parse(file: &[u8]) -> Result<Self, ContentError> {
        if file.starts_with(MAGIC) {
            return parse_glb(file);
        }
        let start = if file.starts_with(BOM) { BOM.len() } else { 0 };
        let first = file[start..].iter().find(|byte| !byte.is_ascii_whitespace());
        if first != Some(&b'{') {
            return Err(ContentError::invalid("", "is not glTF; give a .gltf or .glb file of glTF 2.0"));
        }
        Ok(Self { is_glb: false, json: start..file.len(), bin: None, other_chunks: Vec::new() })
    }
}

fn parse_glb(file: &[u8]) -> Result<Container, ContentError> {
    let broken =
        |problem: String| ContentError::invalid("", format!("{problem}; export or download it again"));
    let (Some(version), Some(length)) = (word(file, 4), word(file, 8)) else {
        return Err(broken("is cut off within the GLB header".into()));
    };
    match version {
        2 => {}
        1 => return Err(ContentError::invalid("", "is a GLB of version 1; convert it to glTF 2.0")),
        _ => {
            let problem =
                "begins as a GLB of a version that does not exist; give a .gltf or .glb file of glTF 2.0";
            return Err(ContentError::invalid("", problem));
        }
    }
    if length as usize != file.len() {
        return Err(broken(format!("the GLB header says {length} bytes but there are {}", file.len())));
    }
    let mut container = Container { is_glb: true, json: 0..0, bin: None, other_chunks: Vec::new() };
    let mut at = 12;
    while at < file.len() {
        let (Some(length), Some(kind)) = (word(file, at), word(file, at + 4)) else {
            return Err(broken(format!("is cut off within the chunk header at byte {at}")));
        };
        let content = at + 8..(at + 8).saturating_add(length as usize);
        if content.end > file.len() {
            return Err(broken(format!(
                "the chunk at byte {at} says {length} bytes but {} are left",
                file.len() - content.start
            )));
        }
        match kind {
            JSON if at == 12 => {
                container.json = content.start..content.start + unpadded(&file[content.clone()])
            }
            _ if at == 12 => return Err(broken("the first chunk is not JSON".into())),
            BIN if container.bin.is_none() => container.bin = Some(content.clone()),
            _ => container.other_chunks.push((kind, content.clone())),
        }
        at = content.end;
    }
    if container.json.is_empty() {
        return Err(broken("has no JSON chunk".into()));
    }
    Ok(container)
}

/// The length of `json` without the spaces at its end, or the zeros that some exporters write instead.
fn unpadded(json: &[u8]) -> usize {
    json.iter().rposition(|&byte| byte != b' ' && byte != 0).map_or(0, |at| at + 1)
}

fn word(file: &[u8], at: usize) -> Option<u32> {
    Some(u32::from_le_bytes(*file.get(at..)?.first_chunk()?))
}

/// A GLB of `json`, the binary chunk `bin` and other chunks. Errors: more than the 4 GiB that a GLB can hold.
pub fn glb<'a>(
    json: Vec<u8>,
    bin: Option<Vec<Segment<'a>>>,
    other_chunks: Vec<(u32, &'a [u8])>,
) -> Result<Vec<Segment<'a>>, ContentError> {
    let mut chunks = vec![(JSON, vec![Segment::Owned(json)], b' ')];
    chunks.extend(bin.map(|segments| (BIN, segments, 0)));
    chunks.extend(other_chunks.into_iter().map(|(kind, chunk)| (kind, vec![Segment::Borrowed(chunk)], 0)));
    let padded = |segments: &[Segment<'_>]| segments::length(segments).next_multiple_of(4);
    let length = 12 + chunks.iter().map(|(_, segments, _)| 8 + padded(segments)).sum::<usize>();
    let too_large =
        || ContentError::unsupported("", format!("{length} bytes are too many for a GLB; write a .gltf"));
    let total = u32::try_from(length).map_err(|_| too_large())?;

    let mut out = vec![Segment::Owned([MAGIC, &2u32.to_le_bytes(), &total.to_le_bytes()].concat())];
    for (kind, segments, padding) in chunks {
        let length = segments::length(&segments);
        let padding = vec![padding; length.next_multiple_of(4) - length];
        let header = (length + padding.len()) as u64 | u64::from(kind) << 32;
        out.push(Segment::Owned(header.to_le_bytes().to_vec()));
        out.extend(segments);
        out.push(Segment::Owned(padding));
    }
    Ok(out)
}
