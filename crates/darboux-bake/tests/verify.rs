//! The verification finds what is wrong with a map, and by how much.

mod support;

use std::io::Write;

use darboux::{Context, Convention, Mesh, Method, TexelLayout, generate_tangents};
use darboux_bake::{
    BakeError, BakeOptions, BakeProgress, Baked, Bitangent, ErrorStatistics, HighSurface, LowSurface,
    MapKind, Mistake, NormalTexture, Verification, VerifiedPlace, bake, check_verification, verify,
};
use darboux_io::image::srgb_to_linear;
use support::{PAIRS, Shape, unit};

const SIZE: u32 = 128;

/// A pair of shapes, with its bake and what verifies it.
struct Bench {
    low: Shape,
    high: Shape,
    options: BakeOptions,
}

impl Bench {
    fn new(pair: usize) -> Self {
        let pair = PAIRS[pair];
        let options = BakeOptions::new([SIZE; 2], [0.1, 0.1]);
        Self { low: pair.low(16), high: pair.high(150), options }
    }

    fn bake(&self) -> Baked {
        let tangents = self.low.tangents();
        let low = LowSurface::new(self.low.mesh(), &tangents).expect("one tangent per corner");
        let baked = bake(&[low], &[self.high.high()], &self.options, &mut Context::new(), &mut |_| {});
        baked.expect("valid input")
    }

    /// Verifies the bake's map after a change of its texels.
    fn verified(&self, baked: &Baked, change: impl Fn([f32; 3]) -> [f32; 3]) -> Verification {
        self.shown(baked, &self.low, &self.low.tangents(), change)
    }

    /// As [`Bench::verified`], with the mesh and the tangents of a renderer.
    fn shown(
        &self,
        baked: &Baked,
        low: &Shape,
        tangents: &[[f32; 4]],
        change: impl Fn([f32; 3]) -> [f32; 3],
    ) -> Verification {
        let low = LowSurface::new(low.mesh(), tangents).expect("one tangent per corner");
        let texels =
            baked.images.vectors(MapKind::Normal).into_iter().flatten().map(|&texel| change(texel)).collect();
        let written =
            NormalTexture::new(self.options.size, texels, self.options.map_convention, Convention::GLTF);
        let written = written.expect("a texture");
        let high = [self.high.high()];
        verify(&[low], &high, &baked.images, &written, &self.options, &mut Context::new(), &mut |_| {})
            .expect("valid input")
    }
}

fn of_place(verification: &Verification, place: VerifiedPlace) -> ErrorStatistics {
    verification.places.iter().find(|(other, _)| *other == place).expect("every place").1
}

fn of_mistake(verification: &Verification, mistake: Mistake) -> ErrorStatistics {
    verification.mistakes.iter().find(|(other, _)| *other == mistake).expect("every mistake").1
}

fn to_8_bits(texel: [f32; 3]) -> [f32; 3] {
    let layout = TexelLayout::<3>::RGB;
    layout.vector(layout.texel::<u8>(texel))
}

#[test]
fn a_good_map_has_the_error_of_its_resolution_and_of_its_bits() {
    for pair in 0..3 {
        let bench = Bench::new(pair);
        let baked = bench.bake();
        let exact = bench.verified(&baked, |texel| texel);
        assert!(exact.all.median < 0.1 && exact.all.p95 < 0.5, "{:?}", exact.all);
        assert_eq!(exact.rounding.worst, 0.0);
        assert_eq!(exact.points_without_frame, 0);
        let coarse = bench.verified(&baked, to_8_bits);
        // The median error of 8 bits is 0.108 degrees (see the test of the limit of 8 bits).
        assert!((0.09..0.13).contains(&coarse.rounding.median), "{:?}", coarse.rounding);
        assert!(coarse.all.median > exact.all.median);
        let sum: u64 = exact.places.iter().map(|(_, of)| of.points).sum();
        assert_eq!(sum, exact.all.points);
        assert!(of_place(&exact, VerifiedPlace::Border).points > 0);
        assert_eq!(of_place(&exact, VerifiedPlace::Overlap).points, 0);
        let hot = exact.heat.iter().filter(|error| error.is_finite()).count();
        assert_eq!((exact.heat_size, hot as u64), ([SIZE; 2], exact.all.points));
    }
}

