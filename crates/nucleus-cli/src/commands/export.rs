//! `nucleus export`: converts a cache to formats of other tools.

use std::path::PathBuf;

use anyhow::{Context, Result, anyhow, bail, ensure};
use clap::Args;
use clap::builder::PossibleValue;
use nucleus_cache::{Playback, atomic_file, shell_word};
use nucleus_interop::{Format, Request, Selection, export};
use nucleus_maya::{maya_ascii, value_files};

use crate::object_names;
use crate::options::{self, FrameRange};
use crate::process::Outcome;
use crate::progress::ShareProgress;
use crate::{figures, files, output};

/// Converts a cache to formats of other tools, or a scene to Maya ASCII.
///
/// A scene (.ron) becomes a Maya scene (.ma), wired as Maya's own commands do. Attributes that Maya does not have become
/// added attributes, so that `nucleus import` gives the same scene again. All other options are for caches. Lengths stay in scene units, except in glb and foxglove, whose specifications demand metres; usda states its units.
/// Blender assumes z-up OBJ files: import them with forward Y and up Z to keep the coordinates.
#[derive(Debug, Args)]
pub struct Export {
    /// The cache (.mcap), or a scene (.ron).
    file: PathBuf,
    /// The format; default: by the extension of the output; of a scene, ma.
    #[arg(long = "as", visible_alias = "format", value_name = "FORMAT")]
    format: Option<Wanted>,
    /// The file to write, or the folder for formats of several files; default: the name of the cache.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Frames to export: a count (`48`) or a range (`10..58`); default: all.
    #[arg(long, allow_hyphen_values = true)]
    frames: Option<FrameRange>,
    /// Export every Nth frame.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// Export recorded substeps too.
    #[arg(long)]
    substeps: bool,
    /// Export only this object, by its name or a pattern with `*` and `?`; may be given several times.
    #[arg(long, value_name = "NAME")]
    object: Vec<String>,
    /// Factor for all lengths, to convert them to another unit: 0.01 makes metres of centimetres. The real size is kept, so
    /// the unit that usda and usdc state changes with it; glb and foxglove are always in metres and take none.
    #[arg(long, default_value_t = 1.0, value_parser = options::positive)]
    scale: f64,
    /// Export the surface of liquids as a mesh (obj, ply; ply with velocities, if they were recorded); of all particles where
    /// none are a liquid.
    #[arg(long)]
    surface: bool,
    /// Replace existing files.
    #[arg(long)]
    force: bool,
}

/// A format as an option value: one of caches, or `None` for Maya ASCII.
#[derive(Debug, Clone, Copy)]
struct Wanted(Option<Format>);

impl clap::ValueEnum for Wanted {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [Wanted; Format::ALL.len() + 1] = {
            let mut all = [Wanted(None); Format::ALL.len() + 1];
            let mut k = 0;
            while k < Format::ALL.len() {
                all[k] = Wanted(Some(Format::ALL[k]));
                k += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let Some(format) = self.0 else {
            return Some(PossibleValue::new("ma").help("a scene as Maya ASCII"));
        };
        let help = match format {
            Format::Obj => "Wavefront OBJ, a file per object and frame: UVs, groups, materials",
            Format::Ply => "binary PLY, a file per object and frame: UVs, velocities, particle numbers",
            Format::Pc2 => "point caches of 3ds Max and Blender, with their meshes",
            Format::Mdd => "point caches of LightWave, Modo and Houdini, with their meshes",
            Format::Usda => {
                "USD with time samples as text, one file: meshes, UVs, normals, groups, materials, cameras"
            }
            Format::Usdc => "the same as binary, for Maya, Houdini and Blender",
            Format::Glb => "glTF with morph targets, one file: UVs, normals, materials, cameras",
            Format::Vtu => {
                "VTK and ParaView, a file per object and frame: UVs without seams, velocities, particle numbers"
            }
            Format::Mc => "Maya nCache, 32 bit",
            Format::Mcx => "Maya nCache, 64 bit",
            Format::Foxglove => "MCAP for Foxglove, Lichtblick and rerun",
        };
        Some(PossibleValue::new(format.name()).help(help))
    }
}

impl Export {
    /// Writes the files.
    pub fn run(self) -> Result<Outcome> {
        if self.is_scene() {
            return self.write_scene();
        }
        let mut cache = files::open_cache_and_warn(&self.file)?;
        let (format, out) = self.target()?;
        files::refuse_own_input(&self.file, &out)?;
        self.check_options(&cache)?;
        let frames = self.frames.map(|frames| files::frames_of(frames, &cache, &self.file));
        let mut objects: Vec<String> = Vec::new();
        for pattern in &self.object {
            let found = object_names::matching(&cache, "--object", pattern)?;
            objects.extend(found.into_iter().filter(|name| !objects.contains(name)).collect::<Vec<_>>());
        }
        let selection = Selection {
            objects,
            frames: frames.transpose()?,
            every: self.every,
            substeps: self.substeps,
            scale: self.scale,
            surface: self.surface,
        };
        let request = Request { format, out: out.clone(), selection, force: self.force };
        let mut progress = ShareProgress::new("exporting");
        let is_new = !out.exists();
        let exported = export(&mut cache, &request, &mut |share| progress.show(share));
        progress.end();
        if exported.is_err() && is_new {
            // Only a folder without files can be removed so.
            let _ = std::fs::remove_dir(&out);
        }
        let exported = exported.map_err(|error| files::with_remedy(error.into(), &self.file, "--frames"))?;
        let sizes = exported.files.iter().map(|file| Ok(std::fs::metadata(file)?.len()));
        let bytes: u64 = sizes.sum::<std::io::Result<u64>>()?;
        output::report(&format!(
            "{} of {} as {} in `{}` ({}, {})\n",
            figures::count(exported.samples, "sample"),
            figures::count(exported.objects, "object"),
            format.name(),
            out.display(),
            figures::count(exported.files.len(), "file"),
            figures::bytes(bytes),
        ));
        Ok(Outcome::Success)
    }

