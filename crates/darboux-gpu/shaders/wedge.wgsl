// What the corner of a triangle adds to the sums at its vertex: the triangle's derivatives in the plane of the vertex, times the angle of
// the corner there. The twin of `term` of the core's tangents/evaluate.rs.

fn angle_at(normal: V3, before: V3, here: V3, after: V3) -> Real {
    let to_before = direction_in_plane(normal, less(before, here));
    let to_after = direction_in_plane(normal, less(after, here));
    return angle(dotted(to_before, to_after));
}
