//! `docs/cookbook.md`: the scenes of `scenes/cookbook`, each with its text and its picture.

use std::ffi::{OsStr, OsString};
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

/// A scene whose first comment has a title, an explanation and, in lines that begin with `$`, the commands of the recipe.
struct Recipe {
    name: String,
    title: String,
    explanation: Vec<String>,
    /// Arguments of `nucleus`. The last command draws the picture.
    commands: Vec<String>,
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
        let (commands, explanation): (Vec<&str>, Vec<&str>) =
            comment.iter().skip(1).partition(|line| line.starts_with("$ "));
        let mut commands: Vec<String> =
            commands.iter().map(|line| line.trim_start_matches("$ nucleus ").to_owned()).collect();
        if commands.is_empty() {
            commands = vec![format!("run scenes/cookbook/{name}.ron"), format!("render {name}.mcap")];
        }
        let explanation = explanation.into_iter().map(str::to_owned).collect();
        Self { name, title, explanation, commands, scene }
    }

    /// The arguments of a command in a folder of caches: scenes by their full paths, and files that exist are replaced.
    fn arguments(&self, root: &Path, command: &str, picture: &Path) -> Vec<OsString> {
        let word = |word: &str| match word.starts_with("scenes/") {
            true => root.join(word).into_os_string(),
            false => word.into(),
        };
        let mut arguments: Vec<OsString> = command.split(' ').map(word).collect();
        match command.starts_with("render ") {
            true => {
                let more = ["--size".as_ref(), "480x300".as_ref(), "-o".as_ref(), picture.as_os_str()];
                arguments.extend(more.map(OsStr::to_owned));
            }
            false => arguments.push("--force".into()),
        }
        arguments
    }
}

/// The page.
pub fn page(root: &Path) -> io::Result<String> {
    let mut page = HEAD.to_owned();
    for Recipe { name, title, explanation, commands, scene } in recipes(root)? {
        let explanation = explanation.join("\n");
        let commands: String = commands.iter().map(|command| format!("nucleus {command}\n")).collect();
        // Writing to a string cannot fail.
        let _ = write!(
            page,
            "\n## {title}\n\n{explanation}\n\n![{title}](pictures/cookbook/{name}.png)\n\n\
             [`scenes/cookbook/{name}.ron`](../scenes/cookbook/{name}.ron)\n\n```ron\n{scene}\n```\n\n\
             ```sh\n{commands}```\n"
        );
    }
    Ok(page)
}

/// Runs the commands of every recipe, and writes the page. `nucleus` runs the command in a folder with arguments.
pub fn write(
    root: &Path,
    nucleus: impl Fn(&Path, &[OsString]) -> anyhow::Result<bool>,
) -> anyhow::Result<()> {
    let pictures = root.join("docs").join("pictures").join("cookbook");
    fs::create_dir_all(&pictures)?;
    let caches = crate::files::target(root).join("cookbook");
    fs::create_dir_all(&caches)?;
    for recipe in recipes(root)? {
        let picture = pictures.join(&recipe.name).with_extension("png");
        for command in &recipe.commands {
            let arguments = recipe.arguments(root, command, &picture);
            ensure!(nucleus(&caches, &arguments)?, "`{}`: `nucleus {command}` fails", recipe.name);
        }
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
        assert!(recipes.len() >= 18, "eighteen recipes");
        for Recipe { name, title, explanation, commands, scene } in recipes {
            assert!(commands.last().is_some_and(|command| command.starts_with("render ")), "{name}");
            assert!(root.join(format!("docs/pictures/cookbook/{name}.png")).is_file(), "{name}");
            assert!(title != name && !explanation.is_empty() && scene.contains("checks:"), "{name}");
        }
    }
}
