//! Adds the terms of all triangles to the sums of their vertices, and decides the orientation of each quad.

use std::ops::Range;

use crate::exec::limits::RunLimits;
use crate::exec::threads::{self, split_range, split_slice};
use crate::tangents::methods::mesh_slices::MeshSlices;
use crate::tangents::methods::uv_derivatives::{Orientation, ScaledDerivatives};
use crate::tangents::methods::vertex_sums::blocks::BlockOptions;
use crate::tangents::methods::vertex_sums::scatter::{scatter_all, thread_ranges};
use crate::tangents::methods::vertex_sums::side_sums::SideSums;
use crate::tangents::methods::vertex_sums::weighting::{Weighting, term};

/// Computes all sums. The bits do not depend on the number of threads. The sums are unspecified after
/// cancellation.
pub(crate) fn accumulate<const N: usize, W: Weighting<N>>(
    slices: &MeshSlices<'_>,
    limits: RunLimits<'_>,
    sums: &mut SideSums<N>,
) {
    let of_face = (!slices.is_triangles()).then(|| face_orientations::<N, W>(slices, limits));
    let options = BlockOptions { orientation_of_face: of_face.as_deref(), limits };
    scatter_all::<N, W>(slices, options, &thread_ranges(slices, limits), sums);
    if let Some(of_face) = of_face {
        sums.orientation_of_face = of_face;
    }
}

/// The orientation of each face. The orientation of a quad is that of its half with the larger UV area, or of
/// the first half where both areas are equal. Skipped halves are ignored.
fn face_orientations<const N: usize, W: Weighting<N>>(
    slices: &MeshSlices<'_>,
    limits: RunLimits<'_>,
) -> Vec<Orientation> {
    let mut of_face = vec![Orientation::None; slices.face_count()];
    let threads = limits.thread_count(slices.triangles().len());
    let ranges = split_range(0..of_face.len(), threads, 1);
    let jobs = ranges.clone().zip(split_slice(&mut of_face, 0, ranges));
    threads::run(&mut vec![(); threads], jobs, |(), (faces, of_face)| {
        for part in limits.parts(faces.clone()) {
            let of_part = &mut of_face[part.start - faces.start..part.end - faces.start];
            set_orientations::<N, W>(slices, part, of_part);
        }
    });
    of_face
}

fn set_orientations<const N: usize, W: Weighting<N>>(
    slices: &MeshSlices<'_>,
    faces: Range<usize>,
    of_face: &mut [Orientation],
) {
    let inputs = slices.triangle_inputs();
    let mut last = (0, 0.0);
    for t in slices.triangles_of(faces.clone()) {
        let (positions, uvs) = inputs.values_of(inputs.triangles[t]);
        let derivatives = ScaledDerivatives::new(positions, uvs);
        let (face, area) = (slices.face(t) - faces.start, derivatives.area.abs());
        let is_larger = of_face[face] == Orientation::None || last.0 == face && area > last.1;
        if is_larger && term::<N, W>(&derivatives).is_some() {
            (of_face[face], last) = (Orientation::of(derivatives.area), (face, area));
        }
    }
}
