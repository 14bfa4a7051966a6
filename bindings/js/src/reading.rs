//! How files are read.

use darboux_io::{LoadOptions, OptionNames};

/// The options of the readers, with messages for this package.
pub fn load_options() -> LoadOptions {
    LoadOptions::default().with_option_names(OptionNames::of_command())
}
