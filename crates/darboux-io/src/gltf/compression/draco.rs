//! `KHR_draco_mesh_compression`: decodes primitives whose indices and attributes are in a Draco stream.

use std::collections::{BTreeSet, HashMap};
use std::panic;

use ::draco_core::{
    DataType, DecodeLimits, DecoderBuffer, ErrorKind, FaceIndex, Mesh, MeshDecoder, PointAttribute,
    PointIndex,
};

use super::DecodeBudget;
use crate::error::ContentError;
use crate::gltf::document::Document;
use crate::gltf::element_type::{ComponentType, ElementType};
use crate::gltf::elements::{Elements, Target};
use crate::gltf::schema::{Accessor, Draco, Primitive};

const NAME: &str = "KHR_draco_mesh_compression";

/// What a decoded face takes in memory: three indices of 32 bits.
const BYTES_PER_FACE: usize = 12;

/// What a decoded point takes at least, whichever of its attributes are wanted.
const BYTES_PER_POINT: usize = 12;

/// The source of each decoded accessor: the buffer view, and Draco's identifier of the attribute, or none for
/// indices.
type Sources = HashMap<usize, (usize, Option<u32>)>;

impl Document {
    /// Decodes every compressed primitive. Returns the decoded accessors.
    pub(super) fn decode_draco(
        &mut self,
        budget: &mut DecodeBudget,
    ) -> Result<BTreeSet<usize>, ContentError> {
        let mut sources = Sources::new();
        let mut last = None;
        for mesh in 0..self.root.meshes.len() {
            for i in 0..self.root.meshes[mesh].primitives.len() {
                let primitive = &self.root.meshes[mesh].primitives[i];
                let Some(draco) = primitive.extensions.draco.clone() else { continue };
                let at = format!("meshes[{mesh}].primitives[{i}]");
                let wanted = wanted_accessors(primitive, &draco, &at)?;
                if !self.has_data(&wanted, &draco, &sources, &at)? {
                    self.decode_primitive(&wanted, &draco, budget, (&mut sources, &mut last), &at)?;
                }
                self.remove_primitive_extension(mesh, i, NAME)?;
            }
        }
        self.undeclare_extensions(&[NAME]);
        Ok(sources.into_keys().collect())
    }

    /// Whether the accessors have data already: an uncompressed fallback, or the same stream decoded for
    /// another primitive.
    fn has_data(
        &self,
        wanted: &[(usize, Option<u32>)],
        draco: &Draco,
        sources: &Sources,
        at: &str,
    ) -> Result<bool, ContentError> {
        let mut with_data = 0;
        for &(index, id) in wanted {
            let accessor = self.root.accessors.get(index).ok_or_else(|| {
                ContentError::invalid(at, format!("accessor {index} does not exist; export the file again"))
            })?;
            if sources.get(&index).is_some_and(|source| *source != (draco.buffer_view, id)) {
                let problem = format!("accessor {index} belongs to two Draco streams; export the file again");
                return Err(ContentError::invalid(at, problem));
            }
            with_data += usize::from(accessor.buffer_view.is_some());
        }
        if with_data > 0
            && with_data < wanted.len()
            && !wanted.iter().any(|(index, _)| sources.contains_key(index))
        {
            let problem = "is compressed in part only, so that the order of its vertices is unknown; export \
                 the file again";
            return Err(ContentError::unsupported(at, problem));
        }
        Ok(with_data == wanted.len())
    }

