//! The limit on the points of a mesh and of its history.

/// Most points that the history of a mesh makes or keeps, over all its nodes.
const MAX_POINTS: u64 = 20_000_000;

/// The points that a history may still make.
#[derive(Debug)]
pub(crate) struct Budget(u64);

impl Default for Budget {
    fn default() -> Self {
        Self(MAX_POINTS)
    }
}

impl Budget {
    /// A smaller one.
    #[cfg(test)]
    pub(crate) fn of(points: u64) -> Self {
        Self(points)
    }

    /// Takes points, before they are made.
    ///
    /// # Errors
    /// When fewer are left.
    pub(crate) fn take(&mut self, points: u64) -> Result<(), String> {
        let left = self.0.checked_sub(points);
        self.0 = left.ok_or_else(|| "its history makes more than 20 million points".to_owned())?;
        Ok(())
    }
}
