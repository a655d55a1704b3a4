//! A picture in memory, and its encoding as PNG.

use std::io::BufWriter;
use std::num::NonZero;
use std::path::Path;
use std::thread;

use nucleus_cache::atomic_file::AtomicFile;

use super::scene::Vec3;
use crate::error::ViewError;

/// A picture of 8 bits per channel, row by row from the top left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    width: u32,
    height: u32,
    /// Red, green and blue of each pixel.
    bytes: Vec<u8>,
    /// Opacity of each pixel; empty if all are opaque.
    alpha: Vec<u8>,
}

impl Image {
    /// Largest width and height, in pixels.
    pub const LARGEST_SIDE: u32 = 8192;

    pub(super) fn new(width: u32, height: u32) -> Self {
        Self { width, height, bytes: vec![0; 3 * width as usize * height as usize], alpha: Vec::new() }
    }

    /// Opacity of every pixel, row by row from the top left; empty if all are opaque.
    pub fn alpha(&self) -> &[u8] {
        &self.alpha
    }

    /// Width and height, in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// Red, green and blue of every pixel, row by row from the top left.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Red, green and blue of one pixel; black outside the picture.
    pub fn pixel(&self, column: u32, row: u32) -> [u8; 3] {
        if column >= self.width || row >= self.height {
            return [0; 3];
        }
        let first = self.index(column, row);
        [self.bytes[first], self.bytes[first + 1], self.bytes[first + 2]]
    }

    /// Writes the picture as a PNG file, which gets its name when it is complete.
    ///
    /// # Errors
    /// If the file cannot be created or written.
    pub fn write_png(&self, path: impl AsRef<Path>) -> Result<(), ViewError> {
        let path = path.as_ref();
        let create = |source| ViewError::Create { path: path.into(), source };
        let mut file = AtomicFile::create(path).map_err(create)?;
        let encoded = self.encode(BufWriter::new(&mut file));
        encoded.map_err(|source| ViewError::Encode { path: path.into(), source })?;
        file.commit().map_err(create)
    }

    /// The picture as the bytes of a PNG file.
    ///
    /// # Errors
    /// If the encoder fails.
    pub fn to_png(&self) -> Result<Vec<u8>, ViewError> {
        let mut bytes = Vec::new();
        let encoded = self.encode(&mut bytes);
        encoded.map_err(|source| ViewError::Encode { path: "a picture in memory".into(), source })?;
        Ok(bytes)
    }

    fn encode(&self, to: impl std::io::Write) -> Result<(), png::EncodingError> {
        let mut encoder = png::Encoder::new(to, self.width, self.height);
        encoder.set_compression(png::Compression::High);
        if self.alpha.is_empty() {
            encoder.set_color(png::ColorType::Rgb);
            let mut writer = encoder.write_header()?;
            writer.write_image_data(&self.bytes)?;
            return writer.finish();
        }
        encoder.set_color(png::ColorType::Rgba);
        let pixels = self.bytes.chunks_exact(3).zip(&self.alpha);
        let all: Vec<u8> =
            pixels.flat_map(|(colour, alpha)| [colour[0], colour[1], colour[2], *alpha]).collect();
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&all)?;
        writer.finish()
    }

    /// Mixes a linear colour into a pixel inside the picture, by a share from 0 to 1.
    pub(super) fn blend(&mut self, column: u32, row: u32, linear: &Vec3, share: f32) {
        let first = self.index(column, row);
        let before = [0, 1, 2].map(|channel| f32::from(self.bytes[first + channel]) / 255.0);
        let mixed = Vec3::from(before.map(|x| x * x)).lerp(linear, share);
        self.bytes[first..first + 3].copy_from_slice(&encoded(&mixed));
        if let Some(alpha) = self.alpha.get_mut(first / 3) {
            *alpha = (*alpha).max((share * 255.0) as u8);
        }
    }

    /// Sets every pixel to `colour(column, row)`: a linear colour and its opacity, 0 to 1. Rows are divided among all
    /// cores; the result does not depend on their number, because pixels are independent.
    pub(super) fn fill_rows(&mut self, has_alpha: bool, colour: impl Fn(u32, u32) -> (Vec3, f32) + Sync) {
        let cores = thread::available_parallelism().map_or(1, NonZero::get);
        let width = self.width as usize;
        self.alpha = vec![255; if has_alpha { self.bytes.len() / 3 } else { 0 }];
        // More bands than cores, because bands of background take less time.
        let band_rows = (self.height as usize).div_ceil(4 * cores);
        let colour = &colour;
        let mut alphas = self.alpha.chunks_mut(band_rows * width);
        thread::scope(|scope| {
            for (band, bytes) in self.bytes.chunks_mut(band_rows * 3 * width).enumerate() {
                let alpha = alphas.next();
                scope.spawn(move || {
                    let mut alpha = alpha.into_iter().flatten();
                    for (place, pixel) in bytes.chunks_exact_mut(3).enumerate() {
                        let (row, column) = (band * band_rows + place / width, place % width);
                        let (linear, opacity) = colour(column as u32, row as u32);
                        pixel.copy_from_slice(&encoded(&linear));
                        if let Some(alpha) = alpha.next() {
                            *alpha = (opacity.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
                        }
                    }
                });
            }
        });
    }

    fn index(&self, column: u32, row: u32) -> usize {
        3 * (row as usize * self.width as usize + column as usize)
    }
}

/// A linear colour as bytes.
///
/// A square root replaces the sRGB curve: it differs by a few levels, and unlike a power it has the same bits on every
/// machine.
fn encoded(linear: &Vec3) -> [u8; 3] {
    [0, 1, 2].map(|channel| (linear[channel].clamp(0.0, 1.0).sqrt() * 255.0 + 0.5) as u8)
}
