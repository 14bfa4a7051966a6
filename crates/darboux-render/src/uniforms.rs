//! What the shaders are told, as they take it.

use bytemuck::{Pod, Zeroable};
use darboux_io::gltf::{Alpha, Appearance, TextureUse};

use crate::algebra::{IDENTITY, Matrix, direction_columns};
use crate::camera::Sight;
use crate::painter::{Shape, Show};
use crate::{HeatScale, SIGN_COLORS, Side};

/// Pixels along a picture's shorter side for one of a line's width, which is at least one.
const PIXELS_PER_WIDTH: f32 = 500.0;

/// The uniforms of draw.wgsl's `Picture`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct PictureUniforms {
    projection: [[f32; 4]; 4],
    turn: [[f32; 4]; 3],
    distance: f32,
    view: u32,
    heat_ends: [f32; 2],
    ramp: [[f32; 4]; 9],
    flip: [f32; 4],
    none: [f32; 4],
    signs: [[f32; 4]; 2],
    w_side: f32,
    green_side: f32,
    is_v_flipped: u32,
    is_derived: u32,
    is_flat: u32,
    unused: [u32; 3],
}

/// The uniforms of strokes.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct StrokesUniforms {
    projection: [[f32; 4]; 4],
    pixel: [f32; 2],
    distance: f32,
    half_width: f32,
}

/// The uniforms of draw.wgsl's `Material`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct MaterialUniforms {
    base_color: [f32; 4],
    base_axes: [f32; 4],
    normal_axes: [f32; 4],
    origins: [[f32; 2]; 2],
    normal_scale: f32,
    alpha_cutoff: f32,
    has_normal_map: u32,
    unused: u32,
}

/// draw.wgsl's `Place`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Place {
    eye: [[f32; 4]; 4],
    directions: [[f32; 3]; 3],
}

impl PictureUniforms {
    pub fn of(show: &Show<'_>, side: &Side<'_>) -> Self {
        let HeatScale { ends, ramp, flip, none } = &show.options.heat;
        let color = |[r, g, b]: [u8; 3]| [r, g, b, 255].map(|channel| f32::from(channel) / 255.0);
        let turn = [0, 1, 2].map(|column| {
            let [x, y, z] = show.sight.turn.map(|row| row[column] as f32);
            [x, y, z, 0.0]
        });
        let flipped = |is_flipped| if is_flipped { -1.0 } else { 1.0 };
        Self {
            projection: show.sight.projection,
            turn,
            distance: show.sight.distance as f32,
            view: show.view() as u32,
            heat_ends: *ends,
            ramp: ramp.map(color),
            flip: color(*flip),
            none: color(*none),
            signs: SIGN_COLORS.map(color),
            w_side: flipped(side.mistakes.w),
            green_side: flipped(side.mistakes.green),
            is_v_flipped: side.mistakes.v.into(),
            is_derived: side.model.is_derived.into(),
            is_flat: (show.shape == Shape::Layout).into(),
            unused: [0; 3],
        }
    }
}

impl StrokesUniforms {
    pub fn of(sight: &Sight, size: [u32; 2]) -> Self {
        let [width, height] = size.map(|side| side as f32);
        Self {
            projection: sight.projection,
            pixel: [2.0 / width, 2.0 / height],
            distance: sight.distance as f32,
            half_width: 0.5 * (width.min(height) / PIXELS_PER_WIDTH).max(1.0),
        }
    }
}

impl MaterialUniforms {
    pub fn of(appearance: &Appearance, has_normal_map: bool) -> Self {
        let (base_axes, base_origin) = axes(appearance.base_texture.as_ref());
        let (normal_axes, normal_origin) = axes(appearance.normal_texture.as_ref());
        Self {
            base_color: appearance.base_color,
            base_axes,
            normal_axes,
            origins: [base_origin, normal_origin],
            normal_scale: appearance.normal_scale,
            alpha_cutoff: match appearance.alpha {
                Alpha::Opaque => -1.0,
                Alpha::Mask(cutoff) => cutoff.clamp(0.0, 1.0),
                Alpha::Blend => 2.0,
            },
            has_normal_map: has_normal_map.into(),
            unused: 0,
        }
    }
}

impl Place {
    pub fn of(matrix: &Matrix, sight: &Sight, shape: Shape) -> Self {
        Self {
            eye: sight.to_eye(if shape == Shape::Layout { &IDENTITY } else { matrix }),
            directions: direction_columns(matrix),
        }
    }
}

/// Where u and v are taken on an image, and where its origin is.
fn axes(used: Option<&TextureUse>) -> ([f32; 4], [f32; 2]) {
    let place = |uv| used.map_or(uv, |used| used.place(uv));
    let [origin, [ux, uy], [vx, vy]] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(place);
    ([ux - origin[0], uy - origin[1], vx - origin[0], vy - origin[1]], origin)
}
