//! Statistics of angles.

use serde::Serialize;

/// Statistics of angles in degrees. All are 0 where there are no points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ErrorStatistics {
    /// The number of points.
    pub points: u64,
    /// Half of the angles are smaller.
    pub median: f64,
    /// The mean.
    pub mean: f64,
    /// 95 % of the angles are smaller.
    pub p95: f64,
    /// 99 % of the angles are smaller.
    pub p99: f64,
    /// The largest.
    pub worst: f64,
}

impl ErrorStatistics {
    pub(crate) fn of(mut angles: Vec<f32>) -> Self {
        angles.sort_unstable_by(f32::total_cmp);
        let quantile = |share: f64| {
            let last = angles.len().saturating_sub(1) as f64;
            angles.get((last * share) as usize).copied().map_or(0.0, f64::from)
        };
        // The sum of nothing would be -0.
        let sum = angles.iter().copied().map(f64::from).fold(0.0, |sum, angle| sum + angle);
        Self {
            points: angles.len() as u64,
            median: quantile(0.5),
            mean: sum / angles.len().max(1) as f64,
            p95: quantile(0.95),
            p99: quantile(0.99),
            worst: quantile(1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_are_those_of_the_list() {
        let statistics = ErrorStatistics::of((0..=100).rev().map(|x| x as f32).collect());
        let expected =
            ErrorStatistics { points: 101, median: 50.0, mean: 50.0, p95: 95.0, p99: 99.0, worst: 100.0 };
        assert_eq!(statistics, expected);
        let of_none = ErrorStatistics::of(Vec::new());
        assert_eq!(of_none, ErrorStatistics::default());
        assert!(of_none.mean.is_sign_positive());
    }
}
