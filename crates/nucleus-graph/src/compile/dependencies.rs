//! Attributes that have no effect without another one: the table.

use crate::attributes::{
    Attribute, Choice, Key, air_field, drag_field, field, n_base, n_cloth, n_particle, nucleus, particle,
    point_emitter, radial_field,
};

/// A condition for an attribute to have an effect.
pub(super) enum Need {
    /// Another attribute that is ever above zero.
    Number(&'static Key<f64>),
    /// Another attribute with one of these values, or with any but the first where there is none.
    Choice(&'static Key<Choice>, &'static [Choice]),
    /// Any of some numbers that is ever above zero.
    Positive(&'static [&'static Key<f64>]),
    /// Any of some switches that is ever on.
    On(&'static [&'static Key<bool>]),
    /// Particles that are born: by an emitter, or by an event.
    Births,
    /// Any of some other attributes, given.
    Given(&'static [&'static Attribute]),
    /// The Classic resistance model.
    Classic,
    /// The Physical resistance model.
    Physical,
}

/// Attributes that have no effect without another.
pub(super) struct Dependency {
    pub(super) rows: &'static [&'static Attribute],
    pub(super) need: Need,
    pub(super) help: &'static str,
}

/// `pressureMethod`.
const MANUAL: Choice = Choice(0);
const BY_VOLUME: Choice = Choice(1);

/// `emitterType`.
const DIRECTIONAL: Choice = Choice(0);
const SURFACE: Choice = Choice(2);
const CURVE: Choice = Choice(3);
const VOLUME: Choice = Choice(4);
/// `volumeShape` of an emitter.
const TORUS: Choice = Choice(4);

/// A ramp of particles and the end of its range, which have no effect without an input.
macro_rules! ramp {
    ($ramp:ident up to $most:ident over $input:ident) => {
        Dependency {
            rows: &[&n_particle::$ramp.row, &n_particle::$most.row],
            need: Need::Choice(&n_particle::$input, &[]),
            help: "say what the ramp is over: `radiusScaleInput: age`, and likewise for others",
        }
    };
}

