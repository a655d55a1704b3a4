//! `nucleus import`: makes a scene of a Maya scene.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use clap::Args;
use nucleus_cache::atomic_file;
use nucleus_graph::attributes::nucleus;
use nucleus_maya::{ImportOptions, Imported, import_scene, is_maya_scene};

use crate::process::Outcome;
use crate::{figures, files, output};

/// Makes a scene of a Maya scene (.ma). Meshes become OBJ files in a folder beside the scene.
///
/// Nothing in the file is executed. What is left out is listed with its reason and its effect on the result, here and as
/// comments in the scene. Resistances keep Maya's meaning (`resistanceModel: classic`) unless `--physical` is given.
#[derive(Debug, Args)]
pub struct Import {
    /// The Maya scene (.ma).
    file: PathBuf,
    /// The scene to write; default: the name of the Maya scene with `.ron`.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Take a mesh from an OBJ file: `--mesh curtain=curtain.obj`; may be given several times.
    #[arg(long, value_name = "NAME=FILE", value_parser = mesh)]
    mesh: Vec<(String, PathBuf)>,
    /// Read resistances as stiffnesses that depend on neither mesh nor substeps.
    #[arg(long)]
    physical: bool,
    /// Replace existing files.
    #[arg(long)]
    force: bool,
}

/// `curtain=curtain.obj`
fn mesh(text: &str) -> Result<(String, PathBuf), String> {
    let (name, file) =
        text.split_once('=').ok_or("expected the name of a mesh and a file: `curtain=curtain.obj`")?;
    Ok((name.to_owned(), PathBuf::from(file)))
}

impl Import {
    /// Writes the scene and its meshes.
    pub fn run(self) -> Result<Outcome> {
        let out = match &self.out {
            Some(out) => out.clone(),
            None => beside(&self.file)?,
        };
        let how = How { meshes: self.mesh, physical: self.physical, force: self.force };
        let imported = import(&self.file, &out, how)?;
        let solvers = imported.scene.graph.of_type(&nucleus::NUCLEUS).count();
        if solvers == 0 {
            output::report("the scene has no nucleus, so there is nothing to simulate\n");
            return Ok(Outcome::Success);
        }
        let read = files::open_scene(&out, None)?.report()?;
        Ok(if read.is_some() { Outcome::Success } else { Outcome::Problem })
    }
}

/// The scene of a Maya scene in the working folder.
fn beside(file: &Path) -> Result<PathBuf> {
    let stem = file.file_stem().context("the scene has no name")?;
    Ok(Path::new(stem).with_extension("ron"))
}

/// Options of an import.
pub struct How {
    /// Meshes that the artist gives.
    pub meshes: Vec<(String, PathBuf)>,
    /// Whether resistances are stiffnesses.
    pub physical: bool,
    /// Whether other files may be replaced.
    pub force: bool,
}

/// Imports a Maya scene to `out`, and reports what is left out.
///
/// # Errors
/// When it cannot be read, or a file exists that is not to be replaced.
pub fn import(file: &Path, out: &Path, how: How) -> Result<Imported> {
    let stem = out.file_stem().context("the scene has no name")?.to_string_lossy().into_owned();
    let folder = out.parent().unwrap_or(Path::new("")).to_owned();
    let (mut meshes, force) = (0, how.force);
    let mut options = ImportOptions::new(&format!("{stem}_meshes"), |name, text| {
        meshes += 1;
        write(&folder.join(name), &text, force).map_err(|error| format!("{error:#}"))
    });
    options.meshes = how.meshes;
    options.physical = how.physical;
    let imported = import_scene(file, out, &mut options)?;
    drop(options);
    let origin = file.file_name().unwrap_or_default().to_string_lossy();
    write(out, &imported.text(&origin), how.force)?;
    for line in imported.omissions.to_string().lines() {
        output::report(&format!("left out or changed: {line}\n"));
    }
    output::report(&format!(
        "`{}`: {}, {}, {}\n",
        out.display(),
        figures::count(imported.scene.graph.iter().count() - 1, "node"),
        figures::count(meshes, "mesh file"),
        figures::count(imported.omissions.len(), "omission"),
    ));
    Ok(imported)
}

/// Writes a file, unless there is one with another content that is not to be replaced.
fn write(path: &Path, text: &str, force: bool) -> Result<()> {
    match std::fs::read(path) {
        Ok(old) if old == text.as_bytes() => return Ok(()),
        Ok(_) if !force => {
            bail!("`{}` exists, with other content; replace it with `--force`", path.display())
        }
        Err(_) if path.exists() => bail!("`{}` is no file that can be replaced", path.display()),
        _ => {}
    }
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder)
            .with_context(|| format!("cannot make the folder `{}`", folder.display()))?;
    }
    atomic_file::write(path, text.as_bytes())
        .map_err(|error| anyhow!("cannot write `{}`: {error}", path.display()))
}

/// A scene of ours for a path that may be a Maya scene: then it is imported beside `cache`.
///
/// # Errors
/// As [`import`].
pub fn own_scene(scene: PathBuf, cache: &Path, force: bool) -> Result<PathBuf> {
    if !is_maya_scene(&scene) {
        return Ok(scene);
    }
    let out = cache.with_extension("ron");
    import(&scene, &out, How { meshes: Vec::new(), physical: false, force })?;
    Ok(out)
}
