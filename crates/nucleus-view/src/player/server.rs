//! Serves the player to browsers on this machine, and to no other.

use std::io::{self, BufReader, BufWriter, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::request::Request;
use super::response;
use crate::ViewError;

/// A browser that takes longer than this to ask or to listen has gone away.
const PATIENCE: Duration = Duration::from_secs(30);

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
    let server = thread::spawn(move || accept(&listener, &caches.into(), &stop));
    Ok(Player { address, stopping, server: Some(server) })
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

fn accept(listener: &TcpListener, caches: &Arc<Caches>, stopping: &AtomicBool) {
    for connection in listener.incoming() {
        if stopping.load(Ordering::SeqCst) {
            return;
        }
        match connection {
            Ok(connection) => {
                let caches = Arc::clone(caches);
                // A browser that hangs up early is no trouble of ours.
                thread::spawn(move || drop(converse(&connection, &caches)));
            }
            // Out of file handles, say: wait for some to be given back.
            Err(_) => thread::sleep(Duration::from_millis(50)),
        }
    }
}

fn converse(connection: &TcpStream, caches: &Caches) -> io::Result<()> {
    connection.set_read_timeout(Some(PATIENCE))?;
    connection.set_write_timeout(Some(PATIENCE))?;
    let mut to = BufWriter::new(connection);
    match Request::read(&mut BufReader::new(connection))? {
        Some(request) => response::answer(&request, caches, &mut to)?,
        None => response::refuse_nonsense(&mut to)?,
    }
    to.flush()
}
