//! `nucleus new`: scenes to start from.

use std::fmt::Write as _;
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use nucleus_cache::shell_word;

use crate::output;
use crate::process::Outcome;

/// Writes a small scene as a starting point.
#[derive(Debug, Args)]
pub struct New {
    /// The file to write (.ron); default: the name of the template. An existing file is not replaced.
    scene: Option<PathBuf>,
    /// The scene to write.
    #[arg(long, value_enum, default_value_t)]
    template: Template,
}

/// Scenes to start from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum Template {
    /// A cloth that falls on a sphere.
    #[default]
    Drape,
    /// A curtain that hangs by its corners in a wind.
    #[value(alias = "hang")]
    Curtain,
    /// A flag on a pole in a wind that rises.
    Flag,
    /// A banner that hangs in gusts.
    Banner,
    /// A cape on a body that walks and turns.
    Cape,
    /// A skirt on a body that twirls, with its mesh.
    Garment,
    /// Beads that fall into a sheet.
    Particles,
}

impl Template {
    /// The file that is written unless another one is given: `cape.ron`.
    fn name(self) -> String {
        let value = self.to_possible_value();
        format!("{}.ron", value.as_ref().map_or("scene", |value| value.get_name()))
    }

    fn text(self) -> &'static str {
        match self {
            Self::Drape => include_str!("templates/drape.ron"),
            Self::Curtain => include_str!("templates/curtain.ron"),
            Self::Flag => include_str!("templates/flag.ron"),
            Self::Banner => include_str!("templates/banner.ron"),
            Self::Cape => include_str!("templates/cape.ron"),
            Self::Garment => include_str!("templates/garment.ron"),
            Self::Particles => include_str!("templates/particles.ron"),
        }
    }
}

impl New {
    /// Writes the file, and its mesh if it has one; prints the command that runs it.
    pub fn run(self) -> Result<Outcome> {
        let mut scene = self.scene.unwrap_or_else(|| self.template.name().into());
        match scene.extension() {
            None => drop(scene.set_extension("ron")),
            Some(extension) if extension == "ron" => {}
            Some(_) => {
                let ron = scene.with_extension("ron");
                bail!("scenes end in `.ron`: write `{}`", shell_word(&ron))
            }
        }
        let mut text = self.template.text().to_owned();
        if self.template == Template::Garment {
            let stem = scene.file_stem().context("the scene has no name")?.to_string_lossy();
            let mesh = format!("{stem}_skirt.obj");
            text = text.replace("MESH", &mesh);
            write_new(&scene, &text)?;
            write_new(&scene.with_file_name(mesh), &skirt())?;
        } else {
            write_new(&scene, &text)?;
        }
        let (path, word) = (scene.display(), shell_word(&scene));
        output::report(&format!("wrote `{path}`; run and play it with `nucleus play {word}`\n"));
        Ok(Outcome::Success)
    }
}

/// Writes a file that does not exist yet.
fn write_new(path: &Path, text: &str) -> Result<()> {
    let mut file = match OpenOptions::new().write(true).create_new(true).open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            bail!("`{}` exists; give another name", path.display())
        }
        Err(error) => return Err(error).with_context(|| format!("cannot write `{}`", path.display())),
    };
    file.write_all(text.as_bytes()).with_context(|| format!("cannot write `{}`", path.display()))
}

/// Points of the skirt around the body, and rings from waist to hem.
const SKIRT: [u32; 2] = [48, 24];

/// A cone of quads with texture coordinates, as OBJ in centimetres.
fn skirt() -> String {
    let [around, rings] = SKIRT;
    let mut text = String::from("# a skirt: rings of points from the waist down\n");
    for ring in 0..=rings {
        let down = f64::from(ring) / f64::from(rings);
        let (radius, height) = (15.0 + 25.0 * down, 95.0 - 45.0 * down);
        for point in 0..around {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(point) / f64::from(around)).sin_cos();
            // Writing to a string cannot fail.
            let _ = writeln!(text, "v {:.4} {height:.4} {:.4}", radius * sine, radius * cosine);
        }
    }
    for (ring, point) in (0..=rings).flat_map(|ring| (0..=around).map(move |point| (ring, point))) {
        let [u, v] = [f64::from(point) / f64::from(around), 1.0 - f64::from(ring) / f64::from(rings)];
        let _ = writeln!(text, "vt {u:.5} {v:.5}");
    }
    for (ring, point) in (0..rings).flat_map(|ring| (0..around).map(move |point| (ring, point))) {
        let corner = |ring: u32, point: u32| {
            format!("{}/{}", ring * around + point % around + 1, ring * (around + 1) + point + 1)
        };
        let corners = [(ring + 1, point), (ring + 1, point + 1), (ring, point + 1), (ring, point)];
        let _ = writeln!(text, "f {}", corners.map(|(ring, point)| corner(ring, point)).join(" "));
    }
    text
}
