//! The words of defects of positions and normals.

use super::counts::{Count, counted};
use super::said::Said;
use crate::defect::NormalFault;
use crate::indices::Part;
use crate::measure::other_axes::OtherAxes;
use crate::measure::reversal::Reversal;

/// What is said of positions that are no numbers.
pub fn positions_not_finite(part: &Part) -> Said {
    not_finite(part, ["position contains NaN or infinity", "positions contain NaN or infinity"])
}

pub fn said(fault: &NormalFault) -> Said {
    match fault {
        NormalFault::NotFinite(part) => {
            not_finite(part, ["normal contains NaN or infinity", "normals contain NaN or infinity"])
        }
        NormalFault::Missing(vertices) => {
            Said::new("it has no normals").with("without normals", *vertices as f64, "vertices")
        }
        NormalFault::NotUnit { vertices, smallest } => {
            let words = ["normal has another length than 1", "normals have another length than 1"];
            not_finite(vertices, words).with("smallest length", *smallest, "")
        }
        NormalFault::OtherAxes { axes, .. } => other_axes(axes),
        NormalFault::Reversed { reversal, triangles } => {
            let what =
                counted(triangles.len(), "triangle points to its back", "triangles point to their back");
            let why = explanation(*reversal).map_or(String::new(), |clause| format!(": {clause}"));
            Said::of_triangles(format!("the normals of {what}{why}"), triangles)
        }
        NormalFault::PartlyReversed { triangles, whole, mixed, vertices, parts } => {
            let text = partly_reversed(*whole, *mixed, *parts);
            let what = "normals that point to the back of all their faces";
            Said::of_triangles(text, triangles).with(what, *vertices as f64, "vertices")
        }
    }
}

fn not_finite(part: &Part, [one, many]: [&str; 2]) -> Said {
    Said::of_vertices(counted(part.len(), one, many), part)
}

/// What is reversed and why, as a clause; none where it is undecided.
fn explanation(reversal: Reversal) -> Option<&'static str> {
    match reversal {
        Reversal::Faces => Some("its faces are reversed, because they enclose a negative volume"),
        Reversal::Normals => Some("its normals are reversed, because its faces enclose a positive volume"),
        Reversal::NormalsByTangents => {
            Some("its normals are reversed, because its tangents agree with its faces and not with them")
        }
        Reversal::Unknown(_) => None,
    }
}

fn partly_reversed(whole: usize, mixed: usize, [parts, all_parts]: [usize; 2]) -> String {
    let all_parts = counted(all_parts, "connected part", "connected parts");
    let triangles = counted(whole, "triangle", "triangles");
    let verb = if whole == 1 { "points to its back" } else { "point to their back" };
    let reversed = format!("the normals of {triangles}, in {} of {all_parts}, {verb}", Count(parts));
    match (whole, mixed) {
        (0, _) => {
            let what = counted(mixed, "triangle has", "triangles have");
            format!("{what} normals on both sides: some of their corners' normals point to the back")
        }
        (_, 0) => reversed,
        (_, 1) => format!("{reversed}, and 1 triangle beside them has normals on both sides"),
        (_, count) => {
            format!("{reversed}, and {} triangles beside them have normals on both sides", Count(count))
        }
    }
}

fn other_axes(axes: &OtherAxes) -> Said {
    let cause = if axes.are_exchanged() {
        "the positions were turned to another up axis, and they were not"
    } else {
        "the positions were mirrored or turned by 180 degrees, and they were not"
    };
    let component = |i: usize| {
        let sign = if axes.signs[i] < 0.0 { "-" } else { "" };
        format!("{sign}{}", ["x", "y", "z"][axes.sources[i]])
    };
    let components = [0, 1, 2].map(component).join(", ");
    let degrees = axes.mean_cosines.map(|cosine| cosine.clamp(-1.0, 1.0).acos().to_degrees());
    Said::new(format!("its normals fit its faces only if they are read as ({components}), as if {cause}"))
        .with("angle between normals and faces", degrees[0], "degrees")
        .with("with these axes", degrees[1], "degrees")
}
