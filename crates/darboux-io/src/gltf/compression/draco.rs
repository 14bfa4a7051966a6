//! KHR_draco_mesh_compression: primitives whose attributes and indices are encoded together.

use std::collections::HashMap;
use std::panic::catch_unwind;

use draco_core::decode_limits::DecodeLimits;
use draco_core::decoder_buffer::DecoderBuffer;
use draco_core::draco_types::DataType;
use draco_core::geometry_attribute::PointAttribute;
use draco_core::geometry_indices::PointIndex;
use draco_core::mesh::Mesh;
use draco_core::mesh_decoder::MeshDecoder;

use super::{element_text, unreadable, without_extension};
use crate::error::Fault;
use crate::gltf::document::Document;
use crate::gltf::json::{member, set_member};
use crate::gltf::schema::{Accessor, Draco, Primitive};
use crate::gltf::{ComponentType, ElementType, Elements, Target};

const NAME: &str = "KHR_draco_mesh_compression";
const TRIANGLES: u32 = 4;

/// Decodes every compressed primitive into plain accessors, which keep their numbers.
pub fn decompress(document: &mut Document) -> Result<(), Fault> {
    let mut decoded = HashMap::new();
    let mut any = false;
    for mesh in 0..document.root.meshes.len() {
        for place in 0..document.root.meshes[mesh].primitives.len() {
            let primitive = document.root.meshes[mesh].primitives[place].clone();
            let Some(draco) = &primitive.extensions.draco else { continue };
            let at = format!("meshes[{mesh}].primitives[{place}].extensions.{NAME}");
            fill_accessors(document, &primitive, draco, &at, &mut decoded)?;
            let text = document.primitive_text(mesh, place).unwrap_or("{}");
            let plain = without_extension(text, &[NAME]).map_err(unreadable)?;
            document.replace_primitive(mesh, place, plain).map_err(unreadable)?;
            any = true;
        }
    }
    if any {
        document.edits.removed_extensions.push(NAME);
    }
    Ok(())
}

/// Gives the accessors of one primitive their values. `decoded` holds which view each accessor was filled from.
fn fill_accessors(
    document: &mut Document,
    primitive: &Primitive,
    draco: &Draco,
    at: &str,
    decoded: &mut HashMap<usize, usize>,
) -> Result<(), Fault> {
    let attributes = draco.attributes.iter().map(|(semantic, &id)| {
        let accessor = primitive.attributes.get(semantic).copied();
        let missing = || {
            Fault::invalid(at, format!("has {semantic}, which the primitive has not; export the file again"))
        };
        Ok((accessor.ok_or_else(missing)?, Some(id)))
    });
    let indices = primitive.indices.map(|accessor| Ok((accessor, None)));
    let wanted: Vec<(usize, Option<u32>)> = attributes.chain(indices).collect::<Result<_, Fault>>()?;
    if wanted.iter().all(|(accessor, _)| decoded.get(accessor) == Some(&draco.buffer_view)) {
        return Ok(());
    }
    let mesh = decode(document, draco, primitive, at)?;
    for (index, id) in wanted {
        if decoded.insert(index, draco.buffer_view).is_some() {
            continue;
        }
        let path = format!("accessors[{index}]");
        let accessor = document.root.accessors.get(index);
        let accessor =
            accessor.ok_or_else(|| Fault::invalid(&path, "does not exist; export the file again"))?;
        let (bytes, target) = match id {
            Some(id) => (attribute_bytes(&mesh, id, accessor, &path)?, Target::Vertices),
            None => (index_bytes(&mesh, accessor, &path)?, Target::Indices),
        };
        fill(document, index, bytes, target).map_err(unreadable)?;
    }
    Ok(())
}

fn decode(document: &Document, draco: &Draco, primitive: &Primitive, at: &str) -> Result<Mesh, Fault> {
    // A strip's indices are not the faces in sequence, which is all that the decoder gives.
    if primitive.mode != TRIANGLES {
        let problem =
            format!("mode {} is not decoded, only triangles; save the model uncompressed", primitive.mode);
        return Err(Fault::unsupported(at, problem));
    }
    let (bytes, _) = document.view(draco.buffer_view, &format!("{at}.bufferView"))?;
    let limits = limits(document, primitive, bytes.len());
    // The decoder reports broken streams, but its indexing is not all checked: a panic is one more report.
    let decoded = catch_unwind(|| {
        let mut mesh = Mesh::new();
        let mut buffer = DecoderBuffer::new(bytes).with_limits(limits);
        MeshDecoder::new().decode(&mut buffer, &mut mesh).map(|()| mesh).map_err(|error| error.to_string())
    });
    let broken =
        |why: String| Fault::invalid(at, format!("its bytes cannot be decoded{why}; export the file again"));
    match decoded {
        Ok(Ok(mesh)) => Ok(mesh),
        Ok(Err(error)) => Err(broken(format!(" ({error})"))),
        Err(_panic) => Err(broken(String::new())),
    }
}

/// What the primitive's accessors promise, as far as so many bytes can hold it.
fn limits(document: &Document, primitive: &Primitive, bytes: usize) -> DecodeLimits {
    let count =
        |accessor: usize| document.root.accessors.get(accessor).map_or(0, |accessor| accessor.count as u64);
    let points = primitive.attributes.values().map(|&accessor| count(accessor)).max().unwrap_or(0);
    let faces = primitive.indices.map_or(0, count) / 3;
    // A face takes at least a fraction of a bit, an attribute at most four numbers of four bytes per point.
    let believed = (bytes as u64).saturating_mul(1 << 10).max(1 << 20);
    let size = points.saturating_mul(16 * (1 + primitive.attributes.len() as u64));
    DecodeLimits::permissive()
        .with_max_points(points.min(believed))
        .with_max_faces(faces.max(1).min(believed))
        .with_max_decoded_bytes(size.min(believed.saturating_mul(4)))
}

