//! The hierarchy itself.

use darboux::internal::jobs;
use darboux::{Context, Error};

use super::build::{self, Bounded};
use super::leaf::Leaf;
use super::node::Node;

/// The most bytes that a tree takes per triangle while it is built, as the memory check assumes.
pub const BYTES_PER_TRIANGLE: u64 = 100;

/// Triangles whose boxes a job computes.
const PART: usize = 1 << 14;

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
    /// `triangle`: the corners of a triangle, counter-clockwise as seen from its front. Triangles with
    /// corners that are not finite are left out. Errors: the context's token was cancelled.
    pub fn build(
        count: u32,
        triangle: &(impl Fn(u32) -> [[f32; 3]; 3] + Sync),
        context: &Context,
    ) -> Result<Self, Error> {
        let mut bounded = vec![Bounded::EMPTY; count as usize];
        let mut parts: Vec<_> = bounded.chunks_mut(PART).enumerate().collect();
        jobs::for_each(context, &mut parts, |(part, bounded)| {
            for (id, bounded) in (*part * PART..).zip(bounded.iter_mut()) {
                *bounded = Bounded::new(id as u32, triangle(id as u32));
            }
        })?;
        bounded.retain(|triangle| !triangle.is_empty());
        let (nodes, leaves) = build::build(bounded, triangle, context)?;
        let bounds = nodes.first().map(Node::bounds).unwrap_or_default();
        Ok(Self { nodes, leaves, bounds })
    }

    /// The largest coordinate of all triangles, without its sign.
    pub fn largest_coordinate(&self) -> f64 {
        self.bounds.as_flattened().iter().fold(0.0, |largest, x| f64::from(x.abs()).max(largest))
    }

    /// The number of triangles with finite corners.
    pub fn triangle_count(&self) -> usize {
        self.leaves.iter().map(Leaf::triangle_count).sum()
    }
}
