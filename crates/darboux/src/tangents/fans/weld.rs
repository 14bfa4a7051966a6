//! Welding by hashing: vertices whose position, normal and UV are equal as floats become the first of them.
//!
//! The reference names a welded vertex after one of its corners, in an order of its own. That order can show only where the
//! values are not finite (or so large that it does not weld them), and where equal vertices differ in the sign of a zero; such
//! meshes are refused here. (It shows in one other place, the last run of edges: see `last_run`.)

use crate::{Indices, Mesh};

use super::block::Record;
use super::source::{Identity, for_each_record, record};
use super::vertices::Vertex;

/// The welded vertices of a mesh; the memory is kept from mesh to mesh.
#[derive(Debug, Default)]
pub(super) struct Weld {
    /// By vertex, or by corner of an unindexed mesh; empty when every vertex is its own.
    of: Vec<u32>,
    per_corner: bool,
    hashes: Vec<u32>,
    seen: Vec<u64>,
    again: Vec<u64>,
    /// How many bits of a hash number a bit of `seen` and `again`.
    map_bits: u32,
    table: Vec<u32>,
    recent: Vec<u32>,
    /// The number of welded vertices, those that are copies of another or unused included.
    pub count: usize,
}

/// The mesh has values that only the reference's own order of vertices decides.
pub(super) struct Refused;

/// The largest size of a coordinate that is welded here; the reference stops welding at half the largest float.
const LARGEST: f32 = 1e38;

/// No vertex in this slot.
const FREE: u32 = u32::MAX;

/// How many recently met vertices are looked at first, in an unindexed mesh.
const RECENT: usize = if cfg!(small_limits) { 2 } else { 1 << 14 };

impl Weld {
    /// Welds the vertices of an indexed mesh, or the corners of an unindexed one; of the latter, the vertices are written.
    pub fn weld(&mut self, mesh: &Mesh<'_>, vertices: &mut Vec<Vertex>) -> Result<(), Refused> {
        self.of.clear();
        self.per_corner = matches!(mesh.indices(), Indices::Unindexed);
        if self.per_corner {
            return self.weld_corners(mesh, vertices);
        }
        self.count = mesh.vertex_count();
        vertices.resize(self.count, Vertex::default());
        let collisions = self.find_collisions(mesh)?;
        if collisions > 0 { self.weld_collisions(mesh, collisions) } else { Ok(()) }
    }

    pub fn identity(&self) -> Identity<'_> {
        match (self.per_corner, self.of.is_empty()) {
            (true, _) => Identity::OfCorner(&self.of),
            (false, true) => Identity::Own,
            (false, false) => Identity::OfVertex(&self.of),
        }
    }

    /// True when vertices are the mesh's own, and so still to be read.
    pub fn is_per_vertex(&self) -> bool {
        !self.per_corner
    }

    /// Hashes all vertices, marks hash values met more than once, and returns how many there are at most.
    ///
    /// Few meshes have equal vertices: two bits per hash value, which stay in the cache, leave few vertices to compare.
    fn find_collisions(&mut self, mesh: &Mesh<'_>) -> Result<usize, Refused> {
        let bits = if cfg!(small_limits) { 2 } else { (8 * self.count).max(64).ilog2().min(31) + 1 };
        self.map_bits = bits;
        for map in [&mut self.seen, &mut self.again] {
            map.clear();
            map.resize((1usize << bits).div_ceil(64), 0);
        }
        self.hashes.clear();
        self.hashes.reserve(self.count);
        let (mut largest, mut collisions) = ([0; 8], 0);
        let Self { seen, again, hashes, .. } = self;
        for_each_record(mesh, 0..self.count, |_, record| {
            largest = larger(largest, &record);
            let hash = hash(&record);
            hashes.push(hash);
            let (word, bit) = place(hash, bits);
            if seen[word] & bit != 0 {
                again[word] |= bit;
                collisions += 1;
            }
            seen[word] |= bit;
        });
        check_size(largest)?;
        Ok(collisions)
    }

    /// Compares the vertices whose hash values were met more than once.
    fn weld_collisions(&mut self, mesh: &Mesh<'_>, collisions: usize) -> Result<(), Refused> {
        let slots = (4 * collisions).next_power_of_two();
        self.table.clear();
        self.table.resize(slots, FREE);
        for vertex in 0..self.count {
            let hash = self.hashes[vertex];
            let (word, bit) = place(hash, self.map_bits);
            if self.again[word] & bit == 0 {
                continue;
            }
            let own = record(mesh, vertex);
            let mut slot = hash as usize & (slots - 1);
            while self.table[slot] != FREE {
                let first = self.table[slot];
                if self.hashes[first as usize] == hash && are_one(&record(mesh, first as usize), &own)? {
                    if self.of.is_empty() {
                        self.of.extend(0..self.count as u32);
                    }
                    self.of[vertex] = first;
                    break;
                }
                slot = (slot + 1) & (slots - 1);
            }
            if self.table[slot] == FREE {
                self.table[slot] = vertex as u32;
            }
        }
        Ok(())
    }

    /// Numbers the distinct corners of an unindexed mesh in the order in which they are first met, and writes them.
    fn weld_corners(&mut self, mesh: &Mesh<'_>, vertices: &mut Vec<Vertex>) -> Result<(), Refused> {
        let corners = mesh.corner_count();
        self.table.clear();
        self.table
            .resize(if cfg!(small_limits) { 2 } else { (corners / 3).next_power_of_two().max(2) }, FREE);
        self.recent.clear();
        self.recent.resize(RECENT, 0);
        vertices.clear();
        self.of.reserve(corners);
        let Self { of, table, recent, .. } = self;
        let (mut largest, mut refused) = ([0; 8], false);
        for_each_record(mesh, 0..corners, |_, record| {
            largest = larger(largest, &record);
            let hash = hash(&record);
            let cached = &mut recent[hash as usize % RECENT];
            let known = vertices.get(*cached as usize).is_some_and(|vertex: &Vertex| vertex.is_at(&record));
            if !known {
                *cached = find_or_insert(table, vertices, hash, &record);
            }
            refused |= !same_bits(&vertices[*cached as usize].record, &record);
            of.push(*cached);
        });
        self.count = vertices.len();
        if refused { Err(Refused) } else { check_size(largest) }
    }
}

