//! Normal maps are judged correctly: generated maps of every kind, and maps with one known oddity.

use darboux::{
    Channel, Error, MapJudgement, MapVerdict, NormalMapJudge, SrgbMistake, TexelLayout, judge_normal_map,
};
use darboux_tests::maps::damage::Storage;
use darboux_tests::maps::outcome::{MapSet, Success};
use darboux_tests::maps::table::failures;
use darboux_tests::maps::truth::Truth;
use darboux_tests::maps::{Background, MapCase};

/// A map of bumps without background or damage.
fn plain() -> MapCase {
    let mut case = MapCase::new(0, 256);
    case.storage = Storage::Rounded;
    case.background = Background::Padded;
    (case.charts, case.noise, case.slope, case.stretch) = (1, 0.0, 0.3, 1.0);
    case
}

fn judge(truth: Truth, case: &MapCase) -> MapJudgement {
    judged(&truth.texels(case), TexelLayout::RGB)
}

fn judged<C: Channel, const N: usize>(texels: &[[C; N]], layout: TexelLayout<N>) -> MapJudgement {
    judge_normal_map(texels, [256, 256], layout).expect("the map is whole")
}

/// Every surface, several charts, stretches, kinds of noise and of compression. `cargo xtask maps` judges
/// thousands.
#[test]
fn generated_maps_get_the_right_verdict() {
    let set = MapSet { largest_side: 256, slope: 1.0 };
    let cases: Vec<_> = (0..27).map(|number| (number, Truth::ALL.to_vec())).collect();
    let outcomes = set.judge_all(&cases, std::thread::available_parallelism().map_or(1, usize::from));
    assert_eq!(outcomes.len(), 27 * Truth::ALL.len());
    assert_eq!(failures(&set, &outcomes), "");
    for outcome in outcomes {
        let is_hard = outcome.truth == Truth::Noise && outcome.success() == Success::Undecided;
        assert!(is_hard || outcome.success() == Success::Right, "{outcome:?}");
    }
}

/// Noise of one or two codes, whose mixed derivatives happen to be the larger ones, fills most tiles, and a
/// few hold the relief: a keyboard whose screws and lettering are all that is not flat.
#[test]
fn faint_noise_exchanges_no_channels() {
    const RELIEF: usize = 64;
    for (is_down, verdict) in [(false, MapVerdict::OpenGl), (true, MapVerdict::DirectX)] {
        let mut faint = plain();
        faint.slope = 0.015;
        let mut texels: Vec<[u8; 3]> = faint.texels(is_down).iter().map(|&[r, g, b]| [g, r, b]).collect();
        assert!(judged(&texels, TexelLayout::RGB).has_exchanged_channels());
        let relief = plain().texels(is_down);
        for row in 0..RELIEF {
            let of_row = 256 * row..256 * row + RELIEF;
            texels[of_row.clone()].copy_from_slice(&relief[of_row]);
        }
        let judgement = judged(&texels, TexelLayout::RGB);
        assert!(!judgement.has_exchanged_channels(), "{judgement:?}");
        assert_eq!(judgement.verdict, verdict, "{judgement:?}");
    }
}

/// A run that was stopped in the middle of a line gives the same outcomes as one that was not.
#[test]
fn a_stopped_run_goes_on_where_it_was() {
    let set = MapSet { largest_side: 256, slope: 1.0 };
    let cases: Vec<_> = (0..3).map(|number| (number, Truth::ALL[..2].to_vec())).collect();
    let file = std::env::temp_dir().join(format!("darboux-maps-{}.csv", std::process::id()));
    let whole = set.judge_into(&file, &cases, 1).expect("a writable folder");
    let text = std::fs::read_to_string(&file).expect("it was written");
    std::fs::write(&file, &text[..text.len() - 40]).expect("a writable file");
    assert_eq!(set.judge_into(&file, &cases, 1).expect("a writable folder"), whole);
    let read = set.judge_into(&file, &cases[1..], 1).expect("a writable folder");
    assert_eq!(read, whole[2..]);
    let other = MapSet { largest_side: 512, slope: 1.0 };
    let error = other.judge_into(&file, &cases, 1).expect_err("the file belongs to another set");
    assert!(error.to_string().contains("remove it"), "{error}");
    std::fs::remove_file(&file).expect("it was written");
}

