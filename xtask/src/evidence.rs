//! The tests and scenes that cover each claim of the paper.
//!
//! `docs/claims.md` numbers the claims. A test carries, in the comment above it, the word EVIDENCE, a colon
//! and one or more numbers, then a description; a scene carries the same in a comment on its own line.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;

use anyhow::Context;

use crate::files;

/// A claim of the paper.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Claim {
    /// Its number: `N2.4-11`.
    pub id: String,
    /// The claim.
    pub text: String,
}

/// A tag that covers a claim.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Evidence {
    /// The claim's number.
    pub claim: String,
    /// File and line.
    pub place: String,
    /// Name of the test or the scene; empty if no test follows the comment.
    pub name: String,
}

/// Prints every claim with its tests and scenes, then the claims without any.
pub fn print(root: &Path) -> anyhow::Result<()> {
    let claims = claims(root).context("docs/claims.md")?;
    let mut shown: BTreeMap<String, Vec<Evidence>> = BTreeMap::new();
    for evidence in evidence(root)? {
        shown.entry(evidence.claim.clone()).or_default().push(evidence);
    }
    let (with, without): (Vec<_>, Vec<_>) = claims.iter().partition(|claim| shown.contains_key(&claim.id));
    for claim in &with {
        println!("{:<8} {}", claim.id, claim.text);
        shown[&claim.id]
            .iter()
            .for_each(|evidence| println!("         {}  {}", evidence.place, evidence.name));
    }
    println!("\n{} of {} claims are covered; these {} are not:", with.len(), claims.len(), without.len());
    without.iter().for_each(|claim| println!("{:<8} {}", claim.id, claim.text));
    for (id, evidence) in shown.iter().filter(|(id, _)| !claims.iter().any(|claim| claim.id == **id)) {
        println!("{}: there is no claim {id}", evidence[0].place);
    }
    Ok(())
}

/// All claims, in the order of the page.
pub fn claims(root: &Path) -> io::Result<Vec<Claim>> {
    let page = fs::read_to_string(root.join("docs/claims.md"))?;
    let claim = |line: &str| {
        let (id, text) = line.strip_prefix("- **")?.split_once("** ")?;
        Some(Claim { id: id.to_owned(), text: text.to_owned() })
    };
    Ok(page.lines().filter_map(claim).collect())
}

/// All tags of tests and scenes, in order of file and line.
pub fn evidence(root: &Path) -> io::Result<Vec<Evidence>> {
    let mut all = Vec::new();
    for folder in ["crates", "tests", "scenes"] {
        for path in files::below(&root.join(folder))? {
            if path.extension().is_some_and(|end| end == "rs" || end == "ron") {
                all.extend(evidence_in(&files::name(root, &path), &fs::read_to_string(&path)?));
            }
        }
    }
    Ok(all)
}

fn evidence_in(file: &str, text: &str) -> Vec<Evidence> {
    let lines: Vec<_> = text.lines().collect();
    let mut found = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        // A tag within a line is data of a test.
        let Some(tag) = line.trim_start().strip_prefix("// EVIDENCE:") else { continue };
        let name = match file.ends_with(".rs") {
            true => test_below(&lines[index..]).unwrap_or_default(),
            false => scene_name(file),
        };
        for claim in tag.split([' ', ',']).filter(|word| !word.is_empty()).take_while(|word| is_id(word)) {
            let place = format!("{file}:{}", index + 1);
            found.push(Evidence { claim: claim.to_owned(), place, name: name.clone() });
        }
    }
    found
}

/// `N2.4-11`: a letter, a section, a number within it.
fn is_id(word: &str) -> bool {
    let parts = word.strip_prefix('N').and_then(|rest| rest.split_once('-'));
    let numbers = |part: &str| part.split('.').all(|part| part.parse::<u32>().is_ok());
    parts.is_some_and(|(section, number)| numbers(section) && numbers(number))
}

/// The function below a comment, with only comments and attributes between.
fn test_below(lines: &[&str]) -> Option<String> {
    let mut code = lines.iter().map(|line| line.trim_start());
    let first = code.find(|line| !line.starts_with("//") && !line.starts_with('#'))?;
    let name = first.trim_start_matches("pub ").strip_prefix("fn ")?;
    Some(name.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default().to_owned())
}

/// Name of a scene: `cloth/drape`.
fn scene_name(file: &str) -> String {
    file.trim_start_matches("scenes/").trim_end_matches(".ron").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TAG: &str = concat!("// EVIDENCE", ":");

    #[test]
    fn a_tag_belongs_to_the_test_below_it_and_may_name_several_claims() {
        let text =
            format!("{TAG} N2.4-3, N1.1-4  both at once\n// more\n#[test]\nfn links_are_lists() {{}}\n");
        let found = evidence_in("tests/paper.rs", &text);
        let one = |claim: &str| Evidence {
            claim: claim.into(),
            place: "tests/paper.rs:1".into(),
            name: "links_are_lists".into(),
        };
        assert_eq!(found, [one("N2.4-3"), one("N1.1-4")]);
    }

    #[test]
    fn a_tag_in_a_scene_belongs_to_the_scene() {
        let found = evidence_in("scenes/cloth/flag.ron", &format!("Scene(\n    {TAG} N1.2-2\n)"));
        assert_eq!(
            (found[0].name.as_str(), found[0].place.as_str()),
            ("cloth/flag", "scenes/cloth/flag.ron:2")
        );
    }

    #[test]
    fn a_tag_in_a_string_of_a_test_is_ignored() {
        let text = format!("    let text = r#\"{TAG} N1.2-2  a flag\n\"#;\n#[test]\nfn next() {{}}\n");
        assert_eq!(evidence_in("tests/paper.rs", &text), []);
    }

    #[test]
    fn a_tag_that_is_not_directly_above_a_test_has_no_name() {
        let text = format!("{TAG} N1.2-2  a flag\nconst FLAG: u32 = 1;\n#[test]\nfn next() {{}}\n");
        assert_eq!(evidence_in("tests/paper.rs", &text)[0].name, "");
    }

    #[test]
    fn every_tag_names_an_existing_claim_and_is_directly_above_a_test() {
        let root = files::root();
        let claims = claims(&root).unwrap();
        for evidence in evidence(&root).unwrap() {
            assert!(!evidence.name.is_empty(), "{evidence:?}");
            assert!(claims.iter().any(|claim| claim.id == evidence.claim), "{evidence:?}");
        }
    }

    #[test]
    fn claim_numbers_are_unique_and_consecutive() {
        let mut last = ("".to_owned(), 0);
        for claim in claims(&files::root()).unwrap() {
            let (section, number) = claim.id.split_once('-').unwrap();
            let expected = if section == last.0 { last.1 + 1 } else { 1 };
            assert_eq!(number, expected.to_string(), "{}", claim.id);
            last = (section.to_owned(), expected);
        }
        assert!(last.1 > 0);
    }
}
