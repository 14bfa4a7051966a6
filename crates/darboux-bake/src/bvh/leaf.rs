//! Leaves: four triangles, tested at once.

use super::compare::{greater, lesser};
use super::ray::{Hit, PreparedRay, Sides};

/// Triangles per leaf.
pub const SIZE: usize = 4;

/// No triangle.
const ABSENT: u32 = u32::MAX;

/// Up to four triangles.
#[derive(Clone, Copy, Debug)]
pub struct Leaf {
    /// `corners[corner][axis][triangle]`. Absent triangles are points, which no ray hits.
    corners: [[[f32; SIZE]; 3]; 3],
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
        let [first, second, last] = ray.axes;
        let [shear_x, shear_y, scale] = ray.shear;
        let mut sheared = [[[0f32; SIZE]; 3]; 3];
        for (sheared, corner) in sheared.iter_mut().zip(&self.corners) {
            for i in 0..SIZE {
                let z = corner[last][i] - ray.origin[last];
                sheared[0][i] = (corner[first][i] - ray.origin[first]) - shear_x * z;
                sheared[1][i] = (corner[second][i] - ray.origin[second]) - shear_y * z;
                sheared[2][i] = scale * z;
            }
        }
        let [a, b, c] = &sheared;
        let edge = |p: &[[f32; SIZE]; 3], q: &[[f32; SIZE]; 3]| -> [f32; SIZE] {
            std::array::from_fn(|i| p[0][i] * q[1][i] - p[1][i] * q[0][i])
        };
        let [u, v, w] = [edge(c, b), edge(a, c), edge(b, a)];
        let sum: [f32; SIZE] = std::array::from_fn(|i| u[i] + v[i] + w[i]);
        let depth: [f32; SIZE] = std::array::from_fn(|i| u[i] * a[2][i] + v[i] * b[2][i] + w[i] * c[2][i]);
        let farthest = best.map_or(ray.length, |best| best.distance);
        // A NaN among the edges makes the distance NaN, so that there is no hit whatever these say.
        let least: [f32; SIZE] = std::array::from_fn(|i| lesser(lesser(u[i], v[i]), w[i]));
        let greatest: [f32; SIZE] = std::array::from_fn(|i| greater(greater(u[i], v[i]), w[i]));
        let distances: [f32; SIZE] = std::array::from_fn(|i| {
            let distance = depth[i] / sum[i];
            let is_hit = match sides {
                Sides::Front => (least[i] >= 0.0) & (sum[i] > 0.0),
                Sides::Both => ((least[i] >= 0.0) | (greatest[i] <= 0.0)) & (sum[i] != 0.0),
            };
            let is_in_reach = (distance >= 0.0) & (distance <= farthest);
            if is_hit & is_in_reach { distance } else { f32::INFINITY }
        });
        if distances == [f32::INFINITY; SIZE] {
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
}
