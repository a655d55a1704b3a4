//! Maps of what points bring into a contact: a factor on each attribute of their cloth.

use crate::math::Real;
use crate::model::ClothModel;
use crate::model::builder::Cloth;
use crate::model::vertex_maps::VertexMaps;

/// A factor for each of the solver's places; a column that no cloth has a map of is empty, and costs nothing.
#[derive(Debug, Clone, Default)]
pub struct Maps<R> {
    /// On the thickness.
    pub thickness: Vec<R>,
    /// On the friction.
    pub friction: Vec<R>,
    /// On the stickiness.
    pub stickiness: Vec<R>,
    /// On the bounce.
    pub bounce: Vec<R>,
    /// On the collide strength.
    pub strength: Vec<R>,
    /// The largest factor on the thickness of each cloth.
    pub thickest: Vec<f64>,
}

impl<R: Real> Maps<R> {
    /// How many factors there are.
    pub fn len(&self) -> usize {
        let columns = [&self.thickness, &self.friction, &self.stickiness, &self.bounce, &self.strength];
        columns.iter().map(|column| column.len()).sum()
    }

    /// The maps of all cloths, which have so many places together.
    pub fn new(cloths: &[Cloth], models: &[ClothModel<R>], places: usize) -> Self {
        let column = |of: fn(&VertexMaps) -> &Vec<f64>| {
            if cloths.iter().all(|cloth| of(&cloth.factors).is_empty()) {
                return Vec::new();
            }
            let mut column = vec![R::ONE; places];
            for (cloth, model) in cloths.iter().zip(models) {
                for (point, &factor) in of(&cloth.factors).iter().enumerate() {
                    column[model.place(point) as usize] = R::from_f64(factor);
                }
            }
            column
        };
        let most = |map: &Vec<f64>| map.iter().copied().reduce(f64::max).unwrap_or(1.0);
        Self {
            thickness: column(|factors| &factors.thickness),
            friction: column(|factors| &factors.friction),
            stickiness: column(|factors| &factors.stickiness),
            bounce: column(|factors| &factors.bounce),
            strength: column(|factors| &factors.collide_strength),
            thickest: cloths.iter().map(|cloth| most(&cloth.factors.thickness)).collect(),
        }
    }
}

/// The factor on an element, by how near each of its points is; 1 where there is no map, or no point that has one.
#[inline(always)]
pub fn at<R: Real, const N: usize>(map: &[R], points: [u32; N], weights: [R; N]) -> R {
    if map.is_empty() || N == 0 { R::ONE } else { (0..N).map(|k| weights[k] * map[points[k] as usize]).sum() }
}
