//! Edge adjacency of triangles: which triangle lies across each edge.
//!
//! A half-edge `3 t + k` runs from corner `k` of triangle `t` to the next corner. Two half-edges match when
//! they connect the same two vertices in opposite directions:
//!
//! ```text
//! sort the half-edges by (lower vertex, upper vertex, number)
//! for each run of half-edges with equal vertices:
//!     match each with the first unmatched one that runs the opposite way
//! ```
//!
//! mikktspace.c sorts with a quicksort that leaves the *edge tail* unsorted: the half-edges with the largest
//! lower vertex. Matches among them can be missed (the reference's issue 5). [`EdgeOrder::Reference`]
//! reproduces that order with [`crate::topology::edge_sort`].
//!
//! Source: mikktspace.c, `BuildNeighborsFast`.

use std::collections::VecDeque;

use crate::exec::limits::RunLimits;
use crate::topology::edge_sort::{NamedTriangles, tail_runs};
use crate::topology::triangles::{NONE, Triangles};
use crate::util::radix_sort::{first, pair, second, sort};

/// The order in which half-edges are matched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EdgeOrder {
    /// All half-edges are sorted.
    Complete,
    /// The edge tail has the reference's order.
    Reference,
}

/// Finds the neighbour of every triangle across its edges 0-1, 1-2 and 2-0, or [`NONE`]. Neighbours are
/// absent after cancellation.
pub(crate) fn neighbours(triangles: &Triangles, order: EdgeOrder, limits: RunLimits<'_>) -> Vec<[u32; 3]> {
    let mut neighbours = vec![[NONE; 3]; triangles.len()];
    let (mut edges, run_ends) = edges_by_lower_vertex(triangles);
    let tail_start =
        run_ends.iter().rev().map(|&end| end as usize).find(|&end| end < edges.len()).unwrap_or(0);
    let mut start = 0;
    for (lower, end) in run_ends.into_iter().map(|end| end as usize).enumerate() {
        if limits.check_at(lower).is_err() {
            return neighbours;
        }
        let run = &mut edges[start..end];
        sort(run);
        for same in run.chunk_by(|&a, &b| first(a) == first(b)) {
            match_edges(triangles, same.iter().map(|&edge| second(edge)), &mut neighbours);
        }
        start = end;
    }
    let tail = &edges[tail_start..];
    if order == EdgeOrder::Reference && tail_order_matters(tail.iter().map(|&edge| first(edge))) {
        let (lower, _) = ends(triangles, second(tail[0]) as usize);
        let mut list: Vec<u32> = (0..3 * triangles.len() as u32).collect();
        let runs = tail_runs(&mut list, lower, tail.len(), &mut NamedTriangles(&triangles.vertices));
        rematch(triangles, &runs, &mut neighbours);
    }
    neighbours
}

/// True when the order of the edge tail can change which half-edges match: some edge occurs twice, and there
/// are more than two half-edges.
///
/// `uppers`: the upper vertices of the tail's half-edges, ascending.
pub(crate) fn tail_order_matters<U: PartialEq>(uppers: impl Iterator<Item = U> + Clone) -> bool {
    let has_equals = uppers.clone().zip(uppers.clone().skip(1)).any(|(a, b)| a == b);
    has_equals && uppers.count() > 2
}

/// Discards the neighbours of the half-edges in `runs`, and matches the half-edges of each run with each
/// other only.
pub(crate) fn rematch(triangles: &Triangles, runs: &[Vec<u32>], neighbours: &mut [[u32; 3]]) {
    let slots = neighbours.as_flattened_mut();
    runs.iter().flatten().for_each(|&half_edge| slots[half_edge as usize] = NONE);
    for run in runs {
        match_edges(triangles, run.iter().copied(), neighbours);
    }
}

/// The lower and upper vertex of a half-edge.
fn ends(triangles: &Triangles, half_edge: usize) -> (u32, u32) {
    let vertices = triangles.vertices[half_edge / 3];
    let (a, b) = (vertices[half_edge % 3], vertices[(half_edge + 1) % 3]);
    (a.min(b), a.max(b))
}

/// Returns all half-edges, sorted by their lower vertex (stable), and the end of each lower vertex's run.
/// Each entry is the pair of the upper vertex and the half-edge's number.
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

/// Matches half-edges with equal vertices: each with the first unmatched one that runs the opposite way.
fn match_edges(triangles: &Triangles, same: impl Iterator<Item = u32>, neighbours: &mut [[u32; 3]]) {
    let runs_upwards = |half_edge: usize| {
        let vertices = triangles.vertices[half_edge / 3];
        vertices[half_edge % 3] < vertices[(half_edge + 1) % 3]
    };
    // All unmatched half-edges before the current one run the same way, because opposite ones would have
    // matched. So one queue suffices, and its front is the first unmatched half-edge.
    let mut unmatched: VecDeque<usize> = VecDeque::new();
    for edge in same.map(|half_edge| half_edge as usize) {
        match unmatched.front() {
            Some(&first) if runs_upwards(first) != runs_upwards(edge) => {
                unmatched.pop_front();
                neighbours[first / 3][first % 3] = (edge / 3) as u32;
                neighbours[edge / 3][edge % 3] = (first / 3) as u32;
            }
            _ => unmatched.push_back(edge),
        }
    }
}
