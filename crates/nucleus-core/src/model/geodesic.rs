//! Distances along a mesh at rest, from each point to the nearest pins.
//!
//! Fast marching: labels spread from the pins in the order of their distance. Across a triangle with two labels of one
//! pin, the pin is unfolded into its plane (Novotni and Klein 2002), which is exact on a flat mesh; elsewhere a label
//! follows the edges, which is never too short.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::model::surface::Surface;
use crate::model::vertex_maps::mean;

/// Labels of a point, at most: of the nearest pins of two groups.
pub const LABELS: usize = 2;

/// The distance of a point from a pin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Label {
    /// The pin, as a point.
    pub pin: u32,
    /// Along the mesh, in metres.
    pub distance: f64,
    /// The group of pins: pins that edges join are one.
    group: u32,
}

/// A triangle that is seen from one of its corners.
#[derive(Debug, Clone, Copy)]
struct Corner {
    /// The other two.
    others: [u32; 2],
    /// The sides to them, and the one between them, in metres.
    sides: [f64; 3],
}

/// The edges of a mesh at rest.
#[derive(Debug, Clone, Default)]
pub struct RestDistances {
    /// By point: its triangles.
    corners: Vec<Vec<Corner>>,
}

/// Labels that spread from one point, and the points that have one.
struct Spread {
    found: Vec<Vec<Label>>,
    touched: Vec<u32>,
}

/// A label on its path: its distance as ordered bits, the point, the group and the pin.
type Arriving = Reverse<(u64, u32, u32, u32)>;

impl RestDistances {
    /// Of a mesh whose edges are longer by the factors of a vertex map, if there is one; `place` maps its points.
    pub fn new(surface: &Surface, rest_length: &[f64], place: impl Fn(u32) -> u32) -> Self {
        let mut corners = vec![Vec::new(); surface.positions.len()];
        let side = |ends: [u32; 2]| {
            let [a, b] = ends.map(|end| surface.positions[end as usize]);
            (b - a).norm() * mean(rest_length, ends.map(|end| end as usize).into_iter())
        };
        for triangle in surface.faces.triangles() {
            for k in 0..3 {
                let [own, a, b] = [0, 1, 2].map(|next| triangle[(k + next) % 3]);
                let sides = [side([own, a]), side([own, b]), side([a, b])];
                corners[place(own) as usize].push(Corner { others: [a, b].map(&place), sides });
            }
        }
        Self { corners }
    }

    /// The number of points.
    pub fn points(&self) -> usize {
        self.corners.len()
    }

    /// Bytes of its lists.
    pub fn bytes(&self) -> usize {
        self.corners.iter().map(|corners| size_of_val(&corners[..])).sum()
    }

    /// The labels of all points, nearest first; a pin has that of itself, and a point that no edges join with a pin has
    /// none.
    pub fn labels(&self, is_pinned: &[bool]) -> Vec<Vec<Label>> {
        let mut labels: Vec<Vec<Label>> = vec![Vec::new(); self.corners.len()];
        let mut arriving: BinaryHeap<Arriving> = BinaryHeap::new();
        for (pin, group) in self.groups(is_pinned) {
            arriving.push(Reverse((0, pin, group, pin)));
        }
        while let Some(Reverse((bits, point, group, pin))) = arriving.pop() {
            let own = &mut labels[point as usize];
            let most = if is_pinned[point as usize] { 1 } else { LABELS };
            if own.len() >= most || own.iter().any(|label| label.group == group) {
                continue;
            }
            let label = Label { pin, distance: f64::from_bits(bits), group };
            own.push(label);
            for corner in &self.corners[point as usize] {
                for (point, distance) in spread(corner, &label, &labels) {
                    arriving.push(Reverse((distance.to_bits(), point, group, pin)));
                }
            }
        }
        labels
    }

    /// For each point, a point towards its nearest pin at a distance of about `radius`, and the distance along the mesh to
    /// it, in metres; `None` for pins and for points that are nearer to a pin.
    ///
    /// Labels spread from the point in a narrow strip round the shortest path to the pin. Of those that arrive at `radius`,
    /// the one with the shortest path to the pin counts.
    pub fn towards_pins(&self, labels: &[Vec<Label>], radius: f64) -> Vec<Option<(u32, f64)>> {
        let mut spread_from = Spread { found: vec![Vec::new(); labels.len()], touched: Vec::new() };
        let from_pin =
            |point: u32| labels[point as usize].first().map_or(f64::INFINITY, |label| label.distance);
        let one = |point: u32| {
            let own = from_pin(point);
            // The distance to the pin is that of its tether.
            (own.is_finite() && own > radius)
                .then(|| self.towards_pin(point, radius, &from_pin, &mut spread_from))
        };
        (0..labels.len() as u32).map(one).map(Option::flatten).collect()
    }

