//! The arguments of `darboux bake`.

use std::num::NonZero;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{OsStringValueParser, TypedValueParser};
use darboux::{Choice, Convention, Method};
use darboux_bake::{
    Bitangent, CurvatureRadius, HighModelOptions, IdSource, LowModelOptions, MapKind, MapSet,
    OcclusionFalloff, OcclusionWeights, PartMatch,
};
use darboux_io::SaveOptions;

use super::encode::FileKind;
use super::map_choice::{MapChoice, map_choice};
use super::skew::{SkewChoice, skew};
use crate::file_id::FileId;
use crate::heat_scale::HeatRange;
use crate::options::choice::choice;
use crate::options::convention::{ConventionParser, NamedConvention};
use crate::options::files::jobs;
use crate::options::formats::with_endings;
use crate::options::given::Given;
use crate::options::messages::MessageOptions;
use crate::options::reading::ReadOptions;
use crate::options::shading::{NormalsChoice, normals_choice};

pub const ABOUT: &str = "\
Bake the detail of high-poly models into maps of a low-poly model.

From every texel of the low model a ray passes from outside through its surface; the first surface of the \
high models that it hits gives the content. A normal map holds those normals in the tangent frames that \
renderers will use, so that the low model is shaded as the high one is. The frames are those in the file of \
the low model, or MikkTSpace's if it has none: then run darboux tangents on the model that you ship, so that \
renderers use the same.

All models are placed as their scenes have them; skinned meshes have the pose in which they are stored. \
Texels that several triangles cover belong to the first one. Texels outside the UV charts are filled from \
the nearest chart, so that no background shows at a distance. If the rays of more than 1 % of the texels hit \
nothing, a picture beside the map shows where, as in crate.misses.png: red, or orange where rays met \
triangles from behind. The maps are the same for every number of threads, and made on the processor.";

pub const EXAMPLES: &str = "\
Examples:
  darboux bake low.glb --high high.glb -o normal.png
  darboux bake low.glb --high a.glb b.glb -o crate.png --map normal,ao --size 2048
  darboux bake low.glb --high high.glb -o n.png --samples 16 --bits 16
  darboux bake low.glb --high high.glb -o n.png --distance 0.05,0.02
  darboux bake low.glb --high high.glb -o n.png --match name          crate_low from crate_high
  darboux bake low.glb --high high.glb -o n.png --auto-cage           a cage that fits the detail
  darboux bake low.glb --high high.glb -o n.%UDIM%.png                an image for each UDIM tile
  darboux bake low.glb --high high.glb -o n.png --convention unreal   green down
  darboux bake low.glb --high high.glb -o n.png --write-model baked.glb --verify
  darboux bake model.glb --high model.glb -o n.png --uv-set 1         from one UV layout to another
  darboux bake low.glb --high high.glb -o height.exr --map height --json
  darboux bake models --suffixes --map normal,ao --size 2048          each NAME_low from NAME_high
  darboux bake job.toml --resume                                      what has changed since the last run
  darboux bake low.glb --high high.glb -o crate.png --pack orm=ao,roughness,metalness
  darboux bake low.fbx --high high.fbx --write-model crate.glb         a model with all its textures";

/// What is baked, and how.
#[derive(Args, Clone, Debug)]
pub struct BakeArguments {
    #[command(flatten)]
    pub given: Given,

    #[arg(value_name = "LOW", help = with_endings("The low model ({models}), which gets the maps; or a job: \
         a TOML file, or a folder with --suffixes"))]
    pub low: PathBuf,

    #[arg(long, value_name = "HIGH", num_args = 1.., help = with_endings("The high models ({models}), which \
         have the detail; their materials count, with normal maps and textures"))]
    pub high: Vec<PathBuf>,

    /// The map (.png, .exr, .tif), in an existing folder; with several maps the name of each is added, as in
    /// crate.ao.png, and %UDIM% becomes the number of each tile. Without it the PNG named as the model of
    /// --write-model
    #[arg(short, long, value_name = "IMAGE", default_value = "", hide_default_value = true, value_parser = any_path())]
    pub output: PathBuf,

