//! Bending rows: hinges between two faces, and the twist of quads.
//!
//! The bending vector of a row is c = Σ K_i x_i, with Σ K_i = 0 and, where the cloth is flat, Σ K_i x_i = 0. For
//! triangles K are the weights of Bergou et al. 2006, "A quadratic bending model for inextensible surfaces", §3; |c| is
//! then the length of the edge times the angle. The energy is B/2 · |c|², with K scaled so that B is the bending
//! stiffness of a plate in N·m on any mesh:
//!
//! - A hinge stands for half the cloth between the centres of its faces: K is divided by the root of A_0 + A_1 for
//!   triangles, of which three families cover the plane, and of (A_0 + A_1) / 2 for quads, of which two families do.
//! - In a quad a hinge uses the midpoint of the opposite edge. The two families of a grid then measure the two
//!   curvatures only, and the result does not depend on a diagonal.
//! - The twist of a quad is x_a - x_b + x_c - x_d, and stands for all of it. With it a grid is an isotropic plate: its
//!   energy is B/2 · (z_xx² + z_yy² + 2 z_xy²), Poisson's ratio zero.
//!
//! Equilateral triangles are a plate of the same B and a Poisson's ratio of -1/3 (Seung and Nelson 1988). A grid that
//! is cut along one diagonal is up to three times as stiff across that diagonal, so quads should stay quads.
//!
//! **Large angles.** |c| is 2 sin(θ/2) times its value at an angle of 1, and an energy of its square gives a moment of
//! sin θ: a third too small at 90°, and zero for a hinge that is folded shut. A hinge therefore resists with a moment
//! of 2 sin(θ/2), because along c its stiffness is divided by cos(θ/2). The tip of a strip of 50 elements that hangs
//! under its weight (Γ = 1000, 50° at the first hinge) is then 0.4 % off the exact elastica; with the square it is
//! 2.2 % off, with a moment of θ 1.2 %.

use nalgebra::Vector3;

use crate::math::{Lanes, Real};
use crate::model::rows::Row;
use crate::model::surface::Surface;
use crate::model::topology::{Seam, fan_triangles, seams, triangle_area};

/// A hinge of `N` points between rows of the solver's columns, before it is laid out.
#[derive(Debug, Clone, Copy)]
pub struct HingeRow<R, const N: usize> {
    pub(super) points: [u32; N],
    pub(super) weights: [R; N],
    pub(super) rest: R,
    inverse_square_max: R,
}

/// Four hinges side by side. In `f32` 48 bytes a hinge of four points, 56 of six.
#[derive(Debug, Clone, Copy)]
pub struct HingeGroup<R, const N: usize> {
    /// The points.
    pub points: [[u32; 4]; N],
    /// Their weights K, whose sum is zero: all of four, and of six the first, second, third (which is also the fourth) and
    /// fifth.
    weights: [[R; 4]; 4],
    /// The bending vector of the anchors. Written at the start of each frame.
    pub anchored: [[R; 4]; 3],
    /// One over the square of the vector's length when the hinge is folded shut: times |c|² it is sin²(θ/2). Zero for
    /// the twist of a quad, which has no such angle.
    pub inverse_square_max: [R; 4],
}

/// The lengths of the bending vectors of four hinges at rest; zero where flat.
#[derive(Debug, Clone, Copy)]
pub struct RestGroup<R> {
    /// By lane.
    pub rest: [R; 4],
}

/// The length of the bending vector of a hinge at rest, before it is laid out like the hinge.
#[derive(Debug, Clone, Copy)]
pub struct RestRow<R, const N: usize> {
    points: [u32; N],
    rest: R,
}

/// Lower bound of cos(θ/2): beyond 120° a hinge is not stiffer than twice. Folded shut it would be rigid, and open in
/// one step.
pub const MIN_COSINE: f64 = 0.5;

/// The rows of a mesh, by their number of points.
#[derive(Debug, Clone, Default)]
pub struct HingeRows<R> {
    /// Hinges between triangles, and twists of quads.
    pub of_four: Vec<HingeRow<R, 4>>,
    /// Hinges between quads.
    pub of_six: Vec<HingeRow<R, 6>>,
}

