//! Maps whose vectors point along another axis than z on average: the channels are in another order, or
//! inverted.
//!
//! On average a map in tangent space points along z, because its slopes cancel. Unit vectors that point along
//! red or green instead belong to a map whose channels were exchanged with blue, or to a flat surface in
//! object space; the texels do not tell which. Which of the other two channels is x and which is y shows in
//! their derivatives.

use darboux::{MapJudgement, MapVerdict, TexelLayout, judge_normal_map};
use darboux_io::image::RgbaImage;

/// The axis along which the vectors point, and the orders of channels that may undo it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reordered {
    /// The channel: 0 for red, 1 for green, 2 for blue.
    pub channel: usize,
    pub is_negative: bool,
    /// The channels of x, y and z; one possibility or two.
    pub orders: Vec<[usize; 3]>,
}

/// The least mean of the channel along which the vectors point. Slopes of 45 degrees everywhere have 0.7.
const MIN_MEAN: f32 = 0.6;

impl Reordered {
    /// None where the vectors point along z, or where most of them do not have length 1. `judgement`: on red,
    /// green and blue.
    pub fn of(image: &RgbaImage, judgement: &MapJudgement) -> Option<Self> {
        let points_along = |channel: usize| {
            let mean = judgement.mean[channel];
            if channel == 2 { mean <= -MIN_MEAN } else { mean.abs() >= MIN_MEAN }
        };
        let are_unit = 2 * judgement.not_unit <= judgement.texels - judgement.background;
        let channel = (0..3).find(|&channel| points_along(channel)).filter(|_| are_unit)?;
        // One colour shows no order.
        (judgement.verdict != MapVerdict::Flat).then_some(())?;
        let is_negative = judgement.mean[channel] < 0.0;
        let [first, second] = [[1, 2], [0, 2], [0, 1]][channel];
        let orders = [[first, second, channel], [second, first, channel]];
        let is_likely = |order: &[usize; 3]| shows_slopes(image, *order);
        let likely: Vec<[usize; 3]> = orders.into_iter().filter(is_likely).collect();
        let orders = if likely.is_empty() { orders.to_vec() } else { likely };
        Some(Self { channel, is_negative, orders })
    }

    /// Whether the vectors point against z.
    pub fn is_z(&self) -> bool {
        self.channel == 2
    }
}

/// Whether the derivatives of x and y in such channels belong to a surface.
fn shows_slopes(image: &RgbaImage, [x, y, _]: [usize; 3]) -> bool {
    let size = [image.width, image.height].map(|side| side as usize);
    let judgement =
        TexelLayout::new(x, y, None).and_then(|layout| judge_normal_map(&image.texels, size, layout).ok());
    judgement.is_some_and(|judgement| matches!(judgement.verdict, MapVerdict::OpenGl | MapVerdict::DirectX))
}
