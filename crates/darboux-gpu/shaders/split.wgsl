// Splits vertices so that every vertex has one tangent. As in the core's split.rs: corners of one vertex whose tangents have the same bits
// share a vertex, and all NaNs are one value.
//
//     claim    inserts every corner into a hash table, as weld.wgsl does; a slot keeps the first corner of each vertex and tangent
//     find     looks up that first corner, and marks corners that need a new vertex
//     (a prefix sum of the marks numbers the new vertices, in the order of their first corners)
//     keep     writes the old vertices; the first tangent of a vertex keeps its old vertex
//     assign   writes the vertex of every corner, and the tangents

struct Split {
    corner_count: u32,
    vertex_count: u32,
}

@group(0) @binding(0) var<uniform> split: Split;
@group(0) @binding(1) var<storage, read> old_vertex_of_corner: array<u32>;
// Four words per corner.
@group(0) @binding(2) var<storage, read> tangent_of_corner: array<u32>;
// A slot holds a corner index plus one.
@group(0) @binding(3) var<storage, read_write> hash_slots: array<atomic<u32>>;
// The bitwise complement of the first corner of each old vertex; 0 for unused vertices.
@group(0) @binding(4) var<storage, read_write> first_of_vertex: array<atomic<u32>>;
// The first corner with the same vertex and tangent.
@group(0) @binding(5) var<storage, read_write> first_of_corner: array<u32>;
// 1 for corners that need a new vertex; then the number of such corners before each corner. The last element is the total.
@group(0) @binding(6) var<storage, read_write> number_of_corner: array<u32>;
@group(0) @binding(7) var<storage, read_write> counts: Counts;
@group(0) @binding(8) var<storage, read_write> vertex_of_corner: array<u32>;
@group(0) @binding(9) var<storage, read_write> source_of_vertex: array<u32>;
@group(0) @binding(10) var<storage, read_write> tangent_of_vertex: array<u32>;

const ONE: u32 = 0x3f800000u;
const NAN: u32 = 0x7fc00000u;
const NO_CORNER: u32 = 0u;

fn thread_index(thread: vec3u, groups: vec3u) -> u32 {
    return thread.x + thread.y * groups.x * WORKGROUP;
}

fn tangent(corner: u32) -> vec4u {
    let word = 4u * corner;
    let xy = vec2u(tangent_of_corner[word], tangent_of_corner[word + 1u]);
    return vec4u(xy, tangent_of_corner[word + 2u], tangent_of_corner[word + 3u]);
}

// The words by which tangents are told apart: all NaNs are equal.
fn distinct_tangent(corner: u32) -> vec4u {
    let words = tangent(corner);
    return select(words, vec4u(NAN), (words & vec4u(0x7fffffffu)) > vec4u(0x7f800000u));
}

fn hash(vertex: u32, tangent: vec4u) -> u32 {
    let products = (tangent ^ (tangent >> vec4u(15u))) * vec4u(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du, 0x27d4eb2fu);
    let sum = vertex * 0x165667b1u + products.x + products.y + products.z + products.w;
    let mixed = (sum ^ (sum >> 15u)) * 0x2c1b3c6du;
    return mixed ^ (mixed >> 14u);
}

fn is_same(a: u32, b: u32) -> bool {
    return old_vertex_of_corner[a] == old_vertex_of_corner[b] && all(distinct_tangent(a) == distinct_tangent(b));
}

@compute @workgroup_size(WORKGROUP)
fn claim(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let corner = thread_index(thread, groups);
    if corner >= split.corner_count {
        return;
    }
    let vertex = old_vertex_of_corner[corner];
    atomicMax(&first_of_vertex[vertex], ~corner);
    let mask = arrayLength(&hash_slots) - 1u;
    var at = hash(vertex, distinct_tangent(corner)) & mask;
    for (var probe = 0u; probe < MAX_ITERATIONS; probe++) {
        let held = atomicLoad(&hash_slots[at]);
        if held == NO_CORNER {
            if atomicCompareExchangeWeak(&hash_slots[at], NO_CORNER, corner + 1u).exchanged {
                return;
            }
        } else if is_same(corner, held - 1u) {
            atomicMin(&hash_slots[at], corner + 1u);
            return;
        } else {
            at = (at + 1u) & mask;
        }
    }
    atomicAdd(&counts.failure_count, 1u);
}

@compute @workgroup_size(WORKGROUP)
fn find(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let corner = thread_index(thread, groups);
    if corner >= split.corner_count {
        return;
    }
    let vertex = old_vertex_of_corner[corner];
    let mask = arrayLength(&hash_slots) - 1u;
    var at = hash(vertex, distinct_tangent(corner)) & mask;
    for (var probe = 0u; probe < MAX_ITERATIONS; probe++) {
        let held = atomicLoad(&hash_slots[at]);
        if held == NO_CORNER {
            return;
        }
        if is_same(corner, held - 1u) {
            first_of_corner[corner] = held - 1u;
            let is_first = held - 1u == corner;
            number_of_corner[corner] = u32(is_first && atomicLoad(&first_of_vertex[vertex]) != ~corner);
            return;
        }
        at = (at + 1u) & mask;
    }
}

fn store_tangent(vertex: u32, tangent: vec4u) {
    for (var k = 0u; k < 4u; k++) {
        tangent_of_vertex[4u * vertex + k] = tangent[k];
    }
}

// Initialises every old vertex, including unused ones.
@compute @workgroup_size(WORKGROUP)
fn keep(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let vertex = thread_index(thread, groups);
    if vertex < split.vertex_count {
        source_of_vertex[vertex] = vertex;
        store_tangent(vertex, vec4u(ONE, 0u, 0u, ONE));
    }
}

@compute @workgroup_size(WORKGROUP)
fn assign(@builtin(global_invocation_id) thread: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let corner = thread_index(thread, groups);
    if corner >= split.corner_count {
        return;
    }
    let old = old_vertex_of_corner[corner];
    let first = first_of_corner[corner];
    var vertex = old;
    if atomicLoad(&first_of_vertex[old]) != ~first {
        vertex = split.vertex_count + number_of_corner[first];
    }
    vertex_of_corner[corner] = vertex;
    if first == corner {
        source_of_vertex[vertex] = old;
        store_tangent(vertex, tangent(corner));
    }
}