#[test]
fn of_surfaces_that_lie_over_each_other_64_are_compared() {
    let (low, high) = (PAIRS[0].low(4), PAIRS[0].high(16));
    let bench = Bench { low, high, options: BakeOptions::new([32; 2], [0.1; 2]) };
    let tangents = bench.low.tangents();
    let low = LowSurface::new(bench.low.mesh(), &tangents).expect("one tangent per corner");
    let texels = bench.bake().images.vectors(MapKind::Normal).expect("chosen").to_vec();
    let written =
        NormalTexture::new(bench.options.size, texels, bench.options.map_convention, Convention::GLTF)
            .expect("a texture");
    let points = |copies: usize| {
        let (low, high, context) = (vec![low; copies], [bench.high.high()], &mut Context::new());
        let baked = bake(&low, &high, &bench.options, context, &mut |_| {}).expect("valid input");
        let verified = verify(&low, &high, &baked.images, &written, &bench.options, context, &mut |_| {});
        let verified = verified.expect("valid input");
        [verified.all.points, of_place(&verified, VerifiedPlace::Overlap).points]
    };
    let [one, overlapping] = points(1);
    assert_eq!(
        [points(3), points(80), [one, overlapping]],
        [[3 * one, 2 * one], [64 * one, 63 * one], [one, 0]]
    );
}

#[test]
fn mistakes_of_renderers_cost_what_they_show() {
    let bench = Bench::new(1);
    let baked = bench.bake();
    let verification = bench.verified(&baked, |texel| texel);
    let green = of_mistake(&verification, Mistake::OtherGreen);
    assert!(green.median > 1.0, "{green:?}");
    // A map whose green was inverted has the same error as a renderer that inverts it.
    let inverted = bench.verified(&baked, |[x, y, z]| [x, -y, z]);
    assert_eq!(inverted.all, green);
    let per_vertex = Bench { options: bench.options.with_bitangent(Bitangent::PerVertex), ..Bench::new(1) };
    let other = per_vertex.verified(&per_vertex.bake(), |texel| texel);
    let [of_pixel, of_vertex] =
        [&verification, &other].map(|verification| of_mistake(verification, Mistake::OtherBitangent));
    assert!(of_pixel.median > verification.all.median && of_vertex.median > other.all.median);
}

#[test]
fn places_are_told_apart() {
    let mut bench = Bench::new(0);
    // A hole in the high surface: the texels around it are copies.
    let hole = |p: [f32; 3]| p[0].abs() < 0.2 && p[1].abs() < 0.2;
    let positions = bench.high.positions.clone();
    let kept = bench.high.indices.as_chunks::<3>().0.iter();
    let kept = kept.filter(|triangle| !triangle.iter().all(|&vertex| hole(positions[vertex as usize])));
    bench.high.indices = kept.copied().flatten().collect();
    let baked = bench.bake();
    let verification = bench.verified(&baked, |texel| texel);
    assert!(verification.points_without_hit > 100);
    assert!(of_place(&verification, VerifiedPlace::Missed).points > 10);
    // The mirrored half shares its texels with the first, whose triangles come first.
    let mirrored = Bench::new(3);
    let verification = mirrored.verified(&mirrored.bake(), |texel| texel);
    let (inside, overlap) =
        (of_place(&verification, VerifiedPlace::Inside), of_place(&verification, VerifiedPlace::Overlap));
    assert!(overlap.points > inside.points / 2, "{inside:?} {overlap:?}");
    assert!(overlap.median < 2.0 * inside.median + 0.01, "{inside:?} {overlap:?}");
}

#[test]
fn images_of_another_size_are_refused() {
    let bench = Bench::new(0);
    let baked = bench.bake();
    let tangents = bench.low.tangents();
    let low = LowSurface::new(bench.low.mesh(), &tangents).expect("one tangent per corner");
    let written = NormalTexture::new([1; 2], vec![[0.0, 0.0, 1.0]], Convention::GLTF, Convention::GLTF);
    let written = written.expect("a texture");
    let high = [bench.high.high()];
    let refused =
        verify(&[low], &high, &baked.images, &written, &bench.options, &mut Context::new(), &mut |_| {});
    assert!(refused.is_err());
}

/// The bake needs less memory than the comparison.
#[test]
fn memory_for_the_comparison_is_checked_before_the_bake() {
    let bench = Bench::new(0);
    let tangents = bench.low.tangents();
    let low = [LowSurface::new(bench.low.mesh(), &tangents).expect("one tangent per corner")];
    let high = [bench.high.high()];
    let refusal = |options: &BakeOptions| check_verification(&low, &high, options).err();
    assert_eq!(refusal(&bench.options), None);
    let baked = bench.bake();
    let written = NormalTexture::new(
        bench.options.size,
        baked.images.vectors(MapKind::Normal).expect("was chosen").to_vec(),
        bench.options.map_convention,
        Convention::GLTF,
    );
    let written = written.expect("a texture");
    let limited = |bytes: u64| bench.options.with_memory_limit(Some(bytes));
    // Each refusal tells a part of the sum, the last one all of it.
    let mut enough = 0;
    while let Some(BakeError::Memory { needed, .. }) = refusal(&limited(enough)) {
        enough = needed;
    }
    let options = limited(enough - 1);
    let refused = verify(&low, &high, &baked.images, &written, &options, &mut Context::new(), &mut |_| {});
    assert!(refusal(&options).is_some());
    assert_eq!(refused.err(), refusal(&options));
    assert!(bake(&low, &high, &options, &mut Context::new(), &mut |_| {}).is_ok());
}

