//! EXT_meshopt_compression and KHR_meshopt_compression: buffer views whose bytes are encoded elsewhere.
//!
//! The KHR variant adds version 1 of the vertex codec and the colour filter; the decoder takes either under both names.

use std::collections::BTreeMap;

use super::{element_text, unreadable, without_extension};
use crate::error::Fault;
use crate::gltf::document::{Document, Store};
use crate::gltf::json::set_member;
use crate::gltf::schema::Meshopt;

const NAMES: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Decodes every compressed buffer view into the buffer that it falls back to.
///
/// A fallback that has bytes of its own is taken as it is: the extension says that it holds the same.
pub fn decompress(document: &mut Document) -> Result<(), Fault> {
    let views = document.root.buffer_views.iter().enumerate();
    let compressed: Vec<(usize, Meshopt)> =
        views.filter_map(|(i, view)| Some((i, view.extensions.meshopt.as_deref()?.clone()))).collect();
    if compressed.is_empty() {
        return Ok(());
    }
    let mut decoded: BTreeMap<usize, Filling> = BTreeMap::new();
    for (index, meshopt) in &compressed {
        let view = &document.root.buffer_views[*index];
        if matches!(document.stores.get(view.buffer), Some(Store::Absent(_))) {
            let (buffer, offset, length) = (view.buffer, view.byte_offset, view.byte_length);
            let bytes = decode(document, *index, meshopt, length)?;
            place(decoded.entry(buffer).or_default(), offset, &bytes, *index)?;
        }
    }
    for (buffer, Filling { bytes, .. }) in decoded {
        let text = element_text(document, "buffers", buffer);
        let text = text.and_then(|text| set_member(&text, "byteLength", Some(&bytes.len().to_string())));
        document.edits.buffers.insert(buffer, text.map_err(unreadable)?);
        document.root.buffers[buffer].byte_length = bytes.len();
        document.stores[buffer] = Store::Decoded(bytes);
    }
    remove_extension(document, compressed.iter().map(|(index, _)| *index)).map_err(unreadable)
}

fn remove_extension(document: &mut Document, views: impl Iterator<Item = usize>) -> serde_json::Result<()> {
    for index in views {
        let text = element_text(document, "bufferViews", index)?;
        document.edits.views.insert(index, without_extension(&text, &NAMES)?);
        document.root.buffer_views[index].extensions.meshopt = None;
    }
    for index in 0..document.root.buffers.len() {
        let text = match document.edits.buffers.get(&index) {
            Some(edited) => edited.clone(),
            None => element_text(document, "buffers", index)?,
        };
        let plain = without_extension(&text, &NAMES)?;
        if plain != text {
            document.edits.buffers.insert(index, plain);
        }
    }
    document.edits.removed_extensions.extend(NAMES);
    Ok(())
}

/// A buffer while views are decoded into it.
#[derive(Default)]
struct Filling {
    bytes: Vec<u8>,
    /// How many bytes were decoded, gaps left out.
    decoded: usize,
}

/// Writes a view's bytes to its place in the buffer. Gaps between views are zeros; gaps larger than all that was decoded are not
/// believed.
fn place(buffer: &mut Filling, offset: usize, bytes: &[u8], view: usize) -> Result<(), Fault> {
    let at = format!("bufferViews[{view}].byteOffset");
    buffer.decoded = buffer.decoded.saturating_add(bytes.len());
    let most = MOST_GAP.saturating_add(buffer.decoded.saturating_mul(2));
    let Some(end) = offset.checked_add(bytes.len()).filter(|&end| end <= most) else {
        let problem = format!("{offset} is far beyond the other views of its buffer; export the file again");
        return Err(Fault::invalid(at, problem));
    };
    if buffer.bytes.len() < end {
        buffer.bytes.resize(end, 0);
    }
    buffer.bytes[offset..end].copy_from_slice(bytes);
    Ok(())
}

/// Views need not come in the order of their places: so much may be left for later ones.
const MOST_GAP: usize = 64 << 20;

