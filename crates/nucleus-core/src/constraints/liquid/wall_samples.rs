//! Samples of surfaces: points that cover triangles, each of which counts as much as its area, and particles of other objects.

use std::f32::consts::PI;

use crate::math::{Lanes, cross, dot, sub};

use super::ball::BallKernel;
use super::grid::CellGrid;
use super::kernel::{REACH, sheet, weights_and_slopes};
use super::near::{CellBlocks, LANES, fill_columns, lane_numbers, load, total};
use super::pair::Pair;

/// How far behind a surface the liquid begins that it counts as: the layers of particles beside it weigh as much as a
/// half-space that begins there.
pub(super) const GAP: f32 = 0.03;
/// Distance of samples in rest distances, at most.
const SAMPLE_DISTANCE: f32 = 0.4;
/// Distance from a sample below which its weight no longer grows.
const NEAREST: f32 = 0.2;
/// Distance of particles from the surface that they rest on.
pub(super) const WALL_DISTANCE: f32 = 0.5;
/// Samples along and across a triangle, at most: beyond, samples weigh more.
const MAX_ROWS: u32 = 2048;

/// A part of a surface, or a particle of another object.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    /// Area of a part of a surface.
    area: f32,
    /// Of a particle of another object, the place of its kernel in `balls`.
    ball: Option<u32>,
    offset: f32,
    /// Places in the corners of the walls, and weights; none for colliders.
    pub corners: Option<[u32; 3]>,
    pub shares: [f32; 3],
}

/// A surface that is covered with samples.
#[derive(Debug, Clone, Copy)]
pub struct Material {
    /// Distance at which particles rest on it.
    pub distance: f32,
}

/// Samples, sorted into cells.
#[derive(Debug, Default)]
pub(super) struct Samples {
    places: Vec<[f32; 3]>,
    samples: Vec<Sample>,
    grid: CellGrid,
    columns: Columns,
    max_offset: f32,
    /// Kernels of particles of other objects, by radius.
    balls: Vec<BallKernel>,
}

/// Samples in the order of the grid, with eight more that count nowhere.
#[derive(Debug, Default)]
struct Columns {
    place: [Vec<f32>; 3],
    /// Distance at which each begins to count, squared.
    limit: Vec<f32>,
    area: Vec<f32>,
    offset: Vec<f32>,
}

impl Samples {
    /// Removes all.
    pub fn clear(&mut self) {
        self.places.clear();
        self.samples.clear();
        self.balls.clear();
        self.max_offset = 0.0;
    }

    /// In the order in which they were added.
    pub fn all(&self) -> &[Sample] {
        &self.samples
    }

    /// Adds a particle of another object, as a ball of this radius, which moves with a corner.
    pub fn add_ball(&mut self, place: [f32; 3], corner: u32, radius: f32) {
        let known = self.balls.iter().position(|ball| ball.radius == radius);
        // There are as many kernels as objects.
        let ball = known.unwrap_or_else(|| {
            self.balls.push(BallKernel::new(radius));
            self.balls.len() - 1
        });
        let (corners, shares) = (Some([corner; 3]), [1.0, 0.0, 0.0]);
        self.max_offset = self.max_offset.max(radius);
        self.places.push(place);
        self.samples.push(Sample { area: 0.0, ball: Some(ball as u32), offset: radius, corners, shares });
    }

