//! A Maya scene as a Nucleus scene.

use std::path::Path;

use nucleus_graph::scene::{Record, Scene, Source, TimeSpan, read_scene_text, write_scene};

use crate::ascii::{ImportError, SourceText};
use crate::nucleus_nodes::{BorrowedOptions, ImportOptions, Importer, OWN_FILE};
use crate::omissions::{Cause, Omissions};
use crate::scene::MayaScene;
use crate::value_files;

/// An imported scene.
#[derive(Debug)]
pub struct Imported {
    /// The scene.
    pub scene: Scene,
    /// The omissions.
    pub omissions: Omissions,
}

impl Imported {
    /// The text of our scene file, with the omissions as comments at its head.
    pub fn text(&self, origin: &str) -> String {
        let mut head = format!("// Imported from `{}`.\n", one_line(origin));
        if !self.omissions.is_empty() {
            head += "// Left out or changed:\n";
        }
        for line in self.omissions.to_string().lines() {
            head += &format!("// - {line}\n");
        }
        head + &write_scene(&self.scene)
    }
}

fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// Whether a file is a Maya scene by its name, ASCII or binary.
pub fn is_maya_scene(path: &Path) -> bool {
    path.extension().is_some_and(|end| end.eq_ignore_ascii_case("ma") || end.eq_ignore_ascii_case("mb"))
}

/// Imports a scene; `ron` is the scene file that it will be.
///
/// # Errors
/// When the file cannot be read or is no Maya ASCII, a mesh cannot be written, or nothing takes a mesh that is given. All
/// else is an omission.
pub fn import_scene(path: &Path, ron: &Path, options: &mut ImportOptions) -> Result<Imported, ImportError> {
    import_text(SourceText::read(path)?, ron, options)
}

/// As [`import_scene`], for a text in memory.
///
/// # Errors
/// As there.
pub fn import_text(
    text: SourceText,
    ron: &Path,
    options: &mut ImportOptions,
) -> Result<Imported, ImportError> {
    let path = text.path.clone();
    let mut maya = MayaScene::of_text(text)?;
    let own = maya.file_info.iter().find(|(key, _)| key == OWN_FILE).map(|(_, text)| text.clone());
    let refused = |message: String| ImportError::Refused { file: path.clone(), message };
    // The fields of a scene other than its nodes.
    let head = match &own {
        Some(text) => Some(read_head(text, ron).map_err(refused)?),
        None => None,
    };
    let mut omissions = std::mem::take(&mut maya.omissions);
    let refused = |message: String| ImportError::Refused { file: path.clone(), message };
    let options = BorrowedOptions::of(options, ron);
    let importer = Importer::new(&maya, own.is_some(), options);
    let carried = importer.check_given().and_then(|()| importer.run()).map_err(refused)?;
    omissions.extend(carried.omissions);
    let mut graph = carried.graph;
    if own.is_some() {
        for (what, file) in value_files::follow(&mut graph, &value_files::Move::between(&path, ron)) {
            omissions.add(what, Cause::NoValueFile(file));
        }
    }
    let [start, end] = carried.frames;
    let source = Source::new(ron);
    let scene = match head {
        Some(head) => Scene { graph, source, ..head },
        None => Scene {
            time: TimeSpan { start, end, fps: maya.units.fps },
            every: 1.0,
            record: Record::Frames,
            graph,
            checks: Vec::new(),
            source,
        },
    };
    Ok(Imported { scene, omissions })
}

/// The scene of a text that has no nodes.
fn read_head(text: &str, ron: &Path) -> Result<Scene, String> {
    let first = |all: Vec<nucleus_graph::scene::Diagnostic>| {
        all.first().map_or_else(String::new, |diagnostic| diagnostic.message.clone())
    };
    read_scene_text(text, ron).map(|(scene, _)| scene).map_err(first)
}
