//! Generates `bindings/c/include/darboux.h` from this crate, below the folder of its argument.
//!
//! `cargo xtask gen` runs it with the repository's root.

use std::error::Error;
use std::fs::{create_dir_all, write};
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let root = std::env::args_os().nth(1).ok_or("usage: header FOLDER")?;
    let interface = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(interface.join("cbindgen.toml"))?;
    let header = cbindgen::Builder::new().with_crate(interface).with_config(config).generate()?;
    let mut text = Vec::new();
    header.write(&mut text);
    let folder = Path::new(&root).join("bindings/c/include");
    create_dir_all(&folder)?;
    Ok(write(folder.join("darboux.h"), text)?)
}
