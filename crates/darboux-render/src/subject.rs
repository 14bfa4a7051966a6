//! The two things that can be drawn of a model.

/// What is drawn of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Its surface in the scene.
    Surface,
    /// Its UV layout.
    UvLayout,
}
