//! Gusts: the wind varies smoothly in space and time by `windNoise` times its speed.
//!
//! Noise on a lattice that the wind carries along (frozen turbulence, Taylor 1938), in two octaves. Its value at a lattice
//! point is a hash of its coordinates, so the same scene has the same gusts on every machine.

use nalgebra::Vector3;

use crate::input::frame::{ClothFrame, FrameInput};
use crate::math::{Real, Row4};
use crate::model::ClothModel;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::state::State;

/// Size in metres of the largest gusts, and of those of half their strength.
const SIZES: [(f64, f64); 2] = [(2.0, 2.0 / 3.0), (0.5, 1.0 / 3.0)];

/// Whether the wind of a frame varies.
pub fn is_gusty(frame: &FrameInput) -> bool {
    frame.wind_noise != 0.0 && frame.wind != Vector3::zeros()
}

/// Sets what gusts add to the wind at every point that feels it, once per substep; `time` is in seconds since the start of
/// the frame.
pub fn update_gusts<R: Real>(
    cloths: &[ClothModel<R>],
    state: &mut State<R>,
    frame: &FrameInput,
    time: f64,
    pool: &ThreadPool,
) {
    if !is_gusty(frame) || state.normal.is_empty() {
        return state.gust.clear();
    }
    state.gust.clear();
    state.gust.resize(state.normal.len(), Row4::ZERO);
    let feels = |(cloth, settings): &(&ClothModel<R>, &ClothFrame)| {
        settings.feels_wind && !cloth.triangles.is_empty()
    };
    for (cloth, _) in cloths.iter().zip(&frame.cloths).filter(feels) {
        find_gusts(cloth, state, frame, time, pool);
    }
}

fn find_gusts<R: Real>(
    cloth: &ClothModel<R>,
    state: &mut State<R>,
    frame: &FrameInput,
    time: f64,
    pool: &ThreadPool,
) {
    // The frame's own travel is counted from its start on.
    let travel = Vector3::from(state.wind_travel) + frame.wind * (time - frame.duration);
    let strength = frame.wind.norm() * frame.wind_noise;
    let State { anchor, displacement, gust, .. } = state;
    let gusts = DisjointSlice::new(gust);
    pool.parallel_for(cloth.blocks.len(), |block| {
        let rows = cloth.blocks.range(block);
        // SAFETY: blocks do not overlap.
        #[allow(unsafe_code)]
        let run = unsafe { gusts.run(rows.clone()) };
        for (row, gust) in rows.zip(run) {
            let moved = displacement[row as usize].xyz().map(R::to_f64);
            let place = Vector3::from(anchor[row as usize]) + Vector3::from(moved) - travel;
            *gust = Row4::new((noise(place) * strength).into(), R::ZERO);
        }
    });
}

/// A smooth field of vectors, each component between -1 and 1 and of mean zero; `place` in metres.
fn noise(place: Vector3<f64>) -> Vector3<f64> {
    SIZES.iter().map(|&(size, share)| lattice_noise(place / size) * share).sum()
}

/// Smooth noise of mean zero, a lattice point per unit: each component between -1 and 1.
pub fn lattice_noise(place: Vector3<f64>) -> Vector3<f64> {
    let low = place.map(f64::floor);
    let share = (place - low).map(|t| t * t * t * (t * (t * 6.0 - 15.0) + 10.0));
    let cell = low.map(|x| x as i64);
    let mut sum = Vector3::zeros();
    for corner in 0..8i64 {
        let offset = Vector3::new(corner & 1, corner >> 1 & 1, corner >> 2);
        let weight: f64 =
            (0..3).map(|axis| if offset[axis] == 1 { share[axis] } else { 1.0 - share[axis] }).product();
        sum += value(cell + offset) * weight;
    }
    sum
}

/// The value at a lattice point: three components between -1 and 1.
fn value(cell: Vector3<i64>) -> Vector3<f64> {
    let mixed = |hash: u64, x: i64| {
        let hash = (hash ^ x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (hash ^ hash >> 32).wrapping_mul(0xd6e8_feb8_6659_fd93)
    };
    let hash = cell.iter().fold(0x2545_f491_4f6c_dd1d, |hash, &x| mixed(hash, x));
    let component = |k: i64| {
        let bits = mixed(hash, k) >> 40;
        bits as f64 / f64::from(1u32 << 23) - 1.0
    };
    Vector3::new(component(1), component(2), component(3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gusts_are_smooth_bounded_and_of_mean_zero() {
        let line = (0..40_000).map(|k| noise(Vector3::new(f64::from(k) * 0.01, 3.3, -7.1)));
        let all: Vec<_> = line.collect();
        assert!(all.iter().all(|v| v.amax() <= 1.0));
        assert!(all.windows(2).all(|pair| (pair[1] - pair[0]).amax() < 0.06), "no jump in a centimetre");
        let mean = all.iter().sum::<Vector3<f64>>() / all.len() as f64;
        assert!(mean.amax() < 0.1, "{mean}");
        let spread = all.iter().map(|v| v.norm_squared() / 3.0).sum::<f64>() / all.len() as f64;
        assert!(spread.sqrt() > 0.15, "{spread}");
    }
}
