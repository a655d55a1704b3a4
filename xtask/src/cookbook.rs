//! `docs/cookbook.md`: the scenes of `scenes/cookbook`, each with its text and its picture.

use std::ffi::OsStr;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{fs, io};

use anyhow::{Context, ensure};
use nucleus_measure::result_cache;

const HEAD: &str = "\
# Cookbook

Recipes to copy from: each is a scene that runs as it stands, with the picture that its last commands draw.
The gallery tests compile every recipe, and `cargo xtask ci` runs them with their checks; `cargo xtask book --only cookbook` runs them, draws the pictures and writes this page.
The grammar of scenes is in [`scene.md`](scene.md).
";

/// A scene whose first comment has a title and an explanation.
struct Recipe {
    name: String,
    title: String,
    explanation: Vec<String>,
    scene: String,
}

/// The recipes in the order of their names.
fn recipes(root: &Path) -> io::Result<Vec<Recipe>> {
    let mut files: Vec<PathBuf> =
        fs::read_dir(folder(root))?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    files.retain(|file| file.extension().is_some_and(|end| end == "ron"));
    files.sort();
    files.iter().map(|file| Ok(Recipe::of(file, &fs::read_to_string(file)?))).collect()
}

fn folder(root: &Path) -> PathBuf {
    root.join("scenes").join("cookbook")
}

impl Recipe {
    fn of(file: &Path, text: &str) -> Self {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let comment: Vec<&str> = text.lines().map_while(|line| line.strip_prefix("// ")).collect();
        let scene = text.lines().skip(comment.len()).collect::<Vec<_>>().join("\n");
        let title = comment.first().and_then(|line| line.strip_prefix("# ")).unwrap_or(&name).to_owned();
        let explanation = comment.iter().skip(1).map(|line| (*line).to_owned()).collect();
        Self { name, title, explanation, scene }
    }
}

/// The page.
pub fn page(root: &Path) -> io::Result<String> {
    let mut page = HEAD.to_owned();
    for Recipe { name, title, explanation, scene } in recipes(root)? {
        let explanation = explanation.join("\n");
        // Writing to a string cannot fail.
        let _ = write!(
            page,
            "\n## {title}\n\n{explanation}\n\n![{title}](pictures/cookbook/{name}.png)\n\n\
             [`scenes/cookbook/{name}.ron`](../scenes/cookbook/{name}.ron)\n\n```ron\n{scene}\n```\n\n\
             ```sh\nnucleus run scenes/cookbook/{name}.ron\nnucleus render {name}.mcap\n```\n"
        );
    }
    Ok(page)
}

/// Runs every recipe, draws its last frame, and writes the page. `nucleus` runs the command with arguments.
pub fn write(root: &Path, nucleus: impl Fn(&[&OsStr]) -> anyhow::Result<bool>) -> anyhow::Result<()> {
    let pictures = root.join("docs").join("pictures").join("cookbook");
    fs::create_dir_all(&pictures)?;
    let caches = crate::files::target(root).join("cookbook");
    fs::create_dir_all(&caches)?;
    for Recipe { name, .. } in recipes(root)? {
        let scene = folder(root).join(&name).with_extension("ron");
        let [cache, picture] =
            [caches.join(&name).with_extension("mcap"), pictures.join(&name).with_extension("png")];
        let run: [&OsStr; 5] =
            ["run".as_ref(), scene.as_ref(), "--force".as_ref(), "-o".as_ref(), cache.as_ref()];
        ensure!(nucleus(&run)?, "`{name}` does not pass its checks");
        let size = "480x300".as_ref();
        let draw: [&OsStr; 6] =
            ["render".as_ref(), cache.as_ref(), "--size".as_ref(), size, "-o".as_ref(), picture.as_ref()];
        ensure!(nucleus(&draw)?, "`{name}` cannot be drawn");
    }
    let page = page(root).context("the recipes cannot be read")?;
    Ok(result_cache::write_atomic(&root.join("docs").join("cookbook.md"), page.as_bytes())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_shows_the_recipes_as_they_are_and_each_has_a_picture() {
        let root = crate::files::root();
        assert_eq!(fs::read_to_string(root.join("docs/cookbook.md")).unwrap(), page(&root).unwrap());
        let recipes = recipes(&root).unwrap();
        assert!(recipes.len() >= 12, "twelve recipes");
        for Recipe { name, title, explanation, scene } in recipes {
            assert!(root.join(format!("docs/pictures/cookbook/{name}.png")).is_file(), "{name}");
            assert!(title != name && !explanation.is_empty() && scene.contains("checks:"), "{name}");
        }
    }
}
