//! The text of a file: read, recognised and decoded.

use std::path::{Path, PathBuf};

use encoding_rs::Encoding;

/// Largest file that is read, in bytes. Places in a file are 32 bit numbers.
const MAX_BYTES: u64 = 2 << 30;

/// Reasons why a file cannot be imported at all.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImportError {
    /// The file cannot be read.
    #[error("cannot read `{}`: {source}", file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// It is a folder, a device or a pipe.
    #[error("`{}` is not a file", file.display())]
    NoFile {
        /// The path.
        file: PathBuf,
    },
    /// Maya's binary format.
    #[error(
        "`{}` is a Maya binary file, whose format is not public; in Maya, save it as Maya ASCII (.ma)",
        file.display()
    )]
    Binary {
        /// The file.
        file: PathBuf,
    },
    /// Nothing in the file is a statement of Maya.
    #[error("`{}` is not Maya ASCII: line {line}, column {column} is no statement of Maya", file.display())]
    NotMaya {
        /// The file.
        file: PathBuf,
        /// The line from 1.
        line: usize,
        /// The column from 1, in characters.
        column: usize,
    },
    /// The file is larger than a place in it can be numbered.
    #[error("`{}` has {bytes} bytes; files of up to 2 GiB are read", file.display())]
    TooLarge {
        /// The file.
        file: PathBuf,
        /// Its size.
        bytes: u64,
    },
    /// A preset, or the description of a cache, has another form.
    #[error("`{}`, line {line}: {message}", file.display())]
    Malformed {
        /// The file.
        file: PathBuf,
        /// The line from 1.
        line: usize,
        /// The mistake.
        message: String,
    },
    /// The scene that a file gives is refused by the graph.
    #[error("`{}`: {message}", file.display())]
    Refused {
        /// The file.
        file: PathBuf,
        /// Why.
        message: String,
    },
}

/// A place in one of the files of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    /// The number of the file.
    pub file: u16,
    /// The first byte.
    pub start: u32,
    /// One after the last byte.
    pub end: u32,
}

/// The text of a file.
#[derive(Debug)]
pub struct SourceText {
    /// The path as given.
    pub path: PathBuf,
    /// The text in UTF-8.
    pub text: String,
}

impl SourceText {
    /// Reads a file, and decodes it by the codeset that its head names.
    ///
    /// # Errors
    /// When it cannot be read, or is no text of Maya.
    pub fn read(path: &Path) -> Result<Self, ImportError> {
        let file = || path.to_owned();
        let io = |source| ImportError::Io { file: file(), source };
        let about = std::fs::metadata(path).map_err(io)?;
        // A device or a pipe may have no end.
        if !about.is_file() {
            return Err(ImportError::NoFile { file: file() });
        }
        if about.len() > MAX_BYTES {
            return Err(ImportError::TooLarge { file: file(), bytes: about.len() });
        }
        Self::from_bytes(path, std::fs::read(path).map_err(io)?)
    }

    /// The text of these bytes.
    ///
    /// # Errors
    /// When they are no text of Maya.
    pub fn from_bytes(path: &Path, bytes: Vec<u8>) -> Result<Self, ImportError> {
        if [&b"FOR4"[..], b"FOR8", b"\x89MB"].iter().any(|head| bytes.starts_with(head)) {
            return Err(ImportError::Binary { file: path.to_owned() });
        }
        let bytes = match String::from_utf8(bytes) {
            Ok(text) => return Ok(Self { path: path.to_owned(), text }),
            Err(other) => other.into_bytes(),
        };
        let (text, _, _) = codeset(&bytes).decode(&bytes);
        Ok(Self { path: path.to_owned(), text: text.into_owned() })
    }

    /// The line and the column of a byte, both from 1; the column counts characters.
    pub fn place(&self, byte: usize) -> (usize, usize) {
        let mut byte = byte.min(self.text.len());
        while !self.text.is_char_boundary(byte) {
            byte -= 1;
        }
        let before = &self.text[..byte];
        let line = before.bytes().filter(|b| *b == b'\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |line| line.chars().count()) + 1;
        (line, column)
    }
}

/// The codeset in the head of a file (`//Codeset: 932`), a Windows code page or a name. Windows 1252 if there is none.
fn codeset(bytes: &[u8]) -> &'static Encoding {
    const KEY: &[u8] = b"Codeset:";
    let head = &bytes[..bytes.len().min(4096)];
    let named = head.windows(KEY.len()).position(|window| window == KEY).map(|at| {
        let rest = &head[at + KEY.len()..];
        let end = rest.iter().position(|b| *b == b'\n' || *b == b'\r').unwrap_or(rest.len());
        String::from_utf8_lossy(&rest[..end]).trim().to_owned()
    });
    let Some(name) = named else { return encoding_rs::WINDOWS_1252 };
    let label = match name.as_str() {
        "932" => "shift_jis".to_owned(),
        "936" => "gbk".to_owned(),
        "949" => "euc-kr".to_owned(),
        "950" => "big5".to_owned(),
        page if page.bytes().all(|b| b.is_ascii_digit()) => format!("windows-{page}"),
        name => name.to_owned(),
    };
    Encoding::for_label(label.as_bytes()).unwrap_or(encoding_rs::WINDOWS_1252)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<SourceText, ImportError> {
        SourceText::from_bytes(Path::new("a.ma"), bytes.to_vec())
    }

    #[test]
    fn every_codeset_of_maya_is_decoded() {
        let scene = |codeset: &str, word: &[u8]| {
            let head = format!("//Maya ASCII 2016 scene\n//Codeset: {codeset}\ncreateNode transform -n \"");
            [head.as_bytes(), word, b"\";"].concat()
        };
        for (name, word, expected) in [
            ("1252", &b"caf\xe9"[..], "café"),
            ("ISO-8859-1", b"caf\xe9", "café"),
            ("UTF-8", "café".as_bytes(), "café"),
            // The second byte of this character is a backslash.
            ("932", b"\x95\x5c", "表"),
            ("936", b"\xb2\xbc", "布"),
            ("950", b"\xa5\xac", "布"),
            ("unheard of", b"caf\xe9", "café"),
        ] {
            let text = read(&scene(name, word)).unwrap().text;
            assert!(text.contains(&format!("-n \"{expected}\"")), "{name}: {text}");
        }
    }

    #[test]
    fn a_binary_file_is_named_as_such() {
        for head in [&b"FOR4\0\0\0\x10Maya"[..], b"FOR8\0\0\0\0"] {
            let error = read(head).unwrap_err().to_string();
            assert!(error.contains("Maya binary") && error.contains("save it as Maya ASCII"), "{error}");
        }
    }

    #[test]
    fn a_place_is_a_line_and_a_column_in_characters() {
        let text = read("a\né;b".as_bytes()).unwrap();
        assert_eq!(text.place(0), (1, 1));
        assert_eq!(text.place(5), (2, 3));
        assert_eq!(text.place(3), (2, 1), "inside a character");
        assert_eq!(text.place(99), (2, 4));
    }
}
