//! How much memory the points and rows of a solver take.

use crate::constraints::tether::Tethers;
use crate::math::Real;
use crate::model::ClothModel;
use crate::model::rows::RowList;
use crate::particles::population::Population;
use crate::solver::Solver;
use crate::state::State;

/// Bytes of the columns of points and the lists of rows, without contact; see [`Solver::memory`].
pub fn bytes<R: Real>(solver: &Solver<R>) -> usize {
    of_state(&solver.state)
        + solver.model.cloths.iter().map(of_cloth).sum::<usize>()
        + solver.tethers.iter().map(Tethers::bytes).sum::<usize>()
}

/// Every column is named, so that a new one does not compile until it is counted.
fn of_state<R: Real>(state: &State<R>) -> usize {
    let State {
        anchor,
        displacement,
        velocity,
        start,
        depenetration,
        bearing_depenetration,
        pushed_out,
        displaced,
        step_length: _,
        predicted,
        corrections,
        normal,
        area,
        inflation,
        added_wind,
        field,
        frames: _,
        wind_travel: _,
        chambers,
        rotations,
        spins,
        inverse_mass,
        populations,
    } = state;
    let rows = [
        displacement,
        velocity,
        start,
        depenetration,
        bearing_depenetration,
        predicted,
        corrections,
        area,
        added_wind,
        field,
    ];
    let rows: usize = rows.into_iter().map(|column| size_of_val(&column[..])).sum();
    let chambers = size_of_val(&chambers[..])
        + size_of_val(&rotations[..])
        + size_of_val(&displaced[..])
        + size_of_val(&pushed_out[..]);
    let spins = size_of_val(&spins[..]);
    let populations: usize = populations.iter().map(Population::bytes).sum();
    rows + size_of_val(&anchor[..])
        + size_of_val(&normal[..])
        + chambers
        + inflation.bytes()
        + spins
        + size_of_val(&inverse_mass[..])
        + populations
}

fn of_cloth<R: Real>(cloth: &ClothModel<R>) -> usize {
    let maps = &cloth.strength_maps;
    let links = [&cloth.stretch, &cloth.shear].into_iter().map(of_list).sum::<usize>();
    let angles = [&cloth.bend_angles, &cloth.bend_six_angles].into_iter().map(of_list).sum::<usize>();
    let maps = [&maps.stretch, &maps.bend, &maps.bend_six, &maps.damp, &maps.angles, &maps.angles_six];
    let per_point = [&cloth.attract, &cloth.field_map].into_iter().map(|map| size_of_val(&map[..]));
    let triangles = cloth.triangles.iter().map(|triangles| size_of_val(&triangles[..]));
    links
        + of_list(&cloth.bend)
        + of_list(&cloth.bend_six)
        + [&cloth.bend_rest, &cloth.bend_six_rest].into_iter().map(of_list).sum::<usize>()
        + angles
        + maps.into_iter().map(of_list).sum::<usize>()
        + [&cloth.strength_maps.stretch_weave, &cloth.strength_maps.shear_weave]
            .into_iter()
            .map(of_list)
            .sum::<usize>()
        + per_point.sum::<usize>()
        + triangles.sum::<usize>()
        + size_of_val(&cloth.air[..])
        + size_of_val(&cloth.valence[..])
        + cloth.pressure.bytes()
        + cloth.shape.bytes()
}

fn of_list<G>(list: &RowList<G>) -> usize {
    size_of_val(list.groups())
}
