//! `darboux tangents`.

use darboux::{Mesh, Scratch, TangentOptions, Tangents};
use darboux_io::gltf::{
    NormalsOptions, Outcome, PrimitiveNormals, Progress, Summary, TangentsOptions, Totals, Written,
    add_normals, add_tangents_with,
};
use indicatif::HumanCount;
use serde::Serialize;

use crate::arguments::{Device, Files, Method, Talk, TangentsArguments};
use crate::batch::{Made, Work, counted, remarks};
use crate::devices::{Computer, DeviceReport};
use crate::jobs::{Job, Usage, word};
use crate::messages::FileProgress;
use crate::models::{load, save};
use crate::normals;
use crate::report::{FileReport, Status};

/// What the report says of a file.
#[derive(Default, Serialize)]
pub struct TangentsSummary {
    #[serde(flatten)]
    tangents: Summary,
    /// What was done to normals before, if anything.
    normals: Option<Vec<PrimitiveNormals>>,
    /// What computed the tangents.
    device: Option<DeviceReport>,
}

impl Work for TangentsArguments {
    type Summary = TangentsSummary;

    const COMMAND: &'static str = "tangents";
    const IMAGES: bool = false;

    fn word(&self) -> &str {
        word::TANGENTS
    }

    fn files(&self) -> &Files {
        &self.files
    }

    fn talk(&self) -> &Talk {
        &self.talk
    }

    fn check(&self) -> Result<(), Usage> {
        if self.method != Method::MikkTSpace && self.threshold != TangentOptions::default().threshold {
            return Err(Usage("--threshold belongs to --method mikktspace; leave one of them out".into()));
        }
        if self.method != Method::MikkTSpace && self.device == Device::Gpu {
            return Err(Usage("--device gpu belongs to --method mikktspace; leave one of them out".into()));
        }
        Ok(())
    }

    fn options(&self) -> String {
        format!("{:?} after {:?}", options(self), self.normals.options())
    }

    fn process(&self, job: &Job, progress: &FileProgress<'_>) -> Result<Made<TangentsSummary>, String> {
        let sentence = |error: darboux_io::Error| error.to_string();
        let mut computer = Computer::new(self.device)?;
        let mut document = load(&job.input, self.files.allow_outside)?;
        let mut warnings = document.warnings().to_vec();
        let mut normals = None;
        if let Some(options) = self.normals.options() {
            let options = NormalsOptions { normals: options, overwrite: self.overwrite };
            let made = add_normals(&mut document, &options, &mut |_| {}).map_err(sentence)?;
            warnings.extend(made.warnings);
            normals = Some(made.primitives);
        }
        let mut on_progress = |Progress { done, total }: Progress| progress.set(done, total);
        let mut generate =
            |mesh: &Mesh<'_>, options: &TangentOptions, scratch: &mut Scratch, out: &mut Tangents| {
                computer.generate(mesh, options, scratch, out)
            };
        let made = add_tangents_with(&mut document, &options(self), &mut generate, &mut on_progress);
        let mut tangents = made.map_err(sentence)?;
        tangents.warnings.splice(0..0, warnings);
        tangents.warnings.extend(advice(tangents.totals.without_normals));
        tangents.warnings.extend(computer.warning());
        let changed = document.is_changed() && (normals.is_some() || tangents.totals.written > 0);
        let device = Some(computer.report(3 * tangents.totals.triangles));
        let (status, files_written) = save(&document, &job.output, &self.files, changed)?;
        Ok(Made { status, files_written, summary: TangentsSummary { normals, device, tangents } })
    }

    fn lines(summary: &TangentsSummary) -> Vec<String> {
        let mut lines = normals::lines(summary.normals.as_deref().unwrap_or_default());
        for primitive in &summary.tangents.primitives {
            let what = match &primitive.outcome {
                Outcome::Written(written) => told(written),
                Outcome::Kept { reason } => format!("kept: {reason}; --overwrite replaces them"),
                Outcome::Skipped { reason } => format!("left alone: {reason}"),
                _ => continue,
            };
            lines.push(format!("{}: {what}", primitive.name));
        }
        lines.extend(summary.device.as_ref().and_then(DeviceReport::line));
        lines
    }

    fn warnings(summary: &TangentsSummary) -> &[String] {
        &summary.tangents.warnings
    }

    fn total(files: &[FileReport<TangentsSummary>]) -> String {
        let sum = |of: fn(&Totals) -> usize,
                   files: &mut dyn Iterator<Item = &FileReport<TangentsSummary>>| {
            files.filter_map(|file| Some(of(&file.summary.now()?.tangents.totals))).sum::<usize>()
        };
        let (changed, same): (Vec<_>, Vec<_>) = files.iter().partition(|file| file.status == Status::Written);
        let had = match sum(|totals| totals.written, &mut same.into_iter()) {
            0 => String::new(),
            had => format!(", {had} had the same before"),
        };
        format!(
            "{} got tangents{had}, {} kept, {} left alone",
            counted(sum(|totals| totals.written, &mut changed.into_iter()), "primitive", "primitives"),
            sum(|totals| totals.kept, &mut files.iter()),
            sum(|totals| totals.skipped, &mut files.iter()),
        )
    }
}

/// What gives tangents to primitives that lack normals.
fn advice(without_normals: usize) -> Option<String> {
    (without_normals > 0).then(|| {
        let lack = counted(without_normals, "primitive has", "primitives have");
        format!("{lack} no normals, which tangents need; --normals smooth makes them first")
    })
}

fn options(arguments: &TangentsArguments) -> TangentsOptions {
    TangentsOptions {
        tangents: TangentOptions {
            method: arguments.method.into(),
            mode: arguments.mode.into(),
            threshold: arguments.threshold,
        },
        encoding: arguments.encoding,
        overwrite: arguments.overwrite,
        only_needed: arguments.only_needed,
        strict: arguments.strict,
        apply_texture_transform: arguments.apply_texture_transform,
    }
}

/// The tangents of a primitive in words; counts of nothing are left out.
fn told(written: &Written) -> String {
    let Written { counts, vertices_before, vertices_after, .. } = written;
    let mut text = match written.uv_set {
        Some(set) => format!("TEXCOORD_{set} ({})", written.uv_reason),
        None => format!("no UVs ({})", written.uv_reason),
    };
    text += &format!(
        ", {}, {}",
        counted(counts.triangles, "triangle", "triangles"),
        counted(*vertices_before, "vertex", "vertices")
    );
    if vertices_after != vertices_before {
        text += &format!(" became {}", HumanCount(*vertices_after as u64));
    }
    text + &remarks([
        (counts.split_vertices, "vertex split", "vertices split"),
        (counts.mirrored_edges, "mirrored edge", "mirrored edges"),
        (counts.degenerate_triangles, "degenerate triangle", "degenerate triangles"),
        (counts.uv_degenerate_triangles, "UV-degenerate triangle", "UV-degenerate triangles"),
        (counts.non_finite_corners, "non-finite corner", "non-finite corners"),
        (counts.repaired_corners, "unusable corner", "unusable corners"),
        (counts.merged_vertices, "mirrored seam vertex not split", "mirrored seam vertices not split"),
        (counts.mixed_sign_triangles, "triangle with both signs", "triangles with both signs"),
        (written.morph_targets, "morph target", "morph targets"),
        (
            written.regrouped_corners,
            "morphed corner grouped as the base is",
            "morphed corners grouped as the base is",
        ),
        (
            written.conflicting_corners,
            "morphed corner unlike its vertex",
            "morphed corners unlike their vertices",
        ),
    ])
}
