//! Parses and validates the source of every kernel with naga.

use crate::average::{self, Search};
use crate::device::kernel::shader_source;
use crate::device::precision::{Arithmetic, PassOrder, kernel_files};
use crate::device::prefix_sum::PREFIX_SUM_FILES;
use crate::mikktspace::passes::{CORNER_TERMS, DERIVATIVES, EVALUATE, Pass, VERTEX_PASSES, triangle_passes};
use crate::plan::shaders::{
    CHECK_TRIANGLES, CHECK_VERTICES, GATHER, NORMALS, REPAIR, TERMS, WRITE_NORMALS, WRITE_TANGENTS,
};
use crate::split::SPLIT_FILES;

fn validate(files: &[&str]) {
    let source = shader_source(files);
    let module = naga::front::wgsl::parse_str(&source)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(&source)));
    let mut validator = naga::valid::Validator::new(Default::default(), naga::valid::Capabilities::empty());
    validator.validate(&module).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&source)));
}

#[test]
fn shaders_of_averages_splits_and_prefix_sums_are_valid() {
    for search in [Search::BruteForce, Search::Adjacency] {
        average::all_shader_files(search).iter().for_each(|files| validate(files));
    }
    validate(PREFIX_SUM_FILES);
    validate(SPLIT_FILES);
    validate(&[
        "fn opaque_zero() -> u32 { return 0u; }",
        include_str!("../../shaders/precision/device_floats.wgsl"),
        include_str!("../../shaders/precision/correct_rounding.wgsl"),
        include_str!("../../shaders/precision/uint64.wgsl"),
        include_str!("../../shaders/precision/soft_float.wgsl"),
        include_str!("../../shaders/precision/arccosine.wgsl"),
    ]);
}

#[test]
fn shaders_of_passes_are_valid() {
    for pass in [VERTEX_PASSES, &triangle_passes()].concat() {
        match pass {
            Pass::Run(run) | Pass::RunExact(_, run) => validate(run.kernel.files),
            Pass::Clear(_) | Pass::Scan(..) => {}
        }
    }
}

#[test]
fn shaders_are_valid_in_every_arithmetic() {
    use Arithmetic::{Exact, Fast, HostileDevice, SoftFloat};
    for arithmetic in [Exact, SoftFloat, HostileDevice, Fast] {
        for own in [DERIVATIVES.files, CORNER_TERMS.files, EVALUATE.files, TERMS, GATHER] {
            validate(&kernel_files(arithmetic, PassOrder::First, own));
            validate(&kernel_files(arithmetic, PassOrder::Second, own));
        }
    }
    validate(&kernel_files(Fast, PassOrder::Second, REPAIR));
    for own in [CHECK_TRIANGLES, CHECK_VERTICES, NORMALS] {
        validate(&kernel_files(Fast, PassOrder::First, own));
    }
    validate(WRITE_TANGENTS);
    validate(WRITE_NORMALS);
}
