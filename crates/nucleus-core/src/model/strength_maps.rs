//! Vertex maps per row: the factor of each link and hinge, laid out like the rows themselves, and those of the air per
//! point.

use std::ops::Range;

use crate::constraints::hinge::HingeRow;
use crate::constraints::strength_map::{StrengthGroup, StrengthRow};
use crate::constraints::stretch::LinkRow;
use crate::constraints::weave::{WeaveGroup, WeaveRow};
use crate::math::Real;
use crate::model::vertex_maps::{VertexMaps, mean, mean_share};

use crate::model::blocks::Blocks;
use crate::model::order::Order;
use crate::model::rows::{Row, RowList};

/// The strength maps of the lists of a cloth; a list without a map is empty.
#[derive(Debug, Clone)]
pub struct StrengthMaps<R> {
    /// Of links, above and below their rest length.
    pub stretch: RowList<StrengthGroup<R>>,
    /// Of hinges of four points.
    pub bend: RowList<StrengthGroup<R>>,
    /// Of hinges of six points.
    pub bend_six: RowList<StrengthGroup<R>>,
    /// On the damping of links; both sides are the same.
    pub damp: RowList<StrengthGroup<R>>,
    /// Of hinges of four points: on the dropoff (above), and on the angle beyond which bends stay (below).
    pub angles: RowList<StrengthGroup<R>>,
    /// The same of hinges of six points.
    pub angles_six: RowList<StrengthGroup<R>>,
    /// Directions of links along edges, in cloth that is woven or buckles.
    pub stretch_weave: RowList<WeaveGroup<R>>,
    /// Directions of cross links, in woven cloth.
    pub shear_weave: RowList<WeaveGroup<R>>,
}

impl<R> Default for StrengthMaps<R> {
    fn default() -> Self {
        let none = RowList::default;
        let (stretch, damp) = (none(), none());
        let (stretch_weave, shear_weave) = (RowList::default(), RowList::default());
        Self {
            stretch,
            bend: none(),
            bend_six: none(),
            damp,
            angles: none(),
            angles_six: none(),
            stretch_weave,
            shear_weave,
        }
    }
}

impl<R> StrengthMaps<R> {
    /// How many rows have a factor.
    pub fn len(&self) -> usize {
        let lists = [&self.stretch, &self.bend, &self.bend_six, &self.damp, &self.angles, &self.angles_six];
        lists.iter().map(|list| list.len()).sum()
    }

    /// How many links have a direction.
    pub fn woven(&self) -> usize {
        self.stretch_weave.len() + self.shear_weave.len()
    }
}

/// The directions of links, laid out like them.
pub fn weave_of<R: Real>(rows: &[LinkRow<R>], levels: &[u32], blocks: &Blocks) -> RowList<WeaveGroup<R>> {
    RowList::in_levels(&rows.iter().map(WeaveRow::new).collect::<Vec<_>>(), levels, blocks)
}

/// The factors of the vertex maps on the aerodynamic forces of a point, each over its mass factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AirFactors {
    /// On drag.
    pub drag: f64,
    /// On the share of drag along the surface.
    pub tangential_drag: f64,
    /// On lift.
    pub lift: f64,
}

impl AirFactors {
    /// No map.
    pub const NONE: Self = Self { drag: 1.0, tangential_drag: 1.0, lift: 1.0 };
}

/// Reads the vertex maps of a cloth for its rows.
pub struct MapReader<'a> {
    /// In the order of the mesh.
    pub maps: &'a VertexMaps,
    /// Between points of the mesh and places.
    pub order: &'a Order,
    /// The first row of the cloth in the columns.
    pub first: u32,
    /// The blocks of the cloth.
    pub blocks: &'a Blocks,
}

impl MapReader<'_> {
    /// The point of the mesh at a row of the columns.
    pub fn point(&self, row: u32) -> usize {
        self.order.user((row - self.first) as usize)
    }

    /// The map of links.
    pub fn links<R: Real>(&self, rows: &[LinkRow<R>], levels: &[u32]) -> RowList<StrengthGroup<R>> {
        let [above, below] = [&self.maps.stretch, &self.maps.compression];
        if above.is_empty() && below.is_empty() {
            return RowList::default();
        }
        let factors = |row: &LinkRow<R>| {
            StrengthRow::new(row.ends, [above, below].map(|c| self.mean_factor(c, row.ends)))
        };
        RowList::in_levels(&rows.iter().map(factors).collect::<Vec<_>>(), levels, self.blocks)
    }

    /// The map of the damping along links.
    pub fn damping<R: Real>(&self, rows: &[LinkRow<R>], levels: &[u32]) -> RowList<StrengthGroup<R>> {
        let damp = &self.maps.damp;
        if damp.is_empty() {
            return RowList::default();
        }
        let factor = |row: &LinkRow<R>| mean(damp, row.ends.map(|end| self.point(end)).into_iter());
        let row = |row: &LinkRow<R>| StrengthRow::new(row.ends, [factor(row); 2]);
        RowList::in_levels(&rows.iter().map(row).collect::<Vec<_>>(), levels, self.blocks)
    }

    /// The map of hinges.
    pub fn hinges<R: Real, const N: usize>(&self, rows: &[HingeRow<R, N>]) -> RowList<StrengthGroup<R>> {
        let bend = &self.maps.bend;
        if bend.is_empty() {
            return RowList::default();
        }
        let row = |row: &HingeRow<R, N>| {
            let points: [u32; N] = std::array::from_fn(|k| row.point(k));
            StrengthRow::new(points, [self.mean_factor(bend, points); 2])
        };
        RowList::new(&rows.iter().map(row).collect::<Vec<_>>(), self.blocks)
    }

    /// The maps of the angles of hinges.
    pub fn angles<R: Real, const N: usize>(&self, rows: &[HingeRow<R, N>]) -> RowList<StrengthGroup<R>> {
        let maps = [&self.maps.angle_dropoff, &self.maps.yield_angle];
        if maps.iter().all(|map| map.is_empty()) {
            return RowList::default();
        }
        let row = |row: &HingeRow<R, N>| {
            let points: [u32; N] = std::array::from_fn(|k| row.point(k));
            StrengthRow::new(points, maps.map(|map| mean(map, points.map(|p| self.point(p)).into_iter())))
        };
        RowList::new(&rows.iter().map(row).collect::<Vec<_>>(), self.blocks)
    }

    /// The factors of the air at these rows. A larger mass factor lessens drag and lift.
    pub fn air(&self, places: Range<u32>) -> Vec<AirFactors> {
        let VertexMaps { mass, drag, tangential_drag, lift, .. } = self.maps;
        if [mass, drag, tangential_drag, lift].iter().all(|column| column.is_empty()) {
            return Vec::new();
        }
        let at = |column: &[f64], point: usize| column.get(point).copied().unwrap_or(1.0);
        let factors = |point: usize| AirFactors {
            drag: at(drag, point) / at(mass, point),
            tangential_drag: at(tangential_drag, point),
            lift: at(lift, point) / at(mass, point),
        };
        places.map(|place| factors(self.point(place))).collect()
    }

    fn mean_factor<const N: usize>(&self, column: &[f64], places: [u32; N]) -> f64 {
        mean_share(column, places.map(|place| self.point(place)).into_iter())
    }
}
