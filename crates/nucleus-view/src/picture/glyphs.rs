//! The few letters that a legend needs, five by seven dots each.

use super::Vec3;
use super::image::Image;

/// Dots from one letter to the next.
const ADVANCE: u32 = 6;
/// Rows of a letter.
pub(super) const HEIGHT: u32 = 7;

/// Width of a text in dots.
pub(super) fn width(text: &str) -> u32 {
    (text.chars().count() as u32 * ADVANCE).saturating_sub(1)
}

/// Writes a text with its upper left corner at a pixel, each dot `dot` pixels wide.
pub(super) fn write(image: &mut Image, text: &str, [left, top]: [u32; 2], dot: u32, colour: &Vec3) {
    for (place, letter) in text.chars().enumerate() {
        for (row, bits) in rows(letter).into_iter().enumerate() {
            for column in (0..5).filter(|column| bits >> (4 - column) & 1 == 1) {
                let x = left + (place as u32 * ADVANCE + column) * dot;
                fill(image, [x, top + row as u32 * dot], [dot, dot], colour);
            }
        }
    }
}

/// Fills a rectangle, as far as it lies inside the picture.
pub(super) fn fill(image: &mut Image, [left, top]: [u32; 2], [width, height]: [u32; 2], colour: &Vec3) {
    let [right, bottom] = image.size();
    for row in top..(top + height).min(bottom) {
        for column in left..(left + width).min(right) {
            image.set(column, row, colour);
        }
    }
}

/// The dots of a letter, row by row, leftmost in bit 4; nothing for letters that no legend uses.
fn rows(letter: char) -> [u8; 7] {
    match letter {
        '0' => [0b01110, 0b10001, 0b10011, 0b10101, 0b11001, 0b10001, 0b01110],
        '1' => [0b00100, 0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110],
        '2' => [0b01110, 0b10001, 0b00001, 0b00110, 0b01000, 0b10000, 0b11111],
        '3' => [0b01110, 0b10001, 0b00001, 0b00110, 0b00001, 0b10001, 0b01110],
        '4' => [0b00010, 0b00110, 0b01010, 0b10010, 0b11111, 0b00010, 0b00010],
        '5' => [0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110],
        '6' => [0b00110, 0b01000, 0b10000, 0b11110, 0b10001, 0b10001, 0b01110],
        '7' => [0b11111, 0b00001, 0b00010, 0b00100, 0b01000, 0b01000, 0b01000],
        '8' => [0b01110, 0b10001, 0b10001, 0b01110, 0b10001, 0b10001, 0b01110],
        '9' => [0b01110, 0b10001, 0b10001, 0b01111, 0b00001, 0b00010, 0b01100],
        '+' => [0b00000, 0b00100, 0b00100, 0b11111, 0b00100, 0b00100, 0b00000],
        '-' => [0b00000, 0b00000, 0b00000, 0b11111, 0b00000, 0b00000, 0b00000],
        '.' => [0b00000, 0b00000, 0b00000, 0b00000, 0b00000, 0b00100, 0b00100],
        '%' => [0b11001, 0b11001, 0b00010, 0b00100, 0b01000, 0b10011, 0b10011],
        's' => [0b00000, 0b00000, 0b01111, 0b10000, 0b01110, 0b00001, 0b11110],
        't' => [0b00100, 0b00100, 0b01110, 0b00100, 0b00100, 0b00101, 0b00010],
        'r' => [0b00000, 0b00000, 0b10110, 0b11001, 0b10000, 0b10000, 0b10000],
        'a' => [0b00000, 0b00000, 0b01110, 0b00001, 0b01111, 0b10001, 0b01111],
        'i' => [0b00100, 0b00000, 0b01100, 0b00100, 0b00100, 0b00100, 0b01110],
        'n' => [0b00000, 0b00000, 0b10110, 0b11001, 0b10001, 0b10001, 0b10001],
        _ => [0; 7],
    }
}
