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

/// A name with one spelling of the place.
pub fn canonical(path: &Path) -> PathBuf {
    if has_place(path) { with_place(path, PLACES[0]) } else { path.to_owned() }
}

/// The names with a place that may stand for a file: each with the place where the file's name has the number
/// of a tile.
pub fn templates_of(path: &Path) -> impl Iterator<Item = PathBuf> {
    let text = path.to_string_lossy().into_owned();
    let starts = 0..text.len().saturating_sub(Udim::DIGITS - 1);
    let templates = starts.filter_map(move |start| {
        let digits = text.get(start..start + Udim::DIGITS)?;
        let is_number = digits.bytes().all(|byte| byte.is_ascii_digit());
        Udim::from_number(digits.parse().ok().filter(|_| is_number)?)?;
        let at_start = [&text[..start], PLACES[0], &text[start + Udim::DIGITS..]].concat();
        Some([text.replace(digits, PLACES[0]), at_start])
    });
    templates.flatten().map(PathBuf::from)
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
    with_place(path, &udim.to_string())
}

fn with_place(path: &Path, text: &str) -> PathBuf {
    let name = path.to_string_lossy().into_owned();
    PLACES.iter().fold(name, |name, place| name.replace(place, text)).into()
}
