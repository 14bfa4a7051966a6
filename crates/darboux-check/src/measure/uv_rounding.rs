//! UVs that were rounded to a grid so coarse that tangents turn.
//!
//! A tangent is the direction in which v is constant, so that rounding of v turns it. Where one corner of a
//! triangle is moved by half a step, the tangent turns by the angle whose tangent is, at most,
//!
//! max(|k1|, |k2|, |k2 - k1|) A / |k2 e1 - k1 e2|^2
//!
//! where e1 and e2 are the edges from the first corner, A is the area, and k1 and k2 are the steps of v along
//! these edges.
//!
//! UVs can lie on a grid by design, as on a sphere of 32 rings, and then nothing was rounded. Two triangles
//! at an edge decide: laid flat, the v of one triangle predicts the v of the fourth corner. By design the
//! prediction is right, up to what the surface bends and the layout stretches. Errors of rounding, each
//! uniform in half a step to both sides, have a mean square of (1 + a^2 + b^2 + c^2) / 12 steps, where a, b
//! and c are the weights of the three corners in the prediction. Where the errors are of another size,
//! rounding is not what turns the tangents.

use std::collections::{BTreeMap, HashSet};

use crate::indices::Indices;
use crate::measure::values::first_equal;
use crate::model_area::area_of;
use crate::surface::{Surface, dot, length, sub};

/// UVs on a coarse grid, which turns tangents.
#[derive(Clone, Debug, PartialEq)]
pub struct UvRounding {
    /// The steps of the grid from the smallest v to the largest.
    pub steps: usize,
    /// The numbers of the triangles whose tangents half a step turns by [`UvRounding::SEEN`] or more,
    /// ascending.
    pub triangles: Indices,
    /// Their part of the surface's area, from 0 to 1.
    pub share: f64,
    /// What half a step turns the tangents by, in degrees: the value that [`MIN_SHARE`] of the surface's
    /// area reaches.
    pub degrees: f64,
    /// The root mean square error of v against the neighbours' prediction, divided by the error of rounding.
    pub error: f64,
}

/// The most steps that are looked for. With more, half a step turns only the tangents of triangles by 5
/// degrees that are smaller than two texels of a map of 1024 x 1024 texels.
const MAX_STEPS: usize = 4096;

/// The most values of v that are looked at: a grid's values, each with a few neighbours that arithmetic made.
const MAX_VALUES: usize = 4 * MAX_STEPS;

/// The fewest values of v that show a grid, and the fewest pairs of triangles that show rounding.
const MIN_VALUES: usize = 24;
const MIN_PAIRS: usize = 100;

/// The part of the surface's area that is worth a finding.
const MIN_SHARE: f64 = 0.1;

/// The largest part of the edges along which v changes that have one and the same number of steps. By design
/// all or nearly all do.
const MAX_EQUAL: f64 = 0.97;

/// The errors, divided by the error of rounding, that are taken for rounding.
const ERRORS: std::ops::RangeInclusive<f64> = 0.6..=1.4;

/// The largest square of an error, divided by the mean square of rounding, that counts whole: larger squares
/// come from a crease or from a stretched layout.
const MAX_SQUARE: f64 = 4.0;

impl UvRounding {
    /// The degrees from which on a turn can be seen: a slope of 20 degrees is then lit as if it leaned by one
    /// degree to the side.
    pub const SEEN: f64 = 5.0;

