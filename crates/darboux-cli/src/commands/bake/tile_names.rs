//! UDIM: `%UDIM%` in the names of images stands for the number of a tile.

use std::path::{Path, PathBuf};

use darboux_bake::Udim;

use super::arguments::BakeArguments;

/// What stands for the number; the second is how texture painters write it.
const PLACES: [&str; 2] = ["%UDIM%", "<UDIM>"];

/// Whether a name stands for one file per tile.
pub fn has_place(path: &Path) -> bool {
    let text = path.to_string_lossy();
    PLACES.iter().any(|place| text.contains(place))
}

/// Refuses names of images that do not go together, and results that tiles do not have. The error is one
/// sentence.
pub fn check(arguments: &BakeArguments) -> Result<(), String> {
    let BakeArguments { output, heat_map, heat_model, write_model, report, .. } = arguments;
    if let Some(page) = report.as_deref().filter(|path| has_place(path)) {
        return Err(format!("{}: one page has all tiles; leave %UDIM% out", page.display()));
    }
    if !has_place(output) {
        let misplaced =
            [heat_map, heat_model, write_model].into_iter().flatten().find(|path| has_place(path));
        return match misplaced {
            Some(path) => {
                Err(format!("{}: has %UDIM%, which belongs into the name of -o, too", path.display()))
            }
            None => Ok(()),
        };
    }
    if write_model.is_some() || heat_model.is_some() {
        return Err(
            "materials of glTF cannot have UDIM tiles; leave --write-model and --heat-model out, or bake \
             without %UDIM%"
                .to_owned(),
        );
    }
    match heat_map.as_deref().filter(|path| !has_place(path)) {
        Some(path) => {
            Err(format!("{}: each tile has a heat map of its own; write %UDIM% in its name", path.display()))
        }
        None => Ok(()),
    }
}

/// The name of the image of a tile.
pub fn named(path: &Path, udim: Udim) -> PathBuf {
    let text = path.to_string_lossy();
    PLACES.iter().fold(text.into_owned(), |text, place| text.replace(place, &udim.to_string())).into()
}
