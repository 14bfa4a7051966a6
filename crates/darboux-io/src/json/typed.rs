//! Values as other types, by serde.

use std::fmt::Display;

use serde::de::value::{Error, MapDeserializer, SeqDeserializer};
use serde::de::{DeserializeOwned, Deserializer, IntoDeserializer, Visitor};
use serde::forward_to_deserialize_any;
use serde::ser::{Serialize, Serializer};
use serde_path_to_error::Segment;

use super::value::{Key, Number, Value};
use crate::error::{ContentError, shortened};

/// A part of a document's JSON as another type. `at` is the JSON path of the part. Errors: it is not of that
/// type.
pub fn read<T: DeserializeOwned>(value: &Value, at: &str) -> Result<T, ContentError> {
    // Tracking the path of a failure costs time, so only a value that fails is read again for it.
    T::deserialize(value).or_else(|_| {
        serde_path_to_error::deserialize(value).map_err(|error| {
            let (path, found) = (error.path().to_string(), value_at(value, error.path()));
            let path = if path == "." { "" } else { path.as_str() };
            let separator = if at.is_empty() || path.is_empty() || path.starts_with('[') { "" } else { "." };
            let problem = mismatch(found, &error.inner().to_string());
            ContentError::invalid(
                format!("{at}{separator}{path}"),
                format!("{problem}; export the file again"),
            )
        })
    })
}

/// The value at a path, as far as it exists.
fn value_at<'a>(value: &'a Value, path: &serde_path_to_error::Path) -> &'a Value {
    path.iter().fold(value, |value, segment| match segment {
        Segment::Seq { index } => value.get(*index).unwrap_or(value),
        Segment::Map { key } => value.get(key.as_str()).unwrap_or(value),
        _ => value,
    })
}

/// What is wrong with a value, as a clause whose subject is its place. `message`: serde's.
fn mismatch(found: &Value, message: &str) -> String {
    if let Some(name) = message.strip_prefix("missing field ") {
        return format!("has no {}", name.trim_matches('`'));
    }
    let expected = match message.rsplit_once(", expected ") {
        Some((_, expected)) => expected_value(expected),
        None if message == "invalid number" => expected_value("usize"),
        None => return shortened(message),
    };
    let found = match found {
        Value::Null => "null".to_owned(),
        Value::Array(_) => "an array".to_owned(),
        Value::Object(_) => "an object".to_owned(),
        other => shortened(&other.to_string()),
    };
    format!("is {found}; it must be {expected}")
}

/// A type in the words of JSON. `name`: as serde calls it.
fn expected_value(name: &str) -> String {
    match name {
        "usize" | "u64" | "u32" => "a whole number of 0 or more".to_owned(),
        "f32" | "f64" => "a number".to_owned(),
        "a map" => "an object".to_owned(),
        "a sequence" => "an array".to_owned(),
        "a boolean" => "true or false".to_owned(),
        "string or map" | "map with a single key" => "a string".to_owned(),
        name if name.starts_with("struct ") => "an object".to_owned(),
        name => match name.strip_prefix("an array of length ") {
            Some(length) => format!("an array of {length} numbers"),
            None => name.replace('`', ""),
        },
    }
}

impl<'de> IntoDeserializer<'de> for &'de Value {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

impl<'de> IntoDeserializer<'de> for &'de Key {
    type Deserializer = serde::de::value::BorrowedStrDeserializer<'de, Error>;

    fn into_deserializer(self) -> Self::Deserializer {
        serde::de::value::BorrowedStrDeserializer::new(self.as_str())
    }
}

impl<'de> Deserializer<'de> for &'de Value {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self {
            Value::Null => visitor.visit_unit(),
            Value::Bool(value) => visitor.visit_bool(*value),
            Value::Number(Number::Whole(number)) => visitor.visit_u64(*number),
            Value::Number(Number::Spelled(text)) => match text.parse::<i64>() {
                Ok(number) => visitor.visit_i64(number),
                Err(_) => visitor.visit_f64(self.as_f64().unwrap_or_default()),
            },
            Value::String(text) => visitor.visit_borrowed_str(text),
            Value::Array(elements) => visitor.visit_seq(SeqDeserializer::new(elements.iter())),
            Value::Object(members) => visitor.visit_map(MapDeserializer::new(members.iter())),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self {
            Value::Null => visitor.visit_none(),
            value => visitor.visit_some(value),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    /// Enums are strings here.
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match self {
            Value::String(text) => {
                let text: &str = text;
                text.into_deserializer().deserialize_enum(name, variants, visitor)
            }
            other => Err(wrong_type(other, &"string or map")),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct
        seq tuple tuple_struct map struct identifier ignored_any
    }
}

fn wrong_type(found: &Value, expected: &dyn Display) -> Error {
    serde::de::Error::custom(format_args!("invalid type: {found}, expected {expected}"))
}

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Null => serializer.serialize_unit(),
            Self::Bool(value) => serializer.serialize_bool(*value),
            Self::Number(Number::Whole(number)) => serializer.serialize_u64(*number),
            Self::Number(Number::Spelled(text)) => match text.parse::<i64>() {
                Ok(number) => serializer.serialize_i64(number),
                Err(_) => serializer.serialize_f64(self.as_f64().unwrap_or_default()),
            },
            Self::String(text) => serializer.serialize_str(text),
            Self::Array(elements) => serializer.collect_seq(elements),
            Self::Object(members) => {
                serializer.collect_map(members.iter().map(|(key, value)| (key.as_str(), value)))
            }
        }
    }
}
