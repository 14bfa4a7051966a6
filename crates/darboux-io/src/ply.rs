//! Stanford PLY: ASCII, and binary of both byte orders, with any types of properties.
//!
//! ```text
//! header    the elements and their properties
//! values    numbers one after the other: text, or binary
//! read      vertices and faces as a scene
//! ```

mod header;
mod read;
mod values;

pub(crate) use read::read;
