// What a check counts.

struct Changes {
    collapsed: atomic<u32>,
    opened: atomic<u32>,
    parted: atomic<u32>,
    met: atomic<u32>,
    turned: atomic<u32>,
}

@group(0) @binding(8) var<storage, read_write> changes: Changes;
