//! The files of the page, inside the binary.

/// A file of the page.
pub(super) struct Asset {
    pub path: &'static str,
    pub media_type: &'static str,
    pub text: &'static str,
}

/// The file that is served under a path.
pub(super) fn asset(path: &str) -> Option<&'static Asset> {
    let path = if path == "/" { "/player/index.html" } else { path };
    ASSETS.iter().find(|asset| asset.path == path)
}

const SCRIPT: &str = "text/javascript; charset=utf-8";

macro_rules! assets {
    ($($path:literal as $media_type:expr,)*) => {
        &[$(Asset { path: $path, media_type: $media_type, text: include_str!(concat!("../../assets", $path)) }),*]
    };
}

const ASSETS: &[Asset] = assets![
    "/player/index.html" as "text/html; charset=utf-8",
    "/player/style.css" as "text/css; charset=utf-8",
    "/player/bytes.js" as SCRIPT,
    "/player/cache.js" as SCRIPT,
    "/player/camera.js" as SCRIPT,
    "/player/chunk.js" as SCRIPT,
    "/player/colours.js" as SCRIPT,
    "/player/controls.js" as SCRIPT,
    "/player/crc.js" as SCRIPT,
    "/player/curve.js" as SCRIPT,
    "/player/gl.js" as SCRIPT,
    "/player/main.js" as SCRIPT,
    "/player/matrix.js" as SCRIPT,
    "/player/mcap.js" as SCRIPT,
    "/player/mesh.js" as SCRIPT,
    "/player/panel.js" as SCRIPT,
    "/player/player.js" as SCRIPT,
    "/player/points.js" as SCRIPT,
    "/player/records.js" as SCRIPT,
    "/player/scan.js" as SCRIPT,
    "/player/scene.js" as SCRIPT,
    "/player/shaders.js" as SCRIPT,
    "/player/source.js" as SCRIPT,
    "/player/timeline.js" as SCRIPT,
    "/player/topology.js" as SCRIPT,
    "/player/track.js" as SCRIPT,
    "/player/trouble.js" as SCRIPT,
    "/vendor/fzstd.mjs" as SCRIPT,
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_script_of_the_page_is_served() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/player");
        let on_disk: BTreeSet<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| format!("/player/{}", entry.unwrap().file_name().display()))
            .collect();
        let served = ASSETS.iter().map(|asset| asset.path.to_owned());
        assert_eq!(on_disk, served.filter(|path| path.starts_with("/player/")).collect());
    }
}
