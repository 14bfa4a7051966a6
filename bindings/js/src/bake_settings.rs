//! The options of `darboux/bake`, and what they choose for models and meshes.

use darboux::Convention;
use darboux_bake::{
    BakeOptions, Bitangent, CurvatureRadius, HighModelOptions, IdSource, LowSurface, MapKind, MapSet,
    OcclusionFalloff, OcclusionWeights, PartMatch, PreparedSurfaces, RayOrigin, SkewCorrection, Udim,
    with_skew,
};
use serde::Deserialize;

use crate::options::Named;

/// Options of a bake. bindings/js/lib/bake.ts documents them.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Options {
    pub size: [u32; 2],
    cage_offset: Option<f32>,
    auto_cage: Option<f32>,
    distance: Option<[f32; 2]>,
    /// Whether a cage lies behind the other files.
    pub has_cage: bool,
    skew: Option<f32>,
    maps: Vec<Named<MapKind>>,
    samples: u32,
    pub bitangent: Named<Bitangent>,
    convention: String,
    /// Of the map that is converted.
    source_convention: String,
    mesh_convention: String,
    /// Whether a map becomes one in object space.
    pub to_object: bool,
    pub padding: Option<u32>,
    udim: Option<u32>,
    back_faces: bool,
    pub material: Option<usize>,
    pub uv_set: Option<usize>,
    #[serde(rename = "match")]
    pub part_match: Named<PartMatch>,
    pub high_maps: bool,
    ao_rays: u32,
    ao_distance: Option<f32>,
    ao_falloff: Named<OcclusionFalloff>,
    ao_weights: Named<OcclusionWeights>,
    own_part_only: bool,
    thickness_distance: Option<f32>,
    curvature_radius: f32,
    is_curvature_in_texels: bool,
    pub id_from: Named<IdSource>,
    world_direction: [f32; 3],
    pub texture: Option<String>,
}

impl Options {
    pub fn convention(&self) -> Result<Convention, String> {
        self.convention.parse().map_err(|error| format!("convention: {error}"))
    }

    pub fn source_convention(&self) -> Result<Convention, String> {
        self.source_convention.parse().map_err(|error| format!("sourceConvention: {error}"))
    }

    pub fn mesh_convention(&self) -> Result<Convention, String> {
        self.mesh_convention.parse().map_err(|error| format!("meshConvention: {error}"))
    }

    /// Where rays begin. Errors: two options say so.
    pub fn ray_origin(&self) -> Result<RayOrigin, String> {
        match self.has_cage {
            true => self.ray_origin_with_cage("cage"),
            false => self.ray_origin_without_cage(),
        }
    }

    fn ray_origin_without_cage(&self) -> Result<RayOrigin, String> {
        match (self.distance, self.auto_cage, self.cage_offset) {
            (Some(_), Some(_), _) => Err(two_origins("distance", "autoCage")),
            (Some(_), None, Some(_)) => Err(two_origins("distance", "cageOffset")),
            (Some(distance), None, None) => Ok(RayOrigin::Normals(distance)),
            (None, Some(share), reach) => Ok(RayOrigin::AutoCage { share, reach }),
            (None, None, offset) => Ok(RayOrigin::InflatedCage(offset)),
        }
    }

    /// How far inside rays end that begin on a given cage. `name`: of the cage. Errors: another option says
    /// where they begin, too.
    pub fn ray_origin_with_cage(&self, name: &str) -> Result<RayOrigin, String> {
        match self.auto_cage {
            Some(_) => Err(two_origins(name, "autoCage")),
            None => self.ray_origin_without_cage(),
        }
    }

    /// The surfaces with the correction of skew. Errors: an amount out of range.
    pub fn straightened<'a>(&self, low: Vec<LowSurface<'a>>) -> Result<Vec<LowSurface<'a>>, String> {
        match self.skew {
            Some(amount) => with_skew(&low, SkewCorrection::Everywhere(amount)).map_err(text),
            None => Ok(low),
        }
    }

    /// What counts on high models. Errors: a texture without its map, or the other way round.
    pub fn high_options(&self) -> Result<HighModelOptions, String> {
        let options = HighModelOptions::default()
            .with_normal_maps(self.high_maps)
            .with_maps(chosen_maps(self))
            .with_texture(self.texture.clone());
        options.check().map_err(text)?;
        Ok(options)
    }

    /// The tile that is worked on; none for all.
    pub fn udim(&self) -> Result<Option<Udim>, String> {
        let known = |number| {
            Udim::from_number(number)
                .ok_or_else(|| format!("udim is {number}; it must be a number of a tile, 1001 to 9990"))
        };
        self.udim.map(known).transpose()
    }
}

fn two_origins(one: &str, other: &str) -> String {
    format!("{one} and {other} both say where rays begin; leave one of them out")
}

/// What was chosen for models or meshes before the work on them.
#[derive(Default)]
pub struct Setup {
    pub diagonal: f64,
    pub distance: [f32; 2],
    pub warnings: Vec<String>,
    /// As of `Models::misfit`.
    pub misfit: Option<String>,
    /// Of what the colours of [`MapKind::Id`] stand for.
    pub id_names: Vec<String>,
    /// Of the low surfaces.
    pub part_names: Vec<String>,
}

/// The surfaces that are worked on.
pub struct Surfaces<'a> {
    pub prepared: &'a PreparedSurfaces<'a>,
    pub settings: &'a BakeOptions,
}

pub fn read_options(json: &[u8]) -> Result<Options, String> {
    serde_json::from_slice(json).map_err(|error| format!("options: {error}"))
}

pub fn chosen_maps(options: &Options) -> MapSet {
    let kinds: Vec<MapKind> = options.maps.iter().map(|kind| kind.0).collect();
    MapSet::of(&kinds)
}

pub fn bake_settings(options: &Options, distance: [f32; 2]) -> Result<BakeOptions, String> {
    Ok(BakeOptions::new(options.size, distance)
        .with_maps(chosen_maps(options))
        .with_samples_per_axis(options.samples)
        .with_back_faces(options.back_faces)
        .with_bitangent(options.bitangent.0)
        .with_surface_convention(options.mesh_convention()?)
        .with_map_convention(options.convention()?)
        .with_padding(options.padding)
        .with_udim(options.udim()?)
        .with_occlusion(options.ao_rays, options.ao_distance.unwrap_or(f32::INFINITY))
        .with_occlusion_falloff(options.ao_falloff.0)
        .with_occlusion_weights(options.ao_weights.0)
        .with_own_part_only(options.own_part_only)
        .with_thickness_distance(options.thickness_distance.unwrap_or(f32::INFINITY))
        .with_curvature_radius(match options.is_curvature_in_texels {
            true => CurvatureRadius::Texels(options.curvature_radius),
            false => CurvatureRadius::Distance(options.curvature_radius),
        })
        .with_id_source(options.id_from.0)
        .with_world_direction(options.world_direction))
}

pub fn sentence(error: darboux_io::Error) -> String {
    error.to_string()
}

pub fn text(error: darboux_bake::BakeError) -> String {
    error.to_string()
}
