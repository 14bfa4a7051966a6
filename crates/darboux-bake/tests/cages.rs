//! Where rays begin and in which direction they pass: cages that are made, skew correction, rays that cross.

mod support;

use darboux::{Context, Mesh};
use darboux_bake::{
    AutoCageOptions, BakeError, BakeOptions, Baked, ColorTexture, LowSurface, MapKind, MapSet,
    PreparedSurfaces, SkewCorrection, TexelState, auto_cage, bake, crossing_triangles, inflated_cage,
    inflated_cage_by,
};
use support::{PAIRS, Shape, baked};

/// A box with sides along the axes, whose faces have normals of their own.
fn cuboid(low: [f32; 3], high: [f32; 3]) -> Shape {
    let mut shape = Shape::default();
    for face in 0..6 {
        let (axis, is_far) = (face / 2, face % 2 == 1);
        let normal: [f32; 3] = std::array::from_fn(|i| {
            if i != axis {
                0.0
            } else if is_far {
                1.0
            } else {
                -1.0
            }
        });
        let (a, b) = if is_far { ((axis + 1) % 3, (axis + 2) % 3) } else { ((axis + 2) % 3, (axis + 1) % 3) };
        for [s, t] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0f32]] {
            let mut at = [0.0; 3];
            at[axis] = if is_far { high[axis] } else { low[axis] };
            at[a] = low[a] + s * (high[a] - low[a]);
            at[b] = low[b] + t * (high[b] - low[b]);
            shape.positions.push(at);
            shape.normals.push(normal);
            shape.uvs.push([(face as f32 + 0.05 + 0.9 * s) / 6.0, 0.05 + 0.9 * t]);
        }
        shape.indices.extend([0, 1, 2, 0, 2, 3].map(|i| 4 * face as u32 + i));
    }
    shape
}

fn joined(shapes: &[Shape]) -> Shape {
    let mut all = Shape::default();
    for shape in shapes {
        let first = all.positions.len() as u32;
        all.positions.extend(&shape.positions);
        all.normals.extend(&shape.normals);
        all.uvs.extend(&shape.uvs);
        all.indices.extend(shape.indices.iter().map(|index| first + index));
    }
    all
}

/// A crate with a bolt on its lid, which stands in the wood, and a handle above with a gap.
fn crate_with_handle() -> Shape {
    let wood = cuboid([-1.0; 3], [1.0; 3]);
    let bolt = cuboid([0.3, 0.3, 0.9], [0.5, 0.5, 1.1]);
    let handle = cuboid([-0.8, -0.1, 1.4], [0.8, 0.1, 1.6]);
    joined(&[wood, bolt, handle])
}

fn prepared<'a>(low: &'a Shape, tangents: &'a [[f32; 4]], high: &'a Shape) -> PreparedSurfaces<'a> {
    let surface = LowSurface::new(low.mesh(), tangents).expect("one tangent per corner");
    PreparedSurfaces::new(&[surface], &[high.high()], None, &Context::new()).expect("triangles")
}

/// The heights of a bake from an automatic cage, with the largest offset of the cage.
fn caged(low: &Shape, high: &Shape, options: &AutoCageOptions) -> (Baked, [f32; 2]) {
    let tangents = low.tangents();
    let mut context = Context::new();
    let surfaces = prepared(low, &tangents, high);
    let cage = auto_cage(&surfaces, options, &mut context).expect("valid options");
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    let surface = surface.with_cage(&cage.positions[0]).expect("one position per vertex");
    let surfaces = surfaces.with_low(&[surface], &context).expect("triangles");
    let maps = MapSet::of(&[MapKind::Height, MapKind::ObjectNormal]);
    let bake = BakeOptions::new([192, 32], [0.0, cage.inwards]).with_maps(maps);
    (surfaces.bake(&bake, &mut context, &mut |_| {}).expect("valid input"), cage.offsets)
}

