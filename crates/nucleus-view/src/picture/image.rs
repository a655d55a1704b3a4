//! A picture in memory, and its encoding as PNG.

use std::io::{BufWriter, Cursor, Write};
use std::num::NonZero;
use std::path::Path;
use std::thread;

use exr::prelude::{
    Compression, Encoding, Layer, LayerAttributes, SpecificChannels, Vec2, WritableImage, f16,
};
use nucleus_cache::atomic_file::AtomicFile;

use super::scene::Vec3;
use crate::error::ViewError;

/// A picture of 8 bits per channel, row by row from the top left; with linear colours if the style asks for them.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    /// Red, green and blue of each pixel.
    bytes: Vec<u8>,
    /// Opacity of each pixel; empty if all are opaque.
    alpha: Vec<u8>,
    /// Linear red, green and blue of each pixel, not multiplied by its opacity, and the opacity; empty unless they were
    /// asked for.
    linear: Vec<[f32; 4]>,
}

impl Image {
    /// Largest width and height, in pixels.
    pub const LARGEST_SIDE: u32 = 8192;

    pub(super) fn new(width: u32, height: u32) -> Self {
        let bytes = vec![0; 3 * width as usize * height as usize];
        Self { width, height, bytes, alpha: Vec::new(), linear: Vec::new() }
    }

    /// Opacity of every pixel, row by row from the top left; empty if all are opaque.
    pub fn alpha(&self) -> &[u8] {
        &self.alpha
    }

    /// Linear colour of every pixel, not multiplied by its opacity, and the opacity; empty unless the style keeps them.
    pub fn linear(&self) -> &[[f32; 4]] {
        &self.linear
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
        self.write_compressed(path.as_ref(), png::Compression::Balanced)
    }

    /// Writes the picture as a larger PNG file in less time, for sequences.
    ///
    /// # Errors
    /// As [`Image::write_png`].
    pub fn write_png_fast(&self, path: impl AsRef<Path>) -> Result<(), ViewError> {
        self.write_compressed(path.as_ref(), png::Compression::Fast)
    }

    fn write_compressed(&self, path: &Path, compression: png::Compression) -> Result<(), ViewError> {
        let create = |source| ViewError::Create { path: path.into(), source };
        let mut file = AtomicFile::create(path).map_err(create)?;
        let encoded = self.encode(BufWriter::new(&mut file), compression);
        encoded.map_err(|source| ViewError::encode(path, source))?;
        file.commit().map_err(create)
    }

    /// Writes the picture as an OpenEXR file of 16-bit floats: linear colours, multiplied by their opacity, with the
    /// primaries of BT.709. The file gets its name when it is complete.
    ///
    /// # Errors
    /// If the picture has no linear colours, or the file cannot be created or written.
    pub fn write_exr(&self, path: impl AsRef<Path>) -> Result<(), ViewError> {
        let path = path.as_ref();
        if self.linear.is_empty() {
            return Err(ViewError::NoLinearColours { path: path.into() });
        }
        let mut bytes = Cursor::new(Vec::new());
        let width = self.width as usize;
        let pixel = |at: Vec2<usize>| {
            let [red, green, blue, alpha] = self.linear[at.y() * width + at.x()];
            let [red, green, blue] = [red, green, blue].map(|x| f16::from_f32(x * alpha));
            (red, green, blue, f16::from_f32(alpha))
        };
        let size = (width, self.height as usize);
        let channels = SpecificChannels::rgba(pixel);
        let encoding = Encoding { compression: Compression::ZIP16, ..Encoding::SMALL_LOSSLESS };
        let layer = Layer::new(size, LayerAttributes::default(), encoding, channels);
        let written = exr::prelude::Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes);
        written.map_err(|source| ViewError::Exr { path: path.into(), source })?;
        let create = |source| ViewError::Create { path: path.into(), source };
        let mut file = AtomicFile::create(path).map_err(create)?;
        file.write_all(bytes.get_ref()).map_err(create)?;
        file.commit().map_err(create)
    }

    /// The picture as the bytes of a PNG file.
    ///
    /// # Errors
    /// If the encoder fails.
    pub fn to_png(&self) -> Result<Vec<u8>, ViewError> {
        let mut bytes = Vec::new();
        let encoded = self.encode(&mut bytes, png::Compression::Balanced);
        encoded.map_err(|source| ViewError::encode("a picture in memory", source))?;
        Ok(bytes)
    }

    fn encode(&self, to: impl Write, compression: png::Compression) -> Result<(), png::EncodingError> {
        let mut encoder = png::Encoder::new(to, self.width, self.height);
        encoder.set_compression(compression);
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
        if let Some([red, green, blue, alpha]) = self.linear.get_mut(first / 3) {
            let mixed = Vec3::new(*red, *green, *blue).lerp(linear, share);
            [*red, *green, *blue] = mixed.into();
            *alpha = alpha.max(share);
        }
    }

    /// Sets every pixel to `colour(column, row)`: a linear colour and its opacity, 0 to 1. Rows are divided among all
    /// cores; the result does not depend on their number, because pixels are independent.
    pub(super) fn fill_rows(
        &mut self,
        has_alpha: bool,
        keeps_linear: bool,
        colour: impl Fn(u32, u32) -> (Vec3, f32) + Sync,
    ) {
        let cores = thread::available_parallelism().map_or(1, NonZero::get);
        let (width, pixels) = (self.width as usize, self.bytes.len() / 3);
        self.alpha = vec![255; if has_alpha { pixels } else { 0 }];
        self.linear = vec![[0.0; 4]; if keeps_linear { pixels } else { 0 }];
        // More bands than cores, because bands of background take less time.
        let band_rows = (self.height as usize).div_ceil(4 * cores);
        let colour = &colour;
        let mut alphas = self.alpha.chunks_mut(band_rows * width);
        let mut linears = self.linear.chunks_mut(band_rows * width);
        thread::scope(|scope| {
            for (band, bytes) in self.bytes.chunks_mut(band_rows * 3 * width).enumerate() {
                let (alpha, linear) = (alphas.next(), linears.next());
                scope.spawn(move || {
                    let (mut alpha, mut linear) = (alpha.into_iter().flatten(), linear.into_iter().flatten());
                    for (place, pixel) in bytes.chunks_exact_mut(3).enumerate() {
                        let (row, column) = (band * band_rows + place / width, place % width);
                        let (shaded, opacity) = colour(column as u32, row as u32);
                        pixel.copy_from_slice(&encoded(&shaded));
                        if let Some(alpha) = alpha.next() {
                            *alpha = (opacity.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
                        }
                        if let Some(linear) = linear.next() {
                            *linear = [shaded.x, shaded.y, shaded.z, opacity];
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
