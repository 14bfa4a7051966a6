//! The arguments of `darboux tangents`.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use darboux::{Choice, Method, Mode};
use darboux_io::gltf::TangentEncoding;

use crate::options::angle::degrees;
use crate::options::choice::choice;
use crate::options::files::FileOptions;
use crate::options::messages::MessageOptions;
use crate::options::shading::{NormalsChoice, normals_choice};

pub const ABOUT: &str = "\
Add tangents to models, which are read as glTF, GLB or other formats and written as glTF, GLB, PLY or OBJ.

Every triangle primitive with positions, normals and UVs gets MikkTSpace tangents for the UV set that its \
normal map uses. Vertices are split where their corners need different tangents, as at mirrored seams; \
skins, colours, UV sets and morph targets are split with them. The rest of the file does not change. The \
command names each primitive that gets no tangents, with the reason; a file without changes is copied.

Without -o, --out-dir or --in-place the output is written beside its input: model.glb becomes \
model.tangents.glb. The extension of the output selects the container: .glb contains everything; .gltf gets \
files beside it: its buffer, in which images stay that were in a buffer or in another format, and copies of \
image files.

Folders are searched for models of all formats that are read, subfolders included; with --in-place for glTF \
only. A model of another format becomes a .glb: chair.fbx becomes chair.tangents.glb, or \
chair.fbx.tangents.glb where there is a chair.glb as well. Files named like outputs (model.tangents.glb) and \
the folder of --out-dir are skipped in this search; name such a file to process it.";

pub const EXAMPLES: &str = "\
Examples:
  darboux tangents model.glb                        writes model.tangents.glb
  darboux tangents model.gltf -o model.glb          everything in one file
  darboux tangents chair.obj -o chair.glb           another format
  darboux tangents models --out-dir out             a folder and its subfolders
  darboux tangents models --out-dir out --resume    only what is missing or out of date
  darboux tangents models --in-place --only-needed  only where materials use tangents
  darboux tangents a.glb --overwrite --json         replace tangents, report as JSON
  darboux tangents a.glb --encoding snorm8x4        a quarter of the size
  darboux tangents a.glb --device gpu               the same bits, computed on a GPU
  darboux tangents scan.glb --normals smooth        generate normals first
  curl -s URL | darboux tangents - > model.glb      from a pipe to a file";

/// Which tangents are computed, and how they are stored.
#[derive(Debug, Args)]
pub struct TangentsArguments {
    #[command(flatten)]
    pub files: FileOptions,

    /// How tangents are computed: as the normal map was baked, so nearly always mikktspace
    ///
    /// `darboux methods` explains the choice.
    #[arg(
        long,
        value_parser = choice::<Method>(),
        value_name = "NAME",
        default_value = Method::default().name(),
        help_heading = "Tangents"
    )]
    pub method: Method,

    /// Which defects of the MikkTSpace reference implementation are kept
    #[arg(long, value_parser = choice::<Mode>(), default_value = Mode::default().name(), help_heading = "Tangents")]
    pub mode: Mode,

    /// Split the tangents of faces whose directions differ by this angle or more, in degrees
    ///
    /// Bakers use 180, which splits tangents only where UVs are mirrored or separate. Only mikktspace has a
    /// threshold. Below 180 the faces around a vertex are compared in pairs: a vertex with 20,000 faces
    /// takes about 2 s, one with 100,000 about a minute. At 180 only such vertices whose faces have
    /// random or nearly opposite directions take seconds.
    #[arg(
        long,
        value_name = "DEGREES",
        default_value_t = 180.0,
        value_parser = degrees::<f32>,
        allow_negative_numbers = true,
        help_heading = "Tangents"
    )]
    pub threshold: f32,

    /// The device that computes the tangents; all devices give the same bits
    ///
    /// auto is the CPU: at best a GPU halves the time of a mesh that comes from a file, and no GPU has been
    /// measured yet. If your GPU is faster, set the environment variable DARBOUX_GPU_TRIANGLES to a
    /// number of triangles: auto then uses the GPU for meshes with at least this many, and falls back to
    /// the CPU with a warning if the GPU fails. gpu requires --method mikktspace; the CPU still computes
    /// rare cases. `darboux devices` lists the adapters.
    #[arg(long, value_enum, value_name = "DEVICE", default_value_t, help_heading = "Tangents")]
    pub device: Device,

    /// Generate missing normals first: flat, smooth or crease=DEG (smooth except at edges sharper than DEG
    /// degrees); keep generates none
    ///
    /// With --overwrite existing normals are replaced as well. `darboux normals` has more options.
    #[arg(
        long,
        value_name = "SHADING",
        default_value = "keep",
        value_parser = normals_choice,
        help_heading = "Tangents"
    )]
    pub normals: NormalsChoice,

    /// How tangents are stored: f32x4 (16 bytes), snorm16x4 (8 bytes) or snorm8x4 (4 bytes)
    ///
    /// snorm16x4 has an error of up to 0.0016 degrees, snorm8x4 of up to 0.40 degrees. Both make the file
    /// require the extension KHR_mesh_quantization. glTF has no other encodings.
    #[arg(
        long,
        value_name = "NAME",
        default_value = "f32x4",
        hide_possible_values = true,
        value_parser = encoding_parser(),
        help_heading = "Tangents"
    )]
    pub encoding: TangentEncoding,

    /// Replace existing tangents, and with --normals existing normals; without it they are kept
    #[arg(long, help_heading = "Tangents")]
    pub overwrite: bool,

    /// Process only primitives whose material uses tangents (normal map, clearcoat normal map, anisotropy)
    #[arg(long, help_heading = "Tangents")]
    pub only_needed: bool,

    /// Apply KHR_texture_transform to the UVs first
    ///
    /// The default follows the specification: tangents belong to the stored UVs. Some renderers expect
    /// tangents of the transformed UVs. The two differ if a transform rotates or mirrors, which a
    /// warning reports.
    #[arg(long, help_heading = "Tangents")]
    pub apply_texture_transform: bool,

    /// Fail for files with non-finite vertex data or with corners that have no usable tangent
    #[arg(long, help_heading = "Input")]
    pub strict: bool,

    #[command(flatten)]
    pub messages: MessageOptions,
}

/// `--device`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Device {
    /// The CPU, unless DARBOUX_GPU_TRIANGLES is set
    #[default]
    Auto,
    /// The CPU, with all its cores
    Cpu,
    /// The fastest GPU; a file fails if there is none or if the GPU fails
    Gpu,
}

/// Encodings of the library that glTF does not support.
const NOT_GLTF: [&str; 4] = ["snorm10", "octahedral", "diamond", "quaternion"];

fn encoding_parser() -> impl TypedValueParser<Value = TangentEncoding> {
    let known = TangentEncoding::ALL.iter().map(|encoding| PossibleValue::new(encoding.name()));
    let refused = NOT_GLTF.map(|name| PossibleValue::new(name).hide(true));
    PossibleValuesParser::new(known.chain(refused)).try_map(|name| {
        TangentEncoding::from_name(&name)
            .map_err(|_| "glTF does not support this encoding; it can hold f32x4, snorm16x4 and snorm8x4")
    })
}
