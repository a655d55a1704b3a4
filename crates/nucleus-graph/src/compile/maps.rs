//! Maps: attributes that differ from point to point.
//!
//! A map multiplies its attribute. Its type says where its factors come from: per vertex from `...PerVertex`, texture from
//! `...Map`. A type that is not given is that of what is given. A map without values, or without a texture, is none. The stretch map holds for
//! compression too, unless there is a compression map. A map that is the same everywhere is the attribute with
//! another value, to the bit, and costs what that costs.

use nucleus_core::VertexMaps;

use crate::attributes::{Choice, Key, n_base, n_cloth};
use crate::graph::NodeId;

use super::column::Column;
use super::objects::Compiler;

/// The attributes that give one map.
pub(super) struct Map {
    /// A value for each point.
    pub(super) values: &'static Key<Vec<f64>>,
    /// A texture.
    pub(super) texture: &'static Key<f64>,
    /// Which of the two counts.
    pub(super) kind: &'static Key<Choice>,
}

macro_rules! maps {
    ($($name:ident: $module:ident :: $values:ident, $texture:ident, $kind:ident;)+) => {
        $(static $name: Map = Map {
            values: &$module::$values,
            texture: &$module::$texture,
            kind: &$module::$kind,
        };)+
    };
}

maps! {
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

/// Factors on the attributes of a cloth that are the same for all of its points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scales {
    pub(super) mass: f64,
    pub(super) damp: f64,
    pub(super) stretch: f64,
    pub(super) compression: f64,
    pub(super) bend: f64,
    pub(super) rest_length: f64,
    pub(super) drag: f64,
    pub(super) tangential_drag: f64,
    pub(super) lift: f64,
    pub(super) thickness: f64,
    pub(super) friction: f64,
    pub(super) stickiness: f64,
    pub(super) bounce: f64,
    pub(super) collide_strength: f64,
}

/// What the maps of a cloth come to.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Maps {
    pub(super) scales: Scales,
    pub(super) factors: VertexMaps,
}

/// One map: a factor for all, and factors for each where they differ.
#[derive(Debug, Clone, PartialEq)]
struct Varied {
    scale: f64,
    factors: Vec<f64>,
}

impl Scales {
    /// No map at all.
    pub(super) const NONE: Self = Self {
        mass: 1.0,
        damp: 1.0,
        stretch: 1.0,
        compression: 1.0,
        bend: 1.0,
        rest_length: 1.0,
        drag: 1.0,
        tangential_drag: 1.0,
        lift: 1.0,
        thickness: 1.0,
        friction: 1.0,
        stickiness: 1.0,
        bounce: 1.0,
        collide_strength: 1.0,
    };
}

impl Varied {
    const NONE: Self = Self { scale: 1.0, factors: Vec::new() };

    /// Factors as they are, unless they are all the same.
    fn of(factors: Option<Vec<f64>>) -> Self {
        let Some(factors) = factors else { return Self::NONE };
        match factors.first() {
            Some(&first) if factors.iter().all(|factor| *factor == first) => {
                Self { scale: first, factors: Vec::new() }
            }
            _ => Self { scale: 1.0, factors },
        }
    }

    /// Factors as shares of the largest: what the solver takes for resistances.
    fn of_shares(factors: Option<Vec<f64>>) -> Self {
        let Self { scale, mut factors } = Self::of(factors);
        let most = factors.iter().copied().fold(0.0, f64::max);
        if factors.is_empty() {
            return Self { scale, factors };
        }
        factors.iter_mut().for_each(|factor| *factor /= most);
        Self { scale: most, factors }
    }
}

impl Compiler<'_> {
    /// All maps of a cloth; nothing if one of them is wrong, which has been said then.
    pub(super) fn maps(&mut self, cloth: NodeId, mesh: NodeId, points: usize) -> Option<Maps> {
        let before = self.findings.errors();
        let mut read = |map| self.column(&Column { cloth, mesh, points, map });
        let stretch = read(&STRETCH);
        let compression = read(&COMPRESSION).or_else(|| stretch.clone());
        let [mass, damp] = [&MASS, &DAMP].map(|map| Varied::of(read(map)));
        let [rest_length, drag] = [&REST_LENGTH, &DRAG].map(|map| Varied::of(read(map)));
        let [tangential_drag, lift] = [&TANGENTIAL_DRAG, &LIFT].map(|map| Varied::of(read(map)));
        let [thickness, friction] = [&THICKNESS, &FRICTION].map(|map| Varied::of(read(map)));
        let [stickiness, bounce] = [&STICKINESS, &BOUNCE].map(|map| Varied::of(read(map)));
        let collide_strength = Varied::of(read(&COLLIDE_STRENGTH));
        let [stretch, compression, bend] = [stretch, compression, read(&BEND)].map(Varied::of_shares);
        self.check_mass(cloth, &mass);
        if self.findings.errors() > before {
            return None;
        }
        let scales = Scales {
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
        };
        let factors = VertexMaps {
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
        };
        Some(Maps { scales, factors })
    }

    /// Every point has to weigh something.
    fn check_mass(&mut self, cloth: NodeId, mass: &Varied) {
        const LEAST: f64 = 1e-6;
        let light = |factor: &f64| *factor < LEAST;
        let point = if light(&mass.scale) { Some(0) } else { mass.factors.iter().position(light) };
        if let Some(point) = point {
            let name = self.scene.graph.node(cloth).name();
            let place = self.scene.source.place(&format!("{name}.{}", self.source_of(cloth, &MASS)));
            let message = format!("the mass map of `{name}` makes point {point} weigh nothing");
            self.findings
                .error(&place, message)
                .help("its factors have to be above 0; hold a point by a constraint");
        }
    }
}
