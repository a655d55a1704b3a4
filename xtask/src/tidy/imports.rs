//! The import graph of a crate: which files import which. It must have no circle, so that each file can be read with
//! only the files below it in mind.
//!
//! A file imports another when a path in its code, in a `use` or written out, leads into it. A re-export counts as the
//! file that re-exports. Tests, documentation and declarations of modules do not count.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fs;
use std::io;
use std::path::Path;

use syn::visit::{self, Visit};
use syn::{Attribute, Item, ItemUse, UseTree};

use crate::files;

/// A module, as the names that lead to it from the root of its crate.
type Module = Vec<String>;

/// The modules that each module imports.
type Graph = BTreeMap<Module, BTreeSet<Module>>;

/// The circles of imports in a crate, each with its shortest round.
pub fn circles(src: &Path) -> io::Result<Vec<String>> {
    let graph = graph(src)?;
    let reached: BTreeMap<_, _> = graph.keys().map(|from| (from, reached(&graph, from))).collect();
    let mut told = BTreeSet::new();
    let mut circles = Vec::new();
    for module in graph.keys().filter(|module| reached[module].contains(*module)) {
        let circle: Vec<_> = reached[module].iter().filter(|other| reached[other].contains(module)).collect();
        if circle.iter().any(|other| told.contains(*other)) {
            continue;
        }
        told.extend(circle.iter().copied().cloned());
        let round: Vec<_> = shortest_round(&graph, module).iter().map(name).collect();
        circles.push(format!("{} files import each other in a circle: {}", circle.len(), round.join(" → ")));
    }
    Ok(circles)
}

fn name(module: &Module) -> String {
    if module.is_empty() { "crate".to_owned() } else { module.join("::") }
}

/// The modules below `src`, with their imports.
fn graph(src: &Path) -> io::Result<Graph> {
    let mut texts = BTreeMap::new();
    for path in files::below(src)? {
        let name = files::name(src, &path);
        if let Some(module) = name.strip_suffix(".rs").and_then(module_of) {
            texts.insert(module, fs::read_to_string(&path)?);
        }
    }
    let modules: BTreeSet<_> = texts.keys().cloned().collect();
    let imports = |(module, text): (&Module, &String)| {
        let mut imports = Imports { module, here: module.clone(), modules: &modules, found: BTreeSet::new() };
        // The compiler reports a file that is not Rust.
        if let Ok(file) = syn::parse_file(text) {
            imports.visit_file(&file);
        }
        (module.clone(), imports.found)
    };
    Ok(texts.iter().map(imports).collect())
}

/// The module of a file without its ending; none for a file of tests.
fn module_of(file: &str) -> Option<Module> {
    let mut names: Module = file.split('/').map(str::to_owned).collect();
    if names.iter().any(|name| name == "tests") {
        return None;
    }
    if matches!(names.last().map(String::as_str), Some("mod" | "lib" | "main")) {
        names.pop();
    }
    Some(names)
}

/// Collects the imports of one file.
struct Imports<'a> {
    module: &'a Module,
    /// The path of the item that is visited: the module, and the modules written inside its file.
    here: Module,
    modules: &'a BTreeSet<Module>,
    found: BTreeSet<Module>,
}

impl Imports<'_> {
    /// Adds the module that a path leads into, if it is one of this crate.
    fn add(&mut self, path: &[String]) {
        let Some(mut path) = self.absolute(path) else { return };
        while !self.modules.contains(&path) {
            if path.pop().is_none() {
                return;
            }
        }
        if path != *self.module {
            self.found.insert(path);
        }
    }

    /// A path from the root of the crate; none if it does not start inside this crate.
    fn absolute(&self, path: &[String]) -> Option<Module> {
        let (first, rest) = path.split_first()?;
        let inside = |module: &[String]| [module, rest].concat();
        match first.as_str() {
            "crate" => Some(rest.to_vec()),
            "self" if !rest.is_empty() => Some(inside(&self.here)),
            "super" => {
                let up = path.iter().take_while(|name| *name == "super").count();
                let kept = self.here.len().checked_sub(up)?;
                Some([&self.here[..kept], &path[up..]].concat())
            }
            _ => {
                let child = [&self.here, &path[..1]].concat();
                self.modules.contains(&child).then(|| inside(&child))
            }
        }
    }

    fn add_tree(&mut self, before: &mut Vec<String>, tree: &UseTree) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.add_tree(before, &path.tree);
                before.pop();
            }
            UseTree::Name(syn::UseName { ident }) | UseTree::Rename(syn::UseRename { ident, .. }) => {
                let is_module = ident == "self";
                let end = (!is_module).then(|| ident.to_string());
                self.add(&before.iter().cloned().chain(end).collect::<Vec<_>>());
            }
            UseTree::Glob(_) => self.add(before),
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.add_tree(before, tree)),
        }
    }
}

