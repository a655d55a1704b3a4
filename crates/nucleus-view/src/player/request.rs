//! The head of an HTTP request (RFC 9110), as far as this server uses it: method, path, host and byte range.

use std::io::{self, BufRead, Read};
use std::ops::Range;

/// Longest head that is accepted, in bytes; browsers send shorter ones.
pub(super) const MAX_LENGTH: u64 = 16 * 1024;

/// A request without its body.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Request {
    pub method: String,
    /// The path without its query, percent-encoded.
    pub path: String,
    /// The run that is meant, the number after `run=` in the query.
    pub run: Option<u32>,
    /// The value of the `Range` header.
    pub range: Option<String>,
    /// The value of the `Host` header.
    pub host: Option<String>,
}

impl Request {
    /// Reads a head; `None` if the bytes are not one.
    pub fn read(from: &mut impl BufRead) -> io::Result<Option<Self>> {
        let mut lines = from.take(MAX_LENGTH).lines();
        let Some(first) = lines.next().transpose()? else { return Ok(None) };
        let mut words = first.split(' ');
        let (Some(method), Some(target), Some(version)) = (words.next(), words.next(), words.next()) else {
            return Ok(None);
        };
        if !version.starts_with("HTTP/1.") {
            return Ok(None);
        }
        let (path, query) = target.split_once('?').unwrap_or((target, ""));
        let run = query.split('&').find_map(|one| one.strip_prefix("run=")?.parse().ok());
        let mut request = Self { method: method.into(), path: path.into(), run, range: None, host: None };
        for line in lines {
            let line = line?;
            if line.is_empty() {
                return Ok(Some(request));
            }
            request.take_header(&line);
        }
        Ok(None) // cut off before the empty line
    }

    fn take_header(&mut self, line: &str) {
        let Some((name, value)) = line.split_once(':') else { return };
        let value = Some(value.trim().to_owned());
        if name.eq_ignore_ascii_case("range") {
            self.range = value;
        } else if name.eq_ignore_ascii_case("host") {
            self.host = value;
        }
    }

    /// Whether the host is this machine. A foreign page whose name resolves to this machine (DNS rebinding) sends its own
    /// name, and must not read the cache.
    pub fn is_for_this_machine(&self) -> bool {
        let Some(host) = self.host.as_deref() else { return true };
        let name = host.rsplit_once(':').map_or(host, |(name, _)| name);
        matches!(name, "127.0.0.1" | "localhost")
    }
}

/// The bytes of a file that a `Range` header requests (RFC 9110, section 14).
#[derive(Debug, PartialEq, Eq)]
pub(super) enum ByteRange {
    /// The whole file: no range, or one that a server may ignore.
    Whole,
    /// These bytes.
    Part(Range<u64>),
    /// Bytes that the file does not have.
    Unsatisfiable,
}

impl ByteRange {
    /// Reads a `Range` header for a file of `length` bytes.
    pub fn parse(header: Option<&str>, length: u64) -> Self {
        let Some(header) = header.and_then(|header| header.trim().strip_prefix("bytes=")) else {
            return Self::Whole;
        };
        // Several ranges need a multipart response; a server may always send the whole file instead.
        let Some((first, last)) = header.trim().split_once('-').filter(|_| !header.contains(',')) else {
            return Self::Whole;
        };
        match (number(first), number(last)) {
            (Some(first), _) if last.is_empty() => Self::part(first, length, length),
            (Some(first), Some(last)) if first <= last => Self::part(first, last.saturating_add(1), length),
            (None, Some(count)) if first.is_empty() => Self::part(length - count.min(length), length, length),
            _ => Self::Whole,
        }
    }

    fn part(first: u64, end: u64, length: u64) -> Self {
        if first < end.min(length) { Self::Part(first..end.min(length)) } else { Self::Unsatisfiable }
    }
}

/// Reads digits only: `parse` would accept a sign. A number too large for 64 bits lies past the end of any file.
fn number(text: &str) -> Option<u64> {
    let digits = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    digits.then(|| text.parse().unwrap_or(u64::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<Request> {
        Request::read(&mut text.as_bytes()).unwrap()
    }

    #[test]
    fn a_head_is_read_up_to_its_empty_line() {
        let request =
            read("GET /a/b?c=d HTTP/1.1\r\nHost: localhost:80\r\nRANGE:  bytes=0-1 \r\n\r\nbody").unwrap();
        assert_eq!((request.method.as_str(), request.path.as_str()), ("GET", "/a/b"));
        assert_eq!(request.range.as_deref(), Some("bytes=0-1"));
        assert!(request.is_for_this_machine());
        assert!(!read("GET / HTTP/1.1\r\nHost: elsewhere.example\r\n\r\n").unwrap().is_for_this_machine());
    }

    #[test]
    fn bytes_that_are_no_head_are_refused() {
        for text in ["", "GET /\r\n\r\n", "GET / FTP/1\r\n\r\n", "GET / HTTP/1.1\r\nHost: a"] {
            assert_eq!(read(text), None, "{text:?}");
        }
        let endless = format!("GET / HTTP/1.1\r\nX: {}\r\n\r\n", "x".repeat(MAX_LENGTH as usize));
        assert_eq!(read(&endless), None);
    }

    #[test]
    fn ranges_are_read_as_in_the_standard() {
        for (header, expected) in [
            ("bytes=0-0", ByteRange::Part(0..1)),
            ("bytes=2-5", ByteRange::Part(2..6)),
            ("bytes=2-", ByteRange::Part(2..10)),
            ("bytes=-3", ByteRange::Part(7..10)),
            ("bytes=-30", ByteRange::Part(0..10)),
            ("bytes=8-99", ByteRange::Part(8..10)),
            ("bytes=0-99999999999999999999", ByteRange::Part(0..10)),
            ("bytes=10-", ByteRange::Unsatisfiable),
            ("bytes=-0", ByteRange::Unsatisfiable),
            ("bytes=99999999999999999999-", ByteRange::Unsatisfiable),
            ("bytes=5-2", ByteRange::Whole),
            ("bytes=-", ByteRange::Whole),
            ("bytes=+1-2", ByteRange::Whole),
            ("bytes=0-1,4-5", ByteRange::Whole),
            ("lines=1-2", ByteRange::Whole),
        ] {
            assert_eq!(ByteRange::parse(Some(header), 10), expected, "{header}");
        }
        assert_eq!(ByteRange::parse(None, 10), ByteRange::Whole);
    }

    #[test]
    fn an_empty_file_has_no_part() {
        for header in ["bytes=0-", "bytes=0-0", "bytes=-1"] {
            assert_eq!(ByteRange::parse(Some(header), 0), ByteRange::Unsatisfiable, "{header}");
        }
    }
}
