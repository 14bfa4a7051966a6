//! Judges many generated maps and counts the verdicts.

use std::fmt;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use darboux::{MapJudgement, MapVerdict, TexelLayout, judge_normal_map};

use super::MapCase;
use super::surfaces::Surface;
use crate::Dice;

/// What a generated map is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Truth {
    /// Green up.
    OpenGl,
    /// Green down.
    DirectX,
    /// Red and green exchanged.
    Exchanged,
    /// Vectors around z that have nothing to do with each other.
    Noise,
    /// Grey slopes in all channels.
    Grey,
    /// Vectors in all directions.
    ObjectSpace,
    /// One vector.
    Flat,
}

impl Truth {
    /// All kinds of maps.
    pub const ALL: [Self; 7] = [
        Self::OpenGl,
        Self::DirectX,
        Self::Exchanged,
        Self::Noise,
        Self::Grey,
        Self::ObjectSpace,
        Self::Flat,
    ];

    /// The verdict that is right.
    pub fn verdict(self) -> MapVerdict {
        match self {
            Self::OpenGl => MapVerdict::OpenGl,
            Self::DirectX => MapVerdict::DirectX,
            Self::Flat => MapVerdict::Flat,
            Self::Exchanged | Self::Noise | Self::Grey | Self::ObjectSpace => MapVerdict::NoGradient,
        }
    }

    /// The texels of a case.
    pub fn texels(self, case: &MapCase) -> Vec<[u8; 3]> {
        let code = |x: f32| ((x + 1.0) * 127.5).round().clamp(0.0, 255.0) as u8;
        let mut dice = Dice::from_seed(case.feature.to_bits().into());
        match self {
            Self::OpenGl => case.texels(false),
            Self::DirectX => case.texels(true),
            Self::Exchanged => case.texels(false).into_iter().map(|[r, g, b]| [g, r, b]).collect(),
            Self::Grey => case.texels(false).into_iter().map(|[r, ..]| [r; 3]).collect(),
            Self::Flat => vec![[128, 128, 255]; case.side * case.side],
            Self::Noise => {
                let mut slope = || 1.5 * case.slope * dice.uniform();
                let vector = |_| {
                    let (p, q) = (slope(), slope());
                    let length = (p * p + q * q + 1.0).sqrt();
                    [p, q, 1.0].map(|x| code(x / length))
                };
                (0..case.side * case.side).map(vector).collect()
            }
            Self::ObjectSpace => {
                let around = |i: usize| i as f32 / case.side as f32 * std::f32::consts::PI;
                let turned = |(i, [r, g, b]): (usize, [u8; 3])| {
                    let [x, y, z] = [r, g, b].map(|code| f32::from(code) / 127.5 - 1.0);
                    let (sin, cos) = (2.0 * around(i % case.side)).sin_cos();
                    let [x, z] = [x * cos + z * sin, z * cos - x * sin];
                    let (sin, cos) = (around(i / case.side) - 1.57).sin_cos();
                    [x, y * cos + z * sin, z * cos - y * sin].map(code)
                };
                case.texels(false).into_iter().enumerate().map(turned).collect()
            }
        }
    }
}

/// The judgement on a generated map.
pub fn judge(truth: Truth, case: &MapCase) -> MapJudgement {
    let texels = truth.texels(case);
    judge_normal_map(&texels, [case.side; 2], TexelLayout::RGB).expect("the map is whole")
}

/// How many maps of which kind got which verdict.
#[derive(Clone, Debug, Default)]
pub struct ConfusionTable {
    /// Per truth: right, wrong and undecided maps.
    pub counts: [[usize; 3]; Truth::ALL.len()],
    /// The same for gradients, per surface.
    pub surfaces: [[usize; 3]; Surface::ALL.len()],
    /// The stated confidence of the likelier convention of gradients, and whether it is the right one.
    pub confidences: Vec<(f32, bool)>,
    /// Gradients with a wrong verdict or none, as `number: case`.
    pub failures: Vec<String>,
}

