//! Tangents and normals in fewer bytes, and back.

use darboux::encode;

use crate::codes::{self, TangentEncodingCode, darboux_tangent_encoding};
use crate::pointers::{Output, copied};
use crate::status::{Error, call, darboux_status};

type Tangent = [f32; 4];
type Normal = [f32; 3];

/// Where elements are, and how far apart in bytes (0: packed).
struct Place(*mut u8, usize);

/// Writes tangents in fewer bytes.
///
/// `encoding`: the form, which says what type `codes` has. `count`: the number of elements of every array. `normals`: `count` by 3, unit
/// and bit for bit what the decoder will be given; DARBOUX_TANGENT_ENCODING_DIAMOND alone reads them, else null. `tangents`: `count` by
/// 4, unit xyz and sign w; a w below zero counts as -1, any other as +1. `codes`: room for the result. Each stride: bytes from one
/// element to the next, 0 for packed. Errors: null, a stride that is too small, an unknown encoding.
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
    use TangentEncodingCode::{Diamond, Octahedral, Snorm8, Snorm10, Snorm16};
    let to = Place(codes.cast(), code_stride);
    // SAFETY: every pointer is as the documentation above says.
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

/// Reads tangents that darboux_encode_tangents wrote; they are unit but in the SNORM forms.
///
/// Parameters and errors as there, with `codes` read and `tangents` written.
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
    use TangentEncodingCode::{Diamond, Octahedral, Snorm8, Snorm10, Snorm16};
    let to = Place(tangents.cast(), tangent_stride);
    let from = Place(codes.cast_mut().cast(), code_stride);
    // SAFETY: every pointer is as the documentation above says.
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

/// Writes normals as `int16_t[2]`, a point of the unfolded octahedron. Directions turn by up to 0.0038 degrees.
///
/// `count`: the number of elements. `normals`: `count` by 3. `codes`: room for `count` by 2. Each stride: bytes from one element to the
/// next, 0 for packed. Errors: null, a stride that is too small.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_encode_normals(
    count: usize,
    normals: *const f32,
    normal_stride: usize,
    codes: *mut i16,
    code_stride: usize,
) -> darboux_status {
    // SAFETY: every pointer is as the documentation above says.
    call(|| unsafe {
        let normals = copied("normals", normals.cast(), count, normal_stride)?;
        convert(count, normals, Place(codes.cast(), code_stride), encode::normal_to_octahedral)
    })
}

/// Reads the unit normals that darboux_encode_normals wrote. Parameters and errors as there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_decode_normals(
    count: usize,
    codes: *const i16,
    code_stride: usize,
    normals: *mut f32,
    normal_stride: usize,
) -> darboux_status {
    // SAFETY: every pointer is as the documentation above says.
    call(|| unsafe {
        let codes = copied("codes", codes.cast(), count, code_stride)?;
        convert(count, codes, Place(normals.cast(), normal_stride), encode::normal_from_octahedral)
    })
}

/// Writes normals and tangents as `int16_t[4]`, one quaternion, the scalar last. Directions turn by up to 0.0047 degrees.
///
/// `count`: the number of elements. `normals`: `count` by 3, unit. `tangents`: `count` by 4, unit xyz and sign w. `codes`: room for
/// `count` by 4. Each stride: bytes from one element to the next, 0 for packed. Errors: null, a stride that is too small.
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
    // SAFETY: every pointer is as the documentation above says.
    call(|| unsafe {
        let normals = copied::<Normal>("normals", normals.cast(), count, normal_stride)?;
        let tangents = copied::<Tangent>("tangents", tangents.cast(), count, tangent_stride)?;
        let pairs = normals.zip(tangents);
        convert(count, pairs, Place(codes.cast(), code_stride), |(normal, tangent)| {
            encode::frame_to_quaternion(normal, tangent)
        })
    })
}

/// Reads the unit normals and tangents that darboux_encode_frames wrote. Parameters and errors as there.
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
    // SAFETY: every pointer is as the documentation above says; codes are copied before anything is written.
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
    /// # Safety
    ///
    /// As of [`copied`].
    unsafe fn elements<T: Copy>(self, count: usize) -> Result<impl Iterator<Item = T>, Error> {
        // SAFETY: as of this function.
        unsafe { copied("codes", self.0, count, self.1) }
    }
}

/// Writes every element as `of` turns it.
///
/// # Safety
///
/// As of [`Output::new`].
unsafe fn convert<From, To: Copy>(
    count: usize,
    from: impl Iterator<Item = From>,
    to: Place,
    of: impl Fn(From) -> To,
) -> Result<(), Error> {
    // SAFETY: as of this function.
    let out = unsafe { Output::new("the result", to.0, count, to.1) }?;
    out.write(from.map(of));
    Ok(())
}