/// The bending rows of a mesh; `place` maps a point of the mesh to its row in the columns.
pub fn rows<R: Real>(surface: &Surface, place: impl Fn(u32) -> u32) -> HingeRows<R> {
    let mut rows = HingeRows { of_four: Vec::new(), of_six: Vec::new() };
    for seam in seams(surface) {
        match hinge(surface, &seam, &place) {
            Some(Hinge::Wide(row)) => rows.of_six.push(row),
            Some(Hinge::Narrow(row)) => rows.of_four.push(row),
            None => {}
        }
    }
    for face in surface.faces.iter().filter(|face| face.len() == 4) {
        rows.of_four.extend(twist(surface, [face[0], face[1], face[2], face[3]], &place));
    }
    for face in surface.faces.iter().filter(|face| face.len() > 4) {
        let fan: Vec<_> = fan_triangles(face).collect();
        for pair in fan.windows(2) {
            let [[a, c, b], [_, _, d]] = [pair[0], pair[1]];
            rows.of_four.extend(narrow(surface, [a, b, c, d], &place));
        }
    }
    rows.of_four.sort_unstable_by_key(|row| sorted(row.points));
    rows.of_six.sort_unstable_by_key(|row| sorted(row.points));
    rows
}

enum Hinge<R> {
    Narrow(HingeRow<R, 4>),
    Wide(HingeRow<R, 6>),
}

/// The hinge of an edge; `None` where a face has no area, and so no angle.
fn hinge<R: Real>(surface: &Surface, seam: &Seam, place: impl Fn(u32) -> u32) -> Option<Hinge<R>> {
    let faces = seam.faces.map(|face| surface.faces.face(face as usize));
    let [a, b] = seam.ends;
    if faces.iter().all(|face| face.len() == 4) {
        let [[c, d], [e, f]] = faces.map(|face| far_side(face, seam.ends));
        let points = [a, b, c, d, e, f];
        if all_differ(points) {
            return wide(surface, points, place).map(Hinge::Wide);
        }
    }
    let [c, d] = faces.map(|face| apex(face, seam.ends));
    let points = [a, b, c?, d?];
    if all_differ(points) { narrow(surface, points, place).map(Hinge::Narrow) } else { None }
}

/// Two triangles: the ends of their edge, then the corners opposite.
fn narrow<R: Real>(
    surface: &Surface,
    points: [u32; 4],
    place: impl Fn(u32) -> u32,
) -> Option<HingeRow<R, 4>> {
    let [a, b, c, d] = points;
    let area = triangle_area(surface, [a, b, c]) + triangle_area(surface, [a, b, d]);
    let weights = bending_weights(points.map(|point| position(surface, point)))?;
    let edge = (position(surface, b) - position(surface, a)).norm();
    let row = HingeRow::new(surface, points, weights.map(|weight| weight / area.sqrt()), place);
    Some(row.with_max_length(2.0 * edge / area.sqrt()))
}

/// Two quads: the ends of their edge, then those of the edges opposite.
fn wide<R: Real>(surface: &Surface, points: [u32; 6], place: impl Fn(u32) -> u32) -> Option<HingeRow<R, 6>> {
    let [a, b, c, d, e, f] = points.map(|point| position(surface, point));
    let (near, far) = ((c + d) / 2.0, (e + f) / 2.0);
    let area = |middle: Vector3<f64>| (b - a).cross(&(middle - a)).norm() / 2.0;
    let weights = bending_weights([a, b, near, far])?;
    let root = (area(near) + area(far)).sqrt();
    let [k0, k1, k2, k3] = weights.map(|weight| weight / root);
    let weights = [k0, k1, k2 / 2.0, k2 / 2.0, k3 / 2.0, k3 / 2.0];
    Some(HingeRow::new(surface, points, weights, place).with_max_length(2.0 * (b - a).norm() / root))
}

