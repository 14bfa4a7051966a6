//! [`ExchangeFormat`].

/// A format that holds the surfaces of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::gltf) enum ExchangeFormat {
    Ply,
    Obj,
}
