//! The answers of the server.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use super::page::{self, Asset};
use super::range::{Wanted, wanted};
use super::request::Request;
use super::server::Caches;

/// Where the page finds the cache, whatever its file is called.
const CACHE: &str = "/cache.mcap";
/// Where it finds the one to compare it with, if there is one.
const OTHER: &str = "/other.mcap";

/// Answers one request. Only the page's own files and the cache exist; no path leads anywhere else.
pub(super) fn answer(request: &Request, caches: &Caches, to: &mut impl Write) -> io::Result<()> {
    let with_body = match request.method.as_str() {
        "GET" => true,
        "HEAD" => false,
        _ => return refuse(to, "405 Method Not Allowed", "Allow: GET, HEAD\r\n"),
    };
    if !request.is_for_this_machine() {
        return refuse(to, "403 Forbidden", "");
    }
    match (request.path.as_str(), &caches.other) {
        (CACHE, _) => return send_cache(request, &caches.shown, with_body, to),
        (OTHER, Some(other)) => return send_cache(request, other, with_body, to),
        _ => {}
    }
    match page::asset(&request.path) {
        Some(asset) => send_asset(asset, with_body, to),
        None => refuse(to, "404 Not Found", ""),
    }
}

/// Answers what is not a request at all.
pub(super) fn refuse_nonsense(to: &mut impl Write) -> io::Result<()> {
    refuse(to, "400 Bad Request", "")
}

fn send_asset(asset: &Asset, with_body: bool, to: &mut impl Write) -> io::Result<()> {
    head(to, "200 OK", asset.text.len() as u64, &format!("Content-Type: {}\r\n", asset.media_type))?;
    if with_body { to.write_all(asset.text.as_bytes()) } else { Ok(()) }
}

/// The length is taken anew each time: a run that is still going on makes its cache longer.
fn send_cache(request: &Request, cache: &Path, with_body: bool, to: &mut impl Write) -> io::Result<()> {
    let Ok(mut file) = File::open(cache) else { return refuse(to, "404 Not Found", "") };
    let length = file.metadata()?.len();
    let name = cache.file_name().map(|name| escaped(&name.to_string_lossy())).unwrap_or_default();
    let mut headers = format!(
        "Content-Type: application/octet-stream\r\nAccept-Ranges: bytes\r\n\
         Content-Disposition: inline; filename*=UTF-8''{name}\r\n"
    );
    let (status, part) = match wanted(request.range.as_deref(), length) {
        Wanted::Whole => ("200 OK", 0..length),
        Wanted::Unsatisfiable => {
            return refuse(to, "416 Range Not Satisfiable", &format!("Content-Range: bytes */{length}\r\n"));
        }
        Wanted::Part(part) => {
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

/// A file name as a header can carry it: everything but plain letters and digits as %XX.
fn escaped(name: &str) -> String {
    let plain = |byte: &u8| byte.is_ascii_alphanumeric() || b"-._".contains(byte);
    name.bytes()
        .map(|byte| if plain(&byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") })
        .collect()
}
