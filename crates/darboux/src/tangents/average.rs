//! The mean of the adjacent triangles' unit tangents and bitangents, gathered per vertex: every triangle counts the same.
//!
//! The adjacency is compressed: one array of triangles, ordered by vertex, and one of running sums that says where each
//! vertex's part ends. Each vertex reads what it needs and writes once, which is the form that parallel hardware wants.

use super::accumulate::{Sums, gather, terms};
use super::flat::Flat;
use super::sums::{Derivatives, Sum, Weighting};
use super::width::Width;

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

/// The sums of all vertices, gathered: what [`super::accumulate::accumulate`] would scatter.
pub(super) fn average(flat: &Flat<'_>, width: Width, sums: &mut Sums<3>) {
    let (terms, used) = terms::<3, Average>(flat, width, sums);
    let (triangle_of_entry, ends) = adjacency(flat);
    gather((&terms, used), (&triangle_of_entry, &ends), sums);
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
