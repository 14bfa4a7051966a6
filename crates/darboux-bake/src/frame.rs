//! Stage 5: a normal in the frame of the low surface, as a renderer will undo it.
//!
//! A renderer computes n = x T + y B + z N from the texel (x, y, z) and normalises n (M. Mikkelsen, "Simulation of Wrinkled Surfaces
//! Revisited", 2008). T and N are interpolated and not normalised, and for one choice of [`Bitangent`] B is w cross(N, T). So the texel is the
//! solution of that equation, normalised.

use crate::Bitangent;
use crate::face::SurfacePoint;
use crate::vector::{Vector, cross, dot, length, scale, unit};

/// Tangent, bitangent and normal at a point.
#[derive(Clone, Copy, Debug)]
pub struct ShadingFrame {
    tangent: Vector,
    bitangent: Vector,
    normal: Vector,
}

/// A frame whose volume is below this share of the product of its lengths has no inverse that means anything.
const LEAST_VOLUME: f64 = 1e-6;

impl ShadingFrame {
    pub fn new(point: &SurfacePoint, bitangent: Bitangent) -> Self {
        let bitangent = match bitangent {
            Bitangent::PerPixel => scale(point.sign, cross(point.normal, point.tangent)),
            Bitangent::PerVertex => point.bitangent,
        };
        Self { tangent: point.tangent, bitangent, normal: point.normal }
    }

    /// The unit vector m with x T + y B + z N along `normal`, by Cramer's rule; `None` where the frame is degenerate.
    pub fn to_tangent_space(self, normal: Vector) -> Option<Vector> {
        let Self { tangent: t, bitangent: b, normal: n } = self;
        let volume = dot(t, cross(b, n));
        let spans_space = volume.abs() > LEAST_VOLUME * length(t) * length(b) * length(n);
        if !spans_space {
            return None;
        }
        let solution = [dot(normal, cross(b, n)), dot(normal, cross(n, t)), dot(normal, cross(t, b))];
        unit(scale(volume.signum(), solution))
    }
}

#[cfg(test)]
mod tests {
    use darboux_dice::Dice;

    use super::*;
    use crate::vector::sub;

    /// The unit vector along x T + y B + z N: what a renderer computes.
    fn rendered(frame: ShadingFrame, [x, y, z]: Vector) -> Vector {
        let ShadingFrame { tangent: t, bitangent: b, normal: n } = frame;
        unit([0, 1, 2].map(|i| x * t[i] + y * b[i] + z * n[i])).expect("not zero")
    }

    fn point(dice: &mut Dice<'_>) -> SurfacePoint {
        let mut vector = || [0, 1, 2].map(|_| f64::from(dice.uniform()));
        let [normal, tangent, bitangent] = [vector(), vector(), vector()];
        SurfacePoint {
            position: [0.0; 3],
            normal,
            tangent,
            sign: -1.0,
            bitangent,
            cage: None,
            face_normal: normal,
        }
    }

    #[test]
    fn a_renderer_undoes_it() {
        let mut dice = Dice::from_seed(3);
        for bitangent in [Bitangent::PerPixel, Bitangent::PerVertex] {
            for _ in 0..1000 {
                let frame = ShadingFrame::new(&point(&mut dice), bitangent);
                let normal = unit([0, 1, 2].map(|_| f64::from(dice.uniform()))).expect("not zero");
                let Some(texel) = frame.to_tangent_space(normal) else { continue };
                let back = rendered(frame, texel);
                // The condition of the frame is at most 1 / LEAST_VOLUME, and doubles have 16 digits.
                assert!(length(sub(back, normal)) < 1e-8, "{normal:?} {texel:?} {back:?}");
            }
        }
    }

    #[test]
    fn degenerate_frames_have_no_solution() {
        let mut point = point(&mut Dice::from_seed(1));
        point.tangent = scale(2.0, point.normal);
        assert_eq!(ShadingFrame::new(&point, Bitangent::PerPixel).to_tangent_space([0.0, 0.0, 1.0]), None);
        point.normal = [f64::NAN; 3];
        assert_eq!(ShadingFrame::new(&point, Bitangent::PerVertex).to_tangent_space([0.0, 0.0, 1.0]), None);
    }
}
