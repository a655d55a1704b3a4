//! Particles of a liquid in one place. Density cannot part them: its gradient has no direction there, and nearby it is so
//! small that the linear constraint parts them at up to 4 m/s. They begin the frame a little apart.

use nalgebra::Vector3;

use crate::contact::system::ContactSystem;
use crate::input::frame::FrameInput;
use crate::math::Real;
use crate::model::Model;
use crate::state::State;

/// Distance below which particles are in one place, in rest distances.
const SAME_PLACE: f64 = 0.05;
/// Edge of the cube that they are spread over, in rest distances.
const APART: f64 = 0.2;
/// A direction in which particles of a grid have different coordinates, so that few of them are compared; and the steps of a
/// sequence that fills a cube evenly (Roberts 2018).
const ALONG: [f64; 3] = [0.819_172_513_4, 0.671_043_606_7, 0.549_700_477_9];

/// Moves the particles of each liquid that are in one place apart, about their centre: at the start of a run, and in every
/// frame where particles are born. The anchors are those of the frame.
pub fn separate<R: Real>(
    model: &Model<R>,
    state: &mut State<R>,
    contact: &mut ContactSystem<R>,
    frame: &FrameInput,
) {
    for (cloth, settings) in frame.cloths.iter().enumerate() {
        let Some(liquid) = &settings.liquid else { continue };
        if state.frames > 0 && state.population_of(cloth).is_none() {
            continue;
        }
        let rows: Vec<usize> = model.cloths[cloth].points().map(|row| row as usize).collect();
        let places: Vec<Vector3<f64>> = rows.iter().map(|&row| state.anchor[row].into()).collect();
        for group in groups(&places, SAME_PLACE * liquid.spacing) {
            let free = group.iter().map(|&at| rows[at]).filter(|&row| state.displacement[row].0[3] > R::ZERO);
            let free: Vec<usize> = free.collect();
            let moves = moves(free.len(), group.len() > free.len());
            for (row, by) in free.into_iter().zip(moves) {
                let place = Vector3::from(state.anchor[row]) + by * (APART * liquid.spacing);
                state.anchor[row] = place.into();
                contact.invalidate_bounds(row);
            }
        }
    }
}

/// The particles that are within a distance of another: groups of two and more, each in the order of particles.
fn groups(places: &[Vector3<f64>], distance: f64) -> Vec<Vec<usize>> {
    let keys: Vec<f64> = places.iter().map(|place| place.dot(&Vector3::from(ALONG))).collect();
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|&a, &b| keys[a].total_cmp(&keys[b]).then(a.cmp(&b)));
    let mut is_taken = vec![false; places.len()];
    let mut found = Vec::new();
    // The direction is longer than one.
    let reach = 2.0 * distance;
    for (at, &first) in order.iter().enumerate() {
        if is_taken[first] {
            continue;
        }
        let near = order[at + 1..].iter().take_while(|&&other| keys[other] - keys[first] <= reach);
        let mut group: Vec<usize> = near
            .copied()
            .filter(|&other| !is_taken[other] && (places[other] - places[first]).norm() < distance)
            .collect();
        if group.is_empty() {
            continue;
        }
        group.push(first);
        group.sort_unstable();
        group.iter().for_each(|&member| is_taken[member] = true);
        found.push(group);
    }
    found
}

/// So many places that fill a cube of edge one evenly, less their mean unless one particle stays where it is.
fn moves(count: usize, one_stays: bool) -> Vec<Vector3<f64>> {
    let place = |k: usize| Vector3::from(ALONG).map(|step| (0.5 + step * (k + 1) as f64).fract() - 0.5);
    let all: Vec<Vector3<f64>> = (0..count).map(place).collect();
    let mean = all.iter().sum::<Vector3<f64>>() / count.max(1) as f64;
    let mean = if one_stays { Vector3::zeros() } else { mean };
    all.into_iter().map(|one| one - mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_the_particles_within_the_distance_and_no_others() {
        let grid = (0..1000).map(|k| Vector3::new((k % 10) as f64, (k / 10 % 10) as f64, (k / 100) as f64));
        let mut places: Vec<Vector3<f64>> = grid.collect();
        places.extend([places[7], places[7] + Vector3::x() * 1e-6, places[300] - Vector3::repeat(1e-6)]);
        places.push(places[500] + Vector3::y() * 2e-4);
        let mut found = groups(&places, 1e-4);
        found.sort();
        assert_eq!(found, [vec![7, 1000, 1001], vec![300, 1002]]);
    }

    #[test]
    fn moves_keep_the_centre_and_part_all() {
        for count in [2, 3, 12, 100] {
            let moves = moves(count, false);
            assert!(moves.iter().sum::<Vector3<f64>>().norm() < 1e-9);
            let nearest = (1..count).map(|k| (moves[k] - moves[0]).norm()).fold(f64::MAX, f64::min);
            assert!(nearest > 0.3 / (count as f64).cbrt(), "{count}: {nearest}");
        }
        assert_eq!(moves(0, true).len(), 0);
    }
}
