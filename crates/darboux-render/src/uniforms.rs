//! The uniforms and the per-instance data of the shaders, in their memory layout.

use bytemuck::{Pod, Zeroable};
use darboux_io::gltf::{Alpha, Material, TextureUse};

use crate::algebra::{IDENTITY, Matrix, direction_columns};
use crate::camera::ViewTransform;
use crate::drawing::{Drawing, Side};
use crate::ground::Ground;
use crate::heat::HeatScale;
use crate::material_textures::{TEXTURES, textures_of};
use crate::options::{SIGN_COLORS, View};
use crate::studio::{LAMPS, Studio};
use crate::subject::Subject;

/// Lines are one pixel wide per this many pixels of the shorter side of the picture, and at least one pixel.
const PICTURE_PIXELS_PER_LINE_PIXEL: f32 = 500.0;

/// `Picture` of surface.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct PictureUniforms {
    projection: [[f32; 4]; 4],
    rotation: [[f32; 4]; 3],
    distance: f32,
    view: u32,
    heat_ends: [f32; 2],
    ramp: [[f32; 4]; 9],
    flip: [f32; 4],
    no_angle: [f32; 4],
    signs: [[f32; 4]; 2],
    /// The direction to the light in eye space, and its intensity.
    light: [f32; 4],
    /// The directions to the lamps in eye space, and their sharpness.
    lamps: [[f32; 4]; LAMPS],
    lamp_radiance: [[f32; 4]; LAMPS],
    w_factor: f32,
    green_factor: f32,
    is_v_flipped: u32,
    is_derived: u32,
    is_layout: u32,
    has_wrong_columns: u32,
    room: f32,
    padding: u32,
}

/// `Lines` of lines.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct LineUniforms {
    projection: [[f32; 4]; 4],
    pixel: [f32; 2],
    distance: f32,
    half_width: f32,
}

/// `Ground` of ground.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct GroundUniforms {
    projection: [[f32; 4]; 4],
    corners: [[f32; 4]; 4],
    background: [f32; 4],
}

/// `Material` of surface.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct MaterialUniforms {
    base_color: [f32; 4],
    /// The images of the u and v axes under the transform of each texture.
    axes: [[f32; 4]; TEXTURES],
    /// The images of the origin; two floats each are not used.
    origins: [[f32; 4]; TEXTURES],
    emission: [f32; 3],
    normal_scale: f32,
    metallic: f32,
    roughness: f32,
    occlusion: f32,
    alpha_cutoff: f32,
    is_unlit: u32,
    has_normal_map: u32,
    has_bumps: u32,
    padding: u32,
}

/// `Instance` of surface.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Instance {
    to_eye: [[f32; 4]; 4],
    directions: [[f32; 3]; 3],
}

impl PictureUniforms {
    pub fn of(drawing: &Drawing<'_>, side: &Side<'_>) -> Self {
        let HeatScale { ends, ramp, flip, none } = &drawing.options.heat;
        let color = |[r, g, b]: [u8; 3]| [r, g, b, 255].map(|channel| f32::from(channel) / 255.0);
        let rotation = [0, 1, 2].map(|column| {
            let [x, y, z] = drawing.transform.rotation.map(|row| row[column] as f32);
            [x, y, z, 0.0]
        });
        let studio = Studio::get();
        // With a camera of the viewer's, the studio stands as the viewer has it.
        let yaw = drawing.options.look.map_or(drawing.options.camera.yaw, |_| studio.camera_yaw);
        let lamps = studio.lamps(yaw);
        let in_eye_space = |direction, last: f32| {
            let [x, y, z] = drawing.transform.direction(direction).map(|x| x as f32);
            [x, y, z, last]
        };
        let factor = |is_negated| if is_negated { -1.0 } else { 1.0 };
        Self {
            projection: drawing.transform.projection,
            rotation,
            distance: drawing.transform.distance as f32,
            view: drawing.view() as u32,
            heat_ends: *ends,
            ramp: ramp.map(color),
            flip: color(*flip),
            no_angle: color(*none),
            signs: SIGN_COLORS.map(color),
            light: in_eye_space(studio.light_direction(yaw), studio.light.intensity),
            lamps: lamps.each_ref().map(|lamp| in_eye_space(lamp.towards, lamp.sharpness)),
            lamp_radiance: lamps.map(|lamp| [lamp.radiance, 0.0, 0.0, 0.0]),
            w_factor: factor(side.mistakes.w),
            green_factor: factor(side.mistakes.green),
            is_v_flipped: side.mistakes.v.into(),
            is_derived: side.model.is_derived.into(),
            is_layout: (drawing.subject == Subject::UvLayout).into(),
            has_wrong_columns: side.mistakes.columns.into(),
            room: studio.room(),
            padding: 0,
        }
    }
}

impl LineUniforms {
    pub fn of(transform: &ViewTransform, size: [u32; 2]) -> Self {
        let [width, height] = size.map(|side| side as f32);
        Self {
            projection: transform.projection,
            pixel: [2.0 / width, 2.0 / height],
            distance: transform.distance as f32,
            half_width: 0.5 * (width.min(height) / PICTURE_PIXELS_PER_LINE_PIXEL).max(1.0),
        }
    }
}

impl GroundUniforms {
    /// `background`: the linear colour behind the model.
    pub fn of(ground: &Ground, transform: &ViewTransform, background: [f64; 3]) -> Self {
        let Ground { middle: [x, height, z], half_side, .. } = *ground;
        let square = [[half_side, 0.0, 0.0, 0.0], [0.0; 4], [0.0, 0.0, half_side, 0.0], [x, height, z, 1.0]];
        let corners = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]].map(|[x, z]| {
            let [x, y, z] = transform.point(&square, [x, 0.0, z]).map(|x| x as f32);
            [x, y, z, 1.0]
        });
        let [r, g, b] = background.map(|channel| channel as f32);
        Self { projection: transform.projection, corners, background: [r, g, b, 1.0] }
    }
}

impl MaterialUniforms {
    pub fn of(material: &Material, has_normal_map: bool, view: View) -> Self {
        let transforms = textures_of(material).map(|(used, _)| axes(used));
        Self {
            base_color: material.base_color,
            axes: transforms.map(|(axes, _)| axes),
            origins: transforms.map(|(_, [u, v])| [u, v, 0.0, 0.0]),
            emission: material.emission,
            normal_scale: material.normal_scale,
            metallic: material.metallic,
            roughness: material.roughness,
            occlusion: material.occlusion_strength,
            is_unlit: material.is_unlit.into(),
            has_bumps: (view == View::TestBumps && !material.is_anisotropic).into(),
            alpha_cutoff: match material.alpha {
                Alpha::Opaque => -1.0,
                Alpha::Mask(cutoff) => cutoff.clamp(0.0, 1.0),
                Alpha::Blend => 2.0,
            },
            has_normal_map: has_normal_map.into(),
            padding: 0,
        }
    }
}

impl Instance {
    pub fn of(matrix: &Matrix, transform: &ViewTransform, subject: Subject) -> Self {
        Self {
            to_eye: transform.to_eye(if subject == Subject::UvLayout { &IDENTITY } else { matrix }),
            directions: direction_columns(matrix),
        }
    }
}

/// The texture transform of a material: the images of the u and v axes, and of the origin.
fn axes(used: Option<&TextureUse>) -> ([f32; 4], [f32; 2]) {
    let transformed = |uv| used.map_or(uv, |used| used.transform_uv(uv));
    let [origin, [ux, uy], [vx, vy]] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(transformed);
    ([ux - origin[0], uy - origin[1], vx - origin[0], vy - origin[1]], origin)
}
