//! Meshes on which the reference takes quadratic time: every corner must have the reference's bits.
//!
//! Their times are measured by `cargo xtask bench --meshes fan,polar-fan,lone-degenerates,one-position`.

use darboux::{MikkTSpaceOptions, Mode, TangentOptions, generate_frames};
use darboux_tests::{OwnedMesh, assert_equal, engine, families};

fn lone_degenerates(cells: usize, count: usize) -> OwnedMesh {
    families::with_lone_degenerates(families::grid(cells, cells, false, false), count)
}

/// A polar fan whose triangles lie around its vertex in random order.
fn scattered_fan(count: usize) -> OwnedMesh {
    let mut mesh = families::fan(count, true);
    for (i, position) in mesh.positions.iter_mut().enumerate().skip(1) {
        let (y, x) = (i as f32 * 3.883_222).sin_cos();
        *position = [x, y, 0.0];
    }
    mesh
}

/// A fan whose members have one of four directions, some of them opposite.
fn bundled_fan(count: usize) -> OwnedMesh {
    let mut mesh = families::fan(count, true);
    for (i, position) in mesh.positions.iter_mut().enumerate().skip(1) {
        *position = [[2.0, 0.0, 0.0], [1.0, 1.0, 0.0], [-2.0, 0.0, 0.0], [-1.0, 3.0, 0.0]][i % 4];
    }
    mesh
}

/// A polar fan that goes around its vertex many times.
fn winding_fan(count: usize) -> OwnedMesh {
    let mut mesh = families::fan(count, true);
    for (i, position) in mesh.positions.iter_mut().enumerate().skip(1) {
        let (y, x) = (i as f32 * 0.0157).sin_cos();
        let radius = 1.0 + i as f32 / count as f32;
        *position = [radius * x, radius * y, 0.0];
    }
    mesh
}

/// A turning fan whose edges differ in length by a factor of 3,000, in space and in UV space.
fn uneven_fan(count: usize) -> OwnedMesh {
    let mut mesh = turning_fan(count);
    for (i, (position, uv)) in mesh.positions.iter_mut().zip(&mut mesh.uvs).enumerate().skip(1) {
        let [a, b] = [0.618_034, 0.414_214].map(|step| (8.0 * (i as f32 * step).fract() - 4.0).exp());
        *position = position.map(|x| a * x);
        *uv = uv.map(|x| b * x);
    }
    mesh
}

/// A turning fan whose normal is tilted and not of unit length.
fn tilted_fan(count: usize) -> OwnedMesh {
    let mut mesh = turning_fan(count);
    mesh.normals.fill([0.3, -0.2, 0.9]);
    mesh
}

/// A fan on a circle whose UVs turn by a pseudo-random angle from triangle to triangle: tangents in all
/// directions, many of them opposite.
fn turning_fan(count: usize) -> OwnedMesh {
    let mut mesh = families::fan(count, true);
    mesh.uvs[0] = [0.0; 2];
    let mut turn = 0.0f64;
    for (i, (position, uv)) in mesh.positions.iter_mut().zip(&mut mesh.uvs).enumerate().skip(1) {
        let (y, x) = (i as f64 / count as f64 * std::f64::consts::TAU).sin_cos();
        *position = [x as f32, y as f32, 0.0];
        let (v, u) = turn.sin_cos();
        *uv = [u as f32, v as f32];
        turn += (i as f64 * 0.754_877_666_246_692_8).fract() * 2.95;
    }
    mesh
}

fn assert_exact(what: &str, mesh: &OwnedMesh) {
    let expected = engine::reference(mesh, 180.0);
    let options = TangentOptions::from(MikkTSpaceOptions::new().with_mode(Mode::Reference));
    let found = generate_frames(&mesh.view(), &options).corners.into_per_corner();
    let found: Vec<_> = found.into_iter().map(Some).collect();
    assert_equal(what, mesh, 180.0, &expected, &found);
}

#[test]
fn small_ones_are_exact() {
    assert_exact("fan", &families::fan(1_000, false));
    assert_exact("polar fan", &families::fan(1_000, true));
    assert_exact("scattered fan", &scattered_fan(1_000));
    assert_exact("bundled fan", &bundled_fan(1_000));
    assert_exact("winding fan", &winding_fan(1_000));
    assert_exact("turning fan", &turning_fan(4_000));
    assert_exact("uneven fan", &uneven_fan(4_000));
    assert_exact("tilted fan", &tilted_fan(2_000));
    assert_exact("lone degenerates", &lone_degenerates(40, 500));
    assert_exact("one position", &families::unwelded_fan(1_000));
}

#[test]
#[ignore = "long: the reference takes minutes"]
fn large_ones_are_exact() {
    assert_exact("fan of 20,000", &families::fan(20_000, false));
    assert_exact("polar fan of 20,000", &families::fan(20_000, true));
    assert_exact("scattered fan of 20,000", &scattered_fan(20_000));
    assert_exact("winding fan of 20,000", &winding_fan(20_000));
    assert_exact("turning fan of 20,000", &turning_fan(20_000));
    assert_exact("uneven fan of 20,000", &uneven_fan(20_000));
    assert_exact("20,000 lone degenerates on a grid of 80,000", &lone_degenerates(200, 20_000));
    assert_exact("20,000 on one position", &families::unwelded_fan(20_000));
}
