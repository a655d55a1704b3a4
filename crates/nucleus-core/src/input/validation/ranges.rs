//! The ranges of all numbers in the input of a frame, as their documentation states them.
//!
//! [`Solver::check_frame`](crate::Solver::check_frame) refuses a number outside of its range and names it. A step is more lenient: it
//! replaces only what it cannot compute with, because scenes may go beyond Maya's usual ranges.

use nalgebra::Vector3;

use super::attributes::{MAX_COORDINATE, MAX_EVALUATIONS, MAX_FACTOR, MAX_SUBSTEPS, MIN_SPACING};
use super::number::{InputNumber, InputRange, InputSubject};
use super::sanitized::InvalidInput;
use crate::input::fields::{Field, FieldKind, Noise};
use crate::input::frame::{
    Birth, ClothFrame, ColliderFrame, ForceField, FrameInput, GroundPlane, Liquid, Pressure, PushOut,
    ResistanceModel, Stiffness,
};
use crate::input::links::{ConstraintFrame, Link, LinkKind, LinkSide};
use crate::input::object_fields::{PointField, WindField};
use crate::input::{ClothId, ColliderId};

/// Error of a sum of barycentric weights, at most: they may have been computed in `f32`.
const MAX_WEIGHT_ERROR: f64 = 1e-4;

const fn range(least: f64, most: f64) -> InputRange {
    InputRange { least: InputNumber(least), most: InputNumber(most), is_above: false }
}

const FINITE: InputRange = range(-MAX_COORDINATE, MAX_COORDINATE);
const POSITIVE: InputRange = range(0.0, MAX_COORDINATE);
const FACTOR: InputRange = range(-MAX_FACTOR, MAX_FACTOR);
const SHARE: InputRange = range(0.0, 1.0);
const SIGNED_SHARE: InputRange = range(-1.0, 1.0);
const STICKINESS: InputRange = range(0.0, 2.0);
/// A limit that may never be reached.
const LIMIT: InputRange = range(0.0, f64::INFINITY);
const NOT_NAN: InputRange = range(f64::NEG_INFINITY, f64::INFINITY);

