//! [`MapKind`]: the list of maps, with all that the crate, the command and the bindings know of each.

use darboux::{Choice, choice};

/// A kind of map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MapKind {
    /// The normal of the high surface in the frame of the low surface.
    Normal,
    /// The normal of the high surface.
    ObjectNormal,
    /// The distance of the high surface from the low one along the ray, positive outside.
    Height,
    /// The share of the hemisphere over the high surface that is open.
    Occlusion,
    /// The position on the high surface.
    Position,
    /// The mean of the open directions over the high surface, in the frame of the low surface.
    BentNormal,
    /// The mean of the open directions over the high surface.
    ObjectBentNormal,
    /// The mean distance to the other side of the high surface.
    Thickness,
    /// The mean curvature of the high surface, times the radius in which it is measured.
    Curvature,
    /// The colour of the material, mesh or part that the ray hits.
    Id,
    /// The colour of the vertices of the high surface.
    VertexColor,
    /// The base colour of the high surface's material, times the colour of its vertices, in linear light.
    BaseColor,
    /// The opacity: 1 where the material's alpha mode is opaque, 1 or 0 where it is a mask, and elsewhere the
    /// alpha of the same.
    Opacity,
    /// The roughness of the high surface's material.
    Roughness,
    /// The metalness of the high surface's material.
    Metalness,
    /// The light that the high surface emits, in linear light.
    Emission,
    /// Another texture of the high surface's material, as its file has it.
    Texture,
    /// A direction of the world in the frame of the low surface.
    WorldDirection,
    /// The colour of the chart of the low surface.
    UvIslands,
    /// The edges of the low surface's triangles.
    Wireframe,
}

/// What the numbers of a map mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MapContent {
    /// Unit vectors.
    Directions,
    /// Shares and factors from 0 to 1.
    Shares,
    /// Numbers from -1 to 1.
    Signed,
    /// Distances and coordinates, in units of the positions.
    Lengths,
    /// Red, green and blue in linear light. Files of 8 and 16 bits hold them in sRGB.
    Light,
    /// Colours that stand for something, as files hold them.
    Labels,
}

/// What is known of a kind.
struct Facts {
    channels: usize,
    content: MapContent,
    /// The content of texels outside the charts.
    background: [f32; 4],
}

// The position of a kind is its number in JavaScript.
choice! { MapKind, "maps",
    Normal => "normal", "Normals in tangent space";
    ObjectNormal => "object-normal", "Normals in the space of the scene";
    Height => "height", "The distance of the high surface from the low one; half grey is none";
    Occlusion => "ao", "Ambient occlusion: white is open";
    Position => "position", "Positions, from 0 to 1 in the box around the high models";
    BentNormal => "bent-normal", "The mean of the open directions, in tangent space";
    ObjectBentNormal => "object-bent-normal", "The mean of the open directions, in the space of the scene";
    Thickness => "thickness", "The mean distance to the other side: black is thin";
    Curvature => "curvature", "Convex is brighter than half grey, concave darker; white curves with the \
         radius of --curvature-radius";
    Id => "id", "A colour for each material, mesh or part of the high models";
    VertexColor => "vertex-color", "The colours of the high model's vertices";
    BaseColor => "base-color", "The base colours that the high models show";
    Opacity => "opacity", "The alpha of the base colour, as the alpha mode of the material says";
    Roughness => "roughness", "The roughness of the high models' materials";
    Metalness => "metalness", "The metalness of the high models' materials";
    Emission => "emission", "The light that the high models emit";
    Texture => "texture", "The texture that --texture names, of the high models' materials";
    WorldDirection => "world-direction", "The direction of --world-direction, in tangent space";
    UvIslands => "uv-islands", "A colour for each UV chart of the low model";
    Wireframe => "wireframe", "White along the edges of the low model's triangles";
}

impl MapKind {
    #[rustfmt::skip]
    fn facts(self) -> Facts {
        use MapContent::{Directions, Labels, Lengths, Light, Shares, Signed};
        let up = [0.0, 0.0, 1.0, 0.0];
        let (none, full) = ([0.0; 4], [1.0; 4]);
        let (channels, content, background) = match self {
            Self::Normal => (3, Directions, up),
            Self::ObjectNormal => (3, Directions, none),
            Self::Height => (1, Lengths, none),
            Self::Occlusion => (1, Shares, full),
            Self::Position => (3, Lengths, none),
            Self::BentNormal => (3, Directions, up),
            Self::ObjectBentNormal => (3, Directions, none),
            Self::Thickness => (1, Lengths, none),
            Self::Curvature => (1, Signed, none),
            Self::Id => (3, Labels, none),
            Self::VertexColor => (4, Shares, full),
            Self::BaseColor => (3, Light, full),
            Self::Opacity => (1, Shares, full),
            Self::Roughness => (1, Shares, full),
            Self::Metalness => (1, Shares, full),
            Self::Emission => (3, Light, none),
            Self::Texture => (4, Shares, none),
            Self::WorldDirection => (3, Directions, up),
            Self::UvIslands => (3, Labels, none),
            Self::Wireframe => (1, Shares, none),
        };
        Facts { channels, content, background }
    }

    /// Numbers per texel: 1, 3 or 4.
    pub fn channels(self) -> usize {
        self.facts().channels
    }

    /// What the numbers mean.
    pub fn content(self) -> MapContent {
        self.facts().content
    }

    /// The content of texels outside the charts: the first numbers count.
    pub(crate) fn background(self) -> [f32; 4] {
        self.facts().background
    }

    /// Whether the map shows the low surface only, so that texels without a hit have content, too.
    pub fn is_of_low_surface(self) -> bool {
        matches!(self, Self::WorldDirection | Self::UvIslands | Self::Wireframe)
    }

    /// Whether the map needs the materials of the high surfaces.
    pub fn is_of_material(self) -> bool {
        matches!(
            self,
            Self::BaseColor
                | Self::Opacity
                | Self::Roughness
                | Self::Metalness
                | Self::Emission
                | Self::Texture
        )
    }
}

/// A set of kinds of maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct MapSet(u32);

impl MapSet {
    /// The set of these kinds.
    pub fn of(kinds: &[MapKind]) -> Self {
        Self(kinds.iter().fold(0, |bits, &kind| bits | 1 << kind as u32))
    }

    /// Whether the set has a kind.
    pub fn has(self, kind: MapKind) -> bool {
        self.0 >> kind as u32 & 1 != 0
    }

    /// Whether the set is empty.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The kinds in the order of the list of [`MapKind`].
    pub fn kinds(self) -> impl Iterator<Item = MapKind> {
        MapKind::ALL.iter().copied().filter(move |&kind| self.has(kind))
    }
}
