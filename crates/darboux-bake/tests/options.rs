//! Every option acts as its documentation says, and what is unusual is counted.

mod support;

use darboux::{Cancel, Choice, Context, Convention, Mesh};
use darboux_bake::{
    BakeError, BakeOptions, Bitangent, HighModelOptions, HighSurface, LowSurface, MapKind, MapSet, RayOrigin,
    TexelState, bake, inflated_cage,
};
use support::{PAIRS, Shape, baked};

/// The unit square as a plate in the plane z = 0, with its UVs times `scale`.
fn plate(scale: f32) -> Shape {
    let uvs = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].map(|uv: [f32; 2]| uv.map(|x| scale * x));
    Shape {
        positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 4],
        uvs: uvs.to_vec(),
        indices: vec![0, 1, 2, 0, 2, 3],
    }
}

/// The plate, raised by a height at x = 0 and by another at x = 1, without normals.
fn roof(at_zero: f32, at_one: f32) -> Shape {
    let mut roof = plate(1.0);
    roof.positions.iter_mut().for_each(|p| p[2] = if p[0] == 0.0 { at_zero } else { at_one });
    roof.normals.fill([0.0; 3]);
    roof
}

fn options(size: u32) -> BakeOptions {
    BakeOptions::new([size, size], [1.0, 1.0])
}

fn all_maps(size: u32) -> BakeOptions {
    options(size).with_maps(MapSet::of(MapKind::ALL)).with_occlusion(16, 10.0)
}

#[test]
fn every_map_of_a_roof_is_what_geometry_says() {
    let baked = baked(&plate(1.0), &roof(0.25, 0.75), &all_maps(8));
    let images = &baked.images;
    let leaning = [-1.0 / 5f32.sqrt(), 0.0, 2.0 / 5f32.sqrt()];
    let near = |a: &[f32], b: &[f32]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    for texel in 0..64 {
        let [x, y] = [texel % 8, 7 - texel / 8].map(|i| (i as f32 + 0.5) / 8.0);
        let height = 0.25 + 0.5 * x;
        assert!(near(&images.vectors(MapKind::Normal).expect("chosen")[texel], &leaning));
        assert!(near(&images.vectors(MapKind::ObjectNormal).expect("chosen")[texel], &leaning));
        assert!(near(&images.numbers(MapKind::Height).expect("chosen")[texel..=texel], &[height]));
        assert!(near(&images.numbers(MapKind::Occlusion).expect("chosen")[texel..=texel], &[1.0]));
        assert!(near(&images.vectors(MapKind::Position).expect("chosen")[texel], &[x, y, height]));
    }
    assert!(images.states.iter().all(|&state| state == TexelState::Baked));
    let report = baked.report;
    assert_eq!([report.texels, report.charted_texels, report.rays], [64; 3]);
    assert_eq!([report.missed_texels, report.overlapping_texels, report.inverted_texels], [0; 3]);
    assert_eq!([report.low_triangles, report.high_triangles], [2; 2]);
}

#[test]
fn the_bits_are_the_same_for_every_number_of_threads() {
    let pair = PAIRS[3];
    let (low, high) = (pair.low(12), pair.high(96));
    let tangents = low.tangents();
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    let options = all_maps(150).with_distance([0.1, 0.1]);
    let with = |threads| {
        let mut context = Context::new().with_max_threads(threads);
        bake(&[surface], &[high.high()], &options, &mut context, &mut |_| {}).expect("valid input")
    };
    let one = with(1);
    for threads in [2, 3, 16] {
        assert!(with(threads) == one, "{threads} threads");
    }
}

#[test]
fn the_distance_decides_what_rays_reach() {
    let high = roof(0.5, 0.5);
    let missed =
        |distance| baked(&plate(1.0), &high, &options(4).with_distance(distance)).report.missed_texels;
    assert_eq!([missed([0.6, 0.0]), missed([0.4, 1.0])], [0, 16]);
    let mut below = high.clone();
    below.positions.iter_mut().for_each(|p| p[2] = -0.5);
    let missed =
        |distance| baked(&plate(1.0), &below, &options(4).with_distance(distance)).report.missed_texels;
    assert_eq!([missed([0.0, 0.6]), missed([1.0, 0.4])], [0, 16]);
}

