//! Builds the hierarchy from the top: every set of triangles is split where the surface area heuristic says so.
//!
//! ```text
//! node(triangles):   split the largest part in two until there are four; every part is a child
//! split(triangles):  16 bins along the longest axis of the centres; at most 16 triangles: sorted, in steps of whole leaves
//! cost of a split:   area of the left box * leaves on the left + the same of the right
//! ```
//!
//! The upper part of the tree is built on the calling thread. The parts below are jobs for all threads; their number depends on the triangles
//! alone, and their lists are joined in order.

use darboux::internal::jobs;
use darboux::{Context, Error};

use super::leaf::{Leaf, SIZE};
use super::node::{Child, Node};

/// The most levels of nodes.
pub const MAX_DEPTH: usize = 64;

/// From this level on sets are halved, so that no arrangement of triangles needs more than [`MAX_DEPTH`] levels.
const HALVING_DEPTH: usize = 32;

/// Bins per split.
const BINS: usize = 16;

/// The most triangles that are sorted instead of binned.
const SORTED: usize = 16;

/// Jobs per tree, about.
const JOBS: usize = 64;

/// The fewest triangles of a job.
const MIN_JOB: usize = if cfg!(small_limits) { 8 } else { 4096 };

/// The bounding box of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    least: [f32; 3],
    greatest: [f32; 3],
    id: u32,
}

impl Bounded {
    /// `None` if a corner is not finite.
    pub fn new(id: u32, [a, b, c]: [[f32; 3]; 3]) -> Option<Self> {
        let least = [0, 1, 2].map(|i| a[i].min(b[i]).min(c[i]));
        let greatest = [0, 1, 2].map(|i| a[i].max(b[i]).max(c[i]));
        let is_finite = [a, b, c].as_flattened().iter().all(|x| x.is_finite());
        is_finite.then_some(Self { least, greatest, id })
    }

    /// Twice the centre of the box.
    fn center(&self, axis: usize) -> f32 {
        self.least[axis] + self.greatest[axis]
    }
}

/// A bounding box.
#[derive(Clone, Copy, Debug)]
struct Box3 {
    least: [f32; 3],
    greatest: [f32; 3],
}

impl Box3 {
    const EMPTY: Self = Self { least: [f32::INFINITY; 3], greatest: [f32::NEG_INFINITY; 3] };

    fn of(triangles: &[Bounded]) -> Self {
        triangles.iter().fold(Self::EMPTY, |all, one| all.with(one.least, one.greatest))
    }

    fn with(self, least: [f32; 3], greatest: [f32; 3]) -> Self {
        Self {
            least: [0, 1, 2].map(|i| self.least[i].min(least[i])),
            greatest: [0, 1, 2].map(|i| self.greatest[i].max(greatest[i])),
        }
    }

    fn union(self, other: Self) -> Self {
        self.with(other.least, other.greatest)
    }

    /// Half of the surface area; 0 for an empty box.
    fn half_area(self) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|i| (self.greatest[i] - self.least[i]).max(0.0));
        x * y + y * z + z * x
    }
}

/// The lists of a tree or a part of it.
#[derive(Default)]
struct Tree {
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
}

/// A part of the tree that is built on any thread.
struct Job<'a> {
    triangles: &'a mut [Bounded],
    depth: usize,
    /// The node and the place in it of which the part is the child.
    parent: (usize, usize),
    bounds: Box3,
    tree: Tree,
}

/// Builds the tree. Errors: the context's token was cancelled.
pub fn build(
    mut triangles: Vec<Bounded>,
    corners: &(impl Fn(u32) -> [[f32; 3]; 3] + Sync),
    context: &Context,
) -> Result<(Vec<Node>, Vec<Leaf>), Error> {
    if triangles.is_empty() {
        return Ok((Vec::new(), Vec::new()));
    }
    let job_size = (triangles.len() / JOBS).max(MIN_JOB);
    let mut tree = Tree::default();
    let mut list = Vec::new();
    build_upper(&mut triangles, 0, job_size, corners, &mut tree, &mut list);
    jobs::for_each(context, &mut list, |job| {
        let Job { triangles, depth, tree, .. } = job;
        build_node(triangles, *depth, corners, tree);
    })?;
    let parts: Vec<_> = list.into_iter().map(|job| (job.parent, job.bounds, job.tree)).collect();
    drop(triangles);
    tree.nodes.reserve_exact(parts.iter().map(|(_, _, part)| part.nodes.len()).sum());
    tree.leaves.reserve_exact(parts.iter().map(|(_, _, part)| part.leaves.len()).sum());
    for ((node, place), bounds, part) in parts {
        let root = tree.append(part);
        tree.nodes[node].set(place, [bounds.least, bounds.greatest], root);
    }
    Ok((tree.nodes, tree.leaves))
}