    /// The maps to bake; several at once share their rays. Without it normal, or material if --write-model
    /// stands without -o
    #[arg(long, value_parser = map_choice(), value_name = "MAPS", value_delimiter = ',', help_heading = "Maps")]
    pub map: Vec<MapChoice>,

    /// Texels per side, or width and height
    #[arg(long, value_name = "N|WxH", default_value = "1024", value_parser = size, help_heading = "Maps")]
    pub size: [u32; 2],

    /// Bits per channel: 8 or 16 (PNG), 16 or 32 (EXR, TIFF); by default the more for heights, positions and
    /// thickness, the fewer for the others
    ///
    /// EXR, and TIFF of 32 bits, hold numbers as they are: distances in the models' unit, light in linear
    /// light, directions from 0 to 1.
    #[arg(long, value_name = "8|16|32", value_parser = bits, help_heading = "Maps")]
    pub bits: Option<u8>,

    /// Round to 8 bits with blue noise, so that smooth surfaces show no bands; SEED moves the noise
    #[arg(long, value_name = "SEED", num_args = 0..=1, default_missing_value = "0", require_equals = true, help_heading = "Maps")]
    pub dither: Option<u32>,

    /// Write an image whose channels are maps of one channel each, such as orm=ao,roughness,metalness:
    /// OUTPUT with NAME before its ending
    #[arg(long, value_name = "NAME=MAPS", value_parser = pack, help_heading = "Maps")]
    pub pack: Vec<Pack>,

    /// Samples per texel: 1, 4, 9, 16 and so on up to 256
    #[arg(long, value_name = "NUMBER", default_value = "1", value_parser = samples_per_axis, help_heading = "Maps")]
    pub samples: SamplesPerAxis,

    /// The convention of the maps: directions of red and green, axes of object-space normals and positions
    #[arg(long, value_name = "NAME", default_value = "gltf", value_parser = ConventionParser, help_heading = "Maps")]
    pub convention: NamedConvention,

    /// Fill texels outside the charts up to this distance only, in texels; without it all are filled
    #[arg(long, value_name = "TEXELS", help_heading = "Maps")]
    pub padding: Option<u32>,

    #[command(flatten)]
    pub content: ContentOptions,

    /// Rays along the interpolated normals: how far outside they begin, and how far inside they end
    #[arg(long, value_name = "OUT,IN", value_parser = two_distances, help_heading = "Rays")]
    pub distance: Option<[f32; 2]>,

    /// Rays from a cage: the low model, moved outwards by this distance along smooth normals, so that hard
    /// edges leave no gaps; they end as far inside
    ///
    /// Without any of these options the distance is 2 % of the diagonal of the low model's box, and is
    /// printed.
    #[arg(long, value_name = "DISTANCE", value_parser = distance, conflicts_with = "distance", help_heading = "Rays")]
    pub cage_offset: Option<f32>,

    /// Rays from a cage that is a file: the low model with its vertices moved; they end as far inside as
    /// --cage-offset says
    #[arg(long, value_name = "CAGE", conflicts_with = "distance", help_heading = "Rays")]
    pub cage: Option<PathBuf>,

    /// Rays from a cage that is made for the models: at every vertex as close as all but a SHARE of the rays
    /// around allows, 0.001 by default
    ///
    /// Detail that stands on the surface lies inside the cage, and what stands over it behind a gap, such as
    /// a handle over a lid, outside. The cage is at most --cage-offset away, by default 10 % of the
    /// diagonal of the low model's box. The distances found are printed.
    #[arg(long, value_name = "SHARE", num_args = 0..=1, default_missing_value = "0.001", require_equals = true, value_parser = share, conflicts_with_all = ["distance", "cage"], help_heading = "Rays")]
    pub auto_cage: Option<f32>,

