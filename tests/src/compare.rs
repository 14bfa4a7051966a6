//! Compares frames as bits, with NaN equal to NaN, and reports differences with the mesh that reproduces
//! them.

use std::fmt;

use darboux::Frame;

use crate::OwnedMesh;

/// A difference between two results.
#[derive(Clone, Debug)]
pub struct Difference {
    /// The number of corners that differ.
    pub count: usize,
    /// The first of them.
    pub corner: usize,
    /// What was expected there.
    pub expected: Option<Frame>,
    /// What was found there.
    pub found: Option<Frame>,
}

/// The nine numbers of a frame as bits, every NaN the same: a NaN's payload and sign differ between
/// processors.
pub fn bits(frame: &Frame) -> [u32; 9] {
    let ([tx, ty, tz], [bx, by, bz], [s, t]) = (frame.tangent, frame.bitangent, frame.magnitude);
    [tx, ty, tz, bx, by, bz, s, t, frame.sign].map(|x| if x.is_nan() { f32::NAN } else { x }.to_bits())
}

/// The difference between two results, if any.
pub fn first_difference(expected: &[Option<Frame>], found: &[Option<Frame>]) -> Option<Difference> {
    assert_eq!(expected.len(), found.len(), "answers about meshes of different size");
    let differs = |corner: &usize| expected[*corner].as_ref().map(bits) != found[*corner].as_ref().map(bits);
    let differing: Vec<usize> = (0..expected.len()).filter(differs).collect();
    let &corner = differing.first()?;
    Some(Difference { count: differing.len(), corner, expected: expected[corner], found: found[corner] })
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} corners differ, the first is corner {}", self.count, self.corner)?;
        writeln!(f, "  expected {:?}", self.expected)?;
        write!(f, "  found    {:?}", self.found)
    }
}

/// Panics if two results differ, with the mesh in the corpus format.
#[track_caller]
pub fn assert_equal(
    what: &str,
    mesh: &OwnedMesh,
    threshold: f32,
    expected: &[Option<Frame>],
    found: &[Option<Frame>],
) {
    if let Some(difference) = first_difference(expected, found) {
        let dump =
            if mesh.corner_count() <= 600 { mesh.to_text() } else { String::from("(too large to show)") };
        panic!("{what}: {difference}\nthresholds {threshold:?}\n{dump}");
    }
}
