//! The report of `darboux bake`, and what it advises.

pub mod advice;

use serde::Serialize;

use super::cage::Rays;
use super::write::WrittenMap;
use crate::text::{counted, nonzero_counts};

/// The JSON report. json.md documents its fields.
#[derive(Debug, Serialize)]
pub struct BakeReport {
    pub command: &'static str,
    pub version: &'static str,
    pub low: String,
    pub high: Vec<String>,
    pub size: [u32; 2],
    pub samples: u32,
    pub rays: Rays,
    pub maps: Vec<WrittenMap>,
    pub counts: Counts,
    pub warnings: Vec<String>,
}

/// The counts of the library, as JSON.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Counts {
    pub texels: u64,
    pub charted_texels: u64,
    pub missed_texels: u64,
    pub back_facing_texels: u64,
    pub overlapping_texels: u64,
    pub inverted_texels: u64,
    pub frameless_texels: u64,
    pub below_horizon_texels: u64,
    pub rays: u64,
    pub low_triangles: u64,
    pub degenerate_triangles: u64,
    pub oversized_triangles: u64,
    pub high_triangles: u64,
    pub non_finite_triangles: u64,
}

impl From<darboux_bake::BakeReport> for Counts {
    fn from(report: darboux_bake::BakeReport) -> Self {
        Self {
            texels: report.texels,
            charted_texels: report.charted_texels,
            missed_texels: report.missed_texels,
            back_facing_texels: report.back_facing_texels,
            overlapping_texels: report.overlapping_texels,
            inverted_texels: report.inverted_texels,
            frameless_texels: report.frameless_texels,
            below_horizon_texels: report.below_horizon_texels,
            rays: report.rays,
            low_triangles: report.low_triangles,
            degenerate_triangles: report.degenerate_triangles,
            oversized_triangles: report.oversized_triangles,
            high_triangles: report.high_triangles,
            non_finite_triangles: report.non_finite_triangles,
        }
    }
}

/// What was done, one line per map, and one for the run.
pub fn summary(report: &BakeReport) -> Vec<String> {
    let [width, height] = report.size;
    let map = |map: &WrittenMap| {
        let bits = map.bits;
        let range = map.range.iter().map(|[from, to]| format!(", black is {from}, white {to}"));
        let range: String = if map.map == "ao" { String::new() } else { range.collect() };
        format!("{}: {}, {width} x {height}, {bits} bits{range}", map.file, map.map)
    };
    let counts = &report.counts;
    let as_count = |count: u64| usize::try_from(count).unwrap_or(usize::MAX);
    let share = 100.0 * counts.charted_texels as f64 / counts.texels.max(1) as f64;
    let of_run = format!(
        "{} onto {}, {}; charts cover {share:.1} % of the image{}",
        counted(as_count(counts.high_triangles), "triangle", "triangles"),
        as_count(counts.low_triangles),
        report.rays.describe(),
        nonzero_counts([
            (as_count(counts.missed_texels), "texel without a hit", "texels without a hit"),
            (
                as_count(counts.overlapping_texels),
                "texel of several triangles",
                "texels of several triangles"
            ),
            (as_count(counts.degenerate_triangles), "triangle without UV area", "triangles without UV area"),
            (as_count(counts.frameless_texels), "texel without a frame", "texels without a frame"),
            (as_count(counts.below_horizon_texels), "normal below the surface", "normals below the surface"),
        ])
    );
    report.maps.iter().map(map).chain([of_run]).collect()
}
