//! The state at the start of a scene.

use crate::math::{Real, Row4};
use crate::model::ClothModel;
use crate::model::objects::{Cloth, point_masses};
use crate::particles::population::Population;
use crate::state::inflation::Inflation;
use crate::state::{State, inverse_mass_of};

impl<R: Real> State<R> {
    /// Columns for all cloths, at the start that each cloth gives. Padding points have no mass.
    pub fn new(cloths: &[Cloth], models: &[ClothModel<R>]) -> Self {
        let rows = models.last().map_or(0, |last| last.blocks.end()) as usize;
        let air = models.iter().any(|model| !model.triangles.is_empty());
        let mut state = Self {
            anchor: vec![[0.0; 3]; rows],
            displacement: vec![Row4::ZERO; rows],
            velocity: vec![Row4::ZERO; rows],
            start: Vec::new(),
            depenetration: Vec::new(),
            bearing_depenetration: Vec::new(),
            pushed_out: Vec::new(),
            displaced: Vec::new(),
            step_length: 0.0,
            predicted: Vec::new(),
            corrections: vec![
                Row4::ZERO;
                if models.iter().any(|m| !m.valence.is_empty()) { rows } else { 0 }
            ],
            normal: vec![[R::ZERO; 3]; if air { rows } else { 0 }],
            area: vec![Row4::ZERO; if models.iter().any(|model| model.pressure.is_on()) { rows } else { 0 }],
            inflation: Inflation::default(),
            added_wind: Vec::new(),
            field: Vec::new(),
            frames: 0,
            wind_travel: [0.0; 3],
            chambers: Vec::new(),
            rotations: Vec::new(),
            spins: Vec::new(),
            inverse_mass: vec![R::ZERO; rows],
            populations: (0..).zip(cloths).filter_map(|(at, cloth)| Population::of(at, cloth)).collect(),
        };
        for (cloth, model) in cloths.iter().zip(models) {
            let masses = point_masses(cloth);
            for (point, position) in cloth.positions().iter().enumerate() {
                let row = model.place(point) as usize;
                state.anchor[row] = (*position).into();
                if let Some(velocity) = cloth.start.velocities.get(point) {
                    state.velocity[row] = Row4::new((*velocity).into(), R::ZERO);
                }
                state.inverse_mass[row] = inverse_mass_of(masses[point]);
            }
        }
        state
    }
}
