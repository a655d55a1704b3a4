//! Animations, written frame by frame: animated PNG and GIF.

use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

use nucleus_cache::atomic_file::AtomicFile;

use super::image::Image;
use crate::error::ViewError;

/// Writes an animated PNG that loops. The file gets its name at [`finish`](Self::finish).
///
/// Of each frame only the rectangle that differs from the frame before is stored.
pub struct AnimationWriter {
    file: AtomicFile,
    size: [u32; 2],
    encoder: png::Writer<BufWriter<File>>,
    last: Option<Image>,
    frames: u32,
}

/// Frame count in the header until the number of frames is known.
const UNKNOWN_COUNT: u32 = i32::MAX as u32;

impl AnimationWriter {
    /// Starts a file for frames of `size` pixels.
    ///
    /// # Errors
    /// If the file cannot be created.
    pub fn create(path: impl AsRef<Path>, size: [u32; 2]) -> Result<Self, ViewError> {
        let path = path.as_ref();
        let (file, handle) = open(path)?;
        let encoder =
            start(BufWriter::new(handle), size).map_err(|source| ViewError::encode(path, source))?;
        Ok(Self { file, size, encoder, last: None, frames: 0 })
    }

    /// Adds a frame that is shown for some seconds.
    ///
    /// # Errors
    /// If it has another size than the file, or cannot be written.
    pub fn push(&mut self, image: &Image, seconds: f64) -> Result<(), ViewError> {
        if image.size() != self.size {
            let (expected, found) = (self.size, image.size());
            return Err(ViewError::FrameSize { path: self.file.destination().into(), expected, found });
        }
        let changed =
            self.last.as_ref().map_or([0, 0, self.size[0], self.size[1]], |last| changed(last, image));
        self.write_part(image, changed, seconds)
            .map_err(|source| ViewError::encode(self.file.destination(), source))?;
        self.last = Some(image.clone());
        self.frames += 1;
        Ok(())
    }

    /// Completes the file.
    ///
    /// # Errors
    /// If it has no frame, or its end cannot be written.
    pub fn finish(self) -> Result<(), ViewError> {
        let Self { file, encoder, frames, .. } = self;
        let path = file.destination().to_owned();
        if frames == 0 {
            return Err(ViewError::NoFrame { path });
        }
        encoder.finish().map_err(|source| ViewError::encode(&path, source))?;
        let counted = file.handle().and_then(|handle| set_frame_count(handle, frames));
        counted.and_then(|()| file.commit()).map_err(|source| ViewError::Create { path, source })
    }

    fn write_part(&mut self, image: &Image, part: [u32; 4], seconds: f64) -> Result<(), png::EncodingError> {
        let [left, top, width, height] = part;
        if self.frames > 0 {
            self.encoder.reset_frame_position()?;
            self.encoder.set_frame_dimension(width, height)?;
            self.encoder.set_frame_position(left, top)?;
        }
        let (numerator, denominator) = delay(seconds);
        self.encoder.set_frame_delay(numerator, denominator)?;
        let row_bytes = 3 * self.size[0] as usize;
        let columns = 3 * left as usize..3 * (left + width) as usize;
        let rows = image.bytes().chunks_exact(row_bytes).skip(top as usize).take(height as usize);
        let bytes: Vec<u8> = rows.flat_map(|row| &row[columns.clone()]).copied().collect();
        self.encoder.write_image_data(&bytes)
    }
}

/// Creates a file, with a handle for its encoder.
fn open(path: &Path) -> Result<(AtomicFile, File), ViewError> {
    let create = || {
        let file = AtomicFile::create(path)?;
        let handle = file.handle()?;
        Ok((file, handle))
    };
    create().map_err(|source| ViewError::Create { path: path.into(), source })
}

