// The angle of a triangle's corner in the plane perpendicular to a normal, by which the corner's terms are weighted. As in the core's
// tangents/mikktspace/evaluate.rs.

// The edges of a triangle, from each corner to the next. The core subtracts in both directions; negation is exact, so the bits are the same.
fn edges_of(a: V3, b: V3, c: V3) -> array<V3, 3> {
    let edges = array<V3, 3>(subtract3(b, a), subtract3(c, b), subtract3(a, c));
    check_not_tiny3(edges[0]);
    check_not_tiny3(edges[1]);
    check_not_tiny3(edges[2]);
    return edges;
}

// The angle between the edge that arrives at a corner and the edge that leaves it.
fn angle_between(normal: V3, coming: V3, leaving: V3) -> Real {
    return angle(negate(dot3(direction_in_plane(normal, coming), direction_in_plane(normal, leaving))));
}
