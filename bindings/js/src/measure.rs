//! `measureTangents`: the angles between two sets of tangents.

use darboux::measure_tangents as measure;

use crate::arena::with_arena;
use crate::mesh_arrays::rows;

/// Compares the given tangents with the other tangents, of which there are as many. Returns the address of the numbers in the order in
/// which `measureTangents` of `lib/darboux.ts` reads them; last the number of worst corners, and each of these with its angle.
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
