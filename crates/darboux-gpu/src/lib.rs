//! Tangent frames on the GPU, with wgpu.
//!
//! - [`Average`] writes frames into the caller's vertex buffers, recorded into the caller's command encoder,
//!   without reading back: means of unit tangents, or Lengyel's sums of tangents.
//! - [`Planner`] prepares a mesh once; its [`Plan`] then computes MikkTSpace tangents every frame for
//!   vertices that move on the GPU.
//! - [`MikkTSpace`] computes the tangents of a mesh in CPU memory, with the bits of
//!   `darboux::generate_tangents`.
//! - [`Splitter`] turns tangents per corner into an indexed mesh with tangents per vertex.
//!
//! ```no_run
//! use darboux_gpu::{Average, Destination, FrameLayout, Gpu, GpuError, MeshBuffers, Search, VertexLayout};
//!
//! # async fn tangents(vertices: &wgpu::Buffer, indices: &wgpu::Buffer) -> Result<(), GpuError> {
//! // Or use the device and queue of your own program.
//! let Gpu { device, queue, .. } = Gpu::open().await?;
//! // A vertex of 14 floats: position, UV, normal, tangent, bitangent.
//! let mesh = MeshBuffers {
//!     vertices,
//!     layout: VertexLayout { stride: 56, position: 0, uv: 12, normal: 20 },
//!     vertex_count: 5_000,
//!     indices,
//!     index_format: wgpu::IndexFormat::Uint16,
//!     first_index: 0,
//!     index_count: 30_000,
//! };
//! let frames = Destination::Vertices(FrameLayout { tangent: 32, bitangent: Some(44), sign: None });
//! let average = Average::new(&device, Search::Adjacency).of_mesh(&mesh, &frames)?;
//!
//! let mut encoder = device.create_command_encoder(&Default::default());
//! average.record(&mut encoder);
//! queue.submit([encoder.finish()]);
//! # Ok(())
//! # }
//! ```

mod average;
mod device;
mod error;
mod mikktspace;
mod plan;
#[cfg(test)]
mod shader_tests;
mod split;

pub use average::{Average, AverageOfMesh, Search};
pub use device::adapters::{AdapterKind, AdapterSummary, Gpu};
pub use device::mesh_buffers::{Destination, FrameLayout, MeshBuffers, VertexLayout};
pub use device::precision::Precision;
pub use error::GpuError;
pub use mikktspace::generate::{CpuFallback, GpuTangents, MikkTSpace};
pub use plan::bound_plan::BoundPlan;
pub use plan::check::PlanCheck;
pub use plan::moving_mesh::{Attribute, MovingMesh, TangentsPer};
pub use plan::normals::PlanNormals;
pub use plan::planner::{Plan, Planner};
pub use split::Splitter;

/// Single stages, for tests. Not part of the API.
#[doc(hidden)]
pub mod internal {
    pub use crate::device::precision::Arithmetic;
    pub use crate::mikktspace::generate::{StageArrays, StageRecording};
    pub use crate::mikktspace::stages::{Evaluation, EvaluationKernels, GroupedMesh};
}

/// The example of docs/gpu.md compiles.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/gpu.md")]
struct GpuPage;

/// The example of README.md compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
