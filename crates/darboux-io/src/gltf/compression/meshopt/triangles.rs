//! The codec of triangle lists: `KHR_meshopt_compression`, appendix A, mode 1.
//!
//! A code of one byte says where the vertices of a triangle come from: an edge or a vertex of one of the
//! triangles just before, the next vertex that no triangle had, or an index that is stored.

use super::bytes::Bytes;
use super::indices::{low_bytes, unzigzag};

const HEADER: u8 = 0xe1;

/// The table of frequent pairs of codes, at the end of the stream.
const TABLE: usize = 16;

/// Decodes `count` indices of `SIZE` bytes, a multiple of three. None: the stream is broken.
pub fn decode<const SIZE: usize>(stream: &[u8], count: usize) -> Option<Vec<u8>> {
    let (&HEADER, rest) = stream.split_first()? else { return None };
    let (rest, table) = rest.split_last_chunk::<TABLE>()?;
    let (codes, data) = rest.split_at_checked(count / 3)?;
    let is_allowed = |&pair: &u8| pair >> 4 < 15 && pair & 15 < 15;
    if !count.is_multiple_of(3) || !table.iter().all(is_allowed) || table[14..] != [0, 0] {
        return None;
    }
    let mut indices = vec![0; count.checked_mul(SIZE)?];
    let mut state =
        State { data: Bytes::new(data), next: 0, last: 0, edges: Recent::new(), vertices: Recent::new() };
    let triangles = indices.as_chunks_mut::<SIZE>().0.as_chunks_mut::<3>().0;
    for (triangle, &code) in triangles.iter_mut().zip(codes) {
        let indices = match code {
            0..0xf0 => state.beside_edge(code >> 4, code & 15)?,
            0xf0..0xfe => state.by_pair(table[usize::from(code & 15)], false)?,
            0xfe.. => state.stored(code == 0xff)?,
        };
        *triangle = indices.map(low_bytes);
    }
    state.data.is_empty().then_some(indices)
}

struct State<'a> {
    data: Bytes<'a>,
    /// The next vertex that no triangle had.
    next: u32,
    /// The last index that was stored, or follows one.
    last: u32,
    edges: Recent<[u32; 2]>,
    vertices: Recent<u32>,
}

impl State<'_> {
    /// A triangle at one of the last edges.
    #[inline(always)]
    fn beside_edge(&mut self, edge: u8, vertex: u8) -> Option<[u32; 3]> {
        let [a, b] = self.edges.get(edge)?;
        let c = match vertex {
            0 => self.next_vertex(),
            1..13 => self.vertices.get(vertex)?,
            13 | 14 => {
                self.last = if vertex == 13 { self.last.wrapping_sub(1) } else { self.last.wrapping_add(1) };
                self.last
            }
            _ => self.stored_vertex()?,
        };
        if !(1..13).contains(&vertex) {
            self.vertices.push(c);
        }
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        Some([a, b, c])
    }

    /// A triangle of stored indices, or of a stored pair of codes.
    fn stored(&mut self, is_first_stored: bool) -> Option<[u32; 3]> {
        let pair = self.data.byte()?;
        if pair == 0 {
            self.next = 0;
        }
        self.by_pair(pair, is_first_stored)
    }

    /// A triangle whose second and third vertices are named by a pair of codes.
    #[inline(always)]
    fn by_pair(&mut self, pair: u8, is_first_stored: bool) -> Option<[u32; 3]> {
        let codes = [if is_first_stored { 15 } else { 0 }, pair >> 4, pair & 15];
        let mut triangle = [0; 3];
        for (vertex, code) in triangle.iter_mut().zip(codes) {
            *vertex = match code {
                0 => self.next_vertex(),
                15 => self.stored_vertex()?,
                code => self.vertices.get(code - 1)?,
            };
        }
        for (vertex, code) in triangle.into_iter().zip(codes) {
            if code == 0 || code == 15 {
                self.vertices.push(vertex);
            }
        }
        let [a, b, c] = triangle;
        [[b, a], [c, b], [a, c]].into_iter().for_each(|edge| self.edges.push(edge));
        Some(triangle)
    }

    fn next_vertex(&mut self) -> u32 {
        let next = self.next;
        self.next = next.wrapping_add(1);
        next
    }

    fn stored_vertex(&mut self) -> Option<u32> {
        self.last = self.last.wrapping_add(unzigzag(self.data.varint()?));
        Some(self.last)
    }
}

/// The last 16 elements that were pushed.
struct Recent<T> {
    elements: [T; 16],
    pushed: usize,
}

impl<T: Copy + Default> Recent<T> {
    fn new() -> Self {
        Self { elements: [T::default(); 16], pushed: 0 }
    }

    #[inline(always)]
    fn push(&mut self, element: T) {
        self.elements[self.pushed & 15] = element;
        self.pushed += 1;
    }

    /// The element that was pushed `age` elements before the last one; none if there was none.
    #[inline(always)]
    fn get(&self, age: u8) -> Option<T> {
        let age = usize::from(age) + 1;
        (age <= self.pushed).then(|| self.elements[self.pushed.wrapping_sub(age) & 15])
    }
}
