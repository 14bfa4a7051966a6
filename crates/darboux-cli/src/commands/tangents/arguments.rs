//! The arguments of `darboux tangents`.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use darboux_io::gltf::TangentEncoding;

use crate::options::angle::degrees;
use crate::options::files::FileOptions;
use crate::options::messages::MessageOptions;
use crate::options::method::MethodName;
use crate::options::shading::{NormalsChoice, normals_choice};

pub const ABOUT: &str = "\
Add tangents to glTF and GLB files.

Every triangle primitive with positions, normals and UVs gets MikkTSpace tangents for the UV set that its normal map uses. \
Vertices are split where corners need different tangents (mirrored seams); skins, colours, UV sets and morph targets \
follow. Everything else stays as it was. A primitive that gets no tangents is named with its reason; a file with \
nothing to do is copied.

Without -o, --out-dir or --in-place the output lies beside its input: model.glb becomes model.tangents.glb. The output's \
extension decides the container: .glb embeds everything, .gltf writes its buffer beside it and brings images along.

Folders are searched for .gltf, .glb and .vrm, inner folders included. Names like model.tangents.glb are left out \
there, as they are outputs, and so is the folder of --out-dir; give such a file by name to use it.";

pub const EXAMPLES: &str = "\
Examples:
  darboux tangents model.glb                        writes model.tangents.glb
  darboux tangents model.gltf -o model.glb          the same into one file
  darboux tangents models --out-dir out             a whole folder, its structure kept
  darboux tangents models --out-dir out --resume    what an earlier run left to do
  darboux tangents models --in-place --only-needed  only where materials use tangents
  darboux tangents a.glb --overwrite --json         replace old tangents, report as JSON
  darboux tangents a.glb --encoding snorm8x4        in a quarter of the bytes
  darboux tangents a.glb --device gpu               the same bits, computed on a GPU
  darboux tangents scan.glb --normals smooth        normals first
  curl -s URL | darboux tangents - > model.glb      from a pipe into a file";

/// `darboux tangents`.
#[derive(Debug, Args)]
pub struct TangentsArguments {
    #[command(flatten)]
    pub files: FileOptions,

    /// How tangents are computed: as the normal map was baked, so nearly always mikktspace
    ///
    /// `darboux methods` explains the choice.
    #[arg(long, value_enum, value_name = "NAME", default_value_t, help_heading = "Tangents")]
    pub method: MethodName,

    /// Which defects of the MikkTSpace reference to keep
    #[arg(long, value_enum, default_value_t, help_heading = "Tangents")]
    pub mode: Mode,

    /// Split tangents of faces whose directions differ by this many degrees or more
    ///
    /// Bakers use 180: tangents are split only where they must be. Only mikktspace has a threshold.
    #[arg(
        long,
        value_name = "DEGREES",
        default_value_t = 180.0,
        value_parser = degrees::<f32>,
        allow_negative_numbers = true,
        help_heading = "Tangents"
    )]
    pub threshold: f32,

    /// What computes the tangents: the bits are the same
    ///
    /// auto takes the CPU: no measurement shows yet that a GPU is quicker once models have been read and sent to it. Where yours is, set
    /// DARBOUX_GPU_TRIANGLES to the triangles of a mesh from which on it is: auto then takes the GPU for these, and the CPU with a warning
    /// where it fails. gpu computes MikkTSpace there, and leaves to the CPU what is rare; `darboux devices` lists the adapters.
    #[arg(long, value_enum, value_name = "DEVICE", default_value_t, help_heading = "Tangents")]
    pub device: Device,

    /// keep normals as they are, or first make those that are missing: flat, smooth or crease=DEG
    ///
    /// With --overwrite all normals are made anew. `darboux normals` has more options.
    #[arg(
        long,
        value_name = "SHADING",
        default_value = "keep",
        value_parser = normals_choice,
        help_heading = "Tangents"
    )]
    pub normals: NormalsChoice,

    /// How tangents are stored: f32x4 (16 bytes), snorm16x4 (8) or snorm8x4 (4)
    ///
    /// Integers turn a direction by up to 0.0016 and 0.40 degrees, and need KHR_mesh_quantization, which the file then requires
    /// of its readers. glTF has no other encodings.
    #[arg(
        long,
        value_name = "NAME",
        default_value = "f32x4",
        hide_possible_values = true,
        value_parser = encoding_parser(),
        help_heading = "Tangents"
    )]
    pub encoding: TangentEncoding,

    /// Replace tangents that exist, and with --normals normals; without it such primitives are kept
    #[arg(long, help_heading = "Tangents")]
    pub overwrite: bool,

    /// Only primitives whose material uses tangents (normal map, clearcoat normal map, anisotropy)
    #[arg(long, help_heading = "Tangents")]
    pub only_needed: bool,

    /// Apply KHR_texture_transform to the UVs first
    ///
    /// The specification asks for tangents of the UVs as stored, which is the default. Some renderers expect tangents of
    /// the transformed UVs; the two differ where a transform rotates or mirrors, and then a warning says so.
    #[arg(long, help_heading = "Tangents")]
    pub apply_texture_transform: bool,

    /// Refuse files with non-finite vertex data or corners that have no usable tangent
    #[arg(long, help_heading = "Input")]
    pub strict: bool,

    #[command(flatten)]
    pub messages: MessageOptions,
}

/// `--device`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Device {
    /// The quicker one, as far as was measured: the CPU
    #[default]
    Auto,
    /// The CPU, on all its threads
    Cpu,
    /// The fastest adapter; without one, or where it fails, files fail
    Gpu,
}

/// `--mode`: [`darboux::Mode`] as people type it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Mode {
    /// Every bit of the reference, zero-length and non-finite tangents included
    Reference,
    /// The reference's bits where they are usable, a unit tangent elsewhere
    #[default]
    Repaired,
    /// As repaired, with all edges matched and one sign per triangle
    Corrected,
}

impl From<Mode> for darboux::Mode {
    fn from(mode: Mode) -> Self {
        match mode {
            Mode::Reference => Self::Reference,
            Mode::Repaired => Self::Repaired,
            Mode::Corrected => Self::Corrected,
        }
    }
}

/// Encodings of the library that a glTF file has no place for, by the names that people may try.
const NOT_GLTF: [&str; 4] = ["snorm10", "octahedral", "diamond", "quaternion"];

fn encoding_parser() -> impl TypedValueParser<Value = TangentEncoding> {
    let known = ["f32x4", "snorm16x4", "snorm8x4"].map(PossibleValue::new);
    let refused = NOT_GLTF.map(|name| PossibleValue::new(name).hide(true));
    PossibleValuesParser::new(known.into_iter().chain(refused)).try_map(|name| match name.as_str() {
        "f32x4" => Ok(TangentEncoding::F32x4),
        "snorm16x4" => Ok(TangentEncoding::Snorm16x4),
        "snorm8x4" => Ok(TangentEncoding::Snorm8x4),
        _ => Err("a glTF file cannot hold such tangents; it can hold f32x4, snorm16x4 and snorm8x4"),
    })
}
