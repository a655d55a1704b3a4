//! Force fields: from the nodes to the fields of a frame.
//!
//! A field acts on the objects that it is connected to. Lengths, speeds and accelerations of fields are in scene units, as
//! in Maya's classic dynamics; forces are kilograms times scene units per second squared.

use nalgebra::{Matrix3, Vector3};
use nucleus_core::{ClothId, Field, FieldKind, Noise, Reach, Volume, VolumeAxis, VolumeShape};

use crate::animation::{Affine, sin_cos_degrees};
use crate::attributes::{
    Choice, Key, NodeType, Ramp, air_field, drag_field, field, gravity_field, newton_field, particle,
    radial_field, turbulence_field, uniform_field, volume_axis_field, vortex_field,
};
use crate::graph::{EvalContext, NodeId};

use super::compiler::Compiler;
use super::program::EvaluationInterval;
use super::sources::FieldSource;

impl Compiler<'_> {
    /// The fields connected to the objects of the nucleus, in the order of objects and connections.
    pub(super) fn fields(&mut self) -> Vec<FieldSource> {
        let graph = &self.scene.graph;
        let mut fields: Vec<FieldSource> = Vec::new();
        for (cloth, source) in (0..).map(ClothId).zip(&self.program.cloths) {
            let wires = graph.elements(source.node, &particle::INPUT_FORCE).into_iter();
            let is_field = |id: &NodeId| graph.node(*id).node_type().is_a(&field::FIELD);
            for node in wires.map(|(_, plug)| plug.node).filter(is_field) {
                if self.broken.contains(&node) {
                    continue;
                }
                match fields.iter_mut().find(|field| field.node == node) {
                    Some(field) => field.targets.push((cloth, source.node)),
                    None => fields.push(FieldSource { node, targets: vec![(cloth, source.node)] }),
                }
            }
        }
        fields
    }
}

impl EvaluationInterval<'_> {
    /// The fields of the interval, of `seconds` of solver time.
    pub(super) fn fields(&self, seconds: f64) -> Vec<Field> {
        self.nucleus.fields.iter().map(|source| self.field(source, seconds)).collect()
    }

    fn field(&self, source: &FieldSource, seconds: f64) -> Field {
        let placements = [&self.from, &self.to].map(|moment| moment.placement(source.node));
        let time = self.to.frame() / self.fps;
        let node = FieldNode { id: source.node, to: &self.to, time, placement: placements[1] };
        let travel = placements[1].offset - placements[0].offset;
        let metre = self.nucleus.units.length(1.0);
        // In Maya the weight of objects other than particles is 1.
        let weight = |node: NodeId| match self.graph.node(node).node_type() {
            of if of.has_no_use_for(&particle::DYNAMICS_WEIGHT.row) => 1.0,
            _ => self.to.get(node, &particle::DYNAMICS_WEIGHT),
        };
        Field {
            kind: node.kind(self.graph.node(source.node).node_type(), travel / seconds, metre),
            reach: node.reach(self.graph.node(source.node).node_type(), metre),
            targets: source.targets.iter().map(|&(cloth, node)| (cloth, weight(node))).collect(),
        }
    }
}

/// A field node at the end of an interval.
struct FieldNode<'a> {
    id: NodeId,
    to: &'a EvalContext<'a>,
    /// The time in seconds.
    time: f64,
    placement: Affine,
}

