//! Nearest hits of rays on triangles: a bounding volume hierarchy with four children per node and up to four
//! triangles per leaf.
//!
//! Boxes and triangles are stored component by component, so that the compiler tests four at once with vector
//! instructions. Rays that pass exactly through an edge or a vertex hit one of its triangles: texels often
//! lie exactly on edges of the high mesh, and a miss there would be a hole in the map.
//!
//! I. Wald, C. Benthin, S. Boulos, "Getting Rid of Packets", RT 2008 (wide trees); I. Wald, "On fast
//! Construction of SAH-based Bounding Volume Hierarchies", RT 2007 (bins); S. Woop, C. Benthin, I. Wald,
//! "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.

mod build;
mod compare;
mod leaf;
mod node;
mod ray;
mod shaft;
mod traverse;
mod tree;

pub use ray::{Hit, PreparedRay, Ray, Sides};
pub use shaft::Shaft;
pub use traverse::Stack;
pub use tree::{BYTES_PER_TRIANGLE, Bvh};

#[cfg(test)]
mod tests;
