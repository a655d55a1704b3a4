//! The gradient of a link on a surface: how its length changes with each point, and with the turn of the face.
//!
//! With d from the foot Σ w_i x_i to the place and the unit normal n of the face, δn = -Σ g_i (n·δx_i), where g_i is the
//! gradient of the barycentric coordinate i in the plane of the face. So d·n changes by -(w_i + g_i·d) n·δx_i, and d·t by
//! (-w_i t + (d·n) (g_i·t) n)·δx_i. Without the tilt, a link that holds a place far from a face would turn the face without
//! an opposite torque, and feed on it.
//!
//! The direction m of an oblique link turns with the frame of the face, δm = φ × m, whose rotation φ is the tilt n × δn and the turn
//! of the first edge about n. So d·m changes by φ·(m × d), and its length across m, along t, by -(d·m) φ·(m × t).

use nalgebra::Vector3;

use crate::input::links::Link;
use crate::math::{Real, Row4};
use crate::state::State;

use super::ends::Ends;

type Point = Vector3<f64>;

/// The gradient of a length: of each point a vector, and how it is moved, which weights of sides change.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gradient {
    count: usize,
    rows: [u32; 6],
    of: [Point; 6],
    push: [Point; 6],
}

impl Gradient {
    /// That of the distance vector of a link along a unit vector, at a fixed tilt.
    pub(super) fn along(ends: &Ends, unit: Point) -> Self {
        Self {
            count: ends.count,
            rows: ends.rows,
            of: ends.weights.map(|weight| unit * weight),
            push: ends.push.map(|push| unit * push),
        }
    }

    /// Subtracts the change of a face's unit normal times a vector, which is given with a factor. `weight` is that of the side.
    pub(super) fn add_tilt(
        &mut self,
        (corners, face): ([u32; 3], [Point; 3]),
        normal: Point,
        (lever, factor): (Point, f64),
        weight: f64,
    ) {
        for (corner, of) in corners.into_iter().zip(barycentric_gradients(face)) {
            self.add(corner, normal * (of.dot(&lever) * factor), weight);
        }
    }

    /// Adds the rotation of a face's frame times a vector.
    pub(super) fn add_turn(&mut self, on: ([u32; 3], [Point; 3]), torque: Point, weight: f64) {
        let ([first, second, _], face) = on;
        let Some([along, across, normal]) = Link::face_frame(face) else { return };
        self.add_tilt(on, normal, (normal.cross(&torque), 1.0), weight);
        let turn = across * (normal.dot(&torque) / along.dot(&(face[1] - face[0])));
        self.add(first, -turn, weight);
        self.add(second, turn, weight);
    }

    /// Adds the part of a corner of the face. `weight` is that of the side.
    fn add(&mut self, row: u32, change: Point, weight: f64) {
        let known = self.rows[..self.count].iter().position(|&other| other == row);
        let at = known.unwrap_or(self.count);
        self.count = self.count.max(at + 1);
        self.rows[at] = row;
        self.of[at] += change;
        self.push[at] += change * weight;
    }

    /// How far a unit push changes the length, in 1/kg.
    pub(super) fn mobility<R: Real>(&self, displacement: &[Row4<R>]) -> f64 {
        let of = |k: usize| displacement[self.rows[k] as usize].0[3].to_f64() * self.of[k].dot(&self.push[k]);
        (0..self.count).map(of).sum()
    }

    /// How far the motion of the time step has changed the length.
    pub(super) fn motion<R: Real>(&self, state: &State<R>) -> f64 {
        let moved = |row: usize| {
            let [end, start] = [&state.displacement, &state.start].map(|column| column[row].xyz());
            Point::from(end.map(R::to_f64)) - Point::from(start.map(R::to_f64))
        };
        (0..self.count).map(|k| self.of[k].dot(&moved(self.rows[k] as usize))).sum()
    }

    /// Moves each point along its gradient by `change` times its inverse mass.
    pub(super) fn displace<R: Real>(&self, displacement: &mut [Row4<R>], change: f64) {
        for (&row, push) in self.rows[..self.count].iter().zip(self.push) {
            let row = &mut displacement[row as usize];
            let moved = push * (change * row.0[3].to_f64());
            (0..3).for_each(|axis| row.0[axis] += R::from_f64(moved[axis]));
        }
    }
}

/// The gradients of the barycentric coordinates of a triangle in its plane, in 1/m; zero without area.
pub(super) fn barycentric_gradients([a, b, c]: [Point; 3]) -> [Point; 3] {
    let normal = (b - a).cross(&(c - a));
    let square = normal.norm_squared();
    let of = |edge: Point| if square > 0.0 { normal.cross(&edge) / square } else { Point::zeros() };
    [of(c - b), of(a - c), of(b - a)]
}

/// The unit vector with these components along the first edge of a triangle and across it; zero without area.
pub(super) fn direction_on(face: [Point; 3], [along, across]: [f64; 2]) -> Point {
    let above = (1.0 - along * along - across * across).max(0.0).sqrt();
    let of = |axes: [Point; 3]| axes[0] * along + axes[1] * across + axes[2] * above;
    Link::face_frame(face).map(of).and_then(|direction| direction.try_normalize(0.0)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn barycentric_coordinates_grow_from_the_opposite_edge_to_the_corner() {
        let corners = [Point::new(0.0, 0.0, 1.0), Point::new(2.0, 0.5, 1.0), Point::new(0.3, 1.0, 2.0)];
        let gradients = barycentric_gradients(corners);
        for (i, gradient) in gradients.iter().enumerate() {
            for (j, corner) in corners.iter().enumerate() {
                let grown = gradient.dot(&(corner - corners[(i + 1) % 3]));
                assert!((grown - f64::from(u8::from(i == j))).abs() < 1e-12, "{i} {j}: {grown}");
            }
        }
    }
}