    fn towards_pin(
        &self,
        point: u32,
        radius: f64,
        from_pin: &impl Fn(u32) -> f64,
        local: &mut Spread,
    ) -> Option<(u32, f64)> {
        let Spread { found, touched } = local;
        touched.drain(..).for_each(|other| found[other as usize].clear());
        let longest = self.corners[point as usize].iter().map(|corner| corner.sides[0]).fold(0.0, f64::max);
        let (own, most) = (from_pin(point), radius + longest);
        let mut best: Option<(f64, u32, f64)> = None;
        let mut arriving: BinaryHeap<Reverse<(u64, u32)>> = [Reverse((0, point))].into();
        while let Some(Reverse((bits, at))) = arriving.pop() {
            let label = Label { pin: point, distance: f64::from_bits(bits), group: point };
            if label.distance > most {
                break;
            }
            if !found[at as usize].is_empty() {
                continue;
            }
            found[at as usize].push(label);
            touched.push(at);
            let path = label.distance + from_pin(at);
            if label.distance >= radius && best.is_none_or(|(least, ..)| path < least) {
                best = Some((path, at, label.distance));
            }
            for (next, distance) in self.corners[at as usize].iter().flat_map(|c| spread(c, &label, found)) {
                if distance + from_pin(next) < own + longest / 2.0 {
                    arriving.push(Reverse((distance.to_bits(), next)));
                }
            }
        }
        best.map(|(_, at, distance)| (at, distance))
    }

    /// The mean length of the edges, in metres.
    pub fn mean_edge(&self) -> f64 {
        let sides = self.corners.iter().flatten().flat_map(|corner| [corner.sides[0], corner.sides[1]]);
        let (sum, count) = sides.fold((0.0, 0.0), |(sum, count), side| (sum + side, count + 1.0));
        sum / f64::max(count, 1.0)
    }

    /// All pins, each with its group.
    fn groups(&self, is_pinned: &[bool]) -> Vec<(u32, u32)> {
        let mut found = Vec::new();
        let mut seen = vec![false; is_pinned.len()];
        for first in (0..is_pinned.len()).filter(|&point| is_pinned[point]) {
            let mut left = vec![first as u32];
            while let Some(pin) = left.pop() {
                if std::mem::replace(&mut seen[pin as usize], true) {
                    continue;
                }
                found.push((pin, first as u32));
                let others = self.corners[pin as usize].iter().flat_map(|corner| corner.others);
                left.extend(others.filter(|&other| is_pinned[other as usize]));
            }
        }
        found
    }
}

/// The distances of the other two corners of a triangle, from a label of one of them.
fn spread(corner: &Corner, label: &Label, labels: &[Vec<Label>]) -> [(u32, f64); 2] {
    let [to_a, to_b, between] = corner.sides;
    let [a, b] = corner.others;
    let of = |point: u32| {
        let mut own = labels[point as usize].iter();
        own.find(|other| other.group == label.group && other.pin == label.pin).map(|other| other.distance)
    };
    let distance = |side: f64, base: f64, other: Option<f64>, opposite: f64| {
        let unfolded = other.and_then(|other| unfold([label.distance, other], base, [side, opposite]));
        let along = label.distance + side;
        unfolded.map_or(along, |unfolded| unfolded.min(along))
    };
    [(a, distance(to_a, to_b, of(b), between)), (b, distance(to_b, to_a, of(a), between))]
}

