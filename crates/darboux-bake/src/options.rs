//! What is baked, and how.

use darboux::{Convention, choice};

use crate::limits::{MAX_SAMPLES_PER_AXIS, MAX_SIDE};
use crate::{BakeError, MapKind, MapSet, Udim};

/// Options of [`bake`](crate::bake()).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BakeOptions {
    /// Texels per row, and rows.
    pub size: [u32; 2],
    /// The images that are made. They share their rays.
    pub maps: MapSet,
    /// Samples per texel and axis: 1 takes the centre of each texel, 4 takes 16 samples, evenly spaced. From
    /// 1 to 16.
    pub samples_per_axis: u32,
    /// How far rays begin outside the low surface along its normals, and how far inside they end, in units
    /// of the positions. A surface with a cage has its rays begin there instead; the second distance is
    /// used for both.
    pub distance: [f32; 2],
    /// Whether rays may hit triangles from behind. By default such triangles are transparent: behind a hole
    /// in the high mesh, the far wall would be in the map.
    pub back_faces: bool,
    /// How a renderer rebuilds the bitangent.
    pub bitangent: Bitangent,
    /// The convention of the surfaces: axes, and the origin of UVs. Tangents are those that
    /// [`darboux::generate_tangents`] gives for them. Default: glTF's.
    pub surface_convention: Convention,
    /// The convention of the maps: directions of red and green, and for object-space normals and positions
    /// the axes. Default: glTF's.
    pub map_convention: Convention,
    /// How far texels outside the charts are filled from the nearest one, in texels. Default: all are
    /// filled, so that no mip level shows the background.
    pub padding: Option<u32>,
    /// Rays per sample of ambient occlusion.
    pub occlusion_rays: u32,
    /// How far a surface occludes another, in units of the positions. Default: any distance.
    pub occlusion_distance: f32,
    /// How occlusion fades with the distance, up to [`BakeOptions::occlusion_distance`]. Default: not at
    /// all.
    pub occlusion_falloff: OcclusionFalloff,
    /// How the directions of occlusion and bent normals are weighted. Default: by the cosine.
    pub occlusion_weights: OcclusionWeights,
    /// Whether surfaces are occluded by their own part only. Default: by all parts of their group.
    pub own_part_only: bool,
    /// How far the other side of a surface is looked for, in units of the positions. Rays that meet nothing
    /// count as this distance; they do not count where it is infinite. Default: infinite.
    pub thickness_distance: f32,
    /// The radius in which curvature is measured. Default: 4 texels.
    pub curvature_radius: CurvatureRadius,
    /// What the colours of [`MapKind::Id`] stand for. Default: materials.
    pub id_source: IdSource,
    /// The direction of [`MapKind::WorldDirection`], along the axes of the surfaces. Default: (0, 1, 0), up
    /// in glTF.
    pub world_direction: [f32; 3],
    /// The tile of the UV plane that is baked. Default: all tiles lie over each other, as a repeated texture
    /// shows them.
    pub udim: Option<Udim>,
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
            occlusion_falloff: OcclusionFalloff::None,
            occlusion_weights: OcclusionWeights::Cosine,
            own_part_only: false,
            thickness_distance: f32::INFINITY,
            curvature_radius: CurvatureRadius::Texels(4.0),
            id_source: IdSource::Material,
            world_direction: [0.0, 1.0, 0.0],
            udim: None,
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

    /// These options with so many rays of ambient occlusion per sample, and the distance over which surfaces
    /// occlude.
    #[must_use]
    pub fn with_occlusion(self, rays: u32, distance: f32) -> Self {
        Self { occlusion_rays: rays, occlusion_distance: distance, ..self }
    }

    /// These options with another fading of occlusion.
    #[must_use]
    pub fn with_occlusion_falloff(self, occlusion_falloff: OcclusionFalloff) -> Self {
        Self { occlusion_falloff, ..self }
    }

    /// These options with other weights of the directions of occlusion.
    #[must_use]
    pub fn with_occlusion_weights(self, occlusion_weights: OcclusionWeights) -> Self {
        Self { occlusion_weights, ..self }
    }

    /// These options with occlusion by the own part only, or by all.
    #[must_use]
    pub fn with_own_part_only(self, own_part_only: bool) -> Self {
        Self { own_part_only, ..self }
    }

    /// These options with another distance up to which thickness is measured.
    #[must_use]
    pub fn with_thickness_distance(self, thickness_distance: f32) -> Self {
        Self { thickness_distance, ..self }
    }

    /// These options with another radius of curvature maps.
    #[must_use]
    pub fn with_curvature_radius(self, curvature_radius: CurvatureRadius) -> Self {
        Self { curvature_radius, ..self }
    }

    /// These options with colours of [`MapKind::Id`] that stand for something else.
    #[must_use]
    pub fn with_id_source(self, id_source: IdSource) -> Self {
        Self { id_source, ..self }
    }

    /// These options with another direction for [`MapKind::WorldDirection`]; its length does not matter.
    #[must_use]
    pub fn with_world_direction(self, world_direction: [f32; 3]) -> Self {
        Self { world_direction, ..self }
    }

    /// These options for a tile of the UV plane, or for all.
    #[must_use]
    pub fn with_udim(self, udim: Option<Udim>) -> Self {
        Self { udim, ..self }
    }

    /// These options with a memory limit in bytes, or none.
    #[must_use]
    pub fn with_memory_limit(self, memory_limit: Option<u64>) -> Self {
        Self { memory_limit, ..self }
    }

    /// Refuses options with which nothing can be baked, as [`bake`](crate::bake()) does.
    ///
    /// # Errors
    ///
    /// A size, number of samples or distance out of range, no map, and numbers of maps that mean nothing.
    pub fn check(&self) -> Result<(), BakeError> {
        let BakeOptions { size, samples_per_axis, distance, maps, .. } = *self;
        if size.iter().any(|&side| side == 0 || side > MAX_SIDE) {
            return Err(BakeError::Size { size });
        }
        if samples_per_axis == 0 || samples_per_axis > MAX_SAMPLES_PER_AXIS {
            return Err(BakeError::Samples { found: samples_per_axis });
        }
        let is_distance = |x: &f32| x.is_finite() && *x >= 0.0;
        if !distance.iter().all(is_distance) || distance == [0.0; 2] {
            return Err(BakeError::Distance { found: distance });
        }
        if maps.is_empty() {
            return Err(BakeError::NoMaps);
        }
        self.check_maps()
    }

    /// Refuses numbers of single maps that mean nothing.
    fn check_maps(&self) -> Result<(), BakeError> {
        let radius = match self.curvature_radius {
            CurvatureRadius::Texels(radius) | CurvatureRadius::Distance(radius) => radius,
        };
        let largest = self.world_direction.iter().fold(0f32, |most, x| most.max(x.abs()));
        let is_positive = |x: f32| x > 0.0;
        let needed = [
            (
                "the distance of occlusion",
                "above 0",
                self.occlusion_distance,
                !self.occlusion_distance.is_nan(),
            ),
            (
                "the distance of thickness",
                "above 0",
                self.thickness_distance,
                is_positive(self.thickness_distance),
            ),
            (
                "the radius of curvature",
                "finite and above 0",
                radius,
                is_positive(radius) && radius.is_finite(),
            ),
            (
                "the largest component of the world's direction",
                "finite and above 0",
                largest,
                is_positive(largest) && self.world_direction.iter().all(|x| x.is_finite()),
            ),
        ];
        match needed.into_iter().find(|(.., is_valid)| !is_valid) {
            Some((what, expected, found, _)) => Err(BakeError::Option { what, expected, found }),
            None => Ok(()),
        }
    }
}

