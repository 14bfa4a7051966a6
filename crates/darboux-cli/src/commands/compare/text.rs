//! A comparison as text: totals, a histogram of the angles, the worst corners, and a verdict in one sentence.

use darboux::{Choice, Method};
use darboux_io::words::Count;

use super::report::{CompareReport, Verdict};
use super::statistics::{Bin, ROUNDING, Statistics, WorstCorner};
use crate::heat_scale::{ENDS, TICKS};
use crate::text::{command_line, nonzero_counts, printable};

/// The length of the histogram's longest bar.
const LONGEST_BAR: usize = 40;

/// The whole text; the verdict is the last line.
pub fn describe(report: &CompareReport) -> String {
    let mut text = format!("{} and {}\n", printable(&report.first), other_side(report));
    for primitive in &report.primitives {
        let outcome = match (&primitive.statistics, &primitive.reason) {
            (Some(statistics), _) => describe_primitive(statistics),
            (None, reason) => format!("not compared: {}", reason.as_deref().unwrap_or_default()),
        };
        text += &format!("  {}\n", printable(&format!("{}: {outcome}", primitive.name)));
    }
    text += &describe_totals(&report.totals);
    text += &histogram(&report.totals);
    if !report.worst.is_empty() {
        text += "\nthe worst corners\n";
        text += &report.worst.iter().map(describe_corner).collect::<String>();
    }
    if let Some(path) = &report.heat_map {
        let ticks = TICKS.map(|tick| tick.to_string()).join(", ");
        let [from, to] = ENDS;
        text += &format!(
            "\n{}: colours from violet ({from} degrees or less) to yellow ({to} degrees), ticks at {ticks}; \
             red where the sign w is opposite; where UVs overlap, the largest angle\n",
            printable(path)
        );
    }
    text + "\n" + &verdict(report) + "\n"
}

/// What the first file is compared with.
fn other_side(report: &CompareReport) -> String {
    match (&report.second, &report.method) {
        (Some(second), _) => printable(second).into_owned(),
        (None, method) => format!("method {}", method.as_deref().unwrap_or_default()),
    }
}

const OF_QUADS: &str = "tangents that were computed on quads before these were cut, as darboux computes \
     those of FBX, OBJ and PLY, differ so in a few places: keep them; otherwise, ";

/// Whether the tangents may be MikkTSpace's of quads: most corners agree.
fn may_be_of_quads(method: &str, totals: &Statistics) -> bool {
    method == Method::default().name() && 2 * totals.different < totals.corners
}

/// The result in one sentence, and the command that writes the method's tangents.
fn verdict(report: &CompareReport) -> String {
    let CompareReport { totals, first, method, .. } = report;
    let other =
        method.as_ref().map_or("those of the second file".to_owned(), |method| format!("those of {method}"));
    match report.verdict {
        Verdict::Identical => format!("the tangents are identical to {other}, bit for bit"),
        Verdict::Close => format!("the tangents agree with {other} to {ROUNDING} degrees"),
        Verdict::Different if totals.different == 0 => {
            "the tangents agree where both files have them; some primitives have tangents in one file only"
                .to_owned()
        }
        Verdict::Different => {
            let repair = method.as_ref().map_or(String::new(), |method| {
                let command = command_line(&["tangents", "--overwrite", "--method", method], &[first]);
                let quads = if may_be_of_quads(method, totals) { OF_QUADS } else { "" };
                format!("; {quads}to replace them: {command}")
            });
            let tolerance = match report.within_tolerance {
                Some(true) => "; the largest angle is within --tolerance",
                Some(false) => "; the largest angle is above --tolerance",
                None => "",
            };
            format!("the tangents differ from {other}: {}{tolerance}{repair}", difference(totals))
        }
    }
}

/// How many corners differ, and how.
fn difference(totals: &Statistics) -> String {
    let Statistics { corners, different, sign_flips, without_angle, .. } = *totals;
    let [shown, all, rest] = [different, corners, corners - different].map(Count);
    if sign_flips == corners && without_angle == 0 && totals.max <= ROUNDING {
        return format!(
            "the sign w is opposite at all {all} corners and the directions agree to {ROUNDING} degrees, as \
             for UVs whose v axis is inverted"
        );
    }
    let extent = match corners - different {
        0 => format!("all {all} corners differ by more than {ROUNDING} degrees or in the sign w"),
        _ => format!(
            "{shown} of {all} corners differ by more than {ROUNDING} degrees or in the sign w, the other \
             {rest} agree"
        ),
    };
    let signs = if sign_flips == corners { "; the sign w is opposite at all of them" } else { "" };
    format!("{extent}{signs}")
}

fn describe_primitive(statistics: &Statistics) -> String {
    let Statistics { corners, identical, median, max, sign_flips, without_angle, .. } = statistics;
    if identical == corners {
        return format!("all {} corners are identical", Count(corners));
    }
    let angles = match corners - without_angle {
        0 => "no corner has an angle".to_owned(),
        _ => format!("median {}, maximum {} degrees", degrees(*median), degrees(*max)),
    };
    angles
        + &nonzero_counts([
            (*sign_flips, "opposite sign", "opposite signs"),
            (*without_angle, "corner without an angle", "corners without an angle"),
        ])
}

fn describe_totals(totals: &Statistics) -> String {
    let [corners, identical, flips, without] =
        [totals.corners, totals.identical, totals.sign_flips, totals.without_angle].map(Count);
    let [min, median, p95, max, mean, weighted] =
        [totals.min, totals.median, totals.p95, totals.max, totals.mean, totals.area_weighted_mean]
            .map(degrees);
    format!(
        "\n{corners} corners: {identical} identical, {flips} with opposite signs w, {without} without an \
         angle (a tangent is zero or not finite)\n\
         angles in degrees: minimum {min}, median {median}, 95th percentile {p95}, maximum {max}; mean \
         {mean}, weighted by area {weighted}\n\n"
    )
}

fn histogram(totals: &Statistics) -> String {
    let most = totals.histogram.iter().map(|bin| bin.corners).max().unwrap_or(0).max(1);
    let line = |bin: &Bin| {
        let length = (bin.corners * LONGEST_BAR).div_ceil(most);
        let label = if bin.up_to == 0.0 { "0".to_owned() } else { format!("to {}", bin.up_to) };
        let count = Count(bin.corners);
        let line = format!("{label:>8} | {:<LONGEST_BAR$} {count}", "#".repeat(length));
        format!("{}\n", line.trim_end())
    };
    totals.histogram.iter().map(line).collect()
}

fn describe_corner(worst: &WorstCorner) -> String {
    let position = worst.position.map_or(String::new(), |[x, y, z]| format!(", at ({x}, {y}, {z})"));
    let angle = worst.angle.map_or("no angle".to_owned(), |angle| format!("{} degrees", degrees(angle)));
    let flip = if worst.sign_flip { " and an opposite sign" } else { "" };
    let WorstCorner { triangle, corner, .. } = worst;
    let name = worst.name.to_string();
    format!("  {angle}{flip}: {}, triangle {triangle}, corner {corner}{position}\n", printable(&name))
}

/// An angle with about four significant digits.
fn degrees(angle: f64) -> String {
    match angle {
        0.0 => "0".to_owned(),
        small if small < 0.001 => format!("{small:.1e}"),
        angle => format!("{angle:.3}"),
    }
}
