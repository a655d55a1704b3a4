//! All rows.
//!
//! | Question                                                    | Read              |
//! |-------------------------------------------------------------|-------------------|
//! | rows whose scene is a file of `scenes/extremes/`            | `scenes.rs`       |
//! | rows whose mesh is generated                                | `mesh.rs`         |
//! | rows that inject faults into the input of frames            | `input.rs`        |

mod input;
mod mesh;
mod scenes;

use std::sync::LazyLock;

use super::row::StressCase;

/// All rows, in the order of the table.
static ROWS: LazyLock<Vec<StressCase>> = LazyLock::new(|| {
    let from_files = scenes::rows();
    let group = |name: &'static str| from_files.iter().copied().filter(move |row| row.group == name);
    let mut rows = mesh::MASS.to_vec();
    rows.extend(["Mass", "Resistances", "Time", "Scale", "Forces", "Thickness"].into_iter().flat_map(group));
    rows.extend(mesh::ROWS);
    rows.extend(group("Colliders"));
    rows.extend(input::ROWS);
    rows
});

/// All rows, in the order of the table.
pub fn rows() -> impl Iterator<Item = &'static StressCase> {
    ROWS.iter()
}

/// The row of this name.
pub fn named(name: &str) -> Option<&'static StressCase> {
    rows().find(|row| row.name == name)
}