    /// None where UVs were not rounded, or nothing is to be seen of it. `uvs`: of the vertices.
    pub fn of(surface: &Surface, uvs: &[[f32; 2]]) -> Option<Self> {
        let grid = Grid::of(uvs)?;
        let numbered = surface.triangles().enumerate();
        let mut turns: Vec<(f64, f64, usize)> = numbered
            .filter_map(|(number, triangle)| {
                let (turn, area) = turn(surface, &grid, triangle)?;
                Some((turn, area, number))
            })
            .collect();
        turns.sort_by(|a, b| b.0.total_cmp(&a.0));
        let all: f64 = turns.iter().map(|(_, area, _)| area).sum();
        let seen = turns.partition_point(|(turn, ..)| *turn >= Self::SEEN);
        let share = turns[..seen].iter().map(|(_, area, _)| area).sum::<f64>() / all;
        if share.is_nan() || share < MIN_SHARE {
            return None;
        }
        let mut above = 0.0;
        let (degrees, ..) = turns.iter().find(|(_, area, _)| {
            above += area;
            above >= MIN_SHARE * all
        })?;
        let error = error(surface, uvs, &grid).filter(|error| ERRORS.contains(error))?;
        let mut triangles: Vec<usize> = turns[..seen].iter().map(|(.., number)| *number).collect();
        triangles.sort_unstable();
        let triangles = triangles.as_slice().into();
        Some(Self { steps: grid.steps, triangles, share, degrees: *degrees, error })
    }
}

/// The v of all vertices in steps of the coarsest grid on which they lie.
struct Grid {
    steps: usize,
    of_vertex: Vec<i32>,
}

impl Grid {
    /// None without such a grid, or with too few values.
    fn of(uvs: &[[f32; 2]]) -> Option<Self> {
        let values = values(uvs)?;
        let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &v| {
            (low.min(f64::from(v)), high.max(f64::from(v)))
        });
        let range = high - low;
        let rounding = 2.0 * f64::from(f32::EPSILON) * low.abs().max(high.abs()) / range;
        if !(range.is_finite() && rounding.is_finite()) {
            return None;
        }
        let place = |v: f32, steps: usize| (f64::from(v) - low) / range * steps as f64;
        let is_grid = |steps: &usize| {
            let tolerance = 1e-4 + rounding * *steps as f64;
            let is_on = |&v: &f32| {
                let place = place(v, *steps);
                (place - place.round()).abs() <= tolerance
            };
            values.iter().all(is_on)
        };
        // Beyond a twentieth of a step, single precision cannot show a grid.
        let most = MAX_STEPS.min((0.05 / rounding) as usize);
        let steps = (1..=most).find(is_grid)?;
        let of_vertex: Vec<i32> = uvs.iter().map(|uv| place(uv[1], steps).round() as i32).collect();
        let mut is_used = vec![false; steps + 1];
        of_vertex.iter().for_each(|&step| is_used[step as usize] = true);
        let values = is_used.into_iter().filter(|is_used| *is_used).count();
        (values >= MIN_VALUES).then_some(Self { steps, of_vertex })
    }
}

/// The values of v; none for fewer than a grid needs and for more than [`MAX_VALUES`].
fn values(uvs: &[[f32; 2]]) -> Option<Vec<f32>> {
    let mut values = HashSet::new();
    for [_, v] in uvs {
        if values.insert(v.to_bits()) && values.len() > MAX_VALUES {
            return None;
        }
    }
    (values.len() >= MIN_VALUES).then(|| values.into_iter().map(f32::from_bits).collect())
}

/// What half a step turns the tangent of a triangle by, in degrees, and the triangle's area; none without a
/// tangent.
fn turn(surface: &Surface, grid: &Grid, triangle: [usize; 3]) -> Option<(f64, f64)> {
    let corners = triangle.map(|vertex| surface.positions[vertex]);
    let [k0, k1, k2] = triangle.map(|vertex| f64::from(grid.of_vertex[vertex]));
    let (k1, k2) = (k1 - k0, k2 - k0);
    let [e1, e2] = [1, 2].map(|corner| sub(corners[corner], corners[0]).map(f64::from));
    let along: f64 = (0..3).map(|i| (k2 * e1[i] - k1 * e2[i]).powi(2)).sum();
    let area = area_of(corners);
    let largest = k1.abs().max(k2.abs()).max((k2 - k1).abs());
    let turn = (largest * area / along).atan().to_degrees();
    (area > 0.0 && turn.is_finite()).then_some((turn, area))
}