/// The distance of a quad from a plane: its diagonals as a hinge, scaled so that all four weights of a parallelogram
/// are equal.
fn twist<R: Real>(surface: &Surface, face: [u32; 4], place: impl Fn(u32) -> u32) -> Option<HingeRow<R, 4>> {
    let [a, b, c, d] = face;
    let points = [a, c, b, d];
    let area = triangle_area(surface, [a, b, c]) + triangle_area(surface, [a, c, d]);
    let weights = bending_weights(points.map(|point| position(surface, point)))?;
    let size = weights.iter().map(|weight| weight.abs()).sum::<f64>() / 4.0;
    Some(HingeRow::new(surface, points, weights.map(|weight| weight / size * (2.0 / area).sqrt()), place))
}

/// Largest weight of a hinge: beyond, sums of weights overflow in single precision.
const MAX_WEIGHT: f64 = 1e30;

/// The weights of Bergou et al. 2006, from cotangents of the angles at the edge; `None` where an angle is degenerate.
pub(super) fn bending_weights([x0, x1, x2, x3]: [Vector3<f64>; 4]) -> Option<[f64; 4]> {
    let cotangent = |u: Vector3<f64>, v: Vector3<f64>| u.dot(&v) / u.cross(&v).norm();
    let edge = x1 - x0;
    let at_0 = [cotangent(edge, x2 - x0), cotangent(edge, x3 - x0)];
    let at_1 = [cotangent(-edge, x2 - x1), cotangent(-edge, x3 - x1)];
    let weights = [at_1[0] + at_1[1], at_0[0] + at_0[1], -at_0[0] - at_1[0], -at_0[1] - at_1[1]];
    weights.iter().all(|weight| weight.abs() < MAX_WEIGHT).then_some(weights)
}

impl<R: Real, const N: usize> HingeRow<R, N> {
    /// Whether the hinge is bent at rest.
    pub fn is_bent(&self) -> bool {
        self.rest > R::ZERO
    }

    /// The length of its bending vector at rest.
    pub fn at_rest(&self) -> RestRow<R, N> {
        RestRow { points: self.points, rest: self.rest }
    }

    fn new(surface: &Surface, points: [u32; N], weights: [f64; N], place: impl Fn(u32) -> u32) -> Self {
        let x = points.map(|point| position(surface, point));
        let vector: Vector3<f64> = (0..N).map(|k| x[k] * weights[k]).sum();
        // Flat up to rounding counts as flat: 1e-6 of the terms that cancel.
        let flat = 1e-6 * (0..N).map(|k| weights[k].abs() * (x[k] - x[0]).norm()).sum::<f64>();
        let rest = if vector.norm() <= flat { 0.0 } else { vector.norm() };
        let mut weights = weights.map(R::from_f64);
        // The rounded weights must still add up to zero: else the cloth would be attracted to the origin.
        weights[N - 1] = weights[..N - 1].iter().fold(R::ZERO, |sum, &weight| sum - weight);
        Self { points: points.map(place), weights, rest: R::from_f64(rest), inverse_square_max: R::ZERO }
    }

    /// Sets the length that the bending vector has when the hinge is folded shut.
    fn with_max_length(self, most: f64) -> Self {
        Self { inverse_square_max: R::from_f64(1.0 / (most * most)), ..self }
    }
}

/// The energy of a hinge in joules at a bending stiffness of 1: the moment 2 (sin(θ/2) - sin(θ_0/2)), integrated from
/// rest.
pub fn energy_of_length(length: f64, rest: f64, inverse_square_max: f64) -> f64 {
    let square = |length: f64| (length - rest).powi(2) / 2.0;
    if inverse_square_max == 0.0 {
        return square(length);
    }
    let most = 1.0 / inverse_square_max.sqrt();
    let half_angle = |length: f64| (length / most).clamp(0.0, 1.0).asin();
    let sum = |half: f64| -most * most * half.cos() - rest * most * half;
    let turn = MIN_COSINE.acos();
    let stiffest = most * turn.sin();
    let beyond = if length > stiffest { (square(length) - square(stiffest)) / MIN_COSINE } else { 0.0 };
    sum(half_angle(length).min(turn)) - sum(half_angle(rest).min(turn)) + beyond
}

impl<R: Real, const N: usize> Row for HingeRow<R, N> {
    type Group = HingeGroup<R, N>;
    const POINTS: usize = N;
    const GROUPS: usize = 2;

    fn point(&self, k: usize) -> u32 {
        self.points[k]
    }

