//! The words of defects of materials.

use super::said::Said;
use crate::defect::MaterialFault;

pub fn said(fault: &MaterialFault) -> Said {
    match fault {
        MaterialFault::TransformMirrors { axes: [u, v], determinant, rotation } => {
            let what = if *determinant < 0.0 { "mirrors" } else { "rotates" };
            Said::new(format!(
                "KHR_texture_transform {what} its normal texture: u goes to ({:.3}, {:.3}) and v to ({:.3}, \
                 {:.3})",
                u[0], u[1], v[0], v[1]
            ))
            .with("determinant of the transform (negative if mirrored)", *determinant, "")
            .with("direction of u", *rotation, "degrees")
        }
        MaterialFault::ScaleNegative(scale) => Said::new(
            "normalTexture.scale is negative, so that red and green of its normal map are both inverted",
        )
        .with("scale", *scale, ""),
        MaterialFault::ScaleZero(scale) => {
            Said::new("normalTexture.scale hides the bumps of its normal map").with("scale", *scale, "")
        }
        MaterialFault::ScaleExtreme(scale) => Said::new(
            "normalTexture.scale makes the slopes of its normal map far steeper than they are in the map",
        )
        .with("scale", *scale, "")
        .with("what a slope of 10 degrees becomes", steepened(10.0, *scale), "degrees"),
    }
}

/// The angle of a slope, in degrees, after the scale.
fn steepened(degrees: f64, scale: f64) -> f64 {
    (scale.abs() * degrees.to_radians().tan()).atan().to_degrees()
}
