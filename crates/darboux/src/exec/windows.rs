//! Windows: consecutive triangles of the triangle list, and which vertices each window uses. Threads divide
//! the windows among themselves.

use std::ops::Range;

/// Triangles per window. Vertices are read before the first window that uses them, and finished after the
/// last.
pub(crate) const WINDOW: usize = if cfg!(small_limits) { 2 } else { 1024 };

/// The vertices of one window, and of the windows before and after it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Window {
    /// From the lowest vertex of the window to the highest.
    pub vertices: Range<u32>,
    /// The lowest vertex of this window and of all later ones.
    pub lowest_from_here: u32,
    /// The end of the vertices of this window and of all earlier ones.
    pub end_up_to_here: u32,
}

/// Computes the running minimum and maximum of the windows' vertices.
pub(crate) fn accumulate_bounds(windows: &mut [Window]) {
    let mut end = 0;
    for window in windows.iter_mut() {
        end = window.vertices.end.max(end);
        window.end_up_to_here = end;
    }
    let mut lowest = u32::MAX;
    for window in windows.iter_mut().rev() {
        lowest = window.vertices.start.min(lowest);
        window.lowest_from_here = lowest;
    }
}

/// What one thread does. No two threads write the same vertex or corner.
#[derive(Clone, Debug)]
pub(crate) struct Partition {
    /// The windows whose corners the thread writes.
    pub windows: Range<usize>,
    /// The end of the windows that the thread adds: it is behind the last window that uses one of the
    /// thread's vertices. Windows from `windows.end` on are added by two threads.
    pub end_window: usize,
    /// The vertices that the thread finishes: those whose first window is one of `windows`.
    pub vertices: Range<usize>,
}

/// Divides windows among `count` threads. `vertices`: the number of vertices.
pub(crate) fn partitions(
    windows: &[Window],
    vertices: usize,
    count: usize,
) -> impl Iterator<Item = Partition> {
    let used_before = move |window: usize| match window {
        0 => 0,
        _ if window == windows.len() => vertices,
        _ => windows[window - 1].end_up_to_here as usize,
    };
    let partition = move |at: usize| {
        let (start, end) = (windows.len() * at / count, windows.len() * (at + 1) / count);
        let own = used_before(start)..used_before(end);
        let later = windows[end..].iter().take_while(|window| (window.lowest_from_here as usize) < own.end);
        Partition { windows: start..end, end_window: end + later.count(), vertices: own }
    };
    (0..count).map(partition)
}

/// True when so many windows would be added twice that partitions are not worthwhile.
pub(crate) fn overlap_too_much(partitions: &[Partition], windows: &[Window]) -> bool {
    let added: usize =
        partitions.iter().map(|partition| partition.end_window - partition.windows.start).sum();
    cfg!(feature = "parallel") && partitions.len() > 1 && added > windows.len() * 5 / 4
}

/// The triangles of consecutive windows. `count`: the number of all triangles.
pub(crate) fn triangles_of(windows: Range<usize>, count: usize) -> Range<usize> {
    windows.start * WINDOW..(windows.end * WINDOW).min(count)
}

/// The triangles of every window. `count`: the number of all triangles.
pub(crate) fn windows_of(count: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count.div_ceil(WINDOW)).map(move |at| triangles_of(at..at + 1, count))
}