    /// Multiply the distance of the cage at each vertex by the red of the low model's vertex colours
    #[arg(long, conflicts_with_all = ["distance", "cage", "auto_cage"], help_heading = "Rays")]
    pub offset_colors: bool,

    /// Turn rays towards the normals of the low model's triangles: by an AMOUNT from 0 to 1, or by a painted
    /// IMAGE over its UVs, white where rays follow the triangle's normal and black where they follow the
    /// smooth one
    ///
    /// It straightens details on flat faces with smooth normals; at hard edges straight rays leave gaps,
    /// which the image can leave out.
    #[arg(long, value_name = "AMOUNT|IMAGE", value_parser = skew, help_heading = "Rays")]
    pub skew: Option<SkewChoice>,

    /// Fail, and write nothing, if the rays of more than this SHARE of the texels hit nothing; without it
    /// they are a warning, unless all miss
    #[arg(long, value_name = "SHARE", value_parser = share, help_heading = "Rays")]
    pub max_misses: Option<f32>,

    /// Write the cage as a model, which --cage reads
    #[arg(long, value_name = "GLB", conflicts_with = "distance", help_heading = "Results")]
    pub write_cage: Option<PathBuf>,

    /// Which high parts the rays of a low part can hit
    #[arg(long = "match", value_parser = choice::<PartMatch>(), value_name = "HOW", default_value = "nearest", help_heading = "Rays")]
    pub part_match: PartMatch,

    /// Let rays hit triangles from behind
    ///
    /// By default such triangles are transparent, so that a hole in the high model does not show its far
    /// wall.
    #[arg(long, help_heading = "Rays")]
    pub back_faces: bool,

    /// Bake the geometry of the high models without the normal maps of their materials
    #[arg(long, help_heading = "Maps")]
    pub no_high_maps: bool,

    /// How tangents are computed; by default those of the low model's file are used, and mikktspace if it
    /// has none for the UV set
    #[arg(long, value_parser = choice::<Method>(), value_name = "NAME", help_heading = "Frames")]
    pub method: Option<Method>,

    /// How the renderer rebuilds the bitangent
    #[arg(long, value_parser = choice::<Bitangent>(), value_name = "HOW", default_value = Bitangent::default().name(), help_heading = "Frames")]
    pub bitangent: Bitangent,

    /// The UV set n of TEXCOORD_n; by default that of the material's normal map
    #[arg(long, value_name = "N", help_heading = "Frames")]
    pub uv_set: Option<usize>,

    /// Bake only the primitives with this material, materials[N] of the low model's file; by default all
    /// share the map
    #[arg(long, value_name = "N", help_heading = "Frames")]
    pub material: Option<usize>,

    /// Generate missing normals of the low model first: flat, smooth or crease=DEG; keep generates none
    ///
    /// Its renderer must use the same normals: `darboux normals` writes them.
    #[arg(long, value_name = "SHADING", default_value = "keep", value_parser = normals_choice, help_heading = "Frames")]
    pub normals: NormalsChoice,

    /// Write the low model with the maps that its materials can have, and with the tangents in its vertices
    ///
    /// These are normal, ao, base-color, opacity, roughness, metalness and emission.
    #[arg(long, value_name = "GLB", help_heading = "Results")]
    pub write_model: Option<PathBuf>,

    /// Shade the low model with the map that was written, as a renderer does, and print how far its normals
    /// are from those of the high models
    ///
    /// One random point per texel is compared, in degrees: of all points, by cause, and what renderers with
    /// other frames would show.
    #[arg(long, help_heading = "Results")]
    pub verify: bool,

    /// Draw these errors over the UV layout, with their scale below
    #[arg(long, value_name = "PNG", requires = "verify", help_heading = "Results")]
    pub heat_map: Option<PathBuf>,

    /// Write the low model painted with these errors, unlit, and beside it a PNG of their scale; `darboux
    /// render` and every viewer show it
    #[arg(long, value_name = "GLB", requires = "verify", help_heading = "Results")]
    pub heat_model: Option<PathBuf>,