    /// Refuses options that would have no effect on a cache.
    fn check_options(&self, cache: &Playback) -> Result<()> {
        ensure!(
            !self.substeps || cache.time_samples().iter().any(|sample| sample.substeps > 1),
            "the cache holds no substeps; `nucleus run --record substeps` records them"
        );
        ensure!(
            !self.surface || files::has_particles(cache),
            "`--surface` is for particles, and the cache has none"
        );
        Ok(())
    }

    /// Refuses options that have no effect on a scene.
    fn check_scene_options(&self) -> Result<()> {
        let of_caches = [
            (self.frames.is_some(), "--frames"),
            (self.every != 1, "--every"),
            (self.substeps, "--substeps"),
            (!self.object.is_empty(), "--object"),
            (self.scale != 1.0, "--scale"),
            (self.surface, "--surface"),
        ];
        match of_caches.iter().find(|(is_given, _)| *is_given) {
            Some((_, option)) => bail!("`{option}` is for caches, and `{}` is a scene", self.file.display()),
            None => Ok(()),
        }
    }

    /// Whether the file is a scene, by its name.
    fn is_scene(&self) -> bool {
        self.file.extension().is_some_and(|end| end.eq_ignore_ascii_case("ron"))
    }

    /// Writes a scene as Maya ASCII.
    fn write_scene(self) -> Result<Outcome> {
        if let Some(Wanted(Some(format))) = self.format {
            bail!("`{}` is a scene; {} is a format of caches", self.file.display(), format.name());
        }
        self.check_scene_options()?;
        let is_ascii = |out: &PathBuf| out.extension().is_some_and(|end| end.eq_ignore_ascii_case("ma"));
        if let Some(out) = self.out.as_ref().filter(|out| !is_ascii(out)) {
            let named = out.with_extension("ma");
            bail!(
                "a scene is written as Maya ASCII, which Maya opens as .ma: write `-o {}`",
                named.display()
            );
        }
        let Some((mut scene, ..)) = files::open_scene(&self.file, None)?.report()? else {
            return Ok(Outcome::InvalidInput);
        };
        let stem = self.file.file_stem().context("the scene has no name")?.to_string_lossy().into_owned();
        let out = self.out.unwrap_or_else(|| PathBuf::from(format!("{stem}.ma")));
        files::refuse_own_input(&self.file, &out)?;
        if out.exists() && (!self.force || out.is_dir()) {
            bail!("`{}` exists; replace it with `--force`", out.display());
        }
        value_files::follow(&mut scene.graph, &value_files::Move::between(&self.file, &out));
        let (text, omissions) = maya_ascii(&scene, &stem).map_err(|message| anyhow!(message))?;
        atomic_file::write(&out, text.as_bytes())
            .with_context(|| format!("cannot write `{}`", out.display()))?;
        for line in omissions.to_string().lines() {
            output::report(&format!("left out or changed: {line}\n"));
        }
        let nodes = figures::count(scene.graph.iter().count() - 1, "node");
        output::report(&format!("{nodes} as Maya ASCII in `{}`\n", out.display()));
        Ok(Outcome::Success)
    }

    /// The format and the path of the output.
    fn target(&self) -> Result<(Format, PathBuf)> {
        let named = self.out.as_deref().and_then(Format::of_path);
        let end = self.out.as_deref().and_then(std::path::Path::extension);
        if self.format.is_none() && end.is_some_and(|end| end.eq_ignore_ascii_case("abc")) {
            bail!(
                "Alembic is not written; `--as usdc` opens in Maya, Houdini and Blender with meshes, motion, UVs and cameras, \
                 `--as mdd` and `--as pc2` are point caches, `--as mcx` is Maya's nCache"
            );
        }
        let Some(format) = self.format.and_then(|wanted| wanted.0).or(named) else {
            let all: Vec<_> = Format::ALL.iter().map(|format| format.name()).collect();
            bail!("the format is unknown; give `--as` one of {}", all.join(", "));
        };
        if let Some((out, other)) =
            self.out.as_ref().zip(named).filter(|(out, other)| differs(*other, format, out))
        {
            bail!(
                "`{}` is the name of a {} file, but `--as` asks for {}: name it `{}`, or leave `--as` out",
                out.display(),
                other.name(),
                format.name(),
                out.with_extension(format.name()).display()
            );
        }
        if let Some(out) =
            self.out.as_ref().filter(|out| format.is_one_file() && Format::of_path(out).is_none())
        {
            let stem = out.file_stem().unwrap_or_default().to_string_lossy();
            let own = out.with_file_name(format.default_name(&stem));
            bail!(
                "`{}` is not the name of a {} file: write `-o {}`",
                out.display(),
                format.name(),
                shell_word(&own)
            );
        }
        let out = match &self.out {
            Some(out) => out.clone(),
            None => {
                let stem = self.file.file_stem().context("the cache has no name")?;
                PathBuf::from(format.default_name(&stem.to_string_lossy()))
            }
        };
        Ok((format, out))
    }
}

/// Whether a file name that implies the format `named` is wrong for `format`.
fn differs(named: Format, format: Format, out: &std::path::Path) -> bool {
    // Both kinds of USD and of nCache share an extension.
    let is_shared = out.extension().is_some_and(|end| {
        let is_usd = end.eq_ignore_ascii_case("usd") && matches!(format, Format::Usda | Format::Usdc);
        is_usd || (end.eq_ignore_ascii_case("xml") && matches!(format, Format::Mc | Format::Mcx))
    });
    named != format && !is_shared
}
