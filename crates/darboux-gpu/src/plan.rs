//! Tangents every frame for meshes that move on the GPU: the topology is analysed once on the CPU, each frame
//! evaluates it on the GPU.
//!
//! ```text
//! planner        once per mesh: groups the corners on the CPU and uploads what does not depend on positions
//! moving_mesh    where the moving vertices and their tangents lie in the caller's buffers
//! bound_plan     every frame: terms of triangles -> sums of groups -> replacement of unusable tangents -> tangents of vertices
//! normals        every frame, optional: smooth normals of the moved vertices
//! check          on demand: counts what has changed so much that the mesh should be planned again
//! ```

pub mod bound_plan;
pub mod check;
pub mod moving_mesh;
mod normal_groups;
pub mod normals;
pub mod planner;
pub mod shaders;
