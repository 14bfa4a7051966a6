//! Conventions in C: presets of programs, and conversion of arrays from one convention to another.

use std::mem::offset_of;

use darboux::{
    Axes, Axis, BitangentDirection, Convention, Conversion, SignRule, TangentDirection, UvOrigin, Winding,
};

use crate::codes::{
    self, AxisCode, BitangentDirectionCode, FacesCode, SignRuleCode, TangentDirectionCode, UvOriginCode,
    WindingCode, darboux_axis, darboux_bitangent_direction, darboux_faces, darboux_program,
    darboux_sign_rule, darboux_tangent_direction, darboux_uv_origin, darboux_winding,
};
use crate::pointers::{self, Output, Receiver, Versioned, copied, slice};
use crate::status::{Error, call, darboux_status};

/// The convention of a mesh and of its normal map. NULL or all zeros: glTF.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_convention {
    /// sizeof(darboux_convention). 0: the size in version 0.1.
    pub size: usize,
    /// The axis that the model's right points along. Right, up and front must be three different axes.
    pub right: darboux_axis,
    /// The axis that the model's top points along.
    pub up: darboux_axis,
    /// The axis that the model's front points along.
    pub front: darboux_axis,
    /// The winding of front faces.
    pub winding: darboux_winding,
    /// The origin of UVs.
    pub uv_origin: darboux_uv_origin,
    /// The direction of tangents and of red.
    pub tangent: darboux_tangent_direction,
    /// The direction of bitangents and of green.
    pub bitangent: darboux_bitangent_direction,
    /// The formula of the bitangent.
    pub sign: darboux_sign_rule,
}

// SAFETY: `repr(C)`, the size is the first field, all fields are integers.
unsafe impl Versioned for darboux_convention {
    const NAME: &str = "darboux_convention";
    const FIRST_SIZE: usize = pointers::size_through::<Self, darboux_sign_rule>(offset_of!(Self, sign));
}

impl darboux_convention {
    fn checked(self) -> Result<Convention, Error> {
        let axis = |code, default| codes::axis(code).map(|axis| axis.unwrap_or(default));
        let gltf = Convention::GLTF.axes;
        let axes = Axes::new(
            axis(self.right, gltf.right())?,
            axis(self.up, gltf.up())?,
            axis(self.front, gltf.front())?,
        );
        let along_one_line = || {
            let message = "two of right, up and front lie along one line; give each another axis";
            Error::new(darboux_status::Axes, message.into())
        };
        Ok(Convention {
            axes: axes.ok_or_else(along_one_line)?,
            winding: codes::winding(self.winding)?,
            uv_origin: codes::uv_origin(self.uv_origin)?,
            tangent: codes::tangent_direction(self.tangent)?,
            bitangent: codes::bitangent_direction(self.bitangent)?,
            sign: codes::sign_rule(self.sign)?,
        })
    }
}

impl From<Convention> for darboux_convention {
    fn from(convention: Convention) -> Self {
        let axis = |axis| match axis {
            Axis::X => AxisCode::X as u32,
            Axis::MinusX => AxisCode::MinusX as u32,
            Axis::Y => AxisCode::Y as u32,
            Axis::MinusY => AxisCode::MinusY as u32,
            Axis::Z => AxisCode::Z as u32,
            Axis::MinusZ => AxisCode::MinusZ as u32,
        };
        Self {
            size: size_of::<Self>(),
            right: axis(convention.axes.right()),
            up: axis(convention.axes.up()),
            front: axis(convention.axes.front()),
            winding: match convention.winding {
                Winding::CounterClockwise => WindingCode::CounterClockwise as u32,
                Winding::Clockwise => WindingCode::Clockwise as u32,
            },
            uv_origin: match convention.uv_origin {
                UvOrigin::TopLeft => UvOriginCode::TopLeft as u32,
                UvOrigin::BottomLeft => UvOriginCode::BottomLeft as u32,
            },
            tangent: match convention.tangent {
                TangentDirection::Right => TangentDirectionCode::Right as u32,
                TangentDirection::Left => TangentDirectionCode::Left as u32,
            },
            bitangent: match convention.bitangent {
                BitangentDirection::Up => BitangentDirectionCode::Up as u32,
                BitangentDirection::Down => BitangentDirectionCode::Down as u32,
            },
            sign: match convention.sign {
                SignRule::NormalCrossTangent => SignRuleCode::NormalCrossTangent as u32,
                SignRule::TangentCrossNormal => SignRuleCode::TangentCrossNormal as u32,
            },
        }
    }
}

