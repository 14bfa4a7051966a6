//! What is drawn of a document.

use std::collections::HashMap;

use bytemuck::{Pod, Zeroable};
use darboux_io::Error;
use darboux_io::gltf::{Document, Look, PlacedMesh, PrimitiveCorners, TextureUse};

use crate::camera::Bounds;
use crate::painter::Shape;
use crate::{derivatives, heat};

/// A corner as the shader takes it.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Corner {
    pub position: [f32; 3],
    pub normal: [f32; 3],
    /// Zero where there is none.
    pub tangent: [f32; 4],
    /// Of the base colour, then of the normal map, as stored.
    pub uvs: [[f32; 2]; 2],
    /// The angle, [`heat::FLIP`] or [`heat::NONE`].
    pub degrees: f32,
}

/// The triangles of a primitive.
pub struct Part {
    pub mesh: usize,
    primitive: usize,
    /// The index of its material.
    pub material: Option<usize>,
    pub corners: Vec<Corner>,
    has_tangents: bool,
    /// Triangles without a place.
    left_out: usize,
    /// The UVs that its tangents follow, at every corner; empty where there are none.
    pub layout: Vec<[f32; 2]>,
}

/// What is drawn of a document.
pub struct Model<'a> {
    pub(crate) document: &'a Document,
    pub(crate) looks: Vec<Look>,
    pub(crate) parts: Vec<Part>,
    /// The matrices of every mesh's nodes.
    pub(crate) places: Vec<Vec<[[f64; 4]; 4]>>,
    /// Whether tangents are what shaders derive.
    pub(crate) is_derived: bool,
    /// What every mesh is drawn without.
    unposed: Vec<Option<&'static str>>,
}

impl<'a> Model<'a> {
    /// Reads the meshes of the scene with the tangents that the document has. Compressed documents are decompressed.
    ///
    /// Errors: broken data.
    pub fn read(document: &'a mut Document) -> Result<Self, Error> {
        document.decompress()?;
        let document: &'a Document = document;
        let looks = document.looks()?;
        let mut places = vec![Vec::new(); document.meshes().len()];
        let mut unposed = vec![None; document.meshes().len()];
        for placed in document.placed_meshes()? {
            if let (Some(places), Some(unposed)) = (places.get_mut(placed.mesh), unposed.get_mut(placed.mesh))
            {
                places.push(placed.matrix);
                *unposed = unposed.or(without(&placed));
            }
        }
        let mut parts = Vec::new();
        for corners in document.corners()? {
            if places.get(corners.name().mesh).is_some_and(|places| !places.is_empty()) {
                parts.push(read_part(document, &looks, &corners)?);
            }
        }
        Ok(Self { document, looks, parts, places, is_derived: false, unposed })
    }

    /// The model with the tangents that shaders derive from positions and UVs, in place of its own.
    pub fn derived(mut self) -> Self {
        self.is_derived = true;
        for part in &mut self.parts {
            part.has_tangents = !part.layout.is_empty();
            for (corners, uvs) in
                part.corners.as_chunks_mut::<3>().0.iter_mut().zip(part.layout.as_chunks().0)
            {
                let tangents =
                    derivatives::tangents(corners.map(|c| c.position), corners.map(|c| c.normal), *uvs);
                corners.iter_mut().zip(tangents).for_each(|(corner, tangent)| corner.tangent = tangent);
            }
        }
        self
    }

    /// The model with the angles to the tangents of another one of the same file, for [`View::Angle`](crate::View::Angle).
    pub fn compared_with(mut self, other: &Model<'_>) -> Self {
        let others: HashMap<_, _> =
            other.parts.iter().map(|part| ((part.mesh, part.primitive), part)).collect();
        for part in &mut self.parts {
            let other = others.get(&(part.mesh, part.primitive)).filter(|other| part.is_comparable(other));
            let Some(other) = other else { continue };
            let pairs = part.corners.as_chunks_mut::<3>().0.iter_mut().zip(other.corners.as_chunks::<3>().0);
            for (corners, others) in pairs {
                let degrees = heat::degrees(corners.map(|c| c.tangent), others.map(|c| c.tangent));
                corners.iter_mut().zip(degrees).for_each(|(corner, degrees)| corner.degrees = degrees);
            }
        }
        self
    }

    /// The model without all other meshes. `meshes`: indices.
    pub fn only(mut self, meshes: &[usize]) -> Self {
        self.parts.retain(|part| meshes.contains(&part.mesh));
        self
    }

    /// Triangles that views of the surface show, counted as often as nodes place them.
    pub fn triangle_count(&self) -> u64 {
        let placed = |part: &Part| (part.corners.len() / 3) as u64 * self.places_of(part).len() as u64;
        self.parts.iter().map(placed).fold(0, u64::saturating_add)
    }

    pub(crate) fn places_of(&self, part: &Part) -> &[[[f64; 4]; 4]] {
        self.places.get(part.mesh).map_or(&[], Vec::as_slice)
    }

    /// What is not drawn of a shape, and should be.
    pub(crate) fn warnings(&self, shape: Shape) -> Vec<String> {
        if shape == Shape::Layout {
            return Vec::new();
        }
        let left_out: usize = self.parts.iter().map(|part| part.left_out).sum();
        let left_out = (left_out > 0)
            .then(|| format!("{left_out} triangles have positions that are not finite, and are left out"));
        let is_drawn = |mesh: usize| self.parts.iter().any(|part| part.mesh == mesh);
        let unposed = self.unposed.iter().enumerate().filter(|&(mesh, _)| is_drawn(mesh));
        let unposed =
            unposed.filter_map(|(mesh, what)| Some(format!("meshes[{mesh}]: is drawn {}", (*what)?)));
        left_out.into_iter().chain(unposed).collect()
    }

