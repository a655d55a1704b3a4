//! The two ends of a connection: requests are read without blocking, so that a silent client occupies no thread, and
//! responses are written with a deadline for the whole response.

use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender};
use std::time::{Duration, Instant};

use super::request::{MAX_LENGTH, Request};

/// Time in which a request must be complete.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(10);
/// Connections that may wait for their requests; beyond it the oldest is closed.
const MAX_PENDING: usize = 256;
/// Interval at which pending connections are polled.
const POLL_INTERVAL: Duration = Duration::from_millis(2);

/// A connection with its request; `None` if the bytes are not a request.
pub(super) type Incoming = (TcpStream, Option<Request>);

/// Accepts connections and sends each with its request, until `connections` closes.
pub(super) fn read_requests(connections: &Receiver<TcpStream>, requests: &SyncSender<Incoming>) {
    let mut pending: Vec<PendingConnection> = Vec::new();
    loop {
        let next = match pending.is_empty() {
            true => connections.recv().map_err(|_| RecvTimeoutError::Disconnected),
            false => connections.recv_timeout(POLL_INTERVAL),
        };
        match next.map(PendingConnection::new) {
            Ok(Ok(connection)) => pending.push(connection),
            Ok(Err(_)) | Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return,
        }
        if pending.len() > MAX_PENDING {
            pending.remove(0);
        }
        pending = pending.into_iter().filter_map(|one| one.poll(REQUEST_TIMEOUT, requests)).collect();
    }
}

/// A connection, and the bytes of its request so far.
struct PendingConnection {
    stream: TcpStream,
    head: Vec<u8>,
    begin: Instant,
}

impl PendingConnection {
    fn new(stream: TcpStream) -> io::Result<Self> {
        stream.set_nonblocking(true)?;
        Ok(Self { stream, head: Vec::new(), begin: Instant::now() })
    }

    /// Reads the available bytes; returns the connection if the request is incomplete and in time.
    fn poll(mut self, timeout: Duration, requests: &SyncSender<Incoming>) -> Option<Self> {
        let mut bytes = [0; 4096];
        loop {
            match self.stream.read(&mut bytes) {
                Ok(0) => return None,
                Ok(count) => self.head.extend_from_slice(&bytes[..count]),
                Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => return None,
            }
            if self.is_complete() {
                self.dispatch(requests);
                return None;
            }
        }
        (self.begin.elapsed() < timeout).then_some(self)
    }

    fn is_complete(&self) -> bool {
        let contains = |mark: &[u8]| self.head.windows(mark.len()).any(|bytes| bytes == mark);
        contains(b"\r\n\r\n") || contains(b"\n\n") || self.head.len() as u64 > MAX_LENGTH
    }

    /// Sends the connection with its request. It is closed if the queue is full.
    fn dispatch(self, requests: &SyncSender<Incoming>) {
        let request = Request::read(&mut self.head.as_slice()).ok().flatten();
        if self.stream.set_nonblocking(false).is_ok() {
            drop(requests.try_send((self.stream, request)));
        }
    }
}

/// A writer to a connection that fails at a deadline, however the writes are divided.
pub(super) struct DeadlineWriter<'a> {
    stream: &'a TcpStream,
    end: Instant,
}

impl<'a> DeadlineWriter<'a> {
    /// A writer that fails once `timeout` has passed from now.
    pub fn new(stream: &'a TcpStream, timeout: Duration) -> Self {
        Self { stream, end: Instant::now() + timeout }
    }
}

impl Write for DeadlineWriter<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let left = self.end.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        self.stream.set_write_timeout(Some(left))?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;
    use std::sync::mpsc::sync_channel;
    use std::thread::sleep;

    use super::*;

    /// Client and server end of a connection.
    fn connection() -> (TcpStream, TcpStream) {
        let listener = TcpListener::bind(("127.0.0.1", 0)).unwrap();
        let client = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        (client, listener.accept().unwrap().0)
    }

    #[test]
    fn a_request_times_out_however_slowly_its_bytes_arrive() {
        let (requests, received) = sync_channel(1);
        let (mut client, server) = connection();
        let (mut pending, begin) = (Some(PendingConnection::new(server).unwrap()), Instant::now());
        while let Some(connection) = pending {
            assert!(begin.elapsed() < Duration::from_secs(20), "the request never times out");
            client.write_all(b"G").unwrap();
            sleep(Duration::from_millis(5));
            pending = connection.poll(Duration::from_millis(50), &requests);
        }
        assert!(received.try_recv().is_err());
    }

    #[test]
    fn a_request_may_arrive_in_parts() {
        let (requests, received) = sync_channel(1);
        let (mut client, server) = connection();
        let mut pending = Some(PendingConnection::new(server).unwrap());
        for part in ["GET / HT", "TP/1.1\r\n", "\r\n"] {
            client.write_all(part.as_bytes()).unwrap();
            sleep(Duration::from_millis(20));
            pending = pending.and_then(|connection| connection.poll(REQUEST_TIMEOUT, &requests));
        }
        assert!(pending.is_none());
        assert_eq!(received.recv().unwrap().1.unwrap().path, "/");
    }

    #[test]
    fn a_client_that_reads_slowly_does_not_extend_the_deadline() {
        let (mut slow, server) = connection();
        let mut writer = DeadlineWriter::new(&server, Duration::from_millis(100));
        let (begin, block) = (Instant::now(), vec![0; 1 << 20]);
        let mut written = writer.write_all(&[0]);
        while written.is_ok() {
            assert!(begin.elapsed() < Duration::from_secs(20), "the write never times out");
            slow.read_exact(&mut [0]).unwrap();
            written = writer.write_all(&block);
        }
        assert_ne!(written.unwrap_err().kind(), ErrorKind::BrokenPipe);
    }
}
