//! The values of properties, and the words for elements and properties.

use super::header::{Element, Property};
use super::values::Values;
use crate::error::{ContentError, shortened};

/// The value of a property; the last one of a list, which is 0 for an empty list.
pub fn next(property: &Property, values: &mut Values<'_>) -> Option<f64> {
    let Some(length) = property.length else { return values.next(property.number) };
    let count = values.next(length)?;
    let mut last = 0.0;
    for _ in 0..count as usize {
        last = values.next(property.number)?;
    }
    Some(last)
}

/// A noun phrase for properties that are not carried over; none for none.
pub fn properties<'a>(element: &str, names: impl Iterator<Item = &'a str>) -> Option<String> {
    const MOST: usize = 20;
    let names: Vec<String> = names.map(shortened).collect();
    let (shown, others) = names.split_at(names.len().min(MOST));
    Some(match (shown, others.len()) {
        ([], _) => return None,
        ([name], _) => format!("the {element} property {name}"),
        (_, 0) => format!("the {element} properties {}", shown.join(", ")),
        (_, others) => format!("the {element} properties {} and {others} others", shown.join(", ")),
    })
}

/// A record that is not there, has too few values or a text that is no number.
pub fn cut_off(element: &Element, index: usize, values: &Values<'_>) -> ContentError {
    if let Some((line, word)) = values.wrong_line() {
        let problem = match word {
            Some(word) => {
                format!("has {:?}, which is no number", shortened(&String::from_utf8_lossy(word)))
            }
            None => format!("has fewer values than {} {index} needs by the header", element.name),
        };
        let place = format!("line {line}");
        return ContentError::invalid(place, format!("{problem}; export or download the file again"));
    }
    let place = format!("{} {index}", element.name);
    let problem = format!(
        "is missing, cut off or no number; the header says that there are {}; export or download the file \
         again",
        element.count
    );
    ContentError::invalid(place, problem)
}

/// Elements for which the file has too few bytes.
pub fn too_short(element: &Element) -> ContentError {
    let problem = format!(
        "the file is cut off: its header says that there are {}; export or download it again",
        element.count
    );
    ContentError::invalid(format!("element {}", element.name), problem)
}