    fn decode_primitive(
        &mut self,
        wanted: &[(usize, Option<u32>)],
        draco: &Draco,
        budget: &mut DecodeBudget,
        (sources, last): (&mut Sources, &mut Option<(usize, Mesh)>),
        at: &str,
    ) -> Result<(), ContentError> {
        let at = format!("{at}.extensions.{NAME}");
        // Consecutive primitives over one stream share what it holds.
        let mesh = match last {
            Some((view, mesh)) if *view == draco.buffer_view => mesh,
            _ => {
                let (stream, _) = self.view(draco.buffer_view, &format!("{at}.bufferView"))?;
                let mesh = decode(stream, budget.left).map_err(|problem| {
                    ContentError::invalid(&at, format!("the stream {problem}; compress the file again"))
                })?;
                // The whole stream was decoded, whichever of its accessors are new: this bounds the time of
                // primitives that read several streams in turn.
                budget.spend(mesh.num_points().saturating_mul(BYTES_PER_POINT), &at)?;
                &mut last.insert((draco.buffer_view, mesh)).1
            }
        };
        budget.spend(mesh.num_faces().saturating_mul(BYTES_PER_FACE), &at)?;
        for &(index, id) in wanted {
            let accessor = &self.root.accessors[index];
            if accessor.buffer_view.is_some() {
                continue;
            }
            let decoded = match id {
                None => index_elements(mesh, accessor),
                Some(id) => attribute_elements(mesh, id, accessor),
            };
            let elements = decoded.map_err(|problem| {
                ContentError::invalid(&at, format!("accessors[{index}]: {problem}; compress the file again"))
            })?;
            budget.spend(elements.bytes.len(), &at)?;
            let target = if id.is_none() { Target::Indices } else { Target::Vertices };
            let size = elements.element_size();
            self.decompressed_bytes += elements.bytes.len();
            let view = self.push_view(elements.bytes, size, target.stride(size), Some(target));
            self.edit_element("accessors", index, |accessor| {
                accessor.as_object_mut().and_then(|accessor| accessor.remove("byteOffset"));
                accessor["bufferView"] = view.into();
            })?;
            sources.insert(index, (draco.buffer_view, id));
        }
        Ok(())
    }
}

/// The accessors that a stream fills, with Draco's identifier of each attribute, or none for the indices.
fn wanted_accessors(
    primitive: &Primitive,
    draco: &Draco,
    at: &str,
) -> Result<Vec<(usize, Option<u32>)>, ContentError> {
    let unsupported =
        |problem: &str| ContentError::unsupported(at, format!("{problem}; export the file again"));
    if primitive.mode != 4 {
        return Err(unsupported("is compressed by Draco but is not a triangle list"));
    }
    let indices =
        primitive.indices.ok_or_else(|| unsupported("is compressed by Draco but has no indices"))?;
    let mut wanted = vec![(indices, None)];
    for (name, &id) in &draco.attributes {
        // An attribute of the stream that the primitive does not have is not used by anything.
        let accessor = primitive.attributes.get(name);
        wanted.extend(accessor.map(|&accessor| (accessor, Some(id))));
    }
    Ok(wanted)
}

/// The error is a clause whose subject is the stream.
fn decode(stream: &[u8], max_bytes: usize) -> Result<Mesh, &'static str> {
    let limits = DecodeLimits::default().with_max_decoded_bytes(max_bytes as u64);
    // A panic of the decoder becomes an error of this file. None is known.
    let decoded = panic::catch_unwind(|| {
        let mut mesh = Mesh::new();
        let mut buffer = DecoderBuffer::new(stream).with_limits(limits);
        MeshDecoder::new().decode(&mut buffer, &mut mesh).map(|()| mesh)
    });
    decoded.map_err(|_| "makes the decoder fail")?.map_err(|error| match error.kind() {
        ErrorKind::LimitExceeded => "needs more memory than the limit",
        ErrorKind::UnsupportedVersion | ErrorKind::UnsupportedFeature => {
            "is of a kind that has no decoder here"
        }
        _ => "is broken",
    })
}

fn index_elements(mesh: &Mesh, accessor: &Accessor) -> Result<Elements, String> {
    let count = mesh.num_faces().saturating_mul(3);
    if count != accessor.count || accessor.element_type != ElementType::Scalar {
        return Err(format!("the accessor has {} indices but the stream has {count}", accessor.count));
    }
    let size = accessor.component_type.size();
    let mut bytes = Vec::with_capacity(count * size);
    for face in 0..mesh.num_faces() {
        for PointIndex(point) in mesh.face(FaceIndex(face as u32)) {
            if point as usize >= mesh.num_points() || !fits(accessor.component_type, i64::from(point)) {
                return Err(format!("index {point} is out of range"));
            }
            bytes.extend_from_slice(&point.to_le_bytes()[..size]);
        }
    }
    Ok(elements(accessor, bytes))
}

