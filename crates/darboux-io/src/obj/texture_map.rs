//! The statement of an MTL that names a texture: options, and then the name of a file.

use crate::code_page::decoded;

/// A texture of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct MtlMap {
    /// The name of the file. It may contain spaces.
    pub file: String,
    /// The whole statement, whose options this crate may not know.
    pub statement: String,
    /// The option `-bm`.
    pub multiplier: Option<f32>,
    /// The options `-o` and `-s`: the texture coordinate is scale * uv + offset, with v up.
    pub offset: [f32; 2],
    pub scale: [f32; 2],
    /// Whether the option `-clamp` is on.
    pub is_clamped: bool,
    /// Whether an option has no place in glTF: it changes the values, disturbs the texture, or is not
    /// finite.
    pub has_options: bool,
}

impl Default for MtlMap {
    fn default() -> Self {
        Self {
            file: String::new(),
            statement: String::new(),
            multiplier: None,
            offset: [0.0; 2],
            scale: [1.0; 2],
            is_clamped: false,
            has_options: false,
        }
    }
}

impl MtlMap {
    /// The offset, rotation and scale of `KHR_texture_transform`, whose v points down; none for a texture
    /// that is not moved.
    pub fn transform(&self) -> Option<([f32; 2], f32, [f32; 2])> {
        let is_plain = self.offset == [0.0; 2] && self.scale == [1.0; 2];
        (!is_plain).then_some((self.offset_in_gltf(), 0.0, self.scale))
    }

    fn offset_in_gltf(&self) -> [f32; 2] {
        [self.offset[0], 1.0 - self.scale[1] - self.offset[1]]
    }

    /// A texture: its options, and the name after them.
    pub fn parse(rest: &[u8]) -> Self {
        let statement = decoded(rest).into_owned();
        let mut found = Self { file: statement.clone(), statement: statement.clone(), ..Self::default() };
        let mut left = statement.trim();
        while left.starts_with('-') {
            let (option, after) = left.split_once(char::is_whitespace).unwrap_or((left, ""));
            let (least, most) = match option {
                "-bm" | "-boost" | "-texres" | "-blendu" | "-blendv" | "-cc" | "-clamp" | "-imfchan"
                | "-type" => (1, 1),
                "-mm" => (2, 2),
                "-o" | "-s" | "-t" => (1, 3),
                _ => break,
            };
            left = after.trim_start();
            for place in 0..most {
                let (word, after) = left.split_once(char::is_whitespace).unwrap_or((left, ""));
                let number = word.parse::<f32>().ok();
                if place >= least && number.is_none() {
                    break;
                }
                match (option, number) {
                    ("-bm", number) => {
                        found.multiplier = number.filter(|number| number.is_finite());
                        found.has_options |= found.multiplier.is_none();
                    }
                    ("-o", Some(number)) if place < 2 => found.offset[place] = number,
                    ("-s", Some(number)) if place < 2 => found.scale[place] = number,
                    ("-clamp", _) => found.is_clamped = word == "on",
                    // What changes nothing, as 3ds Max writes it.
                    ("-mm", number) => found.has_options |= number != Some([0.0, 1.0][place]),
                    ("-t", number) => found.has_options |= number != Some(0.0),
                    ("-imfchan", _) => found.has_options = true,
                    _ => {}
                }
                left = after.trim_start();
            }
        }
        found.file = left.to_owned();
        if found.offset_in_gltf().iter().chain(&found.scale).any(|number| !number.is_finite()) {
            (found.offset, found.scale, found.has_options) = ([0.0; 2], [1.0; 2], true);
        }
        found
    }
}
