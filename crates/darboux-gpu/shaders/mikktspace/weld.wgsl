// Welds vertices: for each vertex, finds the first vertex with an equal position, normal and UV, compared as floats.
//
//     weld      inserts every vertex into a hash table with open addressing; a slot keeps the minimum of the equal vertices in it
//     look_up   reads the slot of every vertex
//
// A slot is claimed by an atomic compare-exchange and never released. So all equal vertices find the same slot in any order of threads.

@group(0) @binding(2) var<storage, read> vertices: array<u32>;
@group(0) @binding(3) var<storage, read_write> hash_slots: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> welded_vertex: array<u32>;
@group(0) @binding(5) var<storage, read_write> counts: Counts;

// A slot holds a vertex index plus one.
const EMPTY: u32 = 0u;
// 1e38: the reference does not weld positions above half of the largest float.
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

// The vertex with every -0 replaced by +0.
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

// Simple fractions have zeros in their low bits: the shifts mix the high bits into them.
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
    let vertex = thread_index(thread, groups);
    if vertex >= mesh.vertex_count {
        return;
    }
    let record = comparable(load(vertex));
    if largest(record) > LARGEST {
        atomicAdd(&counts.failure_count, 1u);
        return;
    }
    let mask = arrayLength(&hash_slots) - 1u;
    var at = hash(record) & mask;
    for (var probe = 0u; probe < MAX_ITERATIONS; probe++) {
        let held = atomicLoad(&hash_slots[at]);
        if held == EMPTY {
            if atomicCompareExchangeWeak(&hash_slots[at], EMPTY, vertex + 1u).exchanged {
                return;
            }
            // Another thread claimed the slot, or the exchange failed spuriously: read the slot again.
        } else if is_same(record, comparable(load(held - 1u))) {
            atomicMin(&hash_slots[at], vertex + 1u);
            return;
        } else {
            at = (at + 1u) & mask;
        }
    }
    atomicAdd(&counts.failure_count, 1u);
}

@compute @workgroup_size(WORKGROUP)
fn look_up(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let vertex = thread_index(thread, groups);
    if vertex >= mesh.vertex_count {
        return;
    }
    let own = load(vertex);
    let record = comparable(own);
    let mask = arrayLength(&hash_slots) - 1u;
    var at = hash(record) & mask;
    welded_vertex[vertex] = vertex;
    for (var probe = 0u; probe < MAX_ITERATIONS; probe++) {
        let held = atomicLoad(&hash_slots[at]);
        // This vertex could not be inserted.
        if held == EMPTY {
            return;
        }
        let first = load(held - 1u);
        if is_same(record, comparable(first)) {
            welded_vertex[vertex] = held - 1u;
            if !is_same(own, first) {
                atomicAdd(&counts.failure_count, 1u);
            }
            return;
        }
        at = (at + 1u) & mask;
    }
}
