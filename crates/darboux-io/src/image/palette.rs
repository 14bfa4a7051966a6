//! Checks palettes before they are expanded: the decoder of png 0.18 panics at palettes that break the
//! specification.

use png::{ColorType, Info};

/// The bytes of the largest palette.
const MOST: usize = 3 * 256;

/// Checks the palette of an indexed image (PNG 3, 11.2.2 and 11.3.1.1). Errors: its length is not the length
/// of 1 to 256 colours; more colours have an alpha than there are.
pub fn check_palette(info: &Info<'_>) -> Result<(), String> {
    if info.color_type != ColorType::Indexed {
        return Ok(());
    }
    let bytes = info.palette.as_ref().map_or(0, |palette| palette.len());
    if bytes == 0 || bytes > MOST || !bytes.is_multiple_of(3) {
        return Err(format!("its palette has {bytes} bytes, not 3 for each of 1 to 256 colours"));
    }
    let alphas = info.trns.as_ref().map_or(0, |alphas| alphas.len());
    if alphas > bytes / 3 {
        return Err(format!("its palette has {} colours but {alphas} alphas", bytes / 3));
    }
    Ok(())
}
