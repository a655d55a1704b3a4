//! `nucleus export`: a cache as files of other tools.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::Args;
use clap::builder::PossibleValue;
use nucleus_interop::{Format, Request, Selection, export};

use crate::frame_range::FrameRange;
use crate::outcome::Outcome;
use crate::progress::Steps;
use crate::{cache_file, figures, output};

/// Writes a cache as files of other tools.
///
/// Lengths stay in the units of the scene, except in glb and foxglove, which are in metres by their rules; usda
/// states its units. Blender takes OBJ files for z-up: import them with forward Y and up Z to keep coordinates.
#[derive(Debug, Args)]
pub struct Export {
    /// The cache (.mcap).
    file: PathBuf,
    /// The format; taken from the name of the output if not given.
    #[arg(long = "as", value_name = "FORMAT")]
    format: Option<Wanted>,
    /// The file to write, or the folder for formats of many files; named after the cache if not given.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Frames to export: so many (`48`) or from one to another (`10..58`).
    #[arg(long, allow_hyphen_values = true)]
    frames: Option<FrameRange>,
    /// Export only every so many frames.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// Export substeps too, where they were recorded.
    #[arg(long)]
    substeps: bool,
    /// Export only this object; can be given several times.
    #[arg(long, value_name = "NAME")]
    object: Vec<String>,
    /// Factor on all lengths.
    #[arg(long, default_value_t = 1.0, value_parser = parse_scale)]
    scale: f64,
    /// Replace files that exist.
    #[arg(long)]
    force: bool,
}

/// A format, as clap knows it.
#[derive(Debug, Clone, Copy)]
struct Wanted(Format);

impl clap::ValueEnum for Wanted {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [Wanted; Format::ALL.len()] = {
            let mut all = [Wanted(Format::Obj); Format::ALL.len()];
            let mut k = 0;
            while k < all.len() {
                all[k] = Wanted(Format::ALL[k]);
                k += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let what = match self.0 {
            Format::Obj => "Wavefront OBJ, a file per object and frame",
            Format::Ply => "binary PLY, a file per object and frame",
            Format::Pc2 => "point caches of 3ds Max and Blender, with their meshes",
            Format::Mdd => "point caches of LightWave, Modo and Houdini, with their meshes",
            Format::Usda => "USD with time samples, one file",
            Format::Glb => "glTF with morph targets, one file",
            Format::Vtu => "VTK and ParaView, a file per object and frame",
            Format::Mc => "Maya nCache, 32 bit",
            Format::Mcx => "Maya nCache, 64 bit",
            Format::Foxglove => "MCAP for Foxglove, Lichtblick and rerun",
        };
        Some(PossibleValue::new(self.0.name()).help(what))
    }
}

impl Export {
    /// Writes it.
    pub fn run(self) -> Result<Outcome> {
        let mut cache = cache_file::open_and_warn(&self.file)?;
        let (format, out) = self.target()?;
        let start = cache.time_samples().first().context("the cache holds no frame")?.frame;
        let frames = self.frames.map(|frames| frames.within(start).context("there are not so many frames"));
        let selection = Selection {
            objects: self.object.clone(),
            frames: frames.transpose()?,
            every: self.every,
            substeps: self.substeps,
            scale: self.scale,
        };
        let request = Request { format, out: out.clone(), selection, force: self.force };
        let mut steps = Steps::new("exporting");
        let exported = export(&mut cache, &request, &mut |share| steps.show(share));
        steps.end();
        let exported = exported?;
        let sizes = exported.files.iter().map(|file| Ok(std::fs::metadata(file)?.len()));
        let bytes: u64 = sizes.sum::<std::io::Result<u64>>()?;
        output::tell(&format!(
            "{} of {} as {} in `{}` ({}, {})\n",
            figures::count(exported.samples, "sample"),
            figures::count(exported.objects, "object"),
            format.name(),
            out.display(),
            figures::count(exported.files.len(), "file"),
            figures::bytes(bytes),
        ));
        Ok(Outcome::Fine)
    }

    /// The format, and where it goes.
    fn target(&self) -> Result<(Format, PathBuf)> {
        let named = self.out.as_deref().and_then(Format::of_path);
        let Some(format) = self.format.map(|wanted| wanted.0).or(named) else {
            let all: Vec<_> = Format::ALL.iter().map(|format| format.name()).collect();
            bail!("which format? give `--as` one of {}", all.join(", "));
        };
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

fn parse_scale(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(scale) if f64::is_finite(scale) && scale > 0.0 => Ok(scale),
        _ => Err("a scale is a number above zero".to_owned()),
    }
}
