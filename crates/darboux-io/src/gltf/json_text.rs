//! Edits JSON as text. Everything outside an edit keeps its spelling: numbers, order and white space.
//!
//! Values are skipped and never parsed, so that neither their depth nor their content matters.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::ops::Range;

use serde::Deserializer as _;
use serde::de::{MapAccess, Visitor};
use serde_json::value::RawValue;

/// Sets the member `key` of an object to the JSON text `value`, or removes it. A new member becomes the last.
///
/// Errors: `object` is not a JSON object.
pub fn set_member(object: &str, key: &str, value: Option<&str>) -> serde_json::Result<String> {
    let members = members(object)?;
    let found = members.iter().position(|member| member.is(key));
    let (range, new) = match (found, value) {
        (Some(at), Some(value)) => (members[at].value.clone(), value.to_owned()),
        (Some(at), None) => (removal(&members, at), String::new()),
        (None, None) => return Ok(object.to_owned()),
        (None, Some(value)) => {
            let member = format!("{}:{value}", quoted(key));
            insertion(object, members.iter().map(|member| member.key.start..member.value.end), &member)
        }
    };
    Ok(splice(object, range, &new))
}

/// The text of the member `key` of an object, if there is one.
pub fn member<'a>(object: &'a str, key: &str) -> serde_json::Result<Option<&'a str>> {
    let found = members(object)?.into_iter().find(|member| member.is(key));
    Ok(found.map(|member| &object[member.value]))
}

/// The keys of an object, with escapes decoded.
pub fn keys(object: &str) -> serde_json::Result<Vec<String>> {
    members(object)?.iter().map(|member| serde_json::from_str(member.key_text)).collect()
}

/// Replaces some elements of an array, by index, and appends others.
///
/// Errors: `array` is not a JSON array.
pub fn edit_array(
    array: &str,
    replaced: &BTreeMap<usize, String>,
    appended: &[String],
) -> serde_json::Result<String> {
    let elements: Vec<&RawValue> = serde_json::from_str(array)?;
    let mut out = String::with_capacity(array.len());
    let mut copied = 0;
    for (&index, new) in replaced {
        if let Some(element) = elements.get(index) {
            let range = range_in(array, element.get());
            out.push_str(&array[copied..range.start]);
            out.push_str(new);
            copied = range.end;
        }
    }
    let mut appended = appended.iter();
    let close = array.rfind(']').unwrap_or(array.len());
    if let Some(last) = elements.last().map(|last| range_in(array, last.get())) {
        let separator = format!(",{}", space_before(array, last.start));
        out.push_str(&array[copied..last.end.max(copied)]);
        copied = last.end.max(copied);
        for element in appended {
            out.push_str(&separator);
            out.push_str(element);
        }
    } else if let Some(first) = appended.next() {
        out.push_str(&array[copied..close]);
        copied = close;
        out.push_str(first);
        for element in appended {
            out.push(',');
            out.push_str(element);
        }
    }
    out.push_str(&array[copied..]);
    Ok(out)
}

/// Removes some elements of an array; none if no element is left.
///
/// Errors: `array` is not a JSON array.
pub fn without_elements(array: &str, removed: &BTreeSet<usize>) -> serde_json::Result<Option<String>> {
    let elements: Vec<&RawValue> = serde_json::from_str(array)?;
    let ranges: Vec<_> = elements.iter().map(|element| range_in(array, element.get())).collect();
    let (Some(first), Some(last)) = (ranges.first(), ranges.last()) else { return Ok(None) };
    let mut out = String::with_capacity(array.len());
    for (i, range) in ranges.iter().enumerate().filter(|(i, _)| !removed.contains(i)) {
        let before = if out.is_empty() { 0..first.start } else { ranges[i - 1].end..range.start };
        out.push_str(&array[before]);
        out.push_str(&array[range.clone()]);
    }
    let has_elements = !out.is_empty();
    out.push_str(&array[last.end..]);
    Ok(has_elements.then_some(out))
}

/// A text as a JSON string.
pub fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// The ranges of a member's key and value in the text of its object.
struct ObjectMember<'a> {
    key_text: &'a str,
    key: Range<usize>,
    value: Range<usize>,
}

impl ObjectMember<'_> {
    fn is(&self, key: &str) -> bool {
        let inner = &self.key_text[1..self.key_text.len() - 1];
        if inner.contains('\\') {
            serde_json::from_str::<String>(self.key_text).is_ok_and(|decoded| decoded == key)
        } else {
            inner == key
        }
    }
}

fn members(object: &str) -> serde_json::Result<Vec<ObjectMember<'_>>> {
    let mut parser = serde_json::Deserializer::from_str(object);
    let members = parser.deserialize_map(MembersVisitor(object))?;
    parser.end()?;
    Ok(members)
}

