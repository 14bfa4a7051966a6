//! The surfaces of glTF documents, in the space of the scene.

mod high;
mod low;
mod placed;

pub use high::HighModel;
pub use low::{LowModel, LowModelOptions};
