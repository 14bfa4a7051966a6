//! Pictures of maps in a page.

use super::encode::Channels;
use crate::html_page::raster::Raster;

/// The longest side of a map's picture in a page.
const MAP_SIDE: u32 = 384;

/// A map as its file of 8 bits would look, reduced. Transparency is left out, and two channels get a third
/// one that is black.
pub fn thumbnail(channels: &Channels<'_>) -> Raster {
    let pixel = |texel: &[u8]| match *texel {
        [red, green, blue, ..] => [red, green, blue],
        [red, green] => [red, green, 0],
        [grey] => [grey; 3],
        [] => [0; 3],
    };
    let codes = channels.codes::<u8>(None);
    let pixels = codes.chunks_exact(channels.count()).map(pixel).collect();
    Raster { size: channels.size, pixels }.at_most(MAP_SIDE)
}
