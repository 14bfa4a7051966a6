//! What was set, what was counted, and where the time went.

use darboux::Choice;
use darboux_bake::{BakeReport as Counts, PartMatch};
use darboux_io::words::Count;

use super::super::arguments::BakeArguments;
use super::super::report::BakeReport;
use super::shared::figure;
use crate::html_page::escaped;
use crate::html_page::raster::Raster;

/// How many texels have no hit, and where.
pub fn misses(counts: &Counts, raster: &Raster) -> Result<String, String> {
    let Counts { charted_texels, missed_texels, back_facing_texels, .. } = *counts;
    let share = 100.0 * missed_texels as f64 / charted_texels.max(1) as f64;
    let [missed, charted] = [missed_texels, charted_texels].map(Count);
    let behind = match back_facing_texels {
        0 => String::new(),
        count => format!(" The rays of {} of them, orange, met triangles from behind.", Count(count)),
    };
    let sentence = format!(
        "<p>{missed} of {charted} texels ({share:.2} %) have no hit and are filled from around.{behind}</p>\n"
    );
    Ok(sentence + &figure(raster, "Texels without a hit are red or orange", "")?)
}

/// The settings, the counts and the times, each as a table.
pub fn tables(arguments: &BakeArguments, report: &BakeReport) -> String {
    let settings = table("setting", &settings(arguments, report), false);
    let counts = table("count", &counts(&report.counts), true);
    let stages = report.seconds.stages();
    let seconds = stages.into_iter().filter(|(_, seconds)| *seconds > 0.0);
    let seconds: Vec<_> = seconds.map(|(what, seconds)| (what, format!("{seconds:.2}"))).collect();
    let times = table("seconds", &seconds, true);
    format!("<div class=\"pair-of-columns\">\n{settings}{counts}{times}</div>\n")
}

fn settings(arguments: &BakeArguments, report: &BakeReport) -> Vec<(&'static str, String)> {
    let [width, height] = report.size;
    let bitangent = format!("per {}", arguments.bitangent.name());
    let method = arguments.method.map_or("those of the file, or mikktspace", |method| method.name());
    let parts = match arguments.part_match {
        PartMatch::Name => "those of the same name",
        _ => "all, the nearest",
    };
    vec![
        ("size", format!("{width} x {height}")),
        ("samples per texel", report.samples.to_string()),
        ("rays", report.rays.describe()),
        ("high parts", parts.to_owned()),
        ("convention", arguments.convention.name.clone()),
        ("tangents", method.to_owned()),
        ("bitangent", bitangent),
        ("padding", arguments.padding.map_or("everywhere".to_owned(), |texels| format!("{texels} texels"))),
    ]
}

fn counts(counts: &Counts) -> Vec<(&'static str, String)> {
    let all = [
        ("triangles of the high models", counts.high_triangles),
        ("triangles of the low model", counts.low_triangles),
        ("texels", counts.texels),
        ("texels of charts", counts.charted_texels),
        ("rays", counts.rays),
        ("texels without a hit", counts.missed_texels),
        ("of these with triangles from behind", counts.back_facing_texels),
        ("texels of several triangles (overlaps)", counts.overlapping_texels),
        ("area of all charts in texels", counts.chart_area),
        ("texels whose high normals point to the back", counts.inverted_texels),
        ("texels without a tangent frame", counts.frameless_texels),
        ("normals below the low surface", counts.below_horizon_texels),
        ("low triangles without UV area", counts.degenerate_triangles),
        ("low triangles across more than 16 tiles", counts.oversized_triangles),
        ("low triangles that are not finite", counts.non_finite_low_triangles),
        ("high triangles that are not finite", counts.non_finite_triangles),
    ];
    all.into_iter()
        .filter(|(_, count)| *count > 0)
        .map(|(what, count)| (what, Count(count).to_string()))
        .collect()
}

fn table(first: &str, rows: &[(&str, String)], are_numbers: bool) -> String {
    let class = if are_numbers { " class=\"number\"" } else { "" };
    let row = |(what, value): &(&str, String)| {
        format!("<tr><td>{}</td><td{class}>{}</td></tr>\n", escaped(what), escaped(value))
    };
    let rows: String = rows.iter().map(row).collect();
    format!("<table>\n<tr><th scope=\"col\">{first}</th><th></th></tr>\n{rows}</table>\n")
}