impl Tree {
    /// Appends the lists of a part; returns its root.
    fn append(&mut self, part: Tree) -> Child {
        let (nodes, leaves) = (self.nodes.len() as u32, self.leaves.len() as u32);
        self.leaves.extend(part.leaves);
        self.nodes.extend(part.nodes.into_iter().map(|mut node| {
            node.shift(nodes, leaves);
            node
        }));
        Child::Node(nodes)
    }

    fn push_leaf(&mut self, triangles: &[Bounded], corners: &impl Fn(u32) -> [[f32; 3]; 3]) -> Child {
        let mut leaf = Leaf::EMPTY;
        for (place, triangle) in triangles.iter().enumerate() {
            leaf.set(place, triangle.id, corners(triangle.id));
        }
        self.leaves.push(leaf);
        Child::Leaf(self.leaves.len() as u32 - 1)
    }
}

/// Builds the nodes whose children have more than `job_size` triangles; the others become jobs.
fn build_upper<'a>(
    triangles: &'a mut [Bounded],
    depth: usize,
    job_size: usize,
    corners: &impl Fn(u32) -> [[f32; 3]; 3],
    tree: &mut Tree,
    jobs: &mut Vec<Job<'a>>,
) {
    let node = tree.nodes.len();
    tree.nodes.push(Node::EMPTY);
    for (place, (part, bounds)) in parts(triangles, depth).into_iter().enumerate() {
        if part.len() <= SIZE {
            let leaf = tree.push_leaf(part, corners);
            tree.nodes[node].set(place, [bounds.least, bounds.greatest], leaf);
        } else if part.len() <= job_size {
            let tree = Tree::default();
            jobs.push(Job { triangles: part, depth: depth + 1, parent: (node, place), bounds, tree });
        } else {
            let child = Child::Node(tree.nodes.len() as u32);
            tree.nodes[node].set(place, [bounds.least, bounds.greatest], child);
            build_upper(part, depth + 1, job_size, corners, tree, jobs);
        }
    }
}

/// Builds a node and all below it.
fn build_node(
    triangles: &mut [Bounded],
    depth: usize,
    corners: &impl Fn(u32) -> [[f32; 3]; 3],
    tree: &mut Tree,
) -> Child {
    let node = tree.nodes.len();
    tree.nodes.push(Node::EMPTY);
    for (place, (part, bounds)) in parts(triangles, depth).into_iter().enumerate() {
        let child = match part.len() {
            0..=SIZE => tree.push_leaf(part, corners),
            _ => build_node(part, depth + 1, corners, tree),
        };
        tree.nodes[node].set(place, [bounds.least, bounds.greatest], child);
    }
    Child::Node(node as u32)
}

/// Splits triangles into one to four parts: always the part with the largest box, or from [`HALVING_DEPTH`] on that with the most triangles.
fn parts(triangles: &mut [Bounded], depth: usize) -> Vec<(&mut [Bounded], Box3)> {
    let is_halved = depth >= HALVING_DEPTH;
    let bounds = Box3::of(triangles);
    let mut parts = vec![(triangles, bounds)];
    while parts.len() < 4 {
        let size = |(part, bounds): &(&mut [Bounded], Box3)| match part.len() {
            0..=SIZE => -1.0,
            len if is_halved => len as f32,
            _ => bounds.half_area(),
        };
        let sizes: Vec<f32> = parts.iter().map(size).collect();
        let largest = (0..parts.len()).fold(0, |best, i| if sizes[i] > sizes[best] { i } else { best });
        if sizes[largest] < 0.0 {
            break;
        }
        let (part, bounds) = parts.remove(largest);
        let (left, right) = split(part, bounds, is_halved);
        let bounds = [Box3::of(left), Box3::of(right)];
        parts.insert(largest, (right, bounds[1]));
        parts.insert(largest, (left, bounds[0]));
    }
    parts
}

/// Splits more than [`SIZE`] triangles in two.
fn split(triangles: &mut [Bounded], bounds: Box3, is_halved: bool) -> (&mut [Bounded], &mut [Bounded]) {
    let middle = match triangles.len() {
        _ if is_halved => halve(triangles, bounds),
        0..=SORTED => sort_and_sweep(triangles),
        _ => partition_by_bins(triangles).unwrap_or_else(|| halve(triangles, bounds)),
    };
    triangles.split_at_mut(middle)
}

