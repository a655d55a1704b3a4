//! Plugs as Maya writes them: `nucleus1.inputActive[0]`, `ball.translateY`, `cloth1.stch`.

use crate::attributes::NodeType;

use super::nodes::Graph;
use super::plug::Plug;

/// Why a text is no plug of a graph.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PlugError {
    /// It is not of the form `node.attribute` or `node.attribute[3]`.
    #[error("`{text}` is not a plug")]
    Form {
        /// What stands there.
        text: String,
    },
    /// There is no such node.
    #[error("there is no node `{name}`")]
    NoNode {
        /// The name.
        name: String,
    },
    /// The node has no such attribute.
    #[error("`{node}` is of type {}, which has no attribute `{attribute}`", node_type.name)]
    NoAttribute {
        /// The node.
        node: String,
        /// Its type.
        node_type: &'static NodeType,
        /// The name.
        attribute: String,
    },
}

impl Graph {
    /// The plug that a text stands for. Long and short names are both understood.
    ///
    /// # Errors
    /// When the text is none, or names what is not there.
    pub fn plug(&self, text: &str) -> Result<Plug, PlugError> {
        let form = || PlugError::Form { text: text.to_owned() };
        let (name, rest) = text.split_once('.').ok_or_else(form)?;
        let (attribute, index) = match rest.split_once('[') {
            None => (rest, None),
            Some((attribute, index)) => (attribute, Some(index.strip_suffix(']').ok_or_else(form)?)),
        };
        let plain = |digits: &str| digits.bytes().all(|byte| byte.is_ascii_digit());
        let index = match index {
            None => None,
            Some(digits) if plain(digits) => Some(digits.parse::<u32>().map_err(|_| form())?),
            Some(_) => return Err(form()),
        };
        if name.is_empty() || attribute.is_empty() {
            return Err(form());
        }
        let node = self.find(name).ok_or_else(|| PlugError::NoNode { name: name.to_owned() })?;
        let node_type = self.node(node).node_type();
        if let Some(row) = node_type.attribute(attribute) {
            return Ok(Plug { node, attribute: row, index, part: None });
        }
        match node_type.part(attribute) {
            Some((row, part)) => Ok(Plug { node, attribute: row, index, part: Some(part) }),
            None => {
                let (node, attribute) = (name.to_owned(), attribute.to_owned());
                Err(PlugError::NoAttribute { node, node_type, attribute })
            }
        }
    }

    /// A plug as Maya writes it: `nucleus1.inputActive[0]`.
    pub fn describe(&self, plug: Plug) -> String {
        let name = self.node(plug.node).name();
        let parts = plug.attribute.parts();
        let part = plug.part.and_then(|part| parts.map(|parts| parts[part].0.clone()));
        let attribute = part.unwrap_or_else(|| plug.attribute.name.to_owned());
        let index = plug.index.map(|index| format!("[{index}]")).unwrap_or_default();
        format!("{name}.{attribute}{index}")
    }
}
