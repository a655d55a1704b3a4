//! The rows of particles in the columns of the state: a particle is put into a row, and rows are closed up over dead ones.
//!
//! **Invariant:** one list names every field of the state. A new column does not compile until it is listed as one that
//! follows a particle to another row, or as one that is written before it is read.

use std::ops::Range;

use nalgebra::Vector3;

use crate::math::{Real, Row4};
use crate::particles::population::close_up;
use crate::state::{State, inverse_mass_of};

/// The columns that follow a particle to another row.
struct ParticleColumns<'a, R> {
    anchor: &'a mut Vec<[f64; 3]>,
    inverse_mass: &'a mut Vec<R>,
    displacement: &'a mut Vec<Row4<R>>,
    velocity: &'a mut Vec<Row4<R>>,
    /// Zero for a new particle. Some are empty.
    zero_at_birth: [&'a mut Vec<Row4<R>>; 5],
    /// By row, sorted.
    displaced: &'a mut Vec<(u32, [R; 3])>,
}

impl<R: Real> State<R> {
    fn particle_columns(&mut self) -> ParticleColumns<'_, R> {
        let Self {
            anchor,
            inverse_mass,
            displacement,
            velocity,
            predicted,
            start,
            depenetration,
            bearing_depenetration,
            field,
            displaced,
            // Written in each substep before they are read.
            corrections: _,
            normal: _,
            area: _,
            inflation: _,
            added_wind: _,
            spins: _,
            pushed_out: _,
            // Not by row.
            step_length: _,
            frames: _,
            wind_travel: _,
            chambers: _,
            rotations: _,
            populations: _,
        } = self;
        let zero_at_birth = [predicted, start, depenetration, bearing_depenetration, field];
        ParticleColumns { anchor, inverse_mass, displacement, velocity, zero_at_birth, displaced }
    }

    /// Puts a new particle into a row: its position in metres, velocity in m/s and mass in kilograms.
    pub fn put_particle(
        &mut self,
        row: usize,
        position: Vector3<f64>,
        particle_velocity: Vector3<f64>,
        mass: f64,
    ) {
        let ParticleColumns { anchor, inverse_mass, displacement, velocity, zero_at_birth, .. } =
            self.particle_columns();
        inverse_mass[row] = inverse_mass_of(mass);
        anchor[row] = position.into();
        displacement[row] = Row4([R::ZERO, R::ZERO, R::ZERO, inverse_mass[row]]);
        velocity[row] = Row4::new(particle_velocity.into(), R::ZERO);
        zero_at_birth
            .into_iter()
            .filter_map(|column| column.get_mut(row))
            .for_each(|value| *value = Row4::ZERO);
    }

    /// Closes up the rows of an object; `kept` are the places of the particles that remain, which ascend.
    pub fn close_up_particles(&mut self, rows: &Range<u32>, kept: &[u32]) {
        let ParticleColumns { anchor, inverse_mass, displacement, velocity, zero_at_birth, displaced } =
            self.particle_columns();
        let own = rows.start as usize..rows.end as usize;
        close_up(&mut anchor[own.clone()], kept);
        close_up(&mut inverse_mass[own.clone()], kept);
        close_up(&mut displacement[own.clone()], kept);
        close_up(&mut velocity[own.clone()], kept);
        for column in zero_at_birth {
            close_up(column.get_mut(own.clone()).unwrap_or_default(), kept);
        }
        displaced.retain_mut(|(row, _)| {
            let number = number_after(*row, rows, kept);
            *row = number.unwrap_or(*row);
            number.is_some()
        });
        let dead = own.start + kept.len()..own.end;
        anchor[dead.clone()].fill([0.0; 3]);
        displacement[dead.clone()].fill(Row4::ZERO);
        velocity[dead.clone()].fill(Row4::ZERO);
        inverse_mass[dead].fill(R::ZERO);
    }
}

/// The row of a point once an object, whose rows were `before`, has kept only some places; `None` if it is gone.
pub fn number_after(row: u32, before: &Range<u32>, kept: &[u32]) -> Option<u32> {
    match before.contains(&row) {
        true => kept.binary_search(&(row - before.start)).ok().map(|at| before.start + at as u32),
        false => Some(row),
    }
}
