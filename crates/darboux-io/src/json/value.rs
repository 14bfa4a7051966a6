//! [`Value`]: a JSON value whose objects keep the order of their members and whose numbers keep their
//! spelling.

use std::collections::HashMap;
use std::fmt;
use std::ops::{Deref, Index, IndexMut};

/// A JSON value.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Value {
    /// `null`.
    #[default]
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A number.
    Number(Number),
    /// A string, without escapes.
    String(Box<str>),
    /// An array.
    Array(Vec<Value>),
    /// An object.
    Object(Map),
}

static NULL: Value = Value::Null;

impl Value {
    /// The member of an object with a key, or the element of an array with an index; none if it does not
    /// exist.
    pub fn get(&self, place: impl Place) -> Option<&Self> {
        place.of(self)
    }

    /// As [`Value::get`], to change it.
    pub fn get_mut(&mut self, place: impl Place) -> Option<&mut Self> {
        place.of_mut(self)
    }

    /// The elements of an array; none for other values.
    pub fn as_array(&self) -> Option<&Vec<Self>> {
        if let Self::Array(elements) = self { Some(elements) } else { None }
    }

    /// As [`Value::as_array`], to change them.
    pub fn as_array_mut(&mut self) -> Option<&mut Vec<Self>> {
        if let Self::Array(elements) = self { Some(elements) } else { None }
    }

    /// The members of an object; none for other values.
    pub fn as_object(&self) -> Option<&Map> {
        if let Self::Object(members) = self { Some(members) } else { None }
    }

    /// As [`Value::as_object`], to change them.
    pub fn as_object_mut(&mut self) -> Option<&mut Map> {
        if let Self::Object(members) = self { Some(members) } else { None }
    }

    /// A string; none for other values.
    pub fn as_str(&self) -> Option<&str> {
        if let Self::String(text) = self { Some(text) } else { None }
    }

    /// A whole number of 64 bits that is spelled as one; none for other values.
    pub fn as_u64(&self) -> Option<u64> {
        if let Self::Number(Number::Whole(number)) = self { Some(*number) } else { None }
    }

    /// The nearest number of 64 bits; none for values that are no numbers.
    pub fn as_f64(&self) -> Option<f64> {
        match self {
            Self::Number(Number::Whole(number)) => Some(*number as f64),
            Self::Number(Number::Spelled(text)) => text.parse().ok(),
            _ => None,
        }
    }

    /// Whether it is null.
    pub fn is_null(&self) -> bool {
        *self == Self::Null
    }

    /// Whether it is an array.
    pub fn is_array(&self) -> bool {
        matches!(self, Self::Array(_))
    }

    /// Whether it is an object.
    pub fn is_object(&self) -> bool {
        matches!(self, Self::Object(_))
    }
}

/// A number as it is spelled.
#[derive(Clone, Debug, PartialEq)]
pub enum Number {
    /// A whole number of 64 bits.
    Whole(u64),
    /// Another number, in the spelling of JSON.
    Spelled(Box<str>),
}

/// The name of a member. Names of glTF are not stored again and again.
#[derive(Clone)]
pub struct Key(Name);

#[derive(Clone)]
enum Name {
    Known(&'static str),
    Other(Box<str>),
}

/// Defines [`known_name`] for a list of names.
macro_rules! known_names {
    ($($name:literal)*) => {
        fn known_name(name: &str) -> Option<&'static str> {
            match name {
                $($name => Some($name),)*
                _ => None,
            }
        }
    };
}

known_names! {
    "JOINTS_0" "NORMAL" "POSITION" "TANGENT" "TEXCOORD_0" "TEXCOORD_1" "WEIGHTS_0" "attributes" "buffer" "bufferView"
    "byteLength" "byteOffset" "byteStride" "channels" "children" "componentType" "count" "extensions" "extras" "index"
    "indices" "input" "interpolation" "joints" "material" "matrix" "max" "mesh" "min" "mode" "name" "node" "normalized"
    "output" "path" "primitives" "rotation" "sampler" "samplers" "scale" "source" "sparse" "target" "targets" "texCoord"
    "translation" "type" "uri" "values" "weights"
}

