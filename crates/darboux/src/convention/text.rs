//! Conventions as text: the name of a preset, followed by changes: `blender`, `gltf,green=down`.

use std::error::Error;
use std::fmt;
use std::str::FromStr;

use crate::convention::rules::{
    Axes, Axis, BitangentDirection, Convention, SignRule, TangentDirection, UvOrigin, Winding,
};

/// The error of parsing a convention.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ConventionError {
    /// The first part is not the name of a preset.
    Preset(String),
    /// A later part is not `CHOICE=VALUE` with the name of a choice.
    Choice(String),
    /// The value of a choice is invalid.
    Value {
        /// The name of the choice.
        choice: &'static str,
        /// The invalid value.
        value: String,
        /// The valid values.
        allowed: String,
    },
}

impl fmt::Display for ConventionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Preset(name) => {
                let presets = Convention::PRESETS.map(|(name, _)| name).join(", ");
                write!(f, "{name:?} is not a convention; begin with one of {presets}")
            }
            Self::Choice(part) => {
                let choices = CHOICES.map(|choice| choice.0).join(", ");
                write!(f, "{part:?} is not a change; write CHOICE=VALUE with one of {choices}")
            }
            Self::Value { choice, value, allowed } => {
                write!(f, "{choice} cannot be {value:?}; write {allowed}")
            }
        }
    }
}

impl Error for ConventionError {}

/// A choice: its name, a function that reads its value, one that sets it, and one that lists the valid
/// values.
type Choice =
    (&'static str, fn(Convention) -> String, fn(Convention, &str) -> Option<Convention>, fn() -> String);

/// A choice between named values.
macro_rules! choice {
    ($name:literal, $field:ident, [$($text:literal => $value:expr),*]) => {
        (
            $name,
            |it| {
                let named = [$(($text, $value)),*].into_iter().find(|(_, value)| *value == it.$field);
                named.map_or("", |(text, _)| text).to_owned()
            },
            |it, text| {
                let named = [$(($text, $value)),*].into_iter().find(|(name, _)| *name == text);
                Some(Convention { $field: named?.1, ..it })
            },
            || [$($text),*].join(" or "),
        )
    };
}

/// All choices, in the order of the text form.
const CHOICES: [Choice; 6] = [
    (
        "axes",
        |it| spelled_axes(it.axes),
        |it, text| Some(Convention { axes: axes(text)?, ..it }),
        || "right, up and front as in -x/y/z".to_owned(),
    ),
    choice!("fronts", winding, ["ccw" => Winding::CounterClockwise, "cw" => Winding::Clockwise]),
    choice!("v0", uv_origin, ["bottom" => UvOrigin::BottomLeft, "top" => UvOrigin::TopLeft]),
    choice!("red", tangent, ["right" => TangentDirection::Right, "left" => TangentDirection::Left]),
    choice!("green", bitangent, ["up" => BitangentDirection::Up, "down" => BitangentDirection::Down]),
    choice!("w", sign, ["n-cross-t" => SignRule::NormalCrossTangent, "t-cross-n" => SignRule::TangentCrossNormal]),
];

impl Convention {
    /// The names of all presets that equal this convention.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        Self::PRESETS.into_iter().filter(move |(_, preset)| *preset == self).map(|(name, _)| name)
    }
}

/// The first name of the convention; without a name, `gltf` and the changes. [`Convention::from_str`] parses
/// the text.
impl fmt::Display for Convention {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(name) = self.names().next() {
            return f.write_str(name);
        }
        f.write_str("gltf")?;
        let differing = CHOICES.iter().filter(|(_, read, ..)| read(*self) != read(Self::GLTF));
        differing.into_iter().try_for_each(|(name, read, ..)| write!(f, ",{name}={}", read(*self)))
    }
}

impl FromStr for Convention {
    type Err = ConventionError;

    /// Parses the name of a preset, followed by any number of `,CHOICE=VALUE`: `axes=-x/y/z` (right, up,
    /// front), `fronts=ccw` or `cw`, `v0=bottom` or `top`, `red=right` or `left`, `green=up` or `down`,
    /// `w=n-cross-t` or `t-cross-n`.
    fn from_str(text: &str) -> Result<Self, ConventionError> {
        let mut parts = text.split(',');
        let name = parts.next().unwrap_or_default();
        let preset = Self::PRESETS.into_iter().find(|(preset, _)| *preset == name);
        let (_, preset) = preset.ok_or_else(|| ConventionError::Preset(name.to_owned()))?;
        parts.try_fold(preset, |convention, part| {
            let unknown = || ConventionError::Choice(part.to_owned());
            let (key, value) = part.split_once('=').ok_or_else(unknown)?;
            let (choice, _, set, allowed) =
                CHOICES.iter().find(|choice| choice.0 == key).ok_or_else(unknown)?;
            set(convention, value).ok_or_else(|| ConventionError::Value {
                choice,
                value: value.to_owned(),
                allowed: allowed(),
            })
        })
    }
}

const AXES: [(&str, Axis); 6] = [
    ("x", Axis::X),
    ("-x", Axis::MinusX),
    ("y", Axis::Y),
    ("-y", Axis::MinusY),
    ("z", Axis::Z),
    ("-z", Axis::MinusZ),
];

fn axes(text: &str) -> Option<Axes> {
    let axis = |text: &str| Some(AXES.iter().find(|(name, _)| *name == text)?.1);
    let mut parts = text.split('/');
    let axes = Axes::new(axis(parts.next()?)?, axis(parts.next()?)?, axis(parts.next()?)?);
    axes.filter(|_| parts.next().is_none())
}

fn spelled_axes(axes: Axes) -> String {
    let name = |axis: Axis| AXES.iter().find(|(_, other)| *other == axis).map_or("", |(name, _)| name);
    [axes.right(), axes.up(), axes.front()].map(name).join("/")
}
