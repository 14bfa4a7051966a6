//! Repeated calls with one context allocate nothing.

use std::alloc::System;

use darboux::{
    Context, Faces, Frame, Indices, Mesh, Method, Plan, TangentOptions, write_frames, write_tangents,
};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// The number of allocations of a call after the first: the least of several calls, because other threads may
/// start during one.
fn allocations_of(mut call: impl FnMut()) -> usize {
    call();
    let count = |_| {
        let region = Region::new(ALLOCATOR);
        call();
        let change = region.change();
        change.allocations + change.reallocations
    };
    (0..5).map(count).min().expect("five calls")
}

fn allocations(mesh: &Mesh<'_>) -> usize {
    let (mut context, mut tangents) = (Context::new(), vec![[0.0; 4]; mesh.corner_count()]);
    let options = TangentOptions::default();
    allocations_of(|| {
        _ = write_tangents(mesh, &options, &mut context, &mut tangents).expect("as many tangents")
    })
}

fn allocations_of_frames(mesh: &Mesh<'_>) -> usize {
    let (mut context, mut frames) = (Context::new(), vec![Frame::default(); mesh.corner_count()]);
    let options = TangentOptions::default();
    allocations_of(|| _ = write_frames(mesh, &options, &mut context, &mut frames).expect("as many frames"))
}

fn allocations_of_plan(mesh: &Mesh<'_>, method: Method) -> usize {
    let plan = Plan::new(mesh, &TangentOptions::from(method));
    let (mut context, mut tangents) = (Context::new(), vec![[0.0; 4]; mesh.corner_count()]);
    allocations_of(|| plan.write_tangents(mesh, &mut context, &mut tangents).expect("the same mesh"))
}

/// The only test of this program, because the allocations of others would be counted too.
#[test]
#[cfg_attr(small_limits, ignore = "all meshes are worth threads, and starting these allocates")]
fn none_for_a_plain_surface() {
    const SIDE: u32 = 40;
    let place = |vertex: u32| [(vertex % (SIDE + 1)) as f32, (vertex / (SIDE + 1)) as f32];
    let count = (SIDE + 1) * (SIDE + 1);
    let positions: Vec<[f32; 3]> =
        (0..count).map(place).map(|[x, y]| [x, y, (0.3 * x).sin() + (0.2 * y).cos()]).collect();
    let normals = vec![[0.0, 0.0, 1.0]; count as usize];
    let uvs: Vec<[f32; 2]> = (0..count).map(|vertex| place(vertex).map(|x| x / SIDE as f32)).collect();
    let quads = (0..count).filter(|vertex| vertex % (SIDE + 1) < SIDE && vertex / (SIDE + 1) < SIDE);
    let triangles = quads.flat_map(|a| [a, a + 1, a + SIDE + 2, a, a + SIDE + 2, a + SIDE + 1]);
    let indices: Vec<u32> = triangles.collect();
    let short: Vec<u16> = indices.iter().map(|&index| index as u16).collect();
    for indices in [Indices::U32(&indices), Indices::U16(&short)] {
        let mesh = Mesh::triangles(&positions, &normals, &uvs, indices).expect("a mesh");
        assert_eq!(allocations(&mesh), 0);
        assert_eq!(allocations_of_frames(&mesh), 0);
        assert_eq!(allocations_of_plan(&mesh, Method::default()), 0);
    }
    let mesh = Mesh::triangles(&positions, &normals, &uvs, &indices).expect("a mesh");
    assert_eq!(allocations_of_plan(&mesh, Method::AngleArea), 0);
    let of = |list: &[[f32; 3]]| indices.iter().map(|&at| list[at as usize]).collect::<Vec<_>>();
    let soup_uvs: Vec<[f32; 2]> = indices.iter().map(|&at| uvs[at as usize]).collect();
    let (soup_positions, soup_normals) = (of(&positions), of(&normals));
    let mesh =
        Mesh::triangles(&soup_positions, &soup_normals, &soup_uvs, Indices::Unindexed).expect("a mesh");
    assert_eq!(allocations(&mesh), 0);
    assert_eq!(allocations_of_plan(&mesh, Method::default()), 0);
    // Two triangles of a square are corners 0, 1, 2 and 0, 2, 3.
    let squares: Vec<u32> =
        indices.as_chunks().0.iter().flat_map(|&[a, b, c, .., d]: &[_; 6]| [a, b, c, d]).collect();
    let mesh =
        Mesh::with_faces(&positions, &normals, &uvs, Indices::U32(&squares), Faces::Quads).expect("a mesh");
    assert_eq!(allocations(&mesh), 0);
    assert_eq!(allocations_of_plan(&mesh, Method::default()), 0);
}
