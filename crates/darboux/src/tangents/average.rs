//! The mean of the adjacent triangles' unit tangents and bitangents, gathered per vertex: every triangle counts the same.
//!
//! The adjacency is compressed: one array of triangles, ordered by vertex, and one of running sums that says where each
//! vertex's part ends. Each vertex reads what it needs and writes once, which is the form that parallel hardware wants.

use super::flat::Flat;
use super::sums::{Derivatives, Sum, Sums, Weighting, accumulate_into, for_each_term};

/// Weight one for every triangle.
pub(super) struct Average;

impl Weighting<3> for Average {
    #[inline(always)]
    fn term(derivatives: &Derivatives) -> Sum<3> {
        let ([[s0, s1, s2], [t0, t1, t2]], [m0, m1]) = derivatives.directions();
        [[s0, s1, s2, 1.0], [t0, t1, t2, m0], [0.0, 0.0, 0.0, m1]]
    }

    fn size(sum: &Sum<3>) -> f32 {
        sum[0][3]
    }

    fn magnitude([[_, _, _, count], [_, _, _, m0], [_, _, _, m1]]: &Sum<3>) -> [f32; 2] {
        [m0 / count, m1 / count]
    }
}

/// The sums of all vertices, gathered: what [`super::sums::accumulate`] would scatter.
pub(super) fn gather(flat: &Flat<'_>, mut sums: Sums<3>) -> Sums<3> {
    let mut terms: Vec<(Sum<3>, usize)> = vec![([[0.0; 4]; 3], 0); flat.triangles().len()];
    let mut used_sides = [false; 2];
    for_each_term::<3, Average>(flat, &mut sums, |_, (t, _), term, side| {
        terms[t] = (*term, side);
        used_sides[side] = true;
    });
    if used_sides[1] {
        sums.side(1);
    }
    let (triangle_of_entry, ends) = adjacency(flat);
    let mut start = 0;
    for (v, end) in ends.into_iter().map(|end| end as usize).enumerate() {
        for &t in &triangle_of_entry[start..end] {
            let (term, side) = &terms[t as usize];
            accumulate_into(&mut sums.of_side[*side][v], term);
        }
        start = end;
    }
    sums
}

/// The triangles at each vertex, ascending, vertex after vertex, and where each vertex's part ends.
fn adjacency(flat: &Flat<'_>) -> (Vec<u32>, Vec<u32>) {
    let vertices = flat.triangles().as_flattened();
    let mut ends = vec![0u32; flat.positions.len()];
    for &v in vertices {
        ends[v as usize] += 1;
    }
    let mut sum = 0;
    for end in &mut ends {
        // For now the start; filling moves it to the end.
        sum += std::mem::replace(end, sum);
    }
    let mut triangle_of_entry = vec![0; vertices.len()];
    for (corner, &v) in vertices.iter().enumerate() {
        let slot = &mut ends[v as usize];
        triangle_of_entry[*slot as usize] = (corner / 3) as u32;
        *slot += 1;
    }
    (triangle_of_entry, ends)
}
