//! The words of defects of UVs.

use super::counts::{Count, counted};
use super::said::Said;
use crate::defect::UvFault;
use crate::measure::hard_edges::HardEdges;
use crate::measure::uv_rounding::UvRounding;

pub fn said(fault: &UvFault) -> Said {
    match fault {
        UvFault::Missing { set, present } => Said::new(format!(
            "its normal texture uses TEXCOORD_{set}, which it does not have"
        ))
        .with("present", *present as f64, "UV sets"),
        UvFault::NotFinite { set, others, vertices } => {
            let what = counted(vertices.len(), "vertex has", "vertices have");
            let others = match others {
                0 => String::new(),
                _ => format!(" and {} with the same data", counted(*others, "other set", "other sets")),
            };
            Said::of_vertices(format!("{what} NaN or infinity in TEXCOORD_{set}{others}"), vertices)
        }
        UvFault::Degenerate { set, triangles } => {
            let what = counted(triangles.len(), "triangle has", "triangles have");
            Said::of_triangles(format!("{what} no area in TEXCOORD_{set}"), triangles)
        }
        UvFault::Mirrored(part) => {
            let text = counted(part.len(), "triangle has mirrored UVs", "triangles have mirrored UVs");
            Said::of_triangles(text, part)
        }
        UvFault::Overlapping { set, triangles, is_complete, area_share } => {
            let at_least = if *is_complete { "" } else { "at least " };
            let count = Count(triangles.len());
            Said::new(format!("{at_least}{count} triangles share area in TEXCOORD_{set} with others")).with(
                "part of the UV area",
                100.0 * area_share,
                "%",
            )
        }
        UvFault::Stretched(faces) => {
            let what = counted(faces.triangles.len(), "triangle is", "triangles are");
            // A face that is nearly a line in UV space has a stretch of millions.
            let times = match faces.largest {
                ..1000.0 => format!("up to {:.0}", faces.largest),
                _ => "more than 1000".to_owned(),
            };
            Said::new(format!("{what} stretched {times} times as far in one direction as across it"))
                .with("median of the primitive", faces.median, "times")
                .with("part of the primitive's area", 100.0 * faces.share, "%")
        }
        UvFault::Coarse(faces) => {
            let what = counted(faces.triangles.len(), "triangle has", "triangles have");
            Said::new(format!(
                "{what} texels that are up to {:.0} times as long as those of most others",
                faces.largest / faces.median
            ))
            .with("part of the primitive's area", 100.0 * faces.share, "%")
        }
        UvFault::Rounded(UvRounding { steps, triangles, share, degrees, error }) => {
            let what = counted(triangles.len(), "triangle", "triangles");
            Said::new(format!(
                "UVs were rounded to {steps} steps: half a step turns the tangents of {what} by {:.0} \
                 degrees or more",
                UvRounding::SEEN
            ))
            .with("part of the primitive's area", 100.0 * share, "%")
            .with("turn that a tenth of the area reaches", *degrees, "degrees")
            .with("errors of v against its neighbours", *error, "times those of rounding")
        }
        UvFault::HardEdge(HardEdges { edges, all, largest, .. }) => {
            Said::new(format!("{} no UV seam", counted(*edges, "hard edge has", "hard edges have")))
                .with("all hard edges", *all as f64, "edges")
                .with("largest angle between the normals of both sides", *largest, "degrees")
        }
    }
}
