// Moves the vertices of a flag. A real program would use skinning, morphing or a simulation.

@group(0) @binding(0) var<uniform> time: f32;
// Three floats per vertex.
@group(0) @binding(1) var<storage, read> at_rest: array<f32>;
// Twelve floats per vertex: position, normal, UV, tangent.
@group(0) @binding(2) var<storage, read_write> vertices: array<f32>;

@compute @workgroup_size(64)
fn wave(@builtin(global_invocation_id) thread: vec3u) {
    let v = thread.x;
    if v >= arrayLength(&at_rest) / 3u {
        return;
    }
    let x = at_rest[3u * v];
    let y = at_rest[3u * v + 1u];
    let phase = 3.0 * x + 0.9 * y - time;
    // The pole holds the edge at x = 0.
    let size = 0.42 * sqrt(x);
    vertices[12u * v] = x - 0.1 * size * sin(2.0 * phase);
    vertices[12u * v + 1u] = y - 0.06 * x * sin(0.5 * phase);
    vertices[12u * v + 2u] = size * sin(phase);
}
