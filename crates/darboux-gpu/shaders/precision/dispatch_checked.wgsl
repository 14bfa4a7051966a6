// Every item in turn; those that arithmetic is unsure of are listed, for the same work on words.

struct Unsure {
    // Groups of threads for the list, as an indirect dispatch takes them.
    groups: atomic<u32>,
    rows: u32,
    layers: u32,
    count: atomic<u32>,
    items: array<u32>,
}

@group(0) @binding(9) var<storage, read_write> unsure: Unsure;

fn is_left() -> bool {
    return is_unsure() || ALL_UNSURE;
}

@compute @workgroup_size(WORKGROUP)
fn every_item(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let item = thread.x + thread.y * groups.x * WORKGROUP;
    if item >= item_count() {
        return;
    }
    run(item);
    if is_left() {
        let place = atomicAdd(&unsure.count, 1u);
        if place % WORKGROUP == 0u && place / WORKGROUP < MAX_GROUPS {
            atomicAdd(&unsure.groups, 1u);
        }
        unsure.items[place] = item;
    }
}
