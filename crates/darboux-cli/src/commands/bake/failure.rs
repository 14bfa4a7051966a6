//! [`BakeFailure`]: why a bake has failed.

use darboux_bake::BakeError;

/// Why a bake has failed, in one sentence.
#[derive(Debug)]
pub enum BakeFailure {
    /// It needs more memory than it may use.
    Memory(String),
    Other(String),
}

impl BakeFailure {
    /// This failure with words before its sentence.
    pub fn after(self, words: &str) -> Self {
        let sentence = |sentence| format!("{words}: {sentence}");
        match self {
            Self::Memory(of_memory) => Self::Memory(sentence(of_memory)),
            Self::Other(other) => Self::Other(sentence(other)),
        }
    }
}

impl From<String> for BakeFailure {
    fn from(sentence: String) -> Self {
        Self::Other(sentence)
    }
}

impl From<BakeError> for BakeFailure {
    fn from(error: BakeError) -> Self {
        let sentence = error.to_string();
        if matches!(error, BakeError::Memory { .. }) { Self::Memory(sentence) } else { Self::Other(sentence) }
    }
}

impl From<BakeFailure> for String {
    fn from(failure: BakeFailure) -> Self {
        match failure {
            BakeFailure::Memory(sentence) | BakeFailure::Other(sentence) => sentence,
        }
    }
}