/// A number with its name and its range.
type Row = (&'static str, f64, InputRange);

/// The first number of a frame that is outside of its range. Positions of points are checked elsewhere.
pub(crate) fn first_out_of_range(frame: &FrameInput) -> Option<InvalidInput> {
    let cloths = (0..).zip(&frame.cloths).map(|(at, cloth)| (InputSubject::Cloth(ClothId(at)), cloth));
    let colliders =
        (0..).zip(&frame.colliders).map(|(at, collider)| (InputSubject::Collider(ColliderId(at)), collider));
    first(InputSubject::Frame, frame_rows(frame))
        .or_else(|| frame.plane.as_ref().and_then(|plane| first(InputSubject::Plane, plane_rows(plane))))
        .or_else(|| cloths.into_iter().find_map(|(subject, cloth)| first(subject, cloth_rows(cloth))))
        .or_else(|| colliders.into_iter().find_map(|(subject, of)| first(subject, collider_rows(of))))
        .or_else(|| {
            (0..).zip(&frame.velocities).find_map(|(at, of)| {
                let rows = vector("velocity", of.velocity).into_iter();
                let rows = rows.chain(vector("acceleration", of.acceleration)).collect();
                first(InputSubject::StartVelocity(at), rows)
            })
        })
        .or_else(|| (0..).zip(&frame.constraints).find_map(|(at, of)| of_constraint(at, of)))
        .or_else(|| {
            (0..).zip(&frame.fields).find_map(|(at, of)| first(InputSubject::Field(at), field_rows(of)))
        })
        .or_else(|| of_births(&frame.births))
        .or_else(|| {
            (0..).zip(&frame.particle_changes).find_map(|(at, change)| {
                let mut rows: Vec<Row> =
                    change.lifespan.map(|x| ("lifespan", x, NOT_NAN)).into_iter().collect();
                rows.extend(change.velocity.into_iter().flat_map(|of| vector("velocity", of)));
                first(InputSubject::ParticleChange(at), rows)
            })
        })
}

fn first(subject: InputSubject, rows: Vec<Row>) -> Option<InvalidInput> {
    let (field, value, range) = rows.into_iter().find(|(_, value, range)| !range.contains(*value))?;
    Some(InvalidInput::OutOfRange { subject, field, value: InputNumber(value), range })
}

fn vector(name: &'static str, v: Vector3<f64>) -> [Row; 3] {
    [v.x, v.y, v.z].map(|x| (name, x, FINITE))
}

fn frame_rows(frame: &FrameInput) -> Vec<Row> {
    let mut rows = vec![
        ("substeps", f64::from(frame.substeps), range(1.0, MAX_SUBSTEPS as f64)),
        ("collision_iterations", frame.collision_iterations, POSITIVE),
        ("self_collision_iterations", frame.self_collision_iterations, POSITIVE),
        ("layer_range", frame.layer_range, FINITE),
        ("air_density", frame.air_density, POSITIVE),
        ("wind_noise", frame.wind_noise, POSITIVE),
    ];
    if let ResistanceModel::Physical { evaluations } = frame.resistance {
        let above = InputRange { is_above: true, ..range(0.0, MAX_EVALUATIONS) };
        rows.push(("resistance.evaluations", evaluations, above));
    }
    rows.extend(vector("gravity", frame.gravity));
    rows.extend(vector("wind", frame.wind));
    rows
}

fn plane_rows(plane: &GroundPlane) -> Vec<Row> {
    let mut rows = vec![
        ("bounce", plane.bounce, SHARE),
        ("friction", plane.friction, POSITIVE),
        ("stickiness", plane.stickiness, STICKINESS),
    ];
    rows.extend(vector("origin", plane.origin));
    rows.extend(vector("normal", plane.normal));
    rows
}

fn cloth_rows(cloth: &ClothFrame) -> Vec<Row> {
    let mut rows = vec![
        ("stretch_resistance", cloth.stretch_resistance, POSITIVE),
        ("compression_resistance", cloth.compression_resistance, POSITIVE),
        ("shear_resistance", cloth.shear_resistance, POSITIVE),
        ("bend_resistance", cloth.bend_resistance, POSITIVE),
        ("rest_length_scale", cloth.rest_length_scale, POSITIVE),
        ("tethers", cloth.tethers.unwrap_or_default(), FINITE),
        ("stretch_damp", cloth.stretch_damp, POSITIVE),
        ("damp", cloth.damp, POSITIVE),
        ("drag", cloth.drag, POSITIVE),
        ("tangential_drag", cloth.tangential_drag, SHARE),
        ("lift", cloth.lift, POSITIVE),
        ("thickness", cloth.thickness, POSITIVE),
        ("friction", cloth.friction, POSITIVE),
        ("stickiness", cloth.stickiness, STICKINESS),
        ("bounce", cloth.bounce, SHARE),
        ("collide_strength", cloth.collide_strength, POSITIVE),
        ("crossover_push", cloth.crossover_push, FINITE),
        ("self_crossover_push", cloth.self_crossover_push, FINITE),
        ("layer", cloth.layer, FINITE),
        ("self_collision.thickness", cloth.self_collision.thickness, POSITIVE),
        ("bending.angle_scale", cloth.bending.angle_scale, FINITE),
        ("bending.angle_dropoff", cloth.bending.angle_dropoff, SHARE),
        ("bending.yield_sine", cloth.bending.yield_sine, LIMIT),
        ("bending.yield_half_angle", cloth.bending.yield_half_angle, LIMIT),
        ("yield_strain", cloth.yield_strain, LIMIT),
        ("rigidity", cloth.rigidity, POSITIVE),
        ("deform_resistance", cloth.deform_resistance, POSITIVE),
        ("input_attract.strength", cloth.input_attract.strength, POSITIVE),
        ("input_attract.damp", cloth.input_attract.damp, POSITIVE),
        ("input_attract.motion_drag", cloth.input_attract.motion_drag, FINITE),
        ("conserve", cloth.conserve, FINITE),
        ("rotation_friction", cloth.rotation_friction, FINITE),
        ("rotation_damp", cloth.rotation_damp, FINITE),
        ("overlap_pruning", cloth.overlap_pruning, FINITE),
    ];
    rows.extend(vector("local_force", cloth.local_force));
    rows.extend(vector("local_wind", cloth.local_wind));
    let Stiffness { stretch, compression, shear, bend, warp, weft } = cloth.stiffness;
    let stiffnesses = [
        ("stiffness.stretch", stretch),
        ("stiffness.compression", compression),
        ("stiffness.shear", shear),
        ("stiffness.bend", bend),
        ("stiffness.warp", warp),
        ("stiffness.weft", weft),
    ];
    rows.extend(stiffnesses.into_iter().filter_map(|(name, given)| Some((name, given?, POSITIVE))));
    rows.extend(push_out_rows(&cloth.push_out));
    rows.extend(surface_field_rows(cloth.field.as_ref(), cloth.point_field.as_ref(), &cloth.wind_field));
    rows.extend(pressure_rows(&cloth.pressure));
    if let Some(Liquid { spacing, incompressibility, viscosity, surface_tension }) = cloth.liquid {
        rows.extend([
            ("liquid.spacing", spacing, range(MIN_SPACING, MAX_COORDINATE)),
            ("liquid.incompressibility", incompressibility, POSITIVE),
            ("liquid.viscosity", viscosity, POSITIVE),
            ("liquid.surface_tension", surface_tension, POSITIVE),
        ]);
    }
    rows
}

fn pressure_rows(pressure: &Pressure) -> Vec<Row> {
    match *pressure {
        Pressure::Off => Vec::new(),
        Pressure::Manual { pascals, damping } => {
            vec![("pressure.pascals", pascals, FINITE), ("pressure.damping", damping, POSITIVE)]
        }
        Pressure::Gas { start, bulk, pump, tightness, damping, .. } => vec![
            ("pressure.start", start, FINITE),
            ("pressure.bulk", bulk, POSITIVE),
            ("pressure.pump", pump, FINITE),
            ("pressure.tightness", tightness, SHARE),
            ("pressure.damping", damping, POSITIVE),
        ],
    }
}

fn collider_rows(collider: &ColliderFrame) -> Vec<Row> {
    let mut rows = vec![
        ("thickness", collider.thickness, POSITIVE),
        ("friction", collider.friction, POSITIVE),
        ("stickiness", collider.stickiness, STICKINESS),
        ("bounce", collider.bounce, SHARE),
        ("collide_strength", collider.collide_strength, POSITIVE),
        ("layer", collider.layer, FINITE),
    ];
    rows.extend(push_out_rows(&collider.push_out));
    let ColliderFrame { field, point_field, wind_field, .. } = collider;
    rows.extend(surface_field_rows(field.as_ref(), point_field.as_ref(), wind_field));
    rows
}

fn push_out_rows(push_out: &PushOut) -> [Row; 2] {
    [("push_out.share", push_out.share, SIGNED_SHARE), ("push_out.radius", push_out.radius, FINITE)]
}

fn surface_field_rows(force: Option<&ForceField>, point: Option<&PointField>, wind: &WindField) -> Vec<Row> {
    let mut rows = vec![
        ("wind_field.shadow_distance", wind.shadow_distance, FINITE),
        ("wind_field.shadow_diffusion", wind.shadow_diffusion, FINITE),
        ("wind_field.push_distance", wind.push_distance, FINITE),
        ("wind_field.push_vorticity", wind.push_vorticity, FINITE),
    ];
    if let Some(field) = force {
        rows.extend([
            ("field.magnitude", field.magnitude, FINITE),
            ("field.distance", field.distance, FINITE),
        ]);
        rows.extend(field.falloff.map(|x| ("field.falloff", x, FACTOR)));
    }
    if let Some(field) = point {
        rows.extend([
            ("point_field.magnitude", field.magnitude, FINITE),
            ("point_field.self_attract", field.self_attract, FINITE),
            ("point_field.radius", field.radius, FINITE),
            ("point_field.distance", field.distance, FINITE),
        ]);
        rows.extend(field.falloff.map(|x| ("point_field.falloff", x, FACTOR)));
    }
    rows
}

fn of_constraint(at: u32, constraint: &ConstraintFrame) -> Option<InvalidInput> {
    let links = constraint.formed.iter().flatten();
    first(InputSubject::Constraint(at), constraint_rows(constraint)).or_else(|| {
        (0..).zip(links).find_map(|(link, of)| first(InputSubject::Link(at, link), link_rows(of)))
    })
}

fn constraint_rows(constraint: &ConstraintFrame) -> Vec<Row> {
    let [[least, most], scales] = [constraint.iterations, constraint.rest_scale];
    let mut rows = vec![
        ("strength", constraint.strength, POSITIVE),
        ("tangent_strength", constraint.tangent_strength, POSITIVE),
        ("bend_strength", constraint.bend_strength, POSITIVE),
        ("rest_scale", scales[0], FACTOR),
        ("rest_scale", scales[1], FACTOR),
        ("break_half_sine", constraint.break_half_sine, SHARE),
        ("iterations", least, POSITIVE),
        ("iterations", most, POSITIVE),
        ("glue_strength", constraint.glue_strength, SHARE),
        ("glue_scale", constraint.glue_scale, POSITIVE),
        ("friction", constraint.friction, POSITIVE),
        ("damp", constraint.damp, POSITIVE),
        ("motion_drag", constraint.motion_drag, SHARE),
        ("keep_off", constraint.keep_off.unwrap_or_default(), FINITE),
    ];
    if let Some(force) = &constraint.force {
        rows.push(("force.acceleration", force.acceleration, FINITE));
        rows.push(("force.falloff.distance", force.falloff.distance, FINITE));
        rows.extend(force.falloff.samples.map(|x| ("force.falloff.samples", x, FACTOR)));
    }
    if let Some(dropoff) = &constraint.dropoff {
        rows.push(("dropoff.distance", dropoff.distance, FINITE));
        rows.extend(dropoff.samples.map(|x| ("dropoff.samples", x, range(0.0, MAX_FACTOR))));
    }
    for (linear, offset) in &constraint.space {
        rows.extend(linear.iter().map(|x| ("space", *x, FACTOR)));
        rows.extend(vector("space", *offset));
    }
    rows
}

fn link_rows(link: &Link) -> Vec<Row> {
    let mut rows = vec![
        ("rest", link.rest, FINITE),
        ("strength", link.strength, SHARE),
        ("tangent_strength", link.tangent_strength, POSITIVE),
        ("glue", link.glue, POSITIVE),
        ("weight", link.weight[0], POSITIVE),
        ("weight", link.weight[1], POSITIVE),
        ("length", link.length, POSITIVE),
    ];
    // The weights of a fold are those of a hinge, which add up to 0.
    let is_place = !matches!(link.kind, LinkKind::Fold(_));
    for side in &link.sides {
        match side {
            LinkSide::Cloth { weights, .. } | LinkSide::Collider { weights, .. } => {
                rows.extend(weights.map(|x| ("weights", x, FINITE)));
                let one = range(1.0 - MAX_WEIGHT_ERROR, 1.0 + MAX_WEIGHT_ERROR);
                rows.extend(is_place.then(|| ("sum of weights", weights.iter().sum(), one)));
            }
            LinkSide::Space(place) => rows.extend(vector("place", *place)),
        }
    }
    rows
}

fn field_rows(field: &Field) -> Vec<Row> {
    let noise = |noise: &Noise| -> Vec<Row> {
        let rows = vector("noise.frequency", noise.frequency).into_iter();
        rows.chain(vector("noise.phase", noise.phase)).chain([("noise.ratio", noise.ratio, FINITE)]).collect()
    };
    let mut rows = match &field.kind {
        FieldKind::Gravity { acceleration } => vector("acceleration", *acceleration).to_vec(),
        FieldKind::Uniform { force } => vector("force", *force).to_vec(),
        FieldKind::Radial { force } => vec![("force", *force, FINITE)],
        FieldKind::Newton { magnitude, min_distance } => {
            vec![("magnitude", *magnitude, FINITE), ("min_distance", *min_distance, FINITE)]
        }
        FieldKind::Drag { magnitude, along, velocity, half_speed } => {
            let mut rows = vec![("magnitude", *magnitude, FINITE), ("half_speed", *half_speed, FINITE)];
            rows.extend(along.iter().flat_map(|along| vector("along", *along)));
            rows.extend(vector("velocity", *velocity));
            rows
        }
        FieldKind::Air { velocity, rate, spread, .. } => {
            let mut rows = vec![("rate", *rate, FINITE), ("spread", spread.unwrap_or_default(), FINITE)];
            rows.extend(vector("velocity", *velocity));
            rows
        }
        FieldKind::Turbulence { force, noise: of } => [vec![("force", *force, FINITE)], noise(of)].concat(),
        FieldKind::Vortex { force, axis } => {
            [vec![("force", *force, FINITE)], vector("axis", *axis).to_vec()].concat()
        }
        FieldKind::VolumeAxis(axis) => {
            let mut rows = noise(&axis.noise);
            rows.extend([
                ("from_center", axis.from_center, FINITE),
                ("from_axis", axis.from_axis, FINITE),
                ("along_axis", axis.along_axis, FINITE),
                ("around_axis", axis.around_axis, FINITE),
                ("turbulence", axis.turbulence, FINITE),
            ]);
            rows.extend(vector("directional", axis.directional));
            rows.extend(vector("axis", axis.axis));
            rows
        }
    };
    let reach = &field.reach;
    rows.extend(vector("reach.center", reach.center));
    rows.extend([
        ("reach.attenuation", reach.attenuation, FINITE),
        ("reach.max_distance", reach.max_distance, LIMIT),
        ("reach.unit", reach.unit, InputRange { is_above: true, ..POSITIVE }),
    ]);
    rows.extend(reach.falloff.iter().map(|x| ("reach.falloff", *x, FACTOR)));
    rows.extend(field.targets.iter().map(|(_, share)| ("targets", *share, FACTOR)));
    rows
}

fn of_births(births: &[Birth]) -> Option<InvalidInput> {
    let numbers = (0..).zip(births).find_map(|(at, birth)| {
        let mut rows = vec![("time", birth.time, SHARE), ("lifespan", birth.lifespan, NOT_NAN)];
        rows.extend(vector("position", birth.position));
        rows.extend(vector("velocity", birth.velocity));
        first(InputSubject::Birth(at), rows)
    });
    let is_early = |pair: &[Birth]| pair[1].time < pair[0].time;
    numbers.or_else(|| {
        let at = births.windows(2).position(is_early)? + 1;
        Some(InvalidInput::BirthOrder {
            birth: at as u32,
            time: InputNumber(births[at].time),
            before: InputNumber(births[at - 1].time),
        })
    })
}