fn attribute_elements(mesh: &Mesh, id: u32, accessor: &Accessor) -> Result<Elements, String> {
    let attribute =
        mesh.attribute_by_unique_id(id).ok_or_else(|| format!("the stream has no attribute {id}"))?;
    if mesh.num_points() != accessor.count {
        return Err(format!(
            "the accessor has {} elements but the stream has {}",
            accessor.count,
            mesh.num_points()
        ));
    }
    let components = usize::from(attribute.num_components());
    if components != accessor.element_type.components() {
        return Err(format!(
            "the accessor is {} but the stream has {components} components",
            accessor.element_type.name()
        ));
    }
    let from = attribute.data_type();
    let size = components * from.byte_length();
    let mut bytes = Vec::with_capacity(accessor.count * size);
    for point in 0..mesh.num_points() {
        let element = stored(attribute, point as u32, size).ok_or("the stream lacks elements")?;
        if same_type(from, accessor.component_type) {
            bytes.extend_from_slice(element);
        } else {
            convert(from, element, accessor.component_type, &mut bytes)?;
        }
    }
    Ok(elements(accessor, bytes))
}

fn elements(accessor: &Accessor, bytes: Vec<u8>) -> Elements {
    let Accessor { count, component_type, element_type, normalized, .. } = *accessor;
    Elements { bytes, count, component_type, element_type, normalized }
}

/// The bytes of an attribute at a point, if the stream has them.
fn stored(attribute: &PointAttribute, point: u32, size: usize) -> Option<&[u8]> {
    let start = (attribute.mapped_index(PointIndex(point)).0 as usize).checked_mul(size)?;
    attribute.buffer().data().get(start..start.checked_add(size)?)
}

fn same_type(from: DataType, to: ComponentType) -> bool {
    matches!(
        (from, to),
        (DataType::Int8, ComponentType::I8)
            | (DataType::Uint8, ComponentType::U8)
            | (DataType::Int16, ComponentType::I16)
            | (DataType::Uint16, ComponentType::U16)
            | (DataType::Uint32, ComponentType::U32)
            | (DataType::Float32, ComponentType::F32)
    )
}

/// Converts integers to another integer type. Errors: a value does not fit.
fn convert(from: DataType, element: &[u8], to: ComponentType, out: &mut Vec<u8>) -> Result<(), String> {
    let is_signed = match from {
        DataType::Int8 | DataType::Int16 | DataType::Int32 => true,
        DataType::Uint8 | DataType::Uint16 | DataType::Uint32 => false,
        _ => return Err(format!("{from:?} in the stream is not the accessor's component type")),
    };
    for bytes in element.chunks_exact(from.byte_length()) {
        let unsigned = bytes.iter().rev().fold(0i64, |value, &byte| value << 8 | i64::from(byte));
        let wrap = 1i64 << (8 * bytes.len());
        let value = if is_signed && unsigned >= wrap / 2 { unsigned - wrap } else { unsigned };
        if !fits(to, value) {
            return Err(format!("{value} in the stream does not fit the accessor's component type"));
        }
        out.extend_from_slice(&value.to_le_bytes()[..to.size()]);
    }
    Ok(())
}

fn fits(kind: ComponentType, value: i64) -> bool {
    match kind {
        ComponentType::I8 => i8::try_from(value).is_ok(),
        ComponentType::U8 => u8::try_from(value).is_ok(),
        ComponentType::I16 => i16::try_from(value).is_ok(),
        ComponentType::U16 => u16::try_from(value).is_ok(),
        ComponentType::U32 => u32::try_from(value).is_ok(),
        ComponentType::F32 => false,
    }
}
