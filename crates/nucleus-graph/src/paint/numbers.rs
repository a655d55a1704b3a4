//! Files of numbers: one for each point, or three. Between numbers are spaces, commas or line ends; what follows a
//! `#` on a line is a remark.

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::files::{self, Piece};

/// Why a file is not a list of numbers.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NumbersError {
    /// It cannot be read.
    #[error("cannot read `{}`: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// Something in it is no number that can be reckoned with.
    #[error("`{}`, line {line}, {piece}: not a finite number", path.display())]
    NotANumber {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// Where in the line.
        piece: Piece,
    },
    /// Not all vectors have three numbers.
    #[error("`{}` has {count} numbers, which are no vectors of three", path.display())]
    NotVectors {
        /// The file.
        path: PathBuf,
        /// How many numbers it has.
        count: usize,
    },
}

/// All numbers of a file.
///
/// # Errors
/// When it cannot be read, or holds anything else; see [`NumbersError`].
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
                    let piece = Piece::of(word.as_bytes(), whole.as_bytes());
                    return Err(NumbersError::NotANumber { path: path.to_owned(), line: line + 1, piece });
                }
            }
        }
    }
    Ok(numbers)
}

/// All vectors of a file.
///
/// # Errors
/// When it cannot be read, or does not hold three numbers for each; see [`NumbersError`].
pub fn read_vectors(path: &Path) -> Result<Vec<[f64; 3]>, NumbersError> {
    let numbers = read_numbers(path)?;
    let (vectors, rest) = numbers.as_chunks::<3>();
    match rest {
        [] => Ok(vectors.to_vec()),
        _ => Err(NumbersError::NotVectors { path: path.to_owned(), count: numbers.len() }),
    }
}