/// Prints the table of docs/matching-your-baker.md: what each difference between baker and renderer costs, on
/// the sphere with waves.
#[test]
fn every_mismatch_costs_degrees() {
    let mut bench = Bench::new(1);
    bench.low = PAIRS[1].low(12);
    bench.options = bench.options.with_size([512; 2]);
    let baked = bench.bake();
    let same = |texel: [f32; 3]| texel;
    let right = bench.verified(&baked, same);
    let show = |what: &str, errors: &ErrorStatistics| {
        let ErrorStatistics { median, p95, worst, .. } = errors;
        writeln!(std::io::stdout(), "| {what} | {median:.3} | {p95:.3} | {worst:.1} |")
            .expect("standard output");
    };
    let costs = |what: &str, errors: &ErrorStatistics| {
        show(what, errors);
        assert!(errors.p95 > 1.2 * right.all.p95, "{what}: {errors:?} {:?}", right.all);
    };
    show("nothing", &right.all);
    costs("green points the other way", &of_mistake(&right, Mistake::OtherGreen));
    let methods = [
        ("Lengyel's tangents", Method::Lengyel),
        ("tangents of each face", Method::Face),
        ("tangents from the normal alone", Method::FromNormal),
    ];
    for (what, method) in methods {
        let tangents = generate_tangents(&bench.low.mesh(), &method.into()).corners.into_per_corner();
        costs(what, &bench.shown(&baked, &bench.low, &tangents, same).all);
    }
    let mut turned = bench.low.clone();
    for cell in turned.indices.as_chunks_mut::<6>().0 {
        let [a, b, c, _, _, d] = *cell;
        *cell = [a, b, d, d, b, c];
    }
    costs("quads cut along the other diagonal", &bench.shown(&baked, &turned, &turned.tangents(), same).all);
    let mut flat = bench.low.clone();
    flat.normals.iter_mut().zip(&flat.positions).for_each(|(normal, p)| {
        // Normals that lean upwards by some 5 degrees, as another weighting gives them.
        *normal = unit([p[0].into(), f64::from(p[1]) + 0.1, p[2].into()]).map(|x| x as f32);
    });
    costs("normals that lean by 5 degrees", &bench.shown(&baked, &flat, &flat.tangents(), same).all);
    let mut moved = bench.low.clone();
    moved.uvs.iter_mut().for_each(|uv| uv[0] += 1.0 / 512.0);
    costs("UVs moved by a texel", &bench.shown(&baked, &moved, &moved.tangents(), same).all);
    costs("the bitangent per vertex", &of_mistake(&right, Mistake::OtherBitangent));
    costs("N and T normalised per pixel", &of_mistake(&right, Mistake::NormalisedFrame));
    costs("8 bits", &bench.verified(&baked, to_8_bits).all);
    let decoded = |x: f32| 2.0 * srgb_to_linear(f64::from((x + 1.0) / 2.0)) as f32 - 1.0;
    costs("read as sRGB", &bench.verified(&baked, |texel| texel.map(decoded)).all);
}

/// Charts that cover the image 256 times would need 9.4 million points. One texel in each square of 2 x 2 is
/// compared instead, with the first 64 triangles that cover it.
#[test]
fn repeated_uvs_are_compared_at_fewer_points_and_the_progress_is_told() {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let uvs = positions.map(|[x, y, _]: [f32; 3]| [16.0 * x, 16.0 * y]);
    let indices = [0u16, 1, 2, 0, 2, 3];
    let mesh = Mesh::triangles(&positions, &[[0.0, 0.0, 1.0]; 4], &uvs, &indices).expect("a mesh");
    let low = LowSurface::new(mesh, &[[1.0, 0.0, 0.0, 1.0]; 6]).expect("one tangent per corner");
    let high = [HighSurface::new(&positions, None, &indices).expect("a surface")];
    let options = BakeOptions::new([192; 2], [0.1, 0.1]);
    let baked = bake(&[low], &high, &options, &mut Context::new(), &mut |_| {}).expect("valid input");
    let texels = baked.images.vectors(MapKind::Normal).expect("was chosen").to_vec();
    let written = NormalTexture::new(options.size, texels, options.map_convention, Convention::GLTF);
    let written = written.expect("a texture");
    let mut last = None;
    let mut tell = |progress| last = Some(progress);
    let found = verify(&[low], &high, &baked.images, &written, &options, &mut Context::new(), &mut tell);
    let found = found.expect("valid input");
    assert_eq!(found.heat_size, [96; 2]);
    assert_eq!(found.all.points, 192 * 192 * 64 / 4);
    assert_eq!(last, Some(BakeProgress { done: 6, total: 6 }));
}
