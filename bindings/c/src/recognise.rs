//! Verdicts in C: whose convention a normal map has, and how tangents were computed.

use std::mem::offset_of;

use darboux::{
    Channel, Choice, MapJudgement, NormalMapJudge, RecipeMatch, TexelLayout, recognise_recipe_with,
};

use crate::codes::{darboux_map_verdict, darboux_method, darboux_mode, darboux_recipe_writing};
use crate::context::{self, Memory, darboux_context};
use crate::mesh::{self, darboux_mesh};
use crate::pointers::{self, Output, Receiver, Versioned, gathered_of_corners};
use crate::status::{Error, call, darboux_status};

/// The verdict on a normal map and the counts behind it. Counts leave out black, white and middle grey
/// texels.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_map_judgement {
    /// sizeof(darboux_map_judgement), set by the caller. 0: the size in version 0.1.
    pub size: usize,
    /// The verdict.
    pub verdict: darboux_map_verdict,
    /// For OPENGL and DIRECTX an estimate of the probability that the verdict is right, 0.5 to 0.999.
    pub confidence: f32,
    /// The correlation of the mixed derivatives, from -1 (DirectX) to 1 (OpenGL).
    pub correlation: f32,
    /// The correlation in units of its standard error.
    pub z_score: f32,
    /// Half the logarithm of the unmixed derivatives' energy over that of the mixed ones. Negative where red
    /// and green are exchanged.
    pub log_energy_ratio: f32,
    /// The mean length of the vectors.
    pub mean_length: f32,
    /// All texels.
    pub texels: usize,
    /// Black, white and middle grey texels, and those with z = 0 whose x and y are beyond the unit circle.
    pub background: usize,
    /// Texels whose length is not in [0.9, 1.1].
    pub not_unit: usize,
    /// Texels with z below -1/100; 0 for two channels.
    pub negative_z: usize,
    /// Texels whose three channels are nearly equal; 0 for two channels.
    pub grey: usize,
    /// Texels that cannot be normals.
    pub not_normal: usize,
}

// SAFETY: `repr(C)`, the size is the first field, all fields are numbers.
unsafe impl Versioned for darboux_map_judgement {
    const NAME: &str = "darboux_map_judgement";
    const FIRST_SIZE: usize = pointers::size_through::<Self, usize>(offset_of!(Self, not_normal));
}

impl From<MapJudgement> for darboux_map_judgement {
    fn from(judgement: MapJudgement) -> Self {
        Self {
            size: size_of::<Self>(),
            verdict: judgement.verdict.code(),
            confidence: judgement.confidence,
            correlation: judgement.correlation,
            z_score: judgement.z_score,
            log_energy_ratio: judgement.log_energy_ratio,
            mean_length: judgement.mean_length,
            texels: judgement.texels,
            background: judgement.background,
            not_unit: judgement.not_unit,
            negative_z: judgement.negative_z,
            grey: judgement.grey,
            not_normal: judgement.not_normal,
        }
    }
}

/// How well a way of computing tangents explains given ones.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_recipe_match {
    /// The method.
    pub method: darboux_method,
    /// The mode of MikkTSpace; 0 for other methods.
    pub mode: darboux_mode,
    /// 1 where the tangents were computed with 1 - v and the sign negated, else 0.
    pub flips_v: u32,
    /// How corners share the tangents of vertices.
    pub writing: darboux_recipe_writing,
    /// Bits per component: 32 (floats), 16 or 8 (signed normalised integers).
    pub bits: u32,
    /// 1 where the tangents were computed before quads were cut into triangles, as Unity and other importers
    /// do, else 0. Which triangles were quads is an estimate from their shapes.
    pub from_quads: u32,
    /// The number of corners.
    pub corners: usize,
    /// Corners whose four components are equal after rounding.
    pub identical: usize,
    /// Corners within 0.1 degrees (1 degree for 8 bits) and with equal signs.
    pub close: usize,
    /// Corners whose signs differ.
    pub sign_flips: usize,
    /// The largest angle in degrees.
    pub worst: f64,
}

impl From<&RecipeMatch> for darboux_recipe_match {
    fn from(found: &RecipeMatch) -> Self {
        Self {
            method: found.recipe.method.code(),
            mode: found.recipe.mode().map_or(0, Choice::code),
            flips_v: found.recipe.flips_v.into(),
            writing: found.recipe.writing.code(),
            bits: found.recipe.rounding.bits(),
            from_quads: found.recipe.from_quads.into(),
            corners: found.corners,
            identical: found.identical,
            close: found.close,
            sign_flips: found.sign_flips,
            worst: found.worst,
        }
    }
}

