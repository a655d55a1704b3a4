//! What is known of a history while it is built.

use std::collections::HashMap;

use crate::omissions::Cause;
use crate::scene::NodeId;

use super::budget::Budget;
use super::poly::{Built, Poly};

/// A history while it is built.
#[derive(Debug, Default)]
pub(crate) struct History {
    /// Nodes that were passed over, and why.
    pub(crate) omitted: Vec<(String, Cause)>,
    /// The points that it may still make.
    pub(crate) budget: Budget,
    /// Whether a deformer or a driven number moves its points.
    pub(crate) is_deformed: bool,
    /// The meshes of nodes that feed several inputs.
    pub(crate) known: HashMap<NodeId, Result<Poly, String>>,
}

impl History {
    /// The mesh with what its history leaves out.
    pub(crate) fn finish(self, mesh: Result<Poly, String>) -> Result<Built, String> {
        Ok(Built { mesh: mesh?, omitted: self.omitted, is_deformed: self.is_deformed })
    }
}
