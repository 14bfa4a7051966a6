//! A comparison in words.

use indicatif::HumanCount;

use super::report::{CompareReport, Verdict};
use super::statistics::{ROUNDING, Statistics, WorstCorner};
use crate::heat_scale::{ENDS, TICKS};
use crate::text::nonzero_counts;

/// The longest bar of the histogram.
const BAR: usize = 40;

/// Everything that a person wants to know, the totals last but for the worst places.
pub fn described(report: &CompareReport) -> String {
    let other = match (&report.second, &report.method) {
        (Some(second), _) => second.clone(),
        (None, method) => format!("method {}", method.as_deref().unwrap_or_default()),
    };
    let mut text = format!("{} and {other}\n", report.first);
    for primitive in &report.primitives {
        text += &match (&primitive.statistics, &primitive.reason) {
            (Some(statistics), _) => format!("  {}: {}\n", primitive.name, summed_up(statistics)),
            (None, reason) => {
                format!("  {}: not compared: {}\n", primitive.name, reason.as_deref().unwrap_or_default())
            }
        };
    }
    text += &totals(&report.totals);
    text += &histogram(&report.totals);
    if !report.worst.is_empty() {
        text += "\nthe worst places\n";
        text += &report.worst.iter().map(place).collect::<String>();
    }
    if let Some(path) = &report.heat_map {
        let ticks = TICKS.map(|tick| tick.to_string()).join(", ");
        let [from, to] = ENDS;
        text += &format!(
            "\n{path}: from violet ({from} degrees and less) to yellow ({to}), ticks at {ticks}; red: the sign is flipped; \
             where UVs overlap, the worst\n"
        );
    }
    text + "\n" + &verdict(report)
}

/// What it comes to, and what to do about it.
fn verdict(report: &CompareReport) -> String {
    let CompareReport { totals, first, method, .. } = report;
    let whose = method.as_ref().map_or("the same".to_owned(), |method| format!("those of {method}"));
    let advice = method.as_ref().map_or(String::new(), |method| {
        format!("; darboux tangents {first} --method {method} --overwrite makes them so")
    });
    let [different, corners] = [totals.different, totals.corners].map(|count| HumanCount(count as u64));
    match report.verdict {
        Verdict::Identical => format!("the tangents are {whose}, bit for bit\n"),
        Verdict::Close => format!("the tangents are {whose}, to {ROUNDING} degrees\n"),
        Verdict::Different if totals.different == 0 => {
            "the tangents are the same where both files have them\n".to_owned()
        }
        Verdict::Different => {
            format!(
                "the tangents are not {whose}: {different} of {corners} corners have others, the rest to {ROUNDING} degrees{advice}\n"
            )
        }
    }
}

fn summed_up(statistics: &Statistics) -> String {
    let Statistics { corners, identical, median, max, sign_flips, without_angle, .. } = statistics;
    if identical == corners {
        return format!("all {} corners are identical", HumanCount(*corners as u64));
    }
    let angles = match corners - without_angle {
        0 => "no corner has an angle".to_owned(),
        _ => format!("median {}, greatest {} degrees", degrees(*median), degrees(*max)),
    };
    angles
        + &nonzero_counts([
            (*sign_flips, "sign flipped", "signs flipped"),
            (*without_angle, "corner without an angle", "corners without an angle"),
        ])
}

fn totals(totals: &Statistics) -> String {
    let [corners, identical, flips, without] =
        [totals.corners, totals.identical, totals.sign_flips, totals.without_angle]
            .map(|count| HumanCount(count as u64));
    let [min, median, p95, max, mean, weighted] =
        [totals.min, totals.median, totals.p95, totals.max, totals.mean, totals.area_weighted_mean]
            .map(degrees);
    format!(
        "\n{corners} corners: {identical} identical, {flips} with flipped signs, {without} without an angle (a tangent is zero or not finite)\n\
         degrees: least {min}, median {median}, 95 % within {p95}, greatest {max}; mean {mean}, weighted by area {weighted}\n\n"
    )
}

fn histogram(totals: &Statistics) -> String {
    let most = totals.histogram.iter().map(|bin| bin.corners).max().unwrap_or(0).max(1);
    let line = |bin: &super::statistics::Bin| {
        let length = (bin.corners * BAR).div_ceil(most);
        let label = if bin.up_to == 0.0 { "0".to_owned() } else { format!("to {}", bin.up_to) };
        let line = format!("{label:>8} | {:<BAR$} {}", "#".repeat(length), HumanCount(bin.corners as u64));
        format!("{}\n", line.trim_end())
    };
    totals.histogram.iter().map(line).collect()
}

fn place(place: &WorstCorner) -> String {
    let position = place.position.map_or(String::new(), |[x, y, z]| format!(", at ({x}, {y}, {z})"));
    let angle = place.angle.map_or("no angle".to_owned(), |angle| format!("{} degrees", degrees(angle)));
    let flip = if place.sign_flip { " and a flipped sign" } else { "" };
    let (name, triangle, corner) = (&place.name, place.triangle, place.corner);
    format!("  {angle}{flip}: {name}, triangle {triangle}, corner {corner}{position}\n")
}

/// Four digits that mean something.
fn degrees(angle: f64) -> String {
    match angle {
        0.0 => "0".to_owned(),
        small if small < 0.001 => format!("{small:.1e}"),
        angle => format!("{angle:.3}"),
    }
}
