//! The sheet that a surface is a part of, on which sliding links walk.

use nalgebra::Vector3;

use super::member::{Member, Places};
use super::near::foot;

type Point = Vector3<f64>;

/// A face: its points, and their places in metres.
type Face<'a> = (&'a [u32], &'a [Point]);

/// All faces of the object of a member.
pub(super) struct Sheet<'a> {
    member: &'a Member,
    corners: Vec<Vec<Point>>,
    /// First entry in `around` of each point, and the end of the last.
    starts: Vec<u32>,
    /// The faces around each point.
    around: Vec<u32>,
}

impl<'a> Sheet<'a> {
    pub(super) fn new(member: &'a Member, places: &Places) -> Self {
        let all = || (0..).zip(member.sheet.iter()).flat_map(|(at, face)| face.iter().map(move |&p| (p, at)));
        let mut pairs: Vec<(u32, u32)> = all().collect();
        pairs.sort_unstable();
        let points = pairs.last().map_or(0, |(point, _)| point + 1);
        let starts = (0..=points).map(|point| pairs.partition_point(|(p, _)| *p < point) as u32).collect();
        let corners = member
            .sheet
            .iter()
            .map(|face| face.iter().map(|&point| places.point(member.object, point)).collect());
        Self { member, corners: corners.collect(), starts, around: pairs.iter().map(|(_, at)| *at).collect() }
    }

    /// The face with the closest place on a walk from face to neighbouring face; `None` where it is the first one.
    pub(super) fn nearest(&self, to: Point, start: Face<'_>) -> Option<Face<'_>> {
        let distance = |polygon: &[Point]| (foot(polygon, to).place - to).norm_squared();
        let (mut best, mut face) = (distance(start.1), None);
        loop {
            let before = best;
            let around = face.map_or(start.0, |at: u32| self.member.sheet.face(at as usize));
            for &point in around {
                let [first, end] = [0, 1].map(|k| self.starts[point as usize + k] as usize);
                for &at in &self.around[first..end] {
                    let squared = distance(&self.corners[at as usize]);
                    if squared < best {
                        (best, face) = (squared, Some(at));
                    }
                }
            }
            if best >= before {
                return face.map(|at| (self.member.sheet.face(at as usize), &self.corners[at as usize][..]));
            }
        }
    }
}
