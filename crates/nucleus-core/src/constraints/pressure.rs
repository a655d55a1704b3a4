//! Pressure: the faces of a mesh are pushed along their normals, by hand or by the gas inside.
//!
//! Every unconnected part of the mesh is a chamber; a mesh that can tear counts as it was before it was split. With
//! a_i = ∂V/∂x_i, a third of the area vectors round point i, a gauge pressure p is the force p a_i, so one time step moves
//! point i by w_i a_i λ with λ = h² p. The gas follows the ideal law at constant temperature, p = K (n V_0 / V - 1), where
//! n V_0 is the volume of its air at ambient pressure and K the bulk modulus. The step is implicit: λ solves
//! λ = h² p(V + s λ) with s = Σ w_i |a_i|², which has one root and is stable for every K (an XPBD constraint, Macklin et al.
//! 2016, with the gas law as its energy).
//!
//! A boundary loop of the mesh is a hole. Sealed, it is capped: the cap carries the pressure to its rim. Open, the missing
//! cap leaves a net force -p A (thrust), and air streams through at the speed of Bernoulli's law, plus the air that the
//! opening runs into. A torn weld opens a hole of the square of its length, through which the gas leaves. Of a mesh in pieces
//! each is pushed as far as it is closed (`pieces.rs`).
//!
//! A constant pressure on a surface that grows does unlimited work: beyond some size no linear stiffness holds it (a balloon
//! bursts). So the push of a time step is limited, relative to a sphere of the mesh's rest area: it moves no point farther
//! than the radius, the faces an eighth of it in the mean, and it holds a chamber within [`BURST_STRETCH`] times that sphere,
//! which it approaches ever more slowly: what pressure has set in motion must not fly on. No mesh that keeps its area encloses
//! more than the sphere does (isoperimetric inequality), so cloth that is not stretched never meets the limit. The volume of a
//! mesh in pieces has no meaning: the limit ends its push there, and pulls nothing back.

mod holes;
mod pieces;

use std::borrow::Cow;

use nalgebra::Vector3;

use crate::input::frame::Pressure;
use crate::math::{Real, Row4};
use crate::model::blocks::{Blocks, triangles_by_block};
use crate::model::surface::{Faces, Surface};
use crate::model::topology::components;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::inflation::{ChamberSums, Inflation};
use crate::state::{Chamber, State};

use holes::{boundary_loops, cap_area, cap_corner, cap_volume};
use pieces::{NO_CHAMBER, Pieces};

/// Pascals for a `pressure`, `startPressure` or `incompressibility` of 1.
pub const PASCALS_PER_PRESSURE: f64 = 1000.0;
/// Density of air in kg/m³ at an `airDensity` of 1.
const AIR: f64 = 1.2;
/// Least density of streaming air, so that it has a finite speed in a vacuum.
const LEAST_AIR: f64 = 1e-3;
/// Rate in 1/s at which a mesh with an `airTightness` of 0 takes up ambient pressure.
const LEAK: f64 = 24.0;
/// Newton steps for λ; quadratic from a monotone side, so 12 reach rounding.
const NEWTON: usize = 12;
/// Volume that a collapsed chamber counts as, as a share of its volume at the start.
const LEAST_VOLUME: f64 = 1e-3;

/// Stretch of the sphere of a chamber's rest area beyond which pressure inflates it no further: about where rubber breaks.
pub const BURST_STRETCH: f64 = 5.0;

/// Mean advance of a chamber's faces in a time step, as a share of the radius of its sphere.
const MAX_FACE_ADVANCE: f64 = 1.0 / 8.0;
/// Growth in a time step, as a share of the volume that is left up to the burst sphere.
const APPROACH: f64 = 1.0 / 4.0;

/// The chambers and holes of one cloth, fixed once it is compiled.
#[derive(Debug, Clone, Default)]
pub struct PressureModel {
    /// Triangles that touch each block of points; empty where the cloth has no pressure.
    triangles: Vec<Vec<[u32; 3]>>,
    /// Chamber of each point, from the first chamber of the cloth on; `NO_CHAMBER` for points of no face.
    chamber: Vec<u32>,
    /// Holes, their corners so that the cap faces outwards.
    holes: Vec<Hole>,
    /// By chamber: radius in metres of a sphere whose area is that of the chamber's faces at rest.
    radii: Vec<f64>,
    /// By chamber: volume of the mesh in m³, with the caps of its holes.
    volumes: Vec<f64>,
    /// The pieces of a mesh that can tear.
    pieces: Pieces,
    /// First of the chambers in the state.
    pub first: usize,
}

