//! What calls take and give beyond a mesh and its tangents.

use darboux::VertexSplit;

use crate::frames::Frames;
use crate::plan::Kept;
use crate::room::{sized, with};

#[derive(Default)]
pub struct Values {
    /// 4 per tangent.
    pub given: Vec<f32>,
    /// The tangents that those are compared with.
    pub others: Vec<f32>,
    /// Encoded tangents.
    pub codes: Vec<u8>,
    /// Results that are floats, 4 or 3 per corner.
    pub floats: Vec<f32>,
    /// Of each vertex the first that equals it.
    pub welded: Vec<u32>,
    pub split: VertexSplit,
    pub frames: Frames,
    /// Plans, and places where others may go.
    pub plans: Vec<Option<Kept>>,
    pub measures: Vec<f64>,
    /// The lists of a mesh that is planned for shaders.
    pub topology: Vec<Vec<u32>>,
}

#[unsafe(no_mangle)]
pub extern "C" fn given(tangents: usize) -> *mut f32 {
    with(|room| sized(&mut room.values.given, 4 * tangents))
}

#[unsafe(no_mangle)]
pub extern "C" fn others(tangents: usize) -> *mut f32 {
    with(|room| sized(&mut room.values.others, 4 * tangents))
}

#[unsafe(no_mangle)]
pub extern "C" fn codes(bytes: usize) -> *mut u8 {
    with(|room| sized(&mut room.values.codes, bytes))
}
