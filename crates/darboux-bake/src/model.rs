//! The surfaces of glTF documents, in the space of the scene.

mod high;
mod low;
mod maps;
mod placed;
mod stored;

pub use high::{HighModel, HighModelOptions};
pub use low::{LowModel, LowModelOptions};
