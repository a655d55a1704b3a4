//! The responses of the server: the files of the page, which are part of the binary, and the caches.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::live::LiveRun;
use super::request::{ByteRange, Request};
use super::surface::surface;

/// The caches that the page can request.
#[derive(Debug)]
pub(super) struct Caches {
    pub shown: Shown,
    /// A second cache, for comparison.
    pub other: Option<PathBuf>,
}

/// The cache that the page shows.
#[derive(Debug)]
pub(super) enum Shown {
    /// One file.
    File(PathBuf),
    /// The cache of a scene that is solved again whenever it changes.
    Live(LiveRun),
}

impl Shown {
    /// The file, and the status for bytes that it does not have. `None` if a run is meant that another has replaced.
    fn file(&self, run: Option<u32>) -> Option<(PathBuf, Missing)> {
        match self {
            Self::File(path) => Some((path.clone(), Missing::OF_A_FILE)),
            Self::Live(live) => live.path(run).map(|path| (path, Missing::OF_A_LIVE_RUN)),
        }
    }
}

/// The path of the cache, whatever the name of its file.
const CACHE: &str = "/cache.mcap";
/// The path of the second cache.
const OTHER: &str = "/other.mcap";

/// Before the object and the recorded time of a surface of particles.
const SURFACE: &str = "/surface/";

/// The status for a part that the page asks for and this run does not have, or not yet: browsers report 404 as an error.
const NOTHING_YET: &str = "204 No Content";
/// The status for a cache that was there when the server started.
const GONE: &str = "410 Gone";

/// The status for a cache, for a range of it, and for a surface, that are not there.
#[derive(Debug, Clone, Copy)]
struct Missing {
    cache: &'static str,
    range: &'static str,
    surface: &'static str,
}

impl Missing {
    const OF_A_FILE: Self =
        Self { cache: GONE, range: "416 Range Not Satisfiable", surface: "404 Not Found" };
    /// The file of a live run begins anew with each run, which is no error.
    const OF_A_LIVE_RUN: Self = Self { cache: NOTHING_YET, range: NOTHING_YET, surface: NOTHING_YET };
}

/// The path of the state of a live run.
const LIVE: &str = "/live.json";

/// Responds to a request. Only the files of the page and the caches have a path.
pub(super) fn respond(request: &Request, caches: &Caches, to: &mut impl Write) -> io::Result<()> {
    let with_body = match request.method.as_str() {
        "GET" => true,
        "HEAD" => false,
        _ => return refuse(to, "405 Method Not Allowed", "Allow: GET, HEAD\r\n"),
    };
    if !request.is_for_this_machine() {
        return refuse(to, "403 Forbidden", "");
    }
    match (request.path.as_str(), &caches.other) {
        (CACHE, _) => {
            let Some((cache, missing)) = caches.shown.file(request.run) else {
                return refuse(to, NOTHING_YET, "");
            };
            return send_cache(request, &cache, missing, with_body, to);
        }
        (LIVE, _) => return send_live(&caches.shown, with_body, to),
        (OTHER, Some(other)) => return send_cache(request, other, Missing::OF_A_FILE, with_body, to),
        (OTHER, None) => return refuse(to, NOTHING_YET, ""),
        _ => {}
    }
    if let Some(wanted) = request.path.strip_prefix(SURFACE) {
        let found = caches.shown.file(request.run);
        let bytes = found.as_ref().and_then(|(cache, _)| surface(cache, wanted));
        let missing = found.map_or(NOTHING_YET, |(_, missing)| missing.surface);
        return send_surface(bytes, missing, with_body, to);
    }
    match asset(&request.path) {
        Some(asset) => send_asset(asset, with_body, to),
        None => refuse(to, "404 Not Found", ""),
    }
}

/// Responds to bytes that are not a request.
pub(super) fn refuse_malformed(to: &mut impl Write) -> io::Result<()> {
    refuse(to, "400 Bad Request", "")
}

fn send_asset(asset: &Asset, with_body: bool, to: &mut impl Write) -> io::Result<()> {
    head(to, "200 OK", asset.text.len() as u64, &format!("Content-Type: {}\r\n", asset.media_type))?;
    if with_body { to.write_all(asset.text.as_bytes()) } else { Ok(()) }
}

fn send_live(shown: &Shown, with_body: bool, to: &mut impl Write) -> io::Result<()> {
    let Shown::Live(run) = shown else { return refuse(to, NOTHING_YET, "") };
    let text = run.to_json();
    head(to, "200 OK", text.len() as u64, "Content-Type: application/json\r\n")?;
    if with_body { to.write_all(text.as_bytes()) } else { Ok(()) }
}

