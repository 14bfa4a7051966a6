//! A limit to the vector width, for benchmarks and for tests that compare the widths of one machine.

use crate::Context;

pub use crate::exec::simd::WidthLimit;

/// A context whose calls use no wider vector instructions than `limit`. Results are the same for every width.
pub fn context(limit: WidthLimit) -> Context {
    let mut context = Context::new();
    context.set_width_limit(limit);
    context
}
