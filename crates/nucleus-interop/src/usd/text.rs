//! A stage as text.

use std::fmt::Display;

use crate::output::OutFile;

use super::stage::{Attribute, Head, Prim, Stage, Value};

/// A text file that a stage is written to.
pub(super) struct TextStage {
    file: OutFile,
    depth: usize,
}

impl TextStage {
    pub fn new(file: OutFile) -> Self {
        Self { file, depth: 0 }
    }

    /// The file, when every prim has ended.
    pub fn finish(self) -> OutFile {
        self.file
    }

    fn line(&mut self, text: impl AsRef<str>) {
        self.file.text("    ".repeat(self.depth));
        self.file.text(text);
        self.file.text("\n");
    }

    /// The attribute up to its value.
    fn declaration(&mut self, attribute: &Attribute) -> String {
        let Attribute { type_name, name, is_uniform, is_custom, .. } = *attribute;
        let custom = if is_custom { "custom " } else { "" };
        let uniform = if is_uniform { "uniform " } else { "" };
        format!("{custom}{uniform}{type_name} {name}")
    }

    /// The metadata behind the value.
    fn metadata(&mut self, attribute: &Attribute) {
        if let Some(interpolation) = attribute.interpolation {
            self.file.text(" (\n");
            self.depth += 1;
            self.line(format!("interpolation = \"{interpolation}\""));
            self.depth -= 1;
            self.file.text("    ".repeat(self.depth) + ")");
        }
        self.file.text("\n");
    }

    fn value(&mut self, value: &Value) {
        match value {
            Value::Bool(on) => self.file.text(if *on { "1" } else { "0" }),
            Value::Token(token) => self.file.text(format!("\"{token}\"")),
            Value::Tokens(tokens) => self.list(tokens.iter().map(|token| format!("\"{token}\""))),
            Value::Text(text) => self.file.text(quoted(text)),
            Value::Float(x) => self.file.text(x.to_string()),
            Value::Vec2(v) => self.file.text(tuple(v)),
            Value::Vec3(v) => self.file.text(tuple(v)),
            Value::Matrix(rows) => self.file.text(format!("({})", rows.map(|row| tuple(&row)).join(", "))),
            Value::Ints(values) => self.list(values.iter()),
            Value::Int64s(values) => self.list(values.iter()),
            Value::Floats(values) => self.list(values.iter()),
            Value::Vec2s(values) => self.list(values.iter().map(|v| tuple(v))),
            Value::Vec3s(values) => self.list(values.iter().map(|v| tuple(v))),
            // In text the real part comes first.
            Value::Quaternions(values) => self.list(values.iter().map(|&[x, y, z, w]| tuple(&[w, x, y, z]))),
        }
    }

    fn list(&mut self, values: impl Iterator<Item = impl Display>) {
        self.file.text("[");
        for (index, value) in values.enumerate() {
            self.file.text(if index > 0 { ", " } else { "" });
            self.file.text(value.to_string());
        }
        self.file.text("]");
    }
}

impl Stage for TextStage {
    fn head(&mut self, head: &Head) {
        let Head { title, metres_per_unit, times: [first, last], fps } = head;
        self.file.text(format!(
            "#usda 1.0\n(\n    defaultPrim = \"run\"\n    doc = {}\n    metersPerUnit = {metres_per_unit}\n    \
             upAxis = \"Y\"\n    startTimeCode = {first}\n    endTimeCode = {last}\n    timeCodesPerSecond = {fps}\n    \
             framesPerSecond = {fps}\n)\n\n",
            quoted(title),
        ));
    }

    fn begin(&mut self, prim: &Prim) {
        let Prim { type_name, name, schemas, kind } = *prim;
        let kind = kind.map(|kind| format!("kind = \"{kind}\""));
        let schemas = (!schemas.is_empty()).then(|| {
            format!(
                "prepend apiSchemas = [{}]",
                schemas.iter().map(|s| format!("\"{s}\"")).collect::<Vec<_>>().join(", ")
            )
        });
        let metadata: Vec<String> = kind.into_iter().chain(schemas).collect();
        if metadata.is_empty() {
            self.line(format!("def {type_name} \"{name}\""));
        } else {
            self.line(format!("def {type_name} \"{name}\" ("));
            self.depth += 1;
            metadata.iter().for_each(|line| self.line(line));
            self.depth -= 1;
            self.line(")");
        }
        self.line("{");
        self.depth += 1;
    }

    fn end(&mut self) {
        self.depth -= 1;
        self.line("}");
    }

    fn attribute(&mut self, attribute: &Attribute, value: &Value) {
        let declaration = self.declaration(attribute);
        self.file.text("    ".repeat(self.depth) + &declaration + " = ");
        self.value(value);
        self.metadata(attribute);
    }

    fn declare(&mut self, attribute: &Attribute) {
        let declaration = self.declaration(attribute);
        self.line(declaration);
    }

    fn connect(&mut self, attribute: &Attribute, target: &str) {
        let declaration = self.declaration(attribute);
        self.line(format!("{declaration}.connect = <{target}>"));
    }

    fn relate(&mut self, name: &str, target: &str) {
        self.line(format!("rel {name} = <{target}>"));
    }

    fn begin_samples(&mut self, attribute: &Attribute) {
        // Metadata of a sampled attribute stands in a declaration of its own.
        if attribute.interpolation.is_some() {
            let declaration = self.declaration(attribute);
            self.file.text("    ".repeat(self.depth) + &declaration);
            self.metadata(attribute);
        }
        let declaration = self.declaration(attribute);
        self.line(format!("{declaration}.timeSamples = {{"));
        self.depth += 1;
    }

    fn sample(&mut self, time: f64, value: &Value) {
        self.file.text("    ".repeat(self.depth) + &format!("{time}: "));
        self.value(value);
        self.file.text(",\n");
    }

    fn end_samples(&mut self) {
        self.depth -= 1;
        self.line("}");
    }

    fn has_failed(&self) -> bool {
        self.file.has_failed()
    }
}

fn tuple(numbers: &[impl Display]) -> String {
    format!("({})", numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "))
}

/// A string of USD: quotes and backslashes are escaped, other control characters than line breaks become spaces.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            '\n' => quoted.push_str("\\n"),
            c if c.is_control() => quoted.push(' '),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}
