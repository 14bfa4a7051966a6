//! Memory that tangent generation reuses from call to call.

use crate::Frame;
use crate::tangents::fast::FastPath;
use crate::tangents::methods::buffers::MethodBuffers;

/// The memory of every method and output.
#[derive(Debug, Default)]
pub(crate) struct TangentMemory {
    pub fast: FastPath,
    pub sums: MethodBuffers,
    pub frames: FrameMemory,
}

/// The frames of a run, or the parts that they are made of.
#[derive(Debug, Default)]
pub(crate) struct FrameMemory {
    /// The tangent of each corner, for a run of the fast path.
    pub tangents: Vec<[f32; 4]>,
    /// The frames of the corners that are undecided in `tangents`, ascending by corner.
    pub decided: Vec<(u32, Frame)>,
    /// The frame of each corner, for every other run.
    pub frames: Vec<Frame>,
}
