//! Generates parts as real models have them: sheets that share vertices, with mirrored halves, islands
//! without UV area, several fans at a vertex, edges of three and more triangles, degenerate triangles, and
//! zeros of both signs, in any mixture.

use darboux_dice::Dice;

use crate::OwnedMesh;
use crate::damage::{damage_faces, negate_zeros};

/// A part of one to four sheets.
pub(crate) fn model_part(dice: &mut Dice) -> OwnedMesh {
    let mut part = Part::default();
    let quads = dice.one_in(3);
    for at in 0..1 + dice.below(4) {
        part.add_sheet(dice, at as f32, quads);
    }
    for _ in 0..dice.below(6) {
        part.connect(dice);
    }
    if dice.one_in(3) {
        part.shuffle(dice);
    }
    let mut mesh = part.mesh.with_face_list(&part.faces);
    for _ in 0..dice.below(3) {
        damage_faces(dice, &mut mesh);
    }
    if dice.one_in(3) {
        negate_zeros(dice, &mut mesh);
    }
    mesh
}

#[derive(Default)]
struct Part {
    mesh: OwnedMesh,
    faces: Vec<Vec<u32>>,
}

/// How a sheet is mapped to UV space.
#[derive(Clone, Copy)]
enum Map {
    Plain,
    /// The second half repeats the first backwards.
    Mirrored,
    /// All vertices have one UV.
    Point,
    /// All vertices lie on a line.
    Line,
    /// Some columns have no width.
    Collapsed,
    /// The UVs are too small for an area.
    Tiny,
}

const MAPS: [Map; 8] =
    [Map::Plain, Map::Plain, Map::Mirrored, Map::Mirrored, Map::Point, Map::Line, Map::Collapsed, Map::Tiny];

const NORMALS: [[f32; 3]; 5] =
    [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-0.6, 0.0, 0.8], [0.0, 0.0, 0.0]];

impl Part {
    /// Adds a grid of up to five by five cells, each a quad or two triangles. Sheets of one number lie in one
    /// plane.
    fn add_sheet(&mut self, dice: &mut Dice, height: f32, quads: bool) {
        let (width, depth) = (1 + dice.below(5), 1 + dice.below(5));
        let (map, normal, is_bumpy) = (dice.pick(&MAPS), dice.pick(&NORMALS), dice.one_in(2));
        let first = self.mesh.positions.len() as u32;
        for y in 0..=depth {
            for x in 0..=width {
                let bump = if is_bumpy { 0.2 * dice.uniform() } else { 0.0 };
                let u = x as f32 / width as f32;
                let v = y as f32 / depth as f32;
                let uv = match map {
                    Map::Plain => [u, v],
                    Map::Mirrored => [0.5 - (u - 0.5).abs(), v],
                    Map::Point => [0.25, 0.75],
                    Map::Line => [u, 0.5],
                    Map::Collapsed => [if x < 2 { 0.0 } else { u }, v],
                    Map::Tiny => [1e-22 * u, 1e-22 * v],
                };
                self.mesh.push(([x as f32, y as f32, height + bump], normal, uv));
            }
        }
        for y in 0..depth {
            for x in 0..width {
                let at = |x: usize, y: usize| first + (y * (width + 1) + x) as u32;
                let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
                match quads {
                    true => self.faces.push(vec![a, b, c, d]),
                    false if dice.one_in(4) => self.faces.extend([vec![a, b, d], vec![b, c, d]]),
                    false => self.faces.extend([vec![a, b, c], vec![a, c, d]]),
                }
            }
        }
    }

    /// Connects sheets, or a sheet with itself.
    fn connect(&mut self, dice: &mut Dice) {
        let count = self.mesh.positions.len();
        let (a, b) = (dice.below(count), dice.below(count));
        let face = dice.below(self.faces.len());
        match dice.below(7) {
            // Two fans at one vertex.
            0 => self.faces.as_mut_slice().iter_mut().flatten().for_each(|vertex| {
                if *vertex as usize == b {
                    *vertex = a as u32;
                }
            }),
            // One more triangle at an edge, in either direction.
            1 | 2 => {
                let [start, end] = [self.faces[face][0], self.faces[face][1]];
                let mut triangle = vec![start, end, a as u32];
                if dice.one_in(2) {
                    triangle.swap(0, 1);
                }
                self.faces.insert(dice.below(self.faces.len() + 1), triangle);
            }
            // A face without UV area.
            3 => {
                let uv = self.mesh.uvs[self.faces[face][0] as usize];
                self.faces[face].iter().for_each(|&vertex| self.mesh.uvs[vertex as usize] = uv);
            }
            // A copy of a vertex, for one face.
            4 => {
                let corner = dice.below(self.faces[face].len());
                let vertex = self.faces[face][corner] as usize;
                let values = (self.mesh.positions[vertex], self.mesh.normals[vertex], self.mesh.uvs[vertex]);
                self.faces[face][corner] = self.mesh.push(values);
            }
            // A degenerate triangle.
            5 => self.faces.push(vec![a as u32, b as u32, b as u32]),
            // One more side of a face.
            _ => {
                let mut other = self.faces[face].clone();
                other.reverse();
                self.faces.push(other);
            }
        }
    }

    fn shuffle(&mut self, dice: &mut Dice) {
        for i in (1..self.faces.len()).rev() {
            self.faces.swap(i, dice.below(i + 1));
        }
    }
}
