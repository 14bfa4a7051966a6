//! Adds what all triangles add, by all threads: scattered where the mesh's order is local, gathered where it is not.

use std::ops::Range;

use crate::exec::limits::RunLimits;
use crate::exec::threads::{self, split_range, split_slice};
use crate::tangents::mesh_slices::MeshSlices;
use crate::tangents::uv_derivatives::{Orientation, ScaledDerivatives};
use crate::tangents::vertex_sums::gather::gather_all;
use crate::tangents::vertex_sums::scatter::{scatter_all, thread_ranges};
use crate::tangents::vertex_sums::side_sums::SideSums;
use crate::tangents::vertex_sums::weighting::{Weighting, term};

/// Adds what all triangles add.
pub(crate) fn accumulate<const N: usize, W: Weighting<N>>(
    flat: &MeshSlices<'_>,
    limits: RunLimits<'_>,
    sums: &mut SideSums<N>,
) {
    let agreed = (!flat.is_triangles()).then(|| agreed_orientations::<N, W>(flat, limits));
    let how = (agreed.as_deref(), limits);
    match thread_ranges(flat, limits) {
        Some(list) => scatter_all::<N, W>(flat, how, &list, sums),
        None => gather_all::<N, W>(flat, how, sums),
    }
    if let Some(agreed) = agreed {
        sums.orientation_of_face = agreed;
    }
}

/// One orientation for each face: of the halves of a quad that add something the one with the larger UV area decides, the first
/// on a tie.
fn agreed_orientations<const N: usize, W: Weighting<N>>(
    flat: &MeshSlices<'_>,
    limits: RunLimits<'_>,
) -> Vec<Orientation> {
    let mut agreed = vec![Orientation::None; flat.face_count()];
    let threads = limits.thread_count(flat.triangles().len());
    let ranges = split_range(0..agreed.len(), threads, 1);
    let jobs = ranges.clone().zip(split_slice(&mut agreed, 0, ranges));
    threads::run(&mut vec![(); threads], jobs, |(), (faces, agreed)| agree_in::<N, W>(flat, faces, agreed));
    agreed
}

fn agree_in<const N: usize, W: Weighting<N>>(
    flat: &MeshSlices<'_>,
    faces: Range<usize>,
    agreed: &mut [Orientation],
) {
    let slices = flat.slices();
    let mut last = (0, 0.0);
    for t in flat.triangles_of(faces.clone()) {
        let (positions, uvs) = slices.refer(slices.triangles[t]);
        let derivatives = ScaledDerivatives::new(positions, uvs);
        let (face, area) = (flat.face(t) - faces.start, derivatives.area.abs());
        let is_larger = agreed[face] == Orientation::None || last.0 == face && area > last.1;
        if is_larger && term::<N, W>(&derivatives).is_some() {
            (agreed[face], last) = (Orientation::of(derivatives.area), (face, area));
        }
    }
}
