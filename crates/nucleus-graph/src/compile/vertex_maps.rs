//! Vertex maps: factors per point on the attributes of a cloth.
//!
//! The `...MapType` selects the source of the factors: `perVertex` reads `...PerVertex`, `texture` reads `...Map`. Where the
//! type is not given, it follows from the source that is. A map without values, or without a texture, has no effect. The
//! stretch map also applies to compression unless there is a compression map. A uniform map scales the attribute: it gives
//! the same bits at the same cost as the scaled value.

use nucleus_core::VertexMaps;

use crate::attributes::{n_base, n_cloth};
use crate::graph::NodeId;

use super::compiler::Compiler;
use super::map_values::{MapAttributes, MapOfCloth};
use super::sources::MapScales;

macro_rules! maps {
    ($($name:ident: $module:ident :: $values:ident, $texture:ident, $kind:ident;)+) => {
        $(pub(super) static $name: MapAttributes = MapAttributes {
            values: &$module::$values,
            texture: &$module::$texture,
            kind: &$module::$kind,
        };)+
    };
}

maps! {
    INPUT_ATTRACT: n_cloth::INPUT_ATTRACT_PER_VERTEX, INPUT_ATTRACT_MAP, INPUT_ATTRACT_MAP_TYPE;
    RIGIDITY: n_cloth::RIGIDITY_PER_VERTEX, RIGIDITY_MAP, RIGIDITY_MAP_TYPE;
    DEFORM: n_cloth::DEFORM_PER_VERTEX, DEFORM_MAP, DEFORM_MAP_TYPE;
    ANGLE_DROPOFF: n_cloth::BEND_ANGLE_DROPOFF_PER_VERTEX, BEND_ANGLE_DROPOFF_MAP, BEND_ANGLE_DROPOFF_MAP_TYPE;
    RESTITUTION_ANGLE: n_cloth::RESTITUTION_ANGLE_PER_VERTEX, RESTITUTION_ANGLE_MAP, RESTITUTION_ANGLE_MAP_TYPE;
    FIELD_MAGNITUDE: n_base::FIELD_MAGNITUDE_PER_VERTEX, FIELD_MAGNITUDE_MAP, FIELD_MAGNITUDE_MAP_TYPE;
    WEAVE_ANGLE: n_cloth::WEAVE_ANGLE_PER_VERTEX, WEAVE_ANGLE_MAP, WEAVE_ANGLE_MAP_TYPE;
    WRINKLE: n_cloth::WRINKLE_PER_VERTEX, WRINKLE_MAP, WRINKLE_MAP_TYPE;
    MASS: n_base::MASS_PER_VERTEX, MASS_MAP, MASS_MAP_TYPE;
    DAMP: n_base::DAMP_PER_VERTEX, DAMP_MAP, DAMP_MAP_TYPE;
    STRETCH: n_cloth::STRETCH_PER_VERTEX, STRETCH_MAP, STRETCH_MAP_TYPE;
    COMPRESSION: n_cloth::COMPRESSION_PER_VERTEX, COMPRESSION_MAP, COMPRESSION_MAP_TYPE;
    BEND: n_cloth::BEND_PER_VERTEX, BEND_MAP, BEND_MAP_TYPE;
    REST_LENGTH: n_cloth::REST_LENGTH_SCALE_PER_VERTEX, REST_LENGTH_SCALE_MAP, REST_LENGTH_SCALE_MAP_TYPE;
    DRAG: n_cloth::DRAG_PER_VERTEX, DRAG_MAP, DRAG_MAP_TYPE;
    TANGENTIAL_DRAG: n_cloth::TANGENTIAL_DRAG_PER_VERTEX, TANGENTIAL_DRAG_MAP, TANGENTIAL_DRAG_MAP_TYPE;
    LIFT: n_cloth::LIFT_PER_VERTEX, LIFT_MAP, LIFT_MAP_TYPE;
    THICKNESS: n_base::THICKNESS_PER_VERTEX, THICKNESS_MAP, THICKNESS_MAP_TYPE;
    FRICTION: n_base::FRICTION_PER_VERTEX, FRICTION_MAP, FRICTION_MAP_TYPE;
    STICKINESS: n_base::STICKINESS_PER_VERTEX, STICKINESS_MAP, STICKINESS_MAP_TYPE;
    BOUNCE: n_base::BOUNCE_PER_VERTEX, BOUNCE_MAP, BOUNCE_MAP_TYPE;
    COLLIDE_STRENGTH: n_base::COLLIDE_STRENGTH_PER_VERTEX, COLLIDE_STRENGTH_MAP, COLLIDE_STRENGTH_MAP_TYPE;
}

/// The vertex maps of a cloth: factors for all points, and factors per point where they differ.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CompiledMaps {
    pub(super) scales: MapScales,
    pub(super) vertex_maps: VertexMaps,
}

/// One map: a factor for all points, and factors per point where they differ.
#[derive(Debug, Clone, PartialEq)]
struct SplitMap {
    scale: f64,
    factors: Vec<f64>,
}

impl SplitMap {
    const ONE: Self = Self { scale: 1.0, factors: Vec::new() };

    /// Splits off the factor if the map is uniform.
    fn new(factors: Option<Vec<f64>>) -> Self {
        let Some(factors) = factors else { return Self::ONE };
        match factors.first() {
            Some(&first) if factors.iter().all(|factor| *factor == first) => {
                Self { scale: first, factors: Vec::new() }
            }
            _ => Self { scale: 1.0, factors },
        }
    }