#[test]
fn the_outermost_surface_is_hit() {
    let mut two = roof(0.2, 0.2);
    two.positions.extend(roof(0.5, 0.5).positions);
    two.normals.extend([[0.0; 3]; 4]);
    two.indices.extend([4, 5, 6, 4, 6, 7]);
    let heights =
        baked(&plate(1.0), &two, &all_maps(4)).images.numbers(MapKind::Height).expect("chosen").to_vec();
    assert!(heights.iter().all(|height| (height - 0.5).abs() < 1e-6), "{heights:?}");
}

#[test]
fn back_faces_are_transparent_unless_asked_for() {
    let mut high = roof(0.25, 0.75);
    high.indices = vec![0, 2, 1, 0, 3, 2];
    let report = baked(&plate(1.0), &high, &options(4)).report;
    assert_eq!([report.missed_texels, report.back_facing_texels], [16; 2]);
    let both = baked(&plate(1.0), &high, &options(4).with_back_faces(true));
    let upright = baked(&plate(1.0), &roof(0.25, 0.75), &options(4));
    assert_eq!(both.report.missed_texels, 0);
    assert_eq!(both.images.vectors(MapKind::Normal), upright.images.vectors(MapKind::Normal));
}

#[test]
fn inverted_normals_are_counted() {
    let mut high = roof(0.25, 0.75);
    high.normals.fill([0.0, 0.0, -1.0]);
    let report = baked(&plate(1.0), &high, &options(4)).report;
    assert_eq!([report.inverted_texels, report.below_horizon_texels], [16; 2]);
}

#[test]
fn a_cage_has_no_gaps_at_hard_edges() {
    // A box without bottom, whose sides have normals of their own, under a larger box.
    let faces = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]];
    let cube = |size: f32| {
        let mut shape = Shape::default();
        for (face, normal) in faces.into_iter().enumerate() {
            let along = if normal[2] == 0.0 { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] };
            let across: [f32; 3] =
                support::cross(along.map(f64::from), normal.map(f64::from)).map(|x| x as f32);
            for [a, b] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0f32]] {
                shape.positions.push([0, 1, 2].map(|i| size * (normal[i] + a * across[i] + b * along[i])));
                shape.normals.push(normal);
                shape.uvs.push([(face as f32 + 0.5 + 0.45 * a) / 5.0, 0.5 - 0.45 * b]);
            }
            shape.indices.extend([0, 1, 2, 0, 2, 3].map(|i| 4 * face as u32 + i));
        }
        shape
    };
    let (low, high) = (cube(1.0), cube(1.2));
    let tangents = low.tangents();
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    let maps = MapSet::of(&[MapKind::Position]);
    let options = BakeOptions::new([320, 64], [0.4, 0.4]).with_maps(maps).with_padding(Some(0));
    let positions = |surface: LowSurface<'_>| {
        let baked = bake(&[surface], &[high.high()], &options, &mut Context::new(), &mut |_| {});
        baked.expect("valid input").images.vectors(MapKind::Position).expect("chosen").to_vec()
    };
    let reach =
        |positions: &[[f32; 3]]| positions.iter().fold(0f32, |most, p| most.max(p[0].abs().min(p[1].abs())));
    let straight = positions(surface);
    let cage = inflated_cage(&low.mesh(), 0.4).expect("triangles");
    let caged = positions(surface.with_cage(&cage).expect("one position per vertex"));
    // Straight rays end at the edge of the low box; those of the cage reach nearly the edge of the high one.
    assert!(reach(&straight) < 1.001 && reach(&caged) > 1.15, "{} {}", reach(&straight), reach(&caged));
}

#[test]
fn more_samples_smooth_edges() {
    let mut step = roof(0.0, 0.0);
    step.positions.iter_mut().for_each(|p| p[0] = p[0].max(0.37));
    let low = plate(1.0);
    let mut floor = plate(1.0);
    floor.positions.iter_mut().for_each(|p| p[2] = -0.5);
    floor.normals.fill([0.0; 3]);
    floor.positions.extend(step.positions);
    floor.normals.extend(step.normals);
    floor.indices.extend([4, 5, 6, 4, 6, 7]);
    let heights = |samples| {
        let options = all_maps(4).with_samples_per_axis(samples);
        baked(&low, &floor, &options).images.numbers(MapKind::Height).expect("chosen")[..4].to_vec()
    };
    // 0.37 lies at 0.48 of the second texel.
    assert_eq!(heights(1), [-0.5, 0.0, 0.0, 0.0]);
    let smooth = heights(16);
    assert!((smooth[1] + 0.25).abs() < 0.02, "{smooth:?}");
}

