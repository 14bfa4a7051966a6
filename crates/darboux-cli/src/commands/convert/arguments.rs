//! The arguments of `darboux convert`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use darboux_io::image::Channels;

use crate::options::convention::{ConventionParser, NamedConvention};
use crate::options::files::FileOptions;
use crate::options::formats::with_endings;
use crate::options::messages::MessageOptions;

pub const ABOUT: &str = "\
Convert normal maps and models between conventions.

What is converted depends on the input: of an image its texels, of a model its geometry, never the images in \
or beside it. To invert green in the normal maps of a model, use darboux check MODEL --fix --assume \
map=directx (or map=opengl): convert would mirror or turn the model instead.

Normal maps (PNG, 8 or 16 bits): red and green are inverted where the conventions differ. This is exact, so \
that converting back restores the original texels. --layout and --to-layout move the vector to other \
channels (DXT5nm uses ag, two-channel maps use rg); a channel that holds no part of the vector keeps its \
values unless a component moves into it. Metadata chunks are kept, except for palettes, colour profiles and \
others that do not fit the new channels. A warning names images that do not look like normal maps.

--space converts object-space maps to tangent space, for any renderer's convention, and back. Texels outside \
the UV charts of --model are filled from the nearest one. It is in builds with the feature bake or full.

Models: positions, normals, tangents, UVs, morph targets and the winding of triangles are converted; if the \
axes differ, nodes, skins and animations too. A glTF file must be in glTF's convention, so this repairs \
files whose writer copied the numbers of another convention (--to gltf). For programs that use the numbers \
of a file as they are, --raw allows any --to; such a file is no valid glTF until it is converted back. It \
names its convention in asset.extras, and the other commands refuse it. Images, cameras and lights are not \
converted; warnings name them. Without --from and --to, a model is only written in another format: readers \
of OBJ, FBX, PLY and STL have already turned it to glTF's convention.

A convention is a preset, optionally followed by differences after commas: gltf,green=down. The differences \
are: axes=-x/y/z (right, up, front), fronts=ccw or cw, v0=bottom or top, red=right or left, green=up or \
down, w=n-cross-t or t-cross-n. docs/conventions.md in the source of Darboux defines them. Without -o, \
--out-dir or --in-place the output is named after its convention: brick.png becomes brick.directx.png, or \
brick.converted.png if the convention is not a preset.";

pub const EXAMPLES: &str = "\
Examples:
  darboux convert brick_n.png --from opengl --to directx      inverts green, writes brick_n.directx.png
  darboux convert *_n.png --from unreal --to gltf --in-place  many normal maps
  darboux convert n.png --from gltf --to gltf --layout ag --to-layout rgb
                                                              unpacks two channels and computes z
  darboux convert object_n.png --space tangent --model low.glb --from gltf --to unreal
                                                              an object-space map for Unreal Engine
  darboux convert exported.glb --from unity --to gltf         repairs the geometry of a file with Unity's numbers
  darboux convert scene.fbx -o scene.glb                      another format, nothing else
  darboux check model.glb --fix --assume map=directx          inverts green in the maps of a model: not convert
  darboux convert model.glb --from gltf --to unreal --raw     for a loader that expects Unreal's numbers";

pub const OUTPUT: &str = "Output file for a single input, in an existing folder; - is standard output";
pub const INPUTS: &str = "Normal maps (.png), models ({models}) and folders of models; - is standard input";

/// The conventions and channel layouts of the input and the output.
#[derive(Debug, Args)]
pub struct ConvertArguments {
    #[command(flatten)]
    pub files: FileOptions,

    /// The convention of the inputs; without it and --to, models are written in another format only
    #[arg(long, value_name = "CONVENTION", value_parser = ConventionParser, requires = "to", help_heading = "Conversion")]
    pub from: Option<NamedConvention>,

    /// The convention of the outputs
    #[arg(long, value_name = "CONVENTION", value_parser = ConventionParser, requires = "from", help_heading = "Conversion")]
    pub to: Option<NamedConvention>,

    /// The channels of x, y and, if stored, z of a normal map: rgb, rg, ag, la, ...
    #[arg(long, value_name = "LETTERS", default_value_t = Channels::RGB, help_heading = "Conversion")]
    pub layout: Channels,

    /// The channels in the output; by default those of --layout. A z that is not stored is computed from x
    /// and y
    #[arg(long, value_name = "LETTERS", help_heading = "Conversion")]
    pub to_layout: Option<Channels>,

    /// Convert normal maps to this space from the other one, with the frames of --model
    #[arg(long, value_enum, value_name = "SPACE", requires = "model", help_heading = "Conversion")]
    pub space: Option<SpaceChoice>,

    #[arg(long, value_name = "LOW", requires = "space", help_heading = "Conversion", help = with_endings("The model that has the map ({models}), with the tangents of its file, or MikkTSpace's"))]
    pub model: Option<PathBuf>,

    /// The UV set n of TEXCOORD_n of the model; by default that of the material's normal map
    #[arg(long, value_name = "N", requires = "space", help_heading = "Conversion")]
    pub uv_set: Option<usize>,

    /// Allow models in other conventions than glTF's, for programs that use the numbers as they are
    #[arg(long, help_heading = "Conversion")]
    pub raw: bool,

    #[command(flatten)]
    pub messages: MessageOptions,
}

impl ConvertArguments {
    /// The two conventions; both are glTF's where only the format changes.
    pub fn conventions(&self) -> [NamedConvention; 2] {
        [&self.from, &self.to].map(|convention| convention.clone().unwrap_or_else(NamedConvention::gltf))
    }

    /// Whether no conventions are named.
    pub fn only_format_changes(&self) -> bool {
        self.from.is_none()
    }
}

/// `--space`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SpaceChoice {
    /// Tangent space, from an object-space map
    Tangent,
    /// Object space, from a tangent-space map: the space of the model's scene
    Object,
}
