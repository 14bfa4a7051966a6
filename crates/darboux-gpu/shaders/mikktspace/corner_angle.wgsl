// What the corner of a triangle adds to the sums at its vertex: the triangle's derivatives in the plane of the vertex, times the angle of
// the corner there. The twin of `term` of the core's tangents/evaluate.rs.

// The edges of a triangle, from each corner to the next. The core takes both from each corner: what is turned round is so exactly.
fn edges_of(a: V3, b: V3, c: V3) -> array<V3, 3> {
    let edges = array<V3, 3>(less(b, a), less(c, b), less(a, c));
    watch_vector_from_below(edges[0]);
    watch_vector_from_below(edges[1]);
    watch_vector_from_below(edges[2]);
    return edges;
}

// Between the edge that comes to a corner and the one that leaves it.
fn angle_between(normal: V3, coming: V3, leaving: V3) -> Real {
    return angle(negated(dotted(direction_in_plane(normal, coming), direction_in_plane(normal, leaving))));
}
