//! `convert` and `convertTexels`: arrays and texels in another convention.

use darboux::{Channel, Convention, Conversion, TexelLayout};

use crate::arena::{Arena, with_arena};
use crate::extras::Extras;
use crate::inputs::resized;
use crate::mesh_arrays::rows_mut;

/// The text of the source convention, and that of the target behind it, in UTF-8.
#[unsafe(no_mangle)]
pub extern "C" fn convention_texts(bytes: usize) -> *mut u8 {
    with_arena(|arena| resized(&mut arena.extras.convention_texts, bytes))
}

/// Converts the positions, normals, UVs, given tangents and faces in the arena in place. The text of the
/// source has `source_bytes` bytes. `generated`: the tangents come from `generate_tangents`. Returns bit 0
/// where red is inverted and bit 1 where green is; -1 where the source is no convention, -2 where the target
/// is none, and -3 where the face sizes do not add up to the corners.
#[unsafe(no_mangle)]
pub extern "C" fn convert(source_bytes: usize, generated: bool) -> i32 {
    with_arena(|arena| {
        let (source, target) = match conventions(&arena.extras, source_bytes) {
            Ok(both) => both,
            Err(code) => return code,
        };
        let change = source.to(target);
        let of_tangents = if generated { source.generated().to(target) } else { change };
        for vector in rows_mut(&mut arena.vertices.positions).iter_mut() {
            *vector = change.vector(*vector);
        }
        for vector in rows_mut(&mut arena.vertices.normals).iter_mut() {
            *vector = change.vector(*vector);
        }
        for uv in rows_mut(&mut arena.surface.uvs).iter_mut() {
            *uv = change.uv(*uv);
        }
        for tangent in rows_mut(&mut arena.extras.given_tangents).iter_mut() {
            *tangent = of_tangents.tangent(*tangent);
        }
        if convert_faces(arena, &change).is_none() { -3 } else { inverted_channels(&change) }
    })
}

/// `None` where the face sizes do not add up to the corners.
fn convert_faces(arena: &mut Arena, change: &Conversion) -> Option<()> {
    let surface = &mut arena.surface;
    if surface.face_sizes.is_empty() {
        surface.indices.chunks_mut(3).for_each(|face| change.face(face));
        return Some(());
    }
    let mut rest = &mut surface.indices[..];
    for &size in &surface.face_sizes {
        let (face, others) = rest.split_at_mut_checked(size as usize)?;
        change.face(face);
        rest = others;
    }
    rest.is_empty().then_some(())
}

/// Converts the texels in the encoded bytes in place: `channels` channels of 8 bits or, with `is_wide`, of
/// 16. Returns as [`convert`].
#[unsafe(no_mangle)]
pub extern "C" fn convert_texels(source_bytes: usize, is_wide: bool, channels: usize) -> i32 {
    with_arena(|arena| {
        let change = match conventions(&arena.extras, source_bytes) {
            Ok((source, target)) => source.to(target),
            Err(code) => return code,
        };
        let bytes = &mut arena.extras.encoded_bytes;
        if is_wide {
            let mut words: Vec<u16> =
                bytes.as_chunks().0.iter().map(|&word| u16::from_le_bytes(word)).collect();
            convert_channels(&change, &mut words, channels);
            bytes.clear();
            bytes.extend(words.into_iter().flat_map(u16::to_le_bytes));
        } else {
            convert_channels(&change, bytes, channels);
        }
        inverted_channels(&change)
    })
}

fn convert_channels<C: Channel>(change: &Conversion, texels: &mut [C], channels: usize) {
    match channels {
        2 => change.texels(TexelLayout::RG, texels.as_chunks_mut().0),
        3 => change.texels(TexelLayout::RGB, texels.as_chunks_mut().0),
        4 => change.texels(TexelLayout::RGBA, texels.as_chunks_mut().0),
        _ => panic!("{channels} is not a number of channels"),
    }
}

/// The source and the target. Errors: the codes of [`convert`].
fn conventions(extras: &Extras, source_bytes: usize) -> Result<(Convention, Convention), i32> {
    let (source, target) = extras.convention_texts.split_at_checked(source_bytes).ok_or(-1)?;
    let parsed = |text| str::from_utf8(text).ok()?.parse::<Convention>().ok();
    Ok((parsed(source).ok_or(-1)?, parsed(target).ok_or(-2)?))
}

fn inverted_channels(change: &Conversion) -> i32 {
    i32::from(change.inverts_red()) | i32::from(change.inverts_green()) << 1
}