fn send_surface(
    bytes: Option<Vec<u8>>,
    missing: &str,
    with_body: bool,
    to: &mut impl Write,
) -> io::Result<()> {
    let Some(bytes) = bytes else { return refuse(to, missing, "") };
    head(to, "200 OK", bytes.len() as u64, "Content-Type: application/octet-stream\r\n")?;
    if with_body { to.write_all(&bytes) } else { Ok(()) }
}

/// The length is read at each request, because the cache of a running simulation grows.
fn send_cache(
    request: &Request,
    cache: &Path,
    missing: Missing,
    with_body: bool,
    to: &mut impl Write,
) -> io::Result<()> {
    let Ok(mut file) = File::open(cache) else { return refuse(to, missing.cache, "") };
    let length = file.metadata()?.len();
    let name = cache.file_name().map(|name| escaped(&name.to_string_lossy())).unwrap_or_default();
    let mut headers = format!(
        "Content-Type: application/octet-stream\r\nAccept-Ranges: bytes\r\n\
         Content-Disposition: inline; filename*=UTF-8''{name}\r\n"
    );
    let (status, part) = match ByteRange::parse(request.range.as_deref(), length) {
        ByteRange::Whole => ("200 OK", 0..length),
        ByteRange::Unsatisfiable if length == 0 => return refuse(to, NOTHING_YET, ""),
        ByteRange::Unsatisfiable => {
            return refuse(to, missing.range, &format!("Content-Range: bytes */{length}\r\n"));
        }
        ByteRange::Part(part) => {
            headers += &format!("Content-Range: bytes {}-{}/{length}\r\n", part.start, part.end - 1);
            ("206 Partial Content", part)
        }
    };
    head(to, status, part.end - part.start, &headers)?;
    if with_body {
        file.seek(SeekFrom::Start(part.start))?;
        io::copy(&mut file.take(part.end - part.start), to)?;
    }
    Ok(())
}

fn refuse(to: &mut impl Write, status: &str, headers: &str) -> io::Result<()> {
    head(to, status, 0, headers)
}

fn head(to: &mut impl Write, status: &str, length: u64, headers: &str) -> io::Result<()> {
    write!(
        to,
        "HTTP/1.1 {status}\r\nContent-Length: {length}\r\n{headers}Cache-Control: no-store\r\n\
         X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n"
    )
}

/// A file name percent-encoded for a header: bytes other than ASCII letters, digits and `-._` as %XX.
fn escaped(name: &str) -> String {
    let plain = |byte: &u8| byte.is_ascii_alphanumeric() || b"-._".contains(byte);
    name.bytes()
        .map(|byte| if plain(&byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") })
        .collect()
}

/// A file of the page.
struct Asset {
    path: &'static str,
    media_type: &'static str,
    text: &'static str,
}

/// The file of the page at a path.
fn asset(path: &str) -> Option<&'static Asset> {
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
    "/player/cache.js" as SCRIPT,
    "/player/camera.js" as SCRIPT,
    "/player/compare.js" as SCRIPT,
    "/player/figures.js" as SCRIPT,
    "/player/framing.js" as SCRIPT,
    "/player/gl.js" as SCRIPT,
    "/player/link.js" as SCRIPT,
    "/player/live.js" as SCRIPT,
    "/player/main.js" as SCRIPT,
    "/player/mcap.js" as SCRIPT,
    "/player/mesh.js" as SCRIPT,
    "/player/messages.js" as SCRIPT,
    "/player/panel.js" as SCRIPT,
    "/player/particles.js" as SCRIPT,
    "/player/pick.js" as SCRIPT,
    "/player/plane.js" as SCRIPT,
    "/player/player.js" as SCRIPT,
    "/player/records.js" as SCRIPT,
    "/player/scene.js" as SCRIPT,
    "/player/shading.js" as SCRIPT,
    "/player/series.js" as SCRIPT,
    "/player/source.js" as SCRIPT,
    "/player/speed.js" as SCRIPT,
    "/player/surface.js" as SCRIPT,
    "/player/timeline.js" as SCRIPT,
    "/vendor/fzstd.mjs" as SCRIPT,
];

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_file_of_the_page_is_served() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/player");
        let on_disk: BTreeSet<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| format!("/player/{}", entry.unwrap().file_name().display()))
            .collect();
        let served = ASSETS.iter().map(|asset| asset.path.to_owned());
        assert_eq!(on_disk, served.filter(|path| path.starts_with("/player/")).collect());
    }
}
