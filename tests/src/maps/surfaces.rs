//! Heights as functions of the position, with features about one unit wide.

/// What a height field looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// Value noise, a sum of octaves.
    Noise,
    /// Bricks with mortar between them; every brick leans a little.
    Bricks,
    /// Round dents of several sizes.
    Dents,
    /// Threads over and under each other.
    Fabric,
    /// Straight grooves in all directions.
    Scratches,
    /// Raised letters in rows.
    Text,
    /// Interlocked rings.
    ChainMail,
    /// Hexagonal tiles with rounded edges.
    Tiles,
    /// Ridges and valleys.
    Terrain,
}

impl Surface {
    /// All surfaces.
    pub const ALL: [Self; 9] = [
        Self::Noise,
        Self::Bricks,
        Self::Dents,
        Self::Fabric,
        Self::Scratches,
        Self::Text,
        Self::ChainMail,
        Self::Tiles,
        Self::Terrain,
    ];

    /// The height at a position. `gain` in (0, 1) is the amplitude of every octave relative to the one before
    /// it, where there are octaves.
    pub fn height(self, seed: u32, gain: f32, at: [f32; 2]) -> f32 {
        match self {
            Self::Noise => octaves(seed, gain, at, 6),
            Self::Bricks => bricks(seed, at) + 0.02 * octaves(seed, gain, at, 3),
            Self::Dents => dents(seed, at),
            Self::Fabric => fabric(at),
            Self::Scratches => scratches(seed, at),
            Self::Text => text(seed, at),
            Self::ChainMail => chain_mail(at),
            Self::Tiles => tiles(seed, at),
            Self::Terrain => terrain(seed, gain, at),
        }
    }
}

/// A hash of a cell, in [0, 1).
fn cell_hash(seed: u32, x: i32, y: i32) -> f32 {
    let mut bits = seed ^ (x as u32).wrapping_mul(0x9e37_79b1) ^ (y as u32).wrapping_mul(0x85eb_ca77);
    bits = (bits ^ bits >> 16).wrapping_mul(0x7feb_352d);
    bits = (bits ^ bits >> 15).wrapping_mul(0x846c_a68b);
    (bits ^ bits >> 16) as f32 / 4_294_967_296.0
}

