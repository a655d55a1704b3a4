//! Rows of links on surfaces, and the faces round each point of these surfaces.

use nalgebra::Vector3;

use crate::input::links::{Link, LinkSide};
use crate::input::{ClothId, ColliderId};
use crate::math::Real;
use crate::model::{ClothModel, ColliderModel};

use super::ends::Ends;

type Point = Vector3<f64>;

/// One link on a surface.
#[derive(Debug, Clone)]
pub struct SurfaceRow {
    /// The link.
    pub link: u32,
    /// Its free points; those of the foot change where it slides.
    pub ends: Ends,
    /// Direction from the foot of a sliding link to the place, where that is beside the faces and the foot on an edge.
    pub beside: Option<Point>,
    /// Distance that contact keeps between the sides in metres, up to which the link does not pull.
    pub contact_distance: f64,
    /// Impulse since the start of the substep in N·s.
    pub impulse: Point,
}

impl SurfaceRow {
    /// The row of a link.
    pub fn new(link: u32, ends: Ends) -> Self {
        Self { link, ends, beside: None, contact_distance: 0.0, impulse: Point::zeros() }
    }
}

/// The faces round each point of the surfaces that links slide on.
#[derive(Debug, Clone, Default)]
pub struct Topology {
    surfaces: Vec<(SurfaceId, CsrLists)>,
}

/// A surface that links are on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceId {
    /// A cloth.
    Cloth(ClothId),
    /// A collider.
    Collider(ColliderId),
}

impl SurfaceId {
    /// The surface of a side.
    pub fn of(side: &LinkSide) -> Option<Self> {
        match side {
            LinkSide::Cloth { cloth, .. } => Some(Self::Cloth(*cloth)),
            LinkSide::Collider { collider, .. } => Some(Self::Collider(*collider)),
            LinkSide::Space(_) => None,
        }
    }
}

impl Topology {
    /// The topology of all surfaces that these links are on.
    pub fn new<R: Real>(links: &[Link], cloths: &[ClothModel<R>], colliders: &[ColliderModel]) -> Self {
        let mut surfaces: Vec<(SurfaceId, CsrLists)> = Vec::new();
        for link in links.iter().filter(|link| link.is_on_surface()) {
            let Some(id) = SurfaceId::of(&link.sides[1]) else { continue };
            if surfaces.iter().any(|(known, _)| *known == id) {
                continue;
            }
            let (first, points, triangles) = match id {
                SurfaceId::Cloth(cloth) => {
                    let model = &cloths[cloth.index()];
                    (model.points().start, model.points().len(), &model.boundary.triangles)
                }
                SurfaceId::Collider(collider) => {
                    let model = &colliders[collider.index()];
                    (0, model.positions.len(), &model.boundary.triangles)
                }
            };
            let corners =
                (0..).zip(triangles).flat_map(|(at, corners)| corners.map(|corner| (corner - first, at)));
            surfaces.push((id, CsrLists::new(points, corners)));
        }
        Self { surfaces }
    }

    /// The faces round each point of a surface.
    pub fn of(&self, id: SurfaceId) -> Option<&CsrLists> {
        self.surfaces.iter().find(|(known, _)| *known == id).map(|(_, faces)| faces)
    }
}

/// Lists of numbers in compressed sparse rows: a list for each point.
#[derive(Debug, Clone, Default)]
pub struct CsrLists {
    numbers: Vec<u32>,
    ends: Vec<u32>,
}

impl CsrLists {
    /// Lists for `points` points, from pairs of point and number.
    pub fn new(points: usize, all: impl Iterator<Item = (u32, u32)> + Clone) -> Self {
        let mut ends = vec![0; points];
        all.clone().for_each(|(point, _)| ends[point as usize] += 1);
        let mut sum = 0;
        for end in &mut ends {
            sum += std::mem::replace(end, sum);
        }
        // `ends` holds the starts now, and the ends once all is filled in.
        let mut numbers = vec![0; sum as usize];
        for (point, number) in all {
            numbers[ends[point as usize] as usize] = number;
            ends[point as usize] += 1;
        }
        Self { numbers, ends }
    }

    /// The list of one point.
    pub fn of(&self, point: u32) -> &[u32] {
        let from = (point as usize).checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.numbers[from as usize..self.ends[point as usize] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_row_holds_exactly_the_numbers_given_for_its_point() {
        let given = [(0, 7), (2, 8), (1, 7), (2, 9), (2, 7)];
        let lists = CsrLists::new(4, given.into_iter());
        let expected: [&[u32]; 4] = [&[7], &[7], &[8, 9, 7], &[]];
        for (point, expected) in (0..).zip(expected) {
            assert_eq!(lists.of(point), expected, "{point}");
        }
    }
}
