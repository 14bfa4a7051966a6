//! What a run writes for each corner: a whole frame, or a tangent with its sign.

use crate::Frame;

/// Tangents of both sides of every vertex, kept from one run to the next.
pub(crate) type TangentsOfSides = [Vec<[f32; 4]>; 2];

/// What corners are given: whole frames, or tangents alone.
pub(crate) trait Output: Copy + Send + Sync {
    /// What nobody reads, or nothing reached.
    const EMPTY: Self;

    /// Whether bitangents and magnitudes are wanted.
    const IS_FULL: bool;

    fn from_frame(frame: &Frame) -> Self;

    /// `tangent`: xyz and sign w, of a frame that is not whole.
    fn from_tangent(tangent: [f32; 4]) -> Self;

    /// Tangent xyz and sign w.
    fn tangent(&self) -> [f32; 4];

    /// The memory of an earlier run, where it is kept.
    fn kept(_kept: &mut TangentsOfSides) -> [Vec<Self>; 2] {
        Default::default()
    }

    /// Leaves memory for another run.
    fn keep(_sides: [Vec<Self>; 2], _kept: &mut TangentsOfSides) {}
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

    fn kept(kept: &mut TangentsOfSides) -> [Vec<Self>; 2] {
        std::mem::take(kept)
    }

    fn keep(sides: [Vec<Self>; 2], kept: &mut TangentsOfSides) {
        *kept = sides;
    }
}

/// Writes one output after the other.
#[inline(always)]
pub(crate) fn fill<O: Output>(out: &mut [O], values: impl Iterator<Item = O>) {
    for (out, value) in out.iter_mut().zip(values) {
        *out = value;
    }
}
