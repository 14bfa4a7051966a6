//! `darboux convert`: converts normal maps and models between conventions.

pub mod arguments;
#[cfg(feature = "bake")]
mod space;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use darboux::{Convention, UvOrigin};
use darboux_io::FileKind;
use darboux_io::gltf::{ConversionSummary, Document, Progress, convert_vertices};
use darboux_io::image::{Channels, PngImage, convert_normal_map, count_invalid_normals};
use darboux_io::source::SourceFormat;
use darboux_io::words::Count;
use serde::Serialize;

use crate::batch::command::{FileCommand, ProcessedFile};
use crate::batch::plan::{Job, Output};
use crate::batch::report::{FileReport, Status};
use crate::documents::{left_out, load_any, read_stdin, save, save_image};
use crate::inputs::{Input, UsageError};
use crate::options::convention::NamedConvention;
use crate::options::files::FileOptions;
use crate::options::messages::MessageOptions;
use crate::paths::is_png;
use crate::regular_file::{Links, open_regular};
use crate::terminal::FileProgress;
use crate::text::counted;
use arguments::{ConvertArguments, SpaceChoice};

/// The report of a file, which is an image or a model.
#[derive(Default, Serialize)]
pub struct ConvertSummary {
    image: Option<ImageSummary>,
    model: Option<ConversionSummary>,
    warnings: Vec<String>,
}

/// The report of an image.
#[derive(Serialize)]
struct ImageSummary {
    width: u32,
    height: u32,
    bits: u32,
    /// The channels of the output.
    channels: &'static str,
    red_inverted: bool,
    green_inverted: bool,
    /// Whether the vector was moved to other channels.
    moved: bool,
    /// What a conversion to another space did.
    space: Option<SpaceSummary>,
}

/// The report of a conversion to another space.
#[derive(Serialize)]
struct SpaceSummary {
    /// `tangent` or `object`.
    to: &'static str,
    /// Texels that the charts of the model cover.
    charted_texels: u64,
    /// Texels that several triangles cover.
    overlapping_texels: u64,
    /// Texels without a tangent frame or a direction.
    invalid_texels: u64,
}

impl FileCommand for ConvertArguments {
    type Summary = ConvertSummary;
    type Totals = usize;

    const NAME: &'static str = "convert";
    const IMAGES: bool = true;

    fn suffix(&self) -> &str {
        match (self.space, &self.to) {
            (Some(space), _) => space_name(space),
            // Only the name of a preset becomes part of a file name.
            (None, Some(to)) if to.convention.names().any(|name| name == to.name) => &to.name,
            (None, _) => "converted",
        }
    }

    fn files(&self) -> &FileOptions {
        &self.files
    }

    fn messages(&self) -> &MessageOptions {
        &self.messages
    }

    fn check(&self) -> Result<(), UsageError> {
        match self.files.inputs.iter().find(|input| input.is_dir() && !self.only_format_changes()) {
            Some(folder) => Err(UsageError(format!(
                "{} is a folder, and not every image in it is a normal map; name the files instead",
                folder.display()
            ))),
            None if self.only_format_changes() => self.check_formats(),
            None if self.space.is_some() && self.to_layout.is_some() => Err(UsageError(
                "--to-layout cannot be used with --space; move channels in a second run".to_owned(),
            )),
            None if self.space.is_some() && self.layout.to_string().len() < 3 => Err(UsageError(
                "--space needs maps that store x, y and z; name three channels with --layout".to_owned(),
            )),
            None if self.space.is_some() && !cfg!(feature = "bake") => {
                Err(UsageError("--space is not in this build; install it with --features full".to_owned()))
            }
            None => Ok(()),
        }
    }

    fn options(&self) -> String {
        let Self { layout, to_layout, raw, space, model, uv_set, .. } = self;
        let [from, to] = self.conventions().map(|named| named.name);
        format!("{:?}", (from, to, layout, to_layout, raw, space, model, uv_set))
    }

