//! What numbers mean, and the change from one meaning to another.

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

/// What the numbers of a mesh and of its normal map mean. All zeros, and a null pointer, are glTF's convention.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_convention {
    /// sizeof(darboux_convention), or 0, which stands for version 0.1's size.
    pub size: usize,
    /// Where a model's own right hand points. Right, up and front are three different axes.
    pub right: darboux_axis,
    /// Where its head points.
    pub up: darboux_axis,
    /// Where it looks.
    pub front: darboux_axis,
    /// How fronts of faces are wound.
    pub winding: darboux_winding,
    /// Where v = 0 is.
    pub uv_origin: darboux_uv_origin,
    /// Where tangents, and red, point.
    pub tangent: darboux_tangent_direction,
    /// Where bitangents, and green, point.
    pub bitangent: darboux_bitangent_direction,
    /// What w means.
    pub sign: darboux_sign_rule,
}

// SAFETY: `repr(C)`, the size first, numbers.
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

/// # Safety
///
/// The pointers are as [`darboux_convention`] says, or null.
unsafe fn conversion(
    from: *const darboux_convention,
    to: *const darboux_convention,
) -> Result<Conversion, Error> {
    // SAFETY: as of this function.
    let (from, to) = unsafe { (pointers::read_or_zeros(from)?, pointers::read_or_zeros(to)?) };
    Ok(from.checked()?.to(to.checked()?))
}

/// Looks up a program's convention.
///
/// `program`: whose. `convention`: receives it. Errors: an unknown program, null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_convention_of(
    program: darboux_program,
    convention: *mut darboux_convention,
) -> darboux_status {
    call(|| {
        // SAFETY: `convention` is null or may be written.
        let out = unsafe { Receiver::new(convention) }?;
        out.put(codes::program(program)?.into());
        Ok(())
    })
}

/// Tells in which convention darboux_generate_tangents writes tangents for a mesh in a convention: this one but for the frames.
///
/// MikkTSpace knows no pictures; its sign is that of the UV area. So tangents for glTF, whose v runs down, are converted from what this
/// gives for glTF to glTF, which negates w. `convention`: the mesh's. `generated`: receives the result. Errors: those of a convention; null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_convention_generated(
    convention: *const darboux_convention,
    generated: *mut darboux_convention,
) -> darboux_status {
    call(|| {
        // SAFETY: every pointer is as the documentation above says.
        let (convention, out) = unsafe { (pointers::read_or_zeros(convention)?, Receiver::new(generated)?) };
        out.put(convention.checked()?.generated().into());
        Ok(())
    })
}

/// Writes positions, normals or offsets in another convention. Exact.
///
/// `from`, `to`: the conventions. `count`: the number of elements. `vectors`: `count` by 3. `converted`: room for as many; it may be
/// `vectors`. Each stride: bytes from one element to the next, 0 for packed.
/// Errors: an unknown number in a convention, two axes along one line; null, a stride that is too small.
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
    // SAFETY: every pointer is as the documentation above says.
    call(|| unsafe {
        let conversion = conversion(from, to)?;
        let vectors = copied("vectors", vectors.cast(), count, vector_stride)?;
        let out = Output::new("converted", converted.cast(), count, converted_stride)?;
        out.write(vectors.map(|vector| conversion.vector(vector)));
        Ok(())
    })
}

/// Writes tangents in another convention. Exact.
///
/// `tangents`: `count` by 4, xyz and the sign w. Other parameters and errors as for darboux_convert_vectors.
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
    // SAFETY: every pointer is as the documentation above says.
    call(|| unsafe {
        let conversion = conversion(from, to)?;
        let tangents = copied("tangents", tangents.cast(), count, tangent_stride)?;
        let out = Output::new("converted", converted.cast(), count, converted_stride)?;
        out.write(tangents.map(|tangent| conversion.tangent(tangent)));
        Ok(())
    })
}

/// Writes UVs in another convention: v becomes 1 - v where the origins differ.
///
/// There and back is exact for multiples of 2^-24 in [0, 1], otherwise off by up to the spacing of floats at the larger of 1 and |v|.
/// `uvs`: `count` by 2. Other parameters and errors as for darboux_convert_vectors.
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
    // SAFETY: every pointer is as the documentation above says.
    call(|| unsafe {
        let conversion = conversion(from, to)?;
        let uvs = copied("uvs", uvs.cast(), count, uv_stride)?;
        let out = Output::new("converted", converted.cast(), count, converted_stride)?;
        out.write(uvs.map(|uv| conversion.uv(uv)));
        Ok(())
    })
}

/// Reverses the corners of every face where fronts are wound the other way; the first of each stays. The eye decides: a change of
/// hands alone reverses nothing.
///
/// `from`, `to`: the conventions. `faces`, `face_sizes`, `face_count`: as in darboux_mesh. `corners`: C elements of `corner_size` bytes,
/// packed, changed in place: the indices, or whatever else lies along the corners. `corner_count`: C.
/// Errors: those of darboux_convert_vectors; corners that do not make whole faces.
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
    // SAFETY: every pointer is as the documentation above says.
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

    /// `corners` are as many as was checked, of `size` bytes each.
    fn reverse(&self, conversion: &Conversion, corners: &mut [u8], size: usize) {
        if corners.is_empty() {
            // Their size may be anything.
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

/// Tells which channels of a normal map lean the other way: where they do, c becomes 2^n - 1 - c in every texel of n bits.
///
/// `from`, `to`: the conventions. `red`, `green`: receive 1 or 0. Errors: those of darboux_convert_vectors.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_convert_channels(
    from: *const darboux_convention,
    to: *const darboux_convention,
    red: *mut u32,
    green: *mut u32,
) -> darboux_status {
    // SAFETY: every pointer is as the documentation above says.
    call(|| unsafe {
        let conversion = conversion(from, to)?;
        let red = Output::new("red", red.cast(), 1, 0)?;
        let green = Output::new("green", green.cast(), 1, 0)?;
        red.copy(&[u32::from(conversion.inverts_red())]);
        green.copy(&[u32::from(conversion.inverts_green())]);
        Ok(())
    })
}
