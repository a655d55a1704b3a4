//! Walls: the density that the ground plane, colliders, cloth and particles of other objects add to particles near them, and
//! the reaction on cloth and on those particles.
//!
//! Near a wall a particle lacks neighbours. The plane counts as a half-space full of liquid that begins at half a rest
//! distance. Surfaces of meshes are covered with samples, each of which counts as much as its area (as the boundary
//! particles of Akinci et al. 2012, "Versatile rigid-fluid coupling"). A sample at distance r weighs S(r) / 2 pi r, with the
//! weight S of a sheet of liquid, so that a flat surface weighs as much as the plane. Contact thickness moves both outwards.
//!
//! The samples of cloth move with the corners of their triangle, and take up the pressure on them: momentum is kept. A
//! particle of another object is a sample that weighs as a ball of liquid, so that two liquids share the volume, and the heavier
//! one sinks.

use std::f32::consts::PI;

use super::ball::BallKernel;
use super::grid::CellGrid;
use super::kernel::{REACH, half_space, weight};
use super::pair::Pair;

/// How far behind a surface the liquid begins that it counts as: the layers of particles beside it weigh as much as a
/// half-space that begins there.
const GAP: f32 = 0.03;
/// Distance of samples in rest distances, at most.
const SAMPLE_DISTANCE: f32 = 0.4;
/// Distance from a sample below which its weight no longer grows.
const NEAREST: f32 = 0.2;
/// Distance of particles from the surface that they rest on.
const WALL_DISTANCE: f32 = 0.5;
/// Samples along and across a triangle, at most: beyond, samples weigh more.
const MAX_ROWS: u32 = 2048;

/// How far beyond the liquid the samples of surfaces at rest reach when they are made, in rest distances.
const REGION_MARGIN: f32 = 3.0;

/// The walls of one liquid; lengths in rest distances, from the liquid's origin.
#[derive(Debug, Default)]
pub struct Walls {
    /// The plane: its unit normal, the height of the origin above it, and how far contact keeps particles from it
    /// beyond [`WALL_DISTANCE`].
    pub plane: Option<Plane>,
    /// Samples of surfaces that rest in this frame, and the box that they serve.
    still: Samples,
    region: Option<[[f32; 3]; 2]>,
    /// Those of all others.
    moving: Samples,
    /// Corners of the triangles of cloth that has samples.
    corners: Vec<Corner>,
    /// Displacement of each moving sample.
    moved: Vec<[f32; 3]>,
}

/// The ground plane.
#[derive(Debug, Clone, Copy)]
pub struct Plane {
    /// Of unit length.
    pub normal: [f32; 3],
    /// Height of the origin above it.
    pub height: f32,
    /// Distance at which particles rest on it, less half a rest distance.
    pub offset: f32,
}

/// A point of cloth, and how far the pressure moves it.
#[derive(Debug, Clone, Copy)]
pub struct Corner {
    /// Its row in the columns of the state.
    pub row: u32,
    /// Inverse mass, in inverse masses of a particle.
    pub inverse_mass: f32,
    /// Displacement.
    pub moved: [f32; 3],
}

#[derive(Debug, Clone, Copy)]
struct Sample {
    /// Area of a part of a surface.
    area: f32,
    /// Of a particle of another object, the place of its kernel in `balls`.
    ball: Option<u32>,
    offset: f32,
    /// Places in `corners`, and weights; none for colliders.
    corners: Option<[u32; 3]>,
    shares: [f32; 3],
}

/// A surface that is covered with samples.
#[derive(Debug, Clone, Copy)]
pub struct Material {
    /// Distance at which particles rest on it.
    pub distance: f32,
}

impl Walls {
    /// Forgets all walls but the samples of surfaces at rest.
    pub fn clear(&mut self) {
        self.plane = None;
        self.moving.clear();
        self.corners.clear();
    }

    /// Forgets the samples of surfaces at rest too.
    pub fn forget(&mut self) {
        self.region = None;
    }

    /// The box near which surfaces at rest need samples, if those that are there do not serve a liquid with these bounds.
    pub fn new_region(&mut self, [low, high]: [[f32; 3]; 2]) -> Option<[[f32; 3]; 2]> {
        let serves =
            |region: &[[f32; 3]; 2]| (0..3).all(|k| region[0][k] <= low[k] && high[k] <= region[1][k]);
        if self.region.as_ref().is_some_and(serves) {
            return None;
        }
        self.still.clear();
        self.region = Some([low.map(|x| x - REGION_MARGIN), high.map(|x| x + REGION_MARGIN)]);
        self.region
    }

