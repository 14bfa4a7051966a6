//! Makes values: conversions from Rust's types, and comparisons with them.

use std::fmt::{Debug, Display};

use super::value::{Map, Number, Value};

impl From<u64> for Value {
    fn from(number: u64) -> Self {
        Self::Number(Number::Whole(number))
    }
}

impl From<usize> for Value {
    fn from(number: usize) -> Self {
        (number as u64).into()
    }
}

impl From<u32> for Value {
    fn from(number: u32) -> Self {
        u64::from(number).into()
    }
}

/// Null for numbers that are not finite, which JSON does not have.
impl From<f64> for Value {
    fn from(number: f64) -> Self {
        float(number.is_finite(), number.abs(), &number)
    }
}

/// As the conversion of `f64`; the shortest text that reads as the same number of 32 bits.
impl From<f32> for Value {
    fn from(number: f32) -> Self {
        float(number.is_finite(), number.abs().into(), &number)
    }
}

fn float<T: Display + Debug>(is_finite: bool, size: f64, number: &T) -> Value {
    if !is_finite {
        return Value::Null;
    }
    // The debug text always shows that it is no whole number, but has an exponent below 0.0001 already.
    let has_few_zeros = (0.00001..0.0001).contains(&size);
    let text = if has_few_zeros { number.to_string() } else { format!("{number:?}") };
    Value::Number(Number::Spelled(text.into()))
}

impl From<i32> for Value {
    fn from(number: i32) -> Self {
        let spelled = |_| Self::Number(Number::Spelled(number.to_string().into()));
        u64::try_from(number).map_or_else(spelled, Self::from)
    }
}

impl From<bool> for Value {
    fn from(value: bool) -> Self {
        Self::Bool(value)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::String(text.into())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::String(text.into())
    }
}

/// The object with these members. Of members with the same key the last one counts.
impl<const N: usize> From<[(&str, Self); N]> for Value {
    fn from(members: [(&str, Self); N]) -> Self {
        let mut object = Map::default();
        for (key, value) in members {
            object.insert(key, value);
        }
        Self::Object(object)
    }
}

impl From<Map> for Value {
    fn from(members: Map) -> Self {
        Self::Object(members)
    }
}

impl<T: Into<Self>> From<Vec<T>> for Value {
    fn from(elements: Vec<T>) -> Self {
        Self::Array(elements.into_iter().map(T::into).collect())
    }
}

impl<T: Into<Self>> From<Option<T>> for Value {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Null, T::into)
    }
}

impl PartialEq<str> for Value {
    fn eq(&self, text: &str) -> bool {
        self.as_str() == Some(text)
    }
}

impl PartialEq<&str> for Value {
    fn eq(&self, text: &&str) -> bool {
        self == *text
    }
}

impl PartialEq<usize> for Value {
    fn eq(&self, number: &usize) -> bool {
        self.as_u64() == Some(*number as u64)
    }
}

impl PartialEq<i32> for Value {
    fn eq(&self, number: &i32) -> bool {
        u64::try_from(*number).is_ok_and(|number| self.as_u64() == Some(number))
    }
}

impl PartialEq<f64> for Value {
    fn eq(&self, number: &f64) -> bool {
        self.as_f64() == Some(*number)
    }
}

impl<T, const N: usize> PartialEq<[T; N]> for Value
where
    Self: PartialEq<T>,
{
    fn eq(&self, elements: &[T; N]) -> bool {
        self.as_array().is_some_and(|own| own.len() == N && own.iter().zip(elements).all(|(a, b)| a == b))
    }
}
