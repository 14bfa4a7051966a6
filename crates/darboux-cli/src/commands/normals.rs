//! `darboux normals`: adds normals to a file.

pub mod arguments;

use darboux_io::gltf::{
    AddNormalsOptions, NormalsOutcome, NormalsSummary, PrimitiveNormals, Progress, WrittenNormals,
    add_normals,
};
use darboux_io::words::Count;

use crate::batch::command::{FileCommand, ProcessedFile};
use crate::batch::plan::Job;
use crate::batch::report::FileReport;
use crate::documents::{left_out, load, save};
use crate::inputs::output_suffix;
use crate::options::files::FileOptions;
use crate::options::messages::MessageOptions;
use crate::terminal::FileProgress;
use crate::text::{counted, nonzero_counts};
use arguments::NormalsArguments;

impl FileCommand for NormalsArguments {
    type Summary = NormalsSummary;
    type Totals = NormalsCounts;

    const NAME: &'static str = "normals";
    const IMAGES: bool = false;

    fn suffix(&self) -> &str {
        output_suffix::NORMALS
    }

    fn files(&self) -> &FileOptions {
        &self.files
    }

    fn messages(&self) -> &MessageOptions {
        &self.messages
    }

    fn options(&self) -> String {
        format!("{:?}", normals_options(self))
    }

    fn process(
        &self,
        job: &Job,
        progress: &FileProgress<'_>,
    ) -> Result<ProcessedFile<NormalsSummary>, String> {
        let mut document = load(&job.input, &self.files.reading)?;
        let mut on_progress = |Progress { done, total }: Progress| progress.set(done, total);
        let mut summary = add_normals(&mut document, &normals_options(self), &mut on_progress)
            .map_err(|error| error.to_string())?;
        summary.warnings.splice(0..0, document.warnings().iter().cloned());
        summary.warnings.extend(without_tangents(&summary.primitives));
        summary.warnings.extend(left_out(&document, &job.output)?);
        let (status, files_written) = save(&document, &job.output, &self.files, summary.written > 0)?;
        Ok(ProcessedFile { status, files_written, summary })
    }

    fn lines(summary: &NormalsSummary) -> Vec<String> {
        describe_normals(&summary.primitives)
    }

    fn warnings(summary: &NormalsSummary) -> &[String] {
        &summary.warnings
    }

    fn count(totals: &mut NormalsCounts, file: &FileReport<NormalsSummary>) {
        if let Some(summary) = file.summary.this_run() {
            totals.written += summary.written;
            totals.primitives += summary.primitives.len();
        }
    }

    fn total(totals: &NormalsCounts) -> String {
        let without = totals.primitives - totals.written;
        format!("{} got normals, {without} did not", counted(totals.written, "primitive", "primitives"))
    }
}

/// The primitives of the files of a run.
#[derive(Default)]
pub struct NormalsCounts {
    primitives: usize,
    written: usize,
}

fn normals_options(arguments: &NormalsArguments) -> AddNormalsOptions {
    AddNormalsOptions::default().with_normals(arguments.shading()).with_overwrite(arguments.overwrite)
}

/// Warns that tangents were removed: materials may need them.
fn without_tangents(primitives: &[PrimitiveNormals]) -> Option<String> {
    let is_without = |primitive: &&PrimitiveNormals| matches!(&primitive.outcome, NormalsOutcome::Written(written) if written.tangents_removed);
    let count = primitives.iter().filter(is_without).count();
    (count > 0).then(|| {
        let lost = counted(count, "primitive has", "primitives have");
        format!("{lost} no tangents any more: they belonged to the old normals; run darboux tangents")
    })
}

/// Describes what was done to each primitive.
pub fn describe_normals(primitives: &[PrimitiveNormals]) -> Vec<String> {
    let line = |primitive: &PrimitiveNormals| {
        let what = match &primitive.outcome {
            NormalsOutcome::Written(written) => describe(written),
            NormalsOutcome::Kept { reason } => format!("normals kept: {reason}; --overwrite replaces them"),
            NormalsOutcome::Skipped { reason } => format!("no normals: {reason}"),
            _ => return None,
        };
        Some(format!("{}: {what}", primitive.name))
    };
    primitives.iter().filter_map(line).collect()
}

/// Describes the normals of a primitive; counts of zero are omitted.
fn describe(written: &WrittenNormals) -> String {
    let WrittenNormals { vertices_before, vertices_after, .. } = written;
    let mut text = format!(
        "normals {}, {}, {}",
        if written.replaced { "replaced" } else { "generated" },
        counted(written.triangles, "triangle", "triangles"),
        counted(*vertices_before, "vertex", "vertices")
    );
    if vertices_after != vertices_before {
        text += &format!(" became {}", Count(vertices_after));
    }
    text += &nonzero_counts([
        (written.creased_edges, "creased edge in its mesh", "creased edges in its mesh"),
        (written.degenerate_triangles, "degenerate triangle in its mesh", "degenerate triangles in its mesh"),
        (
            written.repaired_corners,
            "corner without a normal in its mesh",
            "corners without a normal in its mesh",
        ),
        (written.morph_targets, "morph target", "morph targets"),
        (
            written.conflicting_corners,
            "morphed corner unlike its vertex",
            "morphed corners unlike their vertices",
        ),
    ]);
    if written.tangents_removed {
        text += ", tangents removed";
    }
    text
}