    fn process(
        &self,
        job: &Job,
        progress: &FileProgress<'_>,
    ) -> Result<ProcessedFile<ConvertSummary>, String> {
        let sentence = |error: darboux_io::Error| error.to_string();
        let options = self.files.reading.load_options();
        match &job.input {
            Input::Stdin => {
                let (name, bytes) = (job.input.to_string(), read_stdin()?);
                if PngImage::is_png(&bytes) {
                    return self
                        .image(PngImage::from_bytes(&name, bytes, &options).map_err(sentence)?, &job.output);
                }
                if self.space.is_some() {
                    return Err(format!("{name}: --space converts normal maps; save it as a PNG first"));
                }
                self.model(
                    Document::from_bytes(&name, bytes, None, &options).map_err(sentence)?,
                    job,
                    progress,
                )
            }
            Input::File(path) if is_png(path) || starts_as_png(path) => {
                self.image(PngImage::open(path, &options).map_err(sentence)?, &job.output)
            }
            Input::File(path) if FileKind::of(path).is_some_and(FileKind::is_image) => {
                Err(format!("{}: only PNG images can be converted; save it as a PNG first", path.display()))
            }
            Input::File(path) if self.space.is_some() => {
                Err(format!("{}: --space converts normal maps; save it as a PNG first", path.display()))
            }
            Input::File(_) => self.model(load_any(&job.input, &self.files.reading)?, job, progress),
        }
    }

    fn lines(summary: &ConvertSummary) -> Vec<String> {
        let image = summary.image.iter().map(describe_image);
        image.chain(summary.model.iter().map(describe_model)).collect()
    }

    fn warnings(summary: &ConvertSummary) -> &[String] {
        &summary.warnings
    }

    fn count(changed: &mut usize, file: &FileReport<ConvertSummary>) {
        *changed += usize::from(file.status == Status::Written);
    }

    fn total(changed: &usize) -> String {
        format!("{} changed", counted(*changed, "file", "files"))
    }
}

impl ConvertArguments {
    fn image(&self, mut image: PngImage, output: &Output) -> Result<ProcessedFile<ConvertSummary>, String> {
        let sentence = |error: darboux_io::Error| error.to_string();
        let [from, to] = self.conventions().map(|named| named.convention);
        let conversion = from.to(to);
        let target = self.to_layout.unwrap_or(self.layout);
        let mut warnings: Vec<String> = Vec::new();
        let mut space = None;
        if let Some(to) = self.space {
            space = Some(self.convert_space(&mut image, to, &mut warnings)?);
        } else {
            warnings.extend(self.warning(&image));
            convert_normal_map(&mut image, &conversion, self.layout, target).map_err(sentence)?;
        }
        let (status, files_written) = save_image(&image, output, &self.files)?;
        let [width, height] = image.size();
        let summary = ImageSummary {
            width,
            height,
            bits: image.bits(),
            channels: image.channels(),
            red_inverted: space.is_none() && conversion.inverts_red(),
            green_inverted: space.is_none() && conversion.inverts_green(),
            moved: target != self.layout,
            space,
        };
        Ok(ProcessedFile {
            status,
            files_written,
            summary: ConvertSummary { image: Some(summary), warnings, ..Default::default() },
        })
    }

    /// Converts the vectors of an image to a space, with the frames of `--model`. Errors are one sentence
    /// each.
    #[cfg(not(feature = "bake"))]
    fn convert_space(
        &self,
        _image: &mut PngImage,
        _to: SpaceChoice,
        _warnings: &mut Vec<String>,
    ) -> Result<SpaceSummary, String> {
        Err("--space is not in this build".to_owned())
    }

    /// Errors: an input and an output of the same format, between which nothing changes; an image.
    fn check_formats(&self) -> Result<(), UsageError> {
        let FileOptions { inputs, output, out_dir, .. } = &self.files;
        let needs_conventions = [
            (self.space.is_some(), "--space"),
            (self.to_layout.is_some(), "--to-layout"),
            (self.layout != Channels::RGB, "--layout"),
            (self.raw, "--raw"),
        ];
        if let Some((_, option)) = needs_conventions.into_iter().find(|(is_given, _)| *is_given) {
            return Err(UsageError(format!("{option} needs conventions; name them with --from and --to")));
        }
        let changes = |input: &Path| {
            let kind = FileKind::of(input);
            let is_image = kind.is_some_and(FileKind::is_image);
            match output {
                Some(output) => !is_image && FileKind::of(output) != kind,
                None => {
                    let is_other = kind.is_some_and(|kind| kind.is_model() && !kind.is_gltf());
                    out_dir.is_some() && (input.is_dir() || is_other)
                }
            }
        };
        match inputs.iter().find(|input| !changes(input)) {
            None => Ok(()),
            Some(input) => Err(UsageError(format!(
                "{}: nothing would change; name its convention and the wanted one (--from and --to), or an \
                 output of another format (-o model.glb)",
                input.display()
            ))),
        }
    }

