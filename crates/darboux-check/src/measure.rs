//! The measurements, one file each. Rules read them from [`SurfaceFacts`](crate::facts::SurfaceFacts) and
//! [`Map`](map::Map).

pub mod arrangement;
pub mod closeness;
pub mod contradiction;
pub mod directions;
pub mod expected;
pub mod facet;
pub mod facets;
pub mod fit;
pub mod flattening;
pub mod hard_edges;
pub mod leaning;
pub mod map;
pub mod map_kind;
pub mod mesh_votes;
pub mod misreading;
pub mod other_axes;
pub mod outliers;
pub mod overlap;
pub mod padding;
pub mod recipe;
pub mod reordered;
pub mod reversal;
pub mod reversed;
pub mod seams;
pub mod storage;
pub mod texture_axes;
pub mod turned;
pub mod u_directions;
pub mod uv_rounding;
pub mod uv_scale;
pub mod values;