    /// Adds a point of cloth; returns its number.
    pub fn corner(&mut self, corner: Corner) -> u32 {
        self.corners.push(corner);
        self.corners.len() as u32 - 1
    }

    /// The points of cloth, with their displacements.
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// Covers a triangle that rests in this frame with samples, where it is near a box.
    pub fn cover_still(&mut self, triangle: [[f32; 3]; 3], material: Material, bounds: [[f32; 3]; 2]) {
        self.still.cover(triangle, None, material, bounds);
    }

    /// Covers any other triangle with samples, where it is near a box. That of cloth has corners.
    pub fn cover(
        &mut self,
        triangle: [[f32; 3]; 3],
        corners: Option<[u32; 3]>,
        material: Material,
        bounds: [[f32; 3]; 2],
    ) {
        self.moving.cover(triangle, corners, material, bounds);
    }

    /// Adds a particle of another object, as a ball of liquid of this radius, where it is near a box. It moves with its corner.
    pub fn particle(&mut self, place: [f32; 3], corner: Corner, radius: f32, [low, high]: [[f32; 3]; 2]) {
        let reach = REACH + radius;
        // A place that is not a number is near nothing.
        if (0..3).all(|k| low[k] - reach <= place[k] && place[k] <= high[k] + reach) {
            let corner = self.corner(corner);
            let (corners, shares) = (Some([corner; 3]), [1.0, 0.0, 0.0]);
            let ball = Some(self.moving.ball(radius));
            self.moving.max_offset = self.moving.max_offset.max(radius);
            self.moving.places.push(place);
            self.moving.samples.push(Sample { area: 0.0, ball, offset: radius, corners, shares });
        }
    }

    /// Sorts the samples of surfaces at rest, once all are there.
    pub fn sort_still(&mut self) {
        self.still.sort();
    }

    /// Sorts the other samples, once all are there.
    pub fn sort(&mut self) {
        self.moving.sort();
        self.moved.clear();
        self.moved.resize(if self.corners.is_empty() { 0 } else { self.moving.samples.len() }, [0.0; 3]);
    }

    /// Calls `add` with the density of each wall near a place, its gradient, and the sample if it can move.
    #[inline]
    pub fn near(&self, place: [f32; 3], mut add: impl FnMut(f32, [f32; 3], Option<u32>)) {
        if let Some(Plane { normal, height, offset }) = self.plane {
            let distance =
                height + normal[0] * place[0] + normal[1] * place[1] + normal[2] * place[2] + GAP - offset;
            if distance < REACH {
                let [density, slope] = half_space(distance.max(0.0));
                add(density, normal.map(|x| x * slope), None);
            }
        }
        self.still.near(place, &mut add);
        self.moving.near(place, &mut add);
    }

    /// Term of the mobility of cloth in the diagonal entry of a particle.
    #[inline]
    pub fn mobility(&self, pairs: &[Pair]) -> f32 {
        let of = |pair: &Pair| {
            let [x, y, z] = pair.gradient();
            let sample = &self.moving.samples[pair.other()];
            let masses = sample.corners.into_iter().flatten().zip(sample.shares);
            let mobility: f32 = masses
                .map(|(corner, share)| share * share * self.corners[corner as usize].inverse_mass)
                .sum();
            mobility * (x * x + y * y + z * z)
        };
        pairs.iter().map(of).sum()
    }

    /// How much of a particle's density goes where the samples move.
    #[inline]
    pub fn change(&self, pairs: &[Pair]) -> f32 {
        let of = |pair: &Pair| {
            let ([x, y, z], [a, b, c]) = (self.moved[pair.other()], pair.gradient());
            x * a + y * b + z * c
        };
        pairs.iter().map(of).sum()
    }

