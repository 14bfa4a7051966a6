//! The arguments of `darboux render`.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use darboux::{Choice, Method, UnknownName, choice};
use darboux_render::{FrameMistake, Look};

use crate::options::choice::possible_values;
use crate::options::formats::with_endings;
use crate::options::messages::MessageOptions;
use crate::options::reading::ReadOptions;

pub const ABOUT: &str = "\
Draw a model or its tangents into a PNG, without a window.

The views are those of `darboux view`, with the same names: colours on the surface, vectors as lines, \
mirrored seams, the UV layout, two sources of tangents side by side, and typical mistakes. The scene is \
drawn in its rest pose, with nodes, skins, morph targets and instances. Parts without a normal map hide \
wrong tangents; --view bumps puts test bumps on them.

Drawing needs a graphics adapter; `darboux devices` lists them. Software adapters such as Mesa's lavapipe \
work.";

pub const EXAMPLES: &str = "\
Examples:
  darboux render model.glb -o model.png
  darboux render model.glb -o t.png --view tangent --tangents lengyel
  darboux render model.glb -o angle.png --view angle --tangents file --against mikktspace
  darboux render model.glb -o lines.png --lines tangent,normal --seams --layout corner
  darboux render model.glb -o split.png --tangents mikktspace --against derivatives --split 50
  darboux render model.glb -o green.png --split 50 --mistakes green
  darboux render model.glb -o ground.png --ground --camera 30,25
  darboux render model.glb -o shield.png --mesh Shield
  darboux render model.glb -o same.png --look 1.2,0.8,3,0,0,0
  darboux render model.glb -o back.png --camera 180,10,1.5 --size 1920x1080";

/// What is drawn, and how.
#[derive(Debug, Args)]
pub struct RenderArguments {
    #[arg(value_name = "MODEL", help = with_endings("A model ({models})"))]
    pub model: PathBuf,

    /// The picture, in an existing folder
    #[arg(short, long, value_name = "PNG")]
    pub output: PathBuf,

    /// What the colours of the surface show
    #[arg(long, value_enum, value_name = "VIEW", default_value_t)]
    pub view: ViewChoice,

    /// The source of the tangents: file, derivatives (as shaders without tangents derive them), or a method;
    /// `darboux methods` lists the methods
    ///
    /// The default is the file's tangents, or MikkTSpace if the file has none.
    #[arg(long, value_name = "SOURCE", value_parser = source)]
    pub tangents: Option<TangentSource>,

    /// The second source of tangents, for --view angle and for the right side of --split
    #[arg(long, value_name = "SOURCE", value_parser = source, required_if_eq_any([("view", "angle"), ("view", "heat")]))]
    pub against: Option<TangentSource>,

    /// Divide the picture at this percentage of its width: --tangents on the left; --against, or --mistakes,
    /// on the right
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    pub split: Option<f64>,

    /// Draw these vectors at the vertices
    #[arg(long, value_enum, value_name = "VECTORS", value_delimiter = ',')]
    pub lines: Vec<VectorLines>,

    /// The length of the lines, in percent of the model's radius
    #[arg(long, value_name = "PERCENT", default_value = "2", value_parser = percent, requires = "lines")]
    pub length: f64,

    /// Draw mirrored seams: the edges across which the sign w changes
    #[arg(long)]
    pub seams: bool,

    /// Stand the lit model on a ground that shows its shadow, as the viewer does
    #[arg(long)]
    pub ground: bool,

    /// Draw the UV layout in the colours of the surface (in those of the sign for the shaded view), v down
    #[arg(long, value_enum, value_name = "PLACE")]
    pub layout: Option<LayoutPlacement>,

    /// Make these mistakes, on the right of --split or in the whole picture
    #[arg(long, value_parser = MistakeChoice::parser(), value_name = "MISTAKES", value_delimiter = ',')]
    pub mistakes: Vec<MistakeChoice>,

    /// Draw only this mesh, given by its name or index; can be repeated
    #[arg(long, value_name = "MESH", allow_hyphen_values = true)]
    pub mesh: Vec<String>,

    /// Width and height in pixels, at least 1x1
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = size)]
    pub size: [u32; 2],

    /// Degrees around the model (0 is its front), degrees above the horizon, and the magnification (1 shows
    /// the whole model)
    #[arg(
        long,
        value_name = "YAW,PITCH[,ZOOM]",
        default_value = "30,20,1",
        value_parser = camera,
        allow_hyphen_values = true
    )]
    pub camera: [f64; 3],

    /// Where the camera is and what it looks at, as `view=` in a link of the viewer has it; the light comes
    /// from where the viewer has it
    #[arg(
        long,
        value_name = "X,Y,Z,X,Y,Z",
        value_parser = look,
        allow_hyphen_values = true,
        conflicts_with = "camera"
    )]
    pub look: Option<Look>,

    /// The colour behind the model
    #[arg(long, value_name = "RRGGBB", default_value = "eceff1", value_parser = color)]
    pub background: [u8; 3],

    /// Draw no legend and no names of the two sides
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
    /// The surface with its materials in the viewer's studio, lit from the upper right
    #[default]
    Shaded,
    /// The same, with test bumps on parts without a normal map, which the file does not have
    Bumps,
    /// Tangents as colours: 0.5 + 0.5 times each component, in scene space
    Tangent,
    /// Bitangents in the same colours
    Bitangent,
    /// Normals of the mesh in the same colours
    Normal,
    /// The sign w: blue for 1, orange for -1
    Sign,
    /// The angle between --tangents and --against, from 0.01 to 180 degrees; red with stripes where the signs
    /// are opposite
    #[value(alias = "heat")]
    Angle,
}