/// Reads both conventions and returns the conversion.
///
/// # Safety
///
/// Each pointer is null or points to a valid [`darboux_convention`].
unsafe fn conversion(
    from: *const darboux_convention,
    to: *const darboux_convention,
) -> Result<Conversion, Error> {
    // SAFETY: the caller's promise.
    let (from, to) = unsafe { (pointers::read_or_zeros(from)?, pointers::read_or_zeros(to)?) };
    Ok(from.checked()?.to(to.checked()?))
}

/// Looks up the convention of a program.
///
/// `program`: the program. `convention`: receives its convention. Errors: an unknown program, a null pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_convention_of(
    program: darboux_program,
    convention: *mut darboux_convention,
) -> darboux_status {
    call(|| {
        // SAFETY: `convention` is null or writable.
        let out = unsafe { Receiver::new(convention) }?;
        out.put(codes::program(program)?.into());
        Ok(())
    })
}

/// Computes the convention of the tangents that darboux_generate_tangents writes for a mesh in a given
/// convention.
///
/// Axes, winding and UV origin stay. The sign can differ, because MikkTSpace takes it from the UV area and
/// does not consider the UV origin. For example, tangents generated for a glTF mesh become glTF tangents by
/// darboux_convert_tangents from the result of this function to glTF, which negates w. `convention`: the
/// mesh's convention; may be NULL for glTF. `generated`: receives the tangents' convention. Errors: those of
/// darboux_convert_vectors.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_convention_generated(
    convention: *const darboux_convention,
    generated: *mut darboux_convention,
) -> darboux_status {
    call(|| {
        // SAFETY: the pointers are as documented above.
        let (convention, out) = unsafe { (pointers::read_or_zeros(convention)?, Receiver::new(generated)?) };
        out.put(convention.checked()?.generated().into());
        Ok(())
    })
}

/// Converts positions, normals or offsets from one convention to another. Exact.
///
/// `from`, `to`: the conventions; NULL for glTF. `count`: the number of elements. `vectors`: `count` by 3
/// floats. `converted`: receives `count` by 3 floats; may equal `vectors`. Strides: bytes from one element to
/// the next; 0 for packed. Errors: an unknown value in a convention, two parallel axes, a null pointer, a
/// stride smaller than an element.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_convert_vectors(
    from: *const darboux_convention,
    to: *const darboux_convention,
    count: usize,
    vectors: *const f32,
    vector_stride: usize,
    converted: *mut f32,
    converted_stride: usize,
) -> darboux_status {
    // SAFETY: the pointers are as documented above.
    call(|| unsafe {
        let conversion = conversion(from, to)?;
        let vectors = copied("vectors", vectors.cast(), count, vector_stride)?;
        let out = Output::new("converted", converted.cast(), count, converted_stride)?;
        out.write(vectors.map(|vector| conversion.vector(vector)));
        Ok(())
    })
}

/// Converts tangents from one convention to another. Exact.
///
/// `tangents`: `count` by 4 floats, xyz and the sign w. Other parameters and errors: as for
/// darboux_convert_vectors.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_convert_tangents(
    from: *const darboux_convention,
    to: *const darboux_convention,
    count: usize,
    tangents: *const f32,
    tangent_stride: usize,
    converted: *mut f32,
    converted_stride: usize,
) -> darboux_status {
    // SAFETY: the pointers are as documented above.
    call(|| unsafe {
        let conversion = conversion(from, to)?;
        let tangents = copied("tangents", tangents.cast(), count, tangent_stride)?;
        let out = Output::new("converted", converted.cast(), count, converted_stride)?;
        out.write(tangents.map(|tangent| conversion.tangent(tangent)));
        Ok(())
    })
}

/// Converts UVs from one convention to another: v becomes 1 - v where the origins differ.
///
/// A round trip is exact for multiples of 2^-24 in [0, 1]; its error for other values is at most one ulp of
/// the larger of 1 and |v|. `uvs`: `count` by 2 floats. Other parameters and errors: as for
/// darboux_convert_vectors.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_convert_uvs(
    from: *const darboux_convention,
    to: *const darboux_convention,
    count: usize,
    uvs: *const f32,
    uv_stride: usize,
    converted: *mut f32,
    converted_stride: usize,
) -> darboux_status {
    // SAFETY: the pointers are as documented above.
    call(|| unsafe {
        let conversion = conversion(from, to)?;
        let uvs = copied("uvs", uvs.cast(), count, uv_stride)?;
        let out = Output::new("converted", converted.cast(), count, converted_stride)?;
        out.write(uvs.map(|uv| conversion.uv(uv)));
        Ok(())
    })
}

