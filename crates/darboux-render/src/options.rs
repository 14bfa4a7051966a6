//! The options of [`render`](crate::render::render).

use crate::camera::Camera;
use crate::heat::HeatScale;

/// What the surface is coloured with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// The lit surface with its normal map. The light comes from the upper right.
    Shaded,
    /// The tangent in the directions of the scene. A component x has the colour 0.5 + 0.5 x.
    Tangent,
    /// The bitangent, coloured as the tangent.
    Bitangent,
    /// The normal of the mesh, coloured as the tangent.
    Normal,
    /// The sign w of the tangent.
    Sign,
    /// The angle to the tangents that the model is compared with.
    Angle,
}

/// The sRGB colours of the signs w = 1 and w = -1. The viewer uses the same.
pub const SIGN_COLORS: [[u8; 3]; 2] = [[61, 139, 217], [232, 135, 58]];

/// The sRGB colours of lines along tangents, bitangents and normals. The viewer uses the same.
pub const LINE_COLORS: [[u8; 3]; 3] = [[255, 77, 77], [77, 210, 77], [92, 140, 255]];

/// The sRGB colour of mirrored edges.
pub const SEAM_COLOR: [u8; 3] = [255, 77, 216];

/// Common mistakes, which are made on purpose to show their effect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mistakes {
    /// Negates the green channel of normal maps.
    pub green: bool,
    /// Negates the sign of tangents.
    pub w: bool,
    /// Samples images at 1 - v.
    pub v: bool,
}

/// The vectors that are drawn as lines at every vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lines {
    /// Draws tangents.
    pub tangent: bool,
    /// Draws bitangents.
    pub bitangent: bool,
    /// Draws normals.
    pub normal: bool,
    /// The length of a line, as a fraction of the model's radius.
    pub length: f64,
}

/// Where the UV layout is drawn. Its u axis points right, its v axis down. Overlapping triangles are translucent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayoutPlacement {
    /// Over the lower right corner of the picture, in a square of half its shorter side.
    Corner,
    /// Instead of the model.
    Alone,
}

/// How a picture is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderOptions {
    /// What the surface is coloured with.
    pub view: View,
    /// The vectors that are drawn as lines.
    pub lines: Lines,
    /// Whether mirrored edges are drawn: edges between triangles whose tangents have different signs.
    pub seams: bool,
    /// Where the UV layout is drawn, if it is. It has the colours of the view, or of [`View::Sign`] if the view is [`View::Shaded`].
    pub layout: Option<LayoutPlacement>,
    /// The width and height in pixels.
    pub size: [u32; 2],
    /// The position of the camera.
    pub camera: Camera,
    /// The sRGB colour of the background.
    pub background: [u8; 3],
    /// The colours of [`View::Angle`].
    pub heat: HeatScale,
}
