//! The order in which mikktspace.c matches the edge tail: the half-edges with the largest lower vertex.
//!
//! The reference sorts half-edges by lower vertex with a quicksort, then each run of equal lower vertices by
//! upper vertex, then each run of equal edges by triangle. Its loops end one run early, so that the tail
//! keeps the order of the first, unstable sort. Equal edges that are not adjacent in that order are never
//! matched with each other.
//!
//! ```text
//! quicksort(list):                        # only ranges that can hold tail half-edges
//!     pivot = lower vertex of list[seed % length]
//!     exchange from both ends around the pivot
//!     continue with the right part, and with the left part if the pivot is the tail's lower vertex
//! split the tail into runs of equal edges
//! sort each run but the last              # the reference omits the last run
//! ```
//!
//! The fast path does not know every vertex's name, the number that the reference sorts by. So the sort works
//! on lower and upper bounds of names, and calls [`Edges::resolve_names`] only for vertices whose bounds do
//! not decide.
//!
//! Source: mikktspace.c, `BuildNeighborsFast` and `QuickSortEdges`.

use crate::util::radix_sort::sort;

/// A half-edge by its triangle: the triangle's corners, and the index 0 to 2 of the corner where the
/// half-edge starts.
pub(crate) type TriangleEdge = ([u32; 3], u32);

/// Half-edges `3 t + k`, and bounds of the names of their vertices.
pub(crate) trait Edges {
    /// The two vertices of a half-edge.
    fn ends(&self, edge: u32) -> [u32; 2];

    /// The lower and the upper bound of a vertex's name.
    fn bounds(&self, vertex: u32) -> [u32; 2];

    /// Computes the exact names of vertices. Afterwards their bounds are equal.
    fn resolve_names(&mut self, vertices: &[u32]);

    /// The lower (`which` = 0) or upper (1) bound of the name of a half-edge's lower vertex.
    #[inline(always)]
    fn lower_bound(&self, edge: u32, which: usize) -> u32 {
        let [a, b] = self.ends(edge).map(|vertex| self.bounds(vertex)[which]);
        a.min(b)
    }
}

/// Half-edges of triangles whose vertex numbers are the names.
pub(crate) struct NamedTriangles<'a>(pub &'a [[u32; 3]]);

impl Edges for NamedTriangles<'_> {
    fn ends(&self, edge: u32) -> [u32; 2] {
        let (t, k) = (edge as usize / 3, edge as usize % 3);
        [self.0[t][k], self.0[t][(k + 1) % 3]]
    }

    fn bounds(&self, vertex: u32) -> [u32; 2] {
        [vertex; 2]
    }

    fn resolve_names(&mut self, _vertices: &[u32]) {}
}

/// Returns the runs of the edge tail, in the reference's order. Half-edges match within a run only.
///
/// `list`: all half-edges, ascending; reordered by the call. `last`: the name of the tail's lower vertex.
/// `count`: the length of the tail. Equal edges can lie in several runs; then matches are missed (the
/// reference's issue 5).
pub(crate) fn tail_runs(list: &mut [u32], last: u32, count: usize, edges: &mut impl Edges) -> Vec<Vec<u32>> {
    sort_last(list, last, edges);
    let tail = &list[list.len() - count..];
    let sorted_ends = |edge: u32| {
        let [a, b] = edges.ends(edge);
        [a.min(b), a.max(b)]
    };
    let same = tail.chunk_by(|&a, &b| sorted_ends(a) == sorted_ends(b));
    let mut runs: Vec<Vec<u32>> = same.map(<[u32]>::to_vec).collect();
    // The reference does not sort the last run.
    runs.iter_mut().rev().skip(1).for_each(|run| sort(run));
    runs
}

const SEED: u32 = 39_871_946;

/// The reference's quicksort, restricted to ranges that can hold half-edges of the tail. Both parts of a
/// range inherit its seed.
fn sort_last(list: &mut [u32], last: u32, edges: &mut impl Edges) {
    let mut pending = vec![(0, list.len(), SEED)];
    while let Some((start, end, seed)) = pending.pop() {
        let range = &mut list[start..end];
        match range {
            [] | [_] => {}
            [a, b] => {
                if lower(*a, edges) > lower(*b, edges) {
                    range.swap(0, 1);
                }
            }
            _ => {
                let seed = seed.wrapping_add(seed.rotate_left(seed & 31)).wrapping_add(3);
                let pivot = lower(range[seed as usize % range.len()], edges);
                resolve_near(pivot, range, edges);
                let (left_end, right_start) = exchange_around(range, pivot, edges);
                // The left part of a smaller pivot holds nothing of the tail.
                if pivot == last {
                    pending.push((start, start + left_end, seed));
                }
                pending.push((start + right_start, end, seed));
            }
        }
    }
}

/// The name of a half-edge's lower vertex.
fn lower(edge: u32, edges: &mut impl Edges) -> u32 {
    edges.resolve_names(&edges.ends(edge));
    edges.lower_bound(edge, 0)
}

/// Resolves the names of the vertices whose bounds do not decide the comparison with `pivot`.
fn resolve_near(pivot: u32, list: &[u32], edges: &mut impl Edges) {
    let mut unclear = Vec::new();
    for &edge in list {
        for vertex in edges.ends(edge) {
            let [low, high] = edges.bounds(vertex);
            if low < high && low <= pivot && pivot <= high {
                unclear.push(vertex);
            }
        }
    }
    edges.resolve_names(&unclear);
}

/// Exchanges half-edges from both ends until none above `pivot` is left of one below. Returns the end of the
/// left part and the start of the right part.
fn exchange_around(list: &mut [u32], pivot: u32, edges: &impl Edges) -> (usize, usize) {
    let (mut left, mut right) = (0, list.len());
    loop {
        while edges.lower_bound(list[left], 1) < pivot {
            left += 1;
        }
        while edges.lower_bound(list[right - 1], 0) > pivot {
            right -= 1;
        }
        if left < right {
            list.swap(left, right - 1);
            left += 1;
            right -= 1;
        }
        if left >= right {
            return (right, left);
        }
    }
}
