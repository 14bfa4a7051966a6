//! [`auto_cage`]: the closest cage from which rays see all of the high surface that belongs to the low one.
//!
//! From points all over the low triangles, lines run along the directions of the cage, and all their hits
//! within a distance are listed. Going outwards from the low surface, a line first leaves the body that it is
//! in. Where it enters another body behind a gap, such as a handle above a lid, what follows belongs to that
//! body. The last hit before decides how far outside the ray of the point has to begin.
//!
//! ```text
//! points     spread over every triangle, more on larger ones
//! heights    where the ray of each point has to begin
//! triangles  the smallest offset at which all but a share of the points see what they would see from farther outside
//! vertices   the largest offset of the triangles around
//! ```

use std::collections::HashMap;

use darboux::Context;
use darboux::internal::jobs;

use crate::bvh::{Bvh, Ray, Sides, Stack};
use crate::cage::cage_directions;
use crate::high::HighGroup;
use crate::vector::{Vector, add_scaled, cross, length, narrow, scale, sub, unit, weighted, wide};
use crate::{BakeError, LowSurface, PreparedSurfaces, inflated_cage_by};

/// The points on all triangles together, and the least on each.
const POINTS: f64 = 262_144.0;
const LEAST_POINTS: usize = 48;

/// The most hits of a line that are listed.
const MOST_HITS: usize = 64;

/// A body behind a gap of more than this share of the reach is another one.
const GAP: f64 = 0.05;

/// How far outside of what they have to see rays begin, and how far inside of it they end, as a share of the
/// reach.
const MARGIN: f64 = 0.02;

/// Triangles per job.
const CHUNK: usize = 64;

/// Options of [`auto_cage`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AutoCageOptions {
    /// The share of a triangle's rays that may change their hit if they began farther outside, from 0 to 1.
    pub share: f32,
    /// The largest offset, in units of the positions. What lies farther outside is not looked for.
    pub reach: f32,
}

impl AutoCageOptions {
    /// `share`, `reach`: as the fields.
    pub fn new(share: f32, reach: f32) -> Self {
        Self { share, reach }
    }

    /// Refuses options with which no cage can be made, as [`auto_cage`] does.
    ///
    /// # Errors
    ///
    /// [`BakeError::Option`].
    pub fn check(&self) -> Result<(), BakeError> {
        let Self { share, reach } = *self;
        if !(0.0..1.0).contains(&share) {
            let (what, expected) = ("the share of rays that may change their hit", "from 0 on and below 1");
            return Err(BakeError::Option { what, expected, found: share });
        }
        if !(reach > 0.0 && reach.is_finite()) {
            let (what, expected) = ("the largest offset of a cage", "finite and above 0");
            return Err(BakeError::Option { what, expected, found: reach });
        }
        Ok(())
    }
}

/// The result of [`auto_cage`].
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct AutoCage {
    /// For each low surface, the positions of the cage: one per vertex.
    pub positions: Vec<Vec<[f32; 3]>>,
    /// The smallest and the largest offset, in units of the positions.
    pub offsets: [f32; 2],
    /// How far inside rays have to end, in units of the positions.
    pub inwards: f32,
}

/// Makes the cage of low surfaces.
///
/// Vertices at equal positions have equal offsets, so that hard edges leave no gaps. The cage has the same
/// bits for every number of threads. Errors: options out of range; the context's token was cancelled.
pub fn auto_cage(
    surfaces: &PreparedSurfaces<'_>,
    options: &AutoCageOptions,
    context: &mut Context,
) -> Result<AutoCage, BakeError> {
    options.check()?;
    let AutoCageOptions { share, reach } = *options;
    let total_area: f64 = surfaces.low.iter().map(|low| areas(low).sum::<f64>()).sum();
    let in_box = f64::from(surfaces.space.distance(reach));
    let mut cage = AutoCage { offsets: [f32::INFINITY, 0.0], ..AutoCage::default() };
    let mut depths = Vec::new();
    for low in &surfaces.low {
        let lines = Lines {
            low,
            group: &surfaces.groups[low.group],
            directions: cage_directions(&low.mesh)?,
            reach: in_box,
            share: f64::from(share),
            points_per_area: if total_area > 0.0 { POINTS / total_area } else { 0.0 },
        };
        let found = lines.of_triangles(context)?;
        depths.extend(found.iter().map(|(_, depth)| *depth));
        let of_vertex = lines.offsets_of_vertices(&found);
        let restored = |offset: f64| surfaces.space.restored(offset + MARGIN * in_box) as f32;
        let of_vertex: Vec<f32> = of_vertex.into_iter().map(restored).collect();
        for &offset in &of_vertex {
            cage.offsets = [cage.offsets[0].min(offset), cage.offsets[1].max(offset)];
        }
        cage.positions.push(inflated_cage_by(&low.mesh, &of_vertex)?);
    }
    let depth = depths.into_iter().fold(0.0, f64::max);
    cage.inwards = surfaces.space.restored(depth + MARGIN * in_box) as f32;
    Ok(cage)
}

/// The lines of a low surface. All lengths are in the common box.
struct Lines<'a> {
    low: &'a LowSurface<'a>,
    group: &'a HighGroup<'a>,
    directions: Vec<Option<Vector>>,
    reach: f64,
    share: f64,
    points_per_area: f64,
}

