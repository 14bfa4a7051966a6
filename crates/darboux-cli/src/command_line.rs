//! The one definition of the command line. Help, man pages, completions and docs/cli.md are generated from it.

use clap::{Parser, Subcommand};

use crate::commands::compare::arguments::{self as compare, CompareArguments};
use crate::commands::convert::arguments::{self as convert, ConvertArguments};
#[cfg(feature = "gpu")]
use crate::commands::devices::arguments::{self as devices, DevicesArguments};
use crate::commands::inspect::arguments::{self as inspect, InspectArguments};
#[cfg(not(all(feature = "gpu", feature = "view")))]
use crate::commands::missing::MissingArguments;
use crate::commands::normals::arguments::{self as normals, NormalsArguments};
#[cfg(feature = "gpu")]
use crate::commands::render::arguments::{self as render, RenderArguments};
use crate::commands::tangents::arguments::{self as tangents, TangentsArguments};
#[cfg(feature = "view")]
use crate::commands::view::arguments::{self as view, ViewArguments};

/// Tangents for normal-mapped glTF models: MikkTSpace bit for bit, seams split
#[derive(Debug, Parser)]
#[command(name = "darboux", version, about, long_about = LONG_ABOUT, arg_required_else_help = true, max_term_width = 100)]
pub struct Arguments {
    /// What to do
    #[command(subcommand)]
    pub command: Command,
}

const LONG_ABOUT: &str = "\
Tangents for normal-mapped glTF models: MikkTSpace bit for bit, seams split.

A normal map looks right only when the renderer's tangents are the baker's. Darboux computes MikkTSpace tangents, \
as bakers do, and writes them into .gltf and .glb files without changing anything else.

Messages go to standard error. Exit codes: 0 done (nothing to do included), 1 an input is bad or a file failed, \
2 wrong usage, 3 compared files are further apart than asked for. Ctrl-C, SIGTERM and SIGHUP let a file be finished that is being \
written, then end the command with 128 plus the number of the signal.";

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Add tangents to glTF and GLB files
    #[command(long_about = tangents::ABOUT, after_long_help = tangents::EXAMPLES)]
    Tangents(TangentsArguments),
    /// Add normals to glTF and GLB files
    #[command(long_about = normals::ABOUT, after_long_help = normals::EXAMPLES)]
    Normals(NormalsArguments),
    /// Convert normal maps and models between conventions
    #[command(
        long_about = convert::ABOUT,
        after_long_help = convert::EXAMPLES,
        mut_arg("inputs", |inputs| inputs.help(convert::INPUTS)),
        mut_arg("output", |output| output.help(convert::OUTPUT))
    )]
    Convert(ConvertArguments),
    /// Compare the tangents of two files, or of a file and a method
    #[command(long_about = compare::ABOUT, after_long_help = compare::EXAMPLES)]
    Compare(CompareArguments),
    /// Show what each primitive holds and what its tangents would meet
    #[command(long_about = inspect::ABOUT, after_long_help = inspect::EXAMPLES)]
    Inspect(InspectArguments),
    /// Draw a model or its tangents into a PNG
    #[cfg(feature = "gpu")]
    #[command(long_about = render::ABOUT, after_long_help = render::EXAMPLES)]
    Render(RenderArguments),
    /// Show a model in the browser, with its tangents
    #[cfg(feature = "view")]
    #[command(long_about = view::ABOUT, after_long_help = view::EXAMPLES)]
    View(ViewArguments),
    /// Say which method of computing tangents is for what
    Methods,
    /// List the adapters that can compute tangents
    #[cfg(feature = "gpu")]
    #[command(long_about = devices::ABOUT)]
    Devices(DevicesArguments),
    #[cfg(not(feature = "gpu"))]
    #[command(hide = true)]
    Render(MissingArguments),
    #[cfg(not(feature = "view"))]
    #[command(hide = true)]
    View(MissingArguments),
    #[cfg(not(feature = "gpu"))]
    #[command(hide = true)]
    Devices(MissingArguments),
}
