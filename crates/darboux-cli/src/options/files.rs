//! The inputs and outputs of the subcommands that write files.

use std::hash::{BuildHasher, Hasher, RandomState};
use std::num::NonZero;
use std::path::PathBuf;

use clap::{ArgGroup, Args};
use darboux_io::{RunId, SaveOptions};

use super::reading::ReadOptions;

/// Which files are read, and where their outputs go.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("destination").args(["output", "out_dir", "in_place"]))]
pub struct FileOptions {
    /// Files (.gltf, .glb, .vrm) and folders; - is standard input
    #[arg(required = true, value_name = "INPUT")]
    pub inputs: Vec<PathBuf>,

    /// Output file for a single input, in a folder that exists; - is standard output, as GLB
    #[arg(short, long, value_name = "FILE", help_heading = "Output")]
    pub output: Option<PathBuf>,

    /// Folder for all outputs, made if missing; they have the names of their inputs, and an input folder's structure is kept
    #[arg(long, value_name = "FOLDER", help_heading = "Output")]
    pub out_dir: Option<PathBuf>,

    /// Replace each input by its output
    ///
    /// The new file is written beside the old one and renamed when it is complete. New data of a .gltf goes to a .bin file of its own,
    /// and no file is removed. A file in which nothing changes is not touched.
    #[arg(long, help_heading = "Output")]
    pub in_place: bool,

    /// Replace output files that exist
    #[arg(long, help_heading = "Output")]
    pub force: bool,

    /// Leave out inputs whose output in --out-dir is up to date, and replace those that are not
    ///
    /// Up to date is what was made of the same content by the same options. FOLDER/darboux-journal.jsonl tells, to which each file
    /// is added as it is done: run the same command again, and a run that was stopped goes on.
    #[arg(long, requires = "out_dir", help_heading = "Output")]
    pub resume: bool,

    /// How many files are worked on at the same time
    #[arg(long, value_name = "NUMBER", default_value = "1", value_parser = jobs, help_heading = "Output")]
    pub jobs: NonZero<u16>,

    #[command(flatten, next_help_heading = "Input")]
    pub reading: ReadOptions,

    /// Identifies this run in the journal of --resume.
    #[arg(skip = new_run())]
    pub run: RunId,
}

/// A random number, which no other run has.
fn new_run() -> RunId {
    // The hashers of the standard library start with random keys.
    RunId(RandomState::new().build_hasher().finish())
}

fn jobs(text: &str) -> Result<NonZero<u16>, &'static str> {
    text.parse().map_err(|_| "not a number from 1 to 65535")
}

impl FileOptions {
    /// Whether an output may take the place of a file that exists.
    pub fn may_replace(&self) -> bool {
        self.force || self.in_place || self.resume
    }

    /// How outputs are written.
    pub fn save_options(&self) -> SaveOptions {
        SaveOptions { force: self.may_replace(), run: self.resume.then_some(self.run) }
    }
}
