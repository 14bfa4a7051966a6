//! The ground below a model, with the shadow where the model is close to it. `ground-shadow.ts` of the viewer
//! computes the same texels.
//!
//! ```text
//! R         half the diagonal of the model's box
//! square    around the box seen from above, wider by margin R on each side, at the height of the lowest point
//! heights   of the lowest surface above each texel of the square, divided by R
//! shadow    max(0, 1 - height / reach)^2, blurred by three box filters of the radius blur R
//! light     the product of 1 - darkness shadow over all shadows
//! ```

use crate::algebra::Matrix;
use crate::part::Part;
use crate::studio::{GroundLook, Shadow, Studio};

/// The darkness of a square on the ground.
pub struct Ground {
    /// The middle of the square: x, height, z.
    pub middle: [f64; 3],
    /// Half the side of the square.
    pub half_side: f64,
    /// The part of the light that is missing at each texel, of 255; rows along x.
    pub texels: Vec<u8>,
}

/// A point in the square: x and z in texels, and the height divided by R.
type Point = [f64; 3];

impl Ground {
    /// The ground below the parts; none if they have no extent, or if they need too many samples.
    pub fn below(parts: &[Part]) -> Option<Self> {
        let look = &Studio::get().ground;
        let triangles = parts.iter().map(Part::triangle_count).fold(0, u64::saturating_add);
        if triangles > look.most_steps {
            return None;
        }
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        visit_triangles(parts, &mut |triangle| {
            for point in triangle {
                (0..3).for_each(|i| {
                    min[i] = min[i].min(point[i]);
                    max[i] = max[i].max(point[i]);
                });
            }
        });
        let half = [0, 1, 2].map(|i| 0.5 * (max[i] - min[i]));
        let radius = half.iter().map(|x| x * x).sum::<f64>().sqrt();
        if !(radius > 0.0 && radius.is_finite()) {
            return None;
        }
        let middle = [0.5 * (min[0] + max[0]), min[1], 0.5 * (min[2] + max[2])];
        let half_side = half[0].max(half[2]) + look.margin * radius;
        let texels_per_unit = look.texels as f64 / (2.0 * half_side);
        let mut heights = Heights::new(look);
        visit_triangles(parts, &mut |triangle| {
            heights.add(triangle.map(|point| {
                [0, 1, 2].map(|i| match i {
                    1 => (point[1] - middle[1]) / radius,
                    _ => (point[i] - middle[i] + half_side) * texels_per_unit,
                })
            }));
        });
        let texels = heights.darkness(look, radius * texels_per_unit)?;
        Some(Self { middle, half_side, texels })
    }
}

/// Visits the triangles of all places in the scene, except those that are not finite there.
fn visit_triangles(parts: &[Part], visit: &mut dyn FnMut([[f64; 3]; 3])) {
    for part in parts {
        for matrix in part.matrices.iter() {
            for corners in part.corners.as_chunks::<3>().0 {
                let triangle = [0, 1, 2].map(|corner| in_scene(matrix, corners[corner].position));
                if triangle.as_flattened().iter().all(|x| x.is_finite()) {
                    visit(triangle);
                }
            }
        }
    }
}

fn in_scene([a, b, c, d]: &Matrix, position: [f32; 3]) -> [f64; 3] {
    let [x, y, z] = position.map(f64::from);
    [0, 1, 2].map(|i| a[i] * x + b[i] * y + c[i] * z + d[i])
}

/// The height of the lowest surface above each texel.
struct Heights {
    side: usize,
    lowest: Vec<f64>,
    /// The number of samples that may still be taken; none after more were needed.
    steps: Option<u64>,
}

impl Heights {
    fn new(look: &GroundLook) -> Self {
        let lowest = vec![f64::INFINITY; look.texels * look.texels];
        Self { side: look.texels, lowest, steps: Some(look.most_steps) }
    }

    /// Adds samples of a triangle, at most a texel apart. Vertical triangles get samples, too.
    fn add(&mut self, [a, b, c]: [Point; 3]) {
        let [ab, bc, ca] = [distance(a, b), distance(b, c), distance(c, a)];
        if ab < 1.0 && bc < 1.0 && ca < 1.0 {
            [a, b, c].into_iter().for_each(|point| self.add_sample(point));
        } else if ab >= bc && ab >= ca {
            self.add_strips([a, b, c], [ca, bc]);
        } else if bc >= ca {
            self.add_strips([b, c, a], [ab, ca]);
        } else {
            self.add_strips([c, a, b], [bc, ab]);
        }
    }

    /// Adds samples along lines from the longest side `ab` to the same fraction of the way from `a` over `c`
    /// to `b`. `sides`: the lengths of `ac` and `cb`.
    fn add_strips(&mut self, [a, b, c]: [Point; 3], [ac, cb]: [f64; 2]) {
        let lines = (ac + cb).ceil().max(1.0);
        let mut line = 0.0;
        while line <= lines && self.steps.is_some() {
            let way = (ac + cb) * line / lines;
            let from = mix(a, b, line / lines);
            let to = if way < ac { mix(a, c, way / ac) } else { mix(c, b, (way - ac) / cb.max(1e-9)) };
            let samples = distance(from, to).ceil().max(1.0);
            let mut sample = 0.0;
            while sample <= samples {
                self.add_sample(mix(from, to, sample / samples));
                sample += 1.0;
            }
            line += 1.0;
        }
    }

