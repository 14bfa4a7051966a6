//! The surfaces of glTF documents, in the space of the scene.

mod content;
mod decoded_bytes;
mod high;
mod image_key;
mod instance;
mod low;
mod maps;
mod models;
mod parts;
mod stored;

pub use content::is_color_texture;
pub use high::{HighModel, HighModelOptions};
pub use low::{LowModel, LowModelOptions};
pub use models::{ModelSurfaces, Models, ModelsError, PartMatch};
pub use parts::{UnpairedParts, group_by_name};