#[test]
fn conventions_turn_green_and_axes() {
    let mut tilted = roof(0.0, 0.0);
    tilted.positions.iter_mut().for_each(|p| p[2] = 0.5 * p[1]);
    let maps = MapSet::of(&[MapKind::Normal, MapKind::ObjectNormal]);
    let images = |convention| {
        baked(&plate(1.0), &tilted, &options(2).with_maps(maps).with_map_convention(convention)).images
    };
    let (gltf, unreal) = (images(Convention::GLTF), images(Convention::UNREAL));
    let normal = gltf.vectors(MapKind::Normal).expect("chosen")[0];
    // The roof rises to the top of the image, so its normal leans down, against glTF's green.
    assert!((normal[1] / normal[2] + 0.5).abs() < 1e-6);
    assert_eq!(unreal.vectors(MapKind::Normal).expect("chosen")[0], [normal[0], -normal[1], normal[2]]);
    let conversion = Convention::GLTF.to(Convention::UNREAL);
    assert_eq!(
        unreal.vectors(MapKind::ObjectNormal).expect("chosen")[0],
        conversion.vector(gltf.vectors(MapKind::ObjectNormal).expect("chosen")[0])
    );
}

#[test]
fn the_origin_of_uvs_turns_rows() {
    let low = plate(1.0);
    let mut flipped = low.clone();
    flipped.uvs.iter_mut().for_each(|uv| uv[1] = 1.0 - uv[1]);
    let high = roof(0.25, 0.75);
    let top = baked(&low, &high, &options(4)).images;
    let bottom = baked(&flipped, &high, &options(4).with_surface_convention(Convention::OPENGL)).images;
    assert_eq!(top.vectors(MapKind::Normal), bottom.vectors(MapKind::Normal));
}

#[test]
fn the_bitangent_per_vertex_is_another_map() {
    let pair = PAIRS[1];
    let (low, high) = (pair.low(8), pair.high(64));
    let with = |bitangent| {
        let options = BakeOptions::new([64, 64], [0.2, 0.2]).with_bitangent(bitangent);
        baked(&low, &high, &options).images.vectors(MapKind::Normal).expect("chosen").to_vec()
    };
    let [pixel, vertex] = [Bitangent::PerPixel, Bitangent::PerVertex].map(with);
    let largest = pixel.iter().zip(&vertex).map(|(a, b)| (a[1] - b[1]).abs()).fold(0.0, f32::max);
    assert!(largest > 1e-3, "{largest}");
}

#[test]
fn padding_fills_so_many_texels() {
    let low = plate(0.5);
    let high = roof(0.25, 0.75);
    let filled = |padding| {
        let images = baked(&low, &high, &options(16).with_padding(padding)).images;
        images.vectors(MapKind::Normal).expect("chosen").iter().filter(|normal| normal[0] != 0.0).count()
    };
    assert_eq!([filled(Some(0)), filled(None)], [64, 256]);
    // Two columns, two rows, and the one texel at the corner within a distance of 2.
    assert_eq!(filled(Some(2)), 64 + 16 + 16 + 1);
}

#[test]
fn missed_texels_are_filled_from_around() {
    let mut high = roof(0.25, 0.25);
    high.positions.iter_mut().for_each(|p| p[0] = p[0].max(0.5));
    let baked = baked(&plate(1.0), &high, &all_maps(4).with_padding(Some(0)));
    assert_eq!(baked.report.missed_texels, 8);
    assert!(
        baked
            .images
            .numbers(MapKind::Height)
            .expect("chosen")
            .iter()
            .all(|height| (height - 0.25).abs() < 1e-6)
    );
    assert_eq!(baked.images.states.iter().filter(|state| state.is_missed()).count(), 8);
}

#[test]
fn occlusion_is_dark_in_a_corner() {
    // A wall at x = 0 over the floor.
    let mut corner = plate(1.0);
    corner.normals.fill([0.0; 3]);
    corner.positions.extend([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 3.0], [0.0, 0.0, 3.0]]);
    corner.normals.extend([[0.0; 3]; 4]);
    corner.indices.extend([4, 5, 6, 4, 6, 7]);
    let open = |distance| {
        let options = all_maps(16).with_occlusion(256, distance);
        baked(&plate(1.0), &corner, &options).images.numbers(MapKind::Occlusion).expect("chosen").to_vec()
    };
    let far = open(10.0);
    let row = &far[8 * 16..9 * 16];
    // An endless wall beside a point hides half of the sky; this one hides less with every texel.
    assert!(row[0] > 0.5 && row[0] < 0.6, "{row:?}");
    assert!(row.windows(2).all(|pair| pair[1] >= pair[0] - 0.02) && row[15] > 0.75, "{row:?}");
    assert!(open(0.01)[8 * 16 + 3] == 1.0);
}

