// Smooth normals: the mean of the normals of adjacent triangles, weighted by their angles (G. Thürmer and C. A. Wüthrich, "Computing Vertex
// Normals from Polygonal Facets", 1998). One thread per normal group: the vertices that shared a position and a normal in the planned mesh.

// The number of groups; the end of each group's range of members; the members, which are corners 3 t + k of triangles t.
@group(0) @binding(5) var<storage, read> normal_groups: array<u32>;
// Four words per group, of which the last is unused.
@group(0) @binding(6) var<storage, read_write> normal_of_group: array<u32>;

fn item_count() -> u32 {
    return normal_groups[0];
}

// The unit vector along `v`; zero if `v` is zero or not finite.
fn unit(v: vec3f) -> vec3f {
    let largest = max(max(abs(v.x), abs(v.y)), abs(v.z));
    if (bitcast<u32>(largest) & 0x7f800000u) == 0x7f800000u || !not_zero(largest) {
        return vec3f();
    }
    let scaled = v / largest;
    return scaled / sqrt(dot(scaled, scaled));
}

fn run(group: u32) {
    let members = 1u + normal_groups[0];
    var start = 0u;
    if group > 0u {
        start = normal_groups[group];
    }
    var total = vec3f();
    for (var place = start; place < normal_groups[group + 1u]; place++) {
        let corner = normal_groups[members + place];
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
    normal_of_group[4u * group] = bits_of(normal.x);
    normal_of_group[4u * group + 1u] = bits_of(normal.y);
    normal_of_group[4u * group + 2u] = bits_of(normal.z);
}
