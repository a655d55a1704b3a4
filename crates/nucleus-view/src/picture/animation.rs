//! Frames as one animated PNG, written as they come.

use std::fs::File;
use std::io::{self, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::image::Image;
use crate::ViewError;

/// Writes an animated PNG that plays for ever, one frame at a time.
///
/// Only the part of a frame that differs from the one before is stored.
pub struct AnimationWriter {
    path: PathBuf,
    size: [u32; 2],
    encoder: png::Writer<BufWriter<File>>,
    last: Option<Image>,
    frames: u32,
}

/// Stands in the header until the number of frames is known.
const NOT_YET_KNOWN: u32 = i32::MAX as u32;

impl AnimationWriter {
    /// Starts a file for frames of `size` pixels, shown `fps` times a second.
    pub fn create(path: impl AsRef<Path>, size: [u32; 2], fps: f64) -> Result<Self, ViewError> {
        let path = path.as_ref().to_path_buf();
        let file = File::create(&path).map_err(|source| ViewError::Create { path: path.clone(), source })?;
        let encoder = start(BufWriter::new(file), size, fps)
            .map_err(|source| ViewError::Encode { path: path.clone(), source })?;
        Ok(Self { path, size, encoder, last: None, frames: 0 })
    }

    /// Adds a frame of the size the file was created with.
    pub fn push(&mut self, image: &Image) -> Result<(), ViewError> {
        if image.size() != self.size {
            let (expected, found) = (self.size, image.size());
            return Err(ViewError::FrameSize { path: self.path.clone(), expected, found });
        }
        let changed =
            self.last.as_ref().map_or([0, 0, self.size[0], self.size[1]], |last| changed(last, image));
        self.write_part(image, changed)
            .map_err(|source| ViewError::Encode { path: self.path.clone(), source })?;
        self.last = Some(image.clone());
        self.frames += 1;
        Ok(())
    }

    /// Ends the file. Without this it is not a valid picture.
    pub fn finish(self) -> Result<(), ViewError> {
        let Self { path, encoder, frames, .. } = self;
        if frames == 0 {
            return Err(ViewError::NoFrame { path });
        }
        encoder.finish().map_err(|source| ViewError::Encode { path: path.clone(), source })?;
        set_frame_count(&path, frames)
            .map_err(|source| ViewError::Encode { path, source: png::EncodingError::IoError(source) })
    }

    fn write_part(&mut self, image: &Image, part: [u32; 4]) -> Result<(), png::EncodingError> {
        let [left, top, width, height] = part;
        if self.frames > 0 {
            self.encoder.reset_frame_position()?;
            self.encoder.set_frame_dimension(width, height)?;
            self.encoder.set_frame_position(left, top)?;
        }
        let row_bytes = 3 * self.size[0] as usize;
        let columns = 3 * left as usize..3 * (left + width) as usize;
        let rows = image.bytes().chunks_exact(row_bytes).skip(top as usize).take(height as usize);
        let bytes: Vec<u8> = rows.flat_map(|row| &row[columns.clone()]).copied().collect();
        self.encoder.write_image_data(&bytes)
    }
}

fn start(
    file: BufWriter<File>,
    [width, height]: [u32; 2],
    fps: f64,
) -> Result<png::Writer<BufWriter<File>>, png::EncodingError> {
    let mut encoder = png::Encoder::new(file, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.set_animated(NOT_YET_KNOWN, 0)?;
    // The delay is a fraction of two 16-bit numbers: whole frames a second, as near as they go.
    let per_minute = (fps * 60.0).clamp(60.0, 60_000.0).round() as u16;
    encoder.set_frame_delay(60, per_minute)?;
    encoder.write_header()
}

/// Left, top, width and height of what differs between two pictures of one size; a single pixel if nothing does.
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

/// Puts the true number of frames, and the sum that guards it, into the header's animation chunk.
fn set_frame_count(path: &Path, frames: u32) -> io::Result<()> {
    let mut file = File::options().read(true).write(true).open(path)?;
    let mut head = Vec::new();
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

/// The check sum of a PNG chunk (ISO 3309), bit by bit: it runs over twelve bytes.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| sum >> 1 ^ if sum & 1 == 1 { 0xEDB8_8320 } else { 0 })
    })
}