/// Of objects, of the nucleus, of fields and of emitters, by type.
pub(super) static DEPENDENCIES: &[Dependency] = &[
    Dependency {
        rows: &[&n_cloth::PRESSURE.row],
        need: Need::Choice(&n_cloth::PRESSURE_METHOD, &[MANUAL]),
        help: "the gas inside sets the pressure: leave out `pressureMethod`, or give `startPressure`",
    },
    Dependency {
        rows: &[
            &n_cloth::START_PRESSURE.row,
            &n_cloth::PUMP_RATE.row,
            &n_cloth::AIR_TIGHTNESS.row,
            &n_cloth::INCOMPRESSIBILITY.row,
            &n_cloth::SEAL_HOLES.row,
        ],
        need: Need::Choice(&n_cloth::PRESSURE_METHOD, &[BY_VOLUME]),
        help: "write `pressureMethod: volumeTrackingModel`",
    },
    Dependency {
        rows: &[&n_base::WIND_SHADOW_DIFFUSION.row, &n_cloth::WIND_SELF_SHADOW.row],
        need: Need::Number(&n_base::WIND_SHADOW_DISTANCE),
        help: "give `windShadowDistance`",
    },
    Dependency {
        rows: &[&n_base::AIR_PUSH_VORTICITY.row],
        need: Need::Number(&n_base::AIR_PUSH_DISTANCE),
        help: "give `airPushDistance`",
    },
    Dependency {
        rows: &[&n_base::FIELD_MAGNITUDE.row, &n_base::FIELD_DISTANCE.row],
        need: Need::Choice(&n_base::FORCE_FIELD, &[]),
        help: "write `forceField: singleSided`, `doubleSided` or `alongNormal`",
    },
    Dependency {
        rows: &[
            &n_base::POINT_FIELD_MAGNITUDE.row,
            &n_base::POINT_FIELD_DISTANCE.row,
            &n_base::SELF_ATTRACT.row,
        ],
        need: Need::Choice(&n_base::POINT_FORCE_FIELD, &[]),
        help: "write `pointForceField: worldspace` or `thicknessRelative`",
    },
    Dependency {
        rows: &[&n_cloth::INPUT_ATTRACT_METHOD.row, &n_cloth::INPUT_ATTRACT_DAMP.row],
        need: Need::Number(&n_cloth::INPUT_MESH_ATTRACT),
        help: "give `inputMeshAttract`",
    },
    Dependency {
        rows: &[&n_cloth::INITIAL_PERTURBATION_SEED.row],
        need: Need::Number(&n_cloth::INITIAL_PERTURBATION),
        help: "give `initialPerturbation`",
    },
    Dependency {
        rows: &[
            &n_cloth::WEAVE_ANGLE.row,
            &n_cloth::WEAVE_ANGLE_MAP.row,
            &n_cloth::WEAVE_ANGLE_PER_VERTEX.row,
            &n_cloth::WARP_STIFFNESS.row,
            &n_cloth::WEFT_STIFFNESS.row,
        ],
        need: Need::On(&[&n_cloth::WEAVE]),
        help: "write `weave: true`",
    },
    Dependency {
        rows: &[&n_cloth::WEAVE_ANGLE_MAP.row, &n_cloth::WEAVE_ANGLE_PER_VERTEX.row],
        need: Need::Number(&n_cloth::WEAVE_ANGLE),
        help: "give `weaveAngle`",
    },
    Dependency {
        rows: &[
            &n_cloth::MINIMAL_STRETCH.row,
            &n_cloth::MINIMAL_BEND.row,
            &n_cloth::SCALING_RELATION.row,
            &n_base::MAX_ITERATIONS.row,
            &n_base::MAX_SELF_COLLISION_ITERATIONS.row,
            &nucleus::MAX_COLLISION_ITERATIONS.row,
        ],
        need: Need::Classic,
        help: "it is about counts: write `resistanceModel: classic`",
    },
    Dependency {
        rows: &[&nucleus::EVALUATIONS.row, &nucleus::AUTO_EVALUATIONS.row],
        need: Need::Physical,
        help: "resistances are counts: write `resistanceModel: physical`, or raise `subSteps`",
    },
    Dependency {
        rows: &[&n_cloth::TETHER_SCALE.row, &n_cloth::LONG_LINKS.row],
        need: Need::On(&[&n_cloth::TETHERS]),
        help: "write `tethers: true`",
    },
    Dependency {
        rows: &[&n_cloth::WRINKLE_MAP_SCALE.row],
        need: Need::Given(&[&n_cloth::WRINKLE_MAP.row, &n_cloth::WRINKLE_PER_VERTEX.row]),
        help: "give `wrinkleMap` or `wrinklePerVertex`",
    },
    Dependency {
        rows: &[&n_base::CACHE_FILE.row],
        need: Need::On(&[&n_base::PLAY_FROM_CACHE]),
        help: "write `playFromCache: true`",
    },
    Dependency {
        rows: &[&n_particle::PARTICLE_SPACING.row],
        need: Need::Given(&[
            &n_particle::MINIMUM_CORNER.row,
            &n_particle::MAXIMUM_CORNER.row,
            &n_particle::FILL_MESH.row,
        ]),
        help: "give `minimumCorner` and `maximumCorner`, or `fillMesh`",
    },
    Dependency {
        rows: &[
            &particle::EVENT_COUNT.row,
            &particle::EVENT_RANDOM.row,
            &particle::EVENT_SPREAD.row,
            &n_particle::EVENT_PROBABILITY.row,
            &n_particle::EVENT_PARTICLES.row,
        ],
        need: Need::Given(&[&particle::EVENT_EMIT.row, &particle::EVENT_SPLIT.row, &particle::EVENT_DIE.row]),
        help: "say what happens at a collision: give `eventEmit`, `eventSplit` or `eventDie`",
    },
    Dependency {
        rows: &[
            &nucleus::PLANE_ORIGIN.row,
            &nucleus::PLANE_NORMAL.row,
            &nucleus::PLANE_FRICTION.row,
            &nucleus::PLANE_BOUNCE.row,
            &nucleus::PLANE_STICKINESS.row,
        ],
        need: Need::On(&[&nucleus::USE_PLANE]),
        help: "write `usePlane: true`",
    },
    Dependency {
        rows: &[&nucleus::WIND_NOISE.row],
        need: Need::Number(&nucleus::WIND_SPEED),
        help: "give `windSpeed`",
    },
    Dependency {
        rows: &[&particle::LIFESPAN.row],
        need: Need::Choice(&particle::LIFESPAN_MODE, &[]),
        help: "write `lifespanMode: constant`",
    },
    Dependency {
        rows: &[&particle::LIFESPAN_RANDOM.row],
        need: Need::Choice(&particle::LIFESPAN_MODE, &[particle::RANDOM_RANGE]),
        help: "write `lifespanMode: randomRange`",
    },
    Dependency {
        rows: &[&n_particle::LIFESPAN_PP.row],
        need: Need::Choice(&particle::LIFESPAN_MODE, &[particle::LIFESPAN_PP_ONLY]),
        help: "write `lifespanMode: lifespanPPOnly`",
    },
    Dependency {
        rows: &[&n_particle::ROTATION_FRICTION.row, &n_particle::ROTATION_DAMP.row],
        need: Need::On(&[&n_particle::COMPUTE_ROTATION]),
        help: "write `computeRotation: true`",
    },
    Dependency {
        rows: &[
            &n_particle::INCOMPRESSIBILITY.row,
            &n_particle::VISCOSITY.row,
            &n_particle::SURFACE_TENSION.row,
            &n_particle::REST_DENSITY.row,
            &n_particle::RADIUS_SCALE_SPH.row,
        ],
        need: Need::On(&[&n_particle::ENABLE_SPH]),
        help: "write `enableSPH: true`",
    },
    Dependency {
        rows: &[
            &particle::SEED.row,
            &particle::MAX_COUNT.row,
            &particle::LEVEL_OF_DETAIL.row,
            &particle::INHERIT_FACTOR.row,
            &n_particle::EMISSION_OVERLAP_PRUNING.row,
        ],
        need: Need::Births,
        help: "let a pointEmitter emit them: `target: \"nParticle1\"` of the emitter",
    },
    ramp!(MASS_SCALE up to MASS_SCALE_INPUT_MAX over MASS_SCALE_INPUT),
    ramp!(FRICTION_SCALE up to FRICTION_SCALE_INPUT_MAX over FRICTION_SCALE_INPUT),
    ramp!(STICKINESS_SCALE up to STICKINESS_SCALE_INPUT_MAX over STICKINESS_SCALE_INPUT),
    ramp!(COLLIDE_STRENGTH_SCALE up to COLLIDE_STRENGTH_SCALE_INPUT_MAX over COLLIDE_STRENGTH_SCALE_INPUT),
    ramp!(BOUNCE_SCALE up to BOUNCE_SCALE_INPUT_MAX over BOUNCE_SCALE_INPUT),
    ramp!(VISCOSITY_SCALE up to VISCOSITY_SCALE_INPUT_MAX over VISCOSITY_SCALE_INPUT),
    ramp!(SURFACE_TENSION_SCALE up to SURFACE_TENSION_SCALE_INPUT_MAX over SURFACE_TENSION_SCALE_INPUT),
    ramp!(OPACITY_SCALE up to OPACITY_SCALE_INPUT_MAX over OPACITY_SCALE_INPUT),
    ramp!(RADIUS_SCALE up to RADIUS_SCALE_INPUT_MAX over RADIUS_SCALE_INPUT),
    Dependency {
        rows: &[&n_particle::RADIUS_SCALE_INPUT.row],
        need: Need::Given(&[&n_particle::RADIUS_SCALE.row, &n_particle::RADIUS_SCALE_RANDOMIZE.row]),
        help: "give the ramp: `radiusScale: [(0, 1), (1, 0.2)]`",
    },
    ramp!(POINT_FIELD_SCALE up to POINT_FIELD_SCALE_INPUT_MAX over POINT_FIELD_SCALE_INPUT),
    Dependency {
        rows: &[&field::MAX_DISTANCE.row, &field::FALLOFF_CURVE.row, &radial_field::RADIAL_TYPE.row],
        need: Need::On(&[&field::USE_MAX_DISTANCE]),
        help: "write `useMaxDistance: true`",
    },
    Dependency {
        rows: &[
            &field::VOLUME_OFFSET.row,
            &field::VOLUME_EXCLUSION.row,
            &field::VOLUME_SWEEP.row,
            &field::SECTION_RADIUS.row,
        ],
        need: Need::Choice(&field::VOLUME_SHAPE, &[]),
        help: "give `volumeShape`",
    },
    Dependency {
        rows: &[&air_field::SPREAD.row],
        need: Need::On(&[&air_field::ENABLE_SPREAD]),
        help: "write `enableSpread: true`",
    },
    Dependency {
        rows: &[&drag_field::DIRECTION.row],
        need: Need::On(&[&drag_field::USE_DIRECTION]),
        help: "write `useDirection: true`",
    },
    Dependency {
        rows: &[
            &point_emitter::VOLUME_SHAPE.row,
            &point_emitter::VOLUME_OFFSET.row,
            &point_emitter::VOLUME_SWEEP.row,
            &point_emitter::SECTION_RADIUS.row,
            &point_emitter::AWAY_FROM_CENTER.row,
            &point_emitter::AWAY_FROM_AXIS.row,
            &point_emitter::ALONG_AXIS.row,
            &point_emitter::AROUND_AXIS.row,
            &point_emitter::RANDOM_DIRECTION.row,
            &point_emitter::DIRECTIONAL_SPEED.row,
        ],
        need: Need::Choice(&point_emitter::EMITTER_TYPE, &[VOLUME]),
        help: "write `emitterType: volume`",
    },
    Dependency {
        rows: &[&point_emitter::SECTION_RADIUS.row],
        need: Need::Choice(&point_emitter::VOLUME_SHAPE, &[TORUS]),
        help: "write `volumeShape: torus`",
    },
    Dependency {
        rows: &[&point_emitter::VOLUME_SWEEP.row],
        need: Need::Choice(&point_emitter::VOLUME_SHAPE, &[]),
        help: "a cube has no sweep: write `volumeShape: cylinder` or another round one",
    },
    Dependency {
        rows: &[&point_emitter::SPREAD.row],
        need: Need::Choice(&point_emitter::EMITTER_TYPE, &[DIRECTIONAL]),
        help: "write `emitterType: directional`",
    },
    Dependency {
        rows: &[&point_emitter::NORMAL_SPEED.row, &point_emitter::TANGENT_SPEED.row],
        need: Need::Choice(&point_emitter::EMITTER_TYPE, &[SURFACE, CURVE]),
        help: "write `emitterType: surface` or `curve`; others have `speed` and the speeds of a volume",
    },
    Dependency {
        rows: &[&point_emitter::RATE_MAP.row, &point_emitter::ENABLE_TEXTURE_RATE.row],
        need: Need::Choice(&point_emitter::EMITTER_TYPE, &[SURFACE]),
        help: "write `emitterType: surface`",
    },
    Dependency {
        rows: &[&point_emitter::RATE_MAP.row, &point_emitter::EMIT_FROM_DARK.row],
        need: Need::On(&[&point_emitter::ENABLE_TEXTURE_RATE]),
        help: "write `enableTextureRate: true`",
    },
    Dependency {
        rows: &[&point_emitter::ENABLE_TEXTURE_RATE.row],
        need: Need::Given(&[&point_emitter::RATE_MAP.row]),
        help: "give the texture: `rateMap: texture(\"rate.png\")`",
    },
    Dependency {
        rows: &[&n_cloth::BEND_ANGLE_DROPOFF.row, &n_cloth::RESTITUTION_ANGLE.row],
        need: Need::Positive(&[&n_cloth::BEND_RESISTANCE, &n_cloth::BEND_STIFFNESS]),
        help: "give `bendResistance`",
    },
    Dependency {
        rows: &[&n_base::SELF_COLLISION_FLAG.row, &n_cloth::SELF_COLLIDE_WIDTH_SCALE.row],
        need: Need::On(&[&n_base::SELF_COLLIDE]),
        help: "write `selfCollide: true`",
    },
    Dependency {
        rows: &[&n_base::FRICTION.row],
        need: Need::On(&[&n_base::COLLIDE, &n_base::SELF_COLLIDE]),
        help: "write `collide: true`",
    },
];