/// Two triangles at an edge: the ends of the edge, and the corner of each triangle that faces it.
struct Pair {
    ends: [usize; 2],
    facing: [usize; 2],
}

/// The root mean square error of v against the neighbours' prediction, divided by the error of rounding; none
/// where too few triangles have neighbours, or their edges have the regular steps of a design.
fn error(surface: &Surface, uvs: &[[f32; 2]], grid: &Grid) -> Option<f64> {
    let pairs = pairs(surface, uvs);
    let mut count_of_steps: BTreeMap<u32, usize> = BTreeMap::new();
    for Pair { ends: [a, b], .. } in &pairs {
        *count_of_steps.entry(grid.of_vertex[*a].abs_diff(grid.of_vertex[*b])).or_default() += 1;
    }
    count_of_steps.remove(&0);
    let most = *count_of_steps.values().max()? as f64;
    if most > MAX_EQUAL * count_of_steps.values().sum::<usize>() as f64 {
        return None;
    }
    let squares = pairs.iter().map(|pair| squared_error(surface, grid, pair));
    let squares: Vec<f64> =
        squares.filter(|square| square.is_finite()).map(|square| square.min(MAX_SQUARE)).collect();
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    (squares.len() >= MIN_PAIRS).then_some(mean.sqrt())
}

/// The pairs of triangles at the edges of a surface that lie within charts.
fn pairs(surface: &Surface, uvs: &[[f32; 2]]) -> Vec<Pair> {
    let points = surface.positions.iter().zip(uvs).map(|([x, y, z], [u, v])| [*x, *y, *z, *u, *v]);
    let places = first_equal(&points.collect::<Vec<[f32; 5]>>());
    let mut edges: Vec<([u32; 2], usize)> = Vec::new();
    for corners in surface.triangles() {
        let [a, b, c] = corners.map(|vertex| places[vertex]);
        for (ends, facing) in [([a, b], c), ([b, c], a), ([c, a], b)] {
            edges.push(([ends[0].min(ends[1]), ends[0].max(ends[1])], facing as usize));
        }
    }
    edges.sort_unstable();
    let of_sides = |sides: &[([u32; 2], usize)]| match sides {
        [(ends, c), (_, d)] => Some(Pair { ends: ends.map(|end| end as usize), facing: [*c, *d] }),
        _ => None,
    };
    edges.chunk_by(|a, b| a.0 == b.0).filter_map(of_sides).collect()
}

/// The squared error of the prediction of v at the corner of the second triangle by the first one, over the
/// mean one of rounding; not finite for triangles without an area.
fn squared_error(surface: &Surface, grid: &Grid, Pair { ends: [a, b], facing: [c, d] }: &Pair) -> f64 {
    let [a, b, c, d] = [*a, *b, *c, *d];
    let edge = sub(surface.positions[b], surface.positions[a]);
    let edge_length = length(edge);
    // Along the edge and across it, after both triangles were laid flat.
    let flat = |vertex: usize| {
        let from_a = sub(surface.positions[vertex], surface.positions[a]);
        let along = dot(from_a, edge) / edge_length;
        [along, (dot(from_a, from_a) - along * along).max(0.0).sqrt()]
    };
    let ([along_c, across_c], [along_d, across_d]) = (flat(c), flat(d));
    let weight_c = -across_d / across_c;
    let weight_b = (along_d - weight_c * along_c) / edge_length;
    let weight_a = 1.0 - weight_b - weight_c;
    let [of_a, of_b, of_c, of_d] = [a, b, c, d].map(|vertex| f64::from(grid.of_vertex[vertex]));
    let error = of_d - weight_a * of_a - weight_b * of_b - weight_c * of_c;
    12.0 * error * error / (1.0 + weight_a.powi(2) + weight_b.powi(2) + weight_c.powi(2))
}
