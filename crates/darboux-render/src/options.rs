//! The options of [`render`](crate::render::render).

use crate::camera::{Camera, Look};
use crate::heat::HeatScale;

/// What the surface is coloured with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum View {
    /// The lit surface with its materials, in the studio of the viewer. The light comes from the upper right
    /// of the camera.
    Shaded,
    /// The same with a pattern of bumps on materials without a normal map that are not anisotropic. It is not
    /// in the file.
    TestBumps,
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

impl View {
    /// Whether the surface is lit, instead of showing frames as colours.
    pub fn is_lit(self) -> bool {
        matches!(self, Self::Shaded | Self::TestBumps)
    }
}

/// The sRGB colours of the signs w = 1 and w = -1. The viewer uses the same.
pub const SIGN_COLORS: [[u8; 3]; 2] = [[61, 139, 217], [232, 135, 58]];

/// The sRGB colours of lines along tangents, bitangents and normals. The viewer uses the same.
pub const LINE_COLORS: [[u8; 3]; 3] = [[255, 77, 77], [77, 210, 77], [92, 140, 255]];

/// The dashes of these lines, which tell them apart without their colours. The viewer draws the same.
pub const LINE_DASHES: [u32; 3] = [1, 3, 2];

/// The sRGB colour of mirrored edges.
pub const SEAM_COLOR: [u8; 3] = [255, 77, 216];

/// Common mistakes, which are made on purpose to show their effect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Mistakes {
    /// Negates the green channel of normal maps.
    pub green: bool,
    /// Negates the sign of tangents.
    pub w: bool,
    /// Samples images at 1 - v.
    pub v: bool,
    /// Takes the columns of the matrix in the order tangent, normal, bitangent.
    pub columns: bool,
}

impl Mistakes {
    /// These mistakes, with or without a negated green channel.
    #[must_use]
    pub fn with_green(self, green: bool) -> Self {
        Self { green, ..self }
    }

    /// These mistakes, with or without a negated sign.
    #[must_use]
    pub fn with_w(self, w: bool) -> Self {
        Self { w, ..self }
    }

    /// These mistakes, with or without images sampled at 1 - v.
    #[must_use]
    pub fn with_v(self, v: bool) -> Self {
        Self { v, ..self }
    }

    /// These mistakes, with the columns of the matrix in the order tangent, normal, bitangent, or not.
    #[must_use]
    pub fn with_columns(self, columns: bool) -> Self {
        Self { columns, ..self }
    }
}

/// The vectors that are drawn as lines at every vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
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

impl Lines {
    /// These lines, with or without tangents.
    #[must_use]
    pub fn with_tangent(self, tangent: bool) -> Self {
        Self { tangent, ..self }
    }

    /// These lines, with or without bitangents.
    #[must_use]
    pub fn with_bitangent(self, bitangent: bool) -> Self {
        Self { bitangent, ..self }
    }

    /// These lines, with or without normals.
    #[must_use]
    pub fn with_normal(self, normal: bool) -> Self {
        Self { normal, ..self }
    }

    /// These lines with another length, as a fraction of the model's radius.
    #[must_use]
    pub fn with_length(self, length: f64) -> Self {
        Self { length, ..self }
    }
}

/// Where the UV layout is drawn. Its u axis points right, its v axis down. Overlapping triangles are
/// translucent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LayoutPlacement {
    /// Over the lower right corner of the picture, in a square of half its shorter side.
    Corner,
    /// Instead of the model.
    Alone,
}

/// How a picture is drawn.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RenderOptions {
    /// What the surface is coloured with.
    pub view: View,
    /// The vectors that are drawn as lines.
    pub lines: Lines,
    /// Whether mirrored edges are drawn: edges between triangles whose tangents have different signs.
    pub seams: bool,
    /// Whether a lit model stands on the ground, which shows its shadow and is not seen from below. Models
    /// that are too large for a ground have none, with a warning.
    pub ground: bool,
    /// Where the UV layout is drawn, if it is. It has the colours of the view, or of [`View::Sign`] if the
    /// view is lit.
    pub layout: Option<LayoutPlacement>,
    /// The width and height in pixels.
    pub size: [u32; 2],
    /// The position of the camera.
    pub camera: Camera,
    /// A camera in place of that one. With it, the studio stands as in the viewer and does not turn.
    pub look: Option<Look>,
    /// The sRGB colour of the background.
    pub background: [u8; 3],
    /// The colours of [`View::Angle`].
    pub heat: HeatScale,
}

impl RenderOptions {
    /// A view of the model from the default camera over black, without lines, mirrored edges, ground or UV
    /// layout.
    ///
    /// `size`: the width and height in pixels. `heat`: the colours of [`View::Angle`].
    pub fn new(view: View, size: [u32; 2], heat: HeatScale) -> Self {
        Self {
            view,
            lines: Lines::default(),
            seams: false,
            ground: false,
            layout: None,
            size,
            camera: Camera::default(),
            look: None,
            background: [0; 3],
            heat,
        }
    }

    /// These options with another view.
    #[must_use]
    pub fn with_view(self, view: View) -> Self {
        Self { view, ..self }
    }

    /// These options with other lines.
    #[must_use]
    pub fn with_lines(self, lines: Lines) -> Self {
        Self { lines, ..self }
    }

    /// These options with mirrored edges drawn, or not.
    #[must_use]
    pub fn with_seams(self, seams: bool) -> Self {
        Self { seams, ..self }
    }

    /// These options with a ground below lit models, or not.
    #[must_use]
    pub fn with_ground(self, ground: bool) -> Self {
        Self { ground, ..self }
    }

    /// These options with the UV layout at another place, or without it.
    #[must_use]
    pub fn with_layout(self, layout: Option<LayoutPlacement>) -> Self {
        Self { layout, ..self }
    }

    /// These options with another width and height in pixels.
    #[must_use]
    pub fn with_size(self, size: [u32; 2]) -> Self {
        Self { size, ..self }
    }

    /// These options with another camera.
    #[must_use]
    pub fn with_camera(self, camera: Camera) -> Self {
        Self { camera, ..self }
    }

    /// These options with a camera at a point of the scene, or without it.
    #[must_use]
    pub fn with_look(self, look: Option<Look>) -> Self {
        Self { look, ..self }
    }

    /// These options with another background, in sRGB.
    #[must_use]
    pub fn with_background(self, background: [u8; 3]) -> Self {
        Self { background, ..self }
    }

    /// These options with other colours of [`View::Angle`].
    #[must_use]
    pub fn with_heat(self, heat: HeatScale) -> Self {
        Self { heat, ..self }
    }
}
