//! UDIM: each tile that charts cover is baked into images of its own.

use darboux::Convention;
use darboux_bake::{LowSurface, Udim, udims_of};

use super::arguments::BakeArguments;
use super::conflicts::{InputFile, outputs_of, refuse_twice};
use super::failure::BakeFailure;
use super::outputs::refuse_existing;
use super::tile_names::{has_place, named};

/// A tile that is baked, with the names of its images.
pub struct Tile {
    /// None where all tiles lie over each other in one image.
    pub udim: Option<Udim>,
    pub arguments: BakeArguments,
}

/// The tiles that are baked: those that charts cover where the output's name has `%UDIM%`, or else one for
/// all. Errors: charts where no tile has a number; images that exist; files that would be written twice, or
/// over one of the inputs; more memory than `memory_limit` bytes.
pub fn tiles_of(
    arguments: &BakeArguments,
    low: &[LowSurface<'_>],
    inputs: &[InputFile],
    memory_limit: Option<u64>,
) -> Result<Vec<Tile>, BakeFailure> {
    if !has_place(&arguments.output) {
        return Ok(vec![Tile { udim: None, arguments: arguments.clone() }]);
    }
    let udims = udims_of(low, Convention::GLTF, memory_limit)?;
    if udims.is_empty() {
        return Err("no triangle of the low model covers a tile; check its UVs".to_owned().into());
    }
    let tile = |udim: Udim| {
        let mut arguments = arguments.clone();
        arguments.output = named(&arguments.output, udim);
        arguments.heat_map = arguments.heat_map.map(|path| named(&path, udim));
        refuse_twice(&outputs_of(&arguments, 0), inputs)?;
        refuse_existing(&arguments)?;
        Ok(Tile { udim: Some(udim), arguments })
    };
    udims.into_iter().map(tile).collect()
}
