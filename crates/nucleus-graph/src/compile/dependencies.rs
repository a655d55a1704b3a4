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
    Choice(&'static Key<Choice>, Option<Choice>),
    /// A switch that is ever on.
    On(&'static Key<bool>),
    /// The Classic resistance model.
    Classic,
}

/// An attribute that has no effect without another.
pub(super) struct Dependency {
    pub(super) row: &'static Attribute,
    pub(super) need: Need,
    pub(super) help: &'static str,
}

const fn needs(row: &'static Attribute, need: Need, help: &'static str) -> Dependency {
    Dependency { row, need, help }
}

/// `pressureMethod`.
const MANUAL: Choice = Choice(0);
const BY_VOLUME: Choice = Choice(1);
const BY_VOLUME_HELP: &str = "write `pressureMethod: volumeTrackingModel`";

const WOVEN_HELP: &str = "write `weave: true`";

/// `lifespanMode`, and `emitterType`.
const RANDOM_RANGE: Choice = Choice(2);
const LISTED: Choice = Choice(3);
const VOLUME: Choice = Choice(4);
const LIFESPAN_HELP: &str = "write `lifespanMode: constant`";
const LIFESPAN_RANDOM_HELP: &str = "write `lifespanMode: randomRange`";
const LIFESPAN_PP_HELP: &str = "write `lifespanMode: lifespanPPOnly`";
const RAMP_HELP: &str = "say what the ramp is over: `radiusScaleInput: age`, and likewise for others";
const FIELD_VOLUME_HELP: &str = "give `volumeShape`";
const EMITTER_VOLUME_HELP: &str = "write `emitterType: volume`";

/// Of objects, of the nucleus, of fields and of emitters, by type.
pub(super) static DEPENDENCIES: &[Dependency] = &[
    needs(
        &n_cloth::PRESSURE.row,
        Need::Choice(&n_cloth::PRESSURE_METHOD, Some(MANUAL)),
        "the gas inside sets the pressure: leave out `pressureMethod`, or give `startPressure`",
    ),
    needs(
        &n_cloth::START_PRESSURE.row,
        Need::Choice(&n_cloth::PRESSURE_METHOD, Some(BY_VOLUME)),
        BY_VOLUME_HELP,
    ),
    needs(&n_cloth::PUMP_RATE.row, Need::Choice(&n_cloth::PRESSURE_METHOD, Some(BY_VOLUME)), BY_VOLUME_HELP),
    needs(
        &n_cloth::AIR_TIGHTNESS.row,
        Need::Choice(&n_cloth::PRESSURE_METHOD, Some(BY_VOLUME)),
        BY_VOLUME_HELP,
    ),
    needs(
        &n_cloth::INCOMPRESSIBILITY.row,
        Need::Choice(&n_cloth::PRESSURE_METHOD, Some(BY_VOLUME)),
        BY_VOLUME_HELP,
    ),
    needs(&n_cloth::SEAL_HOLES.row, Need::Choice(&n_cloth::PRESSURE_METHOD, Some(BY_VOLUME)), BY_VOLUME_HELP),
    needs(
        &n_base::WIND_SHADOW_DIFFUSION.row,
        Need::Number(&n_base::WIND_SHADOW_DISTANCE),
        "give `windShadowDistance`",
    ),
    needs(
        &n_cloth::WIND_SELF_SHADOW.row,
        Need::Number(&n_base::WIND_SHADOW_DISTANCE),
        "give `windShadowDistance`",
    ),
    needs(
        &n_base::AIR_PUSH_VORTICITY.row,
        Need::Number(&n_base::AIR_PUSH_DISTANCE),
        "give `airPushDistance`",
    ),
    needs(
        &n_base::FIELD_MAGNITUDE.row,
        Need::Choice(&n_base::FORCE_FIELD, None),
        "write `forceField: singleSided`, `doubleSided` or `alongNormal`",
    ),
    needs(
        &n_base::POINT_FIELD_MAGNITUDE.row,
        Need::Choice(&n_base::POINT_FORCE_FIELD, None),
        "write `pointForceField: worldspace` or `thicknessRelative`",
    ),
    needs(
        &n_base::SELF_ATTRACT.row,
        Need::Choice(&n_base::POINT_FORCE_FIELD, None),
        "write `pointForceField: worldspace` or `thicknessRelative`",
    ),
    needs(
        &n_cloth::INPUT_ATTRACT_METHOD.row,
        Need::Number(&n_cloth::INPUT_MESH_ATTRACT),
        "give `inputMeshAttract`",
    ),
    needs(
        &n_cloth::INPUT_ATTRACT_DAMP.row,
        Need::Number(&n_cloth::INPUT_MESH_ATTRACT),
        "give `inputMeshAttract`",
    ),
    needs(
        &n_cloth::INITIAL_PERTURBATION_SEED.row,
        Need::Number(&n_cloth::INITIAL_PERTURBATION),
        "give `initialPerturbation`",
    ),
    needs(&n_cloth::WEAVE_ANGLE.row, Need::On(&n_cloth::WEAVE), WOVEN_HELP),
    needs(&n_cloth::WEAVE_ANGLE_MAP.row, Need::On(&n_cloth::WEAVE), WOVEN_HELP),
    needs(&n_cloth::WEAVE_ANGLE_MAP.row, Need::Number(&n_cloth::WEAVE_ANGLE), "give `weaveAngle`"),
    needs(&n_cloth::WEAVE_ANGLE_PER_VERTEX.row, Need::On(&n_cloth::WEAVE), WOVEN_HELP),
    needs(&n_cloth::WEAVE_ANGLE_PER_VERTEX.row, Need::Number(&n_cloth::WEAVE_ANGLE), "give `weaveAngle`"),
    needs(&n_cloth::WARP_STIFFNESS.row, Need::On(&n_cloth::WEAVE), WOVEN_HELP),
    needs(&n_cloth::WEFT_STIFFNESS.row, Need::On(&n_cloth::WEAVE), WOVEN_HELP),
    needs(&n_cloth::MINIMAL_STRETCH.row, Need::Classic, "it limits counts: write `resistanceModel: classic`"),
    needs(&n_cloth::MINIMAL_BEND.row, Need::Classic, "it limits counts: write `resistanceModel: classic`"),
    needs(&nucleus::PLANE_ORIGIN.row, Need::On(&nucleus::USE_PLANE), "write `usePlane: true`"),
    needs(&nucleus::PLANE_NORMAL.row, Need::On(&nucleus::USE_PLANE), "write `usePlane: true`"),
    needs(&nucleus::PLANE_FRICTION.row, Need::On(&nucleus::USE_PLANE), "write `usePlane: true`"),
    needs(&nucleus::PLANE_BOUNCE.row, Need::On(&nucleus::USE_PLANE), "write `usePlane: true`"),
    needs(&nucleus::PLANE_STICKINESS.row, Need::On(&nucleus::USE_PLANE), "write `usePlane: true`"),
    needs(&nucleus::WIND_NOISE.row, Need::Number(&nucleus::WIND_SPEED), "give `windSpeed`"),
    needs(&particle::LIFESPAN.row, Need::Choice(&particle::LIFESPAN_MODE, None), LIFESPAN_HELP),
    needs(
        &particle::LIFESPAN_RANDOM.row,
        Need::Choice(&particle::LIFESPAN_MODE, Some(RANDOM_RANGE)),
        LIFESPAN_RANDOM_HELP,
    ),
    needs(
        &n_particle::LIFESPAN_PP.row,
        Need::Choice(&particle::LIFESPAN_MODE, Some(LISTED)),
        LIFESPAN_PP_HELP,
    ),
    needs(
        &n_particle::ROTATION_FRICTION.row,
        Need::On(&n_particle::COMPUTE_ROTATION),
        "write `computeRotation: true`",
    ),
    needs(
        &n_particle::ROTATION_DAMP.row,
        Need::On(&n_particle::COMPUTE_ROTATION),
        "write `computeRotation: true`",
    ),
    needs(&n_particle::INCOMPRESSIBILITY.row, Need::On(&n_particle::ENABLE_SPH), "write `enableSPH: true`"),
    needs(&n_particle::VISCOSITY.row, Need::On(&n_particle::ENABLE_SPH), "write `enableSPH: true`"),
    needs(&n_particle::SURFACE_TENSION.row, Need::On(&n_particle::ENABLE_SPH), "write `enableSPH: true`"),
    needs(&n_particle::REST_DENSITY.row, Need::On(&n_particle::ENABLE_SPH), "write `enableSPH: true`"),
    needs(&n_particle::RADIUS_SCALE_SPH.row, Need::On(&n_particle::ENABLE_SPH), "write `enableSPH: true`"),
    needs(&n_particle::MASS_SCALE.row, Need::Choice(&n_particle::MASS_SCALE_INPUT, None), RAMP_HELP),
    needs(&n_particle::FRICTION_SCALE.row, Need::Choice(&n_particle::FRICTION_SCALE_INPUT, None), RAMP_HELP),
    needs(
        &n_particle::STICKINESS_SCALE.row,
        Need::Choice(&n_particle::STICKINESS_SCALE_INPUT, None),
        RAMP_HELP,
    ),
    needs(
        &n_particle::COLLIDE_STRENGTH_SCALE.row,
        Need::Choice(&n_particle::COLLIDE_STRENGTH_SCALE_INPUT, None),
        RAMP_HELP,
    ),
    needs(&n_particle::BOUNCE_SCALE.row, Need::Choice(&n_particle::BOUNCE_SCALE_INPUT, None), RAMP_HELP),
    needs(
        &n_particle::VISCOSITY_SCALE.row,
        Need::Choice(&n_particle::VISCOSITY_SCALE_INPUT, None),
        RAMP_HELP,
    ),
    needs(
        &n_particle::SURFACE_TENSION_SCALE.row,
        Need::Choice(&n_particle::SURFACE_TENSION_SCALE_INPUT, None),
        RAMP_HELP,
    ),
    needs(&n_particle::OPACITY_SCALE.row, Need::Choice(&n_particle::OPACITY_SCALE_INPUT, None), RAMP_HELP),
    needs(&n_particle::RADIUS_SCALE.row, Need::Choice(&n_particle::RADIUS_SCALE_INPUT, None), RAMP_HELP),
    needs(
        &n_particle::POINT_FIELD_SCALE.row,
        Need::Choice(&n_particle::POINT_FIELD_SCALE_INPUT, None),
        RAMP_HELP,
    ),
    needs(
        &field::USE_MAX_DISTANCE.row,
        Need::Number(&field::MAX_DISTANCE),
        "give `maxDistance`: a field of no reach acts on nothing",
    ),
    needs(&field::MAX_DISTANCE.row, Need::On(&field::USE_MAX_DISTANCE), "write `useMaxDistance: true`"),
    needs(&field::FALLOFF_CURVE.row, Need::On(&field::USE_MAX_DISTANCE), "write `useMaxDistance: true`"),
    needs(&radial_field::RADIAL_TYPE.row, Need::On(&field::USE_MAX_DISTANCE), "write `useMaxDistance: true`"),
    needs(&field::VOLUME_OFFSET.row, Need::Choice(&field::VOLUME_SHAPE, None), FIELD_VOLUME_HELP),
    needs(&field::VOLUME_EXCLUSION.row, Need::Choice(&field::VOLUME_SHAPE, None), FIELD_VOLUME_HELP),
    needs(&field::VOLUME_SWEEP.row, Need::Choice(&field::VOLUME_SHAPE, None), FIELD_VOLUME_HELP),
    needs(&field::SECTION_RADIUS.row, Need::Choice(&field::VOLUME_SHAPE, None), FIELD_VOLUME_HELP),
    needs(&air_field::SPREAD.row, Need::On(&air_field::ENABLE_SPREAD), "write `enableSpread: true`"),
    needs(&drag_field::DIRECTION.row, Need::On(&drag_field::USE_DIRECTION), "write `useDirection: true`"),
    needs(
        &point_emitter::VOLUME_SHAPE.row,
        Need::Choice(&point_emitter::EMITTER_TYPE, Some(VOLUME)),
        EMITTER_VOLUME_HELP,
    ),
    needs(
        &point_emitter::VOLUME_OFFSET.row,
        Need::Choice(&point_emitter::EMITTER_TYPE, Some(VOLUME)),
        EMITTER_VOLUME_HELP,
    ),
    needs(
        &point_emitter::VOLUME_SWEEP.row,
        Need::Choice(&point_emitter::EMITTER_TYPE, Some(VOLUME)),
        EMITTER_VOLUME_HELP,
    ),
    needs(
        &point_emitter::SECTION_RADIUS.row,
        Need::Choice(&point_emitter::EMITTER_TYPE, Some(VOLUME)),
        EMITTER_VOLUME_HELP,
    ),
    needs(
        &point_emitter::AWAY_FROM_CENTER.row,
        Need::Choice(&point_emitter::EMITTER_TYPE, Some(VOLUME)),
        EMITTER_VOLUME_HELP,
    ),
    needs(
        &point_emitter::AWAY_FROM_AXIS.row,
        Need::Choice(&point_emitter::EMITTER_TYPE, Some(VOLUME)),
        EMITTER_VOLUME_HELP,
    ),
    needs(
        &point_emitter::ALONG_AXIS.row,
        Need::Choice(&point_emitter::EMITTER_TYPE, Some(VOLUME)),
        EMITTER_VOLUME_HELP,
    ),
    needs(
        &point_emitter::AROUND_AXIS.row,
        Need::Choice(&point_emitter::EMITTER_TYPE, Some(VOLUME)),
        EMITTER_VOLUME_HELP,
    ),
    needs(
        &point_emitter::RANDOM_DIRECTION.row,
        Need::Choice(&point_emitter::EMITTER_TYPE, Some(VOLUME)),
        EMITTER_VOLUME_HELP,
    ),
    needs(
        &point_emitter::DIRECTIONAL_SPEED.row,
        Need::Choice(&point_emitter::EMITTER_TYPE, Some(VOLUME)),
        EMITTER_VOLUME_HELP,
    ),
];
