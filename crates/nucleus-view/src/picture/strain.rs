//! Strain in pictures: its value at each point, its colour, and the legend.

use super::image::Image;
use super::scene::{Object, Vec3, is_drawable};
use super::text::{draw_text, text_width};

/// Per point, the strain of largest magnitude among its edges, with its sign; 0 for a point without edges.
/// `None` if the object has no rest shape of as many points.
pub(super) fn of_points(object: &Object) -> Option<Vec<f32>> {
    let rest = object.rest.filter(|rest| rest.len() == object.positions.len())?;
    let mut strain = vec![0.0f32; rest.len()];
    for face in object.faces.iter() {
        for (corner, &a) in face.iter().enumerate() {
            let b = face[(corner + 1) % face.len()];
            let Some(edge) = edge_strain(object.positions, rest, a as usize, b as usize) else { continue };
            for point in [a, b] {
                let largest = &mut strain[point as usize];
                if edge.abs() > largest.abs() {
                    *largest = edge;
                }
            }
        }
    }
    Some(strain)
}

/// (length - rest length) / rest length; `None` if a point is missing or cannot be drawn.
fn edge_strain(positions: &[[f32; 3]], rest: &[[f32; 3]], a: usize, b: usize) -> Option<f32> {
    let length = distance(positions.get(a)?, positions.get(b)?)?;
    let rest_length = distance(rest.get(a)?, rest.get(b)?)?;
    (rest_length > 0.0).then(|| length / rest_length - 1.0)
}

fn distance(a: &[f32; 3], b: &[f32; 3]) -> Option<f32> {
    (is_drawable(a) && is_drawable(b)).then(|| (Vec3::from(*a) - Vec3::from(*b)).norm())
}

/// Linear colour of a strain in units of the full scale: blue at -1, pale at 0, red at +1.
pub(super) fn colour(strain: f32) -> Vec3 {
    const SHORTER: [[f32; 3]; 2] = [[0.18, 0.46, 0.66], [0.02, 0.12, 0.42]];
    const LONGER: [[f32; 3]; 2] = [[0.86, 0.42, 0.13], [0.52, 0.02, 0.05]];
    const NONE: [f32; 3] = [0.72, 0.71, 0.67];
    let [near, far] = if strain < 0.0 { SHORTER } else { LONGER }.map(Vec3::from);
    let magnitude = if strain.is_finite() { strain.abs().min(1.0) } else { 1.0 };
    match magnitude < 0.5 {
        true => Vec3::from(NONE).lerp(&near, magnitude * 2.0),
        false => near.lerp(&far, magnitude * 2.0 - 1.0),
    }
}

/// Linear colour of the text.
const INK: [f32; 3] = [0.05, 0.05, 0.055];

/// Draws the legend, a bar with its figures in the lower left corner, for strains from `-full_scale` to `full_scale`.
pub(super) fn draw_legend(image: &mut Image, full_scale: f32) {
    let [width, height] = image.size();
    let unit = (height / 60).max(6);
    let line = unit * 2;
    let bar = [(width / 4).max(6 * line), unit * 3 / 4];
    let [left, top] = [unit * 2, height.saturating_sub(unit + line + bar[1])];
    let ink = Vec3::from(INK);
    for column in 0..bar[0] {
        let share = column as f32 / (bar[0] - 1).max(1) as f32 * 2.0 - 1.0;
        // As bright as a surface that faces the sky, so that the bar matches the cloth.
        fill(image, [left + column, top], [1, bar[1]], &(colour(share) * 0.9));
    }
    let below = top + bar[1] + unit / 4;
    let percent = percent(full_scale);
    let texts = [(format!("-{percent} %"), 0.0), ("0".into(), 0.5), (format!("+{percent} %"), 1.0)];
    for (text, place) in texts {
        let room = bar[0].saturating_sub(text_width(&text, line));
        draw_text(image, &text, [left + (room as f32 * place) as u32, below], line, &ink);
    }
    draw_text(image, "strain", [left, top.saturating_sub(line + unit / 4)], line, &ink);
}

/// A strain in percent, with a decimal only where it is needed.
fn percent(strain: f32) -> String {
    let percent = strain * 100.0;
    if percent < 1.0 || (percent < 10.0 && (percent - percent.round()).abs() > 0.05) {
        format!("{percent:.1}")
    } else {
        format!("{percent:.0}")
    }
}

/// Fills the part of a rectangle that lies inside the picture.
fn fill(image: &mut Image, [left, top]: [u32; 2], [width, height]: [u32; 2], colour: &Vec3) {
    let [right, bottom] = image.size();
    for row in top..(top + height).min(bottom) {
        for column in left..(left + width).min(right) {
            image.blend(column, row, colour, 1.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use nucleus_core::Faces;

    use super::super::scene::Kind;
    use super::*;

    #[test]
    fn an_edge_of_twice_its_rest_length_has_a_strain_of_one() {
        let rest = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let positions = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let faces = Faces::from_iter([&[0u32, 1, 2][..]]);
        let object = Object {
            name: "triangle",
            kind: Kind::Cloth,
            faces: &faces,
            positions: &positions,
            rest: Some(&rest),
            radius: None,
            looks: None,
        };
        let strain = of_points(&object).unwrap();
        assert_eq!(strain[0], 1.0);
        assert_eq!(strain[1], 1.0);
        let slanted = 5f32.sqrt() / 2f32.sqrt() - 1.0;
        assert!((strain[2] - slanted).abs() < 1e-6);
    }
}
