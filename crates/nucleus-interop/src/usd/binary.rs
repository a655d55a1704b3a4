//! A stage as a binary "crate" file (OpenUSD, `pxr/usd/sdf/crateFile.h`, version 0.8.0).
//!
//! ```text
//! head | values, as they come | tokens, strings, fields, field sets, paths, specs | table of contents
//! ```
//!
//! A value is written once and referred to by 64 bits: its type, and its offset or, if it is small, the value itself. A
//! field is a name and a value; a spec (a prim, an attribute, a relationship) is a path and a set of fields. The last six
//! sections are compressed with LZ4 by the format; they are written as literals, because they are small.

mod sections;

use std::collections::HashMap;
use std::io::{Seek, SeekFrom};

use crate::output::OutFile;

use super::stage::{Attribute, Head, Prim, Stage, Value};

use sections::{
    Rep, Spec, SpecType, field_section, field_set_section, path_section, spec_section, token_section, words,
};

const VERSION: [u8; 8] = [0, 8, 0, 0, 0, 0, 0, 0];
/// Length of the head, in bytes.
const HEAD: u64 = 88;
/// Types of values, by their number in the format.
#[derive(Clone, Copy)]
enum Type {
    Bool = 1,
    Int = 3,
    Int64 = 5,
    Float = 8,
    Double = 9,
    String = 10,
    Token = 11,
    Matrix4d = 15,
    Quatf = 17,
    Vec2f = 20,
    Vec3f = 24,
    TokenListOp = 32,
    PathListOp = 34,
    TokenVector = 41,
    Specifier = 42,
    Variability = 44,
    TimeSamples = 46,
    DoubleVector = 48,
}

const ARRAY: Rep = 1 << 63;
const INLINED: Rep = 1 << 62;

fn rep(kind: Type, payload: u64) -> Rep {
    (kind as u64) << 48 | payload
}

fn inlined(kind: Type, payload: u32) -> Rep {
    INLINED | rep(kind, payload.into())
}

/// A binary file that a stage is written to.
pub(super) struct BinaryStage {
    file: OutFile,
    length: u64,
    tokens: Vec<String>,
    token_numbers: HashMap<String, u32>,
    strings: Vec<u32>,
    specs: Vec<Spec>,
    /// The open prims, from the root.
    open: Vec<usize>,
    /// Times and values of the open attribute.
    samples: Vec<(f64, Rep)>,
    /// Relationships and connections: spec, field, and the path that it names. Paths are numbered at the end.
    targets: Vec<(usize, &'static str, String)>,
}

impl BinaryStage {
    pub fn new(file: OutFile) -> Self {
        let mut stage = Self {
            file,
            length: 0,
            tokens: Vec::new(),
            token_numbers: HashMap::new(),
            strings: Vec::new(),
            specs: Vec::new(),
            open: vec![0],
            samples: Vec::new(),
            targets: Vec::new(),
        };
        stage.put(&[0; HEAD as usize]);
        // The sign of a token tells properties from prims in paths, so that no name may be token 0.
        stage.token(";-)");
        let name = stage.token("");
        stage.specs.push(Spec {
            name,
            kind: SpecType::Root,
            fields: Vec::new(),
            children: Vec::new(),
            path: "/".to_owned(),
        });
        stage
    }

    /// The file, when every prim has ended.
    pub fn finish(mut self) -> OutFile {
        self.number_targets();
        self.list_children();
        let sections = [
            ("TOKENS", token_section(&self.tokens)),
            ("STRINGS", words(&self.strings)),
            ("FIELDS", field_section(&self.specs)),
            ("FIELDSETS", field_set_section(&self.specs)),
            ("PATHS", path_section(&self.specs)),
            ("SPECS", spec_section(&self.specs)),
        ];
        let mut contents = (sections.len() as u64).to_le_bytes().to_vec();
        for (name, bytes) in &sections {
            let offset = self.place(bytes);
            let mut title = [0; 16];
            title[..name.len()].copy_from_slice(name.as_bytes());
            contents.extend(title);
            contents.extend(offset.to_le_bytes());
            contents.extend((bytes.len() as u64).to_le_bytes());
        }
        let contents = self.place(&contents);
        let mut head = b"PXR-USDC".to_vec();
        head.extend(VERSION);
        head.extend(contents.to_le_bytes());
        if let Err(error) = self.file.seek(SeekFrom::Start(0)) {
            self.file.fail(error);
        }
        self.file.bytes(&head);
        self.file
    }

    fn put(&mut self, bytes: &[u8]) {
        self.file.bytes(bytes);
        self.length += bytes.len() as u64;
    }

    /// Writes bytes at a multiple of eight; returns the offset.
    fn place(&mut self, bytes: &[u8]) -> u64 {
        let padding = self.length.next_multiple_of(8) - self.length;
        self.put(&[0; 8][..padding as usize]);
        let offset = self.length;
        self.put(bytes);
        offset
    }

