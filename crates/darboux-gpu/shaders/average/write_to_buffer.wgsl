// Writes frames into a separate buffer.

@group(0) @binding(2) var<storage, read> vertices: array<u32>;
@group(0) @binding(3) var<storage, read_write> frames: array<u32>;

fn store(word: u32, value: f32) {
    frames[word] = bitcast<u32>(value);
}