#[test]
fn groups_do_not_see_each_other() {
    let low = plate(1.0);
    let tangents = low.tangents();
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner").with_group(1);
    let (near, far) = (roof(0.5, 0.5), roof(0.2, 0.2));
    let highs = [near.high(), far.high().with_group(1)];
    let baked =
        bake(&[surface], &highs, &all_maps(2), &mut Context::new(), &mut |_| {}).expect("valid input");
    assert!((baked.images.numbers(MapKind::Height).expect("chosen")[0] - 0.2).abs() < 1e-6);
}

#[test]
fn unusual_uvs_are_handled_and_counted() {
    let high = roof(0.25, 0.75);
    // Twice the same chart: the first triangle owns the texels.
    let mut twice = plate(1.0);
    twice.indices.extend([0, 1, 2, 0, 2, 3]);
    let once = baked(&plate(1.0), &high, &options(8));
    let doubled = baked(&twice, &high, &options(8));
    assert_eq!(doubled.report.overlapping_texels, 64);
    assert_eq!(doubled.images.vectors(MapKind::Normal), once.images.vectors(MapKind::Normal));
    // A chart in another tile is moved into the image.
    let mut moved = plate(1.0);
    moved.uvs.iter_mut().for_each(|uv| *uv = [uv[0] - 3.0, uv[1] + 5.0]);
    assert_eq!(
        baked(&moved, &high, &options(8)).images.vectors(MapKind::Normal),
        once.images.vectors(MapKind::Normal)
    );
    // A chart over four tiles covers every texel four times.
    let tiled = baked(&plate(2.0), &high, &options(8)).report;
    assert_eq!([tiled.charted_texels, tiled.overlapping_texels], [64; 2]);
    let huge = baked(&plate(40.0), &high, &options(8)).report;
    assert_eq!([huge.oversized_triangles, huge.charted_texels], [2, 0]);
    let mut degenerate = plate(1.0);
    degenerate.uvs[1] = degenerate.uvs[2];
    assert_eq!(baked(&degenerate, &high, &options(8)).report.degenerate_triangles, 1);
    degenerate.uvs[0] = [f32::NAN, 0.0];
    assert_eq!(baked(&degenerate, &high, &options(8)).report.degenerate_triangles, 2);
    let far = baked(&plate(f32::MAX), &high, &options(8)).report;
    assert_eq!(far.oversized_triangles, 2);
}

#[test]
fn high_triangles_that_are_not_finite_are_counted() {
    let mut high = roof(0.25, 0.75);
    high.positions[3][0] = f32::INFINITY;
    let report = baked(&plate(1.0), &high, &options(8)).report;
    assert_eq!(report.non_finite_triangles, 1);
    assert!(report.missed_texels > 20 && report.missed_texels < 40);
}

#[test]
fn low_triangles_that_are_not_finite_are_counted_and_not_baked() {
    let high = roof(0.2, 0.2);
    let whole = baked(&plate(1.0), &high, &options(8)).report;
    let mut broken = plate(1.0);
    broken.positions[1][2] = f32::NAN;
    let report = baked(&broken, &high, &options(8)).report;
    assert_eq!(report.non_finite_low_triangles, 1);
    assert!(report.charted_texels < whole.charted_texels);
    assert_eq!(report.missed_texels, whole.missed_texels);
}

