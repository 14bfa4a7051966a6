//! Angles between two sets of tangents, and their colours.

use darboux::CornerDifference;

/// The colours of angles: callers give it, so that all their pictures have the same.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatScale {
    /// The least and the greatest angle in degrees; the scale is logarithmic between them.
    pub ends: [f32; 2],
    /// From the least to the greatest, at equal distances, in sRGB.
    pub ramp: [[u8; 3]; 9],
    /// Of triangles in which a sign is flipped, whatever the angle.
    pub flip: [u8; 3],
    /// Where there are no tangents on one side.
    pub none: [u8; 3],
}

/// What the shader is told where there is no angle. All corners of a triangle have it, so that it is interpolated to itself.
pub const NONE: f32 = -1.0;
pub const FLIP: f32 = 1000.0;

/// As far apart as can be, where only one of two different tangents has a direction.
const APART: f64 = 180.0;

/// Degrees between two tangents of every corner of a triangle, or [`FLIP`].
pub fn degrees(a: [[f32; 4]; 3], b: [[f32; 4]; 3]) -> [f32; 3] {
    let differences = [0, 1, 2].map(|i| CornerDifference::between(a[i], b[i]));
    let flips = differences.iter().any(|difference| difference.flips_sign);
    if flips { [FLIP; 3] } else { differences.map(|difference| angle(difference) as f32) }
}

/// Without an angle nothing where both are identical.
fn angle(difference: CornerDifference) -> f64 {
    difference.angle.unwrap_or(if difference.is_identical { 0.0 } else { APART })
}
