//! MikkTSpace on the GPU, with the bits of the core.
//!
//! ```text
//! passes      the list of kernels with their buffers, as data
//! program     compiles that list and binds its buffers
//! tiles       uploads a mesh: all vertices, and the triangles in tiles that fit the device
//! generate    the entry: runs the tiles, then the CPU completes the vertices that the GPU deferred
//! adjacency   the triangles at each vertex, which the method `Average` uses too
//! stages      single stages, for tests
//! ```

pub mod adjacency;
pub mod generate;
pub mod passes;
pub mod program;
pub mod stages;
pub mod tiles;
