//! The reference's last edges: those with the largest lower vertex, which it leaves nearly as an unstable sort left them.
//!
//! Only as far as it moves these is that sort done here.
//!
//! Source: mikktspace.c, `BuildNeighborsFast` and `QuickSortEdges`.

/// A half-edge: the vertices at its ends, and corner `k` of triangle `t`, where it starts, as `3 t + k`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfEdge {
    pub ends: [u32; 2],
    pub corner: u32,
}

/// The names of vertices, by which the reference puts them in order.
pub(crate) trait Names {
    /// A name that is not above a vertex's, and one that is not below it.
    fn bounds(&self, vertex: u32) -> [u32; 2];

    /// Finds the names of vertices: their bounds are equal from then on.
    fn find(&mut self, vertices: &[u32]);
}

/// Vertices that are their own names.
pub(crate) struct OwnNames;

impl Names for OwnNames {
    fn bounds(&self, vertex: u32) -> [u32; 2] {
        [vertex; 2]
    }

    fn find(&mut self, _vertices: &[u32]) {}
}

const SEED: u32 = 39_871_946;

/// The corners of the last edges, in stretches within which the reference matches them, in its order.
///
/// `edges`: all, in the order of their corners. `last`: the largest name of a lower vertex. Edges between the same two vertices
/// can lie in several stretches; then matches are missed (the reference's issue 5).
pub(crate) fn last_stretches(mut edges: Vec<HalfEdge>, last: u32, names: &mut impl Names) -> Vec<Vec<u32>> {
    tell_from(last, &edges, names);
    let is_last = |edge: &&HalfEdge| bound(edge, 0, names) == last;
    let count = edges.iter().filter(is_last).count();
    sort_last(&mut edges, last, names);
    let run = &edges[edges.len() - count..];
    let are_one = |a: &HalfEdge, b: &HalfEdge| a.ends == b.ends || a.ends == [b.ends[1], b.ends[0]];
    let corners = |stretch: &[HalfEdge]| stretch.iter().map(|edge| edge.corner).collect();
    let mut stretches: Vec<Vec<u32>> = run.chunk_by(are_one).map(corners).collect();
    // The reference forgets to sort the last stretch.
    stretches.iter_mut().rev().skip(1).for_each(|stretch| stretch.sort_unstable());
    stretches
}

/// Sorts edges as the reference does, as far as the last ones are concerned.
///
/// The reference's quicksort: its pivots are drawn from a seed that both halves inherit.
fn sort_last(edges: &mut [HalfEdge], last: u32, names: &mut impl Names) {
    let mut pending = vec![(0, edges.len(), SEED)];
    while let Some((start, end, seed)) = pending.pop() {
        let range = &mut edges[start..end];
        match range {
            [] | [_] => {}
            [a, b] => {
                if lower(a, names) > lower(b, names) {
                    range.swap(0, 1);
                }
            }
            _ => {
                let seed = seed.wrapping_add(seed.rotate_left(seed & 31)).wrapping_add(3);
                let pivot = lower(&range[seed as usize % range.len()], names);
                tell_from(pivot, range, names);
                let (left_end, right_start) = exchange_around(range, pivot, names);
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
fn lower(edge: &HalfEdge, names: &mut impl Names) -> u32 {
    names.find(&edge.ends);
    bound(edge, 0, names)
}

/// The bound, 0 or 1, of the name of an edge's lower vertex.
fn bound(edge: &HalfEdge, which: usize, names: &impl Names) -> u32 {
    let [a, b] = edge.ends.map(|vertex| names.bounds(vertex)[which]);
    a.min(b)
}

/// Finds the names of those vertices of which it is not known whether they are below or above `pivot`.
fn tell_from(pivot: u32, edges: &[HalfEdge], names: &mut impl Names) {
    let is_unclear = |&vertex: &u32| {
        let [low, high] = names.bounds(vertex);
        low < high && low <= pivot && pivot <= high
    };
    let unclear: Vec<u32> = edges.iter().flat_map(|edge| edge.ends).filter(is_unclear).collect();
    names.find(&unclear);
}

/// Exchanges from both ends until no edge above `pivot` is left of one below; returns the ends of the two halves.
fn exchange_around(edges: &mut [HalfEdge], pivot: u32, names: &impl Names) -> (usize, usize) {
    let (mut left, mut right) = (0, edges.len());
    loop {
        while bound(&edges[left], 1, names) < pivot {
            left += 1;
        }
        while bound(&edges[right - 1], 0, names) > pivot {
            right -= 1;
        }
        if left < right {
            edges.swap(left, right - 1);
            left += 1;
            right -= 1;
        }
        if left >= right {
            return (right, left);
        }
    }
}
