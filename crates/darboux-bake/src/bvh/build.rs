//! Builds the hierarchy from the top: every set of triangles is split where the surface area heuristic says
//! so.
//!
//! ```text
//! node(triangles):   split the largest part in two until there are four; every part is a child
//! split(triangles):  16 bins along the longest axis of the centres; at most 16 triangles: sorted, in steps of whole leaves
//! cost of a split:   area of the left box * leaves on the left + the same of the right
//! ```
//!
//! The sets of each of the upper levels are split by all threads. The parts below are jobs for all threads;
//! their number depends on the triangles alone, and their lists are joined in order.

use darboux::internal::jobs;
use darboux::{Context, Error};

use super::leaf::{Leaf, SIZE};
use super::node::{Child, Node};

/// The most levels of nodes.
pub const MAX_DEPTH: usize = 64;

/// From this level on sets are halved, so that no arrangement of triangles needs more than [`MAX_DEPTH`]
/// levels.
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
    bounds: Box3,
    id: u32,
}

impl Bounded {
    pub const EMPTY: Self = Self { bounds: Box3::EMPTY, id: 0 };

    pub fn is_empty(&self) -> bool {
        self.bounds.least[0] == f32::INFINITY
    }

    /// [`Bounded::EMPTY`] if a corner is not finite.
    pub fn new(id: u32, corners: [[f32; 3]; 3]) -> Self {
        let bounds = corners.into_iter().fold(Box3::EMPTY, |all, [x, y, z]| all.with([x, y, z, 0.0]));
        let is_finite = corners.as_flattened().iter().all(|x| x.is_finite());
        if is_finite { Self { bounds, id } } else { Self::EMPTY }
    }

    /// Twice the centre of the box.
    fn center(&self) -> [f32; 4] {
        std::array::from_fn(|i| self.bounds.least[i] + self.bounds.greatest[i])
    }
}

/// A bounding box. The fourth component, which is 0, fills a vector register.
#[derive(Clone, Copy, Debug)]
struct Box3 {
    least: [f32; 4],
    greatest: [f32; 4],
}

impl Box3 {
    const EMPTY: Self = Self { least: [f32::INFINITY; 4], greatest: [f32::NEG_INFINITY; 4] };

    fn of(triangles: &[Bounded]) -> Self {
        triangles.iter().fold(Self::EMPTY, |all, one| all.union(one.bounds))
    }

    /// The box around this one and a point. Comparisons instead of `f32::min`: without its rule for NaN they
    /// are one instruction.
    #[inline(always)]
    fn with(self, point: [f32; 4]) -> Self {
        self.union(Self { least: point, greatest: point })
    }

    #[inline(always)]
    fn union(self, other: Self) -> Self {
        let lesser = |i: usize| if other.least[i] < self.least[i] { other.least[i] } else { self.least[i] };
        let greater = |i: usize| {
            if other.greatest[i] > self.greatest[i] { other.greatest[i] } else { self.greatest[i] }
        };
        Self { least: std::array::from_fn(lesser), greatest: std::array::from_fn(greater) }
    }

    fn extent(self) -> [f32; 3] {
        [0, 1, 2].map(|i| self.greatest[i] - self.least[i])
    }

    /// Half of the surface area; 0 for an empty box.
    fn half_area(self) -> f32 {
        let [x, y, z] = self.extent().map(|side| side.max(0.0));
        x * y + y * z + z * x
    }

    /// The least and the greatest coordinates.
    fn ends(self) -> [[f32; 3]; 2] {
        [self.least, self.greatest].map(|[x, y, z, _]| [x, y, z])
    }
}

/// The lists of a tree or a part of it.
#[derive(Default)]
struct Tree {
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
}

