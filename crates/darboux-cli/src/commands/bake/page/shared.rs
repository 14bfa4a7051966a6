//! What several parts of the page use.

use crate::html_page::escaped;
use crate::html_page::raster::Raster;

/// Two pictures from the same side: the high models, and the low one with its maps.
pub struct View {
    /// The side, in words.
    pub side: &'static str,
    pub high: Raster,
    pub low: Raster,
}

/// A picture with its caption. `caption`: text; `more`: HTML.
pub fn figure(raster: &Raster, caption: &str, more: &str) -> Result<String, String> {
    let ([width, height], address, caption) = (raster.size, raster.address()?, escaped(caption));
    Ok(format!(
        "<figure><img src=\"{address}\" width=\"{width}\" height=\"{height}\" \
         alt=\"{caption}\"><figcaption>{caption}{more}</figcaption></figure>\n"
    ))
}
