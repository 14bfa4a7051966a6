// Checks whether welded vertices are still equal, and whether other vertices have become equal, which a hash table finds. One thread per
// vertex.

@group(0) @binding(1) var<storage, read> positions: array<u32>;
@group(0) @binding(2) var<storage, read> normals: array<u32>;
// The vertex that each vertex was welded with; NONE for unused vertices.
@group(0) @binding(4) var<storage, read> representatives: array<u32>;
// Two words per vertex, without -0.
@group(0) @binding(5) var<storage, read> uvs: array<u32>;
// A power of two of slots. A slot holds a vertex index plus one, or 0.
@group(0) @binding(6) var<storage, read_write> hash_slots: array<atomic<u32>>;

const WORDS: u32 = 8u;
// The bits of a bound, with a margin, above which the core does not weld.
const LARGE: u32 = 0x7e000000u;

struct Vertex {
    words: array<u32, WORDS>,
    is_small: bool,
}

fn item_count() -> u32 {
    return plan.vertex_count;
}

fn without_sign_of_zero(word: u32) -> u32 {
    return select(word, 0u, (word & ~SIGN) == 0u);
}

fn load(v: u32) -> Vertex {
    var vertex: Vertex;
    vertex.is_small = true;
    for (var axis = 0u; axis < 3u; axis++) {
        let position = positions[v * plan.position_stride + plan.position + axis];
        let normal = normals[v * plan.normal_stride + plan.normal + axis];
        vertex.words[axis] = without_sign_of_zero(position);
        vertex.words[3u + axis] = without_sign_of_zero(normal);
        vertex.is_small = vertex.is_small && (position & ~SIGN) < LARGE && !is_nan(normal);
    }
    vertex.words[6] = uvs[2u * v];
    vertex.words[7] = uvs[2u * v + 1u];
    return vertex;
}

fn are_equal_vertices(a: Vertex, b: Vertex) -> bool {
    var same = true;
    for (var word = 0u; word < WORDS; word++) {
        same = same && a.words[word] == b.words[word];
    }
    return same;
}

// The finaliser of MurmurHash3 (A. Appleby), word by word.
fn hash(vertex: Vertex) -> u32 {
    var mixed = 0u;
    for (var word = 0u; word < WORDS; word++) {
        mixed = (mixed ^ vertex.words[word]) * 0x85ebca6bu;
        mixed = (mixed ^ (mixed >> 13u)) * 0xc2b2ae35u;
        mixed ^= mixed >> 16u;
    }
    return mixed;
}

// Inserts a vertex. Returns false if an equal vertex is in the table, or if the probe sequence is too long.
fn insert(v: u32, vertex: Vertex) -> bool {
    let last = arrayLength(&hash_slots) - 1u;
    var place = hash(vertex) & last;
    for (var probe = 0u; probe < MAX_ITERATIONS; probe++) {
        let found = atomicCompareExchangeWeak(&hash_slots[place], 0u, v + 1u);
        if found.exchanged {
            return true;
        }
        if found.old_value != 0u {
            if are_equal_vertices(vertex, load(found.old_value - 1u)) {
                return false;
            }
            place = (place + 1u) & last;
        }
    }
    return false;
}

fn run(v: u32) {
    let representative = representatives[v];
    if representative == NONE {
        return;
    }
    let vertex = load(v);
    if !vertex.is_small || (representative != v && !are_equal_vertices(vertex, load(representative))) {
        atomicAdd(&changes.separated, 1u);
    } else if representative == v && !insert(v, vertex) {
        atomicAdd(&changes.merged, 1u);
    }
}
