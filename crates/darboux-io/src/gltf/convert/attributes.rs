//! Converts vertex attributes and morph targets, each accessor once.

use std::collections::HashMap;

use crate::json::Value;
use darboux::{Convention, Conversion};

use super::summary::ConversionSummary;
use crate::Error;
use crate::gltf::primitives::append::{lacks_buffer_view, set_attributes};
use crate::gltf::primitives::canonical::CanonicalAccessors;
use crate::gltf::schema;
use crate::gltf::{ComponentType, Document, ElementType, Elements, NewAccessor, Target};

/// Converts attributes.
pub struct AttributeConverter<'a> {
    accessors: &'a CanonicalAccessors,
    conversion: Conversion,
    /// The kinds of attributes that change.
    changed: Vec<AttributeKind>,
    changes_axes: bool,
    /// Whether tangents change in other ways than by their axes.
    changes_tangents: bool,
    /// New accessors, by the old one and its kind.
    made: HashMap<(usize, AttributeKind), usize>,
}

/// The kind of an attribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum AttributeKind {
    Position,
    Normal,
    Tangent,
    TangentOffset,
    Uv,
    UvOffset,
}

impl AttributeKind {
    /// The kind of a semantic; none if no conversion changes it.
    fn of(semantic: &str, is_offset: bool) -> Option<Self> {
        match (semantic, is_offset) {
            ("POSITION", _) => Some(Self::Position),
            ("NORMAL", _) => Some(Self::Normal),
            ("TANGENT", false) => Some(Self::Tangent),
            ("TANGENT", true) => Some(Self::TangentOffset),
            (name, _) if !name.starts_with("TEXCOORD_") => None,
            (_, false) => Some(Self::Uv),
            (_, true) => Some(Self::UvOffset),
        }
    }
}

impl<'a> AttributeConverter<'a> {
    pub fn new(accessors: &'a CanonicalAccessors, from: Convention, to: Convention) -> Self {
        let conversion = from.to(to);
        let changes_axes = from.axes != to.axes;
        let mut changed = Vec::new();
        if changes_axes {
            changed.extend([AttributeKind::Position, AttributeKind::Normal]);
        }
        let changes_tangents = conversion.inverts_red() || conversion.tangent([0.0, 0.0, 0.0, 1.0])[3] < 0.0;
        if changes_axes || changes_tangents {
            changed.extend([AttributeKind::Tangent, AttributeKind::TangentOffset]);
        }
        if from.uv_origin != to.uv_origin {
            changed.extend([AttributeKind::Uv, AttributeKind::UvOffset]);
        }
        Self { accessors, conversion, changed, changes_axes, changes_tangents, made: HashMap::new() }
    }

    /// Converts a primitive. Returns whether anything changed.
    pub fn convert(&mut self, document: &mut Document, mesh: usize, place: usize) -> Result<bool, Error> {
        let primitive = document.meshes()[mesh].primitives[place].clone();
        let new = self.converted(document, &primitive.attributes, false)?;
        let mut targets = Vec::with_capacity(primitive.targets.len());
        for target in &primitive.targets {
            targets.push(self.converted(document, target, true)?);
        }
        if new.is_empty() && targets.iter().all(schema::Attributes::is_empty) {
            return Ok(false);
        }
        document.edit_primitive(mesh, place, |json| {
            set_attributes(json.get_mut("attributes"), &new);
            let places = json.get_mut("targets").and_then(Value::as_array_mut);
            for (place, target) in places.into_iter().flatten().zip(&targets) {
                set_attributes(Some(place), target);
            }
        })?;
        Ok(true)
    }

    /// Adds the changes of all primitives to a summary.
    pub fn sum_up(&self, summary: &mut ConversionSummary) {
        for (_, kind) in self.made.keys() {
            let (is_uv, is_tangent) = (
                matches!(kind, AttributeKind::Uv | AttributeKind::UvOffset),
                matches!(kind, AttributeKind::Tangent | AttributeKind::TangentOffset),
            );
            summary.uvs_flipped |= is_uv;
            summary.axes_changed |= self.changes_axes && !is_uv;
            summary.tangents_changed |= self.changes_tangents && is_tangent;
        }
    }

    /// The new accessors of the attributes that change.
    fn converted(
        &mut self,
        document: &mut Document,
        old: &schema::Attributes,
        is_offset: bool,
    ) -> Result<schema::Attributes, Error> {
        let mut new = schema::Attributes::new();
        for (semantic, &accessor) in old {
            let kind = AttributeKind::of(semantic, is_offset).filter(|kind| self.changed.contains(kind));
            if let Some(kind) = kind {
                new.insert(semantic.clone(), self.accessor(document, accessor, kind)?);
            }
        }
        Ok(new)
    }

    fn accessor(&mut self, document: &mut Document, old: usize, kind: AttributeKind) -> Result<usize, Error> {
        let key = (self.accessors.of(old), kind);
        if let Some(&made) = self.made.get(&key) {
            return Ok(made);
        }
        let Self { conversion, .. } = self;
        let elements = match kind {
            AttributeKind::Position | AttributeKind::Normal => {
                floats(ElementType::Vec3, &document.vectors(old)?, |vector| conversion.vector(vector))
            }
            AttributeKind::Tangent => {
                floats(ElementType::Vec4, &document.vectors(old)?, |tangent| conversion.tangent(tangent))
            }
            AttributeKind::TangentOffset => {
                floats(ElementType::Vec3, &document.vectors(old)?, |[x, y, z]| {
                    let [x, y, z, _] = conversion.tangent([x, y, z, 0.0]);
                    [x, y, z]
                })
            }
            AttributeKind::Uv => floats(ElementType::Vec2, &document.vectors(old)?, |uv| conversion.uv(uv)),
            // v becomes 1 - v, so that an offset of v becomes its negative.
            AttributeKind::UvOffset => floats(ElementType::Vec2, &document.vectors(old)?, |[u, v]| [u, -v]),
        };
        let (bounds, sparse) = (kind == AttributeKind::Position, lacks_buffer_view(document, old));
        let elements = if sparse { without_negative_zeros(elements) } else { elements };
        let new = NewAccessor::new(elements, Target::Vertices)
            .with_bounds(bounds)
            .with_sparse(sparse)
            .with_metadata_of(Some(old));
        let made = document.push_accessor(new);
        self.made.insert(key, made);
        Ok(made)
    }
}

/// Elements of floats: `vectors`, each changed by a function.
pub fn floats<const N: usize>(
    element_type: ElementType,
    vectors: &[[f32; N]],
    change: impl Fn([f32; N]) -> [f32; N],
) -> Elements {
    let changed = vectors.iter().map(|&vector| change(vector));
    Elements {
        bytes: changed.flatten().flat_map(f32::to_le_bytes).collect(),
        count: vectors.len(),
        component_type: ComponentType::F32,
        element_type,
        normalized: false,
    }
}

/// Turns -0 into 0, since sparse accessors omit elements whose bits are all zero.
fn without_negative_zeros(mut elements: Elements) -> Elements {
    for bytes in elements.bytes.as_chunks_mut::<4>().0 {
        *bytes = (f32::from_le_bytes(*bytes) + 0.0).to_le_bytes();
    }
    elements
}