fn attribute_bytes(mesh: &Mesh, id: u32, accessor: &Accessor, at: &str) -> Result<Vec<u8>, Fault> {
    let invalid = |problem: String| Fault::invalid(at, format!("{problem}; export the file again"));
    let Some(attribute) = mesh.attribute_by_unique_id(id) else {
        return Err(invalid(format!("its Draco attribute {id} does not exist")));
    };
    if mesh.num_points() != accessor.count {
        return Err(invalid(format!(
            "has {} elements but Draco decodes {}",
            accessor.count,
            mesh.num_points()
        )));
    }
    let components = accessor.element_type.components();
    let fits =
        usize::from(attribute.num_components()) == components && accessor.element_type != ElementType::Mat2;
    if !fits || Some(accessor.component_type) != component_type(attribute.data_type()) {
        let found = format!("{} numbers of type {:?}", attribute.num_components(), attribute.data_type());
        return Err(Fault::unsupported(
            at,
            format!("Draco holds {found} for it; save the model uncompressed"),
        ));
    }
    let size = components * accessor.component_type.size();
    gather(attribute, mesh.num_points(), size).ok_or_else(|| invalid("its Draco attribute is broken".into()))
}

/// The values of an attribute, one per point; none where a point has no value.
fn gather(attribute: &PointAttribute, points: usize, size: usize) -> Option<Vec<u8>> {
    let (data, stride) = (attribute.buffer().data(), usize::try_from(attribute.byte_stride()).ok()?);
    let mut bytes = Vec::with_capacity(points.checked_mul(size)?);
    let values = attribute.explicit_mapping();
    for point in 0..points {
        let value = match values {
            Some(values) => values.get(point)?.0 as usize,
            None => attribute.mapped_index(PointIndex(point as u32)).0 as usize,
        };
        let start = value.checked_mul(stride)?;
        bytes.extend_from_slice(data.get(start..start.checked_add(size)?)?);
    }
    Some(bytes)
}

fn component_type(data_type: DataType) -> Option<ComponentType> {
    match data_type {
        DataType::Int8 => Some(ComponentType::I8),
        DataType::Uint8 => Some(ComponentType::U8),
        DataType::Int16 => Some(ComponentType::I16),
        DataType::Uint16 => Some(ComponentType::U16),
        DataType::Uint32 => Some(ComponentType::U32),
        DataType::Float32 => Some(ComponentType::F32),
        _ => None,
    }
}

fn index_bytes(mesh: &Mesh, accessor: &Accessor, at: &str) -> Result<Vec<u8>, Fault> {
    let count = 3 * mesh.num_faces();
    if count != accessor.count {
        let problem = format!("has {} elements but Draco decodes {count}", accessor.count);
        return Err(Fault::invalid(at, format!("{problem}; export the file again")));
    }
    let indices = mesh.faces().as_flattened().iter().map(|point| point.0);
    let narrow = |most: u32| {
        let wide = indices.clone().find(|&index| index > most);
        let problem = |index| format!("Draco decodes index {index}, which its component type cannot hold");
        wide.map_or(Ok(()), |index| {
            Err(Fault::invalid(at, format!("{}; export the file again", problem(index))))
        })
    };
    match accessor.component_type {
        ComponentType::U8 => narrow(0xff).map(|()| indices.map(|index| index as u8).collect()),
        ComponentType::U16 => {
            narrow(0xffff).map(|()| indices.flat_map(|index| (index as u16).to_le_bytes()).collect())
        }
        ComponentType::U32 => Ok(indices.flat_map(u32::to_le_bytes).collect()),
        _ => Err(Fault::invalid(at, "is signed or float; indices must be unsigned")),
    }
}

/// Gives an accessor a buffer view with these bytes. All else that its JSON says stays, but for bounds: decoded values are quantised, so
/// those of the original are wrong.
fn fill(document: &mut Document, index: usize, bytes: Vec<u8>, target: Target) -> serde_json::Result<()> {
    let Accessor { component_type, element_type, count, normalized, .. } = document.root.accessors[index];
    let elements = Elements { bytes, count, component_type, element_type, normalized };
    let size = elements.element_size();
    let stride = if target == Target::Vertices { size.next_multiple_of(4) } else { size };
    let view = document.push_view(&elements.bytes, size, stride, Some(target));
    let mut text = match document.edits.accessors.get(&index) {
        Some(edited) => edited.clone(),
        None => element_text(document, "accessors", index)?,
    };
    text = set_member(&text, "bufferView", Some(&view.to_string()))?;
    let (min, max) = elements.bounds().unzip();
    for (key, bound) in [("min", min), ("max", max)] {
        if member(&text, key)?.is_some() {
            text = set_member(&text, key, bound.as_deref())?;
        }
    }
    for key in ["byteOffset", "sparse"] {
        text = set_member(&text, key, None)?;
    }
    document.edits.accessors.insert(index, text);
    let accessor = &mut document.root.accessors[index];
    (accessor.buffer_view, accessor.byte_offset, accessor.sparse) = (Some(view), 0, None);
    Ok(())
}
