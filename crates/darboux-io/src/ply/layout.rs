//! What the properties of a vertex are, by the names that programs give them.

use super::header::Element;

/// What a property of a vertex is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexProperty {
    Position(usize),
    Normal(usize),
    /// A UV set, and the axis.
    Uv(usize, usize),
    Color(usize),
    Tangent(usize),
    Other,
}

/// The properties of a vertex.
#[derive(Debug)]
pub struct VertexLayout {
    /// What each property is. Properties without their companions, such as `nx` without `ny`, count as
    /// others.
    pub kinds: Vec<VertexProperty>,
    /// The name of each UV set; empty where the file has one.
    pub uv_sets: Vec<String>,
    pub has_normals: bool,
    pub has_colors: bool,
    pub has_tangents: bool,
}

const POSITIONS: [[&str; 3]; 1] = [["x", "y", "z"]];

const NORMALS: [[&str; 3]; 3] =
    [["nx", "ny", "nz"], ["normal_x", "normal_y", "normal_z"], ["normalx", "normaly", "normalz"]];

/// A file that has several of these has as many UV sets, in this order.
const UVS: [[&str; 2]; 14] = [
    ["s", "t"],
    ["u", "v"],
    ["texture_u", "texture_v"],
    ["texcoord_u", "texcoord_v"],
    ["texcoord_x", "texcoord_y"],
    ["tx_u", "tx_v"],
    ["tu", "tv"],
    ["tx", "ty"],
    ["s0", "t0"],
    ["u0", "v0"],
    ["s1", "t1"],
    ["u1", "v1"],
    ["s2", "t2"],
    ["u2", "v2"],
];

const COLORS: [[&str; 3]; 4] = [
    ["red", "green", "blue"],
    ["diffuse_red", "diffuse_green", "diffuse_blue"],
    ["diffuse_r", "diffuse_g", "diffuse_b"],
    ["r", "g", "b"],
];

const ALPHAS: [&str; 3] = ["alpha", "diffuse_alpha", "a"];

/// The names that this crate writes.
const TANGENTS: [[&str; 4]; 1] = [["tangent_x", "tangent_y", "tangent_z", "tangent_w"]];

/// The layout of an element of vertices; none without positions.
pub fn layout(element: &Element) -> Option<VertexLayout> {
    let mut kinds = vec![VertexProperty::Other; element.properties.len()];
    let place = |name: &str| {
        element.properties.iter().position(|property| property.name == name && property.length.is_none())
    };
    let first = |families: &[[&str; 3]]| families.iter().find_map(|names| places(names, place));
    let mut set = |places: &[usize], kind: &dyn Fn(usize) -> VertexProperty| {
        places.iter().enumerate().for_each(|(axis, &at)| kinds[at] = kind(axis));
    };
    set(&first(&POSITIONS)?, &VertexProperty::Position);
    let [normals, colors] = [&NORMALS[..], &COLORS].map(first);
    normals.iter().for_each(|places| set(places, &VertexProperty::Normal));
    colors.iter().for_each(|places| set(places, &VertexProperty::Color));
    if let (Some(_), Some(alpha)) = (&colors, ALPHAS.iter().find_map(|name| place(name))) {
        set(&[alpha], &|_| VertexProperty::Color(3));
    }
    let tangents = TANGENTS.iter().find_map(|names| places(names, place));
    tangents.iter().for_each(|places| set(places, &VertexProperty::Tangent));
    let mut uv_sets = Vec::new();
    for names in &UVS {
        // With a third component, `tx` and `ty` belong to a vector.
        let is_vector = names[0] == "tx" && place("tz").is_some();
        if let Some(places) = places(names, place).filter(|_| !is_vector) {
            let uv_set = uv_sets.len();
            set(&places, &|axis| VertexProperty::Uv(uv_set, axis));
            uv_sets.push(names.join(" "));
        }
    }
    if let [only] = &mut uv_sets[..] {
        only.clear();
    }
    let (has_normals, has_colors, has_tangents) = (normals.is_some(), colors.is_some(), tangents.is_some());
    Some(VertexLayout { kinds, uv_sets, has_normals, has_colors, has_tangents })
}

/// The places of properties; none unless all are there.
fn places<const N: usize>(names: &[&str; N], place: impl Fn(&str) -> Option<usize>) -> Option<[usize; N]> {
    let mut found = [0; N];
    for (slot, name) in found.iter_mut().zip(names) {
        *slot = place(name)?;
    }
    Some(found)
}
