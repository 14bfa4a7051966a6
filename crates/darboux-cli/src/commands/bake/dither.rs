//! Blue noise: thresholds that differ between neighbouring texels as evenly as possible, so that rounding to
//! 8 bits leaves neither bands nor grain.
//!
//! R. Ulichney, "The void-and-cluster method for dither array generation", 1993. The energy of a texel is a
//! sum over the others by their distance, in whole numbers, so that the array has the same bits everywhere.

/// Texels per side of the array, which repeats.
const SIDE: usize = 64;

/// The distance in texels from which on others do not count.
const REACH: usize = 6;

/// An array of thresholds between 0 and 1.
pub struct BlueNoise {
    thresholds: Vec<f32>,
    /// The place of the array's corner.
    shift: [usize; 2],
}

impl BlueNoise {
    /// `seed`: moves the array.
    pub fn new(seed: u32) -> Self {
        let order = void_and_cluster();
        let count = order.len() as f32;
        let mut thresholds = vec![0.0; order.len()];
        for (rank, texel) in order.into_iter().enumerate() {
            thresholds[texel] = (rank as f32 + 0.5) / count;
        }
        let mixed = seed.wrapping_mul(0x9e37_79b9);
        Self { thresholds, shift: [mixed as usize % SIDE, (mixed >> 16) as usize % SIDE] }
    }

    /// The threshold of a channel at a texel. Channels have different ones.
    pub fn threshold(&self, [x, y]: [usize; 2], channel: usize) -> f32 {
        let x = (x + self.shift[0] + 23 * channel) % SIDE;
        let y = (y + self.shift[1] + 41 * channel) % SIDE;
        self.thresholds[y * SIDE + x]
    }
}

/// The texels in the order in which they are set: each time in the largest void.
fn void_and_cluster() -> Vec<usize> {
    let mut field = Field::new();
    // A tenth of the texels at places without pattern, which then move from clusters into voids until that
    // changes nothing.
    let mut state = 1u64;
    while field.set.iter().filter(|set| **set).count() < SIDE * SIDE / 10 {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let texel = (state >> 33) as usize % (SIDE * SIDE);
        if !field.set[texel] {
            field.toggle(texel);
        }
    }
    loop {
        let cluster = field.cluster();
        field.toggle(cluster);
        let void = field.void();
        field.toggle(void);
        if void == cluster {
            break;
        }
    }
    // The first texels come from this pattern, the tightest cluster last.
    let mut order = Vec::new();
    let mut first = field.clone();
    while first.set.contains(&true) {
        let cluster = first.cluster();
        first.toggle(cluster);
        order.push(cluster);
    }
    order.reverse();
    while order.len() < SIDE * SIDE {
        let void = field.void();
        field.toggle(void);
        order.push(void);
    }
    order
}

#[derive(Clone)]
struct Field {
    set: Vec<bool>,
    /// Of each texel: how much the set texels around it weigh.
    energy: Vec<i64>,
    /// By the distance along both axes.
    weights: Vec<i64>,
}

impl Field {
    fn new() -> Self {
        // A Gaussian of 1.9 texels as powers of a ratio in whole numbers: the ratio of exp(-1 / (2 * 1.9^2))
        // to 1.
        let power = |square: usize| (0..square).fold(1i64 << 40, |weight, _| weight / 1000 * 871);
        let weights = (0..=REACH).flat_map(|y| (0..=REACH).map(move |x| power(x * x + y * y))).collect();
        Self { set: vec![false; SIDE * SIDE], energy: vec![0; SIDE * SIDE], weights }
    }

    fn toggle(&mut self, texel: usize) {
        let sign = if self.set[texel] { -1 } else { 1 };
        self.set[texel] = !self.set[texel];
        let [x, y] = [texel % SIDE, texel / SIDE];
        for dy in 0..=2 * REACH {
            for dx in 0..=2 * REACH {
                let at = (y + dy + SIDE - REACH) % SIDE * SIDE + (x + dx + SIDE - REACH) % SIDE;
                let weight = self.weights[dy.abs_diff(REACH) * (REACH + 1) + dx.abs_diff(REACH)];
                self.energy[at] += sign * weight;
            }
        }
    }

    /// The set texel with the most others around it, the first of several.
    fn cluster(&self) -> usize {
        let set = (0..SIDE * SIDE).filter(|&texel| self.set[texel]);
        set.max_by_key(|&texel| (self.energy[texel], SIDE * SIDE - texel)).unwrap_or_default()
    }

    /// The free texel with the fewest set ones around it, the first of several.
    fn void(&self) -> usize {
        let free = (0..SIDE * SIDE).filter(|&texel| !self.set[texel]);
        free.min_by_key(|&texel| (self.energy[texel], texel)).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_threshold_occurs_once_and_neighbours_differ() {
        let noise = BlueNoise::new(3);
        let mut sorted = noise.thresholds.clone();
        sorted.sort_by(f32::total_cmp);
        let count = (SIDE * SIDE) as f32;
        assert!(sorted.iter().enumerate().all(|(i, &x)| (x - (i as f32 + 0.5) / count).abs() < 1e-6));
        // The mean of any 4 x 4 texels is near one half: it deviates by less than half as much as the mean of
        // white noise, 0.072.
        let mean = |x: usize, y: usize| {
            (0..16).map(|i| noise.threshold([x + i % 4, y + i / 4], 0)).sum::<f32>() / 16.0
        };
        let squares = (0..SIDE * SIDE).map(|i| (mean(i % SIDE, i / SIDE) - 0.5).powi(2));
        let deviation = (squares.sum::<f32>() / count).sqrt();
        assert!(deviation < 0.036, "{deviation}");
    }
}