    /// Splits off the maximum, as the solver requires for resistances: the factors per point are at most 1.
    fn normalized(factors: Option<Vec<f64>>) -> Self {
        let Self { scale, mut factors } = Self::new(factors);
        let max = factors.iter().copied().fold(0.0, f64::max);
        if factors.is_empty() {
            return Self { scale, factors };
        }
        factors.iter_mut().for_each(|factor| *factor /= max);
        Self { scale: max, factors }
    }
}

impl Compiler<'_> {
    /// All vertex maps of a cloth; `None` after an error, which is reported.
    pub(super) fn vertex_maps(&mut self, cloth: NodeId, mesh: NodeId, points: usize) -> Option<CompiledMaps> {
        let before = self.findings.errors();
        let mut read = |map| self.map_values(&MapOfCloth { cloth, mesh, points, map });
        let stretch = read(&STRETCH);
        let compression = read(&COMPRESSION).or_else(|| stretch.clone());
        let [mass, damp] = [&MASS, &DAMP].map(|map| SplitMap::new(read(map)));
        let [rest_length, drag] = [&REST_LENGTH, &DRAG].map(|map| SplitMap::new(read(map)));
        let [tangential_drag, lift] = [&TANGENTIAL_DRAG, &LIFT].map(|map| SplitMap::new(read(map)));
        let [thickness, friction] = [&THICKNESS, &FRICTION].map(|map| SplitMap::new(read(map)));
        let [stickiness, bounce] = [&STICKINESS, &BOUNCE].map(|map| SplitMap::new(read(map)));
        let [collide_strength, input_attract] =
            [&COLLIDE_STRENGTH, &INPUT_ATTRACT].map(|map| SplitMap::new(read(map)));
        let [angle_dropoff, restitution_angle, field_magnitude] =
            [&ANGLE_DROPOFF, &RESTITUTION_ANGLE, &FIELD_MAGNITUDE].map(|map| SplitMap::new(read(map)));
        let [rigidity, deform] = [&RIGIDITY, &DEFORM].map(|map| SplitMap::normalized(read(map)));
        let [stretch, compression, bend] = [stretch, compression, read(&BEND)].map(SplitMap::normalized);
        self.check_mass(cloth, &mass);
        if self.findings.errors() > before {
            return None;
        }
        let scales = MapScales {
            mass: mass.scale,
            damp: damp.scale,
            stretch: stretch.scale,
            compression: compression.scale,
            bend: bend.scale,
            rest_length: rest_length.scale,
            drag: drag.scale,
            tangential_drag: tangential_drag.scale,
            lift: lift.scale,
            thickness: thickness.scale,
            friction: friction.scale,
            stickiness: stickiness.scale,
            bounce: bounce.scale,
            collide_strength: collide_strength.scale,
            input_attract: input_attract.scale,
            rigidity: rigidity.scale,
            deform: deform.scale,
            angle_dropoff: angle_dropoff.scale,
            restitution_angle: restitution_angle.scale,
            field_magnitude: field_magnitude.scale,
        };
        let vertex_maps = VertexMaps {
            mass: mass.factors,
            stretch: stretch.factors,
            compression: compression.factors,
            bend: bend.factors,
            rest_length: rest_length.factors,
            damp: damp.factors,
            drag: drag.factors,
            tangential_drag: tangential_drag.factors,
            lift: lift.factors,
            thickness: thickness.factors,
            friction: friction.factors,
            stickiness: stickiness.factors,
            bounce: bounce.factors,
            collide_strength: collide_strength.factors,
            input_attract: input_attract.factors,
            rigidity: rigidity.factors,
            deform: deform.factors,
            angle_dropoff: angle_dropoff.factors,
            yield_angle: restitution_angle.factors,
            field_magnitude: field_magnitude.factors,
        };
        Some(CompiledMaps { scales, vertex_maps })
    }

    /// The vertex maps of a collider: of its contact attributes and its force field; `None` after an error, which is
    /// reported.
    pub(super) fn collider_maps(
        &mut self,
        collider: NodeId,
        mesh: NodeId,
        points: usize,
    ) -> Option<VertexMaps> {
        let before = self.findings.errors();
        let mut read =
            |map| self.map_values(&MapOfCloth { cloth: collider, mesh, points, map }).unwrap_or_default();
        let maps = VertexMaps {
            thickness: read(&THICKNESS),
            friction: read(&FRICTION),
            stickiness: read(&STICKINESS),
            bounce: read(&BOUNCE),
            collide_strength: read(&COLLIDE_STRENGTH),
            field_magnitude: read(&FIELD_MAGNITUDE),
            ..VertexMaps::default()
        };
        (self.findings.errors() == before).then_some(maps)
    }

    /// Reports points whose mass is zero, or too small to divide by.
    fn check_mass(&mut self, cloth: NodeId, mass: &SplitMap) {
        const MIN_FACTOR: f64 = 1e-6;
        let light = |factor: &f64| *factor < MIN_FACTOR;
        let point = if light(&mass.scale) { Some(0) } else { mass.factors.iter().position(light) };
        if let Some(point) = point {
            let name = self.scene.graph.node(cloth).name();
            let place = self.scene.source.place(&format!("{name}.{}", self.source_attribute(cloth, &MASS)));
            let message = format!("the mass map of `{name}` makes point {point} weigh nothing");
            self.findings
                .error(&place, message)
                .help("its factors have to be above 0; hold a point by a constraint");
        }
    }
}
