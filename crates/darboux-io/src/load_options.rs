//! The options of every reader: glTF, OBJ and PNG.

use crate::memory_limit::{Budget, MemoryLimit};
use crate::source::PolygonRule;

/// How a file is read. The default reads files in the folder of the input or below only, with the default
/// memory limit.
#[derive(Clone, Copy, Debug, Default)]
#[non_exhaustive]
pub struct LoadOptions {
    /// Also reads buffers and images of a glTF outside its folder, through `..`, absolute paths or links.
    pub allow_outside: bool,
    /// The most memory that decoding the file, and computing from it, may take.
    pub memory_limit: MemoryLimit,
    /// How faces of five and more corners are cut, in formats that have them.
    pub polygon_rule: PolygonRule,
    /// How messages call the options that they advise to change.
    pub option_names: OptionNames,
}

/// The names of options in the sentences of errors and warnings. The default names those of this crate, such
/// as `LoadOptions::memory_limit`; a program that offers these options under other names sets its own, such
/// as `--memory-limit`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct OptionNames {
    /// The name of [`LoadOptions::memory_limit`].
    pub memory_limit: &'static str,
    /// The name of [`LoadOptions::allow_outside`].
    pub allow_outside: &'static str,
    /// The name of
    /// [`AddTangentsOptions::apply_texture_transform`](crate::gltf::AddTangentsOptions::apply_texture_transform).
    pub apply_texture_transform: &'static str,
    /// What to do about a file whose format this build does not read: a clause.
    pub missing_reader: &'static str,
}

impl Default for OptionNames {
    fn default() -> Self {
        Self {
            memory_limit: "LoadOptions::memory_limit",
            allow_outside: "LoadOptions::allow_outside",
            apply_texture_transform: "AddTangentsOptions::apply_texture_transform",
            missing_reader: "export the model as .glb, or build darboux-io with the feature of that format",
        }
    }
}

impl OptionNames {
    /// The names for a program that has none of these options: messages lead to the command `darboux`.
    #[must_use]
    pub const fn of_command() -> Self {
        Self {
            memory_limit: "--memory-limit of the command darboux",
            allow_outside: "--allow-outside of the command darboux",
            apply_texture_transform: "--apply-texture-transform of the command darboux",
            missing_reader: "export the model as .glb, or convert it with the command: darboux tangents \
                 model.fbx -o model.glb",
        }
    }

    /// These names with another one for [`OptionNames::memory_limit`].
    #[must_use]
    pub const fn with_memory_limit(self, memory_limit: &'static str) -> Self {
        Self { memory_limit, ..self }
    }

    /// These names with another one for [`OptionNames::allow_outside`].
    #[must_use]
    pub const fn with_allow_outside(self, allow_outside: &'static str) -> Self {
        Self { allow_outside, ..self }
    }

    /// These names with another one for [`OptionNames::apply_texture_transform`].
    #[must_use]
    pub const fn with_apply_texture_transform(self, apply_texture_transform: &'static str) -> Self {
        Self { apply_texture_transform, ..self }
    }

    /// These names with another advice for [`OptionNames::missing_reader`].
    #[must_use]
    pub const fn with_missing_reader(self, missing_reader: &'static str) -> Self {
        Self { missing_reader, ..self }
    }
}

impl LoadOptions {
    /// These options, also with files outside the input's folder, or not.
    #[must_use]
    pub const fn with_allow_outside(self, allow_outside: bool) -> Self {
        Self { allow_outside, ..self }
    }

    /// These options with another memory limit.
    #[must_use]
    pub const fn with_memory_limit(self, memory_limit: MemoryLimit) -> Self {
        Self { memory_limit, ..self }
    }

    /// These options with another rule for faces of five and more corners.
    #[must_use]
    pub const fn with_polygon_rule(self, polygon_rule: PolygonRule) -> Self {
        Self { polygon_rule, ..self }
    }

    /// These options with other names of options in messages.
    #[must_use]
    pub const fn with_option_names(self, option_names: OptionNames) -> Self {
        Self { option_names, ..self }
    }

    /// The memory for a file of `size` bytes that was decompressed into `decompressed` bytes.
    pub(crate) fn budget(&self, size: usize, decompressed: usize) -> Budget {
        self.memory_limit.budget(size, decompressed, self.option_names.memory_limit)
    }
}
