//! The columns of the pass of pressure, which each of its passes fills anew.

use nalgebra::Vector3;

use crate::math::{Real, Row4};

/// The columns of the pass of pressure. They last so that a time step allocates nothing.
#[derive(Debug, Clone)]
pub struct Inflation<R> {
    /// By chamber of a cloth.
    pub sums: Vec<ChamberSums>,
    /// By chamber of a cloth: λ, by which its points are pushed.
    pub pushes: Vec<R>,
    /// By piece of a mesh that can tear.
    pub pieces: Vec<AreaSums>,
    /// By piece: the share of the pressure that it gets.
    pub shares: Vec<R>,
    /// The corners of one hole, in metres.
    pub corners: Vec<Vector3<f64>>,
}

impl<R> Default for Inflation<R> {
    fn default() -> Self {
        let (sums, pieces, corners) = (Vec::new(), Vec::new(), Vec::new());
        Self { sums, pushes: Vec::new(), pieces, shares: Vec::new(), corners }
    }
}

impl<R> Inflation<R> {
    /// The memory of its columns.
    pub fn bytes(&self) -> usize {
        let Self { sums, pushes, pieces, shares, corners } = self;
        size_of_val(&sums[..])
            + size_of_val(&pushes[..])
            + size_of_val(&pieces[..])
            + size_of_val(&shares[..])
            + size_of_val(&corners[..])
    }
}

/// Sums over a chamber in one time step.
#[derive(Debug, Clone, Copy, Default)]
pub struct ChamberSums {
    /// Three times the volume.
    pub volume: f64,
    /// Σ w |a|².
    pub mobility: f64,
    /// The largest w² |a|² of a point.
    pub fastest: f64,
    /// Σ |a| in m²: about the area of the mesh.
    pub area: f64,
    /// Area of the holes in m², and the flow of still air into them in m³/s.
    pub hole: f64,
    /// See `hole`.
    pub inflow: f64,
    /// Whether it is torn or in pieces, so that its volume has no meaning.
    pub is_torn: bool,
}

/// Sums of the area vectors, and of their lengths.
#[derive(Debug, Clone, Copy, Default)]
pub struct AreaSums {
    /// In m².
    pub vectors: Vector3<f64>,
    /// In m².
    pub lengths: f64,
}

impl AreaSums {
    /// Adds the vector of a point.
    pub fn add<R: Real>(&mut self, area: &Row4<R>) {
        let area = Vector3::from(area.xyz().map(R::to_f64));
        self.vectors += area;
        self.lengths += area.norm();
    }

    /// 1 for a closed surface, 0 for a flat one.
    pub fn closed(&self) -> f64 {
        if self.lengths > 0.0 { (1.0 - self.vectors.norm() / self.lengths).max(0.0) } else { 0.0 }
    }
}