fn smooth_step(low: f32, high: f32, value: f32) -> f32 {
    let t = ((value - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn value_noise(seed: u32, [x, y]: [f32; 2]) -> f32 {
    let (cell_x, cell_y) = (x.floor(), y.floor());
    let [s, t] = [x - cell_x, y - cell_y].map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
    let at = |dx: i32, dy: i32| cell_hash(seed, cell_x as i32 + dx, cell_y as i32 + dy);
    let top = at(0, 0) + s * (at(1, 0) - at(0, 0));
    let bottom = at(0, 1) + s * (at(1, 1) - at(0, 1));
    top + t * (bottom - top)
}

fn octaves(seed: u32, gain: f32, [x, y]: [f32; 2], count: u32) -> f32 {
    let (mut sum, mut frequency, mut amplitude) = (0.0, 1.0, 1.0);
    for i in 0..count {
        sum += amplitude * value_noise(seed.wrapping_add(i * 977), [x * frequency, y * frequency]);
        frequency *= 1.93;
        amplitude *= gain;
    }
    sum
}

fn bricks(seed: u32, [x, y]: [f32; 2]) -> f32 {
    let row = (y * 2.0).floor();
    let x = x + 0.5 * (row as i32).rem_euclid(2) as f32;
    let column = x.floor();
    let [s, t] = [x - column, y * 2.0 - row];
    let inside = |t: f32, edge: f32| smooth_step(0.0, edge, t.min(1.0 - t) - 0.03);
    let tilt = cell_hash(seed, column as i32, row as i32) - 0.5;
    inside(s, 0.06).min(inside(t, 0.12)) * (0.2 + 0.1 * tilt * (s + 0.7 * t))
}

/// The nine cells around a position, each with a random point in it and a number of its own.
fn cells_around(seed: u32, [x, y]: [f32; 2]) -> impl Iterator<Item = ([f32; 2], f32)> {
    let (cell_x, cell_y) = (x.floor() as i32, y.floor() as i32);
    (0..9).map(move |i| {
        let (i, j) = (cell_x + i % 3 - 1, cell_y + i / 3 - 1);
        let point = [i as f32 + cell_hash(seed, i, j), j as f32 + cell_hash(seed ^ 0x51, i, j)];
        ([x - point[0], y - point[1]], cell_hash(seed ^ 0xa3, i, j))
    })
}

fn dents(seed: u32, at: [f32; 2]) -> f32 {
    let dent = |([x, y], size): ([f32; 2], f32)| {
        let radius = 0.1 + 0.5 * size;
        let inside = (1.0 - (x * x + y * y) / (radius * radius)).max(0.0);
        -radius * inside * inside
    };
    cells_around(seed, at).map(dent).sum()
}

fn fabric([x, y]: [f32; 2]) -> f32 {
    use std::f32::consts::PI;
    let is_over = (x.floor() as i32 + y.floor() as i32).rem_euclid(2) == 0;
    let thread = |across: f32, along: f32| {
        let arch = (PI * along).sin().abs();
        (PI * across).sin().abs().sqrt() * (0.25 + 0.25 * arch) + 0.1 * arch
    };
    if is_over { thread(y, x) } else { thread(x, y) }
}

fn scratches(seed: u32, at: [f32; 2]) -> f32 {
    let scratch = |([x, y], number): ([f32; 2], f32)| {
        let (sin, cos) = (number * 40.0).sin_cos();
        let (along, across) = (x * cos + y * sin, y * cos - x * sin);
        let depth = smooth_step(0.9, 0.4, along.abs()).max(0.0);
        -depth * (-across * across * 900.0).exp()
    };
    cells_around(seed, at).map(scratch).sum()
}

/// Letters of 4 x 6 blocks, of which a hash fills half, with bevelled edges.
fn text(seed: u32, [x, y]: [f32; 2]) -> f32 {
    let block = |i: i32, j: i32| {
        let is_gap = i.rem_euclid(5) == 4 || j.rem_euclid(8) >= 6;
        let is_filled = cell_hash(seed, i.div_euclid(5) * 31 + i.rem_euclid(5), j) > 0.45;
        f32::from(u8::from(is_filled && !is_gap))
    };
    let [x, y] = [x * 6.0, y * 6.0];
    let (i, j) = (x.floor(), y.floor());
    let [s, t] = [x - i, y - j].map(|t| smooth_step(0.35, 0.65, t));
    let (i, j) = (i as i32, j as i32);
    let top = block(i, j) + s * (block(i + 1, j) - block(i, j));
    let bottom = block(i, j + 1) + s * (block(i + 1, j + 1) - block(i, j + 1));
    0.1 * (top + t * (bottom - top))
}

fn chain_mail([x, y]: [f32; 2]) -> f32 {
    let ring = |center: [f32; 2]| {
        let [x, y] = [x - center[0], y - center[1]];
        let from_middle = (x * x + y * y).sqrt() - 0.52;
        let inside = 0.15f32 * 0.15 - from_middle * from_middle;
        if inside > 0.0 { inside.sqrt() + 0.2 * x } else { -0.3 }
    };
    let (i, j) = (x.floor(), y.floor());
    let centers = (0..9).map(|k| [i + (k % 3) as f32 - 0.5, j + (k / 3) as f32 - 0.5]);
    centers.map(ring).fold(-0.3, f32::max)
}

fn tiles(seed: u32, [x, y]: [f32; 2]) -> f32 {
    const ROW: f32 = 0.866_025_4;
    let row = (y / ROW).round();
    let near = (-1..=1).flat_map(|dj| {
        let j = row + dj as f32;
        let shift = 0.5 * (j as i32).rem_euclid(2) as f32;
        let i = (x - shift).round();
        (-1..=1).map(move |di| [i + di as f32 + shift, j * ROW])
    });
    let mut distances: Vec<(f32, [f32; 2])> =
        near.map(|[a, b]| ((x - a) * (x - a) + (y - b) * (y - b), [a, b])).collect();
    distances.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [first, second] = [distances[0], distances[1]];
    let to_edge = second.0.sqrt() - first.0.sqrt();
    let tilt = cell_hash(seed, (first.1[0] * 2.0) as i32, (first.1[1] * 2.0) as i32) - 0.5;
    smooth_step(0.02, 0.14, to_edge) * (0.15 + 0.1 * tilt * (x - first.1[0]))
}

fn terrain(seed: u32, gain: f32, [x, y]: [f32; 2]) -> f32 {
    let bend = |k: u32| value_noise(seed ^ k, [x * 0.7, y * 0.7]) - 0.5;
    let [x, y] = [x + 0.8 * bend(7), y + 0.8 * bend(13)];
    let (mut sum, mut frequency, mut amplitude) = (0.0, 1.0, 1.0);
    for i in 0..5 {
        let noise = value_noise(seed.wrapping_add(i * 71), [x * frequency, y * frequency]);
        sum += amplitude * (1.0 - (2.0 * noise - 1.0).abs());
        frequency *= 2.07;
        amplitude *= gain;
    }
    sum
}
