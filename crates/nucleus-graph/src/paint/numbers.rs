//! Text files of numbers: one per point, or three. Numbers are separated by spaces, commas or line ends. A `#` begins
//! a comment that ends with its line.

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::files::{self, LineSpan};

/// Reasons why a file is no list of numbers.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NumbersError {
    /// It cannot be read.
    #[error("cannot read `{}`: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// A word is not a finite number.
    #[error("`{}`, line {line}, {span}: not a finite number", path.display())]
    NotANumber {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The range in the line.
        span: LineSpan,
    },
    /// The count of numbers is no multiple of three.
    #[error("`{}` has {count} numbers, which is no multiple of three", path.display())]
    NotVectors {
        /// The file.
        path: PathBuf,
        /// The count of numbers.
        count: usize,
    },
}

/// All numbers of a file.
///
/// # Errors
/// When it cannot be read, or has a word that is no finite number; see [`NumbersError`].
pub fn read_numbers(path: &Path) -> Result<Vec<f64>, NumbersError> {
    let mut bytes = Vec::new();
    let read = files::open(path).and_then(|(mut file, _)| file.read_to_end(&mut bytes));
    read.map_err(|source| NumbersError::Unreadable { path: path.to_owned(), source })?;
    let text = String::from_utf8_lossy(&bytes);
    let mut numbers = Vec::new();
    for (line, whole) in text.lines().enumerate() {
        let content = whole.split('#').next().unwrap_or_default();
        let words = content.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
        for word in words {
            match word.parse::<f64>() {
                Ok(number) if number.is_finite() => numbers.push(number),
                _ => {
                    let span = LineSpan::of(word.as_bytes(), whole.as_bytes());
                    return Err(NumbersError::NotANumber { path: path.to_owned(), line: line + 1, span });
                }
            }
        }
    }
    Ok(numbers)
}

/// All vectors of a file.
///
/// # Errors
/// As [`read_numbers`], and when the count of numbers is no multiple of three.
pub fn read_vectors(path: &Path) -> Result<Vec<[f64; 3]>, NumbersError> {
    let numbers = read_numbers(path)?;
    let (vectors, rest) = numbers.as_chunks::<3>();
    match rest {
        [] => Ok(vectors.to_vec()),
        _ => Err(NumbersError::NotVectors { path: path.to_owned(), count: numbers.len() }),
    }
}