    fn idle(padding_point: u32) -> Self {
        Self { points: [padding_point; N], weights: [R::ZERO; N], rest: R::ZERO, inverse_square_max: R::ZERO }
    }

    fn group(rows: [Self; 4]) -> HingeGroup<R, N> {
        HingeGroup {
            points: std::array::from_fn(|k| rows.map(|row| row.points[k])),
            weights: std::array::from_fn(|k| rows.map(|row| row.weights[stored::<N>()[k]])),
            anchored: [[R::ZERO; 4]; 3],
            inverse_square_max: rows.map(|row| row.inverse_square_max),
        }
    }
}

impl<R: Real, const N: usize> Row for RestRow<R, N> {
    type Group = RestGroup<R>;
    const POINTS: usize = N;
    const GROUPS: usize = HingeRow::<R, N>::GROUPS;

    fn point(&self, k: usize) -> u32 {
        self.points[k]
    }

    fn idle(padding_point: u32) -> Self {
        Self { points: [padding_point; N], rest: R::ZERO }
    }

    fn group(rows: [Self; 4]) -> RestGroup<R> {
        RestGroup { rest: rows.map(|row| row.rest) }
    }
}

/// Which of its weights a hinge stores.
const fn stored<const N: usize>() -> [usize; 4] {
    if N == 6 { [0, 1, 2, 4] } else { [0, 1, 2, 3] }
}

/// The weights of hinges side by side.
#[inline(always)]
pub fn weights<R: Real, L: Lanes<R>, const N: usize>(groups: &[HingeGroup<R, N>]) -> [L; N] {
    // Not an array's `map`: it is not inlined.
    let of = |k: usize| L::of_groups(|group| groups[group].weights[k]);
    let [a, b, c, d] = [of(0), of(1), of(2), of(3)];
    // As the rounded weights of the row were made: their sum is zero.
    let last = L::splat(R::ZERO) - a - b - c - c - d;
    let all = if N == 6 { [a, b, c, c, d, last] } else { [a, b, c, d, d, d] };
    let mut weights = [last; N];
    weights.copy_from_slice(&all[..N]);
    weights
}

impl<R: Real, const N: usize> HingeGroup<R, N> {
    /// The weights of the points.
    pub fn weights(&self) -> [[R; 4]; N] {
        weights::<R, R::Lanes, N>(std::slice::from_ref(self)).map(R::Lanes::to_array)
    }

    /// Updates the bending vector of the anchors, in double precision.
    pub fn anchor(&mut self, anchors: &[[f64; 3]]) {
        let weights = self.weights();
        for lane in 0..4 {
            let x = self.points.map(|point| anchors[point[lane] as usize]);
            for axis in 0..3 {
                // Relative to the last point, whose weight is minus the sum of the others.
                let term = |k: usize| weights[k][lane].to_f64() * (x[k][axis] - x[N - 1][axis]);
                self.anchored[axis][lane] = R::from_f64((0..N - 1).map(term).sum());
            }
        }
    }
}

fn position(surface: &Surface, point: u32) -> Vector3<f64> {
    surface.positions[point as usize]
}

/// The two corners of a quad that are not on this edge.
fn far_side(face: &[u32], ends: [u32; 2]) -> [u32; 2] {
    let mut others = face.iter().copied().filter(|corner| !ends.contains(corner));
    [others.next().unwrap_or(ends[0]), others.next().unwrap_or(ends[0])]
}

/// The third corner of the triangle that has this edge, with the face cut into a fan.
fn apex(face: &[u32], ends: [u32; 2]) -> Option<u32> {
    let triangle = fan_triangles(face).find(|triangle| ends.iter().all(|end| triangle.contains(end)))?;
    triangle.into_iter().find(|corner| !ends.contains(corner))
}

fn all_differ<const N: usize>(points: [u32; N]) -> bool {
    (1..N).all(|k| !points[..k].contains(&points[k]))
}

