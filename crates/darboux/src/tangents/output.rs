//! [`Output`]: what a method writes for each corner, either a full frame or a tangent with its sign.

use crate::Frame;

/// The tangents of all vertices, for preserved and for mirrored UV orientation: reused buffers.
pub(crate) type SideTangents = [Vec<[f32; 4]>; 2];

/// The element type of an output array.
pub(crate) trait Output: Copy + Send + Sync {
    /// The value of elements that are not computed: a zero tangent with sign +1.
    const EMPTY: Self;

    /// True for full frames: with bitangents and magnitudes.
    const IS_FULL: bool;

    fn from_frame(frame: &Frame) -> Self;

    /// `tangent`: xyz and sign w. Bitangent and magnitudes of a full frame are zero.
    fn from_tangent(tangent: [f32; 4]) -> Self;

    /// The tangent: xyz and sign w.
    fn tangent(&self) -> [f32; 4];

    /// Takes the buffers of an earlier run; empty ones for full frames, which are not reused.
    fn take_buffers(_buffers: &mut SideTangents) -> [Vec<Self>; 2] {
        Default::default()
    }

    /// Returns the buffers for the next run.
    fn return_buffers(_sides: [Vec<Self>; 2], _buffers: &mut SideTangents) {}
}

impl Output for Frame {
    const EMPTY: Self = Frame { tangent: [0.0; 3], bitangent: [0.0; 3], magnitude: [0.0; 2], sign: 1.0 };
    const IS_FULL: bool = true;

    fn from_frame(frame: &Frame) -> Self {
        *frame
    }

    fn from_tangent([x, y, z, sign]: [f32; 4]) -> Self {
        Self { tangent: [x, y, z], sign, ..Self::EMPTY }
    }

    fn tangent(&self) -> [f32; 4] {
        self.tangent_and_sign()
    }
}

impl Output for [f32; 4] {
    const EMPTY: Self = [0.0, 0.0, 0.0, 1.0];
    const IS_FULL: bool = false;

    #[inline]
    fn from_frame(frame: &Frame) -> Self {
        frame.tangent_and_sign()
    }

    #[inline(always)]
    fn from_tangent(tangent: [f32; 4]) -> Self {
        tangent
    }

    fn tangent(&self) -> [f32; 4] {
        *self
    }

    fn take_buffers(buffers: &mut SideTangents) -> [Vec<Self>; 2] {
        std::mem::take(buffers)
    }

    fn return_buffers(sides: [Vec<Self>; 2], buffers: &mut SideTangents) {
        *buffers = sides;
    }
}

/// Copies `values` to `out`, element by element.
#[inline(always)]
pub(crate) fn fill<O: Output>(out: &mut [O], values: impl Iterator<Item = O>) {
    for (out, value) in out.iter_mut().zip(values) {
        *out = value;
    }
}