/// Moves the half with the smaller centres along the longest axis to the front.
fn halve(triangles: &mut [Bounded], bounds: Box3) -> usize {
    let extent = [0, 1, 2].map(|i| bounds.greatest[i] - bounds.least[i]);
    let axis = longest(extent);
    let middle = (triangles.len() / 2).next_multiple_of(SIZE);
    triangles.select_nth_unstable_by(middle, |a, b| order(a, b, axis));
    middle
}

/// By centres, then by numbers: a total order.
fn order(a: &Bounded, b: &Bounded, axis: usize) -> std::cmp::Ordering {
    a.center(axis).total_cmp(&b.center(axis)).then(a.id.cmp(&b.id))
}

fn longest(extent: [f32; 3]) -> usize {
    (0..3).fold(0, |best, i| if extent[i] > extent[best] { i } else { best })
}

/// Leaves that so many triangles fill.
fn leaf_count(triangles: usize) -> f32 {
    triangles.div_ceil(SIZE) as f32
}

/// Sorts along the best axis; returns the multiple of [`SIZE`] at which the split costs least.
fn sort_and_sweep(triangles: &mut [Bounded]) -> usize {
    let (mut best, mut lowest) = ((0, SIZE), f32::INFINITY);
    for axis in 0..3 {
        triangles.sort_unstable_by(|a, b| order(a, b, axis));
        for middle in (SIZE..triangles.len()).step_by(SIZE) {
            let (left, right) = triangles.split_at(middle);
            let cost = Box3::of(left).half_area() * leaf_count(left.len())
                + Box3::of(right).half_area() * leaf_count(right.len());
            if cost < lowest {
                (best, lowest) = ((axis, middle), cost);
            }
        }
    }
    let (axis, middle) = best;
    triangles.sort_unstable_by(|a, b| order(a, b, axis));
    middle
}

/// Moves the triangles of the lower bins to the front; returns their number. `None` where all centres are equal.
fn partition_by_bins(triangles: &mut [Bounded]) -> Option<usize> {
    let centers = triangles.iter().fold(Box3::EMPTY, |all, one| {
        let center = [0, 1, 2].map(|axis| one.center(axis));
        all.with(center, center)
    });
    let extent = [0, 1, 2].map(|i| centers.greatest[i] - centers.least[i]);
    let axis = longest(extent);
    let scale = BINS as f32 / extent[axis];
    if !(extent[axis] > 0.0 && extent[axis].is_finite() && scale.is_finite()) {
        return None;
    }
    let bin_of =
        |triangle: &Bounded| (((triangle.center(axis) - centers.least[axis]) * scale) as usize).min(BINS - 1);
    let mut bins = [(Box3::EMPTY, 0usize); BINS];
    for triangle in &*triangles {
        let (bounds, count) = &mut bins[bin_of(triangle)];
        *bounds = bounds.with(triangle.least, triangle.greatest);
        *count += 1;
    }
    let last = cheapest_bin(&bins);
    Some(partition(triangles, |triangle| bin_of(triangle) <= last))
}

/// The last bin of the left side of the cheapest split. Both sides have triangles: the first and the last bin are never empty.
fn cheapest_bin(bins: &[(Box3, usize); BINS]) -> usize {
    let mut right_costs = [0f32; BINS];
    let (mut bounds, mut count) = (Box3::EMPTY, 0);
    for i in (1..BINS).rev() {
        bounds = bounds.union(bins[i].0);
        count += bins[i].1;
        right_costs[i] = bounds.half_area() * leaf_count(count);
    }
    let (mut best, mut lowest) = (0, f32::INFINITY);
    let (mut bounds, mut count) = (Box3::EMPTY, 0);
    for i in 0..BINS - 1 {
        bounds = bounds.union(bins[i].0);
        count += bins[i].1;
        let cost = bounds.half_area() * leaf_count(count) + right_costs[i + 1];
        if cost < lowest {
            (best, lowest) = (i, cost);
        }
    }
    best
}

/// Moves the triangles for which `is_left` holds to the front; returns their number.
fn partition(triangles: &mut [Bounded], is_left: impl Fn(&Bounded) -> bool) -> usize {
    let mut middle = 0;
    for i in 0..triangles.len() {
        if is_left(&triangles[i]) {
            triangles.swap(middle, i);
            middle += 1;
        }
    }
    middle
}