/// A set of triangles that is split, or built, on any thread.
struct Job<'a> {
    triangles: &'a mut [Bounded],
    bounds: Box3,
    depth: usize,
    /// The node, and the place in it, whose child the set is; the root has none.
    parent: Option<(usize, usize)>,
    /// The parts of a set that was split.
    parts: Vec<(&'a mut [Bounded], Box3)>,
    /// The part of the tree of a set that was built.
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
    let mut tree = Tree::default();
    let mut list = upper_levels(&mut triangles, corners, &mut tree, context)?;
    jobs::for_each(context, &mut list, |job| {
        build_node(job.triangles, job.bounds, job.depth, corners, &mut job.tree);
    })?;
    let parts: Vec<_> = list.into_iter().map(|job| (job.parent, job.bounds, job.tree)).collect();
    drop(triangles);
    tree.nodes.reserve_exact(parts.iter().map(|(_, _, part)| part.nodes.len()).sum());
    tree.leaves.reserve_exact(parts.iter().map(|(_, _, part)| part.leaves.len()).sum());
    for (parent, bounds, part) in parts {
        let root = tree.append(part);
        tree.link(parent, bounds, root);
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

    /// Enters a child into its parent, if it has one.
    fn link(&mut self, parent: Option<(usize, usize)>, bounds: Box3, child: Child) {
        if let Some((node, place)) = parent {
            self.nodes[node].set(place, bounds.ends(), child);
        }
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

/// Builds the nodes of sets that are too large for one job, level by level; returns the other sets.
fn upper_levels<'a>(
    triangles: &'a mut [Bounded],
    corners: &impl Fn(u32) -> [[f32; 3]; 3],
    tree: &mut Tree,
    context: &Context,
) -> Result<Vec<Job<'a>>, Error> {
    let job_size = (triangles.len() / JOBS).max(MIN_JOB);
    let bounds = Box3::of(triangles);
    let (mut level, mut small) = (vec![Job::new(triangles, bounds, 0, None)], Vec::new());
    loop {
        small.extend(level.extract_if(.., |job| job.triangles.len() <= job_size));
        if level.is_empty() {
            return Ok(small);
        }
        jobs::for_each(context, &mut level, |job| {
            job.parts = parts(std::mem::take(&mut job.triangles), job.bounds, job.depth);
        })?;
        let mut next = Vec::new();
        for job in level {
            let node = tree.nodes.len();
            tree.nodes.push(Node::EMPTY);
            tree.link(job.parent, job.bounds, Child::Node(node as u32));
            for (place, (part, bounds)) in job.parts.into_iter().enumerate() {
                if part.len() <= SIZE {
                    let leaf = tree.push_leaf(part, corners);
                    tree.link(Some((node, place)), bounds, leaf);
                } else {
                    next.push(Job::new(part, bounds, job.depth + 1, Some((node, place))));
                }
            }
        }
        level = next;
    }
}

impl<'a> Job<'a> {
    fn new(triangles: &'a mut [Bounded], bounds: Box3, depth: usize, parent: Option<(usize, usize)>) -> Self {
        Self { triangles, bounds, depth, parent, parts: Vec::new(), tree: Tree::default() }
    }
}

/// Builds a node and all below it.
fn build_node(
    triangles: &mut [Bounded],
    bounds: Box3,
    depth: usize,
    corners: &impl Fn(u32) -> [[f32; 3]; 3],
    tree: &mut Tree,
) -> Child {
    let node = tree.nodes.len();
    tree.nodes.push(Node::EMPTY);
    for (place, (part, bounds)) in parts(triangles, bounds, depth).into_iter().enumerate() {
        let child = match part.len() {
            0..=SIZE => tree.push_leaf(part, corners),
            _ => build_node(part, bounds, depth + 1, corners, tree),
        };
        tree.link(Some((node, place)), bounds, child);
    }
    Child::Node(node as u32)
}

/// Splits triangles into one to four parts: always the part with the largest box, or from [`HALVING_DEPTH`]
/// on that with the most triangles.
fn parts(triangles: &mut [Bounded], bounds: Box3, depth: usize) -> Vec<(&mut [Bounded], Box3)> {
    let is_halved = depth >= HALVING_DEPTH;
    let mut parts = Vec::with_capacity(4);
    parts.push((triangles, bounds));
    while parts.len() < 4 {
        let size = |(part, bounds): &(&mut [Bounded], Box3)| match part.len() {
            0..=SIZE => -1.0,
            len if is_halved => len as f32,
            _ => bounds.half_area(),
        };
        let mut largest = (0, size(&parts[0]));
        for (at, part) in parts.iter().enumerate().skip(1) {
            let size = size(part);
            largest = if size > largest.1 { (at, size) } else { largest };
        }
        if largest.1 < 0.0 {
            break;
        }
        let (part, bounds) = parts.remove(largest.0);
        let [left, right] = split(part, bounds, is_halved);
        parts.insert(largest.0, right);
        parts.insert(largest.0, left);
    }
    parts
}

/// Splits more than [`SIZE`] triangles in two, each with its box.
fn split(triangles: &mut [Bounded], bounds: Box3, is_halved: bool) -> [(&mut [Bounded], Box3); 2] {
    if !is_halved
        && triangles.len() > SORTED
        && let Some((middle, boxes)) = partition_by_bins(triangles)
    {
        let (left, right) = triangles.split_at_mut(middle);
        return [(left, boxes[0]), (right, boxes[1])];
    }
    let middle = match triangles.len() {
        ..=SORTED if !is_halved => sort_and_sweep(triangles),
        _ => halve(triangles, bounds),
    };
    let (left, right) = triangles.split_at_mut(middle);
    let boxes = [Box3::of(left), Box3::of(right)];
    [(left, boxes[0]), (right, boxes[1])]
}

/// Moves the half with the smaller centres along the longest axis to the front.
fn halve(triangles: &mut [Bounded], bounds: Box3) -> usize {
    let axis = longest(bounds.extent());
    let middle = (triangles.len() / 2).next_multiple_of(SIZE);
    let key = |triangle: &Bounded| (triangle.center()[axis], triangle.id);
    triangles.select_nth_unstable_by(middle, |a, b| order(key(a), key(b)));
    middle
}

/// By centres, then by numbers: a total order.
fn order(a: (f32, u32), b: (f32, u32)) -> std::cmp::Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}

