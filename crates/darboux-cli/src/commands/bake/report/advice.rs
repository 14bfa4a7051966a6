//! What is unusual about a bake, and what to change.

use darboux_bake::{BakeReport, LowSurface, crossing_triangles};

use crate::commands::bake::arguments::BakeArguments;
use crate::text::counted;

/// The share of charted texels without a hit, or with inverted normals, from which on there is a warning.
const NOTABLE: f64 = 0.01;

/// Warnings about rays that cross. `names`: of the surfaces; `outwards`: how far outside rays begin without a
/// cage.
pub fn of_rays<'n>(
    arguments: &BakeArguments,
    low: &[LowSurface<'_>],
    names: impl Iterator<Item = &'n str>,
    outwards: f32,
) -> Vec<String> {
    let crossing = crossing_triangles(low, outwards);
    let parts = names.zip(crossing).filter(|(_, count)| *count > 0);
    let parts: Vec<String> = parts
        .map(|(name, count)| {
            let name = if name.is_empty() { "a part without a name" } else { name };
            format!("{name} ({})", counted(count, "triangle", "triangles"))
        })
        .collect();
    match &parts[..] {
        [] => Vec::new(),
        [first, ..] => {
            let others = match parts.len() {
                0..=6 => parts.join(", "),
                count => format!("{first} and {} other parts", count - 1),
            };
            let cure = match arguments.auto_cage {
                Some(_) => {
                    "a larger share for --auto-cage, or move these vertices of the cage (--write-cage)"
                }
                None => "a smaller distance, or --auto-cage",
            };
            vec![format!(
                "rays of neighbouring texels cross before they reach the low model, so that detail may be \
                 mirrored or doubled there: {others}; use {cure}"
            )]
        }
    }
}

/// Whether so many texels have no hit that something must be wrong.
pub fn has_many_misses(report: &BakeReport) -> bool {
    report.missed_texels as f64 > NOTABLE * report.charted_texels as f64
}

/// The reason why maps of this bake would show nothing of the high models; none where they do. `misfit`:
/// of the models.
pub fn failure(report: &BakeReport, arguments: &BakeArguments, misfit: Option<&str>) -> Option<String> {
    let is_all = |count: u64, of: u64| count > 0 && count == of;
    if is_all(report.non_finite_low_triangles, report.low_triangles) {
        return Some(
            "every triangle of the low model has positions or normals that are not finite where the scene \
             has them, so there is nothing to bake; scale the model down"
                .to_owned(),
        );
    }
    if is_all(report.non_finite_triangles, report.high_triangles) {
        return Some(
            "every triangle of the high models has positions that are not finite where their scenes have \
             them, or is too large beside the low model; scale the models to one size"
                .to_owned(),
        );
    }
    if report.charted_texels == 0 {
        return Some("no triangle of the low model covers a texel; check its UVs".to_owned());
    }
    let cause = || cause_of_misses(report, arguments, misfit);
    if report.missed_texels == report.charted_texels {
        return Some(format!("all rays hit nothing, and nothing was written: {}", cause()));
    }
    let most = f64::from(arguments.max_misses?);
    (report.missed_texels as f64 > most * report.charted_texels as f64).then(|| {
        let missed = percent(report, report.missed_texels);
        let cause = cause();
        format!(
            "the rays of {missed} of the texels hit nothing, which --max-misses {most} forbids, and \
             nothing was written: {cause}"
        )
    })
}

/// A count of texels as a part of the charted ones.
fn percent(report: &BakeReport, count: u64) -> String {
    format!("{:.1} %", 100.0 * count as f64 / report.charted_texels.max(1) as f64)
}

fn cause_of_misses<'a>(report: &BakeReport, arguments: &BakeArguments, misfit: Option<&'a str>) -> &'a str {
    if let Some(misfit) = misfit {
        misfit
    } else if 2 * report.back_facing_texels > report.missed_texels {
        "most of these rays meet the high models from behind, so their faces are turned inside out; turn \
         them, or use --back-faces"
    } else if arguments.distance.is_some() {
        "begin rays farther outside or end them farther inside (--distance), or use a cage (--cage-offset), \
         and check that the models lie on each other"
    } else {
        "choose a larger --cage-offset, and check that the models lie on each other"
    }
}

/// Warnings about the result. `misfit`: of the models.
pub fn of_report(
    report: &BakeReport,
    arguments: &BakeArguments,
    misfit: Option<&str>,
    misses: Option<&str>,
) -> Vec<String> {
    let share = |count: u64| count as f64 / report.charted_texels.max(1) as f64;
    let percent = |count: u64| percent(report, count);
    let mut warnings = Vec::new();
    if has_many_misses(report) {
        let (missed, why) = (percent(report.missed_texels), cause_of_misses(report, arguments, misfit));
        let place = misses.map(|path| format!("; {path} shows where")).unwrap_or_default();
        let is_most = share(report.missed_texels) > 0.5;
        let result = if is_most { "most of the map shows nothing of the high models: " } else { "" };
        warnings.push(format!("{result}the rays of {missed} of the texels hit nothing: {why}{place}"));
    }
    if share(report.inverted_texels) > NOTABLE {
        warnings.push(format!(
            "at {} of the texels the normals of the high models point to the back of their triangles; make \
             them again with darboux normals --overwrite",
            percent(report.inverted_texels)
        ));
    }
    if report.overlapping_texels > 0 {
        warnings.push(format!(
            "{} covered by several triangles of the low model, of which the first is baked; all texels of \
             charts together are covered {:.2} times on average; charts may share texels only where their \
             surfaces are equal: otherwise choose UVs that neither overlap nor repeat (--uv-set), or unwrap \
             the model anew",
            counted(
                usize::try_from(report.overlapping_texels).unwrap_or(usize::MAX),
                "texel is",
                "texels are"
            ),
            share(report.chart_area)
        ));
    }
    let left_out = [
        (
            report.oversized_triangles,
            "triangle of the low model spans more than 16 tiles of UVs and is not baked",
            "triangles of the low model span more than 16 tiles of UVs and are not baked",
        ),
        (
            report.non_finite_low_triangles,
            "triangle of the low model has positions or normals that are not finite and is not baked \
             (darboux check says where)",
            "triangles of the low model have positions or normals that are not finite and are not baked \
             (darboux check says where)",
        ),
        (
            report.non_finite_triangles,
            "triangle of the high models has positions that are not finite",
            "triangles of the high models have positions that are not finite",
        ),
    ];
    for (count, one, many) in left_out.into_iter().filter(|(count, ..)| *count > 0) {
        warnings.push(counted(usize::try_from(count).unwrap_or(usize::MAX), one, many));
    }
    warnings
}
