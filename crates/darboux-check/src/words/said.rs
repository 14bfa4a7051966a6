//! [`Said`]: the words about one fault.

use std::borrow::Cow;

use crate::code::Family;
use crate::finding::Evidence;
use crate::indices::Part;

/// What is said of a fault.
pub struct Said {
    pub text: String,
    pub evidence: Vec<Evidence>,
    /// Another cure than the code's.
    pub cure: Option<Cow<'static, str>>,
}

impl Said {
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), evidence: Vec::new(), cure: None }
    }

    pub fn with(mut self, what: &'static str, value: f64, unit: &'static str) -> Self {
        self.evidence.push(Evidence { what, value, unit });
        self
    }

    /// `percent`: of the area of the model, or for tangents of what shows them.
    pub fn with_damaged_percent(self, percent: Option<f64>, family: Family) -> Self {
        let what = match family {
            Family::Tangents => "part of the area with normal maps that looks wrong, by the angle",
            _ => "part of the model's area that looks wrong, by the angle",
        };
        match percent {
            Some(percent) => self.with(what, percent, "%"),
            None => self,
        }
    }

    pub fn with_cure(self, cure: impl Into<Cow<'static, str>>) -> Self {
        Self { cure: Some(cure.into()), ..self }
    }

    pub fn of_vertices(text: String, part: &Part) -> Self {
        Self::new(text).with("part of all vertices", part.percent(), "%")
    }

    pub fn of_triangles(text: String, part: &Part) -> Self {
        Self::new(text).with("part of all triangles", part.percent(), "%")
    }
}
