//! Comments of a scene file, each with the node or attribute that it belongs to, so that formatting keeps them.

use std::collections::BTreeMap;

use super::document::Source;

/// Comments of a file.
#[derive(Debug, Default)]
pub(super) struct Comments {
    /// Before `Scene`.
    pub(super) head: Vec<String>,
    /// On their own lines before a node (`cloth1`) or an attribute (`cloth1.friction`).
    leading: BTreeMap<String, Vec<String>>,
    /// On the line of a node or an attribute.
    trailing: BTreeMap<String, String>,
    /// After the last node or attribute.
    pub(super) tail: Vec<String>,
}

impl Comments {
    /// The comments of a text. `source` has the places of its scene.
    pub(super) fn of(text: &str, source: &Source) -> Self {
        let mut comments = Self::default();
        let places: BTreeMap<usize, &str> = source.places().map(|(name, span)| (span.start, name)).collect();
        let body = text.find("Scene").unwrap_or(text.len());
        for (start, comment) in find_comments(text) {
            let line = text[..start].rfind('\n').map_or(0, |at| at + 1);
            let is_own_line = text[line..start].trim().is_empty();
            let end = text[start..].find('\n').map_or(text.len(), |at| start + at);
            let on_line = places.range(line..start).map(|(_, name)| *name).find(|name| !name.contains('['));
            let next = places.range(end..).map(|(_, name)| *name).find(|name| !name.contains('['));
            match (on_line, next) {
                _ if is_own_line && start < body => comments.head.push(comment),
                (Some(name), _) if !is_own_line => {
                    let old = comments.trailing.remove(name).map(|old| old + " ").unwrap_or_default();
                    comments.trailing.insert(name.to_owned(), old + &comment);
                }
                (_, Some(name)) => comments.leading.entry(name.to_owned()).or_default().push(comment),
                _ => comments.tail.push(comment),
            }
        }
        comments
    }

    /// Whether any attribute of a node has a comment.
    pub(super) fn is_inside(&self, node: &str) -> bool {
        let prefix = format!("{node}.");
        let begins = |name: &&String| name.starts_with(&prefix);
        self.leading.keys().chain(self.trailing.keys()).any(|name| begins(&name))
    }

    /// A line with its comments.
    pub(super) fn line(&self, name: &str, indent: &str, line: &str) -> String {
        let mut text = String::new();
        for comment in self.leading.get(name).into_iter().flatten() {
            text += &format!("{indent}{comment}\n");
        }
        match self.trailing.get(name) {
            Some(comment) => text + &format!("{indent}{line} {comment}\n"),
            None => text + &format!("{indent}{line}\n"),
        }
    }
}

/// All comments with their byte offsets. Text in quotes is skipped. Each line of a block comment becomes a line
/// comment.
fn find_comments(text: &str) -> Vec<(usize, String)> {
    let bytes = text.as_bytes();
    let (mut at, mut all) = (0, Vec::new());
    while at < bytes.len() {
        match (bytes[at], bytes.get(at + 1)) {
            (b'"', _) => at = after_quote(bytes, at),
            (b'/', Some(b'/')) => {
                let end = text[at..].find('\n').map_or(text.len(), |length| at + length);
                all.push((at, text[at..end].trim_end().to_owned()));
                at = end;
            }
            (b'/', Some(b'*')) => {
                let end = text[at..].find("*/").map_or(text.len(), |length| at + length + 2);
                let inside = text[at + 2..end].trim_end_matches("*/");
                let lines = inside.lines().map(str::trim).filter(|line| !line.is_empty());
                all.extend(lines.map(|line| (at, format!("// {line}"))));
                at = end;
            }
            _ => at += 1,
        }
    }
    all
}

fn after_quote(bytes: &[u8], start: usize) -> usize {
    let mut at = start + 1;
    while at < bytes.len() && bytes[at] != b'"' {
        at += if bytes[at] == b'\\' { 2 } else { 1 };
    }
    at + 1
}
