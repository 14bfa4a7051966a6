//! [`Budget`]: compares the bytes that a run needs with its limit.

use crate::BakeError;

/// The bytes that a run needs as far as they are known, and its limit.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    needed: u64,
    limit: Option<u64>,
}

impl Budget {
    pub fn new(limit: Option<u64>) -> Self {
        Self { needed: 0, limit }
    }

    /// Adds bytes. Errors: the sum exceeds the limit.
    pub fn add(&mut self, bytes: u64) -> Result<(), BakeError> {
        self.needed = self.needed.saturating_add(bytes);
        match self.limit {
            Some(limit) if self.needed > limit => {
                Err(BakeError::Memory { needed: self.needed, limit: Some(limit) })
            }
            _ => Ok(()),
        }
    }

    /// The error where the system refuses the memory.
    pub fn refused(&self) -> BakeError {
        BakeError::Memory { needed: self.needed, limit: None }
    }
}
