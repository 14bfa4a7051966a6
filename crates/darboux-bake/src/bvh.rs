//! Nearest hits of rays on triangles: a bounding volume hierarchy with four children per node and up to four triangles per leaf.
//!
//! Boxes and triangles are stored component by component, so that the compiler tests four at once with vector instructions. Rays that pass
//! exactly through an edge or a vertex hit one of its triangles: texels often lie exactly on edges of the high mesh, and a miss there would be
//! a hole in the map.
//!
//! I. Wald, C. Benthin, S. Boulos, "Getting Rid of Packets", RT 2008 (wide trees); I. Wald, "On fast Construction of SAH-based Bounding Volume
//! Hierarchies", RT 2007 (bins); S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.

mod build;
mod leaf;
mod node;
mod ray;
mod traverse;

use darboux::{Context, Error};

pub use ray::{Hit, Ray, Sides};
pub use traverse::Stack;

use build::Bounded;
use leaf::Leaf;
use node::Node;

/// The most bytes that a tree takes per triangle while it is built, as the memory check assumes.
pub const BYTES_PER_TRIANGLE: u64 = 100;

/// A hierarchy over triangles, which it copies.
pub struct Bvh {
    /// The root is the first node; empty for no triangles.
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    /// The least and the greatest coordinates of all triangles.
    bounds: [[f32; 3]; 2],
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

#[cfg(test)]
mod tests;
