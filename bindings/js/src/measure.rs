//! How far tangents are apart.

use darboux::measure_tangents as measure;

use crate::room::{rows, with};

/// Compares the given tangents with the others, which are as many: where the numbers lie, in the order of `measureTangents` in
/// `lib/darboux.ts`, and after them the worst corners, how many and then each with its angle.
#[unsafe(no_mangle)]
pub extern "C" fn measure_tangents() -> *const f64 {
    with(|room| {
        let values = &mut room.values;
        let Ok(found) = measure(rows(&values.given), rows(&values.others)) else { return std::ptr::null() };
        let counts = [found.corners, found.identical, found.sign_flips, found.without_angle];
        values.measures.clear();
        values.measures.extend(counts.map(|count| count as f64));
        values.measures.extend([found.mean, found.min, found.median, found.p95, found.max]);
        values.measures.extend(found.histogram.map(|count| count as f64));
        values.measures.push(found.worst.len() as f64);
        values.measures.extend(found.worst.iter().flat_map(|&(corner, angle)| [corner as f64, angle]));
        values.measures.as_ptr()
    })
}