    /// The ends of the scale of errors in degrees; by default those that fit the errors
    #[arg(long, value_name = "MIN,MAX", requires = "verify", help_heading = "Results")]
    pub heat_range: Option<HeatRange>,

    /// Write an HTML page with pictures of the maps, of errors and misses, and of the low model beside the
    /// high ones; it loads nothing
    #[arg(long, value_name = "HTML", help_heading = "Results")]
    pub report: Option<PathBuf>,

    /// Bake each NAME_low in the folder LOW from NAME_high, with the cage NAME_cage if there is one, into
    /// NAME.png in the folder of -o, or in LOW
    ///
    /// _lowpoly and _lp mean _low, and _highpoly and _hp mean _high.
    ///
    /// An -o such as maps/%NAME%.%UDIM%.exr has another name for the images of each pair. --write-model,
    /// --report and the other results take a folder or such a name, too: --write-model models alone writes
    /// models/NAME.baked.glb with all textures of a material, and their images beside it.
    #[arg(long, help_heading = "Jobs")]
    pub suffixes: bool,

    /// Skip bakes of a job whose models, options and outputs have not changed since an earlier run; a killed
    /// run is continued
    ///
    /// The journal of earlier runs is darboux-journal.jsonl in the folder of the job.
    #[arg(long, help_heading = "Jobs")]
    pub resume: bool,

    /// With --resume, bake also pairs that are skipped because two runs were killed while they worked on
    /// them
    #[arg(long, requires = "resume", help_heading = "Jobs")]
    pub retry: bool,

    /// How many threads work; by default one per processor core
    #[arg(long, value_name = "NUMBER", value_parser = jobs)]
    pub jobs: Option<NonZero<u16>>,

    /// Replace files that exist
    #[arg(long)]
    pub force: bool,

    #[command(flatten)]
    pub reading: ReadOptions,

    #[command(flatten)]
    pub messages: MessageOptions,

    /// The outputs that this bake of a job may replace without `--force`.
    #[arg(skip)]
    pub own_outputs: OwnOutputs,

    /// Whether folders of outputs are made, as in jobs; otherwise one that is missing is most likely
    /// mistyped.
    #[arg(skip)]
    pub makes_folders: bool,
}

/// Outputs of earlier runs.
#[derive(Clone, Debug, Default)]
pub enum OwnOutputs {
    #[default]
    None,
    Files(Vec<PathBuf>),
    /// A run that was killed may have written any of them.
    All,
}

/// What single maps show.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Single maps")]
pub struct ContentOptions {
    /// Rays per sample of occlusion, bent normals and thickness
    #[arg(long, value_name = "NUMBER", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub ao_rays: u32,

    /// How far surfaces occlude each other, in the models' unit; without it any distance
    #[arg(long, value_name = "DISTANCE", value_parser = distance)]
    pub ao_distance: Option<f32>,

    /// How occlusion fades up to --ao-distance
    #[arg(long, value_parser = choice::<OcclusionFalloff>(), value_name = "HOW", default_value = "none", requires = "ao_distance")]
    pub ao_falloff: OcclusionFalloff,

    /// How the directions of occlusion and bent normals are weighted
    #[arg(long, value_parser = choice::<OcclusionWeights>(), value_name = "HOW", default_value = "cosine")]
    pub ao_weights: OcclusionWeights,

    /// Let parts of the high models be occluded by themselves only, not by each other
    #[arg(long)]
    pub ao_own_part: bool,

    /// How far the other side is looked for by thickness, in the models' unit; without it at any distance
    #[arg(long, value_name = "DISTANCE", value_parser = distance)]
    pub thickness_distance: Option<f32>,

    /// The radius in which curvature is measured: texels, as in 4texels, or a distance in the models' unit
    #[arg(long, value_name = "RADIUS", default_value = "4texels", value_parser = curvature_radius)]
    pub curvature_radius: CurvatureRadius,

