//! `encodeTangents` and `decodeTangents`: tangents in 2 to 8 bytes.

use darboux::Choice;
use darboux::encode::{self, Encoding};

use crate::arena::with_arena;
use crate::mesh_arrays::rows;

/// Encodes the given tangents and returns the address of the bytes. `encoding` is a position in `ENCODINGS`
/// of `lib/core/choices.ts`. 'diamond' also reads the arena's normals, one per tangent.
#[unsafe(no_mangle)]
pub extern "C" fn encode_tangents(encoding: u32) -> *const u8 {
    with_arena(|arena| {
        let tangents = rows::<4>(&arena.extras.given_tangents).iter().copied();
        arena.extras.encoded_bytes = match of_code(encoding) {
            Encoding::Snorm8 => {
                tangents.flat_map(|t| encode::tangent_to_snorm8(t).map(|x| x as u8)).collect()
            }
            Encoding::Snorm10 => tangents.flat_map(|t| encode::tangent_to_snorm10(t).to_le_bytes()).collect(),
            Encoding::Snorm16 => {
                tangents.flat_map(encode::tangent_to_snorm16).flat_map(i16::to_le_bytes).collect()
            }
            Encoding::Octahedral => {
                tangents.flat_map(encode::tangent_to_octahedral).flat_map(i16::to_le_bytes).collect()
            }
            Encoding::Diamond => rows(&arena.vertices.normals)
                .iter()
                .zip(tangents)
                .flat_map(|(&normal, t)| encode::tangent_to_diamond(normal, t).to_le_bytes())
                .collect(),
        };
        arena.extras.encoded_bytes.as_ptr()
    })
}

/// Decodes the bytes that [`encode_tangents`] wrote and returns the address of the tangents.
#[unsafe(no_mangle)]
pub extern "C" fn decode_tangents(encoding: u32) -> *const f32 {
    with_arena(|arena| {
        let bytes = &arena.extras.encoded_bytes;
        let words = || bytes.as_chunks().0.iter().map(|&bytes| i16::from_le_bytes(bytes));
        let tangents: Vec<[f32; 4]> = match of_code(encoding) {
            Encoding::Snorm8 => {
                in_rows::<4, _>(bytes.iter().map(|&x| x as i8)).map(encode::tangent_from_snorm8).collect()
            }
            Encoding::Snorm10 => (bytes.as_chunks().0.iter())
                .map(|&bytes| encode::tangent_from_snorm10(u32::from_le_bytes(bytes)))
                .collect(),
            Encoding::Snorm16 => in_rows(words()).map(encode::tangent_from_snorm16).collect(),
            Encoding::Octahedral => in_rows(words()).map(encode::tangent_from_octahedral).collect(),
            Encoding::Diamond => rows(&arena.vertices.normals)
                .iter()
                .zip(words())
                .map(|(&normal, code)| encode::tangent_from_diamond(normal, code as u16))
                .collect(),
        };
        arena.extras.floats = tangents.into_flattened();
        arena.extras.floats.as_ptr()
    })
}

/// The encoding of a code. Panics for a code beyond the list, which JavaScript never passes.
fn of_code(code: u32) -> Encoding {
    Encoding::from_code(code).unwrap_or_else(|| panic!("{code} is not the code of an encoding"))
}

/// Groups numbers into rows of `N`.
fn in_rows<const N: usize, T: Copy + Default>(
    mut numbers: impl ExactSizeIterator<Item = T>,
) -> impl Iterator<Item = [T; N]> {
    (0..numbers.len() / N).map(move |_| std::array::from_fn(|_| numbers.next().unwrap_or_default()))
}