fn longest(extent: [f32; 3]) -> usize {
    (0..3).fold(0, |best, i| if extent[i] > extent[best] { i } else { best })
}

/// Leaves that so many triangles fill.
fn leaf_count(triangles: usize) -> f32 {
    triangles.div_ceil(SIZE) as f32
}

/// Sorts at most [`SORTED`] triangles along the best axis; returns the multiple of [`SIZE`] at which the
/// split costs least.
fn sort_and_sweep(triangles: &mut [Bounded]) -> usize {
    let count = triangles.len();
    let mut given = [triangles[0]; SORTED];
    given[..count].copy_from_slice(triangles);
    let (mut best, mut middle, mut lowest) = ([(0.0, 0, 0); SORTED], SIZE, f32::INFINITY);
    for axis in 0..3 {
        let mut sorted = [(0f32, 0, 0); SORTED];
        for (at, triangle) in given[..count].iter().enumerate() {
            sorted[at] = (triangle.center()[axis], triangle.id, at);
        }
        sorted[..count].sort_unstable_by(|a, b| order((a.0, a.1), (b.0, b.1)));
        let box_of = |part: &[(f32, u32, usize)]| {
            part.iter().fold(Box3::EMPTY, |all, (.., at)| all.union(given[*at].bounds))
        };
        for at in (SIZE..count).step_by(SIZE) {
            let cost = box_of(&sorted[..at]).half_area() * leaf_count(at)
                + box_of(&sorted[at..count]).half_area() * leaf_count(count - at);
            // The first one is taken also where costs overflow.
            if cost < lowest || (axis, at) == (0, SIZE) {
                (best, middle, lowest) = (sorted, at, lowest.min(cost));
            }
        }
    }
    for (triangle, (.., at)) in triangles.iter_mut().zip(best) {
        *triangle = given[at];
    }
    middle
}

/// Moves the triangles of the lower bins to the front; returns their number and the boxes of both sides.
/// `None` where all centres are equal.
fn partition_by_bins(triangles: &mut [Bounded]) -> Option<(usize, [Box3; 2])> {
    let centers = triangles.iter().fold(Box3::EMPTY, |all, one| all.with(one.center()));
    let extent = centers.extent();
    let axis = longest(extent);
    let scale = BINS as f32 / extent[axis];
    if !(extent[axis] > 0.0 && extent[axis].is_finite() && scale.is_finite()) {
        return None;
    }
    let least = centers.least[axis];
    let bin_of = |triangle: &Bounded| {
        let center = triangle.bounds.least[axis] + triangle.bounds.greatest[axis];
        (((center - least) * scale) as u32).min(BINS as u32 - 1) as usize
    };
    let mut bins = [(Box3::EMPTY, 0usize); BINS];
    for triangle in &*triangles {
        let (bounds, count) = &mut bins[bin_of(triangle)];
        *bounds = bounds.union(triangle.bounds);
        *count += 1;
    }
    let last = cheapest_bin(&bins);
    let side = |bins: &[(Box3, usize)]| bins.iter().fold(Box3::EMPTY, |all, bin| all.union(bin.0));
    let boxes = [side(&bins[..=last]), side(&bins[last + 1..])];
    Some((partition(triangles, |triangle| bin_of(triangle) <= last), boxes))
}

/// The last bin of the left side of the cheapest split. Both sides have triangles: the first and the last bin
/// are never empty.
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
