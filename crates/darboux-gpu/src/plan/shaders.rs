//! The WGSL files of the kernels of plans. Files with `Real` arithmetic are completed by
//! [`crate::device::precision::kernel_files`].

const UNIFORMS: &str = include_str!("../../shaders/plan/uniforms.wgsl");
const TRIANGLE: &str = include_str!("../../shaders/plan/triangle.wgsl");
const SUMS: &str = include_str!("../../shaders/plan/sums.wgsl");
const CHANGES: &str = include_str!("../../shaders/plan/changes.wgsl");

pub(crate) const TERMS: &[&str] = &[
    UNIFORMS,
    TRIANGLE,
    include_str!("../../shaders/mikktspace/corner_angle.wgsl"),
    include_str!("../../shaders/plan/terms.wgsl"),
];
pub(crate) const GATHER: &[&str] = &[UNIFORMS, SUMS, include_str!("../../shaders/plan/gather.wgsl")];
pub(crate) const REPAIR: &[&str] =
    &[UNIFORMS, TRIANGLE, SUMS, include_str!("../../shaders/plan/repair.wgsl")];
pub(crate) const CHECK_TRIANGLES: &[&str] =
    &[UNIFORMS, TRIANGLE, CHANGES, include_str!("../../shaders/plan/check_triangles.wgsl")];
pub(crate) const CHECK_VERTICES: &[&str] =
    &[UNIFORMS, CHANGES, include_str!("../../shaders/plan/check_vertices.wgsl")];
pub(crate) const NORMALS: &[&str] = &[UNIFORMS, TRIANGLE, include_str!("../../shaders/plan/normals.wgsl")];

/// Complete files: these kernels only copy words.
pub(crate) const WRITE_TANGENTS: &[&str] =
    &[UNIFORMS, include_str!("../../shaders/plan/write_tangents.wgsl")];
pub(crate) const WRITE_NORMALS: &[&str] = &[UNIFORMS, include_str!("../../shaders/plan/write_normals.wgsl")];
