//! The hierarchy itself.

use darboux::{Context, Error};

use super::build::{self, Bounded};
use super::leaf::Leaf;
use super::node::Node;

/// The most bytes that a tree takes per triangle while it is built, as the memory check assumes.
pub const BYTES_PER_TRIANGLE: u64 = 100;

/// A hierarchy over triangles, which it copies.
pub struct Bvh {
    /// The root is the first node; empty for no triangles.
    pub(super) nodes: Vec<Node>,
    pub(super) leaves: Vec<Leaf>,
    /// The least and the greatest coordinates of all triangles.
    pub(super) bounds: [[f32; 3]; 2],
}

impl Bvh {
    /// Builds the hierarchy over `count` triangles. The result does not depend on the number of threads.
    ///
    /// `triangle`: the corners of a triangle, counter-clockwise as seen from its front. Triangles with corners that are not finite are left
    /// out. Errors: the context's token was cancelled.
    pub fn build(
        count: u32,
        triangle: &(impl Fn(u32) -> [[f32; 3]; 3] + Sync),
        context: &Context,
    ) -> Result<Self, Error> {
        let bounded: Vec<Bounded> = (0..count).filter_map(|id| Bounded::new(id, triangle(id))).collect();
        let (nodes, leaves) = build::build(bounded, triangle, context)?;
        let bounds = nodes.first().map(Node::bounds).unwrap_or_default();
        Ok(Self { nodes, leaves, bounds })
    }

    /// The number of triangles with finite corners.
    pub fn triangle_count(&self) -> usize {
        self.leaves.iter().map(Leaf::triangle_count).sum()
    }
}