struct MembersVisitor<'a>(&'a str);

impl<'de> Visitor<'de> for MembersVisitor<'de> {
    type Value = Vec<ObjectMember<'de>>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut members = Vec::new();
        while let Some((key, value)) = map.next_entry::<&RawValue, &RawValue>()? {
            let key_text = key.get();
            let (key, value) = (range_in(self.0, key_text), range_in(self.0, value.get()));
            members.push(ObjectMember { key_text, key, value });
        }
        Ok(members)
    }
}

/// The range of `part`, which is a slice of `text`.
pub fn range_in(text: &str, part: &str) -> Range<usize> {
    let start = part.as_ptr() as usize - text.as_ptr() as usize;
    start..start + part.len()
}

/// The range to cut so that a member is removed with one comma.
fn removal(members: &[ObjectMember<'_>], at: usize) -> Range<usize> {
    match (at.checked_sub(1), members.get(at + 1)) {
        (_, Some(next)) => members[at].key.start..next.key.start,
        (Some(previous), None) => members[previous].value.end..members[at].value.end,
        (None, None) => members[at].key.start..members[at].value.end,
    }
}

/// The position of `new` after the last of `items`, and the text to insert with its comma and white space.
fn insertion(
    text: &str,
    items: impl DoubleEndedIterator<Item = Range<usize>>,
    new: &str,
) -> (Range<usize>, String) {
    match items.last() {
        Some(last) => (last.end..last.end, format!(",{}{new}", space_before(text, last.start))),
        None => {
            let open = text.find('{').map_or(0, |at| at + 1);
            (open..open, new.to_owned())
        }
    }
}

/// The white space before an offset, with which a new neighbour is laid out alike.
fn space_before(text: &str, at: usize) -> &str {
    let before = &text[..at];
    &before[before.trim_end_matches([' ', '\t', '\r', '\n']).len()..]
}

fn splice(text: &str, range: Range<usize>, new: &str) -> String {
    let mut out = String::with_capacity(text.len() + new.len());
    out.push_str(&text[..range.start]);
    out.push_str(new);
    out.push_str(&text[range.end..]);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_are_set_added_and_removed_without_touching_the_rest() {
        let text = "{ \"a\" : 1E+5 ,\n \"b\":0.10, \"\\u0063\": [1.0e-7] }";
        assert_eq!(
            set_member(text, "b", Some("2")).unwrap(),
            "{ \"a\" : 1E+5 ,\n \"b\":2, \"\\u0063\": [1.0e-7] }"
        );
        assert_eq!(set_member(text, "c", None).unwrap(), "{ \"a\" : 1E+5 ,\n \"b\":0.10 }");
        assert_eq!(set_member(text, "a", None).unwrap(), "{ \"b\":0.10, \"\\u0063\": [1.0e-7] }");
        assert_eq!(
            set_member(text, "d", Some("{}")).unwrap(),
            "{ \"a\" : 1E+5 ,\n \"b\":0.10, \"\\u0063\": [1.0e-7], \"d\":{} }"
        );
        assert_eq!(set_member("{}", "d", Some("1")).unwrap(), "{\"d\":1}");
        assert_eq!(set_member("{\"d\":1}", "d", None).unwrap(), "{}");
    }

    #[test]
    fn elements_are_replaced_and_appended() {
        let replaced = BTreeMap::from([(1, "9".to_owned())]);
        let appended = ["7".to_owned(), "8".to_owned()];
        assert_eq!(edit_array("[ 1, [2]\n]", &replaced, &appended).unwrap(), "[ 1, 9, 7, 8\n]");
        assert_eq!(edit_array("[]", &BTreeMap::new(), &appended).unwrap(), "[7,8]");
        assert_eq!(edit_array("[1]", &BTreeMap::new(), &[]).unwrap(), "[1]");
    }

    #[test]
    fn elements_are_removed_with_their_commas() {
        let without = |removed: &[usize]| {
            without_elements("[ 1,\n 2,\n 3 ]", &removed.iter().copied().collect()).unwrap()
        };
        assert_eq!(without(&[]).as_deref(), Some("[ 1,\n 2,\n 3 ]"));
        assert_eq!(without(&[0]).as_deref(), Some("[ 2,\n 3 ]"));
        assert_eq!(without(&[1]).as_deref(), Some("[ 1,\n 3 ]"));
        assert_eq!(without(&[1, 2]).as_deref(), Some("[ 1 ]"));
        assert_eq!(without(&[0, 1, 2]), None);
    }

    #[test]
    fn depth_does_not_matter() {
        let deep = format!("{{\"a\":{}{},\"b\":1}}", "[".repeat(200_000), "]".repeat(200_000));
        assert_eq!(set_member(&deep, "a", None).unwrap(), "{\"b\":1}");
    }
}
