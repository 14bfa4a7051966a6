//! `darboux methods`.

use crate::exit;
use crate::terminal::{Messages, write_stdout};

/// The choice in ten lines.
const CHOICE: &str = "\
A normal map stores directions relative to the tangents of its baker: use the method that it was baked with.
  mikktspace          what bakers and engines use (Blender, Substance, Marmoset, xNormal, Unity, Unreal, glTF): the default
  angle-area          no baked map: UVs followed best, slivers and bevels count little; tiling maps, anisotropy, hair
  lengyel             sums of dP/du as long as they are, mirrored seams split: for renderers that compute this themselves
  lengyel-per-vertex  as three.js computeTangents and many tutorials: nothing splits, so mirrored seams break (counted)
  average             the mean of the triangles' tangents, all alike: for engines that gather it on the GPU
  area                the mean weighted by area: large faces decide
  face                each face's own dP/du, not smoothed: flat shading, measuring
  from-normal         any perpendicular of the normal, whatever the UVs: for sampling, never for normal maps
`darboux compare model.glb --method NAME` shows how far two choices are apart; docs/algorithms/methods.md in its source derives them.
";

/// Runs the command and returns its exit code.
pub fn run() -> u8 {
    match write_stdout(CHOICE.as_bytes()) {
        Ok(()) => exit::DONE,
        Err(error) => {
            Messages::new(false).error(&format!("the text cannot be written: {error}"));
            exit::FAILED
        }
    }
}
