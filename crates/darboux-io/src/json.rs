//! The JSON of documents: values that keep the order of keys and the spelling of numbers, read from text
//! strictly and written in its layout.
//!
//! ```text
//! value   Value, Map, Number
//! make    values of Rust's types
//! parse   text to values
//! text    values to text
//! typed   values to other types, by serde
//! ```

mod make;
mod parse;
mod text;
mod typed;
mod value;

pub(crate) use parse::parse;
pub(crate) use text::{Part, TextLayout};
pub(crate) use typed::read;
pub use value::{Key, Map, Number, Place, Value};

/// The object with these members, each `"key": value`.
macro_rules! object {
    ($($key:tt : $value:expr),* $(,)?) => {
        $crate::json::Value::from([$(($key, $crate::json::Value::from($value))),*])
    };
}
pub(crate) use object;

/// Removes an extension from an object, and an `extensions` that is empty then. Returns whether the object
/// had it.
pub(crate) fn remove_extension(object: &mut Value, name: &str) -> bool {
    let Some(object) = object.as_object_mut() else { return false };
    let Some(Value::Object(extensions)) = object.get_mut("extensions") else { return false };
    let is_removed = extensions.remove(name).is_some();
    if is_removed && extensions.is_empty() {
        object.remove("extensions");
    }
    is_removed
}

/// Parses JSON without a limit of memory.
#[cfg(test)]
pub(crate) fn parse_test(text: &str) -> Result<Value, crate::error::ContentError> {
    parse(text, crate::memory_limit::Budget { bytes: usize::MAX, is_of_process: false, option: "" })
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::parse_test as parse;
    use super::{TextLayout, Value, read};
    use crate::memory_limit::Budget;

    fn problem(text: &str) -> String {
        parse(text).expect_err("invalid JSON").into_clause()
    }

    #[test]
    fn order_and_spelling_are_kept() {
        let text = r#"{"b":1E5,"a":[0.10,-0,1.0e-7,18446744073709551616],"c":{"é":null,"$x":true}}"#;
        let parsed = parse(text).unwrap();
        assert_eq!(TextLayout::default().text(&parsed), text.as_bytes());
    }

    #[test]
    fn objects_of_many_members_are_indexed() {
        let members: Vec<_> = (0..1000).map(|i| format!("\"k{i}\":{i}")).collect();
        let text = format!("{{{}}}", members.join(","));
        assert!(problem(&text.replace("\"k500\"", "\"k1\"")).contains("an object has the key \"k1\" twice"));
        let mut value = parse(&text).unwrap();
        let members = value.as_object_mut().unwrap();
        members.remove("k0");
        members.insert("new", 5.into());
        assert_eq!(members.len(), 1000);
        assert!(!members.contains_key("k0"));
        assert_eq!(members["k999"], 999);
        assert_eq!(
            members.iter().last().map(|(key, value)| (key.as_str(), value.as_u64())),
            Some(("new", Some(5)))
        );
        members.retain(|key, _| key != "k1");
        assert_eq!((&members["k1"], members["k2"].as_u64()), (&Value::Null, Some(2)));
    }

    #[test]
    fn text_keeps_its_indentation() {
        for text in ["{\n\t\"a\": [\n\t\t1,\n\t\t{}\n\t]\n}\n", "{\r\n  \"a\": 1\r\n}", "{\n    \"a\": []\n}"]
        {
            let written = TextLayout::of(text).text(&parse(text).unwrap());
            assert_eq!(String::from_utf8(written).unwrap(), text);
        }
    }

    /// A first line of white space, and a depth at which each number needs a line of it.
    #[test]
    fn white_space_is_not_amplified() {
        let numbers = format!("{}{}0{}", "[".repeat(90), "0,".repeat(50_000), "]".repeat(90));
        for indentation in [1, 16, 17, 100_000] {
            let text = format!("{{\n{}\"a\": {numbers}\n}}", " ".repeat(indentation));
            let value = parse(&text).unwrap();
            let written = String::from_utf8(TextLayout::of(&text).text(&value)).unwrap();
            assert!(written.len() <= 18 * text.len() + (1 << 20), "{indentation}: {}", written.len());
            assert_eq!(parse(&written).unwrap(), value);
            let kept = if indentation > 16 { 2 } else { indentation };
            assert!(written.starts_with(&format!("{{\n{}\"a\": [\n", " ".repeat(kept))), "{indentation}");
        }
    }

    #[test]
    fn hostile_json_is_refused_in_a_sentence() {
        let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
        assert!(problem(&deep).contains("nested more than 100 levels deep"), "{}", problem(&deep));
        let allowed = format!("{}{}", "[".repeat(100), "]".repeat(100));
        assert!(parse(&allowed).is_ok());
        assert!(problem(r#"{"a":1,"b":{"a":1,"\u0061":2}}"#).contains("an object has the key \"a\" twice"));
        assert!(problem("[1e400]").contains("the number 1e400 is out of range"));
        let sentence = |text: &str| parse(text).expect_err("invalid JSON").in_file("f").to_string();
        assert!(
            sentence("{\"a\":[0,{\"b\":1e400}]}")
                .starts_with("f: a[1].b: the number 1e400 is out of range; ")
        );
        for (text, expected) in [
            ("[1,]", "a bracket follows a comma"),
            ("{} {}", "more text follows its end"),
            ("[1 2]", "a comma or ] is missing"),
            ("[1 ", "the text ends too early"),
            ("[nul]", "the only words outside quotes are true, false and null"),
            ("[\"\\ud800\"]", "the digits after \\u in a string are those of no character"),
            ("[\"\u{1}\"]", "a string has a control character"),
            ("[-]", "a number is misspelled"),
        ] {
            assert!(
                problem(text).starts_with(&format!("is not JSON: {expected} at line 1, column ")),
                "{}",
                problem(text)
            );
        }
        let limit = Budget { bytes: 1 << 20, is_of_process: false, option: "--memory-limit" };
        let many = format!("[{}0]", "{\"\":0},".repeat(10_000));
        let refused = super::parse(&many, limit).expect_err("6 MB").into_clause();
        assert!(refused.contains("has JSON that needs more than the memory limit of 1 MiB"), "{refused}");
    }

    #[test]
    fn the_path_of_a_wrong_type_is_named() {
        #[derive(Debug, Deserialize)]
        struct Inner {
            #[expect(dead_code, reason = "only read")]
            count: usize,
        }
        let value = parse(r#"{"list":[{"count":1},{"count":"x"}]}"#).unwrap();
        let error = read::<Vec<Inner>>(&value["list"], "list").expect_err("a string").in_file("f");
        let expected =
            "f: list[1].count: is \"x\"; it must be a whole number of 0 or more; export the file again";
        assert_eq!(error.to_string(), expected);
    }
}
