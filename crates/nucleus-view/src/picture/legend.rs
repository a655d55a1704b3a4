//! What the colours of strain mean: a bar with its figures in the lower left corner.

use super::image::Image;
use super::{Vec3, glyphs, strain};

const INK: [f32; 3] = [0.05, 0.05, 0.055];

/// Draws the legend for strains from `-full_scale` to `full_scale`.
pub(super) fn draw(image: &mut Image, full_scale: f32) {
    let [width, height] = image.size();
    let dot = (height / 360).max(1);
    let bar = [width / 4, 6 * dot];
    let [left, top] = [14 * dot, height.saturating_sub((14 + 6 + 3 + glyphs::HEIGHT) * dot)];
    let ink = Vec3::from(INK);
    for column in 0..bar[0] {
        let share = column as f32 / (bar[0] - 1).max(1) as f32 * 2.0 - 1.0;
        // Lit as a surface that faces the sky would be, so that the bar matches the cloth.
        glyphs::fill(image, [left + column, top], [1, bar[1]], &(strain::colour(share) * 0.9));
    }
    let below = top + bar[1] + 3 * dot;
    let percent = percent(full_scale);
    let texts = [(format!("-{percent}%"), 0.0), ("0".into(), 0.5), (format!("+{percent}%"), 1.0)];
    for (text, place) in texts {
        let room = bar[0].saturating_sub(glyphs::width(&text) * dot);
        glyphs::write(image, &text, [left + (room as f32 * place) as u32, below], dot, &ink);
    }
    let above = top.saturating_sub((3 + glyphs::HEIGHT) * dot);
    glyphs::write(image, "strain", [left, above], dot, &ink);
}

/// A share in percent, with decimals only where they are needed.
fn percent(share: f32) -> String {
    let percent = share * 100.0;
    if percent < 1.0 || (percent < 10.0 && (percent - percent.round()).abs() > 0.05) {
        format!("{percent:.1}")
    } else {
        format!("{percent:.0}")
    }
}