impl Key {
    /// The name.
    pub fn as_str(&self) -> &str {
        match &self.0 {
            Name::Known(name) => name,
            Name::Other(name) => name,
        }
    }
}

impl From<&str> for Key {
    fn from(name: &str) -> Self {
        Self(known_name(name).map_or_else(|| Name::Other(name.into()), Name::Known))
    }
}

impl Deref for Key {
    type Target = str;

    fn deref(&self) -> &str {
        self.as_str()
    }
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.as_str() == other.as_str()
    }
}

impl fmt::Debug for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.as_str().fmt(f)
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// Objects with more members have an index of their keys.
const INDEXED: usize = 32;

/// The members of an object in their order, each key once.
#[derive(Clone, Default)]
pub struct Map {
    members: Vec<(Key, Value)>,
    /// The place of each key, in objects with many members.
    #[expect(clippy::box_collection, reason = "few objects have one, and values stay small")]
    place_of: Option<Box<HashMap<Box<str>, usize>>>,
}

impl Map {
    /// Members with keys that differ. Errors: a key that two members have.
    pub(crate) fn from_members(members: Vec<(Key, Value)>) -> Result<Self, Key> {
        if members.len() <= INDEXED {
            let has_before = |&at: &usize| members[..at].iter().any(|(key, _)| *key == members[at].0);
            return match (1..members.len()).find(has_before) {
                Some(at) => Err(members[at].0.clone()),
                None => Ok(Self { members, place_of: None }),
            };
        }
        let mut place_of = HashMap::with_capacity(members.len());
        for (place, (key, _)) in members.iter().enumerate() {
            if place_of.insert(key.as_str().into(), place).is_some() {
                return Err(key.clone());
            }
        }
        Ok(Self { members, place_of: Some(Box::new(place_of)) })
    }

    fn place(&self, key: &str) -> Option<usize> {
        match &self.place_of {
            Some(place_of) => place_of.get(key).copied(),
            None => self.members.iter().position(|(known, _)| known.as_str() == key),
        }
    }

    /// Indexes the keys again after members were removed.
    fn index_again(&mut self) {
        let members = std::mem::take(&mut self.members);
        *self = Self::from_members(members).unwrap_or_default();
    }

    /// The number of members.
    pub fn len(&self) -> usize {
        self.members.len()
    }

    /// Whether there are no members.
    pub fn is_empty(&self) -> bool {
        self.members.is_empty()
    }

    /// Whether there is a member.
    pub fn contains_key(&self, key: &str) -> bool {
        self.place(key).is_some()
    }

    /// The value of a member.
    pub fn get(&self, key: &str) -> Option<&Value> {
        self.place(key).map(|place| &self.members[place].1)
    }

    /// As [`Map::get`], to change it.
    pub fn get_mut(&mut self, key: &str) -> Option<&mut Value> {
        self.place(key).map(|place| &mut self.members[place].1)
    }

    /// The value of a member, which is added as null after the others if it does not exist.
    pub fn get_or_add(&mut self, key: &str) -> &mut Value {
        let place = self.place(key).unwrap_or_else(|| {
            let place = self.members.len();
            self.members.push((key.into(), Value::Null));
            match &mut self.place_of {
                Some(place_of) => drop(place_of.insert(key.into(), place)),
                None if place == INDEXED => self.index_again(),
                None => {}
            }
            place
        });
        &mut self.members[place].1
    }

    /// Sets a member, which keeps its place if it exists and else becomes the last one. Returns the old
    /// value.
    pub fn insert(&mut self, key: impl AsRef<str>, value: Value) -> Option<Value> {
        let is_new = !self.contains_key(key.as_ref());
        let old = std::mem::replace(self.get_or_add(key.as_ref()), value);
        (!is_new).then_some(old)
    }

