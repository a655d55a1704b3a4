//! `nucleus import`: makes a scene of a Maya scene, a preset of a Maya preset, mesh files of an nCache.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use clap::Args;
use nucleus_cache::atomic_file;
use nucleus_core::Surface;
use nucleus_graph::attributes::nucleus;
use nucleus_graph::mesh::read_obj;
use nucleus_maya::ncache::NCache;
use nucleus_maya::{
    ImportOptions, Imported, import_scene, is_maya_scene, preset_text, read_maya_preset, unknown_mesh,
};

use crate::process::Outcome;
use crate::{figures, files, output};

/// Makes a scene of a Maya scene (.ma), a preset of a Maya preset (.mel), or OBJ files of an nCache (.xml).
///
/// The points of an nCache become a file for each object and frame, which a scene can take as a moving mesh
/// (`file: "points/nClothShape1.####.obj"`) or as an initial state (`startPositions: file("points/nClothShape1.0012.obj")`).
/// Their faces come from `--mesh NAME=FILE`, since an nCache has none. Meshes of a scene become OBJ files in a folder
/// beside it.
///
/// Nothing in the file is executed. Omissions are listed with their reason and their effect on the result, here and as
/// comments in the scene. Resistances keep Maya's meaning (`resistanceModel: classic`) unless `--physical` is given.
#[derive(Debug, Args)]
pub struct Import {
    /// The Maya scene (.ma), preset (.mel) or nCache (.xml, .mc, .mcx).
    file: PathBuf,
    /// The scene or preset to write, or the folder of the points; default: the name of the file with `.ron`, or without an
    /// extension.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Take a mesh from an OBJ file: `--mesh curtain=curtain.obj`; may be given several times.
    #[arg(long, value_name = "NAME=FILE", value_parser = mesh)]
    mesh: Vec<(String, PathBuf)>,
    /// Read resistances as stiffnesses that depend on neither mesh nor substeps.
    #[arg(long)]
    physical: bool,
    /// Solve objects that the scene plays from a cache.
    #[arg(long)]
    simulate: bool,
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
        let end = self.file.extension().unwrap_or_default().to_ascii_lowercase();
        match end.to_str() {
            Some("mel") => return self.preset(),
            Some("xml" | "mc" | "mcx") => return self.points(),
            _ => {}
        }
        let out = match &self.out {
            Some(out) => out.clone(),
            None => beside(&self.file)?,
        };
        let Self { mesh: meshes, physical, simulate, force, .. } = self;
        let how = How { meshes, physical, simulate, force };
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

impl Import {
    /// Makes a preset of a Maya preset.
    fn preset(self) -> Result<Outcome> {
        if let Some((name, _)) = self.mesh.first() {
            bail!(unknown_mesh(name, std::iter::empty()));
        }
        let (preset, omissions) = read_maya_preset(&self.file)?;
        let out = match self.out {
            Some(out) => out,
            None => beside(&self.file)?,
        };
        write(&out, &preset_text(&preset), self.force)?;
        for line in omissions.to_string().lines() {
            output::report(&format!("left out or changed: {line}\n"));
        }
        let settings = figures::count(preset.settings.len(), "attribute");
        output::report(&format!("{settings} of {} in `{}`\n", preset.node_type.name, out.display()));
        Ok(Outcome::Success)
    }

    /// Writes the points of an nCache as OBJ files.
    fn points(self) -> Result<Outcome> {
        let cache = NCache::read(&self.file)?;
        if let Some((name, _)) = self.mesh.iter().find(|(name, _)| !cache.objects().contains(&name.as_str()))
        {
            bail!(unknown_mesh(name, cache.objects().into_iter()));
        }
        let stem = self.file.file_stem().context("the cache has no name")?.to_owned();
        let folder = self.out.unwrap_or_else(|| PathBuf::from(stem));
        let mut files = 0;
        for object in cache.objects() {
            let faces = match self.mesh.iter().find(|(name, _)| name == object) {
                Some((_, file)) => Some(read_obj(file)?),
                None => None,
            };
            // A channel is no path.
            let name: String =
                object.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
            for sample in cache.samples.iter().filter(|sample| sample.frame.fract() == 0.0) {
                let Some(points) = cache.positions(object, sample.frame) else { continue };
                let text = obj(points, faces.as_ref())
                    .with_context(|| format!("`{object}` at frame {}", sample.frame))?;
                write(&folder.join(format!("{name}.{:04}.obj", sample.frame as i64)), &text, self.force)?;
                files += 1;
            }
        }
        output::report(&format!(
            "{} of {} in `{}`\n",
            figures::count(files, "file"),
            figures::count(cache.objects().len(), "object"),
            folder.display()
        ));
        Ok(if files > 0 { Outcome::Success } else { Outcome::Problem })
    }
}

/// Points with the faces of a mesh as an OBJ file.
fn obj(points: &[[f64; 3]], mesh: Option<&Surface>) -> Result<String> {
    let mut text = String::new();
    for [x, y, z] in points {
        writeln!(text, "v {x} {y} {z}")?;
    }
    let Some(mesh) = mesh else { return Ok(text) };
    if mesh.positions.len() != points.len() {
        bail!("the cache has {} points, the mesh {}", points.len(), mesh.positions.len());
    }
    for face in mesh.faces.iter() {
        text.push('f');
        face.iter().try_for_each(|point| write!(text, " {}", point + 1))?;
        text.push('\n');
    }
    Ok(text)
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
    /// Whether objects that the scene plays from a cache are solved.
    pub simulate: bool,
    /// Whether other files may be replaced.
    pub force: bool,
}

/// Imports a Maya scene to `out`, and reports the omissions.
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
    options.simulate = how.simulate;
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
    files::make_folder_of(path)?;
    atomic_file::write(path, text.as_bytes())
        .map_err(|error| anyhow!("cannot write `{}`: {error}", path.display()))
}

/// A Nucleus scene for a path that may be a Maya scene: then it is imported beside `cache`.
///
/// # Errors
/// As [`import`].
pub fn own_scene(scene: PathBuf, cache: &Path, force: bool) -> Result<PathBuf> {
    if !is_maya_scene(&scene) {
        return Ok(scene);
    }
    let out = cache.with_extension("ron");
    import(&scene, &out, How { meshes: Vec::new(), physical: false, simulate: false, force })?;
    Ok(out)
}
