// The items that are listed.

struct List {
    groups: u32,
    rows: u32,
    layers: u32,
    count: u32,
    items: array<u32>,
}

@group(0) @binding(9) var<storage, read> list: List;

fn is_left() -> bool {
    return false;
}

@compute @workgroup_size(WORKGROUP)
fn every_item(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var place = thread.x; place < list.count; place += groups.x * WORKGROUP) {
        run(list.items[place]);
    }
}
