//! Fuzzes normal maps: any image file gives findings, and any texels a judgement whose numbers are in their
//! ranges; inverting green negates the z score.

#![no_main]

use darboux::{MapJudgement, MapVerdict, TexelLayout, judge_normal_map};
use darboux_check::{CheckOptions, check_map};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let checked = check_map(bytes, &CheckOptions::default());
    checked.judgement.iter().for_each(check);
    let [width, channels, texels @ ..] = bytes else { return };
    let width = usize::from(*width) + 1;
    // Small maps are repeated, so that there are enough tiles for a verdict.
    let repeats = 1 + 4096 / texels.len().max(1);
    let texels: Vec<u8> = (0..repeats).flat_map(|_| texels.iter().copied()).collect();
    match channels % 4 {
        0 => judge(texels.as_chunks::<2>().0, width, TexelLayout::RG),
        1 => judge(texels.as_chunks::<3>().0, width, TexelLayout::RGB),
        2 => judge(texels.as_chunks::<4>().0, width, TexelLayout::RGBA),
        _ => judge(texels.as_chunks::<4>().0, width, TexelLayout::AG),
    }
});

/// Judges whole rows, and the same rows with green inverted.
fn judge<const N: usize>(texels: &[[u8; N]], width: usize, layout: TexelLayout<N>) {
    let height = texels.len() / width;
    let mut texels = texels[..width * height].to_vec();
    let up = judge_normal_map(&texels, [width, height], layout).expect("whole rows");
    texels.iter_mut().for_each(|texel| texel[1] = 255 - texel[1]);
    let down = judge_normal_map(&texels, [width, height], layout).expect("whole rows");
    [&up, &down].into_iter().for_each(check);
    if is_gradient(&up) && is_gradient(&down) {
        assert!(up.z_score * down.z_score < 0.0, "{up:?} and {down:?}");
    }
}

fn is_gradient(judgement: &MapJudgement) -> bool {
    matches!(judgement.verdict, MapVerdict::OpenGl | MapVerdict::DirectX)
}

fn check(judgement: &MapJudgement) {
    let MapJudgement { confidence, correlation, z_score, log_energy_ratio, .. } = *judgement;
    assert!((0.5..=1.0).contains(&confidence), "{judgement:?}");
    assert!(
        correlation.abs() <= 1.001 && z_score.is_finite() && log_energy_ratio.is_finite(),
        "{judgement:?}"
    );
    let counts =
        [judgement.not_unit, judgement.negative_z, judgement.grey, judgement.not_normal, judgement.wrong_z];
    let vectors = judgement.texels - judgement.background;
    assert!(counts.iter().all(|&count| count <= vectors), "{judgement:?}");
    assert!(
        judgement.mean.iter().chain(&judgement.z_range).all(|x| (-1.001..=1.001).contains(x)),
        "{judgement:?}"
    );
}
