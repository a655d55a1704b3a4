//! The server of the player: its responses, and the requests that it refuses.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};

use nucleus_view::{LiveRun, Player, ViewError, serve, serve_live};

/// A served file of 1000 bytes that differ from their neighbours.
fn served() -> (tempfile::TempDir, Player, Vec<u8>) {
    let folder = tempfile::tempdir().unwrap();
    let bytes: Vec<u8> = (0..1000u32).map(|k| (k * 7 % 251) as u8).collect();
    let path = folder.path().join("späte Fahne.mcap");
    std::fs::write(&path, &bytes).unwrap();
    std::fs::write(folder.path().join("secret.txt"), "secret").unwrap();
    (folder, serve(&path, 0).unwrap(), bytes)
}

/// Sends a request; returns status, head and body of the response.
fn ask(address: SocketAddr, request: &str) -> (u16, String, Vec<u8>) {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    let end = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n").unwrap();
    let head = String::from_utf8(answer[..end].to_vec()).unwrap();
    let status = head.split(' ').nth(1).unwrap().parse().unwrap();
    (status, head, answer[end + 4..].to_vec())
}

fn get(address: SocketAddr, path: &str, headers: &str) -> (u16, String, Vec<u8>) {
    ask(address, &format!("GET {path} HTTP/1.1\r\nHost: {address}\r\n{headers}\r\n"))
}

#[test]
fn a_range_gives_just_those_bytes() {
    let (_folder, player, bytes) = served();
    for (range, expected) in [("0-0", 0..1), ("10-19", 10..20), ("990-", 990..1000), ("-5", 995..1000)] {
        let (status, head, body) = get(player.address(), "/cache.mcap", &format!("Range: bytes={range}\r\n"));
        assert_eq!(status, 206, "{range}");
        let place = format!("Content-Range: bytes {}-{}/1000\r\n", expected.start, expected.end - 1);
        assert!(head.contains(&place), "{range}: {head}");
        assert_eq!(body, bytes[expected], "{range}");
    }
}

#[test]
fn a_range_beyond_the_end_is_not_satisfiable() {
    let (_folder, player, _) = served();
    let (status, head, body) = get(player.address(), "/cache.mcap", "Range: bytes=1000-\r\n");
    assert_eq!((status, body.len()), (416, 0));
    assert!(head.contains("Content-Range: bytes */1000"), "{head}");
}

#[test]
fn without_a_range_the_complete_file_is_sent_and_head_has_no_body() {
    let (_folder, player, bytes) = served();
    let (status, head, body) = get(player.address(), "/cache.mcap", "");
    assert_eq!((status, &body), (200, &bytes));
    assert!(head.contains("Accept-Ranges: bytes"), "{head}");
    assert!(head.contains("filename*=UTF-8''sp%C3%A4te%20Fahne.mcap"), "{head}");
    let (status, head, body) = ask(player.address(), "HEAD /cache.mcap HTTP/1.1\r\n\r\n");
    assert_eq!((status, body.len()), (200, 0));
    assert!(head.contains("Content-Length: 1000"), "{head}");
}

#[test]
fn a_growing_file_is_served_at_its_current_length() {
    let (folder, player, mut bytes) = served();
    bytes.extend([1, 2, 3]);
    std::fs::write(folder.path().join("späte Fahne.mcap"), &bytes).unwrap();
    let (_, _, body) = get(player.address(), "/cache.mcap", "Range: bytes=1000-1002\r\n");
    assert_eq!(body, [1, 2, 3]);
}

#[test]
fn parts_that_a_run_does_not_have_are_no_errors_and_a_lost_cache_is_gone() {
    let (folder, player, _) = served();
    for path in ["/live.json", "/other.mcap"] {
        assert_eq!(get(player.address(), path, "").0, 204, "{path}");
    }
    let path = folder.path().join("späte Fahne.mcap");
    std::fs::write(&path, "").unwrap();
    assert_eq!(get(player.address(), "/cache.mcap", "Range: bytes=0-99\r\n").0, 204, "still empty");
    std::fs::remove_file(&path).unwrap();
    assert_eq!(get(player.address(), "/cache.mcap", "").0, 410);
}

