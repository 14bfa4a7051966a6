//! Selects the primitives that get tangents, with a reason for each of the others.

use std::collections::BTreeSet;

use darboux::Method;

use super::options::AddTangentsOptions;
use super::uv::{UvChoice, UvTransform, changes_directions, needs_tangents};
use crate::gltf::primitives::element_count;
use crate::gltf::primitives::triangles::{TriangleMode, mode_name};
use crate::gltf::schema::{Material, Primitive};
use crate::gltf::{Document, PrimitiveName};
use crate::source::UnreadMap;
use crate::words::Count;
use crate::{Error, OptionNames};

/// The wanted primitives of a document, in its order, each with a verdict.
#[derive(Debug)]
pub struct TangentSelection {
    pub candidates: Vec<TangentCandidate>,
    pub warnings: Vec<String>,
}

/// A primitive and the verdict on it.
#[derive(Debug)]
pub struct TangentCandidate {
    pub name: PrimitiveName,
    pub uv: UvChoice,
    pub needs_tangents: bool,
    pub verdict: TangentVerdict,
}

/// Whether a primitive gets tangents.
#[derive(Debug)]
pub enum TangentVerdict {
    /// The primitive gets tangents.
    Chosen(TangentInput),
    /// The primitive keeps its tangents, for a reason.
    Kept(String),
    /// The primitive gets no tangents, because it has no normals.
    WithoutNormals,
    /// The primitive gets no tangents, for another reason.
    Skipped(String),
}

/// The input of a computation of tangents.
#[derive(Clone, Debug)]
pub struct TangentInput {
    pub position: usize,
    pub normal: usize,
    /// None if the method needs no UVs and there are none.
    pub uv: Option<usize>,
    pub indices: Option<usize>,
    pub topology: TriangleMode,
    pub transform: Option<UvTransform>,
    pub index_count: usize,
    pub replaces: bool,
}

impl TangentVerdict {
    /// Why the primitive keeps its tangents or gets none; none where it gets tangents.
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Chosen(_) => None,
            Self::WithoutNormals => Some("it has no NORMAL, which tangents need"),
            Self::Kept(reason) | Self::Skipped(reason) => Some(reason),
        }
    }
}

impl TangentCandidate {
    /// The UV set that the tangents follow, if any, and the reason for it.
    pub fn uv_set_and_reason(&self) -> (Option<usize>, String) {
        match &self.verdict {
            TangentVerdict::Chosen(TangentInput { uv: None, .. }) => {
                (None, "the primitive has none, and this method needs none".into())
            }
            _ => (Some(self.uv.set), self.uv.reason.clone()),
        }
    }

    /// Whether its tangents are replaced.
    pub fn replaces(&self) -> bool {
        matches!(&self.verdict, TangentVerdict::Chosen(chosen) if chosen.replaces)
    }
}

impl TangentSelection {
    /// The candidates that get tangents, with their indices.
    pub fn chosen(&self) -> impl Iterator<Item = (usize, &TangentInput)> {
        self.candidates.iter().enumerate().filter_map(|(place, candidate)| match &candidate.verdict {
            TangentVerdict::Chosen(chosen) => Some((place, chosen)),
            TangentVerdict::Kept(_) | TangentVerdict::WithoutNormals | TangentVerdict::Skipped(_) => None,
        })
    }
}

/// Selects primitives. Errors: materials or accessors that do not exist.
pub fn select(
    document: &Document,
    options: &AddTangentsOptions,
    is_wanted: &dyn Fn(&PrimitiveName) -> bool,
) -> Result<TangentSelection, Error> {
    let mut warnings = Warnings::default();
    let mut candidates = Vec::new();
    for (index, mesh) in document.meshes().iter().enumerate() {
        for (place, primitive) in mesh.primitives.iter().enumerate() {
            let name = PrimitiveName::new(index, mesh, place);
            if is_wanted(&name) {
                candidates.push(candidate(document, name, primitive, options, &mut warnings)?);
            }
        }
    }
    Ok(TangentSelection { candidates, warnings: warnings.sentences })
}

fn candidate(
    document: &Document,
    name: PrimitiveName,
    primitive: &Primitive,
    options: &AddTangentsOptions,
    warnings: &mut Warnings,
) -> Result<TangentCandidate, Error> {
    let materials = materials_of(document, &name, primitive)?;
    let choices: Vec<_> =
        materials.iter().filter_map(|&(index, material)| UvChoice::of(material, index)).collect();
    let unread = unread_map(document, primitive, &materials);
    let needs_tangents = unread.is_some() || materials.iter().any(|(_, material)| needs_tangents(material));
    let uv = choices.first().cloned().or(unread.map(UvChoice::of_unread)).unwrap_or_default();
    let verdict = judge(document, primitive, &uv, needs_tangents, options)?;
    if let TangentVerdict::Chosen(chosen) = &verdict {
        warnings.variants(&name, &choices);
        warnings.transform(&uv, options, document.options.option_names);
        warnings.incomplete(&name, chosen);
    }
    Ok(TangentCandidate { name, uv, needs_tangents, verdict })
}

