//! The limits of sizes and counts.

/// The largest width and height of an image.
pub const MAX_SIDE: u32 = 1 << 15;

/// The most samples per texel and axis: 256 samples per texel.
pub const MAX_SAMPLES_PER_AXIS: u32 = 16;

/// The most triangles of the high surfaces of a group.
pub const MAX_TRIANGLES: u64 = (1 << 30) - 1;