fn start(
    file: BufWriter<File>,
    [width, height]: [u32; 2],
) -> Result<png::Writer<BufWriter<File>>, png::EncodingError> {
    let mut encoder = png::Encoder::new(file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_animated(UNKNOWN_COUNT, 0)?;
    encoder.write_header()
}

/// A duration in seconds as a fraction of two 16-bit numbers.
fn delay(seconds: f64) -> (u16, u16) {
    match seconds {
        // The rates of films are whole numbers of frames per minute.
        ..=1.0 => (60, (60.0 / seconds).clamp(60.0, 60_000.0).round() as u16),
        ..=65.0 => ((seconds * 1000.0).round() as u16, 1000),
        _ => (seconds.round() as u16, 1),
    }
}

/// Left, top, width and height of the rectangle that differs between two pictures of one size; one pixel if none does.
fn changed(before: &Image, after: &Image) -> [u32; 4] {
    let [width, height] = after.size();
    let differs = |row: u32, column: u32| before.pixel(column, row) != after.pixel(column, row);
    let row_differs = |row: &u32| {
        let bytes = 3 * width as usize * *row as usize..3 * width as usize * (*row as usize + 1);
        before.bytes()[bytes.clone()] != after.bytes()[bytes]
    };
    let Some(top) = (0..height).find(row_differs) else { return [0, 0, 1, 1] };
    let bottom = (0..height).rev().find(row_differs).unwrap_or(top);
    let (mut left, mut right) = (width - 1, 0);
    for row in top..=bottom {
        left = (0..left).find(|column| differs(row, *column)).unwrap_or(left);
        right = (right + 1..width).rev().find(|column| differs(row, *column)).unwrap_or(right);
    }
    [left, top, right.max(left) - left + 1, bottom - top + 1]
}

/// Writes the number of frames and its checksum into the animation chunk of the header.
fn set_frame_count(mut file: File, frames: u32) -> io::Result<()> {
    let mut head = Vec::new();
    file.seek(SeekFrom::Start(0))?;
    (&file).take(4096).read_to_end(&mut head)?;
    let missing = || io::Error::other("the animation chunk is missing");
    let name = head.windows(4).position(|name| name == b"acTL").ok_or_else(missing)?;
    let chunk = head.get_mut(name..name + 12).ok_or_else(missing)?;
    chunk[4..8].copy_from_slice(&frames.to_be_bytes());
    let sum = crc(chunk);
    file.seek(SeekFrom::Start(name as u64))?;
    file.write_all(chunk)?;
    file.write_all(&sum.to_be_bytes())
}

/// The checksum of a PNG chunk (ISO 3309), computed bit by bit because it covers twelve bytes only.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| sum >> 1 ^ if sum & 1 == 1 { 0xEDB8_8320 } else { 0 })
    })
}

/// Writes a GIF that loops. Each frame has its own 256 colours. The file gets its name at [`finish`](Self::finish).
pub struct GifWriter {
    file: AtomicFile,
    size: [u32; 2],
    encoder: gif::Encoder<BufWriter<File>>,
    /// Rounding error of the durations so far, in hundredths of a second.
    rounding: f64,
    frames: u32,
}

/// Speed of the colour quantisation, 1 to 30; lower is slower and better. At 10 matt surfaces show no bands.
const QUANTISER_SPEED: i32 = 10;

impl GifWriter {
    /// The most frames per second: many viewers show a frame of less than two hundredths of a second for longer.
    pub const MAX_FPS: f64 = 50.0;

    /// Starts a file for frames of `size` pixels.
    ///
    /// # Errors
    /// If the file cannot be created, or a side exceeds 65,535 pixels.
    pub fn create(path: impl AsRef<Path>, size: [u32; 2]) -> Result<Self, ViewError> {
        let path = path.as_ref();
        let failed = |source| ViewError::Gif { path: path.into(), source };
        let [Ok(width), Ok(height)] = size.map(u16::try_from) else {
            return Err(failed(io::Error::other("a side exceeds 65,535 pixels").into()));
        };
        let (file, handle) = open(path)?;
        let encoder =
            gif::Encoder::new(BufWriter::new(handle), width, height, &[]).and_then(|mut encoder| {
                encoder.set_repeat(gif::Repeat::Infinite)?;
                Ok(encoder)
            });
        let encoder = encoder.map_err(failed)?;
        Ok(Self { file, size, encoder, rounding: 0.0, frames: 0 })
    }

    /// Adds a frame that is shown for some seconds.
    ///
    /// # Errors
    /// If it has another size than the file, or cannot be written.
    pub fn push(&mut self, image: &Image, seconds: f64) -> Result<(), ViewError> {
        if image.size() != self.size {
            let (expected, found) = (self.size, image.size());
            return Err(ViewError::FrameSize { path: self.file.destination().into(), expected, found });
        }
        let [width, height] = self.size.map(|side| side as u16);
        let mut frame = gif::Frame::from_rgb_speed(width, height, image.bytes(), QUANTISER_SPEED);
        // The rounding error is carried to the next frame, so that errors do not add up.
        let exact = 100.0 * seconds + self.rounding;
        let delay = exact.round().clamp(100.0 / Self::MAX_FPS, 65_535.0);
        self.rounding = exact - delay;
        frame.delay = delay as u16;
        self.frames += 1;
        let written = self.encoder.write_frame(&frame);
        written.map_err(|source| ViewError::Gif { path: self.file.destination().into(), source })
    }

    /// Completes the file.
    ///
    /// # Errors
    /// If it has no frame, or its end cannot be written.
    pub fn finish(self) -> Result<(), ViewError> {
        let Self { file, encoder, frames, .. } = self;
        let path = file.destination().to_owned();
        if frames == 0 {
            return Err(ViewError::NoFrame { path });
        }
        let buffer = encoder.into_inner().map_err(|source| ViewError::Gif { path: path.clone(), source })?;
        let flushed = buffer.into_inner().map_err(io::IntoInnerError::into_error);
        flushed.and_then(|_| file.commit()).map_err(|source| ViewError::Create { path, source })
    }
}
