//! How far sweeps leave inflated cloth stretched, estimated from its mesh and its pressure.
//!
//! A gauge pressure p in a ball of radius r is held by a tension p r / 2 of its skin (Laplace), so an edge of length d carries
//! p r d / 2. In a step of h seconds a sweep holds an edge between points of mass m no stiffer than about m / h², and the
//! diagonals of the faces carry as much as the edges: the skin is stretched by about p r h² / 4m beyond what its material
//! allows. The radius is that of a sphere of the same area, the largest that a skin of this area can have.

use std::f64::consts::PI;

use nucleus_core::{BURST_STRETCH, FrameInput, PhysicalStiffness, Pressure, ResistanceModel, Surface};

use super::program::Program;
use crate::mesh::{area, is_closed, volume};
use crate::scene::document::TimeSpan;

/// Frames at which keyed pressure is looked at, at most.
const SAMPLES: i64 = 1_000;
/// Halvings of the interval of the strain at which the skin holds the pressure.
const HALVINGS: u32 = 40;

/// A closed cloth under pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inflated {
    /// The largest gauge pressure of the run, once the skin holds it, in pascals.
    pub pascals: f64,
    /// The radius in metres of a sphere of its area, stretched by that pressure.
    pub radius: f64,
    /// Mean mass of a point in kilograms.
    pub mass: f64,
}

impl Inflated {
    /// Of a cloth of a nucleus by its index; `None` where no gas or hand inflates it, or nothing holds the pressure.
    pub fn of(program: &Program, nucleus: usize, index: usize, input: &FrameInput) -> Option<Self> {
        let own = program.nuclei().get(nucleus)?;
        let (cloth, settings) = (own.model().cloths().get(index)?, input.cloths.get(index)?);
        let is_physical = matches!(input.resistance, ResistanceModel::Physical { .. });
        if !cloth.lists.pressure || !cloth.lists.stretch || settings.is_driven || !is_physical {
            return None;
        }
        let source = own.cloths.get(index)?;
        let TimeSpan { start, end, .. } = program.time();
        let every = (end.saturating_sub(start) / SAMPLES).max(1);
        let frames = (start..=end).step_by(usize::try_from(every).unwrap_or(1));
        let at = |frame: i64| {
            let interval = program.interval(nucleus, [frame as f64 - 1.0, frame as f64], 1.0, false);
            interval.pressure(source.node)
        };
        let Surface { positions, faces } = &cloth.surface;
        let radius = (area(faces, positions) / (4.0 * PI)).sqrt();
        let supply = Supply::of(frames.map(at), every as f64 / program.time().fps, is_closed(faces));
        // Of the sphere that the skin can become.
        let filled = volume(faces, positions).abs() / (4.0 / 3.0 * PI * radius.powi(3));
        let stiffness = PhysicalStiffness::of(settings);
        let strain = supply.strain(filled, radius, (stiffness.warp + stiffness.weft) / 2.0);
        let pascals = supply.gauge(filled, strain);
        let points = cloth.point_masses();
        let mass = points.iter().sum::<f64>() / points.len().max(1) as f64;
        let radius = radius * (1.0 + strain);
        (pascals > 0.0 && radius > 0.0 && mass > 0.0).then_some(Self { pascals, radius, mass })
    }

    /// Estimated strain of the skin beyond that of its material, with this length of a time step in seconds.
    pub fn strain(&self, step: f64) -> f64 {
        self.pascals * self.radius * step * step / (4.0 * self.mass)
    }

    /// The time step in seconds that leaves this strain.
    pub fn step(&self, strain: f64) -> f64 {
        (strain * 4.0 * self.mass / (self.pascals * self.radius)).sqrt()
    }
}

/// What inflates a cloth: the most of a whole run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Supply {
    /// By hand, in pascals.
    hand: f64,
    /// Bulk modulus of the gas in pascals.
    bulk: f64,
    /// Air at the start, and at most, over that which fills the mesh at the start. What leaks is not subtracted.
    start: f64,
    most: f64,
}

impl Supply {
    /// Of the pressures at frames that are `seconds` apart. Gas streams out of open cloth, and pressure by hand drives it.
    fn of(pressures: impl Iterator<Item = Pressure>, seconds: f64, is_closed: bool) -> Self {
        let mut supply = Self { start: 1.0, most: 1.0, ..Self::default() };
        let mut amount = None;
        for pressure in pressures {
            match pressure {
                Pressure::Manual { pascals, .. } if is_closed => supply.hand = supply.hand.max(pascals.abs()),
                Pressure::Gas { start, bulk, pump, sealed, .. } if is_closed || sealed => {
                    supply.bulk = supply.bulk.max(bulk);
                    // The first step begins at the first frame.
                    let air = amount.map_or(1.0 + start, |air: f64| air + pump * seconds).max(0.0);
                    supply.start = if amount.is_none() { air } else { supply.start };
                    amount = Some(air);
                    supply.most = supply.most.max(air);
                }
                _ => {}
            }
        }
        supply
    }

    /// Gauge pressure in pascals on a skin of this strain, whose mesh fills this share of its sphere at the start.
    fn gauge(&self, filled: f64, strain: f64) -> f64 {
        // What is pumped in first fills the sphere.
        let air = self.start.max(self.most * filled.min(1.0));
        self.hand.max(self.bulk * (air / (1.0 + strain).powi(3) - 1.0)).max(0.0)
    }

    /// The strain at which the tension of a skin of this radius in metres and this stiffness in N/m holds the pressure, up to
    /// bursting.
    fn strain(&self, filled: f64, radius: f64, stiffness: f64) -> f64 {
        let is_held =
            |strain: f64| self.gauge(filled, strain) * radius * (1.0 + strain) / 2.0 <= stiffness * strain;
        let (mut low, mut high) = (0.0, BURST_STRETCH - 1.0);
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(low, high);
            if is_held(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        high
    }
}
