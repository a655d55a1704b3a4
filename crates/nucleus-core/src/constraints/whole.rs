//! Effects on a whole cloth, not row by row: pressure, shape, the input mesh, and plastic deformation.

use crate::input::frame::{BendSolver, Bending, FrameInput, InputMesh};
use crate::math::Real;
use crate::model::ClothModel;
use crate::parallel::thread_pool::ThreadPool;
use crate::schedule::{PassTime, WholeEffect, WholeSweep};
use crate::state::{Chamber, State};

use super::angle::AngleMemory;
use super::attract::Attraction;
use super::plastic;
use super::pressure::PressureFrame;
use super::shape::UNTURNED;

/// Gives the chambers and shells of all cloths their places in the state.
pub fn prepare<R: Real>(models: &mut [ClothModel<R>], state: &mut State<R>, pool: &ThreadPool) {
    for model in models {
        model.shape.first = state.rotations.len();
        state.rotations.resize(model.shape.first + model.shape.shells(), UNTURNED);
        if model.pressure.is_on() {
            model.pressure.first = state.chambers.len();
            let chambers = model.pressure.first + model.pressure.chambers();
            state
                .chambers
                .resize(chambers, Chamber { start_volume: 0.0, volume: 0.0, amount: 0.0, torn: 0.0 });
            model.pressure.start(&model.blocks, state, pool);
        }
    }
}

/// One pass of an effect over the cloth that it names, in a time step that ends `now`.
pub fn relax<R: Real>(
    whole: &WholeSweep,
    cloths: &[ClothModel<R>],
    state: &mut State<R>,
    frame: &FrameInput,
    now: PassTime,
    pool: &ThreadPool,
) {
    let PassTime { at: end, length: h } = now;
    let (cloth, settings) = (&cloths[whole.cloth], &frame.cloths[whole.cloth]);
    match whole.effect {
        WholeEffect::Pressure if cloth.pressure.is_on() => {
            let (air_density, rest_scale) = (frame.air_density, settings.rest_length_scale);
            let pushed = PressureFrame { pressure: &settings.pressure, h, air_density, rest_scale };
            cloth.pressure.inflate(&cloth.blocks, state, &pushed, pool);
        }
        WholeEffect::Pressure => {}
        WholeEffect::Shape(strength) => cloth.shape.relax(state, strength, pool),
        WholeEffect::Attract(share) => {
            let own = |mesh: &&InputMesh| mesh.cloth.index() == whole.cloth;
            for mesh in frame.input_meshes.iter().filter(own) {
                let (settings, duration) = (settings.input_attract, frame.duration);
                Attraction { cloth, mesh, settings, duration, h }.pull(state, end, share, pool);
            }
        }
    }
}

/// Velocities take up those of input meshes, before a time step of `h` seconds moves the points.
pub fn drag_to_input_meshes<R: Real>(
    cloths: &[ClothModel<R>],
    state: &mut State<R>,
    frame: &FrameInput,
    h: f64,
    pool: &ThreadPool,
) {
    for mesh in &frame.input_meshes {
        let settings = frame.cloths[mesh.cloth.index()].input_attract;
        let cloth = &cloths[mesh.cloth.index()];
        Attraction { cloth, mesh, settings, duration: frame.duration, h }.drag(state, pool);
    }
}

/// Lets links and bends yield, and follows hinges past 180°, at the end of a time step.
pub fn remember_deformation<R: Real>(
    cloths: &mut [ClothModel<R>],
    state: &State<R>,
    frame: &FrameInput,
    pool: &ThreadPool,
) {
    for (cloth, settings) in cloths.iter_mut().zip(&frame.cloths) {
        if cloth.lists.plastic && settings.yield_strain.is_finite() {
            let [scale, limit] = [settings.rest_length_scale, settings.yield_strain].map(R::from_f64);
            plastic::creep(cloth, &state.displacement, scale, limit, pool);
        }
        let Bending { angle_scale, yield_sine, yield_half_angle, solver, .. } = settings.bending;
        let memory = AngleMemory {
            scale: R::from_f64(angle_scale),
            yield_sine: R::from_f64(yield_sine),
            yield_half_angle,
            tracks_flips: solver == BendSolver::FlipTracking,
        };
        if memory.is_on() && cloth.bend_angles.len() + cloth.bend_six_angles.len() > 0 {
            plastic::remember_angles(cloth, &state.displacement, &memory, pool);
        }
    }
}