#[test]
fn bytes_of_a_live_run_that_another_has_replaced_are_no_error_and_not_those_of_the_other() {
    let folder = tempfile::tempdir().unwrap();
    let (run, cache) = (LiveRun::new(folder.path().join("run.mcap")), folder.path().join("run.mcap"));
    let player = serve_live(&run, 0).unwrap();
    run.begin();
    std::fs::write(&cache, [7; 1000]).unwrap();
    run.end("");
    let bytes = |path: &str, range: &str| {
        let (status, _, body) = get(player.address(), path, &format!("Range: bytes={range}\r\n"));
        (status, body.len())
    };
    assert_eq!(bytes("/cache.mcap?run=1", "0-99"), (206, 100));
    assert_eq!(bytes("/cache.mcap?run=1", "1000-1099"), (204, 0), "it may grow");
    run.begin();
    assert_eq!(bytes("/cache.mcap?run=1", "0-99"), (204, 0));
    assert_eq!(bytes("/cache.mcap?run=2", "0-99"), (206, 100));
    assert_eq!(get(player.address(), "/surface/drops/1/0?run=1", "").0, 204);
}

#[test]
fn a_live_run_without_a_file_has_no_cache_yet() {
    let folder = tempfile::tempdir().unwrap();
    let player = serve_live(&LiveRun::new(folder.path().join("run.mcap")), 0).unwrap();
    assert_eq!(get(player.address(), "/cache.mcap", "").0, 204);
    assert_eq!(get(player.address(), "/live.json", "").0, 200);
}

#[test]
fn the_page_and_all_its_parts_are_served() {
    let (_folder, player, _) = served();
    let (status, head, body) = get(player.address(), "/?anything", "");
    assert_eq!(status, 200);
    assert!(head.contains("text/html"), "{head}");
    let page = String::from_utf8(body).unwrap();
    for part in ["/player/style.css", "/player/main.js"] {
        assert!(page.contains(part));
        assert_eq!(get(player.address(), part, "").0, 200, "{part}");
    }
    let (_, head, _) = get(player.address(), "/vendor/fzstd.mjs", "");
    assert!(head.contains("text/javascript"), "{head}");
}

#[test]
fn no_path_reaches_another_file() {
    let (_folder, player, _) = served();
    for path in
        ["/secret.txt", "/../secret.txt", "/player/../secret.txt", "/%2e%2e/secret.txt", "//etc/passwd", ""]
    {
        let (status, _, body) = get(player.address(), path, "");
        assert_eq!((status, body.len()), (404, 0), "{path}");
    }
}

#[test]
fn foreign_hosts_and_other_methods_are_refused() {
    let (_folder, player, _) = served();
    let address = player.address();
    assert_eq!(ask(address, "GET /cache.mcap HTTP/1.1\r\nHost: evil.example\r\n\r\n").0, 403);
    assert_eq!(ask(address, "POST /cache.mcap HTTP/1.1\r\n\r\n").0, 405);
    assert_eq!(ask(address, "\0\u{1}\u{2} nonsense\r\n\r\n").0, 400);
    assert!(address.ip().is_loopback());
}

#[test]
fn a_silent_client_delays_no_other() {
    let (_folder, player, _) = served();
    let _silent = TcpStream::connect(player.address()).unwrap();
    assert_eq!(get(player.address(), "/", "").0, 200);
}

/// More connections than threads, and more than may be pending.
#[test]
fn many_half_open_connections_delay_no_other() {
    let (_folder, player, _) = served();
    let half = |k: usize| {
        let mut stream = TcpStream::connect(player.address()).unwrap();
        stream.write_all(if k.is_multiple_of(2) { b"GET / HTTP/1.1\r\n" } else { b"" }).unwrap();
        stream
    };
    let half_open: Vec<TcpStream> = (0..400).map(half).collect();
    for _ in 0..20 {
        assert_eq!(get(player.address(), "/", "").0, 200);
    }
    drop(half_open);
    assert_eq!(get(player.address(), "/", "").0, 200);
}

/// The bound allows for the threads of other tests in the same process.
#[cfg(target_os = "linux")]
#[test]
fn connections_start_no_threads() {
    let (_folder, player, _) = served();
    let _half_open: Vec<TcpStream> =
        (0..300).map(|_| TcpStream::connect(player.address()).unwrap()).collect();
    assert_eq!(get(player.address(), "/", "").0, 200);
    assert!(std::fs::read_dir("/proc/self/task").unwrap().count() < 250);
}

#[test]
fn a_stopped_player_releases_its_port() {
    let (folder, player, _) = served();
    let port = player.address().port();
    let path = folder.path().join("späte Fahne.mcap");
    assert!(matches!(serve(&path, port), Err(ViewError::Listen { .. })));
    player.stop();
    assert_eq!(serve(&path, port).unwrap().address().port(), port);
}

#[test]
fn a_path_that_is_not_a_file_is_refused() {
    let (folder, _player, _) = served();
    for path in [folder.path().to_path_buf(), folder.path().join("missing.mcap")] {
        assert!(matches!(serve(path, 0), Err(ViewError::Open { .. })));
    }
}