/// The materials of a primitive: its own, then those of its variants.
fn materials_of<'a>(
    document: &'a Document,
    name: &PrimitiveName,
    primitive: &Primitive,
) -> Result<Vec<(usize, &'a Material)>, Error> {
    let materials = primitive.materials();
    materials
        .into_iter()
        .map(|index| match document.stored_materials().get(index) {
            Some(material) => Ok((index, material)),
            None => Err(document
                .invalid(name.path(), format!("its material {index} does not exist; export the file again"))),
        })
        .collect()
}

/// The first normal map of a primitive's materials that was not read, and whose UV set the primitive has.
fn unread_map<'a>(
    document: &'a Document,
    primitive: &Primitive,
    materials: &[(usize, &Material)],
) -> Option<&'a UnreadMap> {
    let provenance = document.provenance()?;
    let mut maps = materials.iter().flat_map(|&(index, _)| provenance.unread_maps_of(index));
    maps.find(|map| primitive.attributes.contains_key(&format!("TEXCOORD_{}", map.uv_set)))
}

fn judge(
    document: &Document,
    primitive: &Primitive,
    uv: &UvChoice,
    needs_tangents: bool,
    options: &AddTangentsOptions,
) -> Result<TangentVerdict, Error> {
    let attribute = |semantic: &str| primitive.attributes.get(semantic).copied();
    let skipped = |reason: &str| Ok(TangentVerdict::Skipped(reason.to_owned()));
    let Some(topology) = TriangleMode::from_mode(primitive.mode) else {
        let mode = mode_name(primitive.mode).unwrap_or("unknown");
        return Ok(TangentVerdict::Skipped(format!("its mode is {mode}; only triangles have tangents")));
    };
    let replaces = attribute("TANGENT").is_some();
    if replaces && !options.overwrite {
        return Ok(TangentVerdict::Kept("it has tangents already".to_owned()));
    }
    if options.only_needed && !needs_tangents {
        return skipped("its material does not use tangents");
    }
    let Some(position) = attribute("POSITION") else {
        return skipped("it has no POSITION, which tangents need");
    };
    let uv_accessor = attribute(&format!("TEXCOORD_{}", uv.set));
    if uv_accessor.is_none() && options.tangents.method != Method::FromNormal {
        return Ok(TangentVerdict::Skipped(missing_uv(primitive, uv)));
    }
    // Normals can be computed, so that missing ones are named where nothing else is missing.
    let Some(normal) = attribute("NORMAL") else { return Ok(TangentVerdict::WithoutNormals) };
    let vertex_count = element_count(document, position)?;
    let index_count =
        primitive.indices.map_or(Ok(vertex_count), |indices| element_count(document, indices))?;
    if topology.triangle_count(index_count) == 0 {
        return skipped("it has no complete triangle");
    }
    let transform = uv.transform.as_ref().filter(|_| options.apply_texture_transform);
    Ok(TangentVerdict::Chosen(TangentInput {
        position,
        normal,
        uv: uv_accessor,
        indices: primitive.indices,
        topology,
        transform: transform.and_then(UvTransform::new),
        index_count,
        replaces,
    }))
}

fn missing_uv(primitive: &Primitive, uv: &UvChoice) -> String {
    if uv.set == 0 && !primitive.attributes.keys().any(|key| key.starts_with("TEXCOORD_")) {
        "it has no TEXCOORD_0, which tangents need".to_owned()
    } else {
        format!("it has no TEXCOORD_{}, which its tangents must follow ({})", uv.set, uv.reason)
    }
}

/// Warnings about selected primitives. A warning about a material is given once, not for each of its
/// primitives.
#[derive(Default)]
struct Warnings {
    sentences: Vec<String>,
    transformed: BTreeSet<String>,
}

impl Warnings {
    fn variants(&mut self, name: &PrimitiveName, choices: &[UvChoice]) {
        let Some((first, others)) = choices.split_first() else { return };
        if let Some(other) = others.iter().find(|other| other.set != first.set) {
            self.sentences.push(format!(
                "{name}: the tangents follow TEXCOORD_{} ({}), so they do not fit the variant whose {} uses \
                 TEXCOORD_{}",
                first.set, first.reason, other.reason, other.set
            ));
        }
    }

    fn transform(&mut self, uv: &UvChoice, options: &AddTangentsOptions, names: OptionNames) {
        let changes = uv.transform.as_ref().is_some_and(changes_directions);
        if changes && !options.apply_texture_transform && self.transformed.insert(uv.reason.clone()) {
            self.sentences.push(format!(
                "{}: KHR_texture_transform rotates or mirrors its UVs; the tangents follow the stored UVs, \
                 as the specification says; for renderers that transform them first, use {}",
                uv.reason, names.apply_texture_transform
            ));
        }
    }

    fn incomplete(&mut self, name: &PrimitiveName, chosen: &TangentInput) {
        let over = chosen.index_count % 3;
        if chosen.topology == TriangleMode::Triangles && over != 0 {
            self.sentences.push(format!(
                "{name}: its last {over} of {} corners do not form a triangle; they are kept, without \
                 tangents of their own",
                Count(chosen.index_count)
            ));
        }
    }
}
