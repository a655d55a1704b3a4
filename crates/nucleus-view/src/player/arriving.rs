//! Connections whose request has not arrived yet. They are read without waiting, so that a silent one holds no thread.

use std::io::{self, ErrorKind, Read};
use std::net::TcpStream;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender};
use std::time::{Duration, Instant};

use super::request::{LONGEST, Request};

/// A browser that takes longer than this to ask has gone away.
const PATIENCE: Duration = Duration::from_secs(10);
/// Connections that wait for their request at one time; the oldest gives way to the newest.
const MOST: usize = 256;
/// How often waiting connections are looked at.
const PERIOD: Duration = Duration::from_millis(2);

/// A connection with its request; nothing where what arrived is not one.
pub(super) type Asked = (TcpStream, Option<Request>);

/// Takes up connections and hands them on with their requests, until there are no more to come.
pub(super) fn arrive(connections: &Receiver<TcpStream>, asked: &SyncSender<Asked>) {
    let mut waiting: Vec<Arriving> = Vec::new();
    loop {
        let next = match waiting.is_empty() {
            true => connections.recv().map_err(|_| RecvTimeoutError::Disconnected),
            false => connections.recv_timeout(PERIOD),
        };
        match next.map(Arriving::new) {
            Ok(Ok(connection)) => waiting.push(connection),
            Ok(Err(_)) | Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return,
        }
        if waiting.len() > MOST {
            waiting.remove(0);
        }
        waiting = waiting.into_iter().filter_map(|connection| connection.read(PATIENCE, asked)).collect();
    }
}

/// A connection, and what has arrived of its request.
struct Arriving {
    stream: TcpStream,
    head: Vec<u8>,
    begin: Instant,
}

impl Arriving {
    fn new(stream: TcpStream) -> io::Result<Self> {
        stream.set_nonblocking(true)?;
        Ok(Self { stream, head: Vec::new(), begin: Instant::now() })
    }

    /// Reads what is there; gives the connection back if more has to come.
    fn read(mut self, patience: Duration, asked: &SyncSender<Asked>) -> Option<Self> {
        let mut bytes = [0; 4096];
        loop {
            match self.stream.read(&mut bytes) {
                Ok(0) => return None,
                Ok(count) => self.head.extend_from_slice(&bytes[..count]),
                Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => return None,
            }
            if self.is_whole() {
                self.hand_on(asked);
                return None;
            }
        }
        (self.begin.elapsed() < patience).then_some(self)
    }

    fn is_whole(&self) -> bool {
        let ends = |mark: &[u8]| self.head.windows(mark.len()).any(|bytes| bytes == mark);
        ends(b"\r\n\r\n") || ends(b"\n\n") || self.head.len() as u64 > LONGEST
    }

    /// Where all are busy and many wait already, the connection is closed.
    fn hand_on(self, asked: &SyncSender<Asked>) {
        let request = Request::read(&mut self.head.as_slice()).ok().flatten();
        if self.stream.set_nonblocking(false).is_ok() {
            drop(asked.try_send((self.stream, request)));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;
    use std::net::TcpListener;
    use std::sync::mpsc::sync_channel;
    use std::thread::sleep;

    use super::*;

    fn pair() -> (TcpStream, Arriving) {
        let listener = TcpListener::bind(("127.0.0.1", 0)).unwrap();
        let client = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        (client, Arriving::new(listener.accept().unwrap().0).unwrap())
    }

    #[test]
    fn a_request_has_a_deadline_however_many_bytes_drip_in() {
        let (asked, answers) = sync_channel(1);
        let (mut client, arriving) = pair();
        let (mut waiting, begin) = (Some(arriving), Instant::now());
        while let Some(connection) = waiting {
            assert!(begin.elapsed() < Duration::from_secs(20), "it is never cut off");
            client.write_all(b"G").unwrap();
            sleep(Duration::from_millis(5));
            waiting = connection.read(Duration::from_millis(50), &asked);
        }
        assert!(answers.try_recv().is_err());
    }

    #[test]
    fn a_request_may_arrive_in_parts() {
        let (asked, answers) = sync_channel(1);
        let (mut client, arriving) = pair();
        let mut waiting = Some(arriving);
        for part in ["GET / HT", "TP/1.1\r\n", "\r\n"] {
            client.write_all(part.as_bytes()).unwrap();
            sleep(Duration::from_millis(20));
            waiting = waiting.and_then(|connection| connection.read(PATIENCE, &asked));
        }
        assert!(waiting.is_none());
        assert_eq!(answers.recv().unwrap().1.unwrap().path, "/");
    }
}