#[derive(Debug, Clone)]
struct Hole {
    corners: Vec<u32>,
    chamber: u32,
}

impl PressureModel {
    /// Compiles the chambers of a mesh; `place` gives the solver's row of a point, and `split_off` the point that each of the
    /// last points was split off.
    pub fn new(
        surface: &Surface,
        split_off: &[u32],
        place: impl Fn(u32) -> u32 + Copy,
        blocks: &Blocks,
    ) -> Self {
        let whole = unsplit(surface, split_off);
        let parts = components(&whole);
        let first = blocks.range(0).start;
        let mut chamber = vec![NO_CHAMBER; surface.positions.len()];
        for (index, part) in (0..).zip(&parts) {
            part.iter().for_each(|&point| chamber[(place(point) - first) as usize] = index);
        }
        for (point, &original) in (0..surface.positions.len() as u32).rev().zip(split_off.iter().rev()) {
            chamber[(place(point) - first) as usize] = chamber[(place(original) - first) as usize];
        }
        // Relative to a point of the chamber, so that one far from the origin loses nothing.
        let origins: Vec<_> = parts.iter().map(|part| surface.positions[part[0] as usize]).collect();
        let (mut areas, mut volumes) = (vec![0.0; parts.len()], vec![0.0; parts.len()]);
        let holes = boundary_loops(&whole).into_iter().map(|corners| {
            let own = chamber[(place(corners[0]) - first) as usize];
            let from_origin = |&point: &u32| surface.positions[point as usize] - origins[own as usize];
            volumes[own as usize] += cap_volume(&corners.iter().map(from_origin).collect::<Vec<_>>());
            Hole { chamber: own, corners: corners.into_iter().map(place).collect() }
        });
        let holes = holes.collect();
        for [a, b, c] in surface.faces.triangles() {
            let [x, y, z] = [a, b, c].map(|point| surface.positions[point as usize]);
            let own = chamber[(place(a) - first) as usize] as usize;
            areas[own] += (y - x).cross(&(z - x)).norm() / 2.0;
            let [x, y, z] = [x, y, z].map(|corner| corner - origins[own]);
            volumes[own] += x.dot(&y.cross(&z)) / 6.0;
        }
        let radii = areas.into_iter().map(|area| (area / (4.0 * std::f64::consts::PI)).sqrt()).collect();
        let triangles = triangles_by_block(surface, place, blocks);
        let mut model =
            Self { triangles, holes, radii, volumes, chamber, pieces: Pieces::default(), first: 0 };
        if !split_off.is_empty() {
            model.pieces.find(first, &model.chamber, model.triangles.iter().flatten(), &[]);
        }
        model
    }

    /// Finds the pieces anew, where the mesh can tear; `clusters` gives the lowest row that each row of all cloths is welded
    /// to, and is empty where nothing is welded. `first` is the first row of the cloth.
    pub fn find_pieces(&mut self, first: u32, clusters: &[u32]) {
        if !self.pieces.is_empty() {
            self.pieces.find(first, &self.chamber, self.triangles.iter().flatten(), clusters);
        }
    }

    /// Whether the mesh can tear.
    pub fn can_tear(&self) -> bool {
        !self.pieces.is_empty()
    }

    /// Whether the cloth has any.
    pub fn is_on(&self) -> bool {
        !self.triangles.is_empty()
    }

    /// Whether its gas pushes from all sides, so that it has no torque.
    pub fn is_closed(&self, pressure: &Pressure) -> bool {
        self.holes.is_empty() || matches!(pressure, Pressure::Gas { sealed: true, .. })
    }

    /// The chamber of a point in the state, given how far its row is from the first of the cloth; `None` without a face.
    pub fn chamber_of(&self, at: u32) -> Option<usize> {
        let chamber = *self.chamber.get(at as usize)?;
        (chamber != NO_CHAMBER).then(|| self.first + chamber as usize)
    }

    /// How many chambers there are.
    pub fn chambers(&self) -> usize {
        self.radii.len()
    }

