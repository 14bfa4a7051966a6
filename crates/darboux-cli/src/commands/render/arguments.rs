//! The arguments of `darboux render`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::options::messages::MessageOptions;
use crate::options::method::MethodName;
use crate::options::reading::ReadOptions;

pub const ABOUT: &str = "\
Draw a model or its tangents into a PNG, without a window.

The views are those of `darboux view`, by the same names: what the surface is painted with, vectors as lines, mirrored seams, the UV \
layout, two sources side by side, and mistakes. The scene is drawn in its pose: nodes, mirrors included, skins, morph targets and instances; \
animations rest. Parts without a normal map are shaded with a pattern of domes, so that wrong tangents show.

Drawing needs an adapter, as `darboux devices` lists them; software ones such as Mesa's lavapipe do.";

pub const EXAMPLES: &str = "\
Examples:
  darboux render model.glb -o model.png
  darboux render model.glb -o t.png --view tangent --tangents lengyel
  darboux render model.glb -o angle.png --view angle --tangents file --against mikktspace
  darboux render model.glb -o lines.png --lines tangent,normal --seams --layout corner
  darboux render model.glb -o split.png --tangents mikktspace --against derivatives --split 50
  darboux render model.glb -o green.png --split 50 --mistakes green
  darboux render model.glb -o shield.png --mesh Shield
  darboux render model.glb -o back.png --camera 180,10,1.5 --size 1920x1080";

/// `darboux render`.
#[derive(Debug, Args)]
pub struct RenderArguments {
    /// A model (.gltf, .glb, .vrm, .obj)
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,

    /// The picture
    #[arg(short, long, value_name = "PNG")]
    pub output: PathBuf,

    /// What the surface is painted with
    #[arg(long, value_enum, value_name = "VIEW", default_value_t)]
    pub view: ViewChoice,

    /// Whose tangents: file, derivatives (what shaders do that have none), or a method, as `darboux methods` lists them
    ///
    /// Without it those of the file, and MikkTSpace's where it has none.
    #[arg(long, value_name = "SOURCE", value_parser = source)]
    pub tangents: Option<TangentSource>,

    /// The other tangents: what --view angle compares with, and what --split shows on the right
    #[arg(long, value_name = "SOURCE", value_parser = source, required_if_eq_any([("view", "angle"), ("view", "heat")]))]
    pub against: Option<TangentSource>,

    /// Show --tangents left of so many percent of the width, and --against right of them; or the same there, with --mistakes
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    pub split: Option<f64>,

    /// Draw these vectors at the vertices
    #[arg(long, value_enum, value_name = "VECTORS", value_delimiter = ',')]
    pub lines: Vec<VectorLines>,

    /// Length of lines, in percent of the model's radius
    #[arg(long, value_name = "PERCENT", default_value = "2", value_parser = percent)]
    pub length: f64,

    /// Draw the edges across which the sign changes: where a texture meets its mirror image
    #[arg(long)]
    pub seams: bool,

    /// Draw the UV layout in the surface's colours (signs where it is shaded), v down
    #[arg(long, value_enum, value_name = "PLACE")]
    pub layout: Option<LayoutPlacement>,

    /// Do this wrong; right of --split, or everywhere
    #[arg(long, value_enum, value_name = "MISTAKES", value_delimiter = ',')]
    pub mistakes: Vec<MistakeChoice>,

    /// Draw this mesh alone: its name, or else its index; several times for several
    #[arg(long, value_name = "MESH", allow_hyphen_values = true)]
    pub mesh: Vec<String>,

    /// Pixels across and down
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = size)]
    pub size: [u32; 2],

    /// Degrees around the model (0 is its front), degrees above the horizon, and how many times nearer than all of it in view
    #[arg(
        long,
        value_name = "YAW,PITCH[,ZOOM]",
        default_value = "30,20,1",
        value_parser = camera,
        allow_hyphen_values = true
    )]
    pub camera: [f64; 3],

    /// The colour behind the model
    #[arg(long, value_name = "RRGGBB", default_value = "eceff1", value_parser = color)]
    pub background: [u8; 3],

    /// Leave out what explains the colours, and the names of both sides
    #[arg(long)]
    pub no_legend: bool,

    /// Replace a picture that exists
    #[arg(long)]
    pub force: bool,

    #[command(flatten)]
    pub reading: ReadOptions,

    #[command(flatten)]
    pub messages: MessageOptions,
}

/// `--view`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ViewChoice {
    /// The surface with its base colour and normal map, lit from above right
    #[default]
    Shaded,
    /// Tangents as colours, 0.5 + 0.5 of each component in the scene
    Tangent,
    /// Bitangents, likewise
    Bitangent,
    /// Normals of the mesh, likewise
    Normal,
    /// The sign w: blue 1, orange -1
    Sign,
    /// The angle between --tangents and --against, from 0.01 to 180 degrees; red where signs differ
    #[value(alias = "heat")]
    Angle,
}

/// `--lines`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum VectorLines {
    /// Red
    Tangent,
    /// Green
    Bitangent,
    /// Blue
    Normal,
}

/// `--layout`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LayoutPlacement {
    /// Over the lower right corner
    Corner,
    /// In place of the model
    Alone,
}

/// `--mistakes`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MistakeChoice {
    /// Flip the normal map's green channel
    Green,
    /// Flip the sign of tangents
    W,
    /// Sample images at 1 - v
    V,
}

/// `--tangents` and `--against`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentSource {
    /// What the file has.
    File,
    /// What shaders derive.
    Derivatives,
    /// What a method computes.
    Method(MethodName),
}

impl TangentSource {
    /// As it is typed.
    pub fn name(self) -> String {
        match self {
            Self::File => "file".to_owned(),
            Self::Derivatives => "derivatives".to_owned(),
            Self::Method(method) => {
                method.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
            }
        }
    }
}

fn source(text: &str) -> Result<TangentSource, String> {
    let unknown = |_| "neither file, derivatives nor a method; `darboux methods` lists them".to_owned();
    match text {
        "file" => Ok(TangentSource::File),
        "derivatives" => Ok(TangentSource::Derivatives),
        method => MethodName::from_str(method, false).map(TangentSource::Method).map_err(unknown),
    }
}

fn percent(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (0.0..=100.0).contains(number));
    number.ok_or_else(|| "not a number from 0 to 100".to_owned())
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides =
        text.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    sides.ok_or_else(|| "not a size such as 1024x768".to_owned())
}

fn camera(text: &str) -> Result<[f64; 3], String> {
    let parts: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    let (yaw, pitch, zoom) = match parts.as_deref() {
        Some(&[yaw, pitch]) => (yaw, pitch, 1.0),
        Some(&[yaw, pitch, zoom]) => (yaw, pitch, zoom),
        _ => return Err("not two or three numbers such as 30,20 or 30,20,1.5".to_owned()),
    };
    if !((-360.0..=360.0).contains(&yaw)
        && (-90.0..=90.0).contains(&pitch)
        && (0.01..=1000.0).contains(&zoom))
    {
        return Err("not from -360 to 360, -90 to 90 and 0.01 to 1000".to_owned());
    }
    Ok([yaw, pitch, zoom])
}

fn color(text: &str) -> Result<[u8; 3], String> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    let is_color = digits.len() == 6 && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let number = u32::from_str_radix(digits, 16).ok().filter(|_| is_color);
    let [_, r, g, b] = number.ok_or("not a colour of six hexadecimal digits such as eceff1")?.to_be_bytes();
    Ok([r, g, b])
}