fn decode(document: &Document, index: usize, meshopt: &Meshopt, length: usize) -> Result<Vec<u8>, Fault> {
    let at = format!("bufferViews[{index}].extensions.{}", NAMES[0]);
    let invalid = |problem: String| Fault::invalid(at.clone(), format!("{problem}; export the file again"));
    let Meshopt { buffer, byte_offset, byte_length, byte_stride: stride, count, ref mode, ref filter } =
        *meshopt;
    let source = document.buffer_range(buffer, byte_offset, byte_length, &at)?;
    if count.checked_mul(stride) != Some(length) {
        return Err(invalid(format!(
            "{count} elements of {stride} bytes do not make the view's {length} bytes"
        )));
    }
    if count > most_elements(mode, stride, source.len()) {
        return Err(invalid(format!("{count} elements cannot come from {} bytes", source.len())));
    }
    let unknown = |what: &str| {
        Fault::unsupported(at.clone(), format!("{what} is not known; save the model uncompressed"))
    };
    let decoded = match (mode.as_str(), stride) {
        ("ATTRIBUTES", 4..=256) if stride % 4 == 0 => vertices(source, count, stride),
        ("TRIANGLES", 2) if count % 3 == 0 => {
            meshopt::decode_index_buffer::<u16>(source, count).map(u16_bytes).ok()
        }
        ("TRIANGLES", 4) if count % 3 == 0 => {
            meshopt::decode_index_buffer::<u32>(source, count).map(u32_bytes).ok()
        }
        ("INDICES", 2) => meshopt::decode_index_sequence::<u16>(source, count).map(u16_bytes).ok(),
        ("INDICES", 4) => meshopt::decode_index_sequence::<u32>(source, count).map(u32_bytes).ok(),
        ("ATTRIBUTES" | "TRIANGLES" | "INDICES", _) => {
            return Err(invalid(format!("{count} elements of {stride} bytes do not fit mode {mode}")));
        }
        _ => return Err(unknown(&format!("mode {mode:?}"))),
    };
    let mut bytes = decoded.ok_or_else(|| invalid("its bytes are broken".into()))?;
    match filter.as_deref() {
        None | Some("NONE") => {}
        Some(filter) => {
            apply(filter, stride, &mut bytes)
                .ok_or_else(|| unknown(&format!("filter {filter:?} of {stride} bytes")))?;
        }
    }
    Ok(bytes)
}

/// No stream of `length` bytes holds more: triangles and indices take a byte each, 256 vertices a bit for every four bytes.
fn most_elements(mode: &str, stride: usize, length: usize) -> usize {
    match mode {
        "TRIANGLES" => length.saturating_mul(3),
        "INDICES" => length,
        _ => length.saturating_mul(1024) / stride.max(1),
    }
}

fn u16_bytes(values: Vec<u16>) -> Vec<u8> {
    values.into_iter().flat_map(u16::to_le_bytes).collect()
}

fn u32_bytes(values: Vec<u32>) -> Vec<u8> {
    values.into_iter().flat_map(u32::to_le_bytes).collect()
}

/// Decodes vertices of `stride` bytes, a multiple of 4 up to 256.
fn vertices(source: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    // The decoder is generic over the vertex, so every size needs a type.
    macro_rules! by_words {
        ($($words:literal)*) => {
            match stride / 4 {
                $(
                    $words => meshopt::decode_vertex_buffer::<[u32; $words]>(source, count)
                        .map(|vertices| words(vertices.as_flattened())).ok(),
                )*
                $(
                    n if n == 32 + $words => meshopt::decode_vertex_buffer::<([u32; 32], [u32; $words])>(source, count)
                        .map(|vertices| vertices.iter().flat_map(|(a, b)| words(&[&a[..], b].concat())).collect()).ok(),
                )*
                _ => None,
            }
        };
    }
    by_words!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32)
}

/// Words as they lie in memory, which is what the decoder wrote.
fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_ne_bytes()).collect()
}

/// Undoes a filter in place; none where there is no such filter for elements of `stride` bytes.
fn apply(filter: &str, stride: usize, bytes: &mut [u8]) -> Option<()> {
    match (filter, stride) {
        ("OCTAHEDRAL", 4) => in_place(bytes, i8::from_le_bytes, i8::to_le_bytes, meshopt::decode_filter_oct),
        ("OCTAHEDRAL", 8) => {
            in_place(bytes, i16::from_le_bytes, i16::to_le_bytes, meshopt::decode_filter_oct)
        }
        ("QUATERNION", 8) => {
            in_place(bytes, i16::from_le_bytes, i16::to_le_bytes, meshopt::decode_filter_quat)
        }
        ("EXPONENTIAL", _) => {
            in_place(bytes, u32::from_le_bytes, u32::to_le_bytes, meshopt::decode_filter_exp::<1>);
        }
        ("COLOR", 4) => in_place(bytes, u8::from_le_bytes, u8::to_le_bytes, meshopt::decode_filter_color),
        ("COLOR", 8) => in_place(bytes, u16::from_le_bytes, u16::to_le_bytes, meshopt::decode_filter_color),
        _ => return None,
    }
    Some(())
}

/// Runs `filter` over `bytes` as elements of `N` numbers.
fn in_place<T: Copy, const S: usize, const N: usize>(
    bytes: &mut [u8],
    read: fn([u8; S]) -> T,
    write: fn(T) -> [u8; S],
    filter: fn(&mut [[T; N]]),
) {
    let mut values: Vec<T> = bytes.as_chunks::<S>().0.iter().map(|bytes| read(*bytes)).collect();
    filter(values.as_chunks_mut::<N>().0);
    for (bytes, value) in bytes.as_chunks_mut::<S>().0.iter_mut().zip(values) {
        *bytes = write(value);
    }
}
