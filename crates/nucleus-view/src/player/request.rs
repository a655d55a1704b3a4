//! The head of an HTTP request, as much of it as this server uses.

use std::io::{self, BufRead, Read};

/// A request longer than this is not from a browser.
pub(super) const LONGEST: u64 = 16 * 1024;

/// A request without its body.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Request {
    pub method: String,
    /// The path without what follows a question mark, still in its escapes.
    pub path: String,
    pub range: Option<String>,
    pub host: Option<String>,
}

impl Request {
    /// Reads a head; `None` if it is not one.
    pub fn read(from: &mut impl BufRead) -> io::Result<Option<Self>> {
        let mut lines = from.take(LONGEST).lines();
        let Some(first) = lines.next().transpose()? else { return Ok(None) };
        let mut words = first.split(' ');
        let (Some(method), Some(target), Some(version)) = (words.next(), words.next(), words.next()) else {
            return Ok(None);
        };
        if !version.starts_with("HTTP/1.") {
            return Ok(None);
        }
        let path = target.split('?').next().unwrap_or_default();
        let mut request = Self { method: method.into(), path: path.into(), range: None, host: None };
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

    /// Whether the page that asks was loaded from this machine. A page of a stranger whose name
    /// was made to lead here still sends that name, and must not read the cache.
    pub fn is_for_this_machine(&self) -> bool {
        let Some(host) = self.host.as_deref() else { return true };
        let name = host.rsplit_once(':').map_or(host, |(name, _)| name);
        matches!(name, "127.0.0.1" | "localhost")
    }
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
    fn what_is_no_head_is_refused() {
        for text in ["", "GET /\r\n\r\n", "GET / FTP/1\r\n\r\n", "GET / HTTP/1.1\r\nHost: a"] {
            assert_eq!(read(text), None, "{text:?}");
        }
        let endless = format!("GET / HTTP/1.1\r\nX: {}\r\n\r\n", "x".repeat(LONGEST as usize));
        assert_eq!(read(&endless), None);
    }
}
