//! Statements of a file become nodes, values and connections. Nothing is executed: an unknown command is left out.

use std::path::{Path, PathBuf};

use crate::ascii::{Arguments, Flag, ImportError, SourceText, Span, Statement, Statements, Token, Tokens};
use crate::omissions::Cause;

use super::graph::{Assigned, MayaScene, NodeId, PlugRef};
use super::reference::{self, Reference};

const CREATE_NODE: &[Flag] = &[
    Flag::new("n", "name", 1),
    Flag::new("p", "parent", 1),
    Flag::new("s", "shared", 0),
    Flag::new("ss", "skipSelect", 0),
];

const SET_ATTR: &[Flag] = &[
    Flag::new("k", "keyable", 1),
    Flag::new("l", "lock", 1),
    Flag::new("cb", "channelBox", 1),
    Flag::new("ca", "caching", 1),
    Flag::new("s", "size", 1),
    Flag::new("ch", "capacityHint", 1),
    Flag::new("typ", "type", 1),
    Flag::new("av", "alteredValue", 0),
    Flag::new("c", "clamp", 0),
];

const ADD_ATTR: &[Flag] = &[
    Flag::new("ln", "longName", 1),
    Flag::new("sn", "shortName", 1),
    Flag::new("nn", "niceName", 1),
    Flag::new("at", "attributeType", 1),
    Flag::new("dt", "dataType", 1),
    Flag::new("dv", "defaultValue", 1),
    Flag::new("p", "parent", 1),
    Flag::new("nc", "numberOfChildren", 1),
    Flag::new("en", "enumName", 1),
    Flag::new("min", "minValue", 1),
    Flag::new("max", "maxValue", 1),
    Flag::new("smn", "softMinValue", 1),
    Flag::new("smx", "softMaxValue", 1),
    Flag::new("ci", "cachedInternally", 1),
    Flag::new("is", "internalSet", 1),
    Flag::new("k", "keyable", 1),
    Flag::new("h", "hidden", 1),
    Flag::new("s", "storable", 1),
    Flag::new("m", "multi", 0),
    Flag::new("im", "indexMatters", 1),
    Flag::new("uac", "usedAsColor", 0),
    Flag::new("r", "readable", 1),
    Flag::new("w", "writable", 1),
    Flag::new("dcb", "disconnectBehaviour", 1),
    Flag::new("ct", "category", 1),
];

const CONNECT_ATTR: &[Flag] =
    &[Flag::new("na", "nextAvailable", 0), Flag::new("f", "force", 0), Flag::new("l", "lock", 1)];

const PARENT: &[Flag] = &[
    Flag::new("s", "shape", 0),
    Flag::new("nc", "noConnections", 0),
    Flag::new("r", "relative", 0),
    Flag::new("add", "addObject", 0),
    Flag::new("w", "world", 0),
    Flag::new("a", "absolute", 0),
    Flag::new("rm", "removeObject", 0),
];

const FILE: &[Flag] = &[
    Flag::new("r", "reference", 0),
    Flag::new("rdi", "referenceDepthInfo", 1),
    Flag::new("ns", "namespace", 1),
    Flag::new("rpr", "renamingPrefix", 1),
    Flag::new("dr", "deferReference", 1),
    Flag::new("rfn", "referenceNode", 1),
    Flag::new("op", "options", 1),
    Flag::new("typ", "type", 1),
    Flag::new("shd", "sharedNodes", 1),
];

const CURRENT_UNIT: &[Flag] =
    &[Flag::new("l", "linear", 1), Flag::new("a", "angle", 1), Flag::new("t", "time", 1)];

const SELECT: &[Flag] = &[Flag::new("ne", "noExpand", 0)];
const RENAME: &[Flag] = &[Flag::new("uid", "uuid", 0)];
const NO_FLAGS: &[Flag] = &[];

/// Commands that say nothing about a simulation.
const SILENT: [&str; 8] = [
    "requires",
    "lockNode",
    "relationship",
    "dataStructure",
    "applyMetadata",
    "workspace",
    "createDisplayLayer",
    "webTutorialNotify",
];

impl MayaScene {
    /// Reads a scene, and all files that it refers to.
    ///
    /// # Errors
    /// When the scene itself cannot be read, is binary, or holds no statement of Maya. A mistake in a part of
    /// it, or in a file that it refers to, is an omission.
    pub fn read(path: &Path) -> Result<Self, ImportError> {
        Self::of_text(SourceText::read(path)?)
    }

