//! Vertex maps of a collider's contact attributes, interpolated at a contact over the face, edge or point that is touched.
//!
//! Contacts do not store weights on the collider's side: they are computed again where a collider has a map, so that a
//! collider without one costs nothing.

use crate::model::vertex_maps::VertexMaps;

/// Factors on the contact attributes of a collider, one per point of its mesh; an empty map is 1 everywhere.
#[derive(Debug, Clone, Default)]
pub struct ColliderMaps {
    thickness: Vec<f64>,
    friction: Vec<f64>,
    stickiness: Vec<f64>,
    bounce: Vec<f64>,
    strength: Vec<f64>,
    /// The largest factor on the thickness.
    pub max_thickness_factor: f64,
    /// Whether collisions are carried out in part at some point.
    pub is_partial: bool,
}

impl ColliderMaps {
    /// The maps of contact attributes among those of a collider.
    pub fn new(maps: &VertexMaps) -> Self {
        Self {
            thickness: maps.thickness.clone(),
            friction: maps.friction.clone(),
            stickiness: maps.stickiness.clone(),
            bounce: maps.bounce.clone(),
            strength: maps.collide_strength.clone(),
            max_thickness_factor: max_factor(&maps.thickness),
            is_partial: maps.collide_strength.iter().any(|&factor| factor < 1.0),
        }
    }

    /// The number of factors.
    pub fn len(&self) -> usize {
        [&self.thickness, &self.friction, &self.stickiness, &self.bounce, &self.strength]
            .iter()
            .map(|map| map.len())
            .sum()
    }

    /// Whether collisions with any of these points are carried out in part.
    pub fn are_partial(&self, points: &[u32]) -> bool {
        self.is_partial && points.iter().any(|&point| self.strength[point as usize] < 1.0)
    }

    /// The factors at a contact with these points, by their weights.
    pub fn at<const M: usize>(&self, points: [u32; M], weights: [f64; M]) -> ColliderFactors {
        let of = |map: &[f64]| {
            let factor = |k: usize| weights[k] * map[points[k] as usize];
            if map.is_empty() { 1.0 } else { (0..M).map(factor).sum::<f64>() }
        };
        ColliderFactors {
            thickness: of(&self.thickness),
            friction: of(&self.friction),
            stickiness: of(&self.stickiness),
            bounce: of(&self.bounce),
            strength: of(&self.strength),
        }
    }
}

/// Factors on the contact attributes of a collider at a contact.
#[derive(Debug, Clone, Copy)]
pub struct ColliderFactors {
    /// On the thickness.
    pub thickness: f64,
    /// On the friction.
    pub friction: f64,
    /// On the stickiness.
    pub stickiness: f64,
    /// On the bounce.
    pub bounce: f64,
    /// On the collide strength.
    pub strength: f64,
}

/// The largest factor of a map; 1 without a map.
pub fn max_factor(map: &[f64]) -> f64 {
    map.iter().copied().reduce(f64::max).unwrap_or(1.0)
}