/// The statistic is odd: with green inverted exactly, its bits are the same but for the sign.
#[test]
fn inverted_green_negates_the_score() {
    let up = plain().texels(false);
    let down: Vec<[u8; 3]> = up.iter().map(|&[r, g, b]| [r, 255 - g, b]).collect();
    let [up, down] = [up, down].map(|texels| judged(&texels, TexelLayout::RGB));
    assert_eq!((up.verdict, down.verdict), (MapVerdict::OpenGl, MapVerdict::DirectX));
    assert!((up.z_score + down.z_score).abs() < 0.01 * up.z_score, "{} and {}", up.z_score, down.z_score);
    assert_eq!(up.confidence, down.confidence);
}

/// The tiles of a level cover the map, and their mean is the correlation of the judgement.
#[test]
fn tiles_vote_for_the_verdict() {
    for (is_down, sign) in [(false, 1.0), (true, -1.0)] {
        let texels = plain().texels(is_down);
        let mut judge = NormalMapJudge::new(256, TexelLayout::RGB);
        texels.chunks_exact(256).try_for_each(|row| judge.push_row(row)).expect("whole rows");
        let (judgement, tiles) = (judge.judgement(), judge.tiles());
        assert_eq!(tiles.side * tiles.columns, 256);
        assert_eq!(tiles.correlations.len(), tiles.columns * tiles.columns);
        let votes: Vec<f64> = tiles.correlations.iter().flatten().map(|&vote| f64::from(vote)).collect();
        let mean = votes.iter().sum::<f64>() / votes.len() as f64;
        // The judgement and the votes are rounded to single precision.
        assert!((mean - f64::from(judgement.correlation)).abs() < 1e-6, "{mean}, {}", judgement.correlation);
        assert!(mean * sign > 0.0);
    }
}

#[test]
fn layouts_and_depths_agree() {
    let texels = plain().texels(false);
    let whole = judged(&texels, TexelLayout::RGB);
    let words: Vec<[u16; 3]> = texels.iter().map(|texel| texel.map(|byte| u16::from(byte) * 257)).collect();
    let two: Vec<[u8; 2]> = texels.iter().map(|&[r, g, _]| [r, g]).collect();
    let swizzled: Vec<[u8; 4]> = texels.iter().map(|&[r, g, _]| [0, g, 0, r]).collect();
    let others =
        [judged(&words, TexelLayout::RGB), judged(&two, TexelLayout::RG), judged(&swizzled, TexelLayout::AG)];
    for other in others {
        assert_eq!((other.verdict, other.commonest), (whole.verdict, whole.commonest));
        assert!((other.z_score / whole.z_score - 1.0).abs() < 0.01);
    }
}

#[test]
fn rows_give_the_same_as_the_whole_map() {
    let texels = plain().texels(false);
    let mut judge = NormalMapJudge::new(256, TexelLayout::RGB);
    texels.chunks(256).try_for_each(|row| judge.push_row(row)).expect("whole rows");
    assert!(judge.push_row(&texels[..255]).is_err());
    assert_eq!(judge.judgement(), judged(&texels, TexelLayout::RGB));
}

/// The two-channel map is one whose constant blue is wrong, not one whose slopes are gentle.
#[test]
fn gentle_slopes_are_not_a_two_channel_map() {
    let bumps = |degrees: f32, blue: Option<u8>| -> Vec<[u8; 3]> {
        let slope = degrees.to_radians().tan();
        let texel = |i: usize| {
            let (x, y) = ((i % 256) as f32 / 9.0, (i / 256) as f32 / 9.0);
            let [p, q] = [-slope * x.cos() * y.sin(), slope * x.sin() * y.cos()];
            let length = (p * p + q * q + 1.0).sqrt();
            let [r, g, b] = [p, q, 1.0].map(|x| (127.5 + 127.5 * x / length).round() as u8);
            [r, g, blue.unwrap_or(b)]
        };
        (0..256 * 256).map(texel).collect()
    };
    for degrees in [2.0, 8.0] {
        let gentle = judged(&bumps(degrees, None), TexelLayout::RGB);
        assert_eq!((gentle.verdict, gentle.wrong_z), (MapVerdict::OpenGl, 0));
        assert!(!gentle.is_two_channel() && gentle.has_z);
    }
    for blue in [128, 255] {
        let wrong = judged(&bumps(16.7, Some(blue)), TexelLayout::RGB);
        assert!(wrong.is_two_channel(), "{wrong:?}");
    }
    let without_blue =
        judged(&bumps(16.7, Some(0)), TexelLayout::<3>::new(0, 1, None).expect("two channels"));
    assert!(!without_blue.is_two_channel() && !without_blue.has_z && without_blue.wrong_z == 0);
}

