//! From faces to welded triangles with neighbours, in the order that mikktspace.c gives them.

pub(crate) mod corner_lookup;
pub(crate) mod edge_sort;
pub(crate) mod neighbours;
pub(crate) mod triangles;
pub(crate) mod triangulate;
pub(crate) mod weld;
