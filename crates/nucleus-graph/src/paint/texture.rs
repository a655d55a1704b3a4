//! PNG textures as factors: 0 for black, 1 for white.
//!
//! The factor is the luminance of the stored colour (0.3 red, 0.59 green, 0.11 blue, as in Maya), without gamma
//! correction. Alpha is ignored. Sampling is bilinear between pixel centres, and a border pixel holds up to its border. As
//! in Maya, (0, 0) is the lower left corner, and the texture repeats outside 0 to 1.

use std::io::BufReader;
use std::path::{Path, PathBuf};

use crate::files;

/// A grey texture.
#[derive(Debug, Clone, PartialEq)]
pub struct Texture {
    size: [usize; 2],
    /// Row by row from the top, each 0 to 1.
    pixels: Vec<f32>,
}

/// Limit on pixels: a header of a few bytes can announce more than fit into memory.
const MAX_PIXELS: u64 = 1 << 26;

/// Reasons why a file is no texture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// It cannot be read.
    #[error("cannot read `{}`: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: std::io::Error,
    },
    /// It is no PNG, or a damaged one.
    #[error("`{}` is not a valid PNG: {source}", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// The error of the decoder.
        source: png::DecodingError,
    },
    /// It has too many pixels.
    #[error("`{}` has {columns} x {rows} pixels, more than the limit of {MAX_PIXELS}", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its width.
        columns: u32,
        /// Its height.
        rows: u32,
    },
}

impl Texture {
    /// Reads a PNG.
    ///
    /// # Errors
    /// When the file cannot be read, is no valid PNG, or is too large.
    pub fn read(path: &Path) -> Result<Self, TextureError> {
        let (file, _) =
            files::open(path).map_err(|source| TextureError::Unreadable { path: path.to_owned(), source })?;
        let broken = |source| TextureError::Broken { path: path.to_owned(), source };
        let mut decoder = png::Decoder::new(BufReader::new(file));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().map_err(broken)?;
        let (columns, rows) = reader.info().size();
        if u64::from(columns) * u64::from(rows) > MAX_PIXELS {
            return Err(TextureError::TooLarge { path: path.to_owned(), columns, rows });
        }
        let bytes = reader.output_buffer_size().ok_or(png::DecodingError::LimitsExceeded);
        let mut data = vec![0; bytes.map_err(broken)?];
        let info = reader.next_frame(&mut data).map_err(broken)?;
        // The chunks after the image show whether the file is complete.
        reader.finish().map_err(broken)?;
        let samples = info.color_type.samples();
        let pixels = match info.bit_depth {
            png::BitDepth::Sixteen => {
                let value = |pair: &[u8; 2]| f32::from(u16::from_be_bytes(*pair)) / 65535.0;
                let values: Vec<f32> = data.as_chunks::<2>().0.iter().map(value).collect();
                values.chunks_exact(samples).map(brightness).collect()
            }
            _ => {
                let values: Vec<f32> = data.iter().map(|byte| f32::from(*byte) / 255.0).collect();
                values.chunks_exact(samples).map(brightness).collect()
            }
        };
        Ok(Self { size: [info.width as usize, info.height as usize], pixels })
    }

    /// A texture of so many columns, with pixels row by row from the top.
    #[cfg(test)]
    pub(crate) fn of(columns: usize, pixels: Vec<f32>) -> Self {
        Self { size: [columns, pixels.len() / columns], pixels }
    }

    /// The value at texture coordinates.
    pub fn at(&self, [u, v]: [f64; 2]) -> f64 {
        let [columns, rows] = self.size;
        let place = |along: f64, count: usize| {
            // 1 is the far border and not the start of the next repetition.
            let within = if (0.0..=1.0).contains(&along) { along } else { along.rem_euclid(1.0) };
            // Opposite borders do not blend: what is painted at one would appear at the other.
            let at = (within * count as f64 - 0.5).clamp(0.0, (count - 1) as f64);
            let first = at as usize;
            (first, (first + 1).min(count - 1), at - first as f64)
        };
        let (left, right, across) = place(u, columns);
        let (upper, lower, down) = place(1.0 - v, rows);
        let pixel = |column: usize, row: usize| f64::from(self.pixels[row * columns + column]);
        let row = |row: usize| pixel(left, row) * (1.0 - across) + pixel(right, row) * across;
        row(upper) * (1.0 - down) + row(lower) * down
    }
}

/// Luminance of a pixel: grey, grey and alpha, RGB, or RGBA.
fn brightness(pixel: &[f32]) -> f32 {
    match pixel {
        [red, green, blue, ..] => 0.3 * red + 0.59 * green + 0.11 * blue,
        [grey, ..] => *grey,
        [] => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_centre_of_a_pixel_has_its_value_and_sampling_between_is_linear() {
        let texture = Texture::of(2, vec![0.0, 1.0, 0.25, 0.5]);
        // The upper row is at v = 3/4.
        assert_eq!(texture.at([0.25, 0.75]), 0.0);
        assert_eq!(texture.at([0.75, 0.75]), 1.0);
        assert_eq!(texture.at([0.25, 0.25]), 0.25);
        assert_eq!(texture.at([0.5, 0.75]), 0.5);
        assert_eq!(texture.at([0.25, 0.5]), 0.125);
    }

    #[test]
    fn a_texture_repeats() {
        let texture = Texture::of(2, vec![0.0, 1.0, 0.25, 0.5]);
        for whole in [-3.0, 1.0, 7.0] {
            assert_eq!(texture.at([0.25 + whole, 0.75 - whole]), texture.at([0.25, 0.75]));
        }
    }

    #[test]
    fn coordinates_on_a_border_sample_the_pixels_of_that_border() {
        let texture = Texture::of(2, vec![0.0, 1.0, 0.25, 0.5]);
        assert_eq!(
            [[0.0, 1.0], [1.0, 1.0], [0.0, 0.0], [1.0, 0.0]].map(|uv| texture.at(uv)),
            [0.0, 1.0, 0.25, 0.5]
        );
        assert_eq!([0.1, 0.9].map(|u| texture.at([u, 0.75])), [0.0, 1.0]);
        // A repetition begins with the first pixel.
        assert_eq!(texture.at([1.0 + 1e-9, 0.75]), 0.0);
    }

    #[test]
    fn coordinates_of_any_size_are_sampled() {
        let texture = Texture::of(1, vec![0.5]);
        for place in [1e300, -1e300, 0.0, 1.0, -1e-300] {
            assert_eq!(texture.at([place, place]), 0.5);
        }
    }
}
