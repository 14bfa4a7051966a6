//! Which triangles meet at which edges.
//!
//! Two triangles are neighbours when they run along an edge in opposite directions. On an edge of more than two, the next
//! unassigned one that runs the opposite way is taken, in triangle order.

use std::collections::VecDeque;

use crate::triangles::Triangles;

/// No neighbour.
pub(crate) const NONE: u32 = u32::MAX;

/// How far edges are put in order before they are matched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EdgeOrder {
    /// Wholly.
    Complete,
    /// As the reference does: its edges with the largest lower vertex stay as an unstable sort left them, and matches
    /// among them can be missed (the reference's issue 5).
    Reference,
}

/// A half-edge: corner `k` of triangle `t` to the next corner, as `3 t + k`; in a run of edges with one lower vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    upper: u32,
    half_edge: u32,
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
        if order == EdgeOrder::Reference && start == last_run_start && order_shows(run) {
            leave_as_reference(triangles, run);
        } else {
            run.sort_unstable();
        }
        for same in run.chunk_by(|a, b| a.upper == b.upper) {
            match_edges(triangles, same, &mut neighbours);
        }
        start = end;
    }
    neighbours
}

/// The lower and upper vertex of a half-edge.
fn ends(triangles: &Triangles, half_edge: usize) -> (u32, u32) {
    let vertices = triangles.vertices[half_edge / 3];
    let (a, b) = (vertices[half_edge % 3], vertices[(half_edge + 1) % 3]);
    (a.min(b), a.max(b))
}

/// All half-edges, sorted by their lower vertex and else in order, and where the run of each vertex ends.
fn edges_by_lower_vertex(triangles: &Triangles) -> (Vec<Edge>, Vec<u32>) {
    let count = 3 * triangles.len();
    let vertices = triangles.vertices.as_flattened().iter().max().map_or(0, |&max| max as usize + 1);
    let mut next = vec![0u32; vertices + 1];
    for half_edge in 0..count {
        next[ends(triangles, half_edge).0 as usize + 1] += 1;
    }
    for vertex in 0..vertices {
        next[vertex + 1] += next[vertex];
    }
    let mut edges = vec![Edge { upper: 0, half_edge: 0 }; count];
    for half_edge in 0..count {
        let (lower, upper) = ends(triangles, half_edge);
        let slot = &mut next[lower as usize];
        edges[*slot as usize] = Edge { upper, half_edge: half_edge as u32 };
        *slot += 1;
    }
    next.truncate(vertices);
    (edges, next)
}

/// True when another order of the last run could change which edges are matched: it holds an edge twice, and something else.
fn order_shows(run: &[Edge]) -> bool {
    let mut uppers: Vec<u32> = run.iter().map(|edge| edge.upper).collect();
    uppers.sort_unstable();
    let distinct = uppers.chunk_by(|a, b| a == b).count();
    run.len() > 2 && distinct < run.len()
}

/// Puts the last run into the reference's order: as its sort by lower vertex left it, then every stretch of equal edges by
/// triangle, but for the last stretch.
fn leave_as_reference(triangles: &Triangles, run: &mut [Edge]) {
    let mut keys: Vec<(u32, u32)> =
        (0..3 * triangles.len()).map(|half_edge| (ends(triangles, half_edge).0, half_edge as u32)).collect();
    sort_as_reference(&mut keys);
    let last = &keys[keys.len() - run.len()..];
    for (edge, &(_, half_edge)) in run.iter_mut().zip(last) {
        *edge = Edge { upper: ends(triangles, half_edge as usize).1, half_edge };
    }
    let mut stretches = run.chunk_by_mut(|a, b| a.upper == b.upper);
    stretches.next_back();
    for stretch in stretches {
        stretch.sort_unstable();
    }
}

/// The reference's quicksort by the first of each pair: unstable, its pivots drawn from a seed that both halves inherit.
fn sort_as_reference(keys: &mut [(u32, u32)]) {
    const SEED: u32 = 39_871_946;
    let mut pending = vec![(0, keys.len(), SEED)];
    while let Some((start, end, seed)) = pending.pop() {
        let range = &mut keys[start..end];
        match range {
            [] | [_] => {}
            [a, b] => {
                if a.0 > b.0 {
                    range.swap(0, 1);
                }
            }
            _ => {
                let seed = seed.wrapping_add(seed.rotate_left(seed & 31)).wrapping_add(3);
                let pivot = range[seed as usize % range.len()].0;
                let (left_end, right_start) = exchange_around(range, pivot);
                pending.push((start, start + left_end, seed));
                pending.push((start + right_start, end, seed));
            }
        }
    }
}

/// Exchanges from both ends until no key above `pivot` is left of one below; returns the ends of the two halves.
fn exchange_around(keys: &mut [(u32, u32)], pivot: u32) -> (usize, usize) {
    let (mut left, mut right) = (0, keys.len());
    loop {
        while keys[left].0 < pivot {
            left += 1;
        }
        while keys[right - 1].0 > pivot {
            right -= 1;
        }
        if left < right {
            keys.swap(left, right - 1);
            left += 1;
            right -= 1;
        }
        if left >= right {
            return (right, left);
        }
    }
}

/// Makes neighbours of the half-edges along one edge, in order: each takes the next free one that runs the opposite way.
fn match_edges(triangles: &Triangles, same: &[Edge], neighbours: &mut [[u32; 3]]) {
    let runs_upwards = |edge: &Edge| {
        let h = edge.half_edge as usize;
        let vertices = triangles.vertices[h / 3];
        vertices[h % 3] < vertices[(h + 1) % 3]
    };
    // Of the edges before the current one that found no mate, all run the same way: their mates would have found them.
    // So waiting edges form one queue, and taking its first is taking the next free one in the other edge's order.
    let mut waiting: VecDeque<&Edge> = VecDeque::new();
    for edge in same {
        match waiting.front() {
            Some(&first) if runs_upwards(first) != runs_upwards(edge) => {
                waiting.pop_front();
                let (a, b) = (first.half_edge as usize, edge.half_edge as usize);
                neighbours[a / 3][a % 3] = (b / 3) as u32;
                neighbours[b / 3][b % 3] = (a / 3) as u32;
            }
            _ => waiting.push_back(edge),
        }
    }
}