impl Lines<'_> {
    /// The offset of each triangle, and how deep inside its rays have to end.
    fn of_triangles(&self, context: &Context) -> Result<Vec<(f64, f64)>, BakeError> {
        let areas: Vec<f64> = areas(self.low).collect();
        let mut found = vec![(0.0, 0.0); areas.len()];
        let mut chunks: Vec<_> = found.chunks_mut(CHUNK).enumerate().collect();
        jobs::for_each(context, &mut chunks, |(chunk, found)| {
            let mut stack = Stack::new();
            for (place, found) in found.iter_mut().enumerate() {
                let triangle = *chunk * CHUNK + place;
                *found = self.of_triangle(triangle, areas[triangle], &mut stack);
            }
        })?;
        Ok(found)
    }

    fn of_triangle(&self, triangle: usize, area: f64, stack: &mut Stack) -> (f64, f64) {
        let corners = corners(self.low, triangle);
        let vertices = [0, 1, 2].map(|corner| self.low.mesh.vertex_of_corner(3 * triangle + corner));
        let directions = vertices.map(|vertex| self.directions[vertex].unwrap_or_default());
        let count = ((area * self.points_per_area) as usize).clamp(LEAST_POINTS, POINTS as usize);
        let mut heights: Vec<f64> = (0..count)
            .filter_map(|index| {
                let weights = spread(index);
                let direction = [0, 1, 2]
                    .map(|axis| (0..3).map(|corner| weights[corner] * directions[corner][axis]).sum::<f64>());
                self.height(weighted(weights, corners), direction, stack)
            })
            .collect();
        if heights.is_empty() {
            return (0.0, 0.0);
        }
        heights.sort_by(f64::total_cmp);
        let spared = (self.share * heights.len() as f64) as usize;
        let highest = heights[heights.len() - 1 - spared.min(heights.len() - 1)];
        let deepest = heights[spared.min(heights.len() - 1)];
        (highest.max(0.0), (-deepest).max(0.0))
    }

    /// Where the ray of a point has to begin, as a multiple of the cage's direction; negative inside. None
    /// where nothing is hit.
    fn height(&self, point: Vector, direction: Vector, stack: &mut Stack) -> Option<f64> {
        let size = length(direction);
        let outwards = unit(direction)?;
        let reach = self.reach * size;
        let origin = add_scaled(point, reach, outwards);
        let hits = all_hits(&self.group.bvh, origin, scale(-1.0, outwards), 2.0 * reach, stack);
        // From inside to outside.
        let places: Vec<(f64, bool)> =
            hits.iter().rev().map(|&(distance, is_front)| (reach - distance, is_front)).collect();
        let near = 1e-3 * reach;
        let inside = places.iter().rposition(|&(place, is_front)| is_front && place <= near);
        // Without a front below, the point lies inside the body, whose front comes before the back of any
        // other.
        let above = || places.iter().position(|&(place, _)| place > near).filter(|&at| places[at].1);
        let first = inside.or_else(above)?;
        let mut height = places[first].0;
        for &(place, is_front) in &places[first + 1..] {
            if is_front {
                height = place;
            } else if place - height > GAP * reach {
                break;
            }
        }
        Some(height / size)
    }

    /// The offsets of vertices: the largest of the triangles around, and equal at equal positions.
    fn offsets_of_vertices(&self, of_triangle: &[(f64, f64)]) -> Vec<f64> {
        let mesh = &self.low.mesh;
        let place = |vertex: usize| mesh.positions().get(vertex).map(|x| (x + 0.0).to_bits());
        let mut of_place: HashMap<[u32; 3], f64> = HashMap::new();
        for corner in 0..mesh.corner_count() {
            let offset = of_place.entry(place(mesh.vertex_of_corner(corner))).or_default();
            *offset = offset.max(of_triangle[corner / 3].0);
        }
        (0..mesh.vertex_count())
            .map(|vertex| of_place.get(&place(vertex)).copied().unwrap_or_default())
            .collect()
    }
}

/// The distances of all hits of a ray, the nearest first, and whether each is on a front.
fn all_hits(bvh: &Bvh, origin: Vector, direction: Vector, end: f64, stack: &mut Stack) -> Vec<(f64, bool)> {
    let mut hits = Vec::new();
    let mut passed = 0.0;
    let step = 1e-5 * end;
    while hits.len() < MOST_HITS && passed < end {
        let ray = Ray {
            origin: narrow(add_scaled(origin, passed, direction)),
            direction: narrow(direction),
            length: (end - passed) as f32,
        };
        let Some(hit) = bvh.nearest(&ray, Sides::Both, stack) else { break };
        let distance = passed + f64::from(hit.distance);
        hits.push((distance, hit.is_front));
        passed = distance + step;
    }
    hits
}

/// The weights of a point of an even sequence over a triangle (M. Roberts, "The Unreasonable Effectiveness of
/// Quasirandom Sequences", 2018).
fn spread(index: usize) -> [f64; 3] {
    const STEP: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];
    let [u, v] = STEP.map(|step| (0.5 + step * index as f64).fract());
    let [u, v] = if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] };
    [1.0 - u - v, u, v]
}

/// The areas of the triangles of a low surface; 0 where they are not finite.
fn areas<'a>(low: &'a LowSurface<'_>) -> impl Iterator<Item = f64> + use<'a> {
    (0..low.triangle_count()).map(|triangle| {
        let [a, b, c] = corners(low, triangle).map(wide);
        let area = 0.5 * length(cross(sub(b, a), sub(c, a)));
        if area.is_finite() { area } else { 0.0 }
    })
}

fn corners(low: &LowSurface<'_>, triangle: usize) -> [[f32; 3]; 3] {
    [0, 1, 2].map(|corner| {
        let vertex = low.mesh.vertex_of_corner(3 * triangle + corner);
        low.space.position(low.mesh.positions().get(vertex))
    })
}
