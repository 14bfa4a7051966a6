//! `darboux tangents`: adds tangents to a file, and normals first where asked to.

pub mod arguments;
mod device;
pub mod summary;

use darboux::internal::vertex_progress::set_vertex_progress;
use darboux::{Context, Mesh, Method, MikkTSpaceOptions, Mode, TangentOptions};
use darboux_io::gltf::{
    AddNormalsOptions, AddTangentsOptions, Generate, Progress, TangentsOutcome, TangentsTotals,
    WrittenTangents, add_normals, add_tangents_with,
};
use darboux_io::words::Count;

use crate::batch::command::{FileCommand, ProcessedFile};
use crate::batch::plan::Job;
use crate::batch::report::{FileReport, Status};
use crate::commands::normals::describe_normals;
use crate::documents::{left_out, load, save};
use crate::gpu::open_early;
use crate::inputs::{UsageError, output_suffix};
use crate::options::files::FileOptions;
use crate::options::messages::MessageOptions;
use crate::terminal::FileProgress;
use crate::text::{counted, nonzero_counts};
use arguments::{Device, TangentsArguments};
use device::{TangentDevice, may_use_gpu};
use summary::{DeviceReport, SourceReport, TangentsFileSummary};

impl FileCommand for TangentsArguments {
    type Summary = TangentsFileSummary;
    type Totals = TangentsCounts;

    const NAME: &'static str = "tangents";
    const IMAGES: bool = false;

    fn suffix(&self) -> &str {
        output_suffix::TANGENTS
    }

    fn files(&self) -> &FileOptions {
        &self.files
    }

    fn messages(&self) -> &MessageOptions {
        &self.messages
    }

