//! Planes with every height field of the generator of normal maps: bricks, threads, letters and others.

mod support;

use std::io::Write;

use darboux::{Context, Convention, TexelLayout};
use darboux_bake::{BakeOptions, LowSurface, MapKind, NormalTexture, bake, verify};
use darboux_tests::maps::surfaces::Surface;
use support::Shape;

/// Texels per cell of the high meshes: enough for their smooth normals.
const TEXELS: u32 = 8;

/// The largest median error in degrees.
const MEDIAN: f64 = 0.05;

/// A plate of side 1 with heights of up to about 0.02, whose features are a fifth of the side wide.
fn height_field(surface: Surface, cells: usize) -> Shape {
    let at = |u: f64, v: f64| {
        let height = surface.height(7, 0.5, [u, v].map(|x| (5.0 * x) as f32));
        [u - 0.5, 0.5 - v, 0.02 * f64::from(height)]
    };
    let mut shape = Shape::grid(cells, false, |u, v| at(1.02 * u - 0.01, 1.02 * v - 0.01));
    // The normals of the mesh: those of the function differ where it has steps.
    let options = darboux::NormalOptions::new();
    let mesh = shape.mesh();
    let normals = darboux::generate_normals(mesh.positions(), mesh.indices(), mesh.faces(), &options);
    let normals = normals.expect("a valid mesh").corners.into_per_corner();
    let indices = shape.indices.clone();
    indices.iter().zip(normals).for_each(|(&vertex, normal)| shape.normals[vertex as usize] = normal);
    shape
}

/// The median error, in degrees, of a renderer that has the map in 16 bits.
fn median_error(surface: Surface, size: u32) -> f64 {
    let low = Shape::grid(8, false, |u, v| [u - 0.5, 0.5 - v, 0.0]);
    let high = height_field(surface, (size / TEXELS) as usize);
    let tangents = low.tangents();
    let lows = [LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner")];
    let highs = [high.high()];
    let options = BakeOptions::new([size; 2], [0.1, 0.1]);
    let baked = bake(&lows, &highs, &options, &mut Context::new(), &mut |_| {}).expect("valid input");
    assert_eq!(baked.report.missed_texels, 0, "{surface:?}");
    let layout = TexelLayout::<3>::RGB;
    let rounded = |normal: &[f32; 3]| layout.vector(layout.texel::<u16>(*normal));
    let texels = baked.images.vectors(MapKind::Normal).into_iter().flatten().map(rounded).collect();
    let map = NormalTexture::new([size; 2], texels, Convention::GLTF, Convention::GLTF).expect("a map");
    let errors = verify(&lows, &highs, &baked.images, &map, &options, &mut Context::new(), &mut |_| {});
    let errors = errors.expect("valid input").all;
    let line = format!("{surface:?} at {size}: median {:.4}, 99 % {:.4} degrees", errors.median, errors.p99);
    writeln!(std::io::stdout(), "{line}").expect("standard output");
    errors.median
}

#[test]
fn every_height_field_is_baked_right() {
    for surface in Surface::ALL {
        let median = median_error(surface, 512);
        assert!(median < MEDIAN, "{surface:?}: {median}");
    }
}

#[test]
#[ignore = "a minute: the numbers of docs/bake.md"]
fn every_height_field_is_baked_right_at_2048() {
    for surface in Surface::ALL {
        let median = median_error(surface, 2048);
        assert!(median < MEDIAN, "{surface:?}: {median}");
    }
}
