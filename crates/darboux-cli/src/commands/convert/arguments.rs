//! The arguments of `darboux convert`.

use clap::Args;
use darboux_io::image::Channels;

use crate::options::convention::{ConventionParser, NamedConvention};
use crate::options::files::FileOptions;
use crate::options::messages::MessageOptions;

pub const ABOUT: &str = "\
Convert normal maps and models between conventions.

Normal maps (PNG, 8 or 16 bits): red and green are inverted where the conventions differ, to the bit, so that converting back gives the \
first texels. Channels can be moved (DXT5nm's ag, two-channel rg); those that hold nothing of the vector keep what they hold, unless one \
moves into them. Chunks stay, but for palettes, profiles and the like that do not fit other channels. A warning names images that do not \
look like normal maps.

Models: positions, normals, tangents, UVs, morph targets and the winding of triangles change; where axes differ, nodes, skins and \
animations too. A glTF file must be in glTF's convention, so this puts files right whose writer copied the numbers of another one \
(--to gltf). For a program that copies numbers out of the file as they are, --raw allows any --to; such a file is no right glTF until \
it is converted back, says so in asset.extras, and other commands refuse it. Images, cameras and lights stay; warnings name them.

A convention is a name, and what differs from it, separated by commas: gltf,green=down. What can differ: axes=-x/y/z (right, up, front), \
fronts=ccw or cw, v0=bottom or top, red=right or left, green=up or down, w=n-cross-t or t-cross-n. \
docs/conventions.md in Darboux's source defines them all. Without -o, --out-dir or --in-place the output is named by its convention: brick.png \
becomes brick.directx.png, or brick.converted.png where a name is not all of it.";

pub const EXAMPLES: &str = "\
Examples:
  darboux convert brick_n.png --from opengl --to directx      green inverted: brick_n.directx.png
  darboux convert *_n.png --from unreal --to gltf --in-place  a set of normal maps
  darboux convert n.png --from gltf --to gltf --layout ag --to-layout rgb
                                                              unpacked, z rebuilt
  darboux convert exported.glb --from unity --to gltf         a file that holds Unity's numbers, put right
  darboux convert model.glb --from gltf --to unreal --raw     numbers for a loader of one's own";

pub const OUTPUT: &str = "Output file for a single input, in a folder that exists; - is standard output";
pub const INPUTS: &str = "Normal maps (.png) and models (.gltf, .glb, .vrm); - is standard input";

/// `darboux convert`.
#[derive(Debug, Args)]
pub struct ConvertArguments {
    #[command(flatten)]
    pub files: FileOptions,

    /// The convention that the files are in
    #[arg(long, value_name = "CONVENTION", value_parser = ConventionParser, help_heading = "Conversion")]
    pub from: NamedConvention,

    /// The convention that they shall be in
    #[arg(long, value_name = "CONVENTION", value_parser = ConventionParser, help_heading = "Conversion")]
    pub to: NamedConvention,

    /// Channels of a normal map's x, y and, where it is stored, z, in this order: rgb, rg, ag, la, ...
    #[arg(long, value_name = "LETTERS", default_value_t = Channels::RGB, help_heading = "Conversion")]
    pub layout: Channels,

    /// Channels that they shall be in; the same unless given. A z that was not stored is rebuilt
    #[arg(long, value_name = "LETTERS", help_heading = "Conversion")]
    pub to_layout: Option<Channels>,

    /// Let a model leave glTF's convention: for programs that copy its numbers as they are
    #[arg(long, help_heading = "Conversion")]
    pub raw: bool,

    #[command(flatten)]
    pub messages: MessageOptions,
}
