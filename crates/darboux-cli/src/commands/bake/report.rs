//! The report of `darboux bake`, and what it advises.

pub mod advice;

use serde::Serialize;

use super::cage::Rays;
use super::verified::Verified;
use super::write::WrittenMap;
use crate::text::{counted, nonzero_counts};

/// The JSON report. json.txt documents its fields.
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
    /// The files that name the colours of maps.
    pub legends: Vec<String>,
    /// The model that was written.
    pub model: Option<String>,
    /// The picture of texels without a hit.
    pub misses: Option<String>,
    pub counts: darboux_bake::BakeReport,
    pub verification: Option<Verified>,
    pub warnings: Vec<String>,
}

impl BakeReport {
    /// All files that were written.
    pub fn files(&self) -> Vec<String> {
        let maps = self.maps.iter().map(|map| &map.file);
        let pictures = self.verification.iter().flat_map(Verified::files);
        maps.chain(&self.legends).chain(&self.model).chain(&self.misses).chain(pictures).cloned().collect()
    }
}

/// What was done, one line per map, and one for the run.
pub fn summary(report: &BakeReport) -> Vec<String> {
    let [width, height] = report.size;
    let map = |map: &WrittenMap| {
        let bits = map.bits;
        let range = map
            .range
            .iter()
            .filter(|range| **range != [0.0, 1.0])
            .map(|[from, to]| format!(", black is {from}, white {to}"));
        let range: String = range.collect();
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
    let model = report.model.iter().map(|path| format!("{path}: the low model with its maps and tangents"));
    let verified = report.verification.iter().flat_map(Verified::lines);
    let legends = report.legends.iter().map(|path| format!("{path}: what the colours stand for"));
    report.maps.iter().map(map).chain(legends).chain(model).chain([of_run]).chain(verified).collect()
}
