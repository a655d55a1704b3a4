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
    /// The scene to write, a starting point for scenes of its kind.
    #[arg(long, value_enum, default_value_t)]
    template: Template,
}

/// Scenes to start from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum Template {
    /// A sheet of cotton that falls on a sphere.
    #[default]
    Drape,
    /// A curtain that is drawn on its rail into folds, and moves in a breeze.
    #[value(alias = "hang")]
    Curtain,
    /// A flag on a pole in a wind that rises.
    Flag,
    /// A banner that hangs in gusts.
    Banner,
    /// A cape in folds on a body that walks and turns.
    Cape,
    /// A skirt on a body that twirls, with its mesh.
    Garment,
    /// A sheet that a ball pushes through and tears.
    Tear,
    /// Beads that fall into a sheet.
    Particles,
    /// A fountain: an emitter, and drops that bounce and die.
    Emitter,
    /// Water that is poured into a glass, with its mesh.
    Liquid,
}

impl Template {
    /// The file that is written unless another one is given: `cape.ron`.
    fn name(self) -> String {
        let value = self.to_possible_value();
        format!("{}.ron", value.as_ref().map_or("scene", |value| value.get_name()))
    }

    /// The scene; `MESH` stands for the name of its mesh.
    fn text(self) -> &'static str {
        match self {
            Self::Drape => include_str!("templates/drape.ron"),
            Self::Curtain => include_str!("templates/curtain.ron"),
            Self::Flag => include_str!("templates/flag.ron"),
            Self::Banner => include_str!("templates/banner.ron"),
            Self::Cape => include_str!("templates/cape.ron"),
            Self::Garment => include_str!("templates/garment.ron"),
            Self::Tear => include_str!("templates/tear.ron"),
            Self::Particles => include_str!("templates/particles.ron"),
            Self::Emitter => include_str!("templates/emitter.ron"),
            Self::Liquid => include_str!("templates/liquid.ron"),
        }
    }

    /// The mesh that belongs to the scene: the end of its name, and its text.
    fn mesh(self) -> Option<(&'static str, String)> {
        match self {
            Self::Garment => Some(("skirt", revolved("a skirt, from the waist down", 72, &skirt()))),
            Self::Liquid => Some(("glass", revolved("a glass, from its rim down", 32, &GLASS))),
            _ => None,
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
        let text = self.template.text();
        match self.template.mesh() {
            Some((end, mesh)) => {
                let stem = scene.file_stem().context("the scene has no name")?.to_string_lossy();
                let name = format!("{stem}_{end}.obj");
                write_new(&scene, &text.replace("MESH", &name))?;
                write_new(&scene.with_file_name(name), &mesh)?;
            }
            None => write_new(&scene, text)?,
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

/// Radius and height in centimetres of the rings of a skirt: from the waist to a hem so wide that it hangs in folds.
fn skirt() -> Vec<[f64; 2]> {
    let ring = |down: f64| [15.0 + 42.0 * down, 95.0 - 20.0 * down];
    (0..=24).map(|ring| f64::from(ring) / 24.0).map(ring).collect()
}

/// Radius and height in centimetres of the rings of a glass, from its rim to the middle of its bottom.
const GLASS: [[f64; 2]; 7] =
    [[4.0, 8.5], [3.75, 6.5], [3.5, 4.5], [3.25, 2.5], [3.0, 0.5], [1.5, 0.5], [0.2, 0.5]];

/// A surface of revolution about the y axis as OBJ: quads with texture coordinates between rings of points, given by radius
/// and height. Where the radii grow downwards, the faces face outwards.
fn revolved(what: &str, around: u32, outline: &[[f64; 2]]) -> String {
    let rings = outline.len() as u32 - 1;
    let mut text = format!("# {what}: rings of {around} points\n");
    for &[radius, height] in outline {
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
