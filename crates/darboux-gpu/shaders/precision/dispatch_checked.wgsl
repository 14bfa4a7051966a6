// Entry point that runs every item, and appends the items that arithmetic is unsure of to a work list for the second pass.

struct Unsure {
    // The workgroups for the listed items: the arguments of an indirect dispatch.
    groups: atomic<u32>,
    rows: u32,
    layers: u32,
    count: atomic<u32>,
    items: array<u32>,
}

@group(0) @binding(9) var<storage, read_write> unsure: Unsure;

fn is_postponed() -> bool {
    return is_unsure() || ALL_UNSURE;
}

@compute @workgroup_size(WORKGROUP)
fn every_item(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let item = thread.x + thread.y * groups.x * WORKGROUP;
    if item >= item_count() {
        return;
    }
    run(item);
    if is_postponed() {
        let index = atomicAdd(&unsure.count, 1u);
        if index % WORKGROUP == 0u && index / WORKGROUP < MAX_GROUPS {
            atomicAdd(&unsure.groups, 1u);
        }
        unsure.items[index] = item;
    }
}
