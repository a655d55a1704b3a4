//! Writing with a deadline for all of it, not for each write.

use std::io::{self, ErrorKind, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// A connection that can be written to until a deadline.
pub(super) struct Deadline<'a> {
    stream: &'a TcpStream,
    end: Instant,
}

impl<'a> Deadline<'a> {
    pub fn new(stream: &'a TcpStream, patience: Duration) -> Self {
        Self { stream, end: Instant::now() + patience }
    }
}

impl Write for Deadline<'_> {
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
    use std::io::Read;
    use std::net::TcpListener;

    use super::*;

    #[test]
    fn a_reader_that_takes_a_byte_now_and_then_does_not_put_off_the_deadline() {
        let listener = TcpListener::bind(("127.0.0.1", 0)).unwrap();
        let mut slow = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let stream = listener.accept().unwrap().0;
        let mut to = Deadline::new(&stream, Duration::from_millis(100));
        let (begin, block) = (Instant::now(), vec![0; 1 << 20]);
        let mut written = to.write_all(&[0]);
        while written.is_ok() {
            assert!(begin.elapsed() < Duration::from_secs(20), "it is never cut off");
            slow.read_exact(&mut [0]).unwrap();
            written = to.write_all(&block);
        }
        assert_ne!(written.unwrap_err().kind(), ErrorKind::BrokenPipe);
    }
}
