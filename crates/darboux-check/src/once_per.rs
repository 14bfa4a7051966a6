//! [`OncePer`]: values that several maps on one surface need, computed once.

use std::sync::{Arc, Mutex, PoisonError};

use darboux_io::gltf::TextureUse;

/// How a material reads a map, whichever image that is; none for the UVs that the tangents follow.
pub type Reading = Option<TextureUse>;

/// The reading of a texture.
pub fn reading(texture: Option<&TextureUse>) -> Reading {
    let mut reading = texture.cloned();
    if let Some(texture) = &mut reading {
        texture.image = None;
    }
    reading
}

/// Values by key.
#[derive(Debug)]
pub struct OncePer<K, T>(Mutex<Vec<(K, Arc<T>)>>);

impl<K, T> Default for OncePer<K, T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: PartialEq, T> OncePer<K, T> {
    /// The value of a key. The first `most` keys are remembered.
    pub fn get(&self, key: K, most: usize, value: impl FnOnce() -> T) -> Arc<T> {
        // Others that need it meanwhile wait for it.
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, value)) = known.iter().find(|(other, _)| *other == key) {
            return Arc::clone(value);
        }
        let value = Arc::new(value());
        if known.len() < most {
            known.push((key, Arc::clone(&value)));
        }
        value
    }
}
