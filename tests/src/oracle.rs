//! The oracle: every method in f64 by brute force, each stage the loop that its definition describes.
//!
//! The fast versions are compared with it within a tolerance, not bit for bit. Where the f32 code takes a
//! decision near a limit (the diagonal of a quad, a threshold, an area of zero), the oracle may decide
//! otherwise. It takes quadratic time; a few thousand corners are fine. Source: M. S. Mikkelsen, "Simulation
//! of Wrinkled Surfaces Revisited", 2008, and mikktspace.c. Two deviations: vertices weld to their first
//! corner, and every edge finds its neighbour (the C code misses some at the largest vertex number).

mod angle_area;
mod methods;
mod mikktspace;
mod normals;
mod triangles;
mod vectors;

pub use angle_area::{angle_area, angle_edge};
pub use methods::{area, average, face, from_normal, lengyel, lengyel_per_vertex};
pub use mikktspace::mikktspace;
pub use normals::normals;
