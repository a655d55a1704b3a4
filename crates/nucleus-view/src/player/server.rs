//! Serves the player to browsers on this machine, and to no other.

use std::io::{self, BufWriter, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::arriving::{Asked, arrive};
use super::deadline::Deadline;
use super::response;
use crate::ViewError;

/// A browser that takes longer than this to take an answer has gone away. At a slow 10 MB/s it is 600 MB, and a page asks
/// for a frame at a time.
const PATIENCE: Duration = Duration::from_secs(60);
/// Threads that answer. A browser opens six connections at a time.
const WORKERS: usize = 8;
/// Connections, and requests, that may wait their turn.
const QUEUE: usize = 64;

/// The caches that the page can have.
#[derive(Debug)]
pub(super) struct Caches {
    pub shown: PathBuf,
    /// One to compare it with.
    pub other: Option<PathBuf>,
}

/// A player that is being served. Dropping it stops the server.
#[derive(Debug)]
pub struct Player {
    address: SocketAddr,
    stopping: Arc<AtomicBool>,
    server: Option<JoinHandle<()>>,
}

/// Serves the player with the cache at `path`, on 127.0.0.1 and the given port, or any free port if it is 0.
///
/// # Errors
/// If the cache cannot be read or the port is taken. What the file holds is for the page to say.
pub fn serve(path: impl AsRef<Path>, port: u16) -> Result<Player, ViewError> {
    serve_caches(Caches { shown: path.as_ref().to_path_buf(), other: None }, port)
}

/// Serves the player with two caches, to be compared; else as [`serve`].
///
/// # Errors
/// As [`serve`].
pub fn serve_both(path: impl AsRef<Path>, other: impl AsRef<Path>, port: u16) -> Result<Player, ViewError> {
    let (shown, other) = (path.as_ref().to_path_buf(), Some(other.as_ref().to_path_buf()));
    serve_caches(Caches { shown, other }, port)
}

fn serve_caches(caches: Caches, port: u16) -> Result<Player, ViewError> {
    for path in [Some(&caches.shown), caches.other.as_ref()].into_iter().flatten() {
        check_is_file(path).map_err(|source| ViewError::Open { path: path.clone(), source })?;
    }
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port));
    let listener = listener.map_err(|source| ViewError::Listen { port, source })?;
    let address = listener.local_addr().map_err(|source| ViewError::Listen { port, source })?;
    let stopping = Arc::new(AtomicBool::new(false));
    let stop = Arc::clone(&stopping);
    let server = start(listener, caches, stop).map_err(|source| ViewError::Listen { port, source })?;
    Ok(Player { address, stopping, server: Some(server) })
}

/// Starts all threads that there ever are: one that takes up connections, one that waits for their requests, and those that
/// answer. Each ends when the one before it has ended.
fn start(listener: TcpListener, caches: Caches, stopping: Arc<AtomicBool>) -> io::Result<JoinHandle<()>> {
    let named = |name: &str| thread::Builder::new().name(format!("player {name}"));
    let ((connect, connections), (ask, asked)) = (sync_channel(QUEUE), sync_channel(QUEUE));
    let (caches, asked) = (Arc::new(caches), Arc::new(Mutex::new(asked)));
    for _ in 0..WORKERS {
        let (caches, asked) = (Arc::clone(&caches), Arc::clone(&asked));
        named("answers").spawn(move || work(&asked, &caches))?;
    }
    named("requests").spawn(move || arrive(&connections, &ask))?;
    named("connections").spawn(move || accept(&listener, &connect, &stopping))
}

impl Player {
    /// Address and port that the server listens on.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// What to open in a browser.
    pub fn url(&self) -> String {
        format!("http://{}/", self.address)
    }

    /// Serves until the process ends.
    pub fn wait(mut self) {
        if let Some(server) = self.server.take() {
            // A server that panicked has already said why; there is nothing left to wait for.
            let _ = server.join();
        }
    }

    /// Stops listening. Answers that are under way are finished.
    pub fn stop(self) {
        drop(self);
    }
}

impl Drop for Player {
    fn drop(&mut self) {
        let Some(server) = self.server.take() else { return };
        self.stopping.store(true, Ordering::SeqCst);
        // The server sleeps in `accept`: a visit wakes it.
        if TcpStream::connect(self.address).is_ok() {
            let _ = server.join();
        }
    }
}

fn check_is_file(path: &Path) -> io::Result<()> {
    match std::fs::File::open(path)?.metadata()?.is_file() {
        true => Ok(()),
        false => Err(io::Error::new(io::ErrorKind::IsADirectory, "not a file")),
    }
}

fn accept(listener: &TcpListener, connect: &SyncSender<TcpStream>, stopping: &AtomicBool) {
    for connection in listener.incoming() {
        if stopping.load(Ordering::SeqCst) {
            return;
        }
        match connection {
            Ok(connection) => drop(connect.send(connection)),
            // Out of file handles, say: wait for some to be given back.
            Err(_) => thread::sleep(Duration::from_millis(50)),
        }
    }
}

/// Answers one request after another.
fn work(asked: &Mutex<Receiver<Asked>>, caches: &Caches) {
    loop {
        let next = asked.lock().unwrap_or_else(PoisonError::into_inner).recv();
        let Ok(asked) = next else { return };
        // A browser that hangs up early is no trouble of ours.
        drop(answer(&asked, caches));
    }
}

fn answer((connection, request): &Asked, caches: &Caches) -> io::Result<()> {
    let mut to = BufWriter::new(Deadline::new(connection, PATIENCE));
    match request {
        Some(request) => response::answer(request, caches, &mut to)?,
        None => response::refuse_nonsense(&mut to)?,
    }
    to.flush()
}
