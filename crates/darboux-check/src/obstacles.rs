//! Finds the obstacles to the repair of defects.

use darboux_io::image::{PngImage, RgbaImage};

use crate::code::Family;
use crate::defect::{Defect, Fault, NormalFault, Obstacle};
use crate::facts::SurfaceFacts;
use crate::measure::other_axes::OtherAxes;
use crate::measure::reversal::{Reversal, Undecided, are_faces_inwards};
use crate::surface::Surface;

/// Obstacles to the repair of a defect of a surface.
pub fn of_surface(defect: &Defect, facts: &SurfaceFacts<'_>) -> Option<Obstacle> {
    let surface = facts.surface;
    let moves_normals = || surface.moves_normals.then_some(Obstacle::MorphTargetsMoveNormals);
    match &defect.fault {
        Fault::Normal(NormalFault::Missing(_)) if !surface.needs_tangents => {
            Some(Obstacle::FlatShadingMayBeWanted)
        }
        Fault::Normal(NormalFault::NotFinite(_) | NormalFault::NotUnit { .. })
            if facts.other_axes.is_some() =>
        {
            Some(Obstacle::NormalsInOtherAxes)
        }
        Fault::Normal(NormalFault::NotFinite(_) | NormalFault::NotUnit { .. }) => moves_normals(),
        Fault::Normal(NormalFault::OtherAxes { axes, .. }) => of_other_axes(axes, surface),
        Fault::Normal(NormalFault::Reversed { reversal, .. }) => match reversal {
            Reversal::Faces => None,
            Reversal::Normals | Reversal::NormalsByTangents => moves_normals(),
            Reversal::Unknown(reason) => Some(Obstacle::UndecidedReversal(*reason)),
        },
        Fault::Normal(NormalFault::PartlyReversed { .. }) => {
            Some(Obstacle::UndecidedReversal(Undecided::OnlyAPart))
        }
        _ if defect.family() != Family::Tangents => None,
        _ if facts.other_axes.is_some() => Some(Obstacle::NormalsInOtherAxes),
        _ => no_tangents(surface).or_else(|| undecided_side(facts.reversal?)),
    }
}

fn of_other_axes(axes: &OtherAxes, surface: &Surface) -> Option<Obstacle> {
    if surface.tangents.is_some() {
        Some(Obstacle::TangentsMayBeTurned)
    } else if surface.moves_normals {
        Some(Obstacle::MorphTargetsMoveNormals)
    } else if !axes.is_clear {
        Some(Obstacle::AxesUnclear)
    } else {
        are_faces_inwards(surface).then_some(Obstacle::FacesMayBeReversed)
    }
}

/// New tangents would agree with the faces, and then seem to show that the normals are reversed.
fn undecided_side(reversal: Reversal) -> Option<Obstacle> {
    match reversal {
        Reversal::Unknown(reason) if reason != Undecided::OnlyAPart => {
            Some(Obstacle::UndecidedReversal(reason))
        }
        _ => None,
    }
}

/// Why tangents cannot be computed. Missing normals are made before.
fn no_tangents(surface: &Surface) -> Option<Obstacle> {
    let reason = surface.ineligible.as_ref()?;
    let lacks_normals = surface.normals.is_none() && surface.uv_sets.contains_key(&surface.uv_set);
    (!lacks_normals || !surface.needs_tangents).then(|| Obstacle::NoTangents(reason.clone()))
}

/// Obstacles to the repair of the texels of an image.
pub fn of_image(file: &[u8]) -> Option<Obstacle> {
    let becomes_png = file.starts_with(b"\xFF\xD8\xFF") || RgbaImage::is_tga(file);
    let obstacle = PngImage::obstacle(file).filter(|_| !becomes_png)?;
    Some(if PngImage::is_png(file) {
        Obstacle::NotRewritable(obstacle.to_string())
    } else {
        Obstacle::OtherImageFormat
    })
}
