//! The inputs and outputs of the subcommands that write files.

use std::hash::{BuildHasher, Hasher, RandomState};
use std::num::NonZero;
use std::path::PathBuf;

use clap::{ArgGroup, Args};
use darboux_io::{RunId, SaveOptions};

use super::formats::with_endings;
use super::reading::ReadOptions;

const INPUTS: &str = "Files ({models}) and folders of them; - is standard input";
const OUTPUT: &str = "Output file for a single input, in an existing folder; - is standard output, as GLB";
const LONG_OUTPUT: &str = "\
Output file for a single input, in an existing folder; - is standard output, as GLB

Its ending is one of {written}. A PLY holds the faces of the scene and their tangents, an OBJ the faces and \
materials; a warning lists what is left out.";

/// Which files are read, and where their outputs go.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("destination").args(["output", "out_dir", "in_place"]))]
pub struct FileOptions {
    #[arg(required = true, value_name = "INPUT", help = with_endings(INPUTS))]
    pub inputs: Vec<PathBuf>,

    #[arg(short, long, value_name = "FILE", help_heading = "Output", help = OUTPUT, long_help = with_endings(LONG_OUTPUT))]
    pub output: Option<PathBuf>,

    /// Folder for all outputs, created if missing; outputs keep the names of their inputs and the structure
    /// of input folders
    ///
    /// A model of another format than glTF becomes a .glb: chair.fbx becomes chair.glb, or chair.fbx.glb
    /// where there is a chair.glb or chair.obj as well.
    #[arg(long, value_name = "FOLDER", help_heading = "Output")]
    pub out_dir: Option<PathBuf>,

    /// Replace each input by its output
    ///
    /// The new file is written beside the old one and renamed when it is complete. New data of a .gltf goes
    /// to a new .bin file, and no file is removed. A file in which nothing changes is not touched.
    #[arg(long, help_heading = "Output")]
    pub in_place: bool,

    /// Replace output files that exist
    #[arg(long, help_heading = "Output")]
    pub force: bool,

    /// Process only the inputs whose output in --out-dir is missing or out of date
    ///
    /// An output is up to date if it was made from the same content with the same options.
    /// FOLDER/darboux-journal.jsonl records this for each finished file. So the same command continues a
    /// run that was stopped. Give it from the first run on: runs without it keep no journal.
    #[arg(long, requires = "out_dir", help_heading = "Output")]
    pub resume: bool,

    /// With --resume, process also inputs that are skipped because two runs were killed while they worked on
    /// them
    #[arg(long, requires = "resume", help_heading = "Output")]
    pub retry: bool,

    /// How many files are processed at the same time; by default one per processor core
    ///
    /// The results, and the order of messages, are the same for every number. Each file needs memory of its
    /// own.
    #[arg(long, value_name = "NUMBER", value_parser = jobs, help_heading = "Output")]
    pub jobs: Option<NonZero<u16>>,

    /// Print every primitive and warning; without it, more than 10 files get one line each
    #[arg(short, long, conflicts_with = "quiet", help_heading = "Messages")]
    pub verbose: bool,

    #[command(flatten, next_help_heading = "Input")]
    pub reading: ReadOptions,

    /// Identifies this run in the journal of --resume.
    #[arg(skip = new_run())]
    pub run: RunId,
}

/// A random number, which no other run has.
pub fn new_run() -> RunId {
    // The hashers of the standard library start with random keys.
    RunId(RandomState::new().build_hasher().finish())
}

/// Parses a number of jobs.
pub fn jobs(text: &str) -> Result<NonZero<u16>, &'static str> {
    text.parse().map_err(|_| "expected a number from 1 to 65535")
}

impl FileOptions {
    /// Whether an output may replace an existing file.
    pub fn may_replace(&self) -> bool {
        self.force || self.in_place || self.resume
    }

    /// Whether an option says where outputs go; otherwise they are written beside their inputs.
    pub fn names_output(&self) -> bool {
        self.output.is_some() || self.out_dir.is_some() || self.in_place
    }

    /// How outputs are written.
    pub fn save_options(&self) -> SaveOptions {
        SaveOptions::default().with_force(self.may_replace()).with_run(self.resume.then_some(self.run))
    }
}
