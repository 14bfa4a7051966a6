//! The vertices of both shaders, in the layout of their vertex buffers.

use bytemuck::{Pod, Zeroable};

/// A corner of a triangle: `Corner` of surface.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct SurfaceVertex {
    pub position: [f32; 3],
    pub normal: [f32; 3],
    /// Zero if there is none.
    pub tangent: [f32; 4],
    /// The UVs of the material's textures in the order of
    /// [`textures_of`](crate::material_textures::textures_of), as stored in the file.
    pub uvs: [[f32; 2]; 5],
    /// The colour that multiplies the base colour, in linear light.
    pub color: [f32; 4],
    /// The angle to the compared tangent, [`FLIP`](crate::heat::FLIP) or
    /// [`NO_ANGLE`](crate::heat::NO_ANGLE).
    pub degrees: f32,
}

/// A line in eye space: `Segment` of lines.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Segment {
    pub ends: [[f32; 3]; 2],
    pub color: [f32; 3],
}
