//! Compressed formats of tangents, normals and frames in C: encoders and decoders over strided arrays.

use darboux::encode::{self, Encoding};

use crate::codes::{self, darboux_tangent_encoding};
use crate::pointers::{Output, copied};
use crate::status::{Error, call, darboux_status};

type Tangent = [f32; 4];
type Normal = [f32; 3];

/// A strided array: its first byte and the stride in bytes (0: packed).
struct Place(*mut u8, usize);

/// Encodes tangents in a compressed format.
///
/// `encoding`: the format, which determines the type of `codes`. `count`: the number of elements of every
/// array. `normals`: `count` by 3 floats, unit length, equal bit for bit to the normals at decoding; read for
/// DARBOUX_TANGENT_ENCODING_DIAMOND only, otherwise may be NULL. `tangents`: `count` by 4 floats, unit xyz
/// and sign w; a w below zero counts as -1, any other value as +1. `codes`: receives `count` elements.
/// Strides: bytes from one element to the next; 0 for packed. Errors: a null pointer, a stride smaller than
/// an element, an unknown encoding.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_encode_tangents(
    encoding: darboux_tangent_encoding,
    count: usize,
    normals: *const f32,
    normal_stride: usize,
    tangents: *const f32,
    tangent_stride: usize,
    codes: *mut core::ffi::c_void,
    code_stride: usize,
) -> darboux_status {
    use Encoding::{Diamond, Octahedral, Snorm8, Snorm10, Snorm16};
    let to = Place(codes.cast(), code_stride);
    // SAFETY: the pointers are as documented above.
    call(|| unsafe {
        let tangents = copied::<Tangent>("tangents", tangents.cast(), count, tangent_stride)?;
        match codes::tangent_encoding(encoding)? {
            Snorm8 => convert(count, tangents, to, encode::tangent_to_snorm8),
            Snorm10 => convert(count, tangents, to, encode::tangent_to_snorm10),
            Snorm16 => convert(count, tangents, to, encode::tangent_to_snorm16),
            Octahedral => convert(count, tangents, to, encode::tangent_to_octahedral),
            Diamond => {
                let normals = copied::<Normal>("normals", normals.cast(), count, normal_stride)?;
                let pairs = normals.zip(tangents);
                convert(count, pairs, to, |(normal, tangent)| encode::tangent_to_diamond(normal, tangent))
            }
        }
    })
}

/// Decodes the tangents that darboux_encode_tangents wrote. They have unit length, except in the SNORM
/// formats.
///
/// `codes`: read. `tangents`: receives `count` by 4 floats. Other parameters and errors: as for
/// darboux_encode_tangents.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_decode_tangents(
    encoding: darboux_tangent_encoding,
    count: usize,
    normals: *const f32,
    normal_stride: usize,
    codes: *const core::ffi::c_void,
    code_stride: usize,
    tangents: *mut f32,
    tangent_stride: usize,
) -> darboux_status {
    use Encoding::{Diamond, Octahedral, Snorm8, Snorm10, Snorm16};
    let to = Place(tangents.cast(), tangent_stride);
    let from = Place(codes.cast_mut().cast(), code_stride);
    // SAFETY: the pointers are as documented above.
    call(|| unsafe {
        match codes::tangent_encoding(encoding)? {
            Snorm8 => convert(count, from.elements(count)?, to, encode::tangent_from_snorm8),
            Snorm10 => convert(count, from.elements(count)?, to, encode::tangent_from_snorm10),
            Snorm16 => convert(count, from.elements(count)?, to, encode::tangent_from_snorm16),
            Octahedral => convert(count, from.elements(count)?, to, encode::tangent_from_octahedral),
            Diamond => {
                let normals = copied::<Normal>("normals", normals.cast(), count, normal_stride)?;
                let pairs = normals.zip(from.elements(count)?);
                convert(count, pairs, to, |(normal, code)| encode::tangent_from_diamond(normal, code))
            }
        }
    })
}

