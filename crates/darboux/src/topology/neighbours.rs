//! Which triangles meet at which edges.
//!
//! Two triangles are neighbours when they run along an edge in opposite directions. On an edge of more than two, the next
//! unassigned one that runs the opposite way is taken, in triangle order.

use std::collections::VecDeque;

use crate::topology::edge_sort::{NamedTriangles, tail_runs};
use crate::topology::triangles::{NONE, Triangles};
use crate::util::radix_sort::{first, pair, second, sort};

/// How far edges are put in order before they are matched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EdgeOrder {
    /// Wholly.
    Complete,
    /// As the reference does: its edges with the largest lower vertex stay as an unstable sort left them, and matches
    /// among them can be missed (the reference's issue 5).
    Reference,
}

/// The neighbour of every triangle across its edges 0-1, 1-2, 2-0, or [`NONE`].
pub(crate) fn neighbours(triangles: &Triangles, order: EdgeOrder) -> Vec<[u32; 3]> {
    let mut neighbours = vec![[NONE; 3]; triangles.len()];
    let (mut edges, run_ends) = edges_by_lower_vertex(triangles);
    let last_run_start =
        run_ends.iter().rev().map(|&end| end as usize).find(|&end| end < edges.len()).unwrap_or(0);
    let mut start = 0;
    for end in run_ends.into_iter().map(|end| end as usize) {
        let run = &mut edges[start..end];
        sort(run);
        for same in run.chunk_by(|&a, &b| first(a) == first(b)) {
            match_edges(triangles, same.iter().map(|&edge| second(edge)), &mut neighbours);
        }
        start = end;
    }
    let last_run = &edges[last_run_start..];
    if order == EdgeOrder::Reference && tail_order_matters(last_run.iter().map(|&edge| first(edge))) {
        let (last, _) = ends(triangles, second(last_run[0]) as usize);
        let mut list: Vec<u32> = (0..3 * triangles.len() as u32).collect();
        let stretches = tail_runs(&mut list, last, last_run.len(), &mut NamedTriangles(&triangles.vertices));
        match_again(triangles, &stretches, &mut neighbours);
    }
    neighbours
}

/// True when another order of the last run could change which edges are matched: it holds an edge twice, and something else.
///
/// `uppers`: the upper vertices of its edges, ascending.
pub(crate) fn tail_order_matters<U: PartialEq>(uppers: impl Iterator<Item = U> + Clone) -> bool {
    let has_equals = uppers.clone().zip(uppers.clone().skip(1)).any(|(a, b)| a == b);
    has_equals && uppers.count() > 2
}

/// Matches the half-edges of each stretch anew, as numbers `3 t + k`, with each other only.
pub(crate) fn match_again(triangles: &Triangles, stretches: &[Vec<u32>], neighbours: &mut [[u32; 3]]) {
    let slots = neighbours.as_flattened_mut();
    stretches.iter().flatten().for_each(|&half_edge| slots[half_edge as usize] = NONE);
    for stretch in stretches {
        match_edges(triangles, stretch.iter().copied(), neighbours);
    }
}

/// The lower and upper vertex of a half-edge.
fn ends(triangles: &Triangles, half_edge: usize) -> (u32, u32) {
    let vertices = triangles.vertices[half_edge / 3];
    let (a, b) = (vertices[half_edge % 3], vertices[(half_edge + 1) % 3]);
    (a.min(b), a.max(b))
}

/// All half-edges, sorted by their lower vertex and else in order, and where the run of each vertex ends. Each as a pair: the upper vertex;
/// corner `k` of triangle `t`, from which it goes to the next corner, as `3 t + k`.
fn edges_by_lower_vertex(triangles: &Triangles) -> (Vec<u64>, Vec<u32>) {
    let count = 3 * triangles.len();
    let vertices = triangles.vertices.as_flattened().iter().max().map_or(0, |&max| max as usize + 1);
    let mut next = vec![0u32; vertices + 1];
    for half_edge in 0..count {
        next[ends(triangles, half_edge).0 as usize + 1] += 1;
    }
    for vertex in 0..vertices {
        next[vertex + 1] += next[vertex];
    }
    let mut edges = vec![0; count];
    for half_edge in 0..count {
        let (lower, upper) = ends(triangles, half_edge);
        let slot = &mut next[lower as usize];
        edges[*slot as usize] = pair(upper, half_edge as u32);
        *slot += 1;
    }
    next.truncate(vertices);
    (edges, next)
}

/// Makes neighbours of the half-edges along one edge, in order: each takes the next free one that runs the opposite way.
fn match_edges(triangles: &Triangles, same: impl Iterator<Item = u32>, neighbours: &mut [[u32; 3]]) {
    let runs_upwards = |half_edge: usize| {
        let vertices = triangles.vertices[half_edge / 3];
        vertices[half_edge % 3] < vertices[(half_edge + 1) % 3]
    };
    // Of the edges before the current one that found no mate, all run the same way: their mates would have found them.
    // So waiting edges form one queue, and taking its first is taking the next free one in the other edge's order.
    let mut waiting: VecDeque<usize> = VecDeque::new();
    for edge in same.map(|half_edge| half_edge as usize) {
        match waiting.front() {
            Some(&first) if runs_upwards(first) != runs_upwards(edge) => {
                waiting.pop_front();
                neighbours[first / 3][first % 3] = (edge / 3) as u32;
                neighbours[edge / 3][edge % 3] = (first / 3) as u32;
            }
            _ => waiting.push_back(edge),
        }
    }
}