/// The number of the vertex with this record; a new one when there is none.
fn find_or_insert(table: &mut Vec<u32>, vertices: &mut Vec<Vertex>, hash: u32, record: &Record) -> u32 {
    let mut slot = hash as usize & (table.len() - 1);
    while table[slot] != FREE {
        if vertices[table[slot] as usize].is_at(record) {
            return table[slot];
        }
        slot = (slot + 1) & (table.len() - 1);
    }
    let vertex = vertices.len() as u32;
    table[slot] = vertex;
    vertices.push(Vertex::at(*record));
    if 2 * vertices.len() > table.len() {
        grow(table, vertices);
    }
    vertex
}

fn grow(table: &mut Vec<u32>, vertices: &[Vertex]) {
    let slots = 2 * table.len();
    table.clear();
    table.resize(slots, FREE);
    for (vertex, at) in (0..).zip(vertices) {
        let mut slot = hash(&at.record) as usize & (slots - 1);
        while table[slot] != FREE {
            slot = (slot + 1) & (slots - 1);
        }
        table[slot] = vertex;
    }
}

/// The largest bits of each component so far, without its sign.
#[inline(always)]
fn larger(largest: [u32; 8], record: &Record) -> [u32; 8] {
    std::array::from_fn(|i| largest[i].max(record[i].to_bits() & !(1 << 31)))
}

fn check_size(largest: [u32; 8]) -> Result<(), Refused> {
    if largest.iter().all(|&bits| bits <= LARGEST.to_bits()) { Ok(()) } else { Err(Refused) }
}

/// The word of a bit map and the bit in it for a hash value.
#[inline(always)]
fn place(hash: u32, bits: u32) -> (usize, u64) {
    let at = (u64::from(hash) << bits >> 32) as usize;
    (at / 64, 1 << (at % 64))
}

/// A hash that is equal for records that are equal as floats.
#[inline(always)]
fn hash(record: &Record) -> u32 {
    // Adding zero turns -0 into +0.
    let [a, b, c, d, e, f, g, h] = record.map(|x| u64::from((x + 0.0).to_bits()));
    let mix = |x: u64, y: u64| {
        let product = u128::from(x) * u128::from(y);
        product as u64 ^ (product >> 64) as u64
    };
    let position = mix((a | b << 32) ^ 0x9e37_79b9_7f4a_7c15, (c | d << 32) ^ 0xd1b5_4a32_d192_ed03);
    let rest = mix((e | f << 32) ^ 0xa076_1d64_78bd_642f, (g | h << 32) ^ 0xe703_7ed1_a0b4_28db);
    let both = mix(position ^ rest.rotate_left(32), 0x8ebc_6af0_9c88_c6e3);
    (both >> 32) as u32 ^ both as u32
}

/// True for records that are equal as floats. Refuses those whose zeros differ in sign.
fn are_one(a: &Record, b: &Record) -> Result<bool, Refused> {
    if a != b {
        return Ok(false);
    }
    if same_bits(a, b) { Ok(true) } else { Err(Refused) }
}

#[inline(always)]
fn same_bits(a: &Record, b: &Record) -> bool {
    a.map(f32::to_bits) == b.map(f32::to_bits)
}
