//! Tangents in fewer bytes, and back.

use darboux::encode;

use crate::room::{rows, with};

/// Writes the given tangents in a form, which comes as its place in the list of `lib/darboux.ts`: where the codes lie. One form takes
/// the mesh's normals, one per tangent.
#[unsafe(no_mangle)]
pub extern "C" fn encode_tangents(form: u32) -> *const u8 {
    with(|room| {
        let tangents = rows::<4>(&room.values.given).iter().copied();
        room.values.codes = match form {
            0 => tangents.flat_map(|t| encode::tangent_to_snorm8(t).map(|x| x as u8)).collect(),
            1 => tangents.flat_map(|t| encode::tangent_to_snorm10(t).to_le_bytes()).collect(),
            2 => tangents.flat_map(encode::tangent_to_snorm16).flat_map(i16::to_le_bytes).collect(),
            3 => tangents.flat_map(encode::tangent_to_octahedral).flat_map(i16::to_le_bytes).collect(),
            _ => rows(room.vertices.normals())
                .iter()
                .zip(tangents)
                .flat_map(|(&normal, t)| encode::tangent_to_diamond(normal, t).to_le_bytes())
                .collect(),
        };
        room.values.codes.as_ptr()
    })
}

/// Reads what [`encode_tangents`] wrote: where the tangents lie.
#[unsafe(no_mangle)]
pub extern "C" fn decode_tangents(form: u32) -> *const f32 {
    with(|room| {
        let codes = &room.values.codes;
        let words = || codes.as_chunks().0.iter().map(|&bytes| i16::from_le_bytes(bytes));
        let tangents: Vec<[f32; 4]> = match form {
            0 => chunks::<4, _>(codes.iter().map(|&x| x as i8)).map(encode::tangent_from_snorm8).collect(),
            1 => (codes.as_chunks().0.iter())
                .map(|&bytes| encode::tangent_from_snorm10(u32::from_le_bytes(bytes)))
                .collect(),
            2 => chunks(words()).map(encode::tangent_from_snorm16).collect(),
            3 => chunks(words()).map(encode::tangent_from_octahedral).collect(),
            _ => rows(room.vertices.normals())
                .iter()
                .zip(words())
                .map(|(&normal, code)| encode::tangent_from_diamond(normal, code as u16))
                .collect(),
        };
        room.values.floats = tangents.into_flattened();
        room.values.floats.as_ptr()
    })
}

/// Numbers in rows of `N`.
fn chunks<const N: usize, T: Copy + Default>(
    mut numbers: impl ExactSizeIterator<Item = T>,
) -> impl Iterator<Item = [T; N]> {
    (0..numbers.len() / N).map(move |_| std::array::from_fn(|_| numbers.next().unwrap_or_default()))
}
