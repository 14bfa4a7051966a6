//! Text in HTML.

/// A text in HTML.
pub fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            letter if letter.is_control() => safe += " ",
            letter => safe.push(letter),
        }
    }
    safe
}

/// Sentences with `code` in HTML.
pub fn with_code(text: &str) -> String {
    let mut html = String::new();
    for (number, part) in text.split('`').enumerate() {
        let part = escaped(part);
        html += &if number % 2 == 1 { format!("<code>{part}</code>") } else { part };
    }
    html
}
