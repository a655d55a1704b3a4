//! How far the edges at a point are from their rest length, and the colour of it.

use super::{Object, Vec3, is_drawable};

/// The strain of largest size among the edges that meet in each point, with its sign; 0 where there is none.
/// `None` if the object has no rest shape of as many points.
pub(super) fn of_points(object: &Object) -> Option<Vec<f32>> {
    let rest = object.rest.filter(|rest| rest.len() == object.positions.len())?;
    let mut strain = vec![0.0f32; rest.len()];
    for face in object.faces.iter() {
        for (corner, &a) in face.iter().enumerate() {
            let b = face[(corner + 1) % face.len()];
            let Some(of_edge) = edge_strain(object.positions, rest, a as usize, b as usize) else { continue };
            for point in [a, b] {
                let largest = &mut strain[point as usize];
                if of_edge.abs() > largest.abs() {
                    *largest = of_edge;
                }
            }
        }
    }
    Some(strain)
}

/// (length - rest length) / rest length.
fn edge_strain(positions: &[[f32; 3]], rest: &[[f32; 3]], a: usize, b: usize) -> Option<f32> {
    let length = distance(positions.get(a)?, positions.get(b)?)?;
    let rest_length = distance(rest.get(a)?, rest.get(b)?)?;
    (rest_length > 0.0).then(|| length / rest_length - 1.0)
}

fn distance(a: &[f32; 3], b: &[f32; 3]) -> Option<f32> {
    (is_drawable(a) && is_drawable(b)).then(|| (Vec3::from(*a) - Vec3::from(*b)).norm())
}

/// Linear colour of a strain in units of the full scale: blue at -1, pale at 0, red at +1.
pub(super) fn colour(share: f32) -> Vec3 {
    const SHORTER: [[f32; 3]; 2] = [[0.18, 0.46, 0.66], [0.02, 0.12, 0.42]];
    const LONGER: [[f32; 3]; 2] = [[0.86, 0.42, 0.13], [0.52, 0.02, 0.05]];
    const NONE: [f32; 3] = [0.72, 0.71, 0.67];
    let [near, far] = if share < 0.0 { SHORTER } else { LONGER }.map(Vec3::from);
    let size = if share.is_finite() { share.abs().min(1.0) } else { 1.0 };
    if size < 0.5 { Vec3::from(NONE).lerp(&near, size * 2.0) } else { near.lerp(&far, size * 2.0 - 1.0) }
}

#[cfg(test)]
mod tests {
    use nucleus_core::Faces;

    use super::super::Kind;
    use super::*;

    #[test]
    fn an_edge_pulled_to_twice_its_length_has_a_strain_of_one() {
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
        };
        let strain = of_points(&object).unwrap();
        assert_eq!(strain[0], 1.0);
        assert_eq!(strain[1], 1.0);
        let slanted = 5f32.sqrt() / 2f32.sqrt() - 1.0;
        assert!((strain[2] - slanted).abs() < 1e-6);
    }
}
