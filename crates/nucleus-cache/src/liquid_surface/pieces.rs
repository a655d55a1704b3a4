//! Pieces of a surface without a particle inside.
//!
//! Between particles that are about two spacings apart the weighted mean is as near as a particle would be, so that the signed
//! distance has a body there that is nobody's. Joined to a particle it is a bridge; on its own it is removed.

use std::f64::consts::TAU;

use nucleus_core::nalgebra::Vector3;

use super::LiquidSurface;

/// Volume in cubed spacings from which a piece is taken to hold a particle.
const LARGE: f64 = 8.0;

/// A piece of the surface: what its quads join.
#[derive(Debug, Clone)]
struct Piece {
    low: [f32; 3],
    high: [f32; 3],
    volume: f64,
    quads: Vec<[u32; 4]>,
}

impl LiquidSurface {
    /// Removes small pieces that hold none of the particles, which are a spacing apart.
    pub(super) fn remove_empty_pieces(&mut self, particles: &[[f32; 3]], spacing: f32) {
        let pieces = self.pieces();
        let most = LARGE * f64::from(spacing).powi(3);
        let mut along_x = particles.to_vec();
        along_x.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let is_empty = |piece: &Piece| {
            let first = along_x.partition_point(|place| place[0] < piece.low[0]);
            let near = along_x[first..].iter().take_while(|place| place[0] <= piece.high[0]);
            let is_in_box =
                |place: &&[f32; 3]| (0..3).all(|k| (piece.low[k]..=piece.high[k]).contains(&place[k]));
            !near.filter(is_in_box).any(|place| self.encloses(piece, *place))
        };
        // A negative volume is a bubble.
        let is_small = |piece: &&Piece| (0.0..most).contains(&piece.volume);
        let mut stays = vec![true; self.positions.len()];
        for piece in pieces.iter().filter(is_small).filter(|piece| is_empty(piece)) {
            piece.quads.iter().flatten().for_each(|&point| stays[point as usize] = false);
        }
        self.keep(&stays);
    }

    /// Keeps some points, and the quads between them.
    fn keep(&mut self, stays: &[bool]) {
        let mut count = 0;
        let numbers: Vec<u32> = stays.iter().map(|&stays| (count, count += u32::from(stays)).0).collect();
        let mut of_point = stays.iter();
        self.positions.retain(|_| of_point.next() == Some(&true));
        self.quads.retain(|quad| stays[quad[0] as usize]);
        self.quads.iter_mut().flatten().for_each(|point| *point = numbers[*point as usize]);
    }

    fn pieces(&self) -> Vec<Piece> {
        let mut first: Vec<u32> = (0..self.positions.len() as u32).collect();
        fn find(first: &mut [u32], mut point: u32) -> u32 {
            while first[point as usize] != point {
                first[point as usize] = first[first[point as usize] as usize];
                point = first[point as usize];
            }
            point
        }
        for quad in &self.quads {
            for k in 1..4 {
                let [a, b] = [quad[0], quad[k]].map(|point| find(&mut first, point));
                first[a.max(b) as usize] = a.min(b);
            }
        }
        let none = Piece { low: [f32::MAX; 3], high: [f32::MIN; 3], volume: 0.0, quads: Vec::new() };
        let mut numbers = vec![usize::MAX; first.len()];
        let mut pieces: Vec<Piece> = Vec::new();
        for &quad in &self.quads {
            let number = &mut numbers[find(&mut first, quad[0]) as usize];
            if *number == usize::MAX {
                *number = pieces.len();
                pieces.push(none.clone());
            }
            let piece = &mut pieces[*number];
            for [x, y, z] in quad.map(|point| self.positions[point as usize]) {
                piece.low = [piece.low[0].min(x), piece.low[1].min(y), piece.low[2].min(z)];
                piece.high = [piece.high[0].max(x), piece.high[1].max(y), piece.high[2].max(z)];
            }
            let low = piece.low;
            piece.volume += self.triangles(quad, low).map(volume).into_iter().sum::<f64>();
            piece.quads.push(quad);
        }
        pieces
    }

    /// The two triangles of a quad, relative to a place.
    fn triangles(&self, [a, b, c, d]: [u32; 4], from: [f32; 3]) -> [[Vector3<f64>; 3]; 2] {
        let corner = |point: u32| {
            let place = self.positions[point as usize];
            Vector3::from_fn(|k, _| f64::from(place[k]) - f64::from(from[k]))
        };
        [[a, b, c], [a, c, d]].map(|triangle| triangle.map(corner))
    }

    /// Whether a piece encloses a place: its solid angle there is that of the whole sphere.
    fn encloses(&self, piece: &Piece, place: [f32; 3]) -> bool {
        let angles = piece.quads.iter().flat_map(|&quad| self.triangles(quad, place)).map(solid_angle);
        angles.sum::<f64>() > TAU
    }
}

/// The volume between a triangle and the origin, positive where it faces away.
fn volume([a, b, c]: [Vector3<f64>; 3]) -> f64 {
    a.dot(&b.cross(&c)) / 6.0
}

/// The solid angle of a triangle seen from the origin, positive where it faces away (van Oosterom & Strackee 1983, "The solid
/// angle of a plane triangle").
fn solid_angle([a, b, c]: [Vector3<f64>; 3]) -> f64 {
    let [x, y, z] = [a, b, c].map(|corner| corner.norm());
    2.0 * a.dot(&b.cross(&c)).atan2(x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::SurfaceShape;

    fn surface(particles: &[[f32; 3]]) -> LiquidSurface {
        LiquidSurface::of(particles, 1.0, SurfaceShape::DEFAULT)
    }

    #[test]
    fn every_piece_of_a_surface_holds_a_particle() {
        // Apart by 1.8 to 2.4 spacings along a diagonal: from bridges to two balls.
        for k in 0..=12 {
            let apart = (1.8 + 0.05 * k as f32) / 3f32.sqrt();
            let particles = [[0.3, 0.1, 0.2], [0.3 + apart, 0.1 + apart, 0.2 + apart]];
            let found = surface(&particles);
            for piece in found.pieces() {
                let holds = particles.iter().any(|place| found.encloses(&piece, *place));
                assert!(holds, "{k}: a piece of {}", piece.volume);
            }
            assert!((1..=2).contains(&found.pieces().len()));
            let points = found.positions.len() as u32;
            let mut used: Vec<u32> = found.quads.iter().flatten().copied().collect();
            used.sort_unstable();
            used.dedup();
            assert_eq!(used, (0..points).collect::<Vec<u32>>());
        }
    }

    #[test]
    fn a_solid_angle_tells_inside_from_outside() {
        let found = surface(&[[0.0; 3]]);
        let [piece] = &found.pieces()[..] else { panic!("one ball") };
        assert!((piece.volume - 1.0).abs() < 0.1, "{}", piece.volume);
        for (place, is_inside) in [([0.0; 3], true), ([0.0, 0.5, 0.0], true), ([0.0, 0.8, 0.0], false)] {
            assert_eq!(found.encloses(piece, place), is_inside, "{place:?}");
        }
    }
}
