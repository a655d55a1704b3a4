//! The free points of a link as signed weights, and where its prescribed sides are.

use nalgebra::Vector3;

use crate::contact::collider::ColliderState;
use crate::input::links::{ConstraintFrame, Link, LinkSide};
use crate::math::{Real, Row4};
use crate::model::ClothModel;
use crate::state::State;

/// The free points of a link: rows of the columns, each once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ends {
    /// The number of points.
    pub count: usize,
    /// Their rows.
    pub rows: [u32; 6],
    /// Their weights, positive on the first side.
    pub weights: [f64; 6],
    /// How much each is moved.
    pub push: [f64; 6],
}

impl Ends {
    /// The free points of a link. A point on both sides has the sum of its weights.
    pub fn new<R: Real>(link: &Link, cloths: &[ClothModel<R>]) -> Self {
        let mut ends = Self { count: 0, rows: [0; 6], weights: [0.0; 6], push: [0.0; 6] };
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            let LinkSide::Cloth { cloth, points, weights } = link.sides[side] else { continue };
            for (point, weight) in points.into_iter().zip(weights).filter(|(_, weight)| *weight != 0.0) {
                let row = cloths[cloth.index()].place(point.index());
                ends.add(row, sign * weight, link.weight[1 - side]);
            }
        }
        ends
    }

    fn add(&mut self, row: u32, weight: f64, pushed: f64) {
        let known = self.rows[..self.count].iter().position(|&other| other == row);
        let at = known.unwrap_or(self.count);
        self.count = self.count.max(at + 1);
        self.rows[at] = row;
        self.weights[at] += weight;
        self.push[at] += weight * pushed;
    }

    /// Σ s_k x_k over a column, for any quantity.
    pub fn sum(&self, value: impl Fn(u32) -> Vector3<f64>) -> Vector3<f64> {
        (0..self.count).map(|k| value(self.rows[k]) * self.weights[k]).sum()
    }

    /// The inverse masses of its points in 1/kg.
    pub fn inverse_masses<R: Real>(&self, displacement: &[Row4<R>]) -> [f64; 6] {
        self.rows.map(|row| displacement[row as usize].0[3].to_f64())
    }

    /// Σ w_k s_k p_k: how far a unit push along the link changes its length, in 1/kg.
    pub fn mobility<R: Real>(&self, displacement: &[Row4<R>]) -> f64 {
        let of =
            |k: usize| displacement[self.rows[k] as usize].0[3].to_f64() * self.weights[k] * self.push[k];
        (0..self.count).map(of).sum()
    }

    /// Adds `change` per inverse mass to a column, along the link: each point by its inverse mass and its push.
    pub fn apply<R: Real>(&self, inverse_masses: &[f64], column: &mut [Row4<R>], change: Vector3<f64>) {
        for k in 0..self.count {
            let factor = inverse_masses[k] * self.push[k];
            let row = &mut column[self.rows[k] as usize];
            (0..3).for_each(|axis| row.0[axis] += R::from_f64(change[axis] * factor));
        }
    }
}

/// Where prescribed sides are.
#[derive(Clone, Copy)]
pub struct Prescribed<'a> {
    /// The colliders in this frame.
    pub colliders: &'a [ColliderState],
    /// The constraint.
    pub frame: &'a ConstraintFrame,
}

impl Prescribed<'_> {
    /// The part of a link's distance vector that is prescribed, at a time of the frame, in metres.
    pub fn vector(&self, link: &Link, time: f64) -> Vector3<f64> {
        self.place(&link.sides[0], time) - self.place(&link.sides[1], time)
    }

    fn place(&self, side: &LinkSide, time: f64) -> Vector3<f64> {
        match *side {
            LinkSide::Cloth { .. } => Vector3::zeros(),
            LinkSide::Collider { collider, points, weights } => {
                let state = &self.colliders[collider.index()];
                points
                    .into_iter()
                    .zip(weights)
                    .map(|(point, weight)| state.point(point.0, time) * weight)
                    .sum()
            }
            LinkSide::Space(place) => {
                let [start, end] = self.frame.space.map(|(linear, offset)| linear * place + offset);
                start + (end - start) * time
            }
        }
    }
}

/// The distance vector of a link at a time of the frame, in metres.
pub fn vector<R: Real>(
    link: &Link,
    ends: &Ends,
    state: &State<R>,
    prescribed: Prescribed<'_>,
    time: f64,
) -> Vector3<f64> {
    ends.sum(|row| Vector3::from(state.position(row))) + prescribed.vector(link, time)
}

/// The distance vector of a link at the start of the time step, a time of the frame, in metres.
pub fn start_vector<R: Real>(
    link: &Link,
    ends: &Ends,
    state: &State<R>,
    prescribed: Prescribed<'_>,
    time: f64,
) -> Vector3<f64> {
    let start = |row: u32| {
        let moved = state.start[row as usize].xyz().map(R::to_f64);
        Vector3::from(state.anchor[row as usize]) + Vector3::from(moved)
    };
    ends.sum(start) + prescribed.vector(link, time)
}
