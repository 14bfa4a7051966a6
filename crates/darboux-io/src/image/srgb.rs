//! The sRGB transfer function (IEC 61966-2-1).

/// The linear value of a channel in sRGB, both from 0 to 1.
pub fn srgb_to_linear(channel: f64) -> f64 {
    if channel <= 0.04045 { channel / 12.92 } else { ((channel + 0.055) / 1.055).powf(2.4) }
}

/// The sRGB value of a linear channel, both from 0 to 1.
pub fn linear_to_srgb(channel: f64) -> f64 {
    if channel <= 0.003_130_8 { 12.92 * channel } else { 1.055 * channel.powf(1.0 / 2.4) - 0.055 }
}