    /// Triangles that are pushed, each once for every block that it touches.
    pub fn rows(&self) -> usize {
        self.triangles.iter().map(Vec::len).sum()
    }

    /// Bytes of its lists.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.chamber[..]) + size_of_val(&self.radii[..]) + self.rows() * size_of::<[u32; 3]>()
    }

    /// The chambers as they are when nothing has moved yet. What they hold is measured by the mesh, wherever the points start.
    pub fn start<R: Real>(&mut self, blocks: &Blocks, state: &mut State<R>, pool: &ThreadPool) {
        let mut columns = std::mem::take(&mut state.inflation);
        self.find_areas(blocks, state, false, &mut columns.corners, pool);
        self.add_up(blocks, state, false, &mut columns);
        if self.can_tear() {
            let area = &state.area[blocks.range(0).start as usize..];
            self.pieces.start(&self.chamber, area, self.radii.len());
        }
        for (index, sums) in columns.sums.iter().enumerate() {
            let (start_volume, volume) = (self.volumes[index], sums.volume / 3.0);
            state.chambers[self.first + index] = Chamber { start_volume, volume, amount: -1.0, torn: 0.0 };
        }
        state.inflation = columns;
    }

    /// Moves the points of a cloth as the pressure of one time step of `h` seconds says.
    pub fn inflate<R: Real>(
        &self,
        blocks: &Blocks,
        state: &mut State<R>,
        frame: &PressureFrame<'_>,
        pool: &ThreadPool,
    ) {
        let sealed = matches!(frame.pressure, Pressure::Gas { sealed: true, .. });
        let mut columns = std::mem::take(&mut state.inflation);
        self.find_areas(blocks, state, sealed, &mut columns.corners, pool);
        self.add_up(blocks, state, sealed, &mut columns);
        let Inflation { sums, pushes, pieces, shares, .. } = &mut columns;
        for ((index, sums), chamber) in sums.iter_mut().enumerate().zip(&state.chambers[self.first..]) {
            sums.is_torn = chamber.torn > 0.0 || !self.pieces.is_one(index);
        }
        let gases = &mut state.chambers[self.first..self.first + sums.len()];
        let step = |((sums, chamber), radius): ((&ChamberSums, &mut Chamber), &f64)| {
            chamber.step(frame, sums, radius * frame.rest_scale)
        };
        pushes.clear();
        pushes.extend(sums.iter().zip(gases).zip(&self.radii).map(step).map(R::from_f64));
        let displacement = DisjointSlice::new(&mut state.displacement);
        let (area, first) = (&state.area, blocks.range(0).start);
        shares.clear();
        if self.can_tear() {
            shares.extend(self.pieces.shares(&area[first as usize..], pieces).map(R::from_f64));
        }
        pool.parallel_for(blocks.len(), |block| {
            // SAFETY: blocks do not overlap.
            #[allow(unsafe_code)]
            let points = unsafe { displacement.run(blocks.range(block)) };
            for (row, point) in blocks.range(block).zip(points) {
                let own = (row - first) as usize;
                let Some(&push) = pushes.get(self.chamber[own] as usize) else { continue };
                let scale = match self.pieces.of(own) {
                    Some(piece) => point.0[3] * push * shares[piece],
                    None => point.0[3] * push,
                };
                let a = area[row as usize].xyz();
                (0..3).for_each(|axis| point.0[axis] += scale * a[axis]);
            }
        });
        state.inflation = columns;
    }

    /// Sets ∂V/∂x of every point, with the caps of the holes if they are sealed.
    fn find_areas<R: Real>(
        &self,
        blocks: &Blocks,
        state: &mut State<R>,
        sealed: bool,
        corners: &mut Vec<Vector3<f64>>,
        pool: &ThreadPool,
    ) {
        let State { anchor, displacement, area, .. } = state;
        let position = |row: u32| at(anchor, displacement, row);
        let areas = DisjointSlice::new(area);
        pool.parallel_for(blocks.len(), |block| {
            let points = blocks.range(block);
            // SAFETY: blocks do not overlap.
            #[allow(unsafe_code)]
            let areas = unsafe { areas.run(points.clone()) };
            areas.fill(Row4::ZERO);
            for triangle in &self.triangles[block] {
                let [a, b, c] = triangle.map(position);
                let share = (b - a).cross(&(c - a)) / 6.0;
                for point in triangle.iter().filter(|point| points.contains(point)) {
                    add(&mut areas[(point - points.start) as usize], share);
                }
            }
        });
        for hole in self.holes.iter().filter(|_| sealed) {
            corners.clear();
            corners.extend(hole.corners.iter().map(|&row| at(anchor, displacement, row)));
            let shared = cap_area(corners) / (3.0 * corners.len() as f64);
            for (k, &row) in hole.corners.iter().enumerate() {
                add(&mut area[row as usize], cap_corner(corners, k) + shared);
            }
        }
    }

    /// Sets the sums over each chamber, point by point in a fixed order.
    fn add_up<R: Real>(
        &self,
        blocks: &Blocks,
        state: &State<R>,
        sealed: bool,
        Inflation { sums, corners, .. }: &mut Inflation<R>,
    ) {
        sums.clear();
        sums.resize(self.chambers(), ChamberSums::default());
        let points = blocks.range(0).start..blocks.range(blocks.len() - 1).end;
        // Relative to a point of the cloth, so that a chamber far from the origin loses nothing.
        let origin = Vector3::from(state.position(points.start));
        for (row, &chamber) in points.zip(&self.chamber) {
            let Some(sums) = sums.get_mut(chamber as usize) else { continue };
            let a: Vector3<f64> = state.area[row as usize].xyz().map(R::to_f64).into();
            sums.volume += a.dot(&(Vector3::from(state.position(row)) - origin));
            let inverse_mass = state.displacement[row as usize].0[3].to_f64();
            sums.mobility += inverse_mass * a.norm_squared();
            sums.fastest = sums.fastest.max(inverse_mass * inverse_mass * a.norm_squared());
            sums.area += a.norm();
        }
        for hole in self.holes.iter().filter(|_| !sealed) {
            corners.clear();
            corners.extend(hole.corners.iter().map(|&row| Vector3::from(state.position(row)) - origin));
            let velocities = hole.corners.iter().map(|&row| state.velocity[row as usize].xyz());
            let velocity: Vector3<f64> =
                velocities.map(|v| Vector3::from(v.map(R::to_f64))).sum::<Vector3<f64>>()
                    / corners.len() as f64;
            let area = cap_area(corners);
            let sums = &mut sums[hole.chamber as usize];
            sums.volume += 3.0 * cap_volume(corners);
            sums.hole += area.norm();
            sums.inflow += velocity.dot(&area);
        }
    }
}

