//! Local wind: gusts, wind shadows and pushed air at each point, added to the solver's wind in this order.
//!
//! Once per substep, from the positions at its start. The column is empty where nothing is added.

use nalgebra::Vector3;

use crate::contact::collider::ColliderState;
use crate::contact::placed_surface::{ObjectAt, ObjectSurfaces, PlacedSurface, RAYS};
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
    surfaces: &mut ObjectSurfaces,
    frame: &FrameInput,
    pool: &ThreadPool,
) {
    state.added_wind.clear();
    if state.normal.is_empty() {
        return;
    }
    let gusts = is_gusty(frame).then(|| GustField::new(state.wind_travel, frame, objects.time));
    let sources = place_sources(objects, state, surfaces, frame, pool);
    if gusts.is_none() && sources.is_empty() {
        return;
    }
    let placed = || sources.iter().filter_map(|source| Some((source, surfaces.get(source.at)?)));
    let shadows: Vec<WindShadow<'_>> = placed()
        .filter(|(source, _)| source.settings.casts_shadow())
        .map(|(source, surface)| WindShadow::new(surface, source.settings, source.cloth(), frame.wind))
        .collect();
    let pushes: Vec<AirPush<'_>> = placed()
        .filter(|(source, _)| source.settings.pushes_air())
        .map(|(source, surface)| {
            let velocity = corner_velocities(source, objects, state, frame);
            AirPush::new(surface, source.settings, source.cloth(), velocity)
        })
        .collect();
    state.added_wind.resize(state.normal.len(), Row4::ZERO);
    let State { anchor, displacement, added_wind, .. } = state;
    let place = |row: u32| {
        let moved = displacement[row as usize].xyz().map(R::to_f64);
        Vector3::from(anchor[row as usize]) + Vector3::from(moved)
    };
    let added = DisjointSlice::new(added_wind);
    let air = LocalAir { wind: frame.wind, gusts, shadows, pushes };
    for (at, (cloth, settings)) in objects.cloths.iter().zip(&frame.cloths).enumerate() {
        if !feels_wind(cloth, settings) {
            continue;
        }
        let first = cloth.points().start;
        pool.parallel_for(cloth.blocks.len(), |block| {
            let rows = cloth.blocks.range(block);
            // SAFETY: blocks do not overlap.
            #[allow(unsafe_code)]
            let run = unsafe { added.run(rows.clone()) };
            for (start, run) in rows.step_by(RAYS).zip(run.chunks_mut(RAYS)) {
                let mut places = [Vector3::zeros(); RAYS];
                let places = &mut places[..run.len()];
                (start..).zip(&mut *places).for_each(|(row, own)| *own = place(row));
                air.add_to(run, places, [at, (start - first) as usize]);
            }
        });
    }
}

/// The air around the points of cloth.
struct LocalAir<'a> {
    wind: Vector3<f64>,
    gusts: Option<GustField>,
    shadows: Vec<WindShadow<'a>>,
    pushes: Vec<AirPush<'a>>,
}

impl LocalAir<'_> {
    /// Sets what is added to the wind at up to [`RAYS`] points in a row, given their places; `first` is the first of them, by the
    /// index of its cloth and in that.
    fn add_to<R: Real>(&self, added: &mut [Row4<R>], places: &[Vector3<f64>], [at, first]: [usize; 2]) {
        let mut shares = [1.0; RAYS];
        self.shadows.iter().for_each(|shadow| shadow.shade(places, [at as u32, first as u32], &mut shares));
        for ((place, share), added) in places.iter().zip(shares).zip(added) {
            let mut wind = self.wind;
            wind += self.gusts.as_ref().map_or(Vector3::zeros(), |gusts| gusts.at(*place));
            wind *= share;
            for push in self.pushes.iter().filter(|push| push.cloth != Some(at)) {
                wind = push.blend(wind, *place);
            }
            *added = Row4::new((wind - self.wind).into(), R::ZERO);
        }
    }
}

/// An object that shadows or pushes the air.
struct Source<'a> {
    at: ObjectAt,
    settings: &'a WindField,
}

impl Source<'_> {
    /// The index of the cloth that it is.
    fn cloth(&self) -> Option<usize> {
        match self.at {
            ObjectAt::Cloth(at) => Some(at),
            ObjectAt::Collider(_) => None,
        }
    }
}

/// Lists the objects that shadow or push the air, and moves their surfaces to where they are.
fn place_sources<'a, R: Real>(
    objects: &Objects<'_, R>,
    state: &State<R>,
    surfaces: &mut ObjectSurfaces,
    frame: &'a FrameInput,
    pool: &ThreadPool,
) -> Vec<Source<'a>> {
    let is_source = |settings: &WindField| settings.casts_shadow() || settings.pushes_air();
    let mut sources = Vec::new();
    let (models, states) = objects.colliders;
    for (at, ((model, placed), settings)) in models.iter().zip(states).zip(&frame.colliders).enumerate() {
        if is_source(&settings.wind_field) {
            let at = ObjectAt::Collider(at);
            let place = |point| placed.point(point, objects.time);
            surfaces.place(at, || model.boundary.triangles.clone(), place, pool);
            sources.push(Source { at, settings: &settings.wind_field });
        }
    }
    for (at, (cloth, settings)) in objects.cloths.iter().zip(&frame.cloths).enumerate() {
        if !is_source(&settings.wind_field) || cloth.points().is_empty() {
            continue;
        }
        let at = ObjectAt::Cloth(at);
        let first = cloth.points().start;
        let position = |corner: u32| Vector3::from(state.position(first + corner));
        if cloth.has_surface() {
            surfaces.place(at, || cloth.corner_triangles(), position, pool);
        } else {
            // Particles are born, die and mix.
            let corner = |k: u32| position(k / 6) + OCTAHEDRON[k as usize % 6] * settings.thickness;
            surfaces.replace(at, PlacedSurface::new(octahedra(cloth.points().len() as u32), corner));
        }
        sources.push(Source { at, settings: &settings.wind_field });
    }
    sources
}

/// The velocities of the corners of a source in m/s.
fn corner_velocities<R: Real>(
    source: &Source<'_>,
    objects: &Objects<'_, R>,
    state: &State<R>,
    frame: &FrameInput,
) -> Vec<Vector3<f64>> {
    match source.at {
        ObjectAt::Collider(at) => {
            let placed = &objects.colliders.1[at];
            let ends = placed.start.iter().zip(&placed.end);
            ends.map(|(start, end)| (end - start) / frame.duration).collect()
        }
        ObjectAt::Cloth(at) => {
            let cloth = &objects.cloths[at];
            let corners = if cloth.has_surface() { 1 } else { 6 };
            let velocity = |row: u32| Vector3::from(state.velocity[row as usize].xyz().map(R::to_f64));
            cloth.points().flat_map(|row| std::iter::repeat_n(velocity(row), corners)).collect()
        }
    }
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