    fn token(&mut self, text: &str) -> u32 {
        if let Some(&number) = self.token_numbers.get(text) {
            return number;
        }
        let number = self.tokens.len() as u32;
        self.tokens.push(text.to_owned());
        self.token_numbers.insert(text.to_owned(), number);
        number
    }

    fn string(&mut self, text: &str) -> u32 {
        let token = self.token(text);
        self.strings.push(token);
        self.strings.len() as u32 - 1
    }

    fn field(&mut self, spec: usize, name: &str, value: Rep) {
        let name = self.token(name);
        self.specs[spec].fields.push((name, value));
    }

    /// Adds a spec to the current prim.
    fn spec(&mut self, kind: SpecType, name: &str) -> usize {
        let parent = self.open[self.open.len() - 1];
        let above = &self.specs[parent].path;
        let path = match kind {
            SpecType::Prim if above == "/" => format!("/{name}"),
            SpecType::Prim => format!("{above}/{name}"),
            _ => format!("{above}.{name}"),
        };
        let name = self.token(name);
        let index = self.specs.len();
        self.specs.push(Spec { name, kind, fields: Vec::new(), children: Vec::new(), path });
        self.specs[parent].children.push(index);
        index
    }

    fn attribute_spec(&mut self, attribute: &Attribute) -> usize {
        let spec = self.spec(SpecType::Attribute, attribute.name);
        let type_name = self.token(attribute.type_name);
        self.field(spec, "typeName", inlined(Type::Token, type_name));
        if attribute.is_custom {
            self.field(spec, "custom", inlined(Type::Bool, 1));
        }
        if attribute.is_uniform {
            self.field(spec, "variability", inlined(Type::Variability, 1));
        }
        if let Some(interpolation) = attribute.interpolation {
            let interpolation = self.token(interpolation);
            self.field(spec, "interpolation", inlined(Type::Token, interpolation));
        }
        spec
    }

    fn array(&mut self, kind: Type, count: usize, bytes: impl Iterator<Item = u8>) -> Rep {
        if count == 0 {
            return ARRAY | rep(kind, 0);
        }
        let bytes: Vec<u8> = (count as u64).to_le_bytes().into_iter().chain(bytes).collect();
        ARRAY | rep(kind, self.place(&bytes))
    }

    fn tokens_of<'a>(&mut self, texts: impl Iterator<Item = &'a str>) -> Vec<u32> {
        texts.map(|text| self.token(text)).collect()
    }

    fn value(&mut self, value: &Value) -> Rep {
        match value {
            Value::Bool(on) => inlined(Type::Bool, u32::from(*on)),
            Value::Token(text) => inlined(Type::Token, self.token(text)),
            Value::Tokens(texts) => {
                let tokens = self.tokens_of(texts.iter().copied());
                self.array(Type::Token, tokens.len(), tokens.iter().flat_map(|token| token.to_le_bytes()))
            }
            Value::Text(text) => inlined(Type::String, self.string(text)),
            Value::Float(x) => inlined(Type::Float, x.to_bits()),
            Value::Vec2(v) => {
                let bytes: Vec<u8> = v.iter().flat_map(|x| x.to_le_bytes()).collect();
                rep(Type::Vec2f, self.place(&bytes))
            }
            Value::Vec3(v) => {
                let bytes: Vec<u8> = v.iter().flat_map(|x| x.to_le_bytes()).collect();
                rep(Type::Vec3f, self.place(&bytes))
            }
            Value::Matrix(rows) => {
                let bytes: Vec<u8> = rows.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
                rep(Type::Matrix4d, self.place(&bytes))
            }
            Value::Ints(all) => self.array(Type::Int, all.len(), all.iter().flat_map(|x| x.to_le_bytes())),
            Value::Int64s(all) => {
                self.array(Type::Int64, all.len(), all.iter().flat_map(|x| x.to_le_bytes()))
            }
            Value::Floats(all) => {
                self.array(Type::Float, all.len(), all.iter().flat_map(|x| x.to_le_bytes()))
            }
            Value::Vec2s(all) => {
                self.array(Type::Vec2f, all.len(), all.as_flattened().iter().flat_map(|x| x.to_le_bytes()))
            }
            Value::Vec3s(all) => {
                self.array(Type::Vec3f, all.len(), all.as_flattened().iter().flat_map(|x| x.to_le_bytes()))
            }
            Value::Quaternions(all) => {
                self.array(Type::Quatf, all.len(), all.as_flattened().iter().flat_map(|x| x.to_le_bytes()))
            }
        }
    }

    fn double(&mut self, x: f64) -> Rep {
        let offset = self.place(&x.to_le_bytes());
        rep(Type::Double, offset)
    }

    fn token_vector(&mut self, tokens: &[u32]) -> Rep {
        let offset = self.place(&words(tokens));
        rep(Type::TokenVector, offset)
    }

