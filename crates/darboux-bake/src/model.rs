//! The surfaces of glTF documents, in the space of the scene.

mod cage;
mod content;
mod decoded_bytes;
mod high;
mod image_key;
mod instance;
mod low;
mod maps;
mod misfit;
mod models;
mod parts;
mod stored;
mod stored_material;

pub use cage::cage_of;
pub use content::is_color_texture;
pub use high::{HighModel, HighModelOptions};
pub use low::{LowModel, LowModelOptions};
pub use models::{ModelSurfaces, Models, ModelsError, PartMatch};
pub use parts::{UnpairedParts, group_by_name};