/// The distance of a third corner of a triangle from a place in its plane that has these distances from the other two, on
/// their other side. `base` is the side between the two, `sides` are those to the third. `None` where the straight line
/// does not cross the base.
fn unfold([from_p, from_q]: [f64; 2], base: f64, [to_p, to_q]: [f64; 2]) -> Option<f64> {
    // p is the origin and q on the first axis.
    let place = |to_p: f64, to_q: f64| {
        let x = (to_p * to_p - to_q * to_q + base * base) / (2.0 * base);
        let square = to_p * to_p - x * x;
        // On the base itself, but for rounding.
        let square = if square.abs() < 1e-12 * base * base { 0.0 } else { square };
        (x, square.sqrt())
    };
    let ((x, y), (source_x, depth)) = (place(to_p, to_q), place(from_p, from_q));
    let crossing = source_x + (x - source_x) * depth / (y + depth);
    let distance = ((x - source_x) * (x - source_x) + (y + depth) * (y + depth)).sqrt();
    let slack = 1e-9 * base;
    (crossing >= -slack && crossing <= base + slack && distance.is_finite()).then_some(distance)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::model::surface::Faces;

    /// A grid of `side` by `side` points in the unit square, bent round an axis with this radius; each cell is two triangles
    /// if `split`.
    fn grid(side: u32, radius: f64, split: bool) -> Surface {
        let at = |k: u32| f64::from(k) / f64::from(side - 1);
        let bend = |u: f64, v: f64| match radius.is_finite() {
            true => Vector3::new(radius * (u / radius).sin(), radius * (u / radius).cos(), v),
            false => Vector3::new(u, 0.0, v),
        };
        let points = (0..side * side).map(|k| bend(at(k % side), at(k / side)));
        let mut surface = Surface { positions: points.collect(), faces: Faces::default() };
        for (row, column) in (0..side - 1).flat_map(|row| (0..side - 1).map(move |column| (row, column))) {
            let a = row * side + column;
            if split {
                surface.faces.push(&[a, a + 1, a + side]);
                surface.faces.push(&[a + 1, a + side + 1, a + side]);
            } else {
                surface.faces.push(&[a, a + side, a + side + 1, a + 1]);
            }
        }
        surface
    }

    fn distances(surface: &Surface, pins: &[usize]) -> Vec<Vec<Label>> {
        let mut is_pinned = vec![false; surface.positions.len()];
        pins.iter().for_each(|&pin| is_pinned[pin] = true);
        RestDistances::new(surface, &[], |point| point).labels(&is_pinned)
    }

    #[test]
    fn distances_on_a_flat_mesh_are_straight_lines() {
        for split in [false, true] {
            let surface = grid(13, f64::INFINITY, split);
            for (point, labels) in distances(&surface, &[0, 12]).iter().enumerate() {
                for label in labels {
                    let straight = (surface.positions[point] - surface.positions[label.pin as usize]).norm();
                    let off = label.distance - straight;
                    assert!(off > -1e-9 && off < 0.01 * straight + 1e-9, "{point} to {label:?}: {straight}");
                }
            }
        }
    }

    #[test]
    fn a_long_link_on_a_flat_mesh_is_as_long_as_its_straight_line_and_points_to_the_pin() {
        for (split, pins) in [(false, vec![0]), (true, vec![12]), (true, (0..13).collect())] {
            let surface = grid(13, f64::INFINITY, split);
            let mut is_pinned = [false; 169];
            pins.iter().for_each(|&pin: &usize| is_pinned[pin] = true);
            let mesh = RestDistances::new(&surface, &[], |point| point);
            let labels = mesh.labels(&is_pinned);
            let radius = 4.0 / 12.0;
            for (point, found) in mesh.towards_pins(&labels, radius).into_iter().enumerate() {
                let Some((end, distance)) = found else { continue };
                let straight = (surface.positions[point] - surface.positions[end as usize]).norm();
                assert!(
                    distance > straight - 1e-9 && distance < 1.01 * straight,
                    "{point} to {end}: {distance}"
                );
                let [own, next] = [point, end as usize].map(|point| labels[point][0].distance);
                assert!(
                    distance >= radius && own - next > 0.9 * distance,
                    "{point} to {end}: {own} and {next} m"
                );
            }
        }
    }

    #[test]
    fn distances_round_a_cylinder_are_those_of_the_unrolled_sheet() {
        let radius = 0.5;
        let surface = grid(25, radius, true);
        let flat = grid(25, f64::INFINITY, true);
        for (point, labels) in distances(&surface, &[0]).iter().enumerate() {
            let unrolled = (flat.positions[point] - flat.positions[0]).norm();
            // Edges are chords of the cylinder, shorter than arcs by a part in 3000.
            let off = labels[0].distance / unrolled.max(1e-9) - 1.0;
            assert!(point == 0 || (-1e-3..0.01).contains(&off), "{point}: {off}");
        }
    }

    #[test]
    fn pins_that_edges_join_are_one_group_and_points_have_the_nearest_of_two() {
        let surface = grid(9, f64::INFINITY, true);
        let labels = distances(&surface, &[0, 1, 2, 8]);
        let pins = |point: usize| labels[point].iter().map(|label| label.pin).collect::<Vec<_>>();
        assert_eq!(pins(0), [0]);
        assert_eq!(pins(9 * 8 + 2), [2, 8], "below the third point");
        assert_eq!(pins(9 * 8 + 8), [8, 2]);
    }

    #[test]
    fn a_part_without_pins_has_no_labels() {
        let mut surface = grid(3, f64::INFINITY, true);
        let far = grid(3, f64::INFINITY, true);
        let count = surface.positions.len() as u32;
        surface.positions.extend(far.positions.iter().map(|p| p + Vector3::y()));
        for triangle in far.faces.triangles() {
            surface.faces.push(&triangle.map(|point| point + count));
        }
        let labels = distances(&surface, &[0]);
        assert!(labels[..9].iter().all(|labels| labels.len() == 1));
        assert!(labels[9..].iter().all(Vec::is_empty));
    }
}
