//! What is baked, and how.

use darboux::Convention;

/// Options of [`bake`](crate::bake()).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BakeOptions {
    /// Texels per row, and rows.
    pub size: [u32; 2],
    /// The images that are made. They share their rays.
    pub maps: MapSet,
    /// Samples per texel and axis: 1 takes the centre of each texel, 4 takes 16 samples, evenly spaced. From 1 to 16.
    pub samples_per_axis: u32,
    /// How far rays begin outside the low surface along its normals, and how far inside they end, in units of the positions. A surface with
    /// a cage has its rays begin there instead; the second distance is used for both.
    pub distance: [f32; 2],
    /// Whether rays may hit triangles from behind. By default such triangles are transparent: behind a hole in the high mesh, the far wall
    /// would be in the map.
    pub back_faces: bool,
    /// How a renderer rebuilds the bitangent.
    pub bitangent: Bitangent,
    /// The convention of the surfaces: axes, and the origin of UVs. Tangents are those that [`darboux::generate_tangents`] gives for them.
    /// Default: glTF's.
    pub surface_convention: Convention,
    /// The convention of the maps: directions of red and green, and for object-space normals and positions the axes. Default: glTF's.
    pub map_convention: Convention,
    /// How far texels outside the charts are filled from the nearest one, in texels. Default: all are filled, so that no mip level shows
    /// the background.
    pub padding: Option<u32>,
    /// Rays per sample of ambient occlusion.
    pub occlusion_rays: u32,
    /// How far a surface occludes another, in units of the positions. Default: any distance.
    pub occlusion_distance: f32,
    /// The most bytes that a run may take. Default: no limit.
    pub memory_limit: Option<u64>,
}

impl BakeOptions {
    /// A tangent-space normal map in glTF's convention, one sample per texel, filled everywhere.
    ///
    /// `size`: texels per row, and rows; `distance`: as [`BakeOptions::distance`].
    pub fn new(size: [u32; 2], distance: [f32; 2]) -> Self {
        Self {
            size,
            maps: MapSet::of(&[MapKind::Normal]),
            samples_per_axis: 1,
            distance,
            back_faces: false,
            bitangent: Bitangent::PerPixel,
            surface_convention: Convention::GLTF,
            map_convention: Convention::GLTF,
            padding: None,
            occlusion_rays: 64,
            occlusion_distance: f32::INFINITY,
            memory_limit: None,
        }
    }

    /// These options with another size: texels per row, and rows.
    #[must_use]
    pub fn with_size(self, size: [u32; 2]) -> Self {
        Self { size, ..self }
    }

    /// These options with other distances: outwards and inwards.
    #[must_use]
    pub fn with_distance(self, distance: [f32; 2]) -> Self {
        Self { distance, ..self }
    }

    /// These options with other maps.
    #[must_use]
    pub fn with_maps(self, maps: MapSet) -> Self {
        Self { maps, ..self }
    }

    /// These options with so many samples per texel and axis.
    #[must_use]
    pub fn with_samples_per_axis(self, samples_per_axis: u32) -> Self {
        Self { samples_per_axis, ..self }
    }

    /// These options with rays that may hit triangles from behind, or not.
    #[must_use]
    pub fn with_back_faces(self, back_faces: bool) -> Self {
        Self { back_faces, ..self }
    }

    /// These options with another bitangent.
    #[must_use]
    pub fn with_bitangent(self, bitangent: Bitangent) -> Self {
        Self { bitangent, ..self }
    }

    /// These options with surfaces in another convention.
    #[must_use]
    pub fn with_surface_convention(self, surface_convention: Convention) -> Self {
        Self { surface_convention, ..self }
    }

    /// These options with maps in another convention.
    #[must_use]
    pub fn with_map_convention(self, map_convention: Convention) -> Self {
        Self { map_convention, ..self }
    }

    /// These options with so many texels of padding, or with all.
    #[must_use]
    pub fn with_padding(self, padding: Option<u32>) -> Self {
        Self { padding, ..self }
    }

    /// These options with so many rays of ambient occlusion per sample, and the distance over which surfaces occlude.
    #[must_use]
    pub fn with_occlusion(self, rays: u32, distance: f32) -> Self {
        Self { occlusion_rays: rays, occlusion_distance: distance, ..self }
    }

    /// These options with a memory limit in bytes, or none.
    #[must_use]
    pub fn with_memory_limit(self, memory_limit: Option<u64>) -> Self {
        Self { memory_limit, ..self }
    }
}

/// How a renderer rebuilds the bitangent. A map shows the right normals only where it was baked in the same way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Bitangent {
    /// w * cross(N, T) of the interpolated N and T: the recommendation of MikkTSpace and the default of Blender, Unreal Engine and Unity.
    #[default]
    PerPixel,
    /// w * cross(N, T) at each vertex, interpolated.
    PerVertex,
}

/// A kind of image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MapKind {
    /// The normal of the high surface in the frame of the low surface.
    Normal,
    /// The normal of the high surface.
    ObjectNormal,
    /// The distance of the high surface from the low one along the ray, positive outside.
    Height,
    /// The share of the hemisphere over the high surface that is open, weighted by the cosine.
    Occlusion,
    /// The position on the high surface.
    Position,
}

impl MapKind {
    /// All kinds.
    pub const ALL: [Self; 5] =
        [Self::Normal, Self::ObjectNormal, Self::Height, Self::Occlusion, Self::Position];
}

/// A set of kinds of images.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct MapSet(u8);

impl MapSet {
    /// The set of these kinds.
    pub fn of(kinds: &[MapKind]) -> Self {
        Self(kinds.iter().fold(0, |bits, &kind| bits | 1 << kind as u8))
    }

    /// Whether the set has a kind.
    pub fn has(self, kind: MapKind) -> bool {
        self.0 >> kind as u8 & 1 != 0
    }

    /// Whether the set is empty.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }
}
