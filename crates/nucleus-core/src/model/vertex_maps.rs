//! Vertex maps: factors on attributes, point by point.
//!
//! An empty map is 1 everywhere: it takes no memory, and no pass reads it. A link or hinge has the mean over its
//! points. A factor on a resistance is a share, 0 to 1, of the cloth's attribute, because a Classic evaluation cannot
//! remove more than the whole error.

use crate::model::build_error::BuildError;

/// Factors on attributes, one per point in the mesh's order; an empty map is 1 everywhere.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct VertexMaps {
    /// On the mass; above zero.
    pub mass: Vec<f64>,
    /// Share of the resistance of links longer than at rest, 0 to 1.
    pub stretch: Vec<f64>,
    /// Share of the resistance of links shorter than at rest, 0 to 1.
    pub compression: Vec<f64>,
    /// Share of the bend resistance, 0 to 1.
    pub bend: Vec<f64>,
    /// On the rest length of links.
    pub rest_length: Vec<f64>,
    /// On `damp`.
    pub damp: Vec<f64>,
    /// On `drag`.
    pub drag: Vec<f64>,
    /// On `tangential_drag`.
    pub tangential_drag: Vec<f64>,
    /// On `lift`.
    pub lift: Vec<f64>,
    /// On `thickness`. This and the following maps are interpolated at the contact point, by its barycentric weights.
    pub thickness: Vec<f64>,
    /// On `friction`.
    pub friction: Vec<f64>,
    /// On `stickiness`.
    pub stickiness: Vec<f64>,
    /// On `bounce`.
    pub bounce: Vec<f64>,
    /// On `collide_strength`.
    pub collide_strength: Vec<f64>,
    /// On the attraction to the input mesh.
    pub input_attract: Vec<f64>,
    /// Share of `rigidity`.
    pub rigidity: Vec<f64>,
    /// Share of `deform_resistance`.
    pub deform: Vec<f64>,
    /// On `angle_dropoff`.
    pub angle_dropoff: Vec<f64>,
    /// On the angle beyond which bends stay.
    pub yield_angle: Vec<f64>,
    /// On the magnitude of the force field.
    pub field_magnitude: Vec<f64>,
}

/// Smaller shares count as zero.
const MIN_SHARE: f64 = 1e-6;

impl VertexMaps {
    /// Every map, with its name and range.
    fn columns(&self) -> [(&'static str, &[f64], [f64; 2]); 20] {
        const ANY: [f64; 2] = [0.0, 1e6];
        const SHARE: [f64; 2] = [0.0, 1.0];
        [
            ("mass", &self.mass, [1e-6, 1e6]),
            ("stretch", &self.stretch, SHARE),
            ("compression", &self.compression, SHARE),
            ("bend", &self.bend, SHARE),
            ("rest length", &self.rest_length, ANY),
            ("damp", &self.damp, ANY),
            ("drag", &self.drag, ANY),
            ("tangential drag", &self.tangential_drag, ANY),
            ("lift", &self.lift, ANY),
            ("thickness", &self.thickness, ANY),
            ("friction", &self.friction, ANY),
            ("stickiness", &self.stickiness, ANY),
            ("bounce", &self.bounce, ANY),
            ("collide strength", &self.collide_strength, ANY),
            ("input attract", &self.input_attract, ANY),
            ("rigidity", &self.rigidity, SHARE),
            ("deform resistance", &self.deform, SHARE),
            ("bend angle dropoff", &self.angle_dropoff, ANY),
            ("restitution angle", &self.yield_angle, ANY),
            ("field magnitude", &self.field_magnitude, ANY),
        ]
    }

    /// Refuses maps whose length is not the number of points, and factors out of range.
    pub(crate) fn check(&self, points: usize) -> Result<(), BuildError> {
        for (column, factors, [least, most]) in self.columns() {
            if !factors.is_empty() && factors.len() != points {
                return Err(BuildError::FactorCount { column, factors: factors.len(), points });
            }
            let bad = |factor: &f64| !(least..=most).contains(factor);
            if let Some(point) = factors.iter().position(bad) {
                return Err(BuildError::BadFactor { column, point, factor: factors[point], least, most });
            }
        }
        Ok(())
    }
}

/// The mean of a map over some points; 1 for an empty map.
pub(crate) fn mean(column: &[f64], points: impl ExactSizeIterator<Item = usize>) -> f64 {
    let count = points.len() as f64;
    if column.is_empty() { 1.0 } else { points.map(|point| column[point]).sum::<f64>() / count }
}

/// The mean of a map of shares; at most 1, and 0 below [`MIN_SHARE`].
pub(crate) fn mean_share(column: &[f64], points: impl ExactSizeIterator<Item = usize>) -> f64 {
    let share = mean(column, points);
    if share < MIN_SHARE { 0.0 } else { share.min(1.0) }
}
