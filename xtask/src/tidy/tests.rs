//! Trees made for the purpose, and this repository.

use super::*;
use tempfile::TempDir;

const PAGE: &str = "## Code map\n| `crates/` | one |\n| `docs/` | words |\n### `crates/one`\n| `step` | a frame |\n| `graph` | nodes |\n";

/// A repository of one crate with two modules, as [`PAGE`] has it, and more files.
fn tree(page: &str, more: &[(&str, &str)]) -> TempDir {
    let root = tempfile::tempdir().unwrap();
    let files = [
        ("ARCHITECTURE.md", page),
        ("docs/book.md", "# Book\n"),
        ("target/debug/junk.rs", "junk"),
        ("crates/one/Cargo.toml", "[package]\n"),
        ("crates/one/src/lib.rs", "#![forbid(unsafe_code)]\nmod step;\n"),
        ("crates/one/src/step.rs", "\n"),
        ("crates/one/src/graph/mod.rs", "\n"),
        ("crates/one/src/graph/node.rs", "\n"),
        ("crates/one/src/tests.rs", "\n"),
    ];
    for (name, text) in files.iter().chain(more) {
        let path = root.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    root
}

fn found(page: &str, more: &[(&str, &str)]) -> Vec<String> {
    problems(tree(page, more).path()).unwrap()
}

#[test]
fn a_map_that_fits_its_tree_is_tidy() {
    assert_eq!(found(PAGE, &[]), [""; 0]);
}

#[test]
fn a_crate_that_allows_unsafe_code_is_found() {
    let page = PAGE.replace("### `crates/one`", "### `crates/nucleus-core`\n### `crates/one`");
    let core = [("crates/nucleus-core/Cargo.toml", ""), ("crates/nucleus-core/src/lib.rs", "")];
    let open = ("crates/one/src/main.rs", "#![deny(unsafe_code)]\nfn main() {}\n");
    assert_eq!(
        found(&page, &[core[0], core[1], open]),
        [
            "crates/one/src/main.rs: `#![forbid(unsafe_code)]` is missing; unsafe code is in crates/nucleus-core alone"
        ]
    );
}

#[test]
fn a_module_that_the_map_does_not_name_is_found() {
    let more = [("crates/two/Cargo.toml", ""), ("crates/one/src/new.rs", ""), ("scenes/a.ron", "")];
    assert_eq!(
        found(PAGE, &more),
        [
            "ARCHITECTURE.md: the folder `scenes` is not named",
            "ARCHITECTURE.md: the crate `crates/two` is not named",
            "ARCHITECTURE.md: the module `crates/one/src/new` is not named",
        ]
    );
}

#[test]
fn a_named_module_that_does_not_exist_is_found() {
    let page = format!("{PAGE}| `step` | again |\n| `old` | gone |\n### `crates/gone`\n");
    assert_eq!(
        found(&page, &[]),
        [
            "ARCHITECTURE.md:9: there is no crate `crates/gone`",
            "ARCHITECTURE.md:7: the module `crates/one/src/step` is named twice",
            "ARCHITECTURE.md:8: there is no module `crates/one/src/old`",
        ]
    );
}

#[test]
fn long_files_are_found_unless_they_are_tables() {
    let long = "\n".repeat(601);
    let table = format!("{TABLES}nucleus.rs");
    let all = found(PAGE, &[("crates/one/src/step.rs", &long), (&table, &long)]);
    assert!(
        all.contains(&"crates/one/src/step.rs: 601 lines, more than 600; split it by its nouns".to_owned())
    );
    assert!(!all.iter().any(|problem| problem.starts_with(TABLES)), "{all:?}");
}

#[test]
fn paths_of_one_machine_are_found_with_their_line() {
    let path = MACHINE_PATHS[0];
    let text = format!("fine\nsee {path}main\n");
    assert_eq!(
        found(PAGE, &[("docs/notes.md", &text)]),
        [format!("docs/notes.md:2: `{path}` is a path of one machine")]
    );
}

#[test]
fn a_missing_map_is_one_problem() {
    let root = tree(PAGE, &[]);
    fs::remove_file(root.path().join("ARCHITECTURE.md")).unwrap();
    assert_eq!(problems(root.path()).unwrap(), ["ARCHITECTURE.md: there is none"]);
}

#[test]
fn this_repository_is_tidy() {
    assert_eq!(problems(&files::root()).unwrap(), [""; 0]);
}

#[test]
fn an_attribute_that_names_no_module_is_found_at_its_line() {
    let page = format!(
        "{PAGE}### `crates/nucleus-graph`\n| `attributes` | tables |\n### `crates/nucleus-core`\n| `integrate` | drag |\n| `contact` | contact |\n"
    );
    let table = |modules: [&str; 3]| {
        modules.map(|module| format!("X: f64 = float().solved(\"{module}\");\n")).concat()
    };
    let with = |modules| {
        let table = table(modules);
        let more = [
            ("crates/nucleus-graph/Cargo.toml", ""),
            ("crates/nucleus-graph/src/attributes/n_cloth.rs", table.as_str()),
            ("crates/nucleus-core/Cargo.toml", ""),
            ("crates/nucleus-core/src/integrate/aerodynamics.rs", ""),
            ("crates/nucleus-core/src/contact/mod.rs", ""),
            ("crates/nucleus-core/src/contact/response.rs", ""),
        ];
        found(&page, &more)
    };
    let good =
        ["nucleus_core::integrate::aerodynamics", "nucleus_core::contact", "nucleus_core::contact::response"];
    assert_eq!(with(good), [""; 0]);
    for bad in ["nucleus_core::contact::slip", "stick", "nucleus_cora::air"] {
        let problems = with([good[0], bad, good[2]]);
        let place = format!("crates/nucleus-graph/src/attributes/n_cloth.rs:2: `{bad}` is no module");
        assert!(problems.len() == 1 && problems[0].starts_with(&place), "{problems:?}");
        assert!(problems[0].contains("write the path of the module"), "{problems:?}");
    }
}

#[test]
fn a_retired_word_is_found_at_its_line_but_not_inside_another() {
    let [word, longer] = [concat!("bro", "om"), concat!("bro", "omstick")];
    let page = |text: &str| retired_words("docs/page.md", text);
    assert_eq!(page(longer), [""; 0]);
    let problems = page(&format!("a\na {word}."));
    assert!(problems.len() == 1 && problems[0].starts_with("docs/page.md:2: "), "{problems:?}");
    assert_eq!(retired_words("docs/claims.md", word), [""; 0], "the paper keeps its words");
}

#[test]
fn a_test_that_a_page_names_exists() {
    let page = "A row: `a_row_has_its_own_test`, and `serde_json`, `max_iterations_per_step.rs`.\n";
    let test = "#[test]\nfn a_row_has_its_own_test() {}\n";
    assert_eq!(found(PAGE, &[("docs/rows.md", page), ("crates/one/src/tests.rs", test)]), [""; 0]);
    assert_eq!(
        found(PAGE, &[("docs/rows.md", page)]),
        ["docs/rows.md:1: there is no test `a_row_has_its_own_test`"]
    );
}
