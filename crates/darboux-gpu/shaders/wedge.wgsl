// What the corner of a triangle adds to the sums at its vertex: the triangle's derivatives in the plane of the vertex, times the angle of
// the corner there. The twin of `term` of the core's tangents/evaluate.rs.

fn angle_at(normal: V3, before: V3, here: V3, after: V3) -> Real {
    let edge_before = less(before, here);
    let edge_after = less(after, here);
    watch_vector(edge_before);
    watch_vector(edge_after);
    let to_before = direction_in_plane(normal, edge_before);
    let to_after = direction_in_plane(normal, edge_after);
    return angle(dotted(to_before, to_after));
}
