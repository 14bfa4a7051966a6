//! [`MapKind`]: the list of maps, with all that the crate, the command and the bindings know of each.

use std::str::FromStr;

use darboux::{Choice, UnknownName};

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
    /// The alpha of the same.
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
    name: &'static str,
    summary: &'static str,
    channels: usize,
    content: MapContent,
    /// The content of texels outside the charts.
    background: [f32; 4],
}

impl MapKind {
    /// All kinds. The position of a kind is its number in JavaScript.
    pub const ALL: [Self; 20] = [
        Self::Normal,
        Self::ObjectNormal,
        Self::Height,
        Self::Occlusion,
        Self::Position,
        Self::BentNormal,
        Self::ObjectBentNormal,
        Self::Thickness,
        Self::Curvature,
        Self::Id,
        Self::VertexColor,
        Self::BaseColor,
        Self::Opacity,
        Self::Roughness,
        Self::Metalness,
        Self::Emission,
        Self::Texture,
        Self::WorldDirection,
        Self::UvIslands,
        Self::Wireframe,
    ];

    #[rustfmt::skip]
    fn facts(self) -> Facts {
        use MapContent::{Directions, Labels, Lengths, Light, Shares, Signed};
        let up = [0.0, 0.0, 1.0, 0.0];
        let (none, full) = ([0.0; 4], [1.0; 4]);
        let (name, summary, channels, content, background) = match self {
            Self::Normal => ("normal", "Normals in tangent space", 3, Directions, up),
            Self::ObjectNormal => ("object-normal", "Normals in the space of the scene", 3, Directions, none),
            Self::Height => ("height", "The distance of the high surface from the low one; half grey is none", 1, Lengths, none),
            Self::Occlusion => ("ao", "Ambient occlusion: white is open", 1, Shares, full),
            Self::Position => ("position", "Positions, from 0 to 1 in the box around the high model", 3, Lengths, none),
            Self::BentNormal => ("bent-normal", "The mean of the open directions, in tangent space", 3, Directions, up),
            Self::ObjectBentNormal => ("object-bent-normal", "The mean of the open directions, in the space of the scene", 3, Directions, none),
            Self::Thickness => ("thickness", "The mean distance to the other side: black is thin", 1, Lengths, none),
            Self::Curvature => ("curvature", "Convex is brighter than half grey, concave darker; white curves with the radius of --curvature-radius", 1, Signed, none),
            Self::Id => ("id", "A colour for each material, mesh or part of the high models", 3, Labels, none),
            Self::VertexColor => ("vertex-color", "The colours of the high model's vertices", 4, Shares, full),
            Self::BaseColor => ("base-color", "The base colours that the high models show", 3, Light, full),
            Self::Opacity => ("opacity", "The alpha of the base colour", 1, Shares, full),
            Self::Roughness => ("roughness", "The roughness of the high models' materials", 1, Shares, full),
            Self::Metalness => ("metalness", "The metalness of the high models' materials", 1, Shares, full),
            Self::Emission => ("emission", "The light that the high models emit", 3, Light, none),
            Self::Texture => ("texture", "The texture that --texture names, of the high models' materials", 4, Shares, none),
            Self::WorldDirection => ("world-direction", "The direction of --world-direction, in tangent space", 3, Directions, up),
            Self::UvIslands => ("uv-islands", "A colour for each UV chart of the low model", 3, Labels, none),
            Self::Wireframe => ("wireframe", "White along the edges of the low model's triangles", 1, Shares, none),
        };
        Facts { name, summary, channels, content, background }
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

impl Choice for MapKind {
    const WHAT: &'static str = "maps";
    const ALL: &'static [Self] = &MapKind::ALL;

    fn name(self) -> &'static str {
        self.facts().name
    }

    fn summary(self) -> &'static str {
        self.facts().summary
    }
}

impl FromStr for MapKind {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Choice::from_name(name)
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

    /// The kinds in the order of [`MapKind::ALL`].
    pub fn kinds(self) -> impl Iterator<Item = MapKind> {
        MapKind::ALL.into_iter().filter(move |&kind| self.has(kind))
    }
}