impl FieldNode<'_> {
    fn number(&self, key: &Key<f64>) -> f64 {
        self.to.get(self.id, key)
    }

    fn vector(&self, key: &Key<[f64; 3]>) -> Vector3<f64> {
        Vector3::from(self.to.get(self.id, key))
    }

    fn direction(&self, key: &Key<[f64; 3]>) -> Vector3<f64> {
        unit(self.vector(key))
    }

    /// The effect of the field; `velocity` is that of its node in scene units per second, `metre` a scene unit in
    /// metres.
    fn kind(&self, node_type: &'static NodeType, velocity: Vector3<f64>, metre: f64) -> FieldKind {
        let force = self.number(&field::MAGNITUDE) * metre;
        let is = |other: &'static NodeType| node_type.is_a(other);
        if is(&gravity_field::GRAVITY_FIELD) {
            let magnitude = self.number(&gravity_field::MAGNITUDE) * metre;
            FieldKind::Gravity { acceleration: self.direction(&gravity_field::DIRECTION) * magnitude }
        } else if is(&uniform_field::UNIFORM_FIELD) {
            FieldKind::Uniform { force: self.direction(&uniform_field::DIRECTION) * force }
        } else if is(&radial_field::RADIAL_FIELD) {
            FieldKind::Radial { force }
        } else if is(&newton_field::NEWTON_FIELD) {
            let min_distance = self.number(&newton_field::MIN_DISTANCE).max(0.0) * metre;
            FieldKind::Newton { magnitude: force, min_distance }
        } else if is(&drag_field::DRAG_FIELD) {
            let along = self.to.get(self.id, &drag_field::USE_DIRECTION);
            // Maya documents which way these act, and no law: here half of the drag is left at a speed of this value.
            let half = self.number(&drag_field::MOTION_ATTENUATION);
            let moving = if half > 0.0 { velocity.norm() / (velocity.norm() + half) } else { 1.0 };
            FieldKind::Drag {
                magnitude: self.number(&field::MAGNITUDE) * moving,
                along: along.then(|| self.direction(&drag_field::DIRECTION)),
                velocity: velocity * self.number(&drag_field::INHERIT_VELOCITY) * metre,
                half_speed: self.number(&drag_field::SPEED_ATTENUATION).max(0.0) * metre,
            }
        } else if is(&air_field::AIR_FIELD) {
            self.air(velocity, metre)
        } else if is(&turbulence_field::TURBULENCE_FIELD) {
            self.turbulence(force, metre)
        } else if is(&vortex_field::VORTEX_FIELD) {
            FieldKind::Vortex { force, axis: self.direction(&vortex_field::AXIS) }
        } else {
            FieldKind::VolumeAxis(self.volume_axis(metre))
        }
    }

    fn air(&self, velocity: Vector3<f64>, metre: f64) -> FieldKind {
        let own = self.direction(&air_field::DIRECTION);
        let turns = self.to.get(self.id, &air_field::INHERIT_ROTATION);
        let direction = if turns { unit(self.placement.linear * own) } else { own };
        let inherited = velocity * self.number(&air_field::INHERIT_VELOCITY);
        let spreads = self.to.get(self.id, &air_field::ENABLE_SPREAD);
        let half_angle = 90.0 * self.number(&air_field::SPREAD).clamp(0.0, 1.0);
        FieldKind::Air {
            velocity: (direction * self.number(&field::MAGNITUDE) + inherited) * metre,
            rate: self.number(&air_field::SPEED).max(0.0),
            component_only: self.to.get(self.id, &air_field::COMPONENT_ONLY),
            spread: spreads.then(|| sin_cos_degrees(half_angle).1),
        }
    }

    fn turbulence(&self, force: f64, metre: f64) -> FieldKind {
        let phase = [&turbulence_field::PHASE_X, &turbulence_field::PHASE_Y, &turbulence_field::PHASE_Z];
        let noise = Noise {
            frequency: Vector3::repeat(self.number(&turbulence_field::FREQUENCY) / metre),
            phase: Vector3::from(phase.map(|key| self.number(key))),
            octaves: self.to.get(self.id, &turbulence_field::NOISE_LEVEL).clamp(0, 64) as u32,
            ratio: self.number(&turbulence_field::NOISE_RATIO),
        };
        FieldKind::Turbulence { force, noise }
    }

    fn volume_axis(&self, metre: f64) -> VolumeAxis {
        let scale = self.number(&field::MAGNITUDE) * metre;
        let force = |key: &Key<f64>| self.number(key) * scale;
        let turned = |v: Vector3<f64>| unit(self.placement.linear * v);
        // Detail is a second octave of the noise.
        let detail = self.number(&volume_axis_field::DETAIL_TURBULENCE);
        let time = self.number(&volume_axis_field::TURBULENCE_SPEED) * self.time;
        let away = away_from(self.to.get(self.id, &field::VOLUME_SHAPE));
        VolumeAxis {
            from_center: if away.center { force(&volume_axis_field::AWAY_FROM_CENTER) } else { 0.0 },
            from_axis: if away.axis { force(&volume_axis_field::AWAY_FROM_AXIS) } else { 0.0 },
            along_axis: force(&volume_axis_field::ALONG_AXIS),
            around_axis: force(&volume_axis_field::AROUND_AXIS),
            directional: self.direction(&volume_axis_field::DIRECTION)
                * force(&volume_axis_field::DIRECTIONAL_SPEED),
            axis: turned(Vector3::y()),
            turbulence: force(&volume_axis_field::TURBULENCE),
            noise: Noise {
                frequency: self.vector(&volume_axis_field::TURBULENCE_FREQUENCY) / metre,
                phase: self.vector(&volume_axis_field::TURBULENCE_OFFSET) + Vector3::new(0.0, time, 0.0),
                octaves: u32::from(detail != 0.0),
                ratio: detail,
            },
        }
    }

    fn reach(&self, node_type: &'static NodeType, metre: f64) -> Reach {
        let bounded = self.to.get(self.id, &field::USE_MAX_DISTANCE);
        let distance = self.number(&field::MAX_DISTANCE).max(0.0) * metre;
        let curve = self.to.get(self.id, &field::FALLOFF_CURVE);
        let curve =
            Some(curve).filter(|points| bounded && !points.is_empty()).map(|points| Ramp::new(&points));
        let is_radial = node_type.is_a(&radial_field::RADIAL_FIELD);
        // A radial field of type 0 fades out towards its largest distance, one of type 1 stops there.
        let fading = match is_radial && bounded {
            true => 1.0 - self.number(&radial_field::RADIAL_TYPE).clamp(0.0, 1.0),
            false => 0.0,
        };
        let attenuation = self.number(&field::ATTENUATION).max(0.0);
        let is_axis = node_type.is_a(&volume_axis_field::VOLUME_AXIS_FIELD);
        // An inverted field is strongest at its largest distance: its falloff is a part of the curve.
        let volume = self.volume(metre);
        let ends = bounded || is_axis && volume.is_some();
        let is_inverted = is_axis && ends && self.to.get(self.id, &volume_axis_field::INVERT_ATTENUATION);
        let at = |k: usize| {
            let share = k as f64 / (Reach::SAMPLES - 1) as f64;
            let faded = if is_inverted { share.powf(attenuation) } else { 1.0 - fading * share };
            curve.as_ref().map_or(faded, |curve| faded * curve.value_at(share))
        };
        Reach {
            center: self.placement.offset * metre,
            unit: metre,
            attenuation: if is_inverted { 0.0 } else { attenuation },
            max_distance: if bounded { distance } else { f64::INFINITY },
            falloff: std::array::from_fn(at),
            volume,
            falls_off_in_volume: is_axis,
        }
    }

    fn volume(&self, metre: f64) -> Option<Volume> {
        let shape = match self.to.get(self.id, &field::VOLUME_SHAPE) {
            Choice(1) => VolumeShape::Cube,
            Choice(2) => VolumeShape::Sphere,
            Choice(3) => VolumeShape::Cylinder,
            Choice(4) => VolumeShape::Cone,
            Choice(5) => VolumeShape::Torus,
            _ => return None,
        };
        let sweep = self.number(&field::VOLUME_SWEEP);
        let end: [f64; 2] = sin_cos_degrees(sweep.max(0.0)).into();
        Some(Volume {
            shape,
            // A volume scaled to nothing contains nothing.
            to_local: self.placement.linear.try_inverse().unwrap_or(Matrix3::repeat(1e9)) / metre,
            offset: self.vector(&field::VOLUME_OFFSET),
            section: self.number(&field::SECTION_RADIUS),
            sweep: (sweep < 360.0).then_some(end),
            is_excluded: self.to.get(self.id, &field::VOLUME_EXCLUSION),
        })
    }
}

/// Which of the two speeds away from the middle of a volume axis field act.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct AwayFrom {
    /// `awayFromCenter`.
    pub(super) center: bool,
    /// `awayFromAxis`.
    pub(super) axis: bool,
}

/// Those of a `volumeShape`: cubes and spheres have no axis, and cylinders, cones and tori no centre.
pub(super) fn away_from(shape: Choice) -> AwayFrom {
    AwayFrom { center: matches!(shape, Choice(0..=2)), axis: !matches!(shape, Choice(1 | 2)) }
}

/// The vector of unit length, or zero for the zero vector.
pub(super) fn unit(vector: Vector3<f64>) -> Vector3<f64> {
    vector.try_normalize(0.0).unwrap_or_default()
}
