//! A triangle of a face.

/// Three places in the list of a face's corners.
pub type Triangle = [usize; 3];
