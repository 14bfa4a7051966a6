//! Tiles of the UV plane have images of their own.

mod support;

use darboux::{Context, Convention};
use darboux_bake::{
    BakeError, BakeOptions, LowSurface, MapKind, MapSet, NormalTexture, PreparedSurfaces, Udim, udims_of,
};
use support::{PAIRS, Shape, baked};

fn udim(number: u32) -> Udim {
    Udim::from_number(number).expect("a number of a tile")
}

/// A shape with its chart moved by whole tiles: to the right, and downwards as in images.
fn moved(shape: &Shape, [column, row]: [f32; 2]) -> Shape {
    let mut moved = shape.clone();
    moved.uvs.iter_mut().for_each(|uv| *uv = [uv[0] + column, uv[1] + row]);
    moved
}

fn tiles(shape: &Shape, convention: Convention) -> Result<Vec<u32>, BakeError> {
    let tangents = shape.tangents();
    let low = LowSurface::new(shape.mesh(), &tangents).expect("one tangent per corner");
    udims_of(&[low], convention, None).map(|tiles| tiles.into_iter().map(Udim::number).collect())
}

#[test]
fn numbers_are_those_of_columns_and_rows() {
    let low = PAIRS[0].low(2);
    let in_tile = |place| tiles(&moved(&low, place), Convention::GLTF);
    assert_eq!(in_tile([0.0, 0.0]), Ok(vec![1001]));
    assert_eq!(in_tile([9.0, 0.0]), Ok(vec![1010]));
    assert_eq!(in_tile([3.0, -2.0]), Ok(vec![1024]));
    // Where v points up, rows count upwards.
    assert_eq!(tiles(&moved(&low, [3.0, 2.0]), Convention::BLENDER), Ok(vec![1024]));
    assert_eq!(in_tile([-1.0, 0.0]), Err(BakeError::NoUdim { tile: [-1, 0] }));
    assert_eq!(in_tile([10.0, 0.0]), Err(BakeError::NoUdim { tile: [10, 0] }));
    let message = in_tile([0.0, 1.0]).expect_err("below the first row").to_string();
    assert!(message.contains("0 to the right of the first and -1 above it"), "{message}");
    assert_eq!(
        [1000, 1001, 9990, 9991].map(|number| Udim::from_number(number).is_some()),
        [false, true, true, false]
    );
}

#[test]
fn only_tiles_with_an_area_count() {
    // A triangle over the diagonal of a square of four tiles does not cover the fourth.
    let mut low = PAIRS[0].low(1);
    low.uvs = vec![[0.1, 0.9], [1.9, 0.9], [0.1, -0.9], [0.1, 0.9]];
    low.indices = vec![0, 1, 2];
    assert_eq!(tiles(&low, Convention::GLTF), Ok(vec![1001, 1002, 1011]));
}

#[test]
fn a_tile_is_the_image_that_its_charts_alone_would_have() {
    let pair = PAIRS[0];
    let (low, high) = (pair.low(4), pair.high(32));
    let maps = [MapKind::Normal, MapKind::Height, MapKind::Occlusion, MapKind::UvIslands];
    let options = BakeOptions::new([40, 48], [0.1; 2]).with_maps(MapSet::of(&maps)).with_occlusion(4, 1.0);
    let alone = baked(&low, &high, &options);
    let mut both = moved(&low, [2.0, -1.0]);
    let first = both.positions.len() as u32;
    let next = moved(&low, [5.0, 0.0]);
    both.positions.extend(next.positions);
    both.normals.extend(next.normals);
    both.uvs.extend(next.uvs);
    both.indices.extend(next.indices.iter().map(|index| first + index));
    assert_eq!(tiles(&both, Convention::GLTF), Ok(vec![1006, 1013]));
    let tangents = both.tangents();
    let surface = LowSurface::new(both.mesh(), &tangents).expect("one tangent per corner");
    let mut context = Context::new();
    let prepared = PreparedSurfaces::new(&[surface], &[high.high()], None, &context).expect("triangles");
    for number in [1006, 1013] {
        let options = options.with_udim(Some(udim(number)));
        let tile = prepared.bake(&options, &mut context, &mut |_| {}).expect("valid input");
        assert_eq!(tile.report.overlapping_texels, 0);
        assert_eq!(tile.images.states, alone.images.states);
        for kind in [MapKind::Height, MapKind::Normal] {
            // UVs lose bits far from the origin.
            let pairs = tile.images.numbers(kind).into_iter().flatten();
            let farthest = pairs
                .zip(alone.images.numbers(kind).into_iter().flatten())
                .fold(0f32, |most, (a, b)| most.max((a - b).abs()));
            assert!(farthest < 1e-4, "{number} {kind:?}: {farthest}");
        }
        let normals = tile.images.vectors(MapKind::Normal).expect("chosen").to_vec();
        let written = NormalTexture::new([40, 48], normals, Convention::GLTF, Convention::GLTF);
        let written = written.expect("as many texels as the size says");
        let verified = prepared.verify(&tile.images, &written, &options, &mut context, &mut |_| {});
        let verified = verified.expect("the images have a normal map");
        assert!(verified.all.points > 1000 && verified.all.median < 0.5, "{:?}", verified.all);
    }
    let empty = options.with_udim(Some(udim(1001)));
    let empty = prepared.bake(&empty, &mut context, &mut |_| {}).expect("valid input");
    assert_eq!(empty.report.charted_texels, 0);
    let over = prepared.bake(&options, &mut context, &mut |_| {}).expect("valid input");
    assert_eq!(over.report.overlapping_texels, alone.report.charted_texels);
}
