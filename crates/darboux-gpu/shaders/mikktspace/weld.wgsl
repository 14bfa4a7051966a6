// Welding: vertices of equal position, normal and UV, as floats, become the one of them with the lowest number. The twin of the core's
// tangents/fans/weld.rs.
//
// `weld` puts every vertex into a hash table with open addresses. A slot is claimed by one atomic exchange and never given up, so equal
// vertices meet in one slot, whatever order threads come in, and leave there the lowest of their numbers. `look_up` reads it.

@group(0) @binding(2) var<storage, read> vertices: array<u32>;
@group(0) @binding(3) var<storage, read_write> slots: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> welded: array<u32>;
@group(0) @binding(5) var<storage, read_write> counts: Counts;

// A slot holds a vertex and one.
const EMPTY: u32 = 0u;
// 1e38: the reference does not weld positions from half of the largest float on.
const LARGEST: u32 = 0x7e967699u;

struct Record {
    position: vec3u,
    normal: vec3u,
    uv: vec2u,
}

fn load(vertex: u32) -> Record {
    let start = vertex * mesh.vertex_stride;
    let p = start + mesh.position;
    let n = start + mesh.normal;
    let t = start + mesh.uv;
    return Record(
        vec3u(vertices[p], vertices[p + 1u], vertices[p + 2u]),
        vec3u(vertices[n], vertices[n + 1u], vertices[n + 2u]),
        vec2u(vertices[t], vertices[t + 1u]),
    );
}

fn is_same(a: Record, b: Record) -> bool {
    return all(a.position == b.position) && all(a.normal == b.normal) && all(a.uv == b.uv);
}

// Without the signs of zeros.
fn comparable(record: Record) -> Record {
    let p = record.position;
    let n = record.normal;
    let t = record.uv;
    return Record(
        vec3u(without_sign_of_zero(p.x), without_sign_of_zero(p.y), without_sign_of_zero(p.z)),
        vec3u(without_sign_of_zero(n.x), without_sign_of_zero(n.y), without_sign_of_zero(n.z)),
        vec2u(without_sign_of_zero(t.x), without_sign_of_zero(t.y)),
    );
}

fn largest(record: Record) -> u32 {
    let p = record.position & vec3u(0x7fffffffu);
    let n = record.normal & vec3u(0x7fffffffu);
    let t = record.uv & vec2u(0x7fffffffu);
    let both = max(p, n);
    return max(max(max(both.x, both.y), both.z), max(t.x, t.y));
}

// Short fractions have their bits at the top: shifts bring them down.
fn hash(record: Record) -> u32 {
    let p = (record.position ^ (record.position >> vec3u(15u))) * vec3u(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du);
    let n = (record.normal ^ (record.normal >> vec3u(15u))) * vec3u(0x27d4eb2fu, 0x165667b1u, 0xd35a2d97u);
    let t = (record.uv ^ (record.uv >> vec2u(15u))) * vec2u(0xb55a4f09u, 0xa3b195c5u);
    let sum = p.x + p.y + p.z + n.x + n.y + n.z + t.x + t.y;
    let mixed = (sum ^ (sum >> 15u)) * 0x2c1b3c6du;
    return mixed ^ (mixed >> 14u);
}

@compute @workgroup_size(WORKGROUP)
fn weld(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let vertex = number_of_thread(thread, groups);
    if vertex >= mesh.vertex_count {
        return;
    }
    let record = comparable(load(vertex));
    if largest(record) > LARGEST {
        atomicAdd(&counts.refused, 1u);
        return;
    }
    let mask = arrayLength(&slots) - 1u;
    var at = hash(record) & mask;
    for (var turn = 0u; turn < MAX_TURNS; turn++) {
        let held = atomicLoad(&slots[at]);
        if held == EMPTY {
            if atomicCompareExchangeWeak(&slots[at], EMPTY, vertex + 1u).exchanged {
                return;
            }
            // Another vertex has it now, or the exchange failed for nothing: look again.
        } else if is_same(record, comparable(load(held - 1u))) {
            atomicMin(&slots[at], vertex + 1u);
            return;
        } else {
            at = (at + 1u) & mask;
        }
    }
    atomicAdd(&counts.refused, 1u);
}

@compute @workgroup_size(WORKGROUP)
fn look_up(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let vertex = number_of_thread(thread, groups);
    if vertex >= mesh.vertex_count {
        return;
    }
    let own = load(vertex);
    let record = comparable(own);
    let mask = arrayLength(&slots) - 1u;
    var at = hash(record) & mask;
    welded[vertex] = vertex;
    for (var turn = 0u; turn < MAX_TURNS; turn++) {
        let held = atomicLoad(&slots[at]);
        // Vertices that were refused are in no slot.
        if held == EMPTY {
            return;
        }
        let first = load(held - 1u);
        if is_same(record, comparable(first)) {
            welded[vertex] = held - 1u;
            if !is_same(own, first) {
                atomicAdd(&counts.refused, 1u);
            }
            return;
        }
        at = (at + 1u) & mask;
    }
}
