//! Where results that cost time are kept between commands: `NUCLEUS_CACHE`, or the system's place for such things.

use std::env;
use std::path::PathBuf;

/// Named in messages and in `--help`.
pub const VARIABLE: &str = "NUCLEUS_CACHE";

/// The folder; nothing in it is needed for good.
pub fn folder() -> PathBuf {
    let set = |name: &str| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    if let Some(folder) = set(VARIABLE) {
        return folder;
    }
    let place = if cfg!(windows) {
        set("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        set("HOME").map(|home| home.join("Library").join("Caches"))
    } else {
        set("XDG_CACHE_HOME").or_else(|| set("HOME").map(|home| home.join(".cache")))
    };
    place.map_or_else(|| PathBuf::from(".nucleus-cache"), |place| place.join("nucleus"))
}