    /// Displacements of cloth by the multipliers of particles, each with its pairs.
    pub fn displace<'p>(&mut self, pushes: impl Iterator<Item = (f32, &'p [Pair])>) {
        if self.corners.is_empty() {
            return;
        }
        self.corners.iter_mut().for_each(|corner| corner.moved = [0.0; 3]);
        for (lambda, pairs) in pushes {
            for pair in pairs {
                let gradient = pair.gradient();
                let sample = self.moving.samples[pair.other()];
                for (corner, share) in sample.corners.into_iter().flatten().zip(sample.shares) {
                    let corner = &mut self.corners[corner as usize];
                    let push = lambda * share * corner.inverse_mass;
                    (0..3).for_each(|axis| corner.moved[axis] += push * gradient[axis]);
                }
            }
        }
        for (moved, sample) in self.moved.iter_mut().zip(&self.moving.samples) {
            let Some(corners) = sample.corners else { continue };
            let corners = corners.map(|corner| self.corners[corner as usize].moved);
            *moved = std::array::from_fn(|axis| (0..3).map(|k| corners[k][axis] * sample.shares[k]).sum());
        }
    }
}

/// Samples of surfaces, sorted into cells.
#[derive(Debug, Default)]
struct Samples {
    places: Vec<[f32; 3]>,
    samples: Vec<Sample>,
    grid: CellGrid,
    /// In the order of the grid: places, and the squared distance at which each begins to count.
    sorted: Vec<[f32; 4]>,
    max_offset: f32,
    /// Kernels of particles of other objects, by radius.
    balls: Vec<BallKernel>,
}

impl Samples {
    fn clear(&mut self) {
        self.places.clear();
        self.samples.clear();
        self.sorted.clear();
        self.balls.clear();
        self.max_offset = 0.0;
    }

    /// The place of the kernel of balls of this radius, of which there are as many as objects.
    fn ball(&mut self, radius: f32) -> u32 {
        let known = self.balls.iter().position(|ball| ball.radius == radius);
        known.unwrap_or_else(|| {
            self.balls.push(BallKernel::new(radius));
            self.balls.len() - 1
        }) as u32
    }

    /// Covers a triangle with samples, where it is near a box: strips along its longest edge, cut by lines from the corner
    /// opposite to it into parts of equal area.
    fn cover(
        &mut self,
        triangle: [[f32; 3]; 3],
        corners: Option<[u32; 3]>,
        material: Material,
        [low, high]: [[f32; 3]; 2],
    ) {
        let offset = (material.distance - WALL_DISTANCE).max(0.0);
        let reach = REACH + offset;
        let [low, high] = [low.map(|x| x - reach), high.map(|x| x + reach)];
        let beyond = |k: usize| {
            triangle.iter().all(|corner| corner[k] < low[k])
                || triangle.iter().all(|corner| corner[k] > high[k])
        };
        // A corner that is not a number is beyond nothing.
        let is_finite = triangle.iter().flatten().all(|x| x.is_finite());
        if !is_finite || (0..3).any(beyond) {
            return;
        }
        let edge = |a: usize| length(minus(triangle[(a + 1) % 3], triangle[a]));
        let [x, y, z] = [edge(0), edge(1), edge(2)];
        let a = if x >= y && x >= z {
            0
        } else if y >= z {
            1
        } else {
            2
        };
        let [a, b, c] = [a, (a + 1) % 3, (a + 2) % 3];
        let base = edge(a);
        let area = length(cross(minus(triangle[b], triangle[a]), minus(triangle[c], triangle[a]))) / 2.0;
        self.max_offset = self.max_offset.max(offset);
        let strips = parts(2.0 * area / base.max(f32::MIN_POSITIVE));
        for strip in 0..strips {
            // Heights of the strip as shares, and that of its centre.
            let [t, s] = [strip, strip + 1].map(|k| k as f32 / strips as f32);
            let share = (1.0 - t) * (1.0 - t) - (1.0 - s) * (1.0 - s);
            let centre = ((s * s - t * t) - (s * s * s - t * t * t) * (2.0 / 3.0)) / share;
            let across = parts(base * (1.0 - t));
            let at = |u: f32| -> [f32; 3] {
                let mut shares = [0.0; 3];
                (shares[a], shares[b], shares[c]) = ((1.0 - centre) * (1.0 - u), (1.0 - centre) * u, centre);
                shares
            };
            let place = |shares: [f32; 3]| -> [f32; 3] {
                std::array::from_fn(|k| (0..3).map(|c| triangle[c][k] * shares[c]).sum())
            };
            let ends = [place(at(0.0)), place(at(1.0))];
            for k in within(ends, [low, high], across) {
                let shares = at((k as f32 + 0.5) / across as f32);
                let place = place(shares);
                if (0..3).all(|k| low[k] <= place[k] && place[k] <= high[k]) {
                    self.places.push(place);
                    let area = area * share / across as f32;
                    self.samples.push(Sample { area, ball: None, offset, corners, shares });
                }
            }
        }
    }

