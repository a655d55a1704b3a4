//! Material presets: a file with one node without a name.
//!
//! The settings of a preset count where the node of a scene has none.
//!
//! ```ron
//! // Silk: light and smooth.
//! nCloth(friction: 0.05, stretchResistance: 60)
//! ```

use crate::attributes::{Attribute, NodeType};
use crate::graph::Setting;

use super::write::setting_lines;

/// Settings for a type of node.
#[derive(Debug, Clone, PartialEq)]
pub struct Preset {
    /// The name.
    pub name: String,
    /// A description in one line: the first comment of its file.
    pub doc: String,
    /// The type of node. Types that inherit from it can use the preset too.
    pub node_type: &'static NodeType,
    /// The settings.
    pub settings: Vec<(&'static Attribute, Setting)>,
}

impl Preset {
    /// The settings as a scene writes them: `friction: 0.4`.
    pub fn lines(&self) -> Vec<String> {
        self.settings.iter().flat_map(|(row, setting)| setting_lines(row, setting)).collect()
    }
}
