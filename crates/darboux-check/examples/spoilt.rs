//! Writes a healthy model, and the same with each mistake that shows in a picture, into a folder: HEALTHY.glb and CODE.glb.
//!
//! docs/check.md shows them as `darboux render` draws them; CONTRIBUTING.md says how they are drawn again.

#[path = "../tests/support/mod.rs"]
mod support;

use std::fs;
use std::io;
use std::path::Path;

use darboux_check::Code;
use support::maps::MAP_MISTAKES;
use support::mistakes::MISTAKES;
use support::models::shown_model;

/// The mistakes that show.
const SHOWN: &[Code] = &[
    Code::TangentSharedAcrossMirror,
    Code::TangentSignFlipped,
    Code::TangentSignFlippedWhereMirrored,
    Code::TangentRotated,
    Code::TangentNegated,
    Code::NormalAgainstWinding,
    Code::MapGreenFlipped,
    Code::MapChannelsSwapped,
    Code::MapSrgb,
    Code::MapTwoChannel,
];

fn main() -> io::Result<()> {
    let Some(folder) = std::env::args_os().nth(1) else {
        return Err(io::Error::other("usage: spoilt FOLDER"));
    };
    let folder = Path::new(&folder);
    fs::create_dir_all(folder)?;
    let healthy = shown_model();
    fs::write(folder.join("healthy.glb"), healthy.glb())?;
    for code in SHOWN {
        let mut model = healthy.clone();
        if let Some(mistake) = MISTAKES.iter().find(|mistake| mistake.code == *code) {
            (mistake.make)(&mut model);
        }
        if let Some(mistake) = MAP_MISTAKES.iter().find(|mistake| mistake.code == *code) {
            model.map = (mistake.make)(&model.map);
        }
        fs::write(folder.join(format!("{code}.glb")), model.glb())?;
    }
    Ok(())
}