    /// Warns about an image that does not look like a normal map.
    fn warning(&self, image: &PngImage) -> Option<String> {
        let [width, height] = image.size();
        let (texels, odd) =
            (f64::from(width) * f64::from(height), count_invalid_normals(image, self.layout) as f64);
        (odd > 0.5 * texels).then(|| {
            let percent = (100.0 * odd / texels).round();
            let layout = self.layout;
            format!(
                "this does not look like a normal map: {percent} % of its texels hold no unit vector in \
                 {layout}"
            )
        })
    }

    fn model(
        &self,
        mut document: Document,
        job: &Job,
        progress: &FileProgress<'_>,
    ) -> Result<ProcessedFile<ConvertSummary>, String> {
        let [from, to] = self.conventions();
        if to.convention != Convention::GLTF && !self.raw {
            return Err(format!(
                "{}: what is written must be in glTF's convention; use --to gltf, or, for a .glb or .gltf \
                 and a program that uses its numbers as they are, --raw",
                job.input
            ));
        }
        let mut warnings = document.warnings().to_vec();
        let mut conversion = None;
        if !self.only_format_changes() {
            warnings.extend(turned_again(&from, &document));
            let mut on_progress = |Progress { done, total }: Progress| progress.set(done, total);
            let mut summary =
                convert_vertices(&mut document, from.convention, to.convention, &mut on_progress)
                    .map_err(|error| error.to_string())?;
            warnings.append(&mut summary.warnings);
            conversion = Some(summary);
        }
        if document.convention().map_err(|error| error.to_string())? != Convention::GLTF {
            warnings.push(format!(
                "the output is in the convention of {}: no viewer of glTF shows it correctly",
                to.name
            ));
        }
        warnings.extend(left_out(&document, &job.output)?);
        let (status, files_written) = save(&document, &job.output, &self.files, document.is_changed())?;
        let summary = ConvertSummary { model: conversion, warnings, ..ConvertSummary::default() };
        Ok(ProcessedFile { status, files_written, summary })
    }
}

/// A warning where the reader of a format has turned what `--from` turns again.
fn turned_again(from: &NamedConvention, document: &Document) -> Option<String> {
    let NamedConvention { convention, name } = from;
    let provenance = document.provenance()?;
    if provenance.format == SourceFormat::Fbx && *convention != Convention::GLTF {
        return Some(format!(
            "this FBX was turned to glTF's convention when it was read, and --from {name} turns it again; \
             unless that is wanted, use --from gltf"
        ));
    }
    let mut primitives = document.meshes().iter().flat_map(|mesh| &mesh.primitives);
    let has_uvs = primitives.any(|primitive| primitive.attributes.contains_key("TEXCOORD_0"));
    (has_uvs && convention.uv_origin != UvOrigin::TopLeft).then(|| {
        format!(
            "v points down since this file was read, and --from {name} turns it again; unless that is \
             wanted, add v0=top: --from {name},v0=top"
        )
    })
}

/// Whether the file starts with the PNG signature.
fn starts_as_png(path: &Path) -> bool {
    let mut first = [0; 8];
    let opened = open_regular(path, File::options().read(true), Links::Follow);
    opened.and_then(|mut file| file.read_exact(&mut first)).is_ok() && PngImage::is_png(&first)
}

fn space_name(space: SpaceChoice) -> &'static str {
    match space {
        SpaceChoice::Tangent => "tangent",
        SpaceChoice::Object => "object",
    }
}

fn describe_image(image: &ImageSummary) -> String {
    let ImageSummary { width, height, bits, channels, .. } = image;
    if let Some(SpaceSummary { to, charted_texels, .. }) = image.space {
        return format!(
            "{width} x {height}, {bits} bits, {channels}: {to} space, {} texels in charts",
            Count(charted_texels)
        );
    }
    let done = [
        (image.red_inverted, "red inverted"),
        (image.green_inverted, "green inverted"),
        (image.moved, "channels moved"),
    ];
    format!("{width} x {height}, {bits} bits, {channels}: {}", list_changes(done))
}

fn describe_model(model: &ConversionSummary) -> String {
    let done = [
        (model.axes_changed, "axes changed"),
        (model.uvs_flipped, "v inverted"),
        (model.faces_reversed, "winding reversed"),
        (model.tangents_changed, "tangents or their signs changed"),
    ];
    format!("{} changed: {}", counted(model.primitives, "primitive", "primitives"), list_changes(done))
}

/// Lists what was done.
fn list_changes<const N: usize>(done: [(bool, &str); N]) -> String {
    let done: Vec<&str> = done.into_iter().filter(|done| done.0).map(|done| done.1).collect();
    if done.is_empty() {
        "the conventions do not differ in anything it contains".to_owned()
    } else {
        done.join(", ")
    }
}
