// Frames go back into the vertices. Words that are written are read by nobody.

@group(0) @binding(2) var<storage, read_write> vertices: array<u32>;

fn store(word: u32, value: f32) {
    vertices[word] = bitcast<u32>(value);
}
