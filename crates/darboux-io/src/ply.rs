//! Stanford PLY: ASCII, and binary of both byte orders, with any types of properties.
//!
//! ```text
//! header    the elements and their properties
//! values    numbers one after the other: text, or binary
//! layout    what the properties of a vertex are
//! read      vertices, and everything as a scene
//! faces     faces and strips, with the UVs and textures of their corners
//! textures  the textures that comments name
//! ```

mod faces;
mod header;
mod layout;
mod property;
mod read;
mod textures;
mod values;

pub(crate) use read::read;