    /// Covers a triangle with samples, where it is near a box: strips along its longest edge, cut by lines from the corner
    /// opposite to it into parts of equal area.
    pub fn cover(
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
        let edge = |a: usize| length(sub(triangle[(a + 1) % 3], triangle[a]));
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
        let area = length(cross(sub(triangle[b], triangle[a]), sub(triangle[c], triangle[a]))) / 2.0;
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
    pub fn sort(&mut self) {
        if self.samples.is_empty() {
            return;
        }
        self.grid.sort(&self.places, REACH + self.max_offset);
        let Self { places, samples, grid, columns: Columns { place, limit, area, offset }, .. } = self;
        let order = grid.order().iter().map(|&at| at as usize);
        fill_columns(place, order.clone().map(|at| places[at]));
        let of = order.map(|at| &samples[at]);
        let square = |x: f32| x * x;
        fill(limit, of.clone().map(|sample| square(REACH + sample.offset - GAP)));
        fill(area, of.clone().map(|sample| sample.area));
        fill(offset, of.map(|sample| sample.offset));
    }

    /// The density that the samples add at a place, and its gradient; adds the pairs with those that can move. `about` keeps
    /// what is about the last cell.
    #[inline(always)]
    pub fn near<W: Lanes<f32, Array = [[f32; 4]; 2]>>(
        &self,
        place: [f32; 3],
        about: &mut CellBlocks,
        pairs: &mut Vec<Pair>,
    ) -> [f32; 4] {
        if self.samples.is_empty() {
            return [0.0; 4];
        }
        about.enter(&self.grid, self.grid.cell(place));
        let zero = W::splat(0.0);
        let (centre, lane) =
            ([W::splat(place[0]), W::splat(place[1]), W::splat(place[2])], lane_numbers::<W>());
        let mut sums = [zero; 4];
        for &[first, count] in about.blocks() {
            let (first, count) = (first as usize, W::splat(count as f32));
            let [xs, ys, zs] = &self.columns.place;
            let apart = sub(centre, [load::<W>(xs, first), load(ys, first), load(zs, first)]);
            let square = dot(apart, apart);
            let inside = load::<W>(&self.columns.limit, first) - square;
            let inside = (count - lane).choose_by_sign(inside, zero);
            let mask = inside.above_zero();
            if mask == 0 {
                continue;
            }
            let distance = square.sqrt().most(W::splat(NEAREST));
            let (area, offset) = (load::<W>(&self.columns.area, first), load(&self.columns.offset, first));
            let mut added = sheet_part(distance, area, offset);
            if !self.balls.is_empty() {
                added = self.with_balls(first, mask, distance, added);
            }
            let [density, slope] = added;
            let slope = inside.choose_by_sign(slope, zero);
            let gradient = [apart[0] * slope, apart[1] * slope, apart[2] * slope];
            sums[0] = sums[0] + inside.choose_by_sign(density, zero);
            for axis in 0..3 {
                sums[axis + 1] = sums[axis + 1] + gradient[axis];
            }
            self.add_pairs(first, mask, gradient, pairs);
        }
        [total(sums[0]), total(sums[1]), total(sums[2]), total(sums[3])]
    }

    /// The same densities and slopes, with those of balls.
    #[inline(always)]
    fn with_balls<W: Lanes<f32, Array = [[f32; 4]; 2]>>(
        &self,
        first: usize,
        mask: u32,
        distance: W,
        [density, slope]: [W; 2],
    ) -> [W; 2] {
        let (distance, mut density, mut slope) = (distance.to_array(), density.to_array(), slope.to_array());
        for lane in (0..LANES).filter(|lane| mask & (1 << lane) != 0) {
            let sample = &self.samples[self.grid.order()[first + lane] as usize];
            let Some(ball) = sample.ball else { continue };
            let (half, lane) = (lane / 4, lane % 4);
            let [of_ball, along] = self.balls[ball as usize].at(distance[half][lane]);
            density[half][lane] = of_ball;
            slope[half][lane] = along / distance[half][lane];
        }
        [W::from_array(density), W::from_array(slope)]
    }

    /// Adds the pairs with those of eight that are near and can move.
    #[inline(always)]
    fn add_pairs<W: Lanes<f32, Array = [[f32; 4]; 2]>>(
        &self,
        first: usize,
        mask: u32,
        gradient: [W; 3],
        pairs: &mut Vec<Pair>,
    ) {
        let [x, y, z] = [gradient[0].to_array(), gradient[1].to_array(), gradient[2].to_array()];
        for lane in (0..LANES).filter(|lane| mask & (1 << lane) != 0) {
            let at = self.grid.order()[first + lane];
            if self.samples[at as usize].corners.is_some() {
                let (half, lane) = (lane / 4, lane % 4);
                pairs.push(Pair::new([x[half][lane], y[half][lane], z[half][lane]], at));
            }
        }
    }
}

/// Takes up a number of each sample, and eight zeros.
fn fill(column: &mut Vec<f32>, numbers: impl Iterator<Item = f32>) {
    column.clear();
    column.extend(numbers);
    column.extend([0.0; LANES]);
}

/// The density that parts of surfaces add at a distance, and its derivative over the distance.
#[inline(always)]
fn sheet_part<W: Lanes<f32>>(distance: W, area: W, offset: W) -> [W; 2] {
    let q = (distance + W::splat(GAP) - offset).most(W::splat(0.0));
    let per_distance = W::splat(1.0) / distance;
    let part = area * W::splat(0.5 / PI) * per_distance;
    let sheet = sheet(q);
    let falloff = W::splat(2.0 * PI) * q * weights_and_slopes(q)[0];
    [part * sheet, W::splat(0.0) - part * (falloff + sheet * per_distance) * per_distance]
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

fn length(a: [f32; 3]) -> f32 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::kernel::{half_space, weight};
    use super::*;
    use crate::math::{Real, Two};

    type Four = Two<<f32 as Real>::Lanes>;

    fn covered(triangle: [[f32; 3]; 3], distance: f32) -> Samples {
        let mut samples = Samples::default();
        samples.cover(triangle, Some([0, 1, 2]), Material { distance }, [[-3.0; 3], [3.0; 3]]);
        samples
    }

    fn near<W: Lanes<f32, Array = [[f32; 4]; 2]>>(
        samples: &Samples,
        place: [f32; 3],
    ) -> ([f32; 4], Vec<Pair>) {
        let mut pairs = Vec::new();
        let sums = samples.near::<W>(place, &mut CellBlocks::default(), &mut pairs);
        (sums, pairs)
    }

    proptest! {
        #[test]
        fn the_density_is_the_sum_of_all_samples_within_reach(
            corners in proptest::array::uniform3(proptest::array::uniform3(-2.0..2.0f32)),
            balls in proptest::collection::vec((proptest::array::uniform3(-2.0..2.0f32), 0.1..1.0f32), 0..20),
            place in proptest::array::uniform3(-2.0..2.0f32),
            distance in 0.3..1.5f32,
        ) {
            let mut samples = covered(corners, distance);
            balls.iter().for_each(|&(place, radius)| samples.add_ball(place, 0, radius));
            samples.sort();
            let (mut expected, mut count) = ([0.0f32; 4], 0);
            for (sample, at) in samples.samples.iter().zip(&samples.places) {
                let apart = sub(place, *at);
                let square = dot(apart, apart);
                if square >= (REACH + sample.offset - GAP).powi(2) {
                    continue;
                }
                let away = square.sqrt().max(NEAREST);
                let [density, slope] = match sample.ball {
                    Some(ball) => samples.balls[ball as usize].at(away),
                    None => {
                        let q = (away + GAP - sample.offset).max(0.0);
                        let (part, sheet) = (sample.area / (2.0 * PI * away), -half_space(q)[1]);
                        [part * sheet, -part * (2.0 * PI * q * weight(q) + sheet / away)]
                    }
                };
                count += 1;
                expected[0] += density;
                (0..3).for_each(|k| expected[k + 1] += apart[k] * slope / away);
            }
            let (sums, pairs) = near::<Four>(&samples, place);
            let size: f32 = 1.0 + expected.iter().map(|x| x.abs()).sum::<f32>();
            prop_assert!((0..4).all(|k| (sums[k] - expected[k]).abs() < 1e-4 * size), "{sums:?} {expected:?}");
            prop_assert_eq!(pairs.len(), count);
            let of_pairs = pairs.iter().fold([0.0f32; 3], |sum, pair| {
                std::array::from_fn(|k| sum[k] + pair.gradient()[k])
            });
            prop_assert!((0..3).all(|k| (of_pairs[k] - expected[k + 1]).abs() < 1e-4 * size));
        }
    }
}
