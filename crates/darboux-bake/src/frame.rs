//! Stage 5: a normal in the frame of the low surface, as a renderer will undo it.
//!
//! A renderer computes n = x T + y B + z N from the texel (x, y, z) and normalises n (M. Mikkelsen,
//! "Simulation of Wrinkled Surfaces Revisited", 2008). T and N are interpolated and not normalised, and for
//! one choice of [`Bitangent`] B is w cross(N, T). So the texel is the solution of that equation, normalised.

use crate::Bitangent;
use crate::point::SurfacePoint;
use crate::vector::{Vector, cross, dot, scale, unit};

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
        let per_pixel = Self::per_pixel(point.normal, point.tangent, point.sign);
        match bitangent {
            Bitangent::PerPixel => per_pixel,
            Bitangent::PerVertex => Self { bitangent: point.bitangent, ..per_pixel },
        }
    }

    /// The frame with B = w cross(N, T), for vectors that are not normalised.
    pub fn per_pixel(normal: Vector, tangent: Vector, sign: f64) -> Self {
        Self { tangent, bitangent: scale(sign, cross(normal, tangent)), normal }
    }

    /// The same frame with N and T normalised before B is made, as renderers do that normalise per pixel.
    pub fn normalised(point: &SurfacePoint) -> Option<Self> {
        Some(Self::per_pixel(unit(point.normal)?, unit(point.tangent)?, point.sign))
    }

    /// What a renderer shows: x T + y B + z N, normalised. `None` where that has no direction.
    pub fn shade(self, [x, y, z]: Vector) -> Option<Vector> {
        let Self { tangent: t, bitangent: b, normal: n } = self;
        unit([0, 1, 2].map(|i| x * t[i] + y * b[i] + z * n[i]))
    }

    /// The unit vector m with x T + y B + z N along `normal`, by Cramer's rule; `None` where the frame is
    /// degenerate.
    pub fn to_tangent_space(self, normal: Vector) -> Option<Vector> {
        let Self { tangent: t, bitangent: b, normal: n } = self;
        let volume = dot(t, cross(b, n));
        let squares = dot(t, t) * dot(b, b) * dot(n, n);
        let spans_space = volume * volume > LEAST_VOLUME * LEAST_VOLUME * squares;
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
    use crate::vector::{length, sub};

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
            skew: 0.0,
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
                let back = frame.shade(texel).expect("not zero");
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