impl ConfusionTable {
    /// Judges the cases of these numbers, each as every kind of map, on all processors.
    pub fn make(numbers: Range<u64>, largest_side: usize, truths: &[Truth], slope: f32) -> Self {
        let next = AtomicU64::new(numbers.start);
        let work = || {
            let mut table = Self::default();
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                if number >= numbers.end {
                    return table;
                }
                let mut case = MapCase::new(number, largest_side);
                case.slope *= slope;
                truths.iter().for_each(|&truth| table.add(number, truth, &case));
            }
        };
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        std::thread::scope(|scope| {
            let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
            workers
                .into_iter()
                .map(|worker| worker.join().expect("no case panics"))
                .fold(Self::default(), Self::joined)
        })
    }

    fn add(&mut self, number: u64, truth: Truth, case: &MapCase) {
        let judgement = judge(truth, case);
        let outcome = match judgement.verdict {
            verdict if verdict == truth.verdict() => 0,
            MapVerdict::CannotTell => 2,
            _ => 1,
        };
        self.counts[truth as usize][outcome] += 1;
        let up = match truth {
            Truth::OpenGl => 1.0,
            Truth::DirectX => -1.0,
            _ => return,
        };
        self.surfaces[case.surface as usize][outcome] += 1;
        if judgement.z_score != 0.0 {
            let confidence =
                if judgement.verdict == MapVerdict::NoGradient { 0.5 } else { judgement.confidence };
            self.confidences.push((confidence, judgement.z_score * up > 0.0));
        }
        if outcome != 0 {
            let MapJudgement { verdict, z_score, log_energy_ratio, .. } = judgement;
            self.failures.push(format!("{number}: {truth:?} judged {verdict:?}, z score {z_score:.1}, log energy ratio {log_energy_ratio:.2}; {case:?}"));
        }
    }

    /// Both tables' maps.
    #[must_use]
    pub fn joined(mut self, other: Self) -> Self {
        let add = |a: &mut [usize; 3], b: [usize; 3]| a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
        self.counts.iter_mut().zip(other.counts).for_each(|(a, b)| add(a, b));
        self.surfaces.iter_mut().zip(other.surfaces).for_each(|(a, b)| add(a, b));
        self.confidences.extend(other.confidences);
        self.failures.extend(other.failures);
        self
    }

    /// Per bin of stated confidence: its lower and upper end, the number of maps, the mean confidence and the share of right signs.
    pub fn calibration(&self) -> Vec<([f32; 2], usize, f32, f32)> {
        const ENDS: [f32; 8] = [0.5, 0.6, 0.7, 0.8, 0.9, 0.97, 0.997, 1.0];
        let bin = |ends: &[f32]| {
            let is_inside =
                |confidence: f32| confidence >= ends[0] && (confidence < ends[1] || ends[1] == 1.0);
            let inside: Vec<_> =
                self.confidences.iter().filter(|(confidence, _)| is_inside(*confidence)).collect();
            let count = inside.len().max(1) as f32;
            let stated = inside.iter().map(|(confidence, _)| confidence).sum::<f32>() / count;
            let right = inside.iter().filter(|(_, is_right)| *is_right).count() as f32 / count;
            ([ends[0], ends[1]], inside.len(), stated, right)
        };
        ENDS.windows(2).map(bin).collect()
    }
}

impl fmt::Display for ConfusionTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let row =
            |f: &mut fmt::Formatter<'_>, name: &dyn fmt::Debug, [right, wrong, undecided]: [usize; 3]| {
                let all = right + wrong + undecided;
                if all == 0 {
                    return Ok(());
                }
                let percent = |count: usize| 100.0 * count as f64 / all as f64;
                let name = format!("{name:?}");
                writeln!(
                    f,
                    "{name:12} {all:8} {:8.2} % {:8.2} % {:8.2} %",
                    percent(right),
                    percent(wrong),
                    percent(undecided)
                )
            };
        writeln!(f, "truth            maps      right      wrong cannot tell")?;
        for (truth, counts) in Truth::ALL.iter().zip(self.counts) {
            row(f, truth, counts)?;
        }
        writeln!(f, "\nOpenGL and DirectX by surface")?;
        for (surface, counts) in Surface::ALL.iter().zip(self.surfaces) {
            row(f, surface, counts)?;
        }
        writeln!(f, "\nconfidence           maps   stated    right")?;
        for ([low, high], count, stated, right) in self.calibration() {
            writeln!(f, "{low:.3} to {high:.3} {count:10} {:7.2} % {:6.2} %", 100.0 * stated, 100.0 * right)?;
        }
        Ok(())
    }
}
