//! UDIM: `%UDIM%` in the names of images stands for the number of a tile, each of which is baked into images of its own.

use std::path::{Path, PathBuf};

use darboux::Convention;
use darboux_bake::{LowSurface, Udim, udims_of};

use super::arguments::BakeArguments;
use super::outputs::refuse_existing;
use crate::memory;

/// What stands for the number; the second is how texture painters write it.
const PLACES: [&str; 2] = ["%UDIM%", "<UDIM>"];

/// A tile that is baked, with the names of its images.
pub struct Tile {
    /// None where all tiles lie over each other in one image.
    pub udim: Option<Udim>,
    pub arguments: BakeArguments,
}

/// Whether a name stands for one file per tile.
pub fn has_place(path: &Path) -> bool {
    let text = path.to_string_lossy();
    PLACES.iter().any(|place| text.contains(place))
}

/// Refuses names of images that do not go together, and results that tiles do not have. The error is one sentence.
pub fn check(arguments: &BakeArguments) -> Result<(), String> {
    let BakeArguments { output, heat_map, heat_model, write_model, .. } = arguments;
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
            "materials of glTF cannot have UDIM tiles; leave --write-model and --heat-model out, or bake without %UDIM%"
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

/// The tiles that are baked: those that charts cover where the output's name has `%UDIM%`, or else one for all. Errors are one sentence each: charts where no
/// tile has a number; images that exist.
pub fn tiles_of(arguments: &BakeArguments, low: &[LowSurface<'_>]) -> Result<Vec<Tile>, String> {
    if !has_place(&arguments.output) {
        return Ok(vec![Tile { udim: None, arguments: arguments.clone() }]);
    }
    let udims = udims_of(low, Convention::GLTF, memory::available()).map_err(|error| error.to_string())?;
    if udims.is_empty() {
        return Err("no triangle of the low model covers a tile; check its UVs".to_owned());
    }
    let tile = |udim: Udim| {
        let mut arguments = arguments.clone();
        arguments.output = named(&arguments.output, udim);
        arguments.heat_map = arguments.heat_map.map(|path| named(&path, udim));
        refuse_existing(&arguments)?;
        Ok(Tile { udim: Some(udim), arguments })
    };
    udims.into_iter().map(tile).collect()
}

fn named(path: &Path, udim: Udim) -> PathBuf {
    let text = path.to_string_lossy();
    PLACES.iter().fold(text.into_owned(), |text, place| text.replace(place, &udim.to_string())).into()
}
