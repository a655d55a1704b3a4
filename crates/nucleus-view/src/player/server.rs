//! The server of the player. It listens on the loopback address only.

use std::io::{self, BufWriter, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::connection::{DeadlineWriter, Incoming, read_requests};
use super::live::LiveRun;
use super::response::{self, Caches, Shown};
use crate::error::ViewError;

/// Time in which a client must have read a response. At 10 MB/s that is 600 MB, and the page requests single frames.
const RESPONSE_TIMEOUT: Duration = Duration::from_secs(60);
/// Threads that respond. A browser opens up to six connections.
const WORKERS: usize = 8;
/// Length of the queues of connections and of requests.
const QUEUE: usize = 64;

/// A running server of the player. Dropping it stops the server.
#[derive(Debug)]
pub struct Player {
    address: SocketAddr,
    stopping: Arc<AtomicBool>,
    server: Option<JoinHandle<()>>,
}

/// Serves the player with the cache at `path`, on 127.0.0.1 and the given port, or any free port if it is 0.
///
/// # Errors
/// If the cache cannot be read or the port is taken. The content of the file is checked by the page.
pub fn serve(path: impl AsRef<Path>, port: u16) -> Result<Player, ViewError> {
    serve_files(path.as_ref(), None, port)
}

/// Serves the player with a scene that is solved again whenever it changes. The page shows frames as they are solved.
///
/// # Errors
/// If the port is taken.
pub fn serve_live(run: &LiveRun, port: u16) -> Result<Player, ViewError> {
    serve_caches(Caches { shown: Shown::Live(run.clone()), other: None }, port)
}

/// Serves the player with two caches for comparison, otherwise like [`serve`].
///
/// # Errors
/// As [`serve`].
pub fn serve_both(path: impl AsRef<Path>, other: impl AsRef<Path>, port: u16) -> Result<Player, ViewError> {
    serve_files(path.as_ref(), Some(other.as_ref()), port)
}

fn serve_files(path: &Path, other: Option<&Path>, port: u16) -> Result<Player, ViewError> {
    for path in [Some(path), other].into_iter().flatten() {
        check_is_file(path).map_err(|source| ViewError::Open { path: path.to_path_buf(), source })?;
    }
    let shown = Shown::File(path.to_path_buf());
    serve_caches(Caches { shown, other: other.map(Path::to_path_buf) }, port)
}

fn serve_caches(caches: Caches, port: u16) -> Result<Player, ViewError> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port));
    let listener = listener.map_err(|source| ViewError::Listen { port, source })?;
    let address = listener.local_addr().map_err(|source| ViewError::Listen { port, source })?;
    let stopping = Arc::new(AtomicBool::new(false));
    let stop = Arc::clone(&stopping);
    let server = start(listener, caches, stop).map_err(|source| ViewError::Listen { port, source })?;
    Ok(Player { address, stopping, server: Some(server) })
}

/// Starts all threads: one accepts connections, one reads their requests, the workers respond. Each ends after the one
/// before it.
fn start(listener: TcpListener, caches: Caches, stopping: Arc<AtomicBool>) -> io::Result<JoinHandle<()>> {
    let named = |name: &str| thread::Builder::new().name(format!("player {name}"));
    let ((connect, connections), (send, requests)) = (sync_channel(QUEUE), sync_channel(QUEUE));
    let (caches, requests) = (Arc::new(caches), Arc::new(Mutex::new(requests)));
    for _ in 0..WORKERS {
        let (caches, requests) = (Arc::clone(&caches), Arc::clone(&requests));
        named("responses").spawn(move || work(&requests, &caches))?;
    }
    named("requests").spawn(move || read_requests(&connections, &send))?;
    named("connections").spawn(move || accept(&listener, &connect, &stopping))
}

impl Player {
    /// Address and port that the server listens on.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// The address to open in a browser.
    pub fn url(&self) -> String {
        format!("http://{}/", self.address)
    }

    /// Serves until the process ends.
    pub fn wait(mut self) {
        if let Some(server) = self.server.take() {
            // A server that panicked has printed its message.
            let _ = server.join();
        }
    }

    /// Stops listening. Responses in progress are finished.
    pub fn stop(self) {
        drop(self);
    }
}

impl Drop for Player {
    fn drop(&mut self) {
        let Some(server) = self.server.take() else { return };
        self.stopping.store(true, Ordering::SeqCst);
        // The server blocks in `accept`; a connection wakes it.
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
            // Such as a lack of file handles: wait until some are free.
            Err(_) => thread::sleep(Duration::from_millis(50)),
        }
    }
}

/// Responds to one request after another.
fn work(requests: &Mutex<Receiver<Incoming>>, caches: &Caches) {
    loop {
        let next = requests.lock().unwrap_or_else(PoisonError::into_inner).recv();
        let Ok(incoming) = next else { return };
        // An error means that the client has closed the connection.
        drop(respond(&incoming, caches));
    }
}

fn respond((connection, request): &Incoming, caches: &Caches) -> io::Result<()> {
    let mut to = BufWriter::new(DeadlineWriter::new(connection, RESPONSE_TIMEOUT));
    match request {
        Some(request) => response::respond(request, caches, &mut to)?,
        None => response::refuse_malformed(&mut to)?,
    }
    to.flush()
}