    /// As [`read`](Self::read), for a text in memory.
    ///
    /// # Errors
    /// As there.
    pub fn of_text(text: SourceText) -> Result<Self, ImportError> {
        let mut scene = Self::default();
        let path = text.path.clone();
        let mut reader = Reader { scene: &mut scene, open: Vec::new() };
        if !reader.file(text, "", true) {
            let text = &scene.texts[0];
            let start = Statements::new(&text.text).next().map_or(0, |statement| statement.start);
            let (line, column) = text.place(start);
            return Err(ImportError::NotMaya { file: path, line, column });
        }
        reference::apply_edits(&mut scene);
        Ok(scene)
    }
}

/// Reads files into a scene.
pub(super) struct Reader<'s> {
    pub(super) scene: &'s mut MayaScene,
    /// The files that are being read, outermost first.
    open: Vec<PathBuf>,
}

/// The state of reading one file.
struct FileReader<'a> {
    file: u16,
    text: &'a str,
    namespace: &'a str,
    current: Option<NodeId>,
}

impl Reader<'_> {
    /// Reads a file. Returns whether any of its statements is one of Maya's.
    pub(super) fn file(&mut self, source: SourceText, namespace: &str, is_main: bool) -> bool {
        let Ok(file) = u16::try_from(self.scene.texts.len()) else { return false };
        let path = source.path.clone();
        self.open.push(path.canonicalize().unwrap_or(path));
        // The text is taken out while it is read, so that the scene can change.
        let text = source.text;
        self.scene.texts.push(SourceText { path: source.path, text: String::new() });
        // A file that states no units has those of the scene.
        self.scene.file_units.resize(usize::from(file) + 1, self.scene.units);
        let mut reader = FileReader { file, text: &text, namespace, current: None };
        let (mut known, mut references) = (text.starts_with("//Maya ASCII"), Vec::new());
        let mut wires = Vec::new();
        for statement in Statements::new(&text) {
            if statement.is_cut {
                let place = place_of(&text, statement.start);
                let what = format!("{}:{place}", self.scene.texts[usize::from(file)].path.display());
                self.scene.omissions.add(what, Cause::Cut);
                break;
            }
            known |= self.statement(&mut reader, statement, is_main, &mut references, &mut wires);
        }
        self.scene.texts[usize::from(file)].text = text;
        self.references(references, file, namespace);
        for wire in wires {
            self.wire(wire, namespace);
        }
        self.open.pop();
        known
    }

    /// Applies a statement. Returns whether it is one of Maya's.
    fn statement<'a>(
        &mut self,
        reader: &mut FileReader<'a>,
        statement: Statement<'a>,
        is_main: bool,
        references: &mut Vec<Reference>,
        wires: &mut Vec<[Span; 2]>,
    ) -> bool {
        let mut tokens = Tokens::new(statement.text);
        let Some(Token::Word(command)) = tokens.next() else { return false };
        match command {
            "setAttr" => self.set_attr(reader, &mut tokens),
            "createNode" => self.create_node(reader, &mut tokens),
            "connectAttr" => {
                let arguments = Arguments::of(&mut tokens, CONNECT_ATTR);
                if let [Token::Quoted(from), Token::Quoted(to)] = arguments.plain[..] {
                    wires.push([reader.span(from), reader.span(to)]);
                }
            }
            "addAttr" => self.add_attr(reader, &mut tokens),
            "select" => {
                let arguments = Arguments::of(&mut tokens, SELECT);
                let name = arguments.plain.last().map(|token| token.text().into_owned()).unwrap_or_default();
                reader.current = Some(self.find_or_add(&name, reader.file));
            }
            "rename" => {
                let arguments = Arguments::of(&mut tokens, RENAME);
                if !arguments.has("uid")
                    && let [old, new] = &arguments.plain[..]
                    && let Some(id) = self.scene.find(&old.text())
                {
                    self.scene.rename(id, &new.text());
                }
            }
            "parent" => self.parent(reader, &mut tokens),
            "currentUnit" => self.current_unit(&mut tokens, reader.file, is_main),
            "fileInfo" => {
                let arguments = Arguments::of(&mut tokens, NO_FLAGS);
                if let (true, [key, value]) = (is_main, &arguments.plain[..]) {
                    self.scene.file_info.push((key.text().into_owned(), value.text().into_owned()));
                }
            }
            "file" => references.extend(Reference::of(&Arguments::of(&mut tokens, FILE))),
            known if SILENT.contains(&known) => {}
            other => {
                let word = other.starts_with(|c: char| c.is_ascii_alphabetic());
                if word && other.len() < 64 {
                    self.scene.omissions.add(other.to_owned(), Cause::Command);
                }
                return false;
            }
        }
        true
    }

    fn create_node(&mut self, reader: &mut FileReader, tokens: &mut Tokens) {
        let arguments = Arguments::of(tokens, CREATE_NODE);
        let Some(kind) = arguments.plain.first().map(|token| token.text()) else { return };
        let given =
            arguments.get("n").map(|token| token.text().into_owned()).unwrap_or_else(|| kind.to_string());
        let path = |token: Token| qualified(&token.text(), reader.namespace);
        let parent = arguments.get("p").and_then(|token| self.scene.find(&path(token)));
        let name = qualified(&given, reader.namespace);
        let exists = || self.scene.find(&name).filter(|id| self.scene.kind(*id) == kind);
        // Every file brings its own cameras and shading nodes; a reference shares them with the scene.
        let shared = arguments.has("s").then(exists).flatten();
        reader.current = Some(shared.unwrap_or_else(|| self.scene.add(&name, &kind, parent, reader.file)));
    }

    fn set_attr(&mut self, reader: &FileReader, tokens: &mut Tokens) {
        let arguments = Arguments::until(tokens, SET_ATTR, 1);
        let Some(Token::Quoted(plug) | Token::Word(plug)) = arguments.plain.first().copied() else { return };
        let (node, plug) = match plug.split_once('.') {
            Some(("", plug)) => (reader.current, plug),
            Some((node, plug)) => (self.scene.find(&qualified(node, reader.namespace)), plug),
            None => return,
        };
        let Some(node) = node else { return };
        let value = reader.span(tokens.rest());
        let data_type = match arguments.get("typ") {
            Some(Token::Quoted(name) | Token::Word(name)) => reader.span(name),
            None => Span { start: 0, end: 0, ..value },
        };
        // The range of frames stands in a script that Maya runs when it opens a scene.
        if plug == "b" || plug == "before" {
            self.playback(&reader.text[value.start as usize..value.end as usize]);
        }
        let assigned = Assigned { plug: reader.span(plug), data_type, value };
        self.scene.nodes[node.0 as usize].assigned.push(assigned);
    }

    /// `playbackOptions -min 1 -max 120 -ast 1 -aet 200`
    fn playback(&mut self, script: &str) {
        let Some((_, options)) = script.split_once("playbackOptions ") else { return };
        let words: Vec<&str> = options.split([' ', '"', ';']).filter(|word| !word.is_empty()).collect();
        let after = |names: [&str; 2]| {
            let at = words.iter().position(|word| names.contains(word))?;
            words.get(at + 1)?.parse::<f64>().ok().filter(|x| x.is_finite())
        };
        if let (Some(first), Some(last)) = (after(["-min", "-minTime"]), after(["-max", "-maxTime"])) {
            self.scene.playback.get_or_insert([first, last]);
        }
    }

    fn add_attr(&mut self, reader: &FileReader, tokens: &mut Tokens) {
        let arguments = Arguments::of(tokens, ADD_ATTR);
        let name = |flag| arguments.get(flag).map(|token| token.text());
        let Some(long) = name("ln").or_else(|| name("sn")) else { return };
        let short = name("sn").unwrap_or_else(|| long.clone());
        if let Some(node) = reader.current {
            self.scene.nodes[node.0 as usize].added.push((long.into(), short.into()));
        }
    }

    fn parent(&mut self, reader: &FileReader, tokens: &mut Tokens) {
        let arguments = Arguments::of(tokens, PARENT);
        let ids: Vec<Option<NodeId>> = arguments
            .plain
            .iter()
            .map(|token| self.scene.find(&qualified(&token.text(), reader.namespace)))
            .collect();
        if arguments.has("w") {
            ids.into_iter().flatten().for_each(|id| self.scene.nodes[id.0 as usize].parent = None);
            return;
        }
        let Some((Some(parent), children)) = ids.split_last() else { return };
        for child in children.iter().flatten() {
            let loops = self.scene.self_and_ancestors(*parent).contains(child);
            if arguments.has("add") {
                let under = self.scene.name(*parent).to_owned();
                self.scene.omissions.add(self.scene.name(*child).to_owned(), Cause::Instance(under));
            } else if !loops {
                self.scene.nodes[child.0 as usize].parent = Some(*parent);
            }
        }
    }

    fn current_unit(&mut self, tokens: &mut Tokens, file: u16, is_main: bool) {
        let arguments = Arguments::of(tokens, CURRENT_UNIT);
        let units = &mut self.scene.file_units[usize::from(file)];
        let take = |flag: &str, set: &mut dyn FnMut(&str) -> bool| {
            let name = arguments.get(flag).map(|token| token.text())?;
            (!set(&name)).then(|| name.into_owned())
        };
        let unknown = [
            take("l", &mut |name| units.set_length(name)),
            take("a", &mut |name| units.set_angle(name)),
            take("t", &mut |name| units.set_time(name)),
        ];
        if is_main {
            self.scene.units = *units;
        }
        if let Some(name) = arguments.get("t").filter(|_| !units.has_a_frame_rate()) {
            self.scene.omissions.add(name.text().into_owned(), Cause::FrameRate);
        }
        for name in unknown.into_iter().flatten() {
            self.scene.omissions.add(name, Cause::Unit);
        }
    }

    fn find_or_add(&mut self, name: &str, file: u16) -> NodeId {
        let plain = name.trim_start_matches(':');
        self.scene.find(name).unwrap_or_else(|| {
            let kind = if plain == "time1" { "time" } else { "" };
            self.scene.add(plain, kind, None, file)
        })
    }

    fn wire(&mut self, [from, to]: [Span; 2], namespace: &str) {
        let end = |scene: &MayaScene, span: Span| {
            let text = scene.text(span);
            let (node, path) = text.split_once('.')?;
            let start = span.start + (text.len() - path.len()) as u32;
            Some((qualified(node, namespace), Span { start, ..span }))
        };
        let (Some((from, out)), Some((to, input))) = (end(self.scene, from), end(self.scene, to)) else {
            return;
        };
        let file = out.file;
        if from.trim_start_matches(':') == "time1" {
            self.find_or_add("time1", file);
        }
        // Connections to Maya's own nodes, `:initialShadingGroup`, say nothing about a simulation.
        if let [Some(from), Some(to)] = [from, to].map(|name| self.scene.find(&name)) {
            self.scene.connect(PlugRef { node: from, path: out }, PlugRef { node: to, path: input });
        }
    }

    /// Reads the files that a file refers to.
    fn references(&mut self, references: Vec<Reference>, file: u16, namespace: &str) {
        for reference in reference::merged(references) {
            let from = self.scene.texts[usize::from(file)].path.clone();
            let inner = match (namespace, reference.namespace.as_str()) {
                ("", inner) => inner.to_owned(),
                (outer, "") => outer.to_owned(),
                (outer, inner) => format!("{outer}:{inner}"),
            };
            let Some(found) = reference::locate(&from, &reference.path, "ma") else {
                self.scene.omissions.add(reference.path, Cause::NoFile);
                continue;
            };
            let canonical = found.canonicalize().unwrap_or_else(|_| found.clone());
            if self.open.contains(&canonical) || self.open.len() > 32 || self.scene.texts.len() > 4096 {
                self.scene.omissions.add(reference.path, Cause::Recursion);
                continue;
            }
            match SourceText::read(&found) {
                Ok(text) => {
                    self.file(text, &inner, false);
                }
                Err(error) => self.scene.omissions.add(reference.path, Cause::Unreadable(error.to_string())),
            }
        }
    }
}

impl FileReader<'_> {
    /// The place of a part of the text of this file.
    fn span(&self, part: &str) -> Span {
        let start = part.as_ptr() as usize - self.text.as_ptr() as usize;
        Span { file: self.file, start: start as u32, end: (start + part.len()) as u32 }
    }
}

/// A name inside a namespace: every part of a path gets it, except names of the root namespace.
pub(super) fn qualified(path: &str, namespace: &str) -> String {
    if namespace.is_empty() {
        return path.to_owned();
    }
    let part = |part: &str| match part {
        "" => String::new(),
        root if root.starts_with(':') || root == "time1" => root.to_owned(),
        name => format!("{namespace}:{name}"),
    };
    path.split('|').map(part).collect::<Vec<_>>().join("|")
}

fn place_of(text: &str, byte: usize) -> String {
    let before = text.get(..byte).unwrap_or_default();
    let line = before.bytes().filter(|b| *b == b'\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |line| line.chars().count()) + 1;
    format!("{line}:{column}")
}
