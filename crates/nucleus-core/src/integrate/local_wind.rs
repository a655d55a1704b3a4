//! Local wind: gusts, wind shadows and pushed air at each point, added to the solver's wind in this order.
//!
//! Once per substep, from the positions at its start. The column is empty where nothing is added.

use nalgebra::Vector3;

use crate::contact::collider::ColliderState;
use crate::contact::placed_surface::PlacedSurface;
use crate::input::frame::{ClothFrame, FrameInput};
use crate::input::object_fields::WindField;
use crate::integrate::air_push::AirPush;
use crate::integrate::gusts::{GustField, is_gusty};
use crate::integrate::wind_shadow::WindShadow;
use crate::math::{Real, Row4};
use crate::model::{ClothModel, ColliderModel};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

/// All objects of a solver at a time of the frame.
pub struct Objects<'a, R> {
    /// The cloths.
    pub cloths: &'a [ClothModel<R>],
    /// The colliders, and where they are.
    pub colliders: (&'a [ColliderModel], &'a [ColliderState]),
    /// The time as a share of the frame.
    pub time: f64,
}

/// Whether wind acts on a cloth.
pub fn feels_wind<R>(cloth: &ClothModel<R>, settings: &ClothFrame) -> bool {
    settings.feels_wind && !cloth.triangles.is_empty()
}

/// Computes the local wind at every point that wind acts on.
pub fn update_local_wind<R: Real>(
    objects: &Objects<'_, R>,
    state: &mut State<R>,
    frame: &FrameInput,
    pool: &ThreadPool,
) {
    state.added_wind.clear();
    if state.normal.is_empty() {
        return;
    }
    let gusts = is_gusty(frame).then(|| GustField::new(state.wind_travel, frame, objects.time));
    let shadows = surfaces(objects, state, frame, WindField::casts_shadow, |surface, settings, cloth, _| {
        WindShadow::new(surface, settings, cloth, frame.wind)
    });
    let pushes = surfaces(objects, state, frame, WindField::pushes_air, AirPush::new);
    if gusts.is_none() && shadows.is_empty() && pushes.is_empty() {
        return;
    }
    state.added_wind.resize(state.normal.len(), Row4::ZERO);
    let State { anchor, displacement, added_wind, .. } = state;
    let added = DisjointSlice::new(added_wind);
    for (at, (cloth, settings)) in objects.cloths.iter().zip(&frame.cloths).enumerate() {
        if !feels_wind(cloth, settings) {
            continue;
        }
        pool.parallel_for(cloth.blocks.len(), |block| {
            let rows = cloth.blocks.range(block);
            // SAFETY: blocks do not overlap.
            #[allow(unsafe_code)]
            let run = unsafe { added.run(rows.clone()) };
            let first = cloth.points().start;
            for (row, added) in rows.zip(run) {
                let moved = displacement[row as usize].xyz().map(R::to_f64);
                let place = Vector3::from(anchor[row as usize]) + Vector3::from(moved);
                let mut wind = frame.wind;
                wind += gusts.as_ref().map_or(Vector3::zeros(), |gusts| gusts.at(place));
                wind *= shadows
                    .iter()
                    .map(|shadow| shadow.share(place, [at as u32, row - first]))
                    .product::<f64>();
                for push in pushes.iter().filter(|push| push.cloth != Some(at)) {
                    wind = push.blend(wind, place);
                }
                *added = Row4::new((wind - frame.wind).into(), R::ZERO);
            }
        });
    }
}

/// Calls `make` for every object whose settings are `wanted`: with its surface, its settings, the index of the cloth,
/// and the velocities of its corners in m/s.
fn surfaces<R: Real, T>(
    objects: &Objects<'_, R>,
    state: &State<R>,
    frame: &FrameInput,
    wanted: fn(&WindField) -> bool,
    make: impl Fn(PlacedSurface, &WindField, Option<usize>, Vec<Vector3<f64>>) -> T,
) -> Vec<T> {
    let mut made = Vec::new();
    let (models, states) = objects.colliders;
    for ((model, placed), settings) in models.iter().zip(states).zip(&frame.colliders) {
        if wanted(&settings.wind_field) {
            let place = |point| placed.point(point, objects.time);
            let surface = PlacedSurface::new(model.boundary.triangles.clone(), place);
            let moved =
                placed.start.iter().zip(&placed.end).map(|(start, end)| (end - start) / frame.duration);
            made.push(make(surface, &settings.wind_field, None, moved.collect()));
        }
    }
    for (at, (cloth, settings)) in objects.cloths.iter().zip(&frame.cloths).enumerate() {
        if !wanted(&settings.wind_field) || cloth.points().is_empty() {
            continue;
        }
        let first = cloth.points().start;
        let position = |at: u32| Vector3::from(state.position(first + at));
        let velocity = |row: u32| Vector3::from(state.velocity[row as usize].xyz().map(R::to_f64));
        let triangles: Vec<_> =
            cloth.surface_triangles().into_iter().map(|t| t.map(|row| row - first)).collect();
        let (surface, corners) = if triangles.is_empty() {
            let corner = |at: u32| position(at / 6) + OCTAHEDRON[at as usize % 6] * settings.thickness;
            (PlacedSurface::new(octahedra(cloth.points().len() as u32), corner), 6)
        } else {
            (PlacedSurface::new(triangles, position), 1)
        };
        let moved = cloth.points().flat_map(|row| std::iter::repeat_n(velocity(row), corners));
        made.push(make(surface, &settings.wind_field, Some(at), moved.collect()));
    }
    made
}

/// Corners of an octahedron of radius 1, which stands for a particle.
const OCTAHEDRON: [Vector3<f64>; 6] = [
    Vector3::new(1.0, 0.0, 0.0),
    Vector3::new(0.0, 1.0, 0.0),
    Vector3::new(0.0, 0.0, 1.0),
    Vector3::new(-1.0, 0.0, 0.0),
    Vector3::new(0.0, -1.0, 0.0),
    Vector3::new(0.0, 0.0, -1.0),
];

/// The faces of an octahedron for each particle, facing outwards; corners are counted six for each.
fn octahedra(count: u32) -> Vec<[u32; 3]> {
    let face = |first: u32, octant: u32| {
        // A corner on either half of each axis; an odd number on the negative half inverts the winding.
        let [x, y, z] = [0, 1, 2].map(|axis| first + axis + 3 * (octant >> axis & 1));
        if octant.count_ones().is_multiple_of(2) { [x, y, z] } else { [x, z, y] }
    };
    (0..count).flat_map(|at| (0..8).map(move |octant| face(6 * at, octant))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_faces_of_an_octahedron_face_outwards() {
        for [a, b, c] in octahedra(2) {
            assert_eq!([a / 6, b / 6], [c / 6; 2], "a face is of one particle");
            let [a, b, c] = [a, b, c].map(|corner| OCTAHEDRON[corner as usize % 6]);
            assert_eq!((b - a).cross(&(c - a)).dot(&(a + b + c)), 3.0);
        }
    }
}
