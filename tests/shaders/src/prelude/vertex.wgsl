// One triangle that covers the upper left half of the viewport.
@vertex
fn main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    return vec4f(select(-1.0, 1.0, vertex == 1u), select(1.0, -1.0, vertex == 2u), 0.0, 1.0);
}
