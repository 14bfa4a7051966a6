//! `darboux methods`: explains the methods of computing tangents.

use crate::exit;
use crate::terminal::{Messages, write_stdout};

/// The explanation.
const EXPLANATION: &str = "\
A normal map stores directions relative to the tangents of the program that baked it: use the method of that program.
  mikktspace          the standard of bakers and engines (Blender, Substance, Marmoset, xNormal, Unity, Unreal, glTF); the default
  angle-area          follows the UVs most closely; for surfaces without a baked map: tiling maps, anisotropy, hair
  angle-edge          the default of meshoptimizer, gltfpack -gt and Godot from 4.6 on; to get the tangents that they compute
  lengyel             the sum of dP/du, not normalised, split at mirrored seams; for renderers that compute the same
  lengyel-per-vertex  the same without splits, as in three.js and many tutorials; wrong at mirrored seams, which are counted
  average             the mean of the triangles' tangents; for engines that compute it on the GPU
  area                the mean weighted by area: large faces dominate
  face                the dP/du of each face, not smoothed; for flat shading and measurements
  from-normal         any direction perpendicular to the normal, independent of UVs; for sampling, not for normal maps
`darboux compare model.glb --method NAME` shows how much a file's tangents differ from a method's; docs/algorithms/methods.md derives them.
";

/// Runs the command and returns its exit code.
pub fn run() -> u8 {
    match write_stdout(EXPLANATION.as_bytes()) {
        Ok(()) => exit::DONE,
        Err(error) => {
            Messages::new(false).error(&format!("the text cannot be written: {error}"));
            exit::FAILED
        }
    }
}
