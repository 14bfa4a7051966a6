// The items that are listed.

struct Unsure {
    groups: u32,
    rows: u32,
    layers: u32,
    count: u32,
    items: array<u32>,
}

@group(0) @binding(9) var<storage, read> unsure: Unsure;

fn is_left() -> bool {
    return false;
}

@compute @workgroup_size(WORKGROUP)
fn every_item(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var place = thread.x; place < unsure.count; place += groups.x * WORKGROUP) {
        run(unsure.items[place]);
    }
}
