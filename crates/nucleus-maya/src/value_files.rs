//! Files of values for points, textures and recorded positions, which a scene names relative to its own folder.

use std::path::{Component, Path, PathBuf};

use nucleus_graph::attributes::{Attribute, Painting, Value, n_base};
use nucleus_graph::graph::{Graph, NodeId, Setting};

/// A scene that moves to another folder.
#[derive(Debug, Clone)]
pub struct Move {
    from: PathBuf,
    to: PathBuf,
}

impl Move {
    /// From the folder of one file to that of another.
    pub fn between(from: &Path, to: &Path) -> Self {
        let folder = |file: &Path| {
            let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
            real(folder.unwrap_or(Path::new(".")))
        };
        Self { from: folder(from), to: folder(to) }
    }

    /// The path by which the scene names the same file from its new folder.
    fn path(&self, path: &str) -> String {
        let from_new_folder = relative(&self.to, &self.from.join(path));
        from_new_folder.to_str().map_or_else(|| path.to_owned(), |path| path.replace('\\', "/"))
    }
}

/// Renames the files of values, textures and recorded positions that exist in the old folder of a scene alone, so that it names them from
/// its new folder. Returns the node, the attribute and the path of those that are in neither.
pub fn follow(graph: &mut Graph, how: &Move) -> Vec<(String, String)> {
    let mut missing = Vec::new();
    if how.from == how.to {
        return missing;
    }
    for (id, row, painting) in files(graph) {
        let (Painting::File(path) | Painting::Texture(path)) = &painting else { continue };
        if Path::new(path).is_absolute() || how.to.join(path).is_file() {
            continue;
        }
        if !how.from.join(path).is_file() {
            missing.push((format!("{}.{}", graph.node(id).name(), row.name), path.clone()));
            continue;
        }
        let moved = match &painting {
            Painting::Texture(path) => Painting::Texture(how.path(path)),
            _ => Painting::File(how.path(path)),
        };
        // A path fits wherever one was.
        let _ = graph.set(id, row, Setting::Fixed(Value::Painting(moved)));
    }
    follow_caches(graph, how);
    missing
}

/// The same for `cacheFile`, whose `####` stands for the frame.
fn follow_caches(graph: &mut Graph, how: &Move) {
    let path = |(id, node): (NodeId, &nucleus_graph::graph::Node)| match node.setting(&n_base::CACHE_FILE) {
        Some(Setting::Fixed(Value::Text(path))) => Some((id, path.clone())),
        _ => None,
    };
    let paths: Vec<(NodeId, String)> = graph.iter().filter_map(path).collect();
    for (id, path) in paths {
        let is_elsewhere = !Path::new(&path).is_absolute() && !has_frames(&how.to.join(&path));
        if is_elsewhere && has_frames(&how.from.join(&path)) {
            // A path fits wherever one was.
            let moved = Setting::Fixed(Value::Text(how.path(&path)));
            let _ = graph.set(id, &n_base::CACHE_FILE.row, moved);
        }
    }
}

/// Whether there is a file of any frame of a numbered file.
fn has_frames(file: &Path) -> bool {
    let name = file.file_name().and_then(|name| name.to_str());
    let Some((before, rest)) = name.and_then(|name| name.split_once('#')) else { return file.is_file() };
    let after = rest.trim_start_matches('#');
    let is_frame = |name: &str| {
        let number = name.strip_prefix(before).and_then(|name| name.strip_suffix(after));
        number.is_some_and(|number| number.parse::<i64>().is_ok())
    };
    let entries = file.parent().and_then(|folder| folder.read_dir().ok());
    entries.into_iter().flatten().flatten().any(|entry| entry.file_name().to_str().is_some_and(is_frame))
}

/// The attributes whose values come from a file.
fn files(graph: &Graph) -> Vec<(NodeId, &'static Attribute, Painting)> {
    let of_node = |(id, node): (NodeId, &nucleus_graph::graph::Node)| {
        let node_type = node.node_type();
        let of_setting = move |(name, setting): (&&'static str, &Setting)| match setting {
            Setting::Fixed(Value::Painting(painting @ (Painting::File(_) | Painting::Texture(_)))) => {
                Some((id, node_type.attribute(name)?, painting.clone()))
            }
            _ => None,
        };
        node.settings().iter().filter_map(of_setting).collect::<Vec<_>>()
    };
    graph.iter().flat_map(of_node).collect()
}

/// The real path of a folder, of which the end may not exist yet.
fn real(folder: &Path) -> PathBuf {
    let whole = std::path::absolute(folder).unwrap_or(folder.to_owned());
    let known = whole.ancestors().find_map(|known| Some((known, known.canonicalize().ok()?)));
    match known {
        Some((known, real)) => real.join(whole.strip_prefix(known).unwrap_or(Path::new(""))),
        None => whole,
    }
}

/// A path as seen from a folder; both are absolute.
fn relative(folder: &Path, path: &Path) -> PathBuf {
    let (folder, path) = (plain(folder), plain(path));
    let shared = folder.iter().zip(&path).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return path.iter().collect();
    }
    let up = folder[shared..].iter().map(|_| Component::ParentDir);
    up.chain(path[shared..].iter().copied()).collect()
}

/// The parts of an absolute path without `.` and `..`.
fn plain(path: &Path) -> Vec<Component<'_>> {
    let mut parts = Vec::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if parts.len() > 1 => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frames_of_a_cache_are_found_under_its_name_with_numbers() {
        let folder = tempfile::tempdir().unwrap();
        let sequence = folder.path().join("points/c.####.obj");
        assert!(!has_frames(&sequence));
        std::fs::create_dir(folder.path().join("points")).unwrap();
        std::fs::write(folder.path().join("points/c.rest.obj"), "").unwrap();
        assert!(!has_frames(&sequence));
        std::fs::write(folder.path().join("points/c.0012.obj"), "").unwrap();
        assert!(has_frames(&sequence));
    }

    #[test]
    fn a_path_leads_from_a_folder_to_a_file() {
        let seen = |folder: &str, path: &str| relative(Path::new(folder), Path::new(path));
        assert_eq!(seen("/a/maya", "/a/scenes/../meshes/beads.obj"), Path::new("../meshes/beads.obj"));
        assert_eq!(seen("/a", "/a/m.obj"), Path::new("m.obj"));
        assert_eq!(seen("/a/./b/c", "/x/m.obj"), Path::new("../../../x/m.obj"));
    }
}