    fn add_sample(&mut self, [x, height, z]: Point) {
        self.steps = self.steps.and_then(|steps| steps.checked_sub(1));
        let [column, row] = [x, z].map(|at| (at.max(0.0) as usize).min(self.side - 1));
        let lowest = &mut self.lowest[row * self.side + column];
        *lowest = lowest.min(height);
    }

    /// The part of the light that is missing, of 255. `radius`: R in texels. None if there were too many
    /// samples.
    fn darkness(&self, look: &GroundLook, radius: f64) -> Option<Vec<u8>> {
        self.steps?;
        let mut light = vec![1.0; self.lowest.len()];
        for Shadow { reach, blur, darkness } in &look.shadows {
            let shadow = self.lowest.iter().map(|height| (1.0 - height / reach).max(0.0));
            let mut shadow: Vec<f64> = shadow.map(|x| x * x).collect();
            let radius = (blur * radius + 0.5).floor() as usize;
            for _ in 0..3 {
                shadow = blurred_and_turned(&shadow, self.side, radius);
                shadow = blurred_and_turned(&shadow, self.side, radius);
            }
            light.iter_mut().zip(&shadow).for_each(|(light, shadow)| *light *= 1.0 - darkness * shadow);
        }
        Some(light.iter().map(|light| (255.0 * (1.0 - light) + 0.5).floor() as u8).collect())
    }
}

/// The means of `2 radius + 1` texels along each row, with rows and columns exchanged. Beyond the edge, there
/// is 0.
fn blurred_and_turned(texels: &[f64], side: usize, radius: usize) -> Vec<f64> {
    let mut out = vec![0.0; texels.len()];
    let width = (2 * radius + 1) as f64;
    for (at, row) in texels.chunks_exact(side).enumerate() {
        let mut sum: f64 = row[..radius.min(side)].iter().sum();
        for x in 0..side {
            sum += row.get(x + radius).unwrap_or(&0.0);
            out[x * side + at] = sum / width;
            sum -= x.checked_sub(radius).map_or(0.0, |x| row[x]);
        }
    }
    out
}

/// The larger of the distances along x and z.
fn distance(a: Point, b: Point) -> f64 {
    (b[0] - a[0]).abs().max((b[2] - a[2]).abs())
}

fn mix(a: Point, b: Point, t: f64) -> Point {
    [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytemuck::Zeroable;

    use crate::algebra::IDENTITY;
    use crate::vertex::SurfaceVertex;

    /// A parallelogram with a corner and two sides, at some places.
    fn quad([a, u, v]: [[f32; 3]; 3], matrices: &[Matrix]) -> Part {
        let at = |s: f32, t: f32| SurfaceVertex {
            position: [0, 1, 2].map(|i| a[i] + s * u[i] + t * v[i]),
            ..SurfaceVertex::zeroed()
        };
        let [a, b, c, d] = [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)];
        Part::of(vec![a, b, d, a, d, c], matrices)
    }

    const PLATE: [[f32; 3]; 3] = [[-1.0, 0.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0]];

    /// The shadow in the middle, and the darkest texel of the border.
    fn middle_and_border(ground: &Ground) -> [u8; 2] {
        let side = Studio::get().ground.texels;
        let at = |row: usize, column: usize| ground.texels[row * side + column];
        let border = (0..side).flat_map(|i| [at(0, i), at(side - 1, i), at(i, 0), at(i, side - 1)]);
        [at(side / 2, side / 2), border.max().unwrap_or(0)]
    }

    #[test]
    fn the_ground_is_dark_below_the_model_and_fades_to_nothing() {
        let wall = [[-1.0, 2.0, -1.0], [2.0, 0.0, 2.0], [0.0, 2.0, 0.0]];
        let pole = [[0.0, 3.0, 0.0], [0.5, 0.0, 0.0], [0.0, 9.0, 0.5]];
        for sides in [PLATE, wall, pole] {
            let ground = Ground::below(&[quad(sides, &[IDENTITY])]).expect("a ground");
            let [middle, border] = middle_and_border(&ground);
            assert!(middle > 5 && border == 0, "{sides:?}: {middle} in the middle, {border} at the border");
            assert_eq!(ground.middle[1], f64::from(sides[0][1]));
        }
        // Between two plates on the ground.
        let raised = |height: f64| {
            let at =
                |x: f64, y: f64| [[1.0, 0.0, 0.0, 0.0], [0.0; 4], [0.0, 0.0, 1.0, 0.0], [x, y, 0.0, 1.0]];
            let parts = [quad(PLATE, &[at(0.0, height), at(-9.0, 0.0), at(9.0, 0.0)])];
            middle_and_border(&Ground::below(&parts).expect("a ground"))[0]
        };
        assert!(raised(0.1) > raised(1.0) && raised(1.0) > raised(6.0), "higher surfaces cast less shadow");
    }

    #[test]
    fn models_without_extent_or_with_too_many_large_triangles_have_no_ground() {
        assert!(Ground::below(&[]).is_none());
        assert!(Ground::below(&[quad([[1.0; 3], [0.0; 3], [0.0; 3]], &[IDENTITY])]).is_none());
        assert!(Ground::below(&[quad(PLATE, &[[[f64::NAN; 4]; 4]])]).is_none());
        assert!(Ground::below(&[quad(PLATE, &vec![IDENTITY; 20])]).is_some());
        assert!(Ground::below(&[quad(PLATE, &vec![IDENTITY; 2000])]).is_none());
    }
}
