//! Windows: stretches of the triangle list, and which vertices each uses. They tell what threads can do without each other.

use std::ops::Range;

/// Triangles per window: vertices are read when the first window that uses them begins, and finished when the last has ended.
pub(crate) const WINDOW: usize = if cfg!(small_limits) { 2 } else { 1024 };

/// A window's vertices, the lowest of all windows from it on, and the end of those of all up to it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Window {
    pub lowest: u32,
    pub end: u32,
    pub lowest_from_here: u32,
    pub end_up_to_here: u32,
}

/// Sets what windows know of those before and after them.
pub(crate) fn look_around(windows: &mut [Window]) {
    let mut end = 0;
    for window in windows.iter_mut() {
        end = window.end.max(end);
        window.end_up_to_here = end;
    }
    let mut lowest = u32::MAX;
    for window in windows.iter_mut().rev() {
        lowest = window.lowest.min(lowest);
        window.lowest_from_here = lowest;
    }
}

/// A part of a mesh for one thread, which shares nothing with the others while it runs.
#[derive(Clone, Debug)]
pub(crate) struct Share {
    /// The windows that it writes.
    pub windows: Range<usize>,
    /// The end of those that it adds: up to the last that uses one of its vertices. Those are added by two threads.
    pub until: usize,
    /// The vertices that it finishes: those met first in its windows.
    pub vertices: Range<usize>,
}

/// The shares of `count` threads, whose windows are as many.
pub(crate) fn shares(windows: &[Window], vertices: usize, count: usize) -> impl Iterator<Item = Share> {
    let met_before = move |window: usize| match window {
        0 => 0,
        _ if window == windows.len() => vertices,
        _ => windows[window - 1].end_up_to_here as usize,
    };
    let share = move |at: usize| {
        let (start, end) = (windows.len() * at / count, windows.len() * (at + 1) / count);
        let own = met_before(start)..met_before(end);
        let later = windows[end..].iter().take_while(|window| (window.lowest_from_here as usize) < own.end);
        Share { windows: start..end, until: end + later.count(), vertices: own }
    };
    (0..count).map(share)
}

/// True when threads would do the same so often that shares do not pay.
pub(crate) fn overlap(shares: &[Share], windows: &[Window]) -> bool {
    let added: usize = shares.iter().map(|share| share.until - share.windows.start).sum();
    cfg!(feature = "parallel") && shares.len() > 1 && added > windows.len() * 5 / 4
}

/// The triangles of windows, of `count` in all.
pub(crate) fn triangles_of(windows: Range<usize>, count: usize) -> Range<usize> {
    windows.start * WINDOW..(windows.end * WINDOW).min(count)
}

/// A range cut into windows.
pub(crate) fn windows_of(count: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count.div_ceil(WINDOW)).map(move |at| window(at, count))
}

/// The triangles of one window.
pub(crate) fn window(at: usize, count: usize) -> Range<usize> {
    at * WINDOW..((at + 1) * WINDOW).min(count)
}
