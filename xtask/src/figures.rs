//! `docs/learn/figures/*.svg`: the figures of the lessons, drawn from numbers that are computed here.
//!
//! Each figure carries its own colours for light and dark pages, a title and a description for readers who cannot see it. Tangents,
//! bitangents and normals have colours that colour-blind readers can tell apart, and each arrow is labelled as well.

mod averaging;
mod beyond;
mod colours;
mod derivatives;
mod drawing;
mod memory;
mod mirroring;
mod plane;
mod shading;

use std::fs;
use std::path::Path;

use crate::run::Outcome;
use drawing::Figure;

/// Below the repository's root. The folder holds nothing else.
pub const FOLDER: &str = "docs/learn/figures";

/// The name of a figure's file without `.svg`, and the function that draws it.
type FigureFile = (&'static str, fn() -> Figure);

/// All figures.
const FIGURES: &[FigureFile] = &[
    ("texel", colours::texel),
    ("object-or-tangent", colours::object_or_tangent),
    ("uv-to-surface", derivatives::uv_to_surface),
    ("determinant", derivatives::determinant),
    ("shared-edge", averaging::shared_edge),
    ("gram-schmidt", averaging::gram_schmidt),
    ("two-bitangents", averaging::two_bitangents),
    ("mirrored-seam", mirroring::mirrored_seam),
    ("green-channel", mirroring::green_channel),
    ("weights", averaging::weights),
    ("groups", mirroring::groups),
    ("matrix-columns", shading::matrix_columns),
    ("non-uniform-scale", shading::non_uniform_scale),
    ("interpolated-vectors", shading::interpolated_vectors),
    ("skinned-frames", shading::skinned_frames),
    ("scatter-gather", memory::scatter_gather),
    ("vertex-layout", memory::vertex_layout),
    ("brute-force", memory::brute_force),
    ("anisotropy", beyond::anisotropy),
    ("triplanar", beyond::triplanar),
    ("detail-normals", beyond::detail_normals),
    ("displacement", beyond::displacement),
    ("parallax", beyond::parallax),
];

/// Writes all figures below `into`.
pub fn write(into: &Path) -> Outcome {
    let folder = into.join(FOLDER);
    fs::create_dir_all(&folder).map_err(|error| format!("{} cannot be made: {error}", folder.display()))?;
    for (name, draw) in FIGURES {
        let path = folder.join(format!("{name}.svg"));
        fs::write(&path, draw().text())
            .map_err(|error| format!("{} cannot be written: {error}", path.display()))?;
    }
    Ok(())
}
