//! The words of defects of UVs.

use super::counts::counted;
use super::said::Said;
use crate::defect::Fault;

pub fn said(fault: &Fault) -> Said {
    match fault {
        Fault::UvMissing { set, present } => Said::new(format!(
            "its normal texture uses TEXCOORD_{set}, which it does not have"
        ))
        .with("present", *present as f64, "UV sets"),
        Fault::UvNotFinite { set, vertices } => {
            let what = counted(vertices.len(), "vertex has", "vertices have");
            Said::of_vertices(format!("{what} NaN or infinity in TEXCOORD_{set}"), vertices)
        }
        Fault::UvDegenerate { set, triangles } => {
            let what = counted(triangles.len(), "triangle has", "triangles have");
            Said::of_triangles(format!("{what} no area in TEXCOORD_{set}"), triangles)
        }
        Fault::UvMirrored(part) => {
            let text = counted(part.len(), "triangle has mirrored UVs", "triangles have mirrored UVs");
            Said::of_triangles(text, part)
        }
        Fault::UvOverlapping { set, triangles, is_complete, area_share } => {
            let at_least = if *is_complete { "" } else { "at least " };
            let count = triangles.len();
            Said::new(format!("{at_least}{count} triangles share area in TEXCOORD_{set} with others")).with(
                "part of the UV area",
                100.0 * area_share,
                "%",
            )
        }
        _ => unreachable!("a fault of UVs"),
    }
}
