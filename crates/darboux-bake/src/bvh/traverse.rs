//! Traversal: nearest hits, and whether there is any.

use super::build::MAX_DEPTH;
use super::node::{Child, Node};
use super::ray::{Hit, PreparedRay, Ray, Sides};
use super::shaft::{Cut, MOST};
use super::tree::Bvh;

/// A node leaves at most three children on the stack besides the one that is visited next, and a cut begins
/// with up to [`MOST`].
const STACK: usize = 3 * MAX_DEPTH + MOST;

/// The children that wait, each with the distance of its box. Rays reuse it one after the other.
pub struct Stack {
    entries: [(f32, Child); STACK],
    len: usize,
}

impl Stack {
    pub const fn new() -> Self {
        Self { entries: [(0.0, Child::Node(0)); STACK], len: 0 }
    }

    fn push(&mut self, entry: (f32, Child)) {
        self.entries[self.len] = entry;
        self.len += 1;
    }

    fn pop(&mut self) -> Option<(f32, Child)> {
        self.len = self.len.checked_sub(1)?;
        Some(self.entries[self.len])
    }
}

impl Bvh {
    /// The nearest hit of a ray. Of hits at the same distance, the one on the triangle with the smallest
    /// number.
    pub fn nearest(&self, ray: &Ray, sides: Sides, stack: &mut Stack) -> Option<Hit> {
        self.nearest_below(self.root(), &self.prepare(ray), sides, stack)
    }

    /// The nearest hit of a ray on the triangles that `accepts` does not refuse, from either side.
    pub fn nearest_where(&self, ray: &Ray, accepts: impl Fn(u32) -> bool, stack: &mut Stack) -> Option<Hit> {
        self.search(self.root(), &self.prepare(ray), Sides::Both, false, accepts, stack)
    }

    /// The nearest hit of a ray whose shaft has this cut: the same as of [`Bvh::nearest`], in fewer steps.
    pub fn nearest_of_cut(
        &self,
        cut: &Cut,
        ray: &PreparedRay,
        sides: Sides,
        stack: &mut Stack,
    ) -> Option<Hit> {
        self.nearest_below(cut.nodes(), ray, sides, stack)
    }

    /// Whether a ray hits any triangle, from either side.
    pub fn is_blocked(&self, ray: &Ray, stack: &mut Stack) -> bool {
        self.is_blocked_where(ray, |_| true, stack)
    }

    /// Whether a ray hits any triangle that `accepts` does not refuse, from either side.
    pub fn is_blocked_where(&self, ray: &Ray, accepts: impl Fn(u32) -> bool, stack: &mut Stack) -> bool {
        self.search(self.root(), &self.prepare(ray), Sides::Both, true, accepts, stack).is_some()
    }

    /// A ray, prepared for this tree.
    pub fn prepare(&self, ray: &Ray) -> PreparedRay {
        PreparedRay::new(ray, &self.bounds)
    }

    fn root(&self) -> &[Node] {
        &self.nodes[..self.nodes.len().min(1)]
    }

    fn nearest_below(
        &self,
        start: &[Node],
        ray: &PreparedRay,
        sides: Sides,
        stack: &mut Stack,
    ) -> Option<Hit> {
        self.search(start, ray, sides, false, |_| true, stack)
    }

    /// `is_any`: returns the first hit that is found.
    #[inline(always)]
    fn search(
        &self,
        start: &[Node],
        ray: &PreparedRay,
        sides: Sides,
        is_any: bool,
        accepts: impl Fn(u32) -> bool,
        stack: &mut Stack,
    ) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        let mut limit = ray.length;
        stack.len = 0;
        // Comparisons with NaN would enter the boxes of absent children.
        if !ray.is_finite() {
            return None;
        }
        for node in start {
            push_children(node, ray, limit, stack);
        }
        while let Some((entry, child)) = stack.pop() {
            if entry > limit {
                continue;
            }
            match child {
                Child::Leaf(index) => {
                    best = self.leaves[index as usize].nearest(ray, sides, &accepts, best);
                    if let Some(hit) = best {
                        limit = hit.distance;
                        if is_any {
                            break;
                        }
                    }
                }
                Child::Node(index) => push_children(&self.nodes[index as usize], ray, limit, stack),
            }
        }
        best
    }
}

/// Pushes the children whose boxes a ray enters, the nearest one last.
#[inline(always)]
fn push_children(node: &Node, ray: &PreparedRay, limit: f32, stack: &mut Stack) {
    let entries = node.entries(ray, limit);
    let first = stack.len;
    for (place, entry) in entries.into_iter().enumerate() {
        if entry < f32::INFINITY {
            stack.push((entry, node.child(place)));
            let mut at = stack.len - 1;
            while at > first && stack.entries[at - 1].0 < entry {
                stack.entries.swap(at - 1, at);
                at -= 1;
            }
        }
    }
}
