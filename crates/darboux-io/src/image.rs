//! Images: normal maps in PNG files, converted with every other chunk kept, and textures decoded to RGBA.

mod channels;
mod chunks;
#[cfg(feature = "textures")]
mod decoding;
#[cfg(feature = "ktx2")]
mod ktx2_image;
mod normal_map;
#[cfg(feature = "textures")]
mod other_formats;
mod palette;
mod png_image;
mod reasons;
#[cfg(feature = "textures")]
mod rgba;
mod srgb;
#[cfg(feature = "textures")]
mod tga;

pub use channels::{Channels, ChannelsError};
#[cfg(feature = "textures")]
pub use decoding::{DecodeError, DecodeLimits};
pub use normal_map::{
    RgbCodes, change_texels, convert_normal_map, count_invalid_normals, normal_vectors, rgb_codes,
    set_normal_vectors,
};
pub use png_image::{PngImage, Sample};
#[cfg(feature = "textures")]
pub use rgba::{RgbaCodes, RgbaImage};
pub use srgb::{linear_to_srgb, srgb_to_linear};