/// Reverses the corners of every face where the winding differs. The first corner of each face stays first.
///
/// A change of handedness alone reverses nothing, because the winding is defined as seen on the screen.
/// `from`, `to`: the conventions; NULL for glTF. `faces`, `face_sizes`, `face_count`: as in darboux_mesh.
/// `corners`: C packed elements of `corner_size` bytes, changed in place: the indices, or any other attribute
/// of corners. `corner_count`: C. `corner_size`: bytes per element. Errors: those of darboux_convert_vectors;
/// corners that do not make whole faces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_convert_faces(
    from: *const darboux_convention,
    to: *const darboux_convention,
    faces: darboux_faces,
    face_sizes: *const u32,
    face_count: usize,
    corners: *mut core::ffi::c_void,
    corner_count: usize,
    corner_size: usize,
) -> darboux_status {
    // SAFETY: the pointers are as documented above.
    call(|| unsafe {
        let conversion = conversion(from, to)?;
        let sizes = match codes::faces(faces)? {
            FacesCode::Triangles => FaceSizes::Equal(3),
            FacesCode::Quads => FaceSizes::Equal(4),
            FacesCode::Mixed => FaceSizes::Each(slice("face_sizes", face_sizes, face_count)?),
        };
        sizes.check(corner_count)?;
        let corners = pointers::bytes_mut("corners", corners.cast(), corner_count, corner_size)?;
        sizes.reverse(&conversion, corners, corner_size);
        Ok(())
    })
}

enum FaceSizes<'a> {
    Equal(usize),
    Each(&'a [u32]),
}

impl FaceSizes<'_> {
    fn check(&self, corners: usize) -> Result<(), Error> {
        let message = match *self {
            Self::Equal(size) if !corners.is_multiple_of(size) => {
                format!("{corners} corners do not make whole faces of {size}")
            }
            Self::Each(sizes) => {
                let sum: u128 = sizes.iter().map(|&size| u128::from(size)).sum();
                if sum == corners as u128 {
                    return Ok(());
                }
                format!("the face sizes add up to {sum} but there are {corners} corners")
            }
            Self::Equal(_) => return Ok(()),
        };
        Err(Error::new(darboux_status::Faces, message))
    }

    /// Reverses the corners of every face. `corners`: elements of `size` bytes, whose number
    /// [`FaceSizes::check`] accepted.
    fn reverse(&self, conversion: &Conversion, corners: &mut [u8], size: usize) {
        if corners.is_empty() {
            // Without corners, `size` may be 0 or huge.
            return;
        }
        let (mut order, mut old) = (Vec::new(), Vec::new());
        let mut reverse = |face: &mut [u8]| {
            order.clear();
            order.extend(0..face.len() / size);
            conversion.face(&mut order);
            old.clear();
            old.extend_from_slice(face);
            for (corner, &from) in face.chunks_exact_mut(size).zip(&order) {
                corner.copy_from_slice(&old[from * size..][..size]);
            }
        };
        match self {
            Self::Equal(count) => corners.chunks_exact_mut(count * size).for_each(reverse),
            Self::Each(sizes) => {
                let mut rest = corners;
                for &count in *sizes {
                    let (face, others) = rest.split_at_mut(count as usize * size);
                    reverse(face);
                    rest = others;
                }
            }
        }
    }
}

/// Tells which channels of a normal map are inverted: in every texel of n bits, c becomes 2^n - 1 - c.
///
/// `from`, `to`: the conventions; NULL for glTF. `red`, `green`: receive 1 where the channel is inverted,
/// else 0. Errors: those of darboux_convert_vectors.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_convert_channels(
    from: *const darboux_convention,
    to: *const darboux_convention,
    red: *mut u32,
    green: *mut u32,
) -> darboux_status {
    // SAFETY: the pointers are as documented above.
    call(|| unsafe {
        let conversion = conversion(from, to)?;
        let red = Output::new("red", red.cast(), 1, 0)?;
        let green = Output::new("green", green.cast(), 1, 0)?;
        red.copy(&[u32::from(conversion.inverts_red())]);
        green.copy(&[u32::from(conversion.inverts_green())]);
        Ok(())
    })
}
