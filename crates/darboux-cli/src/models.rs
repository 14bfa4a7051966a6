//! Models from where the arguments say.

use std::io::{self, Read};
use std::path::Path;

use darboux_io::Error;
use darboux_io::gltf::{Document, LoadOptions};

use crate::jobs::{Found, Input};

/// Reads a model.
pub fn read(input: &Input, allow_outside: bool) -> Result<Document, Error> {
    let options = LoadOptions { allow_outside };
    match input {
        Input::File(path) => Document::open(path, &options),
        Input::Stdin => {
            let mut bytes = Vec::new();
            let name = input.to_string();
            io::stdin()
                .read_to_end(&mut bytes)
                .map_err(|source| Error::Read { file: Path::new(&name).to_path_buf(), source })?;
            Document::from_bytes(&name, bytes, None, &options)
        }
    }
}

/// The bytes of all inputs that are files, as far as they are known.
pub fn total_bytes(found: &Found) -> u64 {
    found.files.iter().map(|(input, _)| bytes(input)).sum()
}

/// The bytes of an input that is a file, 0 where they are not known.
pub fn bytes(input: &Input) -> u64 {
    match input {
        Input::File(path) => std::fs::metadata(path).map_or(0, |file| file.len()),
        Input::Stdin => 0,
    }
}