/// How a renderer rebuilds the bitangent. A map shows the right normals only where it was baked in the same
/// way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Bitangent {
    /// w * cross(N, T) of the interpolated N and T: the recommendation of MikkTSpace and the default of
    /// Blender, Unreal Engine and Unity.
    #[default]
    PerPixel,
    /// w * cross(N, T) at each vertex, interpolated.
    PerVertex,
}

/// How occlusion fades with the distance d of the occluder, as a share of the greatest distance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum OcclusionFalloff {
    /// Not at all.
    #[default]
    None,
    /// 1 - d.
    Linear,
    /// (1 - d)^2.
    Quadratic,
}

/// How the directions of a hemisphere are weighted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum OcclusionWeights {
    /// By the cosine of the angle to the normal, as light falls on a matte surface.
    #[default]
    Cosine,
    /// All alike.
    Uniform,
}

/// The radius in which curvature is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum CurvatureRadius {
    /// In texels: larger where the image is coarser.
    Texels(f32),
    /// In units of the positions.
    Distance(f32),
}

/// What the colours of an id map stand for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum IdSource {
    /// The material.
    #[default]
    Material,
    /// The mesh, wherever the scene has it.
    Mesh,
    /// The part: a node of the scene with a mesh.
    Part,
    /// The colour of the vertices itself, rounded to 8 bits.
    VertexColor,
}

choice! { Bitangent, "bitangent",
    PerPixel => "pixel", "Per pixel from the interpolated normal and tangent, as glTF, MikkTSpace, Blender, \
         Unreal and Unity";
    PerVertex => "vertex", "Per vertex, then interpolated";
}

choice! { OcclusionFalloff, "falloff",
    None => "none", "Occlusion does not fade with the distance";
    Linear => "linear", "It fades evenly up to the greatest distance";
    Quadratic => "quadratic", "It fades fast near the surface and slowly far away";
}

choice! { OcclusionWeights, "weights",
    Cosine => "cosine", "By the cosine of the angle to the normal, as light falls on a matte surface";
    Uniform => "uniform", "All directions alike";
}

choice! { IdSource, "id source",
    Material => "material", "A colour for each material";
    Mesh => "mesh", "A colour for each mesh";
    Part => "part", "A colour for each part: each node with a mesh";
    VertexColor => "vertex-color", "The colours of the vertices themselves";
}
