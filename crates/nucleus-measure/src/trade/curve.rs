//! The curve of a scene, as it is kept for `nucleus run --quality`.

use super::found::Trade;
use crate::store::{Store, StoreError};

/// The file that holds it.
const FILE: &str = "trade.json";

impl Trade {
    /// Keeps it for later runs of the scene.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn keep(&self, store: &Store) -> Result<(), StoreError> {
        store.write(FILE, &serde_json::to_vec_pretty(self).unwrap_or_default())
    }

    /// What was kept last, if it can be understood.
    ///
    /// # Errors
    /// When it is there and cannot be read.
    pub fn find(store: &Store) -> Result<Option<Self>, StoreError> {
        Ok(store.read(FILE)?.and_then(|bytes| serde_json::from_slice(&bytes).ok()))
    }
}
