//! All rows.
//!
//! | Question                                                    | Read              |
//! |-------------------------------------------------------------|-------------------|
//! | rows whose scene is a file of `scenes/extremes/`            | `scenes.rs`       |
//! | rows that inject faults into the input of frames            | `input.rs`        |

mod input;
mod scenes;

use std::sync::LazyLock;

use super::row::StressCase;

/// All rows, in the order of the table.
static ROWS: LazyLock<Vec<StressCase>> = LazyLock::new(|| {
    let mut rows = scenes::rows();
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