    /// Writes the lists of paths that relationships and connections name.
    fn number_targets(&mut self) {
        const EXPLICIT: u8 = 1 | 2;
        for (spec, field, target) in std::mem::take(&mut self.targets) {
            // Every target is part of the stage.
            let number = self.specs.iter().position(|one| one.path == target).unwrap_or_default() as u32;
            let mut bytes = vec![EXPLICIT];
            bytes.extend(words(&[number]));
            let offset = self.place(&bytes);
            self.field(spec, field, rep(Type::PathListOp, offset));
        }
    }

    /// Writes the names of the children of each prim.
    fn list_children(&mut self) {
        for spec in 0..self.specs.len() {
            for (field, wants_prims) in [("primChildren", true), ("properties", false)] {
                let is_wanted =
                    |child: &&usize| matches!(self.specs[**child].kind, SpecType::Prim) == wants_prims;
                let names: Vec<u32> = self.specs[spec]
                    .children
                    .iter()
                    .filter(is_wanted)
                    .map(|child| self.specs[*child].name)
                    .collect();
                if !names.is_empty() {
                    let names = self.token_vector(&names);
                    self.field(spec, field, names);
                }
            }
        }
    }
}

impl Stage for BinaryStage {
    fn head(&mut self, head: &Head) {
        let Head { title, metres_per_unit, times: [first, last], fps } = head;
        let (run, up) = (self.token("run"), self.token("Y"));
        self.field(0, "defaultPrim", inlined(Type::Token, run));
        self.field(0, "upAxis", inlined(Type::Token, up));
        let title = self.string(title);
        self.field(0, "documentation", inlined(Type::String, title));
        for (name, value) in [
            ("metersPerUnit", metres_per_unit),
            ("startTimeCode", first),
            ("endTimeCode", last),
            ("timeCodesPerSecond", fps),
            ("framesPerSecond", fps),
        ] {
            let value = self.double(*value);
            self.field(0, name, value);
        }
    }

    fn begin(&mut self, prim: &Prim) {
        const PREPENDED: u8 = 32;
        let spec = self.spec(SpecType::Prim, prim.name);
        self.field(spec, "specifier", inlined(Type::Specifier, 0));
        let type_name = self.token(prim.type_name);
        self.field(spec, "typeName", inlined(Type::Token, type_name));
        if let Some(kind) = prim.kind {
            let kind = self.token(kind);
            self.field(spec, "kind", inlined(Type::Token, kind));
        }
        if !prim.schemas.is_empty() {
            let schemas = self.tokens_of(prim.schemas.iter().copied());
            let mut bytes = vec![PREPENDED];
            bytes.extend(words(&schemas));
            let offset = self.place(&bytes);
            self.field(spec, "apiSchemas", rep(Type::TokenListOp, offset));
        }
        self.open.push(spec);
    }

    fn end(&mut self) {
        self.open.pop();
    }

    fn attribute(&mut self, attribute: &Attribute, value: &Value) {
        let spec = self.attribute_spec(attribute);
        let value = self.value(value);
        self.field(spec, "default", value);
    }

    fn declare(&mut self, attribute: &Attribute) {
        self.attribute_spec(attribute);
    }

    fn connect(&mut self, attribute: &Attribute, target: &str) {
        let spec = self.attribute_spec(attribute);
        self.targets.push((spec, "connectionPaths", target.to_owned()));
    }

    fn relate(&mut self, name: &str, target: &str) {
        let spec = self.spec(SpecType::Relationship, name);
        self.field(spec, "variability", inlined(Type::Variability, 1));
        self.targets.push((spec, "targetPaths", target.to_owned()));
    }

    fn begin_samples(&mut self, attribute: &Attribute) {
        self.attribute_spec(attribute);
        self.samples.clear();
    }

    fn sample(&mut self, time: f64, value: &Value) {
        let value = self.value(value);
        self.samples.push((time, value));
    }

    fn end_samples(&mut self) {
        /// Each part begins with the distance to what follows it; nothing lies between.
        const NEXT: [u8; 8] = 8_u64.to_le_bytes();
        let samples = std::mem::take(&mut self.samples);
        let count = (samples.len() as u64).to_le_bytes();
        let times = count.into_iter().chain(samples.iter().flat_map(|(time, _)| time.to_le_bytes()));
        let times = self.place(&times.collect::<Vec<u8>>());
        let mut bytes = NEXT.to_vec();
        bytes.extend(rep(Type::DoubleVector, times).to_le_bytes());
        bytes.extend(NEXT);
        bytes.extend(count);
        samples.iter().for_each(|(_, value)| bytes.extend(value.to_le_bytes()));
        let offset = self.place(&bytes);
        self.field(self.specs.len() - 1, "timeSamples", rep(Type::TimeSamples, offset));
    }

    fn has_failed(&self) -> bool {
        self.file.has_failed()
    }
}