/// Encodes normals as `int16_t[2]`, an octahedral map. The largest error is 0.0038 degrees.
///
/// `count`: the number of elements. `normals`: `count` by 3 floats. `codes`: receives `count` by 2 integers.
/// Strides: bytes from one element to the next; 0 for packed. Errors: a null pointer, a stride smaller than
/// an element.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_encode_normals(
    count: usize,
    normals: *const f32,
    normal_stride: usize,
    codes: *mut i16,
    code_stride: usize,
) -> darboux_status {
    // SAFETY: the pointers are as documented above.
    call(|| unsafe {
        let normals = copied("normals", normals.cast(), count, normal_stride)?;
        convert(count, normals, Place(codes.cast(), code_stride), encode::normal_to_octahedral)
    })
}

/// Decodes the normals that darboux_encode_normals wrote, as unit vectors. Parameters and errors: as for
/// darboux_encode_normals.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_decode_normals(
    count: usize,
    codes: *const i16,
    code_stride: usize,
    normals: *mut f32,
    normal_stride: usize,
) -> darboux_status {
    // SAFETY: the pointers are as documented above.
    call(|| unsafe {
        let codes = copied("codes", codes.cast(), count, code_stride)?;
        convert(count, codes, Place(normals.cast(), normal_stride), encode::normal_from_octahedral)
    })
}

/// Encodes normals and tangents as `int16_t[4]`, one quaternion, scalar last. The largest error is 0.0047
/// degrees.
///
/// `count`: the number of elements. `normals`: `count` by 3 floats, unit length. `tangents`: `count` by 4
/// floats, unit xyz and sign w. `codes`: receives `count` by 4 integers. Strides: bytes from one element to
/// the next; 0 for packed. Errors: a null pointer, a stride smaller than an element.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_encode_frames(
    count: usize,
    normals: *const f32,
    normal_stride: usize,
    tangents: *const f32,
    tangent_stride: usize,
    codes: *mut i16,
    code_stride: usize,
) -> darboux_status {
    // SAFETY: the pointers are as documented above.
    call(|| unsafe {
        let normals = copied::<Normal>("normals", normals.cast(), count, normal_stride)?;
        let tangents = copied::<Tangent>("tangents", tangents.cast(), count, tangent_stride)?;
        let pairs = normals.zip(tangents);
        convert(count, pairs, Place(codes.cast(), code_stride), |(normal, tangent)| {
            encode::frame_to_quaternion(normal, tangent)
        })
    })
}

/// Decodes the unit normals and tangents that darboux_encode_frames wrote. Parameters and errors: as for
/// darboux_encode_frames.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_decode_frames(
    count: usize,
    codes: *const i16,
    code_stride: usize,
    normals: *mut f32,
    normal_stride: usize,
    tangents: *mut f32,
    tangent_stride: usize,
) -> darboux_status {
    // SAFETY: the pointers are as documented above; all codes are read before anything is written.
    call(|| unsafe {
        let codes = copied("codes", codes.cast(), count, code_stride)?;
        let frames: Vec<(Normal, Tangent)> = codes.map(encode::frame_from_quaternion).collect();
        let normals = Output::new("normals", normals.cast(), count, normal_stride)?;
        let tangents = Output::new("tangents", tangents.cast(), count, tangent_stride)?;
        normals.write(frames.iter().map(|frame| frame.0));
        tangents.write(frames.iter().map(|frame| frame.1));
        Ok(())
    })
}

impl Place {
    /// Iterates over the `count` codes of the array.
    ///
    /// # Safety
    ///
    /// As for [`copied`].
    unsafe fn elements<T: Copy>(self, count: usize) -> Result<impl Iterator<Item = T>, Error> {
        // SAFETY: the caller's promise.
        unsafe { copied("codes", self.0, count, self.1) }
    }
}

/// Writes `of(element)` for every element of `from`.
///
/// # Safety
///
/// As for [`Output::new`].
unsafe fn convert<From, To: Copy>(
    count: usize,
    from: impl Iterator<Item = From>,
    to: Place,
    of: impl Fn(From) -> To,
) -> Result<(), Error> {
    // SAFETY: the caller's promise.
    let out = unsafe { Output::new("the result", to.0, count, to.1) }?;
    out.write(from.map(of));
    Ok(())
}