#[test]
fn wrong_options_and_surfaces_are_refused() {
    let (low, high) = (plate(1.0), roof(0.2, 0.2));
    let tangents = low.tangents();
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    let refused = |options: BakeOptions| {
        bake(&[surface], &[high.high()], &options, &mut Context::new(), &mut |_| {}).expect_err("refused")
    };
    let good = options(4);
    assert_eq!(refused(good.with_size([0, 4])), BakeError::Size { size: [0, 4] });
    assert_eq!(refused(good.with_size([4, 1 << 20])), BakeError::Size { size: [4, 1 << 20] });
    assert_eq!(refused(good.with_samples_per_axis(0)), BakeError::Samples { found: 0 });
    assert_eq!(refused(good.with_samples_per_axis(17)), BakeError::Samples { found: 17 });
    for distance in [[0.0, 0.0], [-1.0, 1.0], [f32::NAN, 1.0], [1.0, f32::INFINITY]] {
        assert!(matches!(refused(good.with_distance(distance)), BakeError::Distance { .. }));
    }
    assert_eq!(refused(good.with_maps(MapSet::default())), BakeError::NoMaps);
    let large = good.with_size([32768; 2]).with_memory_limit(Some(1 << 30));
    let error = refused(large);
    assert_eq!(error, BakeError::Memory { needed: (21 << 30) + 200, limit: Some(1 << 30) });
    assert!(
        error.to_string().contains("needs 21505 MiB of memory, which is more than the limit of 1024 MiB")
    );
    // The same without models, before they are read.
    let of_images = BakeError::Memory { needed: 21 << 30, limit: Some(1 << 30) };
    assert_eq!(large.check_memory(), Err(of_images));
    assert_eq!(large.with_memory_limit(None).check_memory(), Ok(()));
    let none = Shape::default();
    let tiled = plate(16.0);
    let surface_of_tiles = LowSurface::new(tiled.mesh(), &tangents).expect("one tangent per corner");
    let limited = good.with_memory_limit(Some(1 << 10));
    let error = bake(&[surface_of_tiles], &[high.high()], &limited, &mut Context::new(), &mut |_| {});
    let error = error.expect_err("refused");
    let of_tiles = 2 * 16 * 16 * 16;
    assert_eq!(error, BakeError::Memory { needed: 21 * 16 + 200 + of_tiles, limit: Some(1 << 10) });
    let options = options(4);
    let bake = |low: &[LowSurface<'_>], high: &[HighSurface<'_>]| {
        bake(low, high, &options, &mut Context::new(), &mut |_| {}).expect_err("refused")
    };
    assert_eq!(bake(&[], &[high.high()]), BakeError::NoLowTriangles);
    assert_eq!(bake(&[surface], &[none.high()]), BakeError::NoHighTriangles);
    assert!(matches!(LowSurface::new(low.mesh(), &[]), Err(BakeError::Mesh(_))));
    assert_eq!(
        surface.with_cage(&[[0.0; 3]; 3]).expect_err("refused"),
        BakeError::Cage { vertices: 4, found: 3 }
    );
    let quads =
        Mesh::with_faces(&low.positions, &low.normals, &low.uvs, &[0u32, 1, 2, 3], darboux::Faces::Quads);
    let quads = quads.expect("a valid mesh");
    assert_eq!(LowSurface::new(quads, &tangents[..4]).expect_err("refused"), BakeError::NotTriangles);
    assert_eq!(inflated_cage(&quads, 1.0).expect_err("refused"), BakeError::NotTriangles);
}

#[test]
fn a_run_can_be_cancelled_and_tells_its_progress() {
    let (low, high) = (plate(1.0), roof(0.2, 0.2));
    let tangents = low.tangents();
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    let cancel = Cancel::new();
    let mut context = Context::new().with_cancel(&cancel).with_max_threads(1);
    let mut told = Vec::new();
    let result = bake(&[surface], &[high.high()], &options(256), &mut context, &mut |progress| {
        told.push((progress.done, progress.total));
        if progress.done == 3 {
            cancel.cancel();
        }
    });
    assert_eq!(result.expect_err("cancelled"), BakeError::Mesh(darboux::Error::Cancelled));
    assert_eq!(told, [(1, 8), (2, 8), (3, 8)]);
}

/// What is wrong is told before models are read.
#[test]
fn options_are_checked_without_models() {
    for origin in [
        RayOrigin::Normals([-1.0, 1.0]),
        RayOrigin::InflatedCage(Some(0.0)),
        RayOrigin::AutoCage { share: 1.0, reach: None },
        RayOrigin::AutoCage { share: 0.001, reach: Some(f32::NAN) },
    ] {
        assert!(
            matches!(origin.check(), Err(BakeError::Distance { .. } | BakeError::Option { .. })),
            "{origin:?}"
        );
    }
    for origin in [
        RayOrigin::Normals([1.0, 0.0]),
        RayOrigin::InflatedCage(None),
        RayOrigin::AutoCage { share: 0.0, reach: None },
    ] {
        assert_eq!(origin.check(), Ok(()));
    }
    let place = || Some("occlusionTexture".to_owned());
    let high = HighModelOptions::default().with_maps(MapSet::of(&[MapKind::Normal]));
    assert_eq!(high.check(), Ok(()));
    assert_eq!(high.clone().with_texture(place()).check(), Err(BakeError::Texture { is_chosen: false }));
    let texture = high.with_maps(MapSet::of(&[MapKind::Texture]));
    assert_eq!(texture.check(), Err(BakeError::Texture { is_chosen: true }));
    assert_eq!(texture.with_texture(place()).check(), Ok(()));
}
