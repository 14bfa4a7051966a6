// A mesh read through its welded vertices: here `indices` are the welded vertices of corners, NONE at degenerate triangles.

@group(0) @binding(2) var<storage, read> vertices: array<u32>;

const NONE: u32 = 0xffffffffu;
// What derivatives say of a triangle: the UV map keeps its orientation.
const PRESERVES: u32 = 1u;
// It is UV-degenerate: it goes with any group, and adds nothing.
const ANY: u32 = 2u;

fn vector_at(word: u32) -> V3 {
    return V3(real(vertices[word]), real(vertices[word + 1u]), real(vertices[word + 2u]));
}

fn load_position(start: u32) -> V3 {
    let found = vector_at(start + mesh.position);
    watch_vector(found);
    return found;
}

fn item_count() -> u32 {
    return mesh.triangle_count;
}
