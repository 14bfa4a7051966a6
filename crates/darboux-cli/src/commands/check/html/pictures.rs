//! What the page shows of a model.

/// The pictures of a file, as addresses that hold their data, or why it has none.
#[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "only the renderer makes pictures"))]
pub enum Pictures {
    /// The part that differs most, and the whole model.
    Pairs(Vec<Pair>),
    /// The file alone.
    One {
        png: String,
        size: [u32; 2],
        /// Why there is no second one, as a sentence.
        why: String,
    },
    /// Why there is none, as a sentence, where somebody may miss it.
    None(Option<String>),
}

/// The same part of a model in the file and repaired.
pub struct Pair {
    pub caption: String,
    pub before: String,
    pub after: String,
    /// The width and height in pixels.
    pub size: [u32; 2],
    /// Where the slider stands at first, in percent of the width.
    pub split: u32,
}
