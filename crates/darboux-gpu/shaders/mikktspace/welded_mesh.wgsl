// Reads the positions of a welded mesh. `indices` are the welded vertices of corners, NONE at degenerate triangles.

@group(0) @binding(2) var<storage, read> vertices: array<u32>;

const NONE: u32 = 0xffffffffu;
// Flags of triangles. The UV map keeps the orientation of the triangle.
const KEEPS_ORIENTATION: u32 = 1u;
// The triangle is UV-degenerate: it joins any group and has no term.
const UV_DEGENERATE: u32 = 2u;

fn vector_at(word: u32) -> V3 {
    return V3(real(vertices[word]), real(vertices[word + 1u]), real(vertices[word + 2u]));
}

fn load_position(start: u32) -> V3 {
    let found = vector_at(start + mesh.position);
    check_range3(found);
    return found;
}

fn item_count() -> u32 {
    return mesh.triangle_count;
}
