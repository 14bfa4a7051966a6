//! Writes a healthy model, and the same with each mistake that can be made on it, into a folder: healthy.glb
//! and CODE.glb; and CODE.svg where a UV layout shows more.
//!
//! docs/check.md shows those that look different, as `darboux render` draws them; CONTRIBUTING.md says how
//! they are drawn again.

#[path = "../tests/support/mod.rs"]
mod support;

use std::fs;
use std::io;
use std::path::Path;

use darboux_check::Code;
use support::maps::MAP_MISTAKES;
use support::mistakes::MISTAKES;
use support::models::{Model, shown_model};
use support::shown::{shown_layout, shown_mistake};

fn main() -> io::Result<()> {
    let Some(folder) = std::env::args_os().nth(1) else {
        return Err(io::Error::other("usage: mistakes FOLDER"));
    };
    let folder = Path::new(&folder);
    fs::create_dir_all(folder)?;
    let healthy = shown_model();
    let healthy_file = healthy.glb();
    fs::write(folder.join("healthy.glb"), &healthy_file)?;
    for code in Code::ALL {
        let model = shown_mistake(&healthy, *code).unwrap_or_else(|| damaged(&healthy, *code));
        let file = model.glb();
        if file != healthy_file {
            fs::write(folder.join(format!("{code}.glb")), file)?;
        }
        if let Some(layout) = shown_layout(*code) {
            fs::write(folder.join(format!("{code}.svg")), layout)?;
        }
    }
    Ok(())
}

/// The model with the first mistake of a code.
fn damaged(healthy: &Model, code: Code) -> Model {
    let mut model = healthy.clone();
    if let Some(mistake) = MISTAKES.iter().find(|mistake| mistake.code == code) {
        // Whether the mistake is good for the table of mistakes does not matter here.
        (mistake.make)(&mut model);
    }
    if let Some(mistake) = MAP_MISTAKES.iter().find(|mistake| mistake.code == code) {
        model.map = (mistake.make)(&model.map);
    }
    model
}