/// The mesh as it was before its last points were split off others.
fn unsplit<'a>(surface: &'a Surface, split_off: &[u32]) -> Cow<'a, Surface> {
    if split_off.is_empty() {
        return Cow::Borrowed(surface);
    }
    let kept = surface.positions.len() - split_off.len();
    let original = |&point: &u32| split_off.get((point as usize).wrapping_sub(kept)).map_or(point, |&at| at);
    let mut faces = Faces::default();
    surface.faces.iter().for_each(|face| faces.push(&face.iter().map(original).collect::<Vec<_>>()));
    Cow::Owned(Surface { positions: surface.positions.clone(), faces })
}

/// What pushes a cloth from within in one time step.
pub struct PressureFrame<'a> {
    /// The attributes.
    pub pressure: &'a Pressure,
    /// Length of the time step in seconds.
    pub h: f64,
    /// The nucleus's `airDensity`.
    pub air_density: f64,
    /// Factor on the rest lengths of the cloth.
    pub rest_scale: f64,
}

impl ChamberSums {
    /// The push λ within its limits, for a chamber of this volume in m³ along its normals, of its volume in the step before,
    /// and of this radius in metres. A vacuum is a pressure that inflates the mesh inside out.
    ///
    /// The faces advance in a time step by a share of the radius at most, in the mean, and the volume grows by a share of what
    /// is left up to the burst sphere: it comes to rest there, and what is larger shrinks back to it.
    fn limited(&self, push: f64, volume: f64, before: f64, radius: f64) -> f64 {
        if self.mobility <= 0.0 {
            return push; // nothing moves
        }
        let burst = BURST_STRETCH * radius;
        let sphere = 4.0 / 3.0 * std::f64::consts::PI * burst * burst * burst;
        let after = volume + push * self.mobility;
        let side = if after < 0.0 { -1.0 } else { 1.0 };
        let (after, volume, before) = (side * after, side * volume, side * before);
        let change = self.area * radius * MAX_FACE_ADVANCE;
        let most = before + change.min((sphere - before) * APPROACH);
        let limited = after.max((before - change).min(most)).min(most);
        let wanted = push;
        let push = if limited == after { wanted } else { side * (limited - volume) / self.mobility };
        let push = if self.is_torn { push.clamp(wanted.min(0.0), wanted.max(0.0)) } else { push };
        let advance = push.abs() * self.fastest.sqrt();
        push * if advance > radius { radius / advance } else { 1.0 }
    }
}

