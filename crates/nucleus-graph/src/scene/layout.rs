//! The text of a scene with its comments.

use super::comments::{Comments, items};
use super::syntax::{Node, Value};

/// A text with comments, which are placed in it. A container that holds comments takes a line for each of its items;
/// all others keep their layout.
pub(super) fn with_comments(text: &str, root: &Node, comments: &Comments) -> String {
    let mut layout = Layout { text, comments, out: String::new() };
    layout.lines(&comments.head, 0);
    layout.value(root, 0);
    layout.out.push('\n');
    layout.lines(&comments.foot, 0);
    layout.out
}

/// Spaces for each level of brackets.
const INDENT: usize = 4;

struct Layout<'a> {
    text: &'a str,
    comments: &'a Comments,
    out: String,
}

impl Layout<'_> {
    fn value(&mut self, node: &Node, indent: usize) {
        let items = match items(node) {
            Some(items) if self.comments.are_inside(node) => items,
            _ => {
                self.out.push_str(&self.text[node.span.clone()]);
                return;
            }
        };
        let bracket = match &node.value {
            Value::Record { name: Some(name), .. } | Value::Tuple { name: Some(name), .. } => name.span.end,
            _ => node.span.start,
        };
        self.out.push_str(&self.text[node.span.start..=bracket]);
        self.end_line(self.comments.opening.get(&node.span.start));
        for item in items {
            let start = item.span.start;
            self.lines(self.comments.before.get(&start).map_or(&[], Vec::as_slice), indent + INDENT);
            self.indent(indent + INDENT);
            self.out.push_str(&self.text[start..item.value.span.start]);
            self.value(item.value, indent + INDENT);
            self.out.push(',');
            self.end_line(self.comments.after.get(&start));
        }
        let closing = self.comments.closing.get(&node.span.start);
        self.lines(closing.map_or(&[], Vec::as_slice), indent + INDENT);
        self.indent(indent);
        self.out.push_str(&self.text[node.span.end - 1..node.span.end]);
    }

    fn lines(&mut self, lines: &[String], indent: usize) {
        for line in lines {
            self.indent(indent);
            self.out.push_str(line);
            self.out.push('\n');
        }
    }

    fn indent(&mut self, indent: usize) {
        self.out.extend(std::iter::repeat_n(' ', indent));
    }

    fn end_line(&mut self, comment: Option<&String>) {
        if let Some(comment) = comment {
            self.out.push(' ');
            self.out.push_str(comment);
        }
        self.out.push('\n');
    }
}
