//! The reference's last edges: those with the largest lower vertex, which it leaves nearly as an unstable sort left them.
//!
//! Only as far as it moves these is that sort done here.
//!
//! Source: mikktspace.c, `BuildNeighborsFast` and `QuickSortEdges`.

use crate::util::radix_sort::sort;

/// An edge of a triangle: the triangle's corners, and the place among these where the edge starts.
pub(crate) type TriangleEdge = ([u32; 3], u32);

/// Edges by the number `3 t + k` of the corner where they start, and the names of vertices, by which the reference orders them.
pub(crate) trait Edges {
    /// The vertices of an edge.
    fn ends(&self, edge: u32) -> [u32; 2];

    /// A name that is not above a vertex's, and one that is not below it.
    fn bounds(&self, vertex: u32) -> [u32; 2];

    /// Finds the names of vertices: their bounds are equal from then on.
    fn find(&mut self, vertices: &[u32]);

    /// The bound, 0 or 1, of the name of an edge's lower vertex.
    #[inline(always)]
    fn lower_bound(&self, edge: u32, which: usize) -> u32 {
        let [a, b] = self.ends(edge).map(|vertex| self.bounds(vertex)[which]);
        a.min(b)
    }
}

/// Edges of triangles whose vertices are their own names.
pub(crate) struct NamedTriangles<'a>(pub &'a [[u32; 3]]);

impl Edges for NamedTriangles<'_> {
    fn ends(&self, edge: u32) -> [u32; 2] {
        let (t, k) = (edge as usize / 3, edge as usize % 3);
        [self.0[t][k], self.0[t][(k + 1) % 3]]
    }

    fn bounds(&self, vertex: u32) -> [u32; 2] {
        [vertex; 2]
    }

    fn find(&mut self, _vertices: &[u32]) {}
}

/// The last edges, in stretches within which the reference matches them, in its order.
///
/// `list`: all edges, ascending; it is put into another order. `last`: the largest name of a lower vertex, which `count` edges have.
/// Edges between the same two vertices can lie in several stretches; then matches are missed (the reference's issue 5).
pub(crate) fn tail_runs(list: &mut [u32], last: u32, count: usize, edges: &mut impl Edges) -> Vec<Vec<u32>> {
    sort_last(list, last, edges);
    let run = &list[list.len() - count..];
    let sorted_ends = |edge: u32| {
        let [a, b] = edges.ends(edge);
        [a.min(b), a.max(b)]
    };
    let same = run.chunk_by(|&a, &b| sorted_ends(a) == sorted_ends(b));
    let mut stretches: Vec<Vec<u32>> = same.map(<[u32]>::to_vec).collect();
    // The reference forgets to sort the last stretch.
    stretches.iter_mut().rev().skip(1).for_each(|stretch| sort(stretch));
    stretches
}

const SEED: u32 = 39_871_946;

/// Sorts edges as the reference does, as far as the last ones are concerned.
///
/// The reference's quicksort: its pivots are drawn from a seed that both halves inherit.
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
                tell_from(pivot, range, edges);
                let (left_end, right_start) = exchange_around(range, pivot, edges);
                // Left of a smaller pivot there is none of the last.
                if pivot == last {
                    pending.push((start, start + left_end, seed));
                }
                pending.push((start + right_start, end, seed));
            }
        }
    }
}

/// The name of an edge's lower vertex.
fn lower(edge: u32, edges: &mut impl Edges) -> u32 {
    edges.find(&edges.ends(edge));
    edges.lower_bound(edge, 0)
}

/// Finds the names of those vertices of which it is not known whether they are below or above `pivot`.
fn tell_from(pivot: u32, list: &[u32], edges: &mut impl Edges) {
    let mut unclear = Vec::new();
    for &edge in list {
        for vertex in edges.ends(edge) {
            let [low, high] = edges.bounds(vertex);
            if low < high && low <= pivot && pivot <= high {
                unclear.push(vertex);
            }
        }
    }
    edges.find(&unclear);
}

/// Exchanges from both ends until no edge above `pivot` is left of one below; returns the ends of the two halves.
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
