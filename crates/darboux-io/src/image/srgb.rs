//! The sRGB transfer function.

/// The linear value of a channel in sRGB, both from 0 to 1 (IEC 61966-2-1).
pub fn srgb_to_linear(channel: f64) -> f64 {
    if channel <= 0.04045 { channel / 12.92 } else { ((channel + 0.055) / 1.055).powf(2.4) }
}