impl<'ast> Visit<'ast> for Imports<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        let attributes = match item {
            Item::Mod(item) => &item.attrs,
            Item::Fn(item) => &item.attrs,
            Item::Use(item) => &item.attrs,
            Item::Impl(item) => &item.attrs,
            _ => return visit::visit_item(self, item),
        };
        if is_test(attributes) {
            return;
        }
        if let Item::Mod(inner) = item {
            self.here.push(inner.ident.to_string());
        }
        visit::visit_item(self, item);
        if let Item::Mod(_) = item {
            self.here.pop();
        }
    }

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        self.add_tree(&mut Vec::new(), &item.tree);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: Vec<_> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        if names.len() > 1 && path.leading_colon.is_none() {
            self.add(&names);
        }
        visit::visit_path(self, path);
    }
}

/// Whether an item is compiled for tests only.
fn is_test(attributes: &[Attribute]) -> bool {
    let is_test = |attribute: &Attribute| {
        attribute.path().is_ident("cfg")
            && attribute.parse_args::<syn::Ident>().is_ok_and(|condition| condition == "test")
    };
    attributes.iter().any(is_test)
}

/// The modules that a module imports, and those that they import; itself only where it is in a circle.
fn reached(graph: &Graph, from: &Module) -> BTreeSet<Module> {
    let mut reached = BTreeSet::new();
    let mut open: Vec<_> = graph[from].iter().collect();
    while let Some(next) = open.pop() {
        if reached.insert(next.clone()) {
            open.extend(&graph[next]);
        }
    }
    reached
}

/// The shortest round from a module in a circle back to itself.
fn shortest_round(graph: &Graph, from: &Module) -> Vec<Module> {
    let mut open = VecDeque::from([vec![from.clone()]]);
    let mut seen = BTreeSet::new();
    while let Some(round) = open.pop_front() {
        for next in round.last().into_iter().flat_map(|last| &graph[last]) {
            let longer = [&round[..], std::slice::from_ref(next)].concat();
            if next == from {
                return longer;
            }
            if seen.insert(next) {
                open.push_back(longer);
            }
        }
    }
    Vec::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The circles of a crate of these files.
    fn circles_of(sources: &[(&str, &str)]) -> Vec<String> {
        let root = tempfile::tempdir().unwrap();
        for (name, text) in sources {
            let path = root.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        circles(root.path()).unwrap()
    }

    #[test]
    fn imports_in_one_direction_are_no_circle() {
        let sources = [
            ("lib.rs", "mod a;\nmod b;\npub use b::B;\n"),
            ("a.rs", "pub struct A;\n#[cfg(test)]\nmod tests {\n    use crate::b::B;\n}\n"),
            (
                "b.rs",
                "//! See [`crate::B`].\nuse crate::a::A;\npub struct B(A);\nmod c {\n    use super::*;\n}\n",
            ),
        ];
        assert_eq!(circles_of(&sources), [""; 0]);
    }

    #[test]
    fn two_files_that_import_each_other_are_a_circle_however_they_write_it() {
        let of = |b: &str| {
            circles_of(&[("lib.rs", "mod a;\nmod b;"), ("a.rs", "use crate::{b::B};"), ("b.rs", b)])
        };
        let expected = ["2 files import each other in a circle: a → b → a"];
        assert_eq!(of("use super::a;"), expected);
        assert_eq!(of("use crate::a::{self, A as C};"), expected);
        assert_eq!(of("fn f() -> crate::a::A { todo!() }"), expected);
    }

    #[test]
    fn a_child_that_imports_what_its_parent_re_exports_is_a_circle() {
        let sources = [
            ("lib.rs", "mod a;"),
            ("a/mod.rs", "mod b;\nmod c;\npub use b::B;\npub use c::C;\n"),
            ("a/b.rs", "pub struct B;"),
            ("a/c.rs", "use super::B;\npub struct C(B);"),
        ];
        assert_eq!(circles_of(&sources), ["2 files import each other in a circle: a → a::c → a"]);
    }
}
