//! `nucleus play`.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};

use crate::sample::{assert_refused, cache, folder, nucleus, scene};

/// A player that ends with the test, and its address.
struct Player(Child, String, #[expect(dead_code, reason = "an open pipe")] BufReader<ChildStdout>);

impl Player {
    fn start(folder: &Path, file: &str) -> Self {
        Self::start_with(folder, &[file])
    }

    fn start_with(folder: &Path, arguments: &[&str]) -> Self {
        let mut play = Command::new(env!("CARGO_BIN_EXE_nucleus"));
        play.arg("play").args(arguments).arg("--no-open").current_dir(folder);
        let mut child = play.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut said = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        while !line.contains("http://") {
            line.clear();
            assert_ne!(said.read_line(&mut line).unwrap(), 0, "no address was printed");
        }
        let address = line.split("http://").nth(1).unwrap().split('/').next().unwrap().to_owned();
        Self(child, address, said)
    }

    fn get(&self, path: &str) -> String {
        let mut server = TcpStream::connect(&self.1).unwrap();
        write!(server, "GET {path} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", self.1).unwrap();
        let mut answer = Vec::new();
        server.read_to_end(&mut answer).unwrap();
        String::from_utf8_lossy(&answer).into_owned()
    }
}

impl Drop for Player {
    fn drop(&mut self) {
        self.0.kill().unwrap();
        self.0.wait().unwrap();
    }
}

#[test]
fn a_cache_is_served_at_the_printed_address() {
    let folder = folder();
    cache(folder.path());
    let answer = Player::start(folder.path(), "fall.mcap").get("/");
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    assert!(answer.contains("<html"), "{answer}");
}

#[test]
fn a_scene_is_run_first() {
    let folder = folder();
    scene(folder.path(), 3, "");
    let answer = Player::start(folder.path(), "drape.ron").get("/");
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    assert!(folder.path().join("drape.mcap").exists());
}

/// Asks for the state of the live run until it has these words.
fn wait_for(player: &Player, words: &[&str]) -> String {
    for _ in 0..600 {
        let answer = player.get("/live.json");
        if words.iter().all(|word| answer.contains(word)) {
            return answer;
        }
        std::thread::sleep(std::time::Duration::from_millis(100));
    }
    panic!("{words:?}: {}", player.get("/live.json"))
}

#[test]
fn a_watched_scene_is_run_again_when_its_file_changes() {
    let folder = folder();
    scene(folder.path(), 3, "finite");
    let player = Player::start_with(folder.path(), &["drape.ron", "--watch"]);
    wait_for(&player, &["\"run\":1,\"solving\":false,\"message\":\"\""]);
    let first = player.get("/cache.mcap").len();
    scene(folder.path(), 12, "finite");
    wait_for(&player, &["\"run\":2,\"solving\":false,\"message\":\"\""]);
    assert!(player.get("/cache.mcap").len() > first, "more frames");
    std::fs::write(folder.path().join("drape.ron"), "Scene(nodes: {})").unwrap();
    wait_for(&player, &["\"run\":3,\"solving\":false", "error: "]);
    assert!(player.get("/cache.mcap").len() > first, "the last good run is still shown");
    drop(player);
    let again = nucleus(folder.path(), &["play", "drape.ron", "--watch"]);
    assert_refused(&again, "`drape.mcap` exists; `--force` replaces it");
    assert_refused(&nucleus(folder.path(), &["play", "drape.mcap", "--watch"]), "takes a scene");
}

#[test]
fn a_missing_cache_is_refused() {
    let folder = folder();
    assert_refused(&nucleus(folder.path(), &["play", "none.mcap"]), "cannot read `none.mcap`");
}
