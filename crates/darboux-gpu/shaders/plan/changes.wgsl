// The counts of a check. See `PlanCheck::counts`.

struct Changes {
    collapsed: atomic<u32>,
    expanded: atomic<u32>,
    separated: atomic<u32>,
    merged: atomic<u32>,
    rotated: atomic<u32>,
}

@group(0) @binding(8) var<storage, read_write> changes: Changes;