/// `--lines`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum VectorLines {
    /// Red, unbroken
    Tangent,
    /// Green, three dashes
    Bitangent,
    /// Blue, two dashes
    Normal,
}

/// `--layout`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LayoutPlacement {
    /// In the lower right corner
    Corner,
    /// Instead of the model
    Alone,
}

/// `--mistakes`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MistakeChoice {
    /// In the shader.
    Shader(ShaderMistake),
    /// In the computation of tangents.
    Frames(FrameMistake),
}

/// A mistake of a shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShaderMistake {
    Green,
    W,
    V,
    Columns,
}

choice! { ShaderMistake, "mistake",
    Green => "green", "Invert the green channel of normal maps";
    W => "w", "Invert the sign w of tangents";
    V => "v", "Sample images at 1 - v";
    Columns => "columns", "Take the columns of the matrix as tangent, normal, bitangent";
}

impl MistakeChoice {
    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shader(mistake) => mistake.name(),
            Self::Frames(mistake) => mistake.name(),
        }
    }

    fn parser() -> impl TypedValueParser<Value = Self> {
        let values = possible_values::<ShaderMistake>().chain(possible_values::<FrameMistake>());
        PossibleValuesParser::new(values).try_map(|name| {
            let of_shader = name.parse().map(Self::Shader);
            of_shader.or_else(|_| name.parse().map(Self::Frames))
        })
    }
}

/// `--tangents` and `--against`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TangentSource {
    /// The tangents in the file.
    File,
    /// Tangents that shaders derive per pixel.
    Derivatives,
    /// The tangents of a method.
    Method(Method),
}

impl TangentSource {
    /// The name on the command line.
    pub fn name(self) -> String {
        match self {
            Self::File => "file".to_owned(),
            Self::Derivatives => "derivatives".to_owned(),
            Self::Method(method) => method.name().to_owned(),
        }
    }
}

fn source(text: &str) -> Result<TangentSource, String> {
    let unknown = |_: UnknownName| {
        "expected file, derivatives or a method; `darboux methods` lists the methods".to_owned()
    };
    match text {
        "file" => Ok(TangentSource::File),
        "derivatives" => Ok(TangentSource::Derivatives),
        method => method.parse().map(TangentSource::Method).map_err(unknown),
    }
}

fn percent(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (0.0..=100.0).contains(number));
    number.ok_or_else(|| "expected a number from 0 to 100".to_owned())
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse().ok().filter(|side| *side > 0);
    let sides = text.split_once('x').and_then(|(width, height)| Some([side(width)?, side(height)?]));
    sides.ok_or_else(|| "expected a size of at least 1x1, such as 1024x768".to_owned())
}

fn camera(text: &str) -> Result<[f64; 3], String> {
    let parts: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    let (yaw, pitch, zoom) = match parts.as_deref() {
        Some(&[yaw, pitch]) => (yaw, pitch, 1.0),
        Some(&[yaw, pitch, zoom]) => (yaw, pitch, zoom),
        _ => return Err("expected two or three numbers such as 30,20 or 30,20,1.5".to_owned()),
    };
    if !((-360.0..=360.0).contains(&yaw)
        && (-90.0..=90.0).contains(&pitch)
        && (0.01..=1000.0).contains(&zoom))
    {
        return Err("expected -360 to 360, -90 to 90 and 0.01 to 1000".to_owned());
    }
    Ok([yaw, pitch, zoom])
}

fn look(text: &str) -> Result<Look, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[a, b, c, x, y, z])
            if [a, b, c, x, y, z].iter().all(|x| x.abs() < 1e30) && [a, b, c] != [x, y, z] =>
        {
            Ok(Look { eye: [a, b, c], target: [x, y, z] })
        }
        _ => Err("expected six numbers, the position of the camera and another point, such as 0,0,5,0,0,0"
            .to_owned()),
    }
}

fn color(text: &str) -> Result<[u8; 3], String> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    let is_color = digits.len() == 6 && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let number = u32::from_str_radix(digits, 16).ok().filter(|_| is_color);
    let [_, r, g, b] =
        number.ok_or("expected a colour of six hexadecimal digits such as eceff1")?.to_be_bytes();
    Ok([r, g, b])
}
