//! `darboux render`: draws a model or its tangents into a PNG.

pub mod arguments;
mod draw;
mod legend;

pub use draw::{no_adapter, run};