#[test]
fn an_automatic_cage_has_bolts_and_no_handle() {
    let low = cuboid([-1.0; 3], [1.0; 3]);
    let options = AutoCageOptions::new(0.001, 0.8);
    let (baked, [least, most]) = caged(&low, &crate_with_handle(), &options);
    assert_eq!(baked.report.missed_texels, 0);
    // The cage of the lid rises above the bolt along the diagonals of its corners; that of the floor lies at
    // the margin.
    assert!((least - 0.016).abs() < 1e-4, "{least}");
    assert!((most - (0.1 * 3f32.sqrt() + 0.016)).abs() < 1e-3, "{most}");
    let heights = baked.images.numbers(MapKind::Height).expect("chosen");
    let highest = heights.iter().fold(0f32, |most, x| most.max(*x));
    assert!((0.0999..0.12).contains(&highest), "{highest}");
    // A large fixed offset has the handle on the lid.
    let cage = inflated_cage(&low.mesh(), 1.2).expect("triangles");
    let tangents = low.tangents();
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    let surface = surface.with_cage(&cage).expect("one position per vertex");
    let maps = MapSet::of(&[MapKind::Height]);
    let options = BakeOptions::new([192, 32], [0.0, 0.1]).with_maps(maps);
    let high = crate_with_handle();
    let wrong = bake(&[surface], &[high.high()], &options, &mut Context::new(), &mut |_| {});
    let wrong = wrong.expect("valid input").images;
    assert!(wrong.numbers(MapKind::Height).expect("chosen").iter().any(|&height| height > 0.5));
}

#[test]
fn an_automatic_cage_is_as_close_as_the_detail_allows() {
    for pair in PAIRS {
        let (low, high) = (pair.low(24), pair.high(96));
        let (baked, [least, most]) = caged(&low, &high, &AutoCageOptions::new(0.0, 0.2));
        assert_eq!(baked.report.missed_texels, 0, "{}", pair.name);
        // Detail is 0.01 to 0.02 high; chords of the low meshes lie up to 0.02 below, at the box's edges; the
        // margin is 0.004.
        assert!(least > 0.0 && most < 0.045, "{}: {least} {most}", pair.name);
    }
}

#[test]
fn an_automatic_cage_has_the_same_bits_for_every_number_of_threads() {
    let pair = PAIRS[1];
    let (low, high) = (pair.low(24), pair.high(96));
    let tangents = low.tangents();
    let surfaces = prepared(&low, &tangents, &high);
    let with = |threads| {
        let mut context = Context::new().with_max_threads(threads);
        auto_cage(&surfaces, &AutoCageOptions::new(0.01, 0.1), &mut context).expect("valid options")
    };
    let one = with(1);
    for threads in [2, 3, 16] {
        assert!(with(threads) == one, "{threads} threads");
    }
    let refuse = |share, reach| {
        auto_cage(&surfaces, &AutoCageOptions::new(share, reach), &mut Context::new()).expect_err("refused")
    };
    assert!(refuse(1.0, 0.1).to_string().contains("the share of rays that may change their hit is 1"));
    assert!(refuse(0.0, 0.0).to_string().contains("the largest offset of a cage is 0"));
}

/// A flat plate whose normals lean outwards, as those of the lid of a box with smooth edges.
fn smooth_plate() -> Shape {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0f32]];
    Shape {
        positions: corners.map(|[x, y]| [x, y, 0.0]).to_vec(),
        normals: corners.map(|[x, y]| [x, y, 1.0].map(|c| c / 3f32.sqrt())).to_vec(),
        uvs: corners.map(|[x, y]| [0.5 + 0.5 * x, 0.5 - 0.5 * y]).to_vec(),
        indices: vec![0, 1, 2, 0, 2, 3],
    }
}

/// A wide floor, at a depth.
fn floor(depth: f32) -> Shape {
    let corners = [[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0f32]];
    let mut floor = smooth_plate();
    floor.positions = corners.map(|[x, y]| [x, y, -depth]).to_vec();
    floor.normals = vec![[0.0, 0.0, 1.0]; 4];
    floor
}

/// The x of what the rays of the middle row hit.
fn row_of_hits(skew: Option<SkewCorrection<'_>>) -> Vec<f32> {
    let (low, high) = (smooth_plate(), floor(0.5));
    let tangents = low.tangents();
    let mut surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    if let Some(skew) = skew {
        surface = surface.with_skew_correction(skew).expect("fits");
    }
    let options = BakeOptions::new([16; 2], [0.1, 2.0]).with_maps(MapSet::of(&[MapKind::Position]));
    let baked = bake(&[surface], &[high.high()], &options, &mut Context::new(), &mut |_| {});
    let images = baked.expect("valid input").images;
    assert!(images.states.iter().all(|&state| state == TexelState::Baked));
    images.vectors(MapKind::Position).expect("chosen")[128..144].iter().map(|place| place[0]).collect()
}

