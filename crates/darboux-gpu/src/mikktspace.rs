//! MikkTSpace on the GPU.

pub mod adjacency;
pub mod generate;
pub mod passes;
pub mod program;
pub mod stages;
pub mod tiles;