fn sorted<const N: usize>(mut points: [u32; N]) -> [u32; N] {
    points.sort_unstable();
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::surface::Faces;

    type Faced = fn(u32, u32) -> Vec<Vec<u32>>;

    /// A mesh of `n` by `n` points, `at` placing them, with faces per cell from its corner and row length.
    fn mesh(n: u32, at: impl Fn(f64, f64) -> [f64; 2], cell: Faced) -> Surface {
        let points = (0..n * n).map(|k| at(f64::from(k % n), f64::from(k / n)));
        let positions = points.map(|[x, y]| Vector3::new(x, y, 0.0)).collect();
        let cells = (0..n - 1).flat_map(|row| (0..n - 1).map(move |column| row * n + column));
        let faces: Vec<Vec<u32>> = cells.flat_map(|a| cell(a, n)).collect();
        Surface { positions, faces: faces.iter().map(Vec::as_slice).collect::<Faces>() }
    }

    fn quads(a: u32, n: u32) -> Vec<Vec<u32>> {
        vec![vec![a, a + 1, a + n + 1, a + n]]
    }

    fn triangles(a: u32, n: u32) -> Vec<Vec<u32>> {
        vec![vec![a, a + 1, a + n], vec![a + 1, a + n + 1, a + n]]
    }

    fn energy<const N: usize>(rows: &[HingeRow<f64, N>], x: &[Vector3<f64>]) -> f64 {
        let vector = |row: &HingeRow<f64, N>| -> Vector3<f64> {
            (0..N).map(|k| x[row.points[k] as usize] * row.weights[k]).sum()
        };
        rows.iter().map(|row| vector(row).norm_squared() / 2.0).sum()
    }

    /// Energy per area and B of a mesh bent to z = (p x² + 2 q x y + r y²) / 2. Second differences over three sizes
    /// eliminate the border of cells.
    fn density(at: impl Fn(f64, f64) -> [f64; 2] + Copy, cell: Faced, [p, q, r]: [f64; 3]) -> f64 {
        let of = |n: u32| {
            let surface = mesh(n, at, cell);
            let rows = rows::<f64>(&surface, |point| point);
            let bend = |x: &Vector3<f64>| (p * x.x * x.x + 2.0 * q * x.x * x.y + r * x.y * x.y) / 2.0;
            let bent: Vec<_> = surface.positions.iter().map(|x| Vector3::new(x.x, x.y, bend(x))).collect();
            let area: f64 = surface.faces.triangles().map(|t| triangle_area(&surface, t)).sum();
            (energy(&rows.of_four, &bent) + energy(&rows.of_six, &bent), area)
        };
        // Keeps the part that grows with the square of the size, and drops the part that grows with its border.
        let [(e1, a1), (e2, a2), (e3, a3)] = [of(11), of(21), of(31)];
        (e3 - 2.0 * e2 + e1) / (a3 - 2.0 * a2 + a1)
    }

    const CURVATURES: [[f64; 3]; 5] =
        [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.5, 0.5, 0.5], [0.5, -0.5, 0.5]];

    #[test]
    fn a_grid_of_any_cells_is_an_isotropic_plate() {
        for side in [[1.0, 1.0], [1.0, 2.5], [0.3, 0.1]] {
            for [p, q, r] in CURVATURES {
                let found = density(|x, y| [x * side[0], y * side[1]], quads, [p, q, r]);
                let plate = (p * p + r * r + 2.0 * q * q) / 2.0;
                assert!((found / plate - 1.0).abs() < 1e-9, "{side:?}, {:?}: {found}", [p, q, r]);
            }
        }
    }

    #[test]
    fn equilateral_triangles_are_a_plate_with_poissons_ratio_of_minus_a_third() {
        let at = |x: f64, y: f64| [x + y / 2.0, y * 0.75f64.sqrt()];
        for [p, q, r] in CURVATURES {
            let found = density(at, triangles, [p, q, r]);
            let nu = -1.0 / 3.0;
            let plate = (p * p + r * r + 2.0 * nu * p * r + 2.0 * (1.0 - nu) * q * q) / 2.0;
            assert!((found / plate - 1.0).abs() < 1e-9, "{:?}: {found} for {plate}", [p, q, r]);
        }
    }

    #[test]
    fn a_hinge_of_slivers_has_weights_of_single_precision_or_none() {
        for height in [1e-3, 1e-20, 1e-28, 1e-32, 1e-40, 0.0] {
            let corner = |x: f64, y: f64| Vector3::new(x, y, 0.0);
            let points = [corner(0.0, 0.0), corner(1.0, 0.0), corner(0.5, height), corner(0.5, -height)];
            let weights = bending_weights(points);
            assert!(
                weights.is_none_or(|all| all.iter().all(|&weight| (weight as f32).is_finite())),
                "{height}"
            );
            assert_eq!(weights.is_some(), height > 1e-29, "{height}");
        }
    }

    #[test]
    fn a_hinge_folded_shut_has_the_max_length_of_its_bending_vector() {
        for cell in [quads as Faced, triangles] {
            let mut surface = mesh(2, |x, y| [0.7 * x, 0.4 * y], cell);
            if cell(0, 2).len() == 1 {
                // A second quad beside the first.
                surface.positions.extend([Vector3::new(1.1, 0.0, 0.0), Vector3::new(1.1, 0.4, 0.0)]);
                surface.faces.push(&[1, 4, 5, 3]);
            }
            let rows = rows::<f64>(&surface, |point| point);
            // Turned round the edge from 1 to 3, or from 1 to 2, until it lies on the first face.
            let [from, to, moved] = if rows.of_six.is_empty() { [1, 2, 3] } else { [1, 3, 4] };
            let (edge, base) = (surface.positions[to] - surface.positions[from], surface.positions[from]);
            let half_turn = nalgebra::Rotation3::from_scaled_axis(edge.normalize() * std::f64::consts::PI);
            let mut x = surface.positions.clone();
            x[moved..].iter_mut().for_each(|p| *p = base + half_turn * (*p - base));
            let length = |points: &[u32], weights: &[f64]| -> f64 {
                points.iter().zip(weights).map(|(&k, &w)| x[k as usize] * w).sum::<Vector3<f64>>().norm()
            };
            let (length, fold) = match (rows.of_six.first(), rows.of_four.first()) {
                (Some(row), _) => (length(&row.points, &row.weights), row.inverse_square_max),
                (None, Some(row)) => (length(&row.points, &row.weights), row.inverse_square_max),
                _ => panic!("no hinge"),
            };
            assert!((length * length * fold - 1.0).abs() < 1e-9, "{length} {fold}");
        }
    }

    #[test]
    fn the_energy_of_a_hinge_is_its_moment_integrated_over_the_angle() {
        let (most, rest) = (3.0f64, 0.4f64);
        let at = |angle: f64| energy_of_length(most * (angle / 2.0).sin(), rest, 1.0 / (most * most));
        for degrees in [10.0f64, 45.0, 90.0, 115.0] {
            let (angle, step) = (degrees.to_radians(), 1e-5);
            let moment = (at(angle + step) - at(angle - step)) / (2.0 * step);
            let expected = (most * (angle / 2.0).sin() - rest) * most / 2.0;
            assert!((moment / expected - 1.0).abs() < 1e-6, "{degrees}°: {moment} for {expected}");
        }
        assert!(
            (energy_of_length(0.01, 0.0, 1.0 / 9.0) / 5e-5 - 1.0).abs() < 1e-4,
            "small angles: half the square"
        );
        let small = energy_of_length(most * 1e-6, 0.0, 1.0 / 9.0);
        assert!(small >= 0.0 && energy_of_length(rest, rest, 1.0 / 9.0).abs() < 1e-12);
    }

    #[test]
    fn irregular_quads_in_a_plane_have_no_bending_energy() {
        let crooked = |x: f64, y: f64| [x + 0.3 * (x * y).sin(), y + 0.2 * (x - y).cos()];
        let surface = mesh(9, crooked, quads);
        let rows = rows::<f64>(&surface, |point| point);
        assert_eq!((rows.of_six.len(), rows.of_four.len()), (2 * 7 * 8, 64));
        assert!(
            rows.of_six.iter().all(|row| row.rest == 0.0) && rows.of_four.iter().all(|row| row.rest == 0.0)
        );
        let flat = energy(&rows.of_six, &surface.positions) + energy(&rows.of_four, &surface.positions);
        assert!(flat < 1e-24, "{flat:e}");
    }
}