impl Chamber {
    /// Advances the gas by a time step; λ in Pa·s², along the area vectors. `radius` is that of a sphere of the rest area.
    fn step(&mut self, frame: &PressureFrame<'_>, sums: &ChamberSums, radius: f64) -> f64 {
        let PressureFrame { h, air_density, .. } = *frame;
        // A mesh that is inside out has its gas on the side its normals turn from.
        let side = if self.start_volume < 0.0 { -1.0 } else { 1.0 };
        let (volume, start) = (side * sums.volume / 3.0, side * self.start_volume);
        let before = std::mem::replace(&mut self.volume, side * volume) * side;
        match *frame.pressure {
            Pressure::Off => 0.0,
            Pressure::Manual { pascals, damping } => {
                let damping = if start > 0.0 { h * damping / start } else { 0.0 };
                let push =
                    (h * h * pascals - damping * (volume - before) * side) / (1.0 + damping * sums.mobility);
                let push = sums.limited(push, sums.volume / 3.0, side * before, radius);
                self.volume += push * sums.mobility;
                push
            }
            Pressure::Gas { start: above, bulk, pump, tightness, damping, sealed } => {
                if start <= 0.0 {
                    return 0.0; // a mesh that encloses nothing holds no gas
                }
                if self.amount < 0.0 {
                    self.amount = (1.0 + above).max(0.0);
                }
                let gas =
                    Gas { amount: self.amount * start, bulk: h * h * bulk, damping: h * damping / start };
                let push = gas.solve(volume.max(LEAST_VOLUME * start), before, sums.mobility);
                let push = sums.limited(push, volume, before, radius);
                let after = (volume + push * sums.mobility).max(LEAST_VOLUME * start);
                self.volume = side * after;
                let gauge = bulk * (gas.amount / after - 1.0);
                let leak = (1.0 - tightness).clamp(0.0, 1.0) * LEAK * h;
                let mut flow = pump * h - (self.amount - after / start) * leak / (1.0 + leak);
                let hole = self.torn + if sealed { 0.0 } else { sums.hole };
                if hole > 0.0 {
                    let density = (AIR * air_density).max(LEAST_AIR);
                    let speed = (2.0 * gauge.abs() / density).sqrt() * if gauge < 0.0 { -1.0 } else { 1.0 };
                    // No more than equalizes the pressure within the step.
                    let most = (self.amount - after / start).abs();
                    flow += (-speed * hole * h / start).clamp(-most, most);
                }
                if !sealed {
                    flow += side * sums.inflow * h / start;
                }
                self.amount = (self.amount + flow).max(0.0);
                side * push
            }
        }
    }
}

/// The gas law of one time step: λ = bulk (amount / (V + s λ) - 1) - damping (V + s λ - V_before).
struct Gas {
    amount: f64,
    bulk: f64,
    damping: f64,
}

impl Gas {
    /// λ by Newton's method; the residual grows with λ, and the volume stays positive.
    fn solve(&self, volume: f64, before: f64, mobility: f64) -> f64 {
        let mut push = 0.0;
        for _ in 0..NEWTON {
            let after = volume + mobility * push;
            let residual = push - self.bulk * (self.amount / after - 1.0) + self.damping * (after - before);
            let slope = 1.0 + self.bulk * self.amount * mobility / (after * after) + self.damping * mobility;
            let next = push - residual / slope;
            // At most half of the volume goes in one Newton step.
            push =
                if volume + mobility * next < after / 2.0 { push - after / (2.0 * mobility) } else { next };
        }
        push
    }
}

