//! The colours of maps whose texels are labels, where there are many of them.

mod support;

use std::collections::HashSet;

use darboux::Context;
use darboux::internal::cancel_checks::{cancel_after, check_count};
use darboux_bake::{BakeError, BakeOptions, Baked, HighSurface, LowSurface, MapKind, MapSet, bake};
use support::Shape;

/// Charts per row, and rows of charts.
const SIDE: usize = 40;

/// A plate of squares, each a chart of its own that meets its neighbours in the image.
fn squares() -> Shape {
    let mut shape = Shape::default();
    for square in 0..SIDE * SIDE {
        let [x, y] = [square % SIDE, square / SIDE].map(|i| i as f32);
        for [right, up] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            let [u, v] = [x + right, y + up].map(|i| i / SIDE as f32);
            // Neighbours lie at different heights, so that they are not one chart.
            let height = 0.01 * (square % SIDE % 2 + 2 * (square / SIDE % 2)) as f32;
            shape.positions.push([u, v, height]);
            shape.normals.push([0.0, 0.0, 1.0]);
            shape.uvs.push([u, 1.0 - v]);
        }
        shape.indices.extend([0, 1, 2, 0, 2, 3].map(|corner| 4 * square as u32 + corner));
    }
    shape
}

fn baked(maps: MapSet, context: &mut Context) -> Result<Baked, BakeError> {
    let shape = squares();
    let tangents = shape.tangents();
    let low = LowSurface::new(shape.mesh(), &tangents).expect("a tangent per corner");
    let high = HighSurface::new(&shape.positions, None, &shape.indices).expect("a mesh");
    let options = BakeOptions::new([4 * SIDE as u32; 2], [0.1, 0.1]).with_maps(maps);
    bake(&[low], &[high], &options, context, &mut |_| {})
}

#[test]
fn many_charts_have_different_colours_for_every_number_of_threads() {
    let maps = MapSet::of(&[MapKind::UvIslands]);
    let of = |threads| baked(maps, &mut Context::new().with_max_threads(threads)).expect("not cancelled");
    let one = of(1);
    let (_, legend) = &one.legends[0];
    assert_eq!(
        legend.iter().map(|color| color.id as usize).collect::<Vec<_>>(),
        Vec::from_iter(0..SIDE * SIDE)
    );
    assert_eq!(legend.iter().map(|color| color.color).collect::<HashSet<_>>().len(), SIDE * SIDE);
    assert!(legend.iter().all(|color| color.texels == 16));
    for threads in 2..5 {
        assert!(of(threads) == one, "{threads} threads");
    }
}

#[test]
fn the_choice_of_colours_can_be_cancelled_at_every_chart() {
    let checks = |maps| {
        let cancel = cancel_after(usize::MAX);
        baked(maps, &mut Context::new().with_cancel(&cancel)).expect("not cancelled");
        check_count(&cancel)
    };
    let (without, all) =
        (checks(MapSet::of(&[MapKind::Wireframe])), checks(MapSet::of(&[MapKind::UvIslands])));
    assert!(all >= without + SIDE * SIDE, "{without} {all}");
    for limit in [without, without + SIDE * SIDE / 2, all - 1] {
        let cancelled =
            baked(MapSet::of(&[MapKind::UvIslands]), &mut Context::new().with_cancel(&cancel_after(limit)));
        assert_eq!(cancelled.expect_err("cancelled"), BakeError::Mesh(darboux::Error::Cancelled), "{limit}");
    }
}
