//! Leaves: four triangles, tested at once.

use std::array::from_fn;

use super::compare::{greater, lesser};
use super::ray::{Hit, PreparedRay, Sides};

/// Triangles per leaf.
pub const SIZE: usize = 4;

/// A number of each triangle. Arrays that are made at once, of whole arrays, are computed by vector
/// instructions.
type Lanes = [f32; SIZE];

/// No triangle.
const ABSENT: u32 = u32::MAX;

/// Up to four triangles.
#[derive(Clone, Copy, Debug)]
pub struct Leaf {
    /// `corners[corner][axis][triangle]`. Absent triangles are points, which no ray hits.
    corners: [[Lanes; 3]; 3],
    ids: [u32; SIZE],
}

impl Leaf {
    pub const EMPTY: Self = Self { corners: [[[0.0; SIZE]; 3]; 3], ids: [ABSENT; SIZE] };

    pub fn set(&mut self, place: usize, id: u32, corners: [[f32; 3]; 3]) {
        self.ids[place] = id;
        for (stored, corner) in self.corners.iter_mut().zip(corners) {
            for (stored, x) in stored.iter_mut().zip(corner) {
                stored[place] = x;
            }
        }
    }

    pub fn triangle_count(&self) -> usize {
        self.ids.iter().filter(|&&id| id != ABSENT).count()
    }

    /// The nearest hit that is nearer than `best`, or as near with a smaller number.
    ///
    /// The test of S. Woop et al., "Watertight Ray/Triangle Intersection": the corners are sheared so that
    /// the ray is the last axis. The edge functions of an edge that two triangles share differ in their
    /// sign alone, so that no ray passes between the triangles. Triangles that `accepts` refuses are
    /// transparent.
    #[inline(always)]
    pub fn nearest(
        &self,
        ray: &PreparedRay,
        sides: Sides,
        accepts: &impl Fn(u32) -> bool,
        best: Option<Hit>,
    ) -> Option<Hit> {
        let [a, b, c] = [0, 1, 2].map(|corner| self.sheared(corner, ray));
        let [u, v, w] = [edges(&c, &b), edges(&a, &c), edges(&b, &a)];
        let sum: Lanes = from_fn(|i| u[i] + v[i] + w[i]);
        let depth: Lanes = from_fn(|i| u[i] * a[2][i] + v[i] * b[2][i] + w[i] * c[2][i]);
        let farthest = best.map_or(ray.length, |best| best.distance);
        // A NaN among the edges makes the distance NaN, so that there is no hit whatever these say.
        let least: Lanes = from_fn(|i| lesser(lesser(u[i], v[i]), w[i]));
        let greatest: Lanes = from_fn(|i| greater(greater(u[i], v[i]), w[i]));
        let distances: Lanes = from_fn(|i| {
            let distance = depth[i] / sum[i];
            let distance = if distance >= 0.0 { distance } else { f32::INFINITY };
            let distance = if distance <= farthest { distance } else { f32::INFINITY };
            let from_front = if (sum[i] > 0.0) & (least[i] >= 0.0) { distance } else { f32::INFINITY };
            let from_behind = if (sum[i] < 0.0) & (greatest[i] <= 0.0) { distance } else { f32::INFINITY };
            match sides {
                Sides::Front => from_front,
                Sides::Both => lesser(from_front, from_behind),
            }
        });
        let nearest = lesser(lesser(distances[0], distances[1]), lesser(distances[2], distances[3]));
        if nearest == f32::INFINITY {
            return best;
        }
        let mut found = best;
        for i in (0..SIZE).filter(|&i| distances[i] < f32::INFINITY) {
            let (distance, triangle) = (distances[i], self.ids[i]);
            let is_nearer = found.is_none_or(|best| {
                distance < best.distance || (distance == best.distance && triangle < best.triangle)
            });
            if is_nearer && accepts(triangle) {
                let weights = [u[i], v[i], w[i]].map(|edge| edge / sum[i]);
                found = Some(Hit { distance, triangle, weights, is_front: sum[i] > 0.0 });
            }
        }
        found
    }

    /// A corner of each triangle in the sheared space of a ray, whose last axis is the ray.
    #[inline(always)]
    fn sheared(&self, corner: usize, ray: &PreparedRay) -> [Lanes; 3] {
        let along = |axis: usize| -> Lanes {
            let (corner, origin) = (&self.corners[corner][axis], ray.origin[axis]);
            from_fn(|i| corner[i] - origin)
        };
        let [x, y, z] = ray.axes.map(along);
        let [shear_x, shear_y, scale] = ray.shear;
        [from_fn(|i| x[i] - shear_x * z[i]), from_fn(|i| y[i] - shear_y * z[i]), from_fn(|i| scale * z[i])]
    }
}

/// The edge functions at the ray of the edges between two corners.
#[inline(always)]
fn edges(p: &[Lanes; 3], q: &[Lanes; 3]) -> Lanes {
    from_fn(|i| p[0][i] * q[1][i] - p[1][i] * q[0][i])
}
