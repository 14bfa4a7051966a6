// Writes frames into the vertices themselves. No thread reads the words that any thread writes.

@group(0) @binding(2) var<storage, read_write> vertices: array<u32>;

fn store(word: u32, value: f32) {
    vertices[word] = bitcast<u32>(value);
}
