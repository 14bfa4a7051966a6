//! Maps of what surfaces show beside their shape: labels, colours, textures, charts; and equal bits of all
//! maps for every number of threads.

mod support;

use darboux::{Choice, Context, Mesh};
use darboux_bake::{
    AlphaMode, BakeOptions, Baked, ColorTexture, HighSurface, IdSource, LowSurface, MapKind, MapSet,
    MaterialProperty, SurfaceLabels, TexelState, bake,
};
use darboux_dice::Dice;
use darboux_io::image::srgb_to_linear;
use support::{PAIRS, Shape};

const SIZE: u32 = 32;

fn bake_onto(low: &Shape, high: &[HighSurface<'_>], options: &BakeOptions) -> Baked {
    let tangents = low.tangents();
    let surface = LowSurface::new(low.mesh(), &tangents).expect("one tangent per corner");
    bake(&[surface], high, options, &mut Context::new(), &mut |_| {}).expect("valid input")
}

fn options(maps: &[MapKind]) -> BakeOptions {
    BakeOptions::new([SIZE; 2], [0.1, 0.1]).with_maps(MapSet::of(maps))
}

/// A plate over the unit square, from `from` to `to` along x, with UVs that are its x and 1 - y.
fn strip(from: f32, to: f32) -> Shape {
    let places = [[from, 0.0], [to, 0.0], [to, 1.0], [from, 1.0]];
    Shape {
        positions: places.map(|[x, y]| [x, y, 0.0]).to_vec(),
        normals: vec![[0.0, 0.0, 1.0]; 4],
        uvs: places.map(|[x, y]| [x, 1.0 - y]).to_vec(),
        indices: vec![0, 1, 2, 0, 2, 3],
    }
}

fn random_texture(is_srgb: bool, size: u32) -> (ColorTexture, Vec<[u8; 4]>) {
    let mut dice = Dice::from_seed(9);
    let texels: Vec<[u8; 4]> = (0..size * size).map(|_| [0; 4].map(|_: u8| dice.below(256) as u8)).collect();
    (ColorTexture::new([size; 2], texels.clone(), is_srgb).expect("as many texels"), texels)
}

#[test]
fn labels_get_colours_and_a_legend() {
    let (left, right) = (strip(0.0, 0.5), strip(0.5, 1.0));
    let label = |number| SurfaceLabels { material: number, mesh: 0, part: 7 };
    let high = [left.high().with_labels(label(3)), right.high().with_labels(label(12))];
    let baked = bake_onto(&strip(0.0, 1.0), &high, &options(&[MapKind::Id]).with_samples_per_axis(3));
    let (_, legend) = &baked.legends[0];
    assert_eq!(legend.iter().map(|color| color.id).collect::<Vec<_>>(), [3, 12]);
    assert_eq!(legend.iter().map(|color| color.texels).collect::<Vec<_>>(), [512, 512]);
    let texels = baked.images.vectors(MapKind::Id).expect("chosen");
    for (texel, found) in texels.iter().enumerate() {
        let expected = legend[usize::from(texel % 32 >= 16)].color;
        assert_eq!(*found, expected.map(|code| f32::from(code) / 255.0));
    }
    let by_part = bake_onto(&strip(0.0, 1.0), &high, &options(&[MapKind::Id]).with_id_source(IdSource::Part));
    assert_eq!(by_part.legends[0].1.len(), 1);
}

#[test]
fn vertex_colours_are_interpolated_and_can_be_labels() {
    let shape = strip(0.0, 1.0);
    let colors: Vec<[f32; 4]> = shape.positions.iter().map(|p| [p[0], p[1], 0.5, 1.0 - p[0]]).collect();
    let high = [shape.high().with_colors(&colors).expect("one per vertex")];
    let baked = bake_onto(
        &shape,
        &high,
        &options(&[MapKind::VertexColor, MapKind::Id]).with_id_source(IdSource::VertexColor),
    );
    let found = baked.images.numbers(MapKind::VertexColor).expect("chosen");
    let labels = baked.images.vectors(MapKind::Id).expect("chosen");
    for texel in 0..1024 {
        let [x, y] = [texel % 32, 31 - texel / 32].map(|i| (i as f32 + 0.5) / 32.0);
        let expected = [x, y, 0.5, 1.0 - x];
        for channel in 0..4 {
            assert!((found[4 * texel + channel] - expected[channel]).abs() < 1e-5);
        }
        assert!((0..3).all(|i| (labels[texel][i] - expected[i]).abs() < 0.6 / 255.0), "{:?}", labels[texel]);
    }
    assert!(baked.legends.is_empty());
}

#[test]
fn textures_arrive_texel_by_texel_in_the_same_layout() {
    let shape = strip(0.0, 1.0);
    let (texture, texels) = random_texture(true, SIZE);
    let (linear, _) = random_texture(false, SIZE);
    let high = shape.high();
    let uvs = || (&shape.uvs).into();
    let high = high
        .with_property(MaterialProperty::BaseColor, [1.0, 0.5, 1.0, 1.0], Some((&texture, uvs())))
        .and_then(|high| {
            let factor = [1.0, 0.5, 1.0, 1.0];
            high.with_property(MaterialProperty::MetallicRoughness, factor, Some((&linear, uvs())))
        })
        .expect("one UV per vertex");
    let maps = [MapKind::BaseColor, MapKind::Opacity, MapKind::Roughness, MapKind::Metalness];
    let baked = bake_onto(&shape, &[high], &options(&maps));
    let numbers = |kind| baked.images.numbers(kind).expect("chosen");
    let near = |found: f32, expected: f64| (f64::from(found) - expected).abs() < 1e-4;
    for (texel, codes) in texels.iter().enumerate() {
        let light = |channel: usize| srgb_to_linear(f64::from(codes[channel]) / 255.0);
        let code = |channel: usize| f64::from(codes[channel]) / 255.0;
        let color = &numbers(MapKind::BaseColor)[3 * texel..][..3];
        assert!(near(color[0], light(0)) && near(color[1], 0.5 * light(1)) && near(color[2], light(2)));
        assert!(near(numbers(MapKind::Opacity)[texel], code(3)));
        assert!(near(numbers(MapKind::Roughness)[texel], 0.5 * code(1)));
        assert!(near(numbers(MapKind::Metalness)[texel], code(2)));
    }
}

/// A mask decides at each sample, and the texel has their mean.
#[test]
fn opacity_follows_the_mode_of_alpha() {
    let shape = strip(0.0, 1.0);
    let (texture, texels) = random_texture(true, SIZE);
    let colored = vec![[1.0, 1.0, 1.0, 0.5]; 4];
    let high = shape
        .high()
        .with_property(MaterialProperty::BaseColor, [1.0; 4], Some((&texture, (&shape.uvs).into())))
        .and_then(|high| high.with_colors(&colored))
        .expect("one per vertex");
    let opacity = |mode, size: u32| {
        let options = BakeOptions::new([size; 2], [0.1, 0.1])
            .with_maps(MapSet::of(&[MapKind::Opacity]))
            .with_samples_per_axis(SIZE / size);
        let baked = bake_onto(&shape, &[high.with_alpha_mode(mode, 0.25)], &options);
        baked.images.numbers(MapKind::Opacity).expect("chosen").to_vec()
    };
    assert!(opacity(AlphaMode::Opaque, SIZE).iter().all(|x| *x == 1.0));
    let [mask, blend] = [AlphaMode::Mask, AlphaMode::Blend].map(|mode| opacity(mode, SIZE));
    for (texel, [.., alpha]) in texels.iter().enumerate() {
        assert_eq!(mask[texel], f32::from(u8::from(*alpha >= 128)), "{alpha}");
        assert!((blend[texel] - f32::from(*alpha) / 510.0).abs() < 1e-4);
    }
    let of_four = opacity(AlphaMode::Mask, SIZE / 2);
    assert!(of_four.iter().all(|share| (4.0 * share).fract() == 0.0));
    assert!(of_four.iter().any(|share| share.fract() != 0.0));
}

#[test]
fn a_small_map_has_the_mean_of_a_large_texture() {
    let shape = strip(0.0, 1.0);
    let side = 8 * SIZE as usize;
    // Stripes of one texel: every texel of the map covers 8 x 8 of them.
    let texels = (0..side * side).map(|i| if i % 2 == 0 { [0, 0, 0, 255] } else { [255; 4] }).collect();
    let texture = ColorTexture::new([side as u32; 2], texels, true).expect("as many texels");
    let high = shape.high().with_property(
        MaterialProperty::Emission,
        [1.0; 4],
        Some((&texture, (&shape.uvs).into())),
    );
    let baked = bake_onto(&shape, &[high.expect("one UV per vertex")], &options(&[MapKind::Emission]));
    for light in baked.images.numbers(MapKind::Emission).expect("chosen") {
        assert!((light - 0.5).abs() < 1e-3, "{light}");
    }
}

#[test]
fn own_parts_occlude_and_others_do_not() {
    let floor = strip(0.0, 1.0);
    let mut roof = strip(-9.0, 10.0);
    for p in &mut roof.positions {
        *p = [p[0], 20.0 * p[1] - 10.0, 0.5];
    }
    let part = |part| SurfaceLabels { material: 0, mesh: 0, part };
    let high = [floor.high().with_labels(part(1)), roof.high().with_labels(part(2))];
    let options = options(&[MapKind::Occlusion]).with_distance([0.1, 0.1]);
    let open = |own| {
        let baked = bake_onto(&floor, &high, &options.with_own_part_only(own));
        baked.images.numbers(MapKind::Occlusion).expect("chosen")[500]
    };
    assert!(open(true) == 1.0 && open(false) < 0.1, "{} {}", open(true), open(false));
}

#[test]
fn charts_edges_and_directions_of_the_low_surface_need_no_hits() {
    // Two charts, of which one has no high surface.
    let mut low = strip(0.0, 0.4);
    let other = strip(0.6, 1.0);
    low.positions.extend(&other.positions);
    low.normals.extend(&other.normals);
    low.uvs.extend(&other.uvs);
    low.indices.extend(other.indices.iter().map(|index| 4 + index));
    let maps = [MapKind::UvIslands, MapKind::Wireframe, MapKind::WorldDirection];
    let baked = bake_onto(&low, &[strip(-1.0, 0.5).high()], &options(&maps));
    let texels = baked.images.vectors(MapKind::UvIslands).expect("chosen");
    let legend = &baked.legends[0].1;
    assert_eq!(legend.len(), 2);
    assert!(baked.report.missed_texels > 300);
    for (texel, state) in
        baked.images.states.iter().enumerate().filter(|(_, state)| **state != TexelState::Outside)
    {
        let is_right = texel % 32 >= 16;
        if matches!(state, TexelState::Baked | TexelState::Missed) {
            assert_eq!(
                texels[texel],
                legend[usize::from(is_right)].color.map(|code| f32::from(code) / 255.0)
            );
        }
        let up = baked.images.vectors(MapKind::WorldDirection).expect("chosen")[texel];
        assert!((up[1] - 1.0).abs() < 1e-6, "{up:?}");
    }
    let lines = baked.images.numbers(MapKind::Wireframe).expect("chosen");
    // The corner of the first chart, a texel on its diagonal, and one between diagonal and border.
    assert_eq!([lines[31 * 32], lines[16 * 32 + 6], lines[24 * 32 + 10]], [1.0, 1.0, 0.0]);
}

#[test]
fn every_map_has_the_same_bits_for_every_number_of_threads() {
    let pair = PAIRS[3];
    let (low, high) = (pair.low(12), pair.high(64));
    let (texture, _) = random_texture(true, 64);
    let colors: Vec<[f32; 4]> =
        high.positions.iter().map(|p| [p[0].abs(), p[1].abs(), p[2].abs(), 1.0]).collect();
    let mut surface = high.high().with_colors(&colors).expect("one per vertex");
    for property in [
        MaterialProperty::BaseColor,
        MaterialProperty::MetallicRoughness,
        MaterialProperty::Emission,
        MaterialProperty::Texture,
    ] {
        let placed = surface.with_property(property, [0.9; 4], Some((&texture, (&high.uvs).into())));
        surface = placed.expect("one UV per vertex");
    }
    let tangents = low.tangents();
    let mesh: Mesh<'_> = low.mesh();
    let low = LowSurface::new(mesh, &tangents).expect("one tangent per corner");
    let options = BakeOptions::new([90, 70], [0.1, 0.1])
        .with_maps(MapSet::of(MapKind::ALL))
        .with_samples_per_axis(2)
        .with_occlusion(8, 1.0);
    let with = |threads| {
        let mut context = Context::new().with_max_threads(threads);
        bake(&[low], &[surface], &options, &mut context, &mut |_| {}).expect("valid input")
    };
    let one = with(1);
    for &kind in MapKind::ALL {
        assert!(one.images.numbers(kind).expect("chosen").iter().all(|x| x.is_finite()), "{kind:?}");
    }
    for threads in [2, 3, 16] {
        assert!(with(threads) == one, "{threads} threads");
    }
}
