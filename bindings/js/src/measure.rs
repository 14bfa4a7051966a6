//! `measureTangents`: the angles between two sets of tangents. `measureUvFidelity`: those between tangents
//! and the UVs.

use darboux::{measure_tangents as measure, measure_uv_fidelity as measure_fidelity};

use crate::arena::with_arena;
use crate::mesh_arrays::rows;

/// Compares the given tangents with as many other tangents. Returns the address of the numbers in the order
/// in which `measureTangents` of `lib/darboux.ts` reads them; last the number of worst corners, and each of
/// these with its angle.
#[unsafe(no_mangle)]
pub extern "C" fn measure_tangents() -> *const f64 {
    with_arena(|arena| {
        let extras = &mut arena.extras;
        let (given, other) = (rows(&extras.given_tangents), rows(&extras.other_tangents));
        let Ok(found) = measure(given, other) else { return std::ptr::null() };
        let counts = [found.corners, found.identical, found.sign_flips, found.without_angle];
        let numbers = &mut extras.numbers;
        numbers.clear();
        numbers.extend(counts.map(|count| count as f64));
        numbers.extend([found.mean, found.min, found.median, found.p95, found.max]);
        numbers.extend(found.histogram.map(|count| count as f64));
        numbers.push(found.worst.len() as f64);
        numbers.extend(found.worst.iter().flat_map(|&(corner, angle)| [corner as f64, angle]));
        numbers.as_ptr()
    })
}

/// Compares the given tangents with the derivatives of the UVs of the mesh. Returns the address of four
/// numbers in the order in which `measureUvFidelity` reads them; null where an index is out of range.
#[unsafe(no_mangle)]
pub extern "C" fn measure_uv_fidelity() -> *const f64 {
    with_arena(|arena| {
        let Some(mesh) = arena.vertices.mesh(&arena.surface) else { return std::ptr::null() };
        let extras = &mut arena.extras;
        let Ok(found) = measure_fidelity(&mesh, rows(&extras.given_tangents)) else {
            return std::ptr::null();
        };
        extras.numbers.clear();
        extras.numbers.extend([
            found.mean,
            found.root_mean_square,
            found.area,
            found.unmeasured_triangles as f64,
        ]);
        extras.numbers.as_ptr()
    })
}