    /// What the colours of an id map stand for
    #[arg(long, value_parser = choice::<IdSource>(), value_name = "WHAT", default_value = "material")]
    pub id_from: IdSource,

    /// The texture of the map texture: its place in the JSON of the high models' materials
    #[arg(long, value_name = "PLACE")]
    pub texture: Option<String>,

    /// The direction of the map world-direction, along the axes of glTF, where y is up
    #[arg(long, value_name = "X,Y,Z", default_value = "0,1,0", value_parser = direction, allow_hyphen_values = true)]
    pub world_direction: Direction,
}

/// `--pack`: an image whose channels are maps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pack {
    pub name: String,
    pub maps: Vec<MapKind>,
}

/// A direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction(pub [f32; 3]);

/// `--samples`, as samples per axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SamplesPerAxis(pub u32);

impl BakeArguments {
    /// These arguments with the image and the maps that they leave out.
    pub fn completed(self) -> Self {
        let output = match &self.write_model {
            Some(model) if self.names_model_only() => model.with_extension("png"),
            _ => self.output.clone(),
        };
        Self { output, map: self.completed_map(), ..self }
    }

    /// `--map`, or what it is where it is left out.
    pub fn completed_map(&self) -> Vec<MapChoice> {
        match &self.map[..] {
            [] if self.names_model_only() => vec![MapChoice::Material],
            [] => vec![MapChoice::Map(MapKind::Normal)],
            given => given.to_vec(),
        }
    }

    fn names_model_only(&self) -> bool {
        self.write_model.is_some() && self.output.as_os_str().is_empty()
    }

    /// The maps of `--map`, each once.
    pub fn maps(&self) -> Vec<MapKind> {
        let mut maps: Vec<MapKind> = Vec::new();
        for &map in self.map.iter().flat_map(MapChoice::maps) {
            if !maps.contains(&map) {
                maps.push(map);
            }
        }
        maps
    }

    /// The maps that are baked: the maps of `--map` and the packed ones.
    pub fn baked_maps(&self) -> MapSet {
        let packed = self.pack.iter().flat_map(|pack| &pack.maps).copied();
        MapSet::of(&self.maps().into_iter().chain(packed).collect::<Vec<_>>())
    }

    /// What is baked of the low model.
    pub fn low_options(&self) -> LowModelOptions {
        LowModelOptions::default()
            .with_uv_set(self.uv_set)
            .with_tangents(self.method.map(Into::into))
            .with_material(self.material)
    }

    /// What counts on the high models.
    pub fn high_options(&self) -> HighModelOptions {
        HighModelOptions::default()
            .with_normal_maps(!self.no_high_maps)
            .with_maps(self.baked_maps())
            .with_texture(self.content.texture.clone())
    }

    /// The bits per channel of the file of a map.
    pub fn bits_of_map(&self, kind: FileKind, map: MapKind) -> u8 {
        self.bits.unwrap_or_else(|| kind.default_bits(map))
    }

    /// The bits per channel of the files of packed maps.
    pub fn bits_of_packs(&self, kind: FileKind) -> u8 {
        self.bits.unwrap_or(kind.bits()[0])
    }

    /// Whether images of the high models are decoded.
    pub fn reads_textures(&self) -> bool {
        let needs_textures = |map| {
            use MapKind::{BaseColor, Emission, Metalness, Opacity, Roughness, Texture};
            matches!(map, BaseColor | Emission | Metalness | Opacity | Roughness | Texture)
        };
        !self.no_high_maps || self.baked_maps().kinds().any(needs_textures)
    }

    /// Whether a file may be replaced if it exists.
    pub fn may_replace(&self, path: &Path) -> bool {
        self.force
            || match &self.own_outputs {
                OwnOutputs::None => false,
                OwnOutputs::Files(files) => files.iter().any(|file| FileId::of(file) == FileId::of(path)),
                OwnOutputs::All => true,
            }
    }

