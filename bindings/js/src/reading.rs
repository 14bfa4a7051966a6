//! How files are read.

use darboux_io::{LoadOptions, OptionNames};

/// What to do about a format that this package does not read.
const MISSING_READER: &str =
    "export the model as .glb, or convert it with the command: darboux tangents model.fbx -o model.glb";

/// The options of the readers, with messages for this package.
pub fn load_options() -> LoadOptions {
    LoadOptions::default().with_option_names(OptionNames::default().with_missing_reader(MISSING_READER))
}