    /// The box that holds all that is drawn; none without triangles.
    pub(crate) fn bounds(&self, shape: Shape) -> Option<Bounds> {
        let mut all = Box3::EMPTY;
        for part in &self.parts {
            if shape == Shape::Layout {
                part.layout.iter().for_each(|&uv| all.add(on_layout(uv).map(f64::from)));
                continue;
            }
            let mut own = Box3::EMPTY;
            part.corners.iter().for_each(|corner| own.add(corner.position.map(f64::from)));
            for (matrix, corner) in
                self.places_of(part).iter().flat_map(|m| own.corners().map(move |c| (m, c)))
            {
                let [a, b, c, d] = matrix;
                all.add([0, 1, 2].map(|i| a[i] * corner[0] + b[i] * corner[1] + c[i] * corner[2] + d[i]));
            }
        }
        if shape == Shape::Layout && all.least[0] <= all.most[0] {
            for uv in [[0.0, 0.0], [1.0, 1.0]] {
                all.add(on_layout(uv).map(f64::from));
            }
        }
        (all.least[0] <= all.most[0]).then_some([all.least, all.most])
    }
}

impl Part {
    /// Whether there are tangents on both sides, of the same corners.
    fn is_comparable(&self, other: &Part) -> bool {
        self.has_tangents && other.has_tangents && self.corners.len() == other.corners.len()
    }
}

/// What of a mesh's pose is not drawn, in words.
fn without(placed: &PlacedMesh) -> Option<&'static str> {
    match placed {
        PlacedMesh { is_skinned: true, .. } => {
            Some("without its skin, as it was bound; `darboux view` shows its pose")
        }
        PlacedMesh { is_morphed: true, .. } => {
            Some("without its morph targets, as if none had a weight; `darboux view` shows its pose")
        }
        PlacedMesh { is_instanced: true, .. } => {
            Some("once, at its node, and not where its instances are; `darboux view` shows them")
        }
        _ => None,
    }
}

/// Where a UV lies in the layout, whose v goes down.
pub fn on_layout([u, v]: [f32; 2]) -> [f32; 3] {
    [u, -v, 0.0]
}

/// Reads a primitive, leaving out triangles that have no place.
fn read_part(document: &Document, looks: &[Look], corners: &PrimitiveCorners<'_>) -> Result<Part, Error> {
    let none = Look::default();
    let look = match corners.material() {
        None => &none,
        Some(material) => looks.get(material).ok_or_else(|| {
            let problem = format!("its material {material} does not exist; export the file again");
            document.invalid(corners.name().path(), problem)
        })?,
    };
    let positions = corners.vectors::<3>("POSITION")?.unwrap_or_default();
    let normals = corners.vectors::<3>("NORMAL")?.unwrap_or_default();
    let tangents = corners.vectors::<4>("TANGENT")?.unwrap_or_default();
    let layout = corners.vectors::<2>(&set_name(look.tangent_uv_set))?.unwrap_or_default();
    let uvs = |texture: &Option<TextureUse>| -> Result<Vec<[f32; 2]>, Error> {
        let Some(texture) = texture else { return Ok(layout.clone()) };
        Ok(corners.vectors::<2>(&set_name(texture.uv_set))?.unwrap_or_default())
    };
    let uvs = [uvs(&look.base_texture)?, uvs(&look.normal_texture)?];
    let at = |i: usize| Corner {
        position: positions[i],
        normal: normals.get(i).copied().unwrap_or_default(),
        tangent: tangents.get(i).copied().unwrap_or_default(),
        uvs: [0, 1].map(|k| uvs[k].get(i).copied().unwrap_or_default()),
        degrees: heat::NONE,
    };
    let is_finite = |triangle: &[[f32; 3]; 3]| triangle.as_flattened().iter().all(|x| x.is_finite());
    let triangles = positions.as_chunks::<3>().0.iter().enumerate();
    let kept = triangles.filter(|(_, triangle)| is_finite(triangle)).map(|(triangle, _)| triangle);
    let kept: Vec<usize> = kept.flat_map(|triangle| [0, 1, 2].map(|i| 3 * triangle + i)).collect();
    Ok(Part {
        mesh: corners.name().mesh,
        primitive: corners.name().primitive,
        has_tangents: !tangents.is_empty(),
        material: corners.material(),
        left_out: positions.len() / 3 - kept.len() / 3,
        corners: kept.iter().map(|&corner| at(corner)).collect(),
        layout: kept.iter().filter_map(|&corner| layout.get(corner).copied()).collect(),
    })
}

/// glTF's name of a UV set.
fn set_name(set: usize) -> String {
    format!("TEXCOORD_{set}")
}

/// A box that grows.
struct Box3 {
    least: [f64; 3],
    most: [f64; 3],
}

impl Box3 {
    const EMPTY: Self = Self { least: [f64::INFINITY; 3], most: [f64::NEG_INFINITY; 3] };

    /// Points that are not finite have no place.
    fn add(&mut self, point: [f64; 3]) {
        if point.iter().all(|x| x.is_finite()) {
            (0..3).for_each(|i| {
                self.least[i] = self.least[i].min(point[i]);
                self.most[i] = self.most[i].max(point[i]);
            });
        }
    }

    fn corners(&self) -> [[f64; 3]; 8] {
        let ends = [self.least, self.most];
        [0, 1, 2, 3, 4, 5, 6, 7].map(|bits: usize| [0, 1, 2].map(|i| ends[bits >> i & 1][i]))
    }
}
