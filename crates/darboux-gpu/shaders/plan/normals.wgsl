// Smooth normals from positions: the mean of the triangles' around a vertex, weighted by their angles there (G. Thürmer and C. A. Wüthrich,
// "Computing Vertex Normals from Polygonal Facets", 1998). One thread per normal; vertices share those that were one on the mesh
// that was planned.

// The number of normals, where the members of each end, and the members: corners k of triangles t as 3 t + k.
@group(0) @binding(5) var<storage, read> fans: array<u32>;
// Four words each.
@group(0) @binding(6) var<storage, read_write> normal_of_fan: array<u32>;

fn item_count() -> u32 {
    return fans[0];
}

// A direction; zero where there is none.
fn unit(v: vec3f) -> vec3f {
    let largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if (bitcast<u32>(largest) & 0x7f800000u) == 0x7f800000u || !not_zero(largest) {
        return vec3f();
    }
    let scaled = v / largest;
    return scaled / sqrt(dot(scaled, scaled));
}

fn run(fan: u32) {
    let members = 1u + fans[0];
    var start = 0u;
    if fan > 0u {
        start = fans[fan];
    }
    var total = vec3f();
    for (var place = start; place < fans[fan + 1u]; place++) {
        let corner = fans[members + place];
        let vertices = load_triangle(corner / 3u).vertices;
        let k = corner % 3u;
        let here = load_position(vertices[k]);
        let after = unit(load_position(vertices[(k + 1u) % 3u]) - here);
        let before = unit(load_position(vertices[(k + 2u) % 3u]) - here);
        total += angle(dot(after, before)) * unit(cross(after, before));
    }
    var normal = unit(total);
    if all(normal == vec3f()) {
        normal = vec3f(0.0, 0.0, 1.0);
    }
    normal_of_fan[4u * fan] = word_of(normal.x);
    normal_of_fan[4u * fan + 1u] = word_of(normal.y);
    normal_of_fan[4u * fan + 2u] = word_of(normal.z);
}
