//! Vertex maps: factors on attributes, point by point.
//!
//! An empty map is 1 everywhere: it takes no memory, and no pass reads it. A link or hinge has the mean over its
//! points. A factor on a resistance is a share, 0 to 1, of the cloth's attribute, because a Classic evaluation cannot
//! remove more than the whole error.

use crate::model::build_error::BuildError;

/// Any factor.
const ANY: [f64; 2] = [0.0, 1e6];
/// A share of the attribute.
const SHARE: [f64; 2] = [0.0, 1.0];

/// Defines [`VertexMaps`]: for each map its field, its name in messages and its range.
macro_rules! vertex_maps {
    ($($(#[doc = $doc:literal])+ $field:ident: $name:literal, $range:expr;)+) => {
        /// Factors on attributes, one per point in the mesh's order; an empty map is 1 everywhere.
        #[derive(Debug, Clone, Default, PartialEq)]
        pub struct VertexMaps {
            $($(#[doc = $doc])+ pub $field: Vec<f64>,)+
        }

        impl VertexMaps {
            /// Every map, with its name and range.
            fn columns(&self) -> impl Iterator<Item = (&'static str, &[f64], [f64; 2])> {
                [$(($name, self.$field.as_slice(), $range)),+].into_iter()
            }

            /// Every map, to change its points.
            pub fn columns_mut(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
                [$(&mut self.$field),+].into_iter()
            }
        }
    };
}

vertex_maps! {
    /// On the mass; above zero.
    mass: "mass", [1e-6, 1e6];
    /// Share of the resistance of links longer than at rest, 0 to 1.
    stretch: "stretch", SHARE;
    /// Share of the resistance of links shorter than at rest, 0 to 1.
    compression: "compression", SHARE;
    /// Share of the bend resistance, 0 to 1.
    bend: "bend", SHARE;
    /// On the rest length of links.
    rest_length: "rest length", ANY;
    /// On `damp`.
    damp: "damp", ANY;
    /// On `drag`.
    drag: "drag", ANY;
    /// On `tangential_drag`.
    tangential_drag: "tangential drag", ANY;
    /// On `lift`.
    lift: "lift", ANY;
    /// On `thickness`. This and the following maps are interpolated at the contact point, by its barycentric weights.
    thickness: "thickness", ANY;
    /// On `friction`.
    friction: "friction", ANY;
    /// On `stickiness`.
    stickiness: "stickiness", ANY;
    /// On `bounce`.
    bounce: "bounce", ANY;
    /// On `collide_strength`.
    collide_strength: "collide strength", ANY;
    /// On the attraction to the input mesh.
    input_attract: "input attract", ANY;
    /// Share of `rigidity`.
    rigidity: "rigidity", SHARE;
    /// Share of `deform_resistance`.
    deform: "deform resistance", SHARE;
    /// On `angle_dropoff`.
    angle_dropoff: "bend angle dropoff", ANY;
    /// On the angle beyond which bends stay.
    yield_angle: "restitution angle", ANY;
    /// On the magnitude of the force field.
    field_magnitude: "field magnitude", ANY;
}

/// Smaller shares count as zero.
const MIN_SHARE: f64 = 1e-6;

impl VertexMaps {
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
