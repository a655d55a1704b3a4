//! Merges points of one place.

use std::collections::HashMap;

use nalgebra::Vector3;
use nucleus_core::{Faces, Surface};

/// Merges the points of each object that coincide at every frame, exactly. `objects` holds the count of points of each;
/// points keep their order.
pub(super) fn weld(surface: &mut Surface, frames: &mut [Vec<Vector3<f64>>], objects: &[usize]) {
    let mut kept: Vec<usize> = Vec::new();
    let mut new_of: Vec<u32> = Vec::with_capacity(surface.positions.len());
    for &count in objects {
        let mut seen: HashMap<[u64; 3], Vec<u32>> = HashMap::with_capacity(count);
        for point in new_of.len()..new_of.len() + count {
            let candidates = seen.entry(place(&surface.positions[point])).or_default();
            let is_same =
                |other: &&u32| frames.iter().all(|frame| frame[kept[**other as usize]] == frame[point]);
            let found = candidates.iter().find(is_same).copied();
            new_of.push(found.unwrap_or_else(|| {
                candidates.push(kept.len() as u32);
                kept.push(point);
                kept.len() as u32 - 1
            }));
        }
    }
    if kept.len() == new_of.len() || new_of.len() != surface.positions.len() {
        return;
    }
    let of_kept = |points: &[Vector3<f64>]| kept.iter().map(|point| points[*point]).collect::<Vec<_>>();
    surface.positions = of_kept(&surface.positions);
    frames.iter_mut().for_each(|frame| *frame = of_kept(frame));
    let mut faces = Faces::with_capacity(surface.faces.len(), surface.faces.corners().len());
    let mut corners: Vec<u32> = Vec::new();
    for face in surface.faces.iter() {
        corners.clear();
        corners.extend(face.iter().map(|point| new_of[*point as usize]));
        faces.push(&corners);
    }
    surface.faces = faces;
}

/// The bits of a position; 0 and -0 are one place.
fn place(point: &Vector3<f64>) -> [u64; 3] {
    [point.x, point.y, point.z].map(|x| (x + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_that_part_later_or_belong_to_other_objects_stay_apart() {
        let points = [0.0, 0.0, 0.0, 1.0, 0.0].map(|x| Vector3::new(x, 0.0, 0.0)).to_vec();
        let mut faces = Faces::default();
        faces.push(&[1, 3, 4]);
        let mut surface = Surface { positions: points.clone(), faces };
        let mut moved = points;
        moved[2].y = 1.0;
        let mut frames = [moved];
        weld(&mut surface, &mut frames, &[4, 1]);
        // Point 1 is point 0; point 2 leaves it; point 4 is of another object.
        assert_eq!(surface.positions.len(), 4);
        assert_eq!(surface.faces.face(0), [0, 2, 3]);
        assert_eq!(frames[0][1].y, 1.0);
    }
}
