//! Parser of the code map of `ARCHITECTURE.md`: crates, folders and modules.
//!
//! The code map is the section `## Code map`:
//!
//! ```text
//! ## Code map
//! | `crates/` | the library crates |            top-level folders: the first name of a table row
//! ### `crates/nucleus-core`                     a crate: a heading that is its folder
//! | `step` | one frame of the solver |       its modules: the first name of a table row
//! ```

use std::collections::BTreeMap;

/// A name and its line, counted from 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Named {
    /// The name, without backticks and without a final slash.
    pub name: String,
    /// The line.
    pub line: usize,
}

/// The code map.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct CodeMap {
    /// Top-level folders.
    pub folders: Vec<Named>,
    /// Crates, by the path of their folder, with their modules.
    pub crates: BTreeMap<String, CrateMap>,
}

/// The code map of one crate.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct CrateMap {
    /// The line of its heading.
    pub line: usize,
    /// Its modules.
    pub modules: Vec<Named>,
}

/// Parses the code map of a page; empty if there is none.
pub fn read(page: &str) -> CodeMap {
    let mut map = CodeMap::default();
    let mut inside = false;
    let mut current: Option<String> = None;
    for (index, text) in page.lines().enumerate() {
        let line = index + 1;
        if let Some(heading) = text.strip_prefix("## ") {
            inside = heading.trim().eq_ignore_ascii_case("code map");
            current = None;
        } else if !inside {
            continue;
        } else if let Some(heading) = text.strip_prefix("### ") {
            current = first_name(heading);
            if let Some(folder) = &current {
                map.crates.entry(folder.clone()).or_default().line = line;
            }
        } else if let Some(name) = text.strip_prefix('|').and_then(|row| first_name(row.split('|').next()?)) {
            let named = Named { name, line };
            match &current {
                Some(folder) => map.crates.entry(folder.clone()).or_default().modules.push(named),
                None => map.folders.push(named),
            }
        }
    }
    map
}

/// The text between the first two backticks.
fn first_name(text: &str) -> Option<String> {
    let name = text.split('`').nth(1)?;
    Some(name.trim_end_matches('/').to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "# Map\n| `not/` | counted |\n## Code map\n\n| folder | holds |\n|---|---|\n| `crates/` | `all` |\n\
        ### `crates/one`\nProse with `ticks`.\n| `step` | a frame |\n| `ids` | names |\n## Invariants\n| `nor` | this |\n";

    #[test]
    fn folders_crates_and_modules_are_distinguished() {
        let named = |name: &str, line| Named { name: name.into(), line };
        let map = read(PAGE);
        assert_eq!(map.folders, [named("crates", 7)]);
        let one = CrateMap { line: 8, modules: vec![named("step", 10), named("ids", 11)] };
        assert_eq!(map.crates, BTreeMap::from([("crates/one".to_owned(), one)]));
    }
}
