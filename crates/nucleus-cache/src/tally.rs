//! Counts the bytes that have reached the file.

use std::io::{self, Seek, SeekFrom, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A writer that tells from outside how long its file has become.
pub(crate) struct Tally<W> {
    inner: W,
    position: u64,
    length: Arc<AtomicU64>,
}

impl<W> Tally<W> {
    /// Wraps `inner`, which is taken to be empty; the counter stays readable when the tally is gone.
    pub fn new(inner: W) -> (Self, Arc<AtomicU64>) {
        let length = Arc::new(AtomicU64::new(0));
        (Self { inner, position: 0, length: length.clone() }, length)
    }
}

impl<W: Write> Write for Tally<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.position += written as u64;
        self.length.fetch_max(self.position, Ordering::Relaxed);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

impl<W: Seek> Seek for Tally<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.position = self.inner.seek(to)?;
        Ok(self.position)
    }
}
