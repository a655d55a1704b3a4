//! Text in pictures: DejaVu Sans, as an atlas of opacities of the printable ASCII characters.

use std::sync::OnceLock;

use super::image::Image;
use super::scene::Vec3;

/// The glyphs side by side, in four-bit greys.
const ATLAS: &[u8] = include_bytes!("../../assets/glyphs.png");
/// The first character of the atlas.
const FIRST: u32 = 32;
/// Width of each glyph, in pixels of the atlas.
const WIDTHS: [u8; 95] = [
    10, 13, 15, 27, 20, 30, 25, 9, 12, 12, 16, 27, 10, 12, 10, 11, 20, 20, 20, 20, 20, 20, 20, 20, 20, 20,
    11, 11, 27, 27, 27, 17, 32, 22, 22, 22, 25, 20, 18, 25, 24, 9, 9, 21, 18, 28, 24, 25, 19, 25, 22, 20, 20,
    23, 22, 32, 22, 20, 22, 12, 11, 12, 27, 16, 16, 20, 20, 18, 20, 20, 11, 20, 20, 9, 9, 19, 9, 31, 20, 20,
    20, 20, 13, 17, 13, 20, 19, 26, 19, 19, 17, 20, 11, 20, 27,
];

/// Opacities, row by row; empty if the atlas could not be read, which a test excludes.
struct Atlas {
    width: usize,
    height: usize,
    opacity: Vec<u8>,
}

fn atlas() -> &'static Atlas {
    static ATLAS_OF_GLYPHS: OnceLock<Atlas> = OnceLock::new();
    ATLAS_OF_GLYPHS.get_or_init(|| decode().unwrap_or(Atlas { width: 0, height: 0, opacity: Vec::new() }))
}

fn decode() -> Option<Atlas> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(ATLAS));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().ok()?;
    let mut opacity = vec![0; reader.output_buffer_size()?];
    let info = reader.next_frame(&mut opacity).ok()?;
    Some(Atlas { width: info.width as usize, height: info.height as usize, opacity })
}

/// The left side and the width of a glyph in the atlas; those of a question mark for other characters.
fn glyph(letter: char) -> (usize, usize) {
    let index = (u32::from(letter).wrapping_sub(FIRST) as usize).min(WIDTHS.len());
    let index = if index == WIDTHS.len() { ('?' as u32 - FIRST) as usize } else { index };
    let left = WIDTHS[..index].iter().map(|width| usize::from(*width)).sum();
    (left, WIDTHS[index].into())
}

/// Width of a text in pixels, at this height of a line.
pub(super) fn text_width(text: &str, height: u32) -> u32 {
    let width: usize = text.chars().map(|letter| glyph(letter).1).sum();
    (width as f32 * scale(height)).ceil() as u32
}

/// Pixels of the picture in a pixel of the atlas.
fn scale(height: u32) -> f32 {
    height as f32 / atlas().height.max(1) as f32
}

/// Draws a text in a line of this height, with its upper left corner at a pixel. Parts outside the picture are
/// clipped.
pub(super) fn draw_text(image: &mut Image, text: &str, [left, top]: [u32; 2], height: u32, colour: &Vec3) {
    let step = 1.0 / scale(height).max(1e-6);
    let [right, bottom] = image.size();
    let mut x = 0.0;
    for letter in text.chars() {
        let (start, width) = glyph(letter);
        let from = left + x as u32;
        for column in from..(from + (width as f32 / step).ceil() as u32).min(right) {
            // Whole glyphs begin at fractions of pixels, so that their distances are even.
            let u = (column - left) as f32 - x;
            for row in top..(top + height).min(bottom) {
                let cell = [
                    [u * step, (u + 1.0) * step],
                    [(row - top) as f32 * step, (row - top + 1) as f32 * step],
                ];
                let opacity = mean_opacity(start, width, cell);
                if opacity > 0.0 {
                    image.blend(column, row, colour, opacity);
                }
            }
        }
        x += width as f32 / step;
    }
}

/// The mean opacity of a rectangle of a glyph, in pixels of the atlas.
fn mean_opacity(start: usize, width: usize, [across, down]: [[f32; 2]; 2]) -> f32 {
    let atlas = atlas();
    let overlap =
        |[from, to]: [f32; 2], cell: usize| (to.min(cell as f32 + 1.0) - from.max(cell as f32)).max(0.0);
    let cells = |[from, to]: [f32; 2], size: usize| {
        let first = from.max(0.0) as usize;
        first..(to.max(0.0).ceil() as usize).min(size)
    };
    let mut sum = 0.0;
    for row in cells(down, atlas.height) {
        for column in cells(across, width) {
            let opacity = atlas.opacity.get(row * atlas.width + start + column).copied().unwrap_or(0);
            sum += f32::from(opacity) / 255.0 * overlap(across, column) * overlap(down, row);
        }
    }
    (sum / ((across[1] - across[0]) * (down[1] - down[0]))).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_atlas_has_all_glyphs() {
        let all: usize = WIDTHS.iter().map(|width| usize::from(*width)).sum();
        assert_eq!((atlas().width, atlas().opacity.len()), (all, all * atlas().height));
        let ink = |letter| {
            let (start, width) = glyph(letter);
            mean_opacity(start, width, [[0.0, width as f32], [0.0, atlas().height as f32]])
        };
        assert_eq!(ink(' '), 0.0);
        assert!(('!'..='~').all(|letter| ink(letter) > 0.01) && ink('%') > ink('.'));
        assert_eq!(glyph('\u{2603}'), glyph('?'));
    }
}
