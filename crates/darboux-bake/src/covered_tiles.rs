//! [`udims_of`]: the tiles that charts cover.

use darboux::Convention;

use crate::budget::Budget;
use crate::layout::Layout;
use crate::udim::Udim;
use crate::{BakeError, LowSurface};

/// The tiles that the charts of low surfaces cover, in the order of their numbers.
///
/// Triangles across more than 16 tiles do not count, because they are not baked. Errors: charts where no tile
/// has a number; more memory than `memory_limit` bytes.
pub fn udims_of(
    low: &[LowSurface<'_>],
    convention: Convention,
    memory_limit: Option<u64>,
) -> Result<Vec<Udim>, BakeError> {
    // Tiles of this many texels: corners are exact to 1/256 of one, and triangles smaller than that have no
    // area.
    let layout = Layout::new(low, [4096; 2], convention, None, &mut Budget::new(memory_limit))?;
    let udim = |tile: [i32; 2]| {
        let [column, row] = tile;
        Udim::of_tile(tile).ok_or(BakeError::NoUdim { tile: [column, -row] })
    };
    let mut tiles: Vec<Udim> = layout.covered_tiles(low).into_iter().map(udim).collect::<Result<_, _>>()?;
    tiles.sort();
    Ok(tiles)
}