#[test]
fn skew_correction_makes_rays_straight() {
    let x = |texel: usize| (texel as f32 + 0.5) / 8.0 - 1.0;
    let smooth = row_of_hits(None);
    // The direction leans by as much as the place is away from the middle, so that hits lie nearer to it by
    // half of that.
    assert!((smooth[0] - 0.5 * x(0)).abs() < 1e-3, "{smooth:?}");
    let is_straight =
        |hits: &[f32]| hits.iter().enumerate().all(|(texel, hit)| (hit - x(texel)).abs() < 1e-5);
    assert!(is_straight(&row_of_hits(Some(SkewCorrection::Everywhere(1.0)))));
    assert!(is_straight(&row_of_hits(Some(SkewCorrection::PerTriangle(&[1.0; 2])))));
    assert_eq!(row_of_hits(Some(SkewCorrection::Everywhere(0.0))), smooth);
    let half = row_of_hits(Some(SkewCorrection::Everywhere(0.5)));
    assert!(smooth[0] > half[0] && half[0] > x(0), "{half:?}");
    // Black to the left, white to the right.
    let texels = (0..16).map(|i| if i % 4 < 2 { [0, 0, 0, 255] } else { [255; 4] }).collect();
    let map = ColorTexture::new([4; 2], texels, false).expect("16 texels");
    let painted = row_of_hits(Some(SkewCorrection::Map(&map)));
    assert_eq!(painted[3], smooth[3]);
    assert!((painted[12] - x(12)).abs() < 1e-5, "{painted:?}");
}

#[test]
fn skew_corrections_that_do_not_fit_are_refused() {
    let low = smooth_plate();
    let tangents = low.tangents();
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    let refuse = |skew| surface.with_skew_correction(skew).expect_err("refused").to_string();
    assert!(refuse(SkewCorrection::Everywhere(1.5)).contains("a skew correction is 1.5"));
    assert!(refuse(SkewCorrection::PerTriangle(&[0.5])).contains("1 skew corrections were passed"));
    assert!(refuse(SkewCorrection::PerTriangle(&[0.5, f32::NAN])).contains("a skew correction is NaN"));
}

#[test]
fn rays_that_cross_are_counted() {
    // A groove whose walls' normals meet 1 above its floor.
    let mut groove = Shape::grid(8, false, |u, v| {
        let angle = std::f64::consts::PI * (1.0 - u);
        [angle.cos(), 2.0 * v, -angle.sin()]
    });
    groove.normals.iter_mut().zip(&groove.positions).for_each(|(normal, p)| *normal = [-p[0], 0.0, -p[2]]);
    let tangents = groove.tangents();
    let surface = LowSurface::new(groove.mesh(), &tangents).expect("one tangent per corner");
    assert_eq!(crossing_triangles(&[surface], 0.9), [0]);
    assert_eq!(crossing_triangles(&[surface], 1.1), [128]);
    let moved = |outwards: f32| {
        let moved = |(p, n): (&[f32; 3], &[f32; 3])| [0, 1, 2].map(|i| p[i] + outwards * n[i]);
        groove.positions.iter().zip(&groove.normals).map(moved).collect::<Vec<_>>()
    };
    let (near, far) = (moved(0.9), moved(1.1));
    let with = |cage| surface.with_cage(cage).expect("one position per vertex");
    assert_eq!(crossing_triangles(&[with(&near), with(&far)], 0.0), [0, 128]);
}

#[test]
fn each_vertex_can_have_its_own_offset() {
    let plate = smooth_plate();
    let mesh = Mesh::triangles(&plate.positions, &plate.normals, &plate.uvs, &plate.indices);
    let mesh = mesh.expect("a valid mesh");
    let cage = inflated_cage_by(&mesh, &[0.0, 0.1, 0.2, 0.3]).expect("one per vertex");
    let heights: Vec<f32> = cage.iter().map(|place| place[2]).collect();
    assert_eq!(heights, [0.0, 0.1, 0.2, 0.3]);
    let error = inflated_cage_by(&mesh, &[0.0]).expect_err("refused");
    assert_eq!(error, BakeError::Cage { vertices: 4, found: 1 });
    assert_eq!(baked(&plate, &floor(0.0), &BakeOptions::new([4; 2], [0.1; 2])).report.missed_texels, 0);
}
