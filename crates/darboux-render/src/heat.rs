//! Angles between two sets of tangents, and the colours of these angles.

use darboux::CornerDifference;

/// The colours of angles.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatScale {
    /// The smallest and the largest angle in degrees. The scale between them is logarithmic.
    pub ends: [f32; 2],
    /// The sRGB colours from the smallest to the largest angle, at equal distances.
    pub ramp: [[u8; 3]; 9],
    /// The colour of triangles in which a sign is flipped, whatever the angle.
    pub flip: [u8; 3],
    /// The colour of triangles without tangents in one of the two models.
    pub none: [u8; 3],
}

/// Sentinels instead of an angle. All corners of a triangle have the same, so interpolation does not change
/// it.
pub const NO_ANGLE: f32 = -1.0;
pub const FLIP: f32 = 1000.0;

/// The angle between a tangent with a direction and one without.
const NO_DIRECTION: f64 = 180.0;

/// The degrees between the two tangents of each corner of a triangle, or [`FLIP`].
pub fn degrees(a: [[f32; 4]; 3], b: [[f32; 4]; 3]) -> [f32; 3] {
    let differences = [0, 1, 2].map(|i| CornerDifference::between(a[i], b[i]));
    let flips = differences.iter().any(|difference| difference.flips_sign);
    if flips { [FLIP; 3] } else { differences.map(|difference| angle(difference) as f32) }
}

/// The angle in degrees. Identical tangents without a direction have the angle 0.
fn angle(difference: CornerDifference) -> f64 {
    difference.angle.unwrap_or(if difference.is_identical { 0.0 } else { NO_DIRECTION })
}