    /// How a file is written.
    pub fn save_options(&self, path: &Path) -> SaveOptions {
        SaveOptions::default().with_force(self.may_replace(path))
    }

    /// The convention of the maps.
    pub fn map_convention(&self) -> Convention {
        self.convention.convention
    }
}

/// A path that may be empty: jobs name their own outputs.
fn any_path() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().map(PathBuf::from)
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse().ok().filter(|side| (1..=32768).contains(side));
    let sides = match text.split_once('x') {
        Some((width, height)) => side(width).zip(side(height)),
        None => side(text).map(|side| (side, side)),
    };
    sides.map(<[u32; 2]>::from).ok_or_else(|| "expected 1 to 32768, or a size such as 2048x1024".to_owned())
}

fn bits(text: &str) -> Result<u8, String> {
    let known = text.parse().ok().filter(|bits| [8, 16, 32].contains(bits));
    known.ok_or_else(|| "expected 8 or 16, or 32 for EXR and TIFF".to_owned())
}

fn pack(text: &str) -> Result<Pack, String> {
    let expected = || {
        "expected a name and two to four maps of one channel, such as orm=ao,roughness,metalness".to_owned()
    };
    let (name, maps) = text.split_once('=').ok_or_else(expected)?;
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '-' || letter == '_';
    if name.is_empty() || !name.chars().all(is_plain) {
        return Err(expected());
    }
    let maps = maps.split(',').map(MapKind::from_name).collect::<Result<Vec<_>, _>>();
    let maps = maps.map_err(|error| error.to_string())?;
    match maps.iter().find(|map| map.channels() != 1) {
        Some(map) => {
            Err(format!("{} has {} channels; pack maps of one channel each", map.name(), map.channels()))
        }
        None if (2..=4).contains(&maps.len()) => Ok(Pack { name: name.to_owned(), maps }),
        None => Err(expected()),
    }
}

fn samples_per_axis(text: &str) -> Result<SamplesPerAxis, String> {
    let per_axis = (1..=16).find(|per_axis| (per_axis * per_axis).to_string() == text);
    per_axis
        .map(SamplesPerAxis)
        .ok_or_else(|| "expected a square number from 1 to 256, such as 16".to_owned())
}

fn distance(text: &str) -> Result<f32, String> {
    let number = text.parse().ok().filter(|x: &f32| x.is_finite() && *x > 0.0);
    number.ok_or_else(|| "expected a number above 0".to_owned())
}

fn share(text: &str) -> Result<f32, String> {
    let number = text.parse().ok().filter(|x: &f32| (0.0..1.0).contains(x));
    number.ok_or_else(|| "expected a share from 0 on and below 1, such as 0.001".to_owned())
}

fn curvature_radius(text: &str) -> Result<CurvatureRadius, String> {
    let radius = match text.strip_suffix("texels") {
        Some(texels) => distance(texels.trim()).map(CurvatureRadius::Texels),
        None => distance(text).map(CurvatureRadius::Distance),
    };
    radius.map_err(|_| "expected a number above 0 such as 0.05, or texels such as 4texels".to_owned())
}

fn direction(text: &str) -> Result<Direction, String> {
    let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    let vector = numbers.and_then(|numbers| <[f32; 3]>::try_from(numbers).ok());
    let usable = |vector: &[f32; 3]| vector.iter().all(|x| x.is_finite()) && *vector != [0.0; 3];
    vector
        .filter(usable)
        .map(Direction)
        .ok_or_else(|| "expected three numbers such as 0,1,0, of which one is not 0".to_owned())
}

fn two_distances(text: &str) -> Result<[f32; 2], String> {
    let number = |text: &str| text.trim().parse().ok().filter(|x: &f32| x.is_finite() && *x >= 0.0);
    let both = text.split_once(',').and_then(|(out, inside)| Some([number(out)?, number(inside)?]));
    both.filter(|both| *both != [0.0; 2]).ok_or_else(|| {
        "expected two numbers such as 0.05,0.02, of which none is negative and one is above 0".to_owned()
    })
}