fn at<R: Real>(anchor: &[[f64; 3]], displacement: &[Row4<R>], row: u32) -> Vector3<f64> {
    let (anchor, moved) = (anchor[row as usize], displacement[row as usize].0);
    Vector3::new(anchor[0] + moved[0].to_f64(), anchor[1] + moved[1].to_f64(), anchor[2] + moved[2].to_f64())
}

fn add<R: Real>(row: &mut Row4<R>, vector: Vector3<f64>) {
    (0..3).for_each(|axis| row.0[axis] += R::from_f64(vector[axis]));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_implicit_gas_law_is_met_to_rounding_even_for_a_hard_gas() {
        for bulk in [1e-6, 1.0, 1e6] {
            let gas = Gas { amount: 1.3, bulk, damping: 0.0 };
            for volume in [0.01, 1.0, 7.0] {
                let push = gas.solve(volume, volume, 0.4);
                let after = volume + 0.4 * push;
                let expected = bulk * (1.3 / after - 1.0);
                assert!(after > 0.0 && (push - expected).abs() <= 1e-9 * (1.0 + bulk), "{bulk} {volume}");
            }
        }
    }

    /// A mesh whose faces have points of their own, and what these were split off.
    fn split(surface: &Surface) -> (Surface, Vec<u32>) {
        let (mut whole, mut split_off) = (surface.clone(), Vec::new());
        let mut taken = vec![false; surface.positions.len()];
        let mut faces = Faces::default();
        for face in surface.faces.iter() {
            let own = face.iter().map(|&point| {
                if !std::mem::replace(&mut taken[point as usize], true) {
                    return point;
                }
                whole.positions.push(surface.positions[point as usize]);
                split_off.push(point);
                whole.positions.len() as u32 - 1
            });
            faces.push(&own.collect::<Vec<_>>());
        }
        (Surface { faces, ..whole }, split_off)
    }

    #[test]
    fn a_mesh_that_is_split_has_the_chambers_and_holes_of_the_whole_mesh() {
        let sphere = Surface::sphere(Vector3::new(1.0, 2.0, 3.0), 0.5, 4);
        let mut open = sphere.clone();
        open.faces = sphere.faces.iter().skip(2).collect();
        for mesh in [sphere, open] {
            let (torn, split_off) = split(&mesh);
            let of = |surface: &Surface, split_off: &[u32]| {
                let blocks = Blocks::new(0, surface.positions.len());
                PressureModel::new(surface, split_off, |point| point, &blocks)
            };
            let (whole, torn) = (of(&mesh, &[]), of(&torn, &split_off));
            assert_eq!((torn.chambers(), torn.holes.len()), (1, whole.holes.len()));
            assert!(torn.chamber.iter().all(|&chamber| chamber == 0));
            assert!((torn.volumes[0] - whole.volumes[0]).abs() < 1e-12 && whole.volumes[0] > 0.4);
            assert!((torn.radii[0] - whole.radii[0]).abs() < 1e-12);
        }
    }

    #[test]
    fn gas_leaves_through_a_tear_until_it_is_at_ambient_pressure() {
        let pressure =
            Pressure::Gas { start: 1.0, bulk: 1e3, pump: 0.0, tightness: 1.0, damping: 0.0, sealed: true };
        let frame = PressureFrame { pressure: &pressure, h: 1e-3, air_density: 1.0, rest_scale: 1.0 };
        // A rigid chamber of a litre.
        let still = ChamberSums { volume: 3e-3, ..ChamberSums::default() };
        let mut chamber = Chamber { start_volume: 1e-3, volume: 1e-3, amount: -1.0, torn: 0.0 };
        chamber.step(&frame, &still, 0.06);
        assert_eq!(chamber.amount, 2.0, "whole");
        chamber.torn = 1e-4;
        chamber.step(&frame, &still, 0.06);
        // Bernoulli: a pressure of a kilopascal above ambient streams at (2 p / density)^(1/2) through a square centimetre.
        let flow = (2.0 * 1e3f64 / AIR).sqrt() * 1e-4 * 1e-3 / 1e-3;
        assert!((chamber.amount - (2.0 - flow)).abs() < 1e-9, "{}", chamber.amount);
        for _ in 0..10_000 {
            chamber.step(&frame, &still, 0.06);
        }
        assert!((chamber.amount - 1.0).abs() < 1e-3, "{}", chamber.amount);
    }
}
