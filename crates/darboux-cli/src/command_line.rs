//! The definition of the command line: the program and its subcommands. Help, man pages, completions and
//! docs/cli.md are generated from it.

use clap::{Parser, Subcommand};

#[cfg(feature = "bake")]
use crate::commands::bake::arguments::{self as bake, BakeArguments};
use crate::commands::check::arguments::{self as check, CheckArguments};
use crate::commands::compare::arguments::{self as compare, CompareArguments};
use crate::commands::completions::arguments::{self as completions, CompletionsArguments};
use crate::commands::convert::arguments::{self as convert, ConvertArguments};
#[cfg(feature = "gpu")]
use crate::commands::devices::arguments::{self as devices, DevicesArguments};
use crate::commands::inspect::arguments::{self as inspect, InspectArguments};
#[cfg(not(all(feature = "bake", feature = "gpu", feature = "view")))]
use crate::commands::missing::MissingArguments;
use crate::commands::normals::arguments::{self as normals, NormalsArguments};
#[cfg(feature = "gpu")]
use crate::commands::render::arguments::{self as render, RenderArguments};
use crate::commands::report::arguments::{self as report, ReportArguments};
use crate::commands::tangents::arguments::{self as tangents, TangentsArguments};
#[cfg(feature = "view")]
use crate::commands::view::arguments::{self as view, ViewArguments};
use crate::installing::left_out;
use crate::options::formats::with_endings;

/// Finds and repairs what is wrong with the normal maps and tangents of 3D models; computes, bakes and
/// converts them
#[derive(Debug, Parser)]
#[command(name = "darboux", version, long_about = LONG_ABOUT, arg_required_else_help = true, max_term_width = 100, after_help = left_out())]
pub struct Arguments {
    /// The subcommand
    #[command(subcommand)]
    pub command: Command,
}

const LONG_ABOUT: &str = "\
Finds and repairs what is wrong with the normal maps and tangents of 3D models; computes, bakes and converts \
them.

A normal map looks right only if the renderer uses the tangents of the program that baked it, and most \
bakers use MikkTSpace. Darboux computes these tangents bit for bit, splits vertices at mirrored UV seams, \
and bakes maps for them. Where a file is wrong, `darboux check` names what is wrong, what it looks like and \
the cure; with --fix it writes the repaired file.

The commands that write models change what they name and leave everything else in the file as it is.

Messages go to standard error, results to standard output. Exit codes: 0 done (also if there was nothing to \
do), 1 an input is bad or a file failed, 2 wrong usage, 3 compared files differ by more than the tolerance. \
After Ctrl-C (exit code 130), SIGTERM or SIGHUP the file that is being written is completed first.";

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Add tangents to models
    #[command(long_about = tangents::ABOUT, after_long_help = tangents::EXAMPLES)]
    Tangents(TangentsArguments),
    /// Add normals to models
    #[command(long_about = normals::ABOUT, after_long_help = normals::EXAMPLES)]
    Normals(NormalsArguments),
    /// Convert normal maps and models between conventions
    #[command(
        long_about = convert::ABOUT,
        after_long_help = convert::EXAMPLES,
        mut_arg("inputs", |inputs| inputs.help(with_endings(convert::INPUTS))),
        mut_arg("output", |output| output.help(convert::OUTPUT))
    )]
    Convert(ConvertArguments),
    /// Say what is wrong with models and normal maps
    #[command(
        long_about = check::ABOUT,
        after_long_help = check::EXAMPLES,
        mut_arg("inputs", |inputs| inputs.help(with_endings(check::INPUTS)).required(false).required_unless_present("explain")),
        mut_arg("output", |output| output.requires("fix")),
        mut_arg("out_dir", |out_dir| out_dir.requires("fix")),
        mut_arg("in_place", |in_place| in_place.requires("fix")),
        mut_arg("force", |force| force.requires("fix"))
    )]
    Check(CheckArguments),
    /// Write what is wrong with models as one HTML file with pictures
    #[command(long_about = report::ABOUT, after_long_help = report::EXAMPLES)]
    Report(ReportArguments),
    /// Bake the detail of high-poly models into maps of a low-poly model
    #[cfg(feature = "bake")]
    #[command(long_about = bake::ABOUT, after_long_help = bake::EXAMPLES)]
    Bake(Box<BakeArguments>),
    /// Compare the tangents of two files, or of a file and a method
    #[command(override_usage = compare::USAGE, long_about = compare::ABOUT, after_long_help = compare::EXAMPLES)]
    Compare(CompareArguments),
    /// Show the contents of each primitive and the difficulties for its tangents
    #[command(long_about = inspect::ABOUT, after_long_help = inspect::EXAMPLES)]
    Inspect(InspectArguments),
    /// Draw a model or its tangents into a PNG
    #[cfg(feature = "gpu")]
    #[command(long_about = render::ABOUT, after_long_help = render::EXAMPLES)]
    Render(RenderArguments),
    /// Show a model and its tangents in the browser
    #[cfg(feature = "view")]
    #[command(long_about = view::ABOUT, after_long_help = view::EXAMPLES)]
    View(ViewArguments),
    /// Explain the methods of computing tangents
    Methods,
    /// List the adapters that can compute tangents
    #[cfg(feature = "gpu")]
    #[command(long_about = devices::ABOUT)]
    Devices(DevicesArguments),
    /// Print the completion script of a shell
    #[command(long_about = completions::ABOUT, after_long_help = completions::EXAMPLES)]
    Completions(CompletionsArguments),
    #[cfg(not(feature = "bake"))]
    #[command(hide = true)]
    Bake(MissingArguments),
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