    /// Sorts the samples, once all are there.
    fn sort(&mut self) {
        if self.samples.is_empty() {
            return;
        }
        self.grid.sort(&self.places, REACH + self.max_offset);
        self.sorted.extend(self.grid.order().iter().map(|&at| {
            let ([x, y, z], limit) =
                (self.places[at as usize], REACH + self.samples[at as usize].offset - GAP);
            [x, y, z, limit * limit]
        }));
    }

    #[inline]
    fn near(&self, place: [f32; 3], add: &mut impl FnMut(f32, [f32; 3], Option<u32>)) {
        if self.samples.is_empty() {
            return;
        }
        self.grid.visit_runs(self.grid.cell(place), |run| {
            for k in run {
                let [x, y, z, limit] = self.sorted[k];
                let apart = [place[0] - x, place[1] - y, place[2] - z];
                let square = apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2];
                if square < limit {
                    let at = self.grid.order()[k];
                    let sample = &self.samples[at as usize];
                    let (density, slope) = sample.density(square.sqrt().max(NEAREST), &self.balls);
                    add(density, apart.map(|x| x * slope), sample.corners.map(|_| at));
                }
            }
        });
    }
}

impl Sample {
    /// The density that it adds at a distance, and its derivative over the distance.
    #[inline]
    fn density(&self, distance: f32, balls: &[BallKernel]) -> (f32, f32) {
        if let Some(ball) = self.ball {
            let [density, slope] = balls[ball as usize].at(distance);
            return (density, slope / distance);
        }
        let q = (distance + GAP - self.offset).max(0.0);
        let part = self.area / (2.0 * PI * distance);
        let sheet = -half_space(q)[1];
        (part * sheet, -part * (2.0 * PI * q * weight(q) + sheet / distance) / distance)
    }
}

/// The number of parts of a length.
fn parts(length: f32) -> u32 {
    ((length / SAMPLE_DISTANCE).ceil().min(MAX_ROWS as f32) as u32).max(1)
}

/// Those of so many parts of a segment that may be in a box.
fn within([from, to]: [[f32; 3]; 2], [low, high]: [[f32; 3]; 2], parts: u32) -> std::ops::Range<u32> {
    let (mut first, mut last) = (0.0f32, 1.0f32);
    for k in 0..3 {
        let along = to[k] - from[k];
        if along.abs() > 1e-6 {
            let [a, b] = [(low[k] - from[k]) / along, (high[k] - from[k]) / along];
            (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
        }
    }
    let first = (first * parts as f32 - 1.0).max(0.0) as u32;
    let last = (last * parts as f32 + 1.0).max(0.0) as u32;
    first..last.min(parts).max(first)
}

fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length(a: [f32; 3]) -> f32 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_particle_that_touches_a_mesh_feels_it_like_the_plane() {
        for distance in [0.5f32, 1.3] {
            let mut walls = Walls::default();
            let bounds = [[-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]];
            let triangle = [[-9.0, 0.0, -9.0], [0.0, 0.0, 18.0], [9.0, 0.0, -9.0]];
            walls.cover(triangle, None, Material { distance }, bounds);
            walls.sort();
            let mut sum = [0.0f32; 2];
            walls.near([0.1, distance, 0.05], |density, [_, y, _], _| sum = [sum[0] + density, sum[1] + y]);
            let expected = half_space(WALL_DISTANCE)[0];
            // Measured: 7.7 % too little at 0.5.
            assert!((sum[0] / expected - 1.0).abs() < 0.1, "{sum:?} of {expected} at {distance}");
            assert!(sum[1] < 0.0, "it pushes away");
        }
    }

    #[test]
    fn a_triangle_with_a_corner_that_is_no_number_has_no_samples() {
        for bad in [f32::NAN, f32::INFINITY] {
            let mut walls = Walls::default();
            let triangle = [[bad, 0.0, -9.0], [0.0, 0.0, 18.0], [9.0, 0.0, -9.0]];
            walls.cover(triangle, None, Material { distance: 0.5 }, [[-1.0; 3], [1.0; 3]]);
            assert!(walls.moving.samples.is_empty(), "{bad}");
        }
    }
}