    /// Removes a member. The others keep their order. Returns its value.
    pub fn remove(&mut self, key: &str) -> Option<Value> {
        let (_, value) = self.members.remove(self.place(key)?);
        self.index_again();
        Some(value)
    }

    /// Removes the members for which a function returns false.
    pub fn retain(&mut self, mut is_kept: impl FnMut(&str, &Value) -> bool) {
        self.members.retain(|(key, value)| is_kept(key, value));
        self.index_again();
    }

    /// The members in their order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&Key, &Value)> {
        self.into_iter()
    }

    /// The keys in their order.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.members.iter().map(|(key, _)| key.as_str())
    }
}

impl fmt::Debug for Map {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_map().entries(self.iter()).finish()
    }
}

/// Objects are equal if they have the same members in the same order.
impl PartialEq for Map {
    fn eq(&self, other: &Self) -> bool {
        self.members == other.members
    }
}

impl Index<&str> for Map {
    type Output = Value;

    fn index(&self, key: &str) -> &Value {
        self.get(key).unwrap_or(&NULL)
    }
}

impl IndexMut<&str> for Map {
    fn index_mut(&mut self, key: &str) -> &mut Value {
        self.get_or_add(key)
    }
}

type Member<'a> = fn(&'a (Key, Value)) -> (&'a Key, &'a Value);
type MemberMut<'a> = fn(&'a mut (Key, Value)) -> (&'a Key, &'a mut Value);

impl<'a> IntoIterator for &'a Map {
    type Item = (&'a Key, &'a Value);
    type IntoIter = std::iter::Map<std::slice::Iter<'a, (Key, Value)>, Member<'a>>;

    fn into_iter(self) -> Self::IntoIter {
        self.members.iter().map(|(key, value)| (key, value))
    }
}

impl<'a> IntoIterator for &'a mut Map {
    type Item = (&'a Key, &'a mut Value);
    type IntoIter = std::iter::Map<std::slice::IterMut<'a, (Key, Value)>, MemberMut<'a>>;

    fn into_iter(self) -> Self::IntoIter {
        self.members.iter_mut().map(|(key, value)| (&*key, value))
    }
}

/// A key of an object or an index of an array.
pub trait Place: Copy {
    /// The value at the place.
    fn of(self, value: &Value) -> Option<&Value>;
    /// The value at the place, to change it.
    fn of_mut(self, value: &mut Value) -> Option<&mut Value>;
    /// The value at the place, which is added if it is a member that does not exist. Null becomes an object
    /// for it.
    fn of_or_add(self, value: &mut Value) -> Option<&mut Value>;
}

impl Place for &str {
    fn of(self, value: &Value) -> Option<&Value> {
        value.as_object()?.get(self)
    }

    fn of_mut(self, value: &mut Value) -> Option<&mut Value> {
        value.as_object_mut()?.get_mut(self)
    }

    fn of_or_add(self, value: &mut Value) -> Option<&mut Value> {
        if value.is_null() {
            *value = Value::Object(Map::default());
        }
        Some(value.as_object_mut()?.get_or_add(self))
    }
}

impl Place for usize {
    fn of(self, value: &Value) -> Option<&Value> {
        value.as_array()?.get(self)
    }

    fn of_mut(self, value: &mut Value) -> Option<&mut Value> {
        value.as_array_mut()?.get_mut(self)
    }

    fn of_or_add(self, value: &mut Value) -> Option<&mut Value> {
        self.of_mut(value)
    }
}

/// The value at a place; null if it does not exist.
impl<P: Place> Index<P> for Value {
    type Output = Self;

    fn index(&self, place: P) -> &Self {
        place.of(self).unwrap_or(&NULL)
    }
}

/// The value at a place. A member that does not exist is added. Panics if the value can have no such place.
impl<P: Place> IndexMut<P> for Value {
    fn index_mut(&mut self, place: P) -> &mut Self {
        place.of_or_add(self).expect("an object for a key, or an array with the element")
    }
}
