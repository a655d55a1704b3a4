//! Frames as a GIF, written as they come.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use super::image::Image;
use crate::ViewError;

/// Writes a GIF that plays for ever. Each frame has 256 colours of its own; the same pictures give the same bytes.
pub struct GifWriter {
    path: PathBuf,
    size: [u32; 2],
    encoder: gif::Encoder<BufWriter<File>>,
    /// Hundredths of a second that a frame is shown, and what rounding has left over so far.
    delay: f64,
    owed: f64,
    frames: u32,
}

/// How thoroughly colours are chosen, 1 to 30; lower is slower. At 10 no band is seen on matt surfaces.
const HASTE: i32 = 10;

impl GifWriter {
    /// Starts a file for frames of `size` pixels, shown `fps` times a second.
    ///
    /// # Errors
    /// If the file cannot be made or a side is too long for the format.
    pub fn create(path: impl AsRef<Path>, size: [u32; 2], fps: f64) -> Result<Self, ViewError> {
        let path = path.as_ref().to_path_buf();
        let [Ok(width), Ok(height)] = size.map(u16::try_from) else {
            return Err(ViewError::Gif { path, source: std::io::Error::other("a side is too long").into() });
        };
        let file = File::create(&path).map_err(|source| ViewError::Create { path: path.clone(), source })?;
        let encoder = gif::Encoder::new(BufWriter::new(file), width, height, &[]).and_then(|mut encoder| {
            encoder.set_repeat(gif::Repeat::Infinite)?;
            Ok(encoder)
        });
        let encoder = encoder.map_err(|source| ViewError::Gif { path: path.clone(), source })?;
        Ok(Self { path, size, encoder, delay: 100.0 / fps.max(1e-3), owed: 0.0, frames: 0 })
    }

    /// Adds a frame of the size the file was created with.
    ///
    /// # Errors
    /// If it has another size, or cannot be written.
    pub fn push(&mut self, image: &Image) -> Result<(), ViewError> {
        if image.size() != self.size {
            let (expected, found) = (self.size, image.size());
            return Err(ViewError::FrameSize { path: self.path.clone(), expected, found });
        }
        let [width, height] = self.size.map(|side| side as u16);
        let mut frame = gif::Frame::from_rgb_speed(width, height, image.bytes(), HASTE);
        // Time is counted in hundredths; what one frame lacks the next one gets.
        let delay = (self.delay + self.owed).round().clamp(2.0, 65_535.0);
        self.owed += self.delay - delay;
        frame.delay = delay as u16;
        self.frames += 1;
        self.encoder.write_frame(&frame).map_err(|source| ViewError::Gif { path: self.path.clone(), source })
    }

    /// Ends the file.
    ///
    /// # Errors
    /// If it has no frame, or its end cannot be written.
    pub fn finish(self) -> Result<(), ViewError> {
        let Self { path, encoder, frames, .. } = self;
        if frames == 0 {
            return Err(ViewError::NoFrame { path });
        }
        let file = encoder.into_inner().map_err(|source| ViewError::Gif { path: path.clone(), source })?;
        let flushed = file.into_inner().map(drop);
        flushed.map_err(|error| ViewError::Gif { path, source: error.into_error().into() })
    }
}