#[test]
fn counts_name_what_is_odd() {
    let healthy = plain().texels(false);
    let with = |change: fn([f32; 3]) -> [f32; 3]| {
        let change = |texel: [u8; 3]| {
            change(texel.map(|byte| f32::from(byte) / 255.0)).map(|x| (255.0 * x).round() as u8)
        };
        judged(&healthy.iter().map(|&texel| change(texel)).collect::<Vec<_>>(), TexelLayout::RGB)
    };
    let as_it_is = with(|texel| texel);
    assert_eq!((as_it_is.not_unit, as_it_is.negative_z, as_it_is.grey, as_it_is.background), (0, 0, 0, 0));
    assert!(!as_it_is.is_grey() && !as_it_is.is_object_space() && !as_it_is.is_two_channel());
    assert!(as_it_is.srgb_mistake().is_none() && (as_it_is.mean_length - 1.0).abs() < 0.01);

    let shortened = with(|texel| texel.map(|x| 0.5 + 0.6 * (x - 0.5)));
    assert_eq!(shortened.not_unit, shortened.texels);
    assert!((shortened.mean_length - 0.6).abs() < 0.01 && !shortened.holds_no_normals());
    assert_eq!(shortened.verdict, MapVerdict::OpenGl);
    let downwards = with(|[x, y, z]| [x, y, 1.0 - z]);
    assert_eq!(downwards.negative_z, downwards.texels);
    let without_blue = with(|[x, y, _]| [x, y, 1.0]);
    assert!(without_blue.is_two_channel() && without_blue.verdict == MapVerdict::OpenGl);
    let mut shallow = plain();
    shallow.slope = 0.02;
    let shallow = judge(Truth::OpenGl, &shallow);
    let [low, high] = shallow.z_range;
    assert!(high - low < 0.02 && !shallow.is_two_channel(), "z from {low} to {high}");
    assert!(with(|[x, ..]| [x; 3]).is_grey());
    assert!(judge(Truth::ObjectSpace, &plain()).is_object_space());
    let exchanged = with(|[x, y, z]| [y, x, z]);
    assert!(exchanged.has_exchanged_channels() && !as_it_is.has_exchanged_channels());
}

/// Mostly flat maps whose values went through the transfer function of sRGB once too often.
#[test]
fn wrong_transfer_functions_show_in_the_flat_texel() {
    let mut texels = plain().texels(false);
    texels[..200 * 256].fill([128, 128, 255]);
    let through = |function: fn(f32) -> f32| {
        let byte = |byte: u8| (255.0 * function(f32::from(byte) / 255.0)).round() as u8;
        judged(&texels.iter().map(|texel| texel.map(byte)).collect::<Vec<_>>(), TexelLayout::RGB)
    };
    assert_eq!(through(|x| x).srgb_mistake(), None);
    assert_eq!(through(|x| x.powf(1.0 / 2.2)).srgb_mistake(), Some(SrgbMistake::Encoded));
    assert_eq!(through(|x| x.powf(2.2)).srgb_mistake(), Some(SrgbMistake::Decoded));
}

#[test]
fn the_commonest_near_flat_code_is_found() {
    let mut texels = plain().texels(false);
    texels[..100 * 256].fill([126, 130, 255]);
    texels[100 * 256..250 * 256].fill([0, 0, 0]);
    let judgement = judged(&texels, TexelLayout::RGB);
    assert_eq!(judgement.near_flat, Some([126, 130]));
    assert_eq!(judgement.background, 150 * 256);
}

/// Nothing, one texel, one row, one column, all values.
#[test]
fn small_and_odd_maps_are_judged_too() {
    for size in [[0, 0], [1, 1], [1000, 1], [1, 1000], [17, 16], [33, 70]] {
        let texels: Vec<[u8; 3]> =
            (0..size[0] * size[1]).map(|i| [i as u8, (i >> 3) as u8, (i * 7) as u8]).collect();
        let judgement = judge_normal_map(&texels, size, TexelLayout::RGB).expect("the map is whole");
        assert_eq!(judgement.texels, texels.len());
        assert!(!texels.is_empty() || judgement.verdict == MapVerdict::CannotTell);
        assert!(judgement.confidence >= 0.5 && judgement.confidence <= 1.0);
    }
    let error =
        judge_normal_map(&[[0u8; 3]; 5], [2, 2], TexelLayout::RGB).expect_err("five texels are not 2 x 2");
    assert_eq!(error, Error::ImageSize { width: 2, height: 2, found: 5 });
    assert!(judge_normal_map(&[[0u8; 3]; 5], [usize::MAX, 2], TexelLayout::RGB).is_err());
}
