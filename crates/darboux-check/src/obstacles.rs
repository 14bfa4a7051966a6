//! Why a finding cannot be repaired at its place, as a clause; none where it can.

use darboux_io::image::PngImage;

use crate::code::{Code, Family};
use crate::finding::Finding;
use crate::orientation::{ONLY_A_PART, Reversal};
use crate::rule::Measured;
use crate::surface::Surface;

/// Obstacles to the repair of a finding about a surface.
pub fn of_surface(finding: &Finding, measured: &Measured<'_>) -> Option<String> {
    let surface = measured.surface;
    match finding.code {
        Code::NormalMissing if !surface.needs_tangents => {
            Some("flat shading may be wanted; `darboux normals` makes smooth ones".to_owned())
        }
        Code::NormalNotFinite | Code::NormalNotUnit if surface.moves_normals => {
            Some("morph targets move these normals".to_owned())
        }
        Code::NormalAgainstWinding => match measured.reversal {
            Some(Reversal::Faces) => None,
            Some(Reversal::Normals | Reversal::NormalsByTangents) => {
                surface.moves_normals.then(|| "morph targets move these normals".to_owned())
            }
            Some(Reversal::Unknown(reason)) => Some(reason.to_owned()),
            None => Some(ONLY_A_PART.to_owned()),
        },
        code if code.family() == Family::Tangents && measured.other_axes.is_some() => Some(
            "tangents depend on the normals, which are in other axes and have to be repaired first"
                .to_owned(),
        ),
        code if code.family() == Family::Tangents => {
            no_tangents(surface).or_else(|| undecided_side(measured.reversal?))
        }
        _ => None,
    }
}

/// New tangents would side with the faces, and then seem to show that the normals are the ones that are reversed.
fn undecided_side(reversal: Reversal) -> Option<String> {
    match reversal {
        Reversal::Unknown(reason) if reason != ONLY_A_PART => Some(reason.to_owned()),
        _ => None,
    }
}

/// Why tangents cannot be computed. Missing normals are made before.
fn no_tangents(surface: &Surface) -> Option<String> {
    let reason = surface.ineligible.as_ref()?;
    let lacks_normals = surface.normals.is_none() && surface.uv_sets.contains_key(&surface.uv_set);
    (!lacks_normals || !surface.needs_tangents).then(|| format!("tangents cannot be computed: {reason}"))
}

/// Obstacles to the repair of the texels of an image.
pub fn of_image(file: &[u8]) -> Option<String> {
    let is_jpeg = file.starts_with(b"\xFF\xD8\xFF");
    let obstacle = PngImage::obstacle(file).filter(|_| !is_jpeg)?;
    match PngImage::is_png(file) {
        true => Some(format!("the image {obstacle}")),
        false => Some("PNG and JPEG images are rewritten, and no others, because only PNG files are written; save it as a PNG first".to_owned()),
    }
}