/// Judges a normal map by its texels: whether green points up (OpenGL) or down (DirectX), and whether they
/// are normals at all.
///
/// `texels`: `height` rows of `width` texels, the top row first; each texel has `channels` channels of `bits`
/// bits. `bits`: 8 or 16 (native byte order, aligned). `channels`: 2 (x, y), 3 (x, y, z) or 4 (x, y, z,
/// ignored). `row_stride`: bytes from one row to the next; 0 for packed. `judgement`: receives the verdict.
/// Errors: a null pointer, other `bits` or `channels`, alignment, a stride smaller than a row.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_judge_normal_map(
    texels: *const u8,
    bits: u32,
    channels: u32,
    width: usize,
    height: usize,
    row_stride: usize,
    judgement: *mut darboux_map_judgement,
) -> darboux_status {
    call(|| {
        // SAFETY: the pointer is as documented above.
        let out = unsafe { Receiver::new(judgement) }?;
        let size = [width, height];
        // SAFETY: the pointers are as documented above.
        let found = unsafe {
            match (bits, channels) {
                (8, 2) => judged::<u8, 2>(texels, size, row_stride, TexelLayout::RG),
                (8, 3) => judged::<u8, 3>(texels, size, row_stride, TexelLayout::RGB),
                (8, 4) => judged::<u8, 4>(texels, size, row_stride, TexelLayout::RGBA),
                (16, 2) => judged::<u16, 2>(texels, size, row_stride, TexelLayout::RG),
                (16, 3) => judged::<u16, 3>(texels, size, row_stride, TexelLayout::RGB),
                (16, 4) => judged::<u16, 4>(texels, size, row_stride, TexelLayout::RGBA),
                _ => {
                    let message =
                        format!("{channels} channels of {bits} bits; give 2 to 4 channels of 8 or 16 bits");
                    Err(Error::new(darboux_status::UnknownValue, message))
                }
            }
        }?;
        out.put(found.into());
        Ok(())
    })
}

/// Judges the rows of a map.
///
/// # Safety
///
/// `texels` points to the rows, which do not change during the call.
unsafe fn judged<C: Channel, const N: usize>(
    texels: *const u8,
    [width, height]: [usize; 2],
    row_stride: usize,
    layout: TexelLayout<N>,
) -> Result<MapJudgement, Error> {
    // SAFETY: the caller's promise.
    let rows = unsafe { pointers::row_slices::<[C; N]>("texels", texels, height, width, row_stride) }?;
    // Without rows a width promises nothing, and must allocate nothing.
    let mut judge = NormalMapJudge::new(if height == 0 { 0 } else { width }, layout);
    rows.into_iter().try_for_each(|row| judge.push_row(row))?;
    Ok(judge.judgement())
}

/// Ranks the ways in which the tangents of a mesh could have been computed, the best one first.
///
/// `mesh`: normals and UVs are required. `tangents`: C by 4 floats, with the sign that
/// darboux_generate_tangents gives. `tangent_count`: C. `tangent_stride`: bytes from one tangent to the next;
/// 0 for packed. `context`: threads and a cancellation flag; NULL for the calling thread alone. `matches`:
/// receives the best matches, at most `capacity`. `match_count`: receives the number of matches that exist,
/// which may be larger; may be NULL. Errors: those of the mesh; another number of tangents than corners.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_recognise_recipe(
    mesh: *const darboux_mesh,
    tangents: *const f32,
    tangent_count: usize,
    tangent_stride: usize,
    context: *const darboux_context,
    matches: *mut darboux_recipe_match,
    capacity: usize,
    match_count: *mut usize,
) -> darboux_status {
    call(|| {
        // SAFETY: the pointers are as documented above.
        let (mesh, out, context, tangents) = unsafe {
            let mesh = mesh::view(mesh)?;
            let corners = mesh.corner_count();
            let tangents =
                gathered_of_corners(corners, "tangents", tangents.cast(), tangent_count, tangent_stride)?;
            let out: Output<darboux_recipe_match> = Output::new("matches", matches.cast(), capacity, 0)?;
            (mesh, out, context.as_ref(), tangents)
        };
        let run = |memory: &mut Memory| recognise_recipe_with(&mesh, &tangents, &mut memory.context);
        let found = context::run(context, mesh.corner_count(), run)?;
        out.write(found.iter().map(darboux_recipe_match::from));
        // SAFETY: the pointer is as documented above.
        unsafe { pointers::put(match_count, found.len()) };
        Ok(())
    })
}