    fn check(&self) -> Result<(), UsageError> {
        let mikktspace_options = [
            ("--threshold", self.threshold != MikkTSpaceOptions::new().threshold),
            ("--mode", self.mode != Mode::default()),
            ("--device gpu", self.device == Device::Gpu),
        ];
        match mikktspace_options.iter().find(|(_, is_set)| *is_set) {
            Some((option, _)) if self.method != Method::default() => {
                Err(UsageError(format!("{option} needs --method mikktspace; remove one of them")))
            }
            _ if self.device == Device::Gpu => open_early().map_err(UsageError),
            // Opening redirects standard error for a moment, so it must not happen beside other work. A
            // failure is reported with the file.
            _ if self.device == Device::Auto && may_use_gpu() => {
                _ = open_early();
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn options(&self) -> String {
        format!("{:?} after {:?}", options(self), self.normals.options())
    }

    fn process(
        &self,
        job: &Job,
        progress: &FileProgress<'_>,
    ) -> Result<ProcessedFile<TangentsFileSummary>, String> {
        let sentence = |error: darboux_io::Error| error.to_string();
        let mut device = TangentDevice::new(self.device)?;
        let mut document = load(&job.input, &self.files.reading)?;
        let mut warnings = document.warnings().to_vec();
        let mut normals = None;
        if let Some(options) = self.normals.options() {
            let options = AddNormalsOptions::default().with_normals(options).with_overwrite(self.overwrite);
            let made = add_normals(&mut document, &options, &mut |_| {}).map_err(sentence)?;
            warnings.extend(made.warnings);
            normals = Some(made.primitives);
        }
        let mut on_progress = |Progress { done, total }: Progress| progress.set(done, total);
        let may_use_gpu = device.may_use_gpu();
        let mut generate = |mesh: &Mesh<'_>, options: &TangentOptions, context: &mut Context| {
            device.generate(mesh, options, context)
        };
        let context = &mut Context::new();
        set_vertex_progress(context, progress.vertex);
        let generate = if may_use_gpu { Generate::With(&mut generate) } else { Generate::OnCpu };
        let made = add_tangents_with(&mut document, &options(self), context, generate, &mut on_progress);
        let mut tangents = made.map_err(sentence)?;
        tangents.warnings.splice(0..0, warnings);
        tangents.warnings.extend(advice(tangents.totals.without_normals));
        tangents.warnings.extend(device.warning());
        let changed = document.is_changed() && (normals.is_some() || tangents.totals.written > 0);
        let device_report = Some(device.report(3 * tangents.totals.triangles));
        tangents.warnings.extend(left_out(&document, &job.output)?);
        let (status, files_written) = save(&document, &job.output, &self.files, changed)?;
        let source = SourceReport::of(&document);
        let summary = TangentsFileSummary { normals, device: device_report, source, tangents };
        Ok(ProcessedFile { status, files_written, summary })
    }

    fn lines(summary: &TangentsFileSummary) -> Vec<String> {
        let mut lines: Vec<String> = summary.source.iter().map(SourceReport::line).collect();
        lines.extend(describe_normals(summary.normals.as_deref().unwrap_or_default()));
        for primitive in &summary.tangents.primitives {
            let what = match &primitive.outcome {
                TangentsOutcome::Written(written) => describe(written),
                TangentsOutcome::Kept { reason } => format!("kept: {reason}; --overwrite replaces them"),
                TangentsOutcome::Skipped { reason } => format!("skipped: {reason}"),
                _ => continue,
            };
            lines.push(format!("{}: {what}", primitive.name));
        }
        lines.extend(summary.device.as_ref().and_then(DeviceReport::line));
        lines
    }

    fn warnings(summary: &TangentsFileSummary) -> &[String] {
        &summary.tangents.warnings
    }

    fn count(counts: &mut TangentsCounts, file: &FileReport<TangentsFileSummary>) {
        let Some(summary) = file.summary.this_run() else { return };
        let TangentsTotals { written, kept, skipped, .. } = summary.tangents.totals;
        let count = if file.status == Status::Written { &mut counts.written } else { &mut counts.unchanged };
        *count += written;
        counts.kept += kept;
        counts.skipped += skipped;
    }

    fn total(counts: &TangentsCounts) -> String {
        let TangentsCounts { written, unchanged, kept, skipped } = counts;
        let had = if *unchanged == 0 { String::new() } else { format!(", {unchanged} unchanged") };
        let written = counted(*written, "primitive", "primitives");
        format!("{written} got tangents{had}, {kept} kept, {skipped} skipped")
    }
}

/// The primitives of the files of a run.
#[derive(Default)]
pub struct TangentsCounts {
    /// Of files that were written.
    written: usize,
    /// The primitives of unchanged files whose tangents would have been the same.
    unchanged: usize,
    kept: usize,
    skipped: usize,
}

/// Suggests --normals for primitives without normals.
fn advice(without_normals: usize) -> Option<String> {
    (without_normals > 0).then(|| {
        let subject = counted(without_normals, "primitive has", "primitives have");
        format!("{subject} no normals, which tangents need; --normals smooth generates them")
    })
}

fn options(arguments: &TangentsArguments) -> AddTangentsOptions {
    AddTangentsOptions::default()
        .with_tangents(match arguments.method {
            Method::MikkTSpace(options) => {
                options.with_mode(arguments.mode).with_threshold(arguments.threshold).into()
            }
            method => TangentOptions::from(method),
        })
        .with_encoding(arguments.encoding)
        .with_overwrite(arguments.overwrite)
        .with_only_needed(arguments.only_needed)
        .with_strict(arguments.strict)
        .with_apply_texture_transform(arguments.apply_texture_transform)
}

/// Describes the tangents of a primitive; counts of zero are omitted.
fn describe(written: &WrittenTangents) -> String {
    let WrittenTangents { counts, vertices_before, vertices_after, .. } = written;
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
        if written.sharing_primitives > 1 {
            text += &format!(" shared by {} primitives", written.sharing_primitives);
        }
        text += &format!(" became {}", Count(vertices_after));
    }
    text + &nonzero_counts([
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
