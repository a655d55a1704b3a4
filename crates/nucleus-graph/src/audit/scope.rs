//! Scope of an audit in a frame: the pairs of objects that the solver keeps apart, and the ground planes.

use std::sync::Arc;

use nucleus_audit::{CollisionFilter, CollisionMesh, Plane};
use nucleus_core::{
    ClothFrame, ClothId, ColliderId, ExcludedSide, Exclusion, FrameInput, Link, LinkMethod, MAX_EXCLUSIONS,
    Pin, PointId,
};

use crate::attributes::{n_base, nucleus};
use crate::compile::{NucleusProgram, Object, ObjectKind, Program, self_collides};
use crate::graph::{EvalContext, NodeId};

/// The ground planes of all nuclei.
#[derive(Debug, Default)]
pub(crate) struct GroundPlanes {
    nuclei: Vec<NucleusPlane>,
}

/// The ground plane of one nucleus, from its solver's input.
#[derive(Debug, Default)]
struct NucleusPlane {
    /// At the start and the end of a span of the frame.
    planes: Option<[Plane; 2]>,
    /// Start and end of the span, as shares of the frame.
    span: [f64; 2],
    first_cloth: u32,
    /// Whether each cloth collides with the plane.
    collides: Vec<bool>,
}

impl GroundPlanes {
    /// Begins a frame: each plane is where the last frame left it.
    pub(crate) fn begin_frame(&mut self) {
        for planes in self.nuclei.iter_mut().filter_map(|nucleus| nucleus.planes.as_mut()) {
            planes[0] = planes[1];
        }
    }

    /// A nucleus returns to its initial state: its plane has no earlier position.
    pub(crate) fn reset(&mut self, nucleus: usize) {
        self.nucleus(nucleus).planes = None;
    }

    /// Takes the plane of a nucleus from the solver's input for a span of the frame. A plane without a start or an earlier
    /// position does not move in the span.
    pub(crate) fn begin_span(
        &mut self,
        nucleus: usize,
        first_cloth: u32,
        input: &FrameInput,
        span: [f64; 2],
    ) {
        let nucleus = self.nucleus(nucleus);
        let end = input.plane.as_ref().and_then(|plane| Plane::new(plane.origin, plane.normal));
        let given = input.plane.and_then(|plane| plane.start);
        let given = given.and_then(|[origin, normal]| Plane::new(origin, normal));
        let start = given.or(nucleus.planes.map(|[_, end]| end));
        let collides = |cloth: &ClothFrame| cloth.collide && cloth.collide_strength > 0.0;
        nucleus.planes = end.map(|end| [start.unwrap_or(end), end]);
        nucleus.collides = input.cloths.iter().map(collides).collect();
        (nucleus.first_cloth, nucleus.span) = (first_cloth, span);
    }

    /// The plane that a cloth collides with, at the start of the span and at a share of the frame.
    pub(crate) fn of(&self, cloth: ClothId, share: f64) -> Option<[Plane; 2]> {
        let collides = |nucleus: &NucleusPlane| {
            let own = cloth.0.checked_sub(nucleus.first_cloth);
            own.and_then(|own| nucleus.collides.get(own as usize)).copied()
        };
        let nucleus = self.nuclei.iter().find(|nucleus| collides(nucleus).is_some())?;
        let [start, end] = nucleus.planes.filter(|_| collides(nucleus) == Some(true))?;
        let [from, to] = nucleus.span;
        let progress = if to > from { ((share - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 };
        Some([start, start.towards(&end, progress)])
    }

    fn nucleus(&mut self, index: usize) -> &mut NucleusPlane {
        if self.nuclei.len() <= index {
            self.nuclei.resize_with(index + 1, NucleusPlane::default);
        }
        &mut self.nuclei[index]
    }
}

/// What the input of a frame says about pairs that cannot collide, by the ids of the program.
#[derive(Debug, Default)]
pub(crate) struct AuditScope {
    /// Points whose motion is prescribed.
    pub(crate) pins: Vec<Pin>,
    /// Points that are welded to each other.
    pub(crate) welds: Vec<[(ClothId, PointId); 2]>,
    /// Points of objects whose `collideStrength` is below 1: the solver lets their elements pass through others.
    pub(crate) permeable: Vec<(ObjectKind, PermeablePoints)>,
    /// What does not collide.
    pub(crate) exclusions: Vec<Exclusion>,
}

impl AuditScope {
    /// Adds what the input of a nucleus says. `kept` gives the welds of a constraint that is not formed anew.
    pub(crate) fn add(
        &mut self,
        nucleus: &NucleusProgram,
        input: FrameInput,
        kept: impl Fn(usize) -> Vec<[(ClothId, PointId); 2]>,
    ) {
        let cloth = |own: ClothId| ClothId(nucleus.cloths().start + own.0);
        let collider = |own: ColliderId| ColliderId(nucleus.colliders().start + own.0);
        self.pins.extend(input.pins.into_iter().map(|pin| Pin { cloth: cloth(pin.cloth), ..pin }));
        for (at, constraint) in input.constraints.iter().enumerate() {
            let welds = match &constraint.formed {
                Some(links) if constraint.method == LinkMethod::Weld => {
                    links.iter().filter_map(Link::points).collect()
                }
                Some(_) => Vec::new(),
                None => kept(at),
            };
            self.welds.extend(welds.iter().map(|weld| weld.map(|(own, point)| (cloth(own), point))));
        }
        let cloths = input.cloths.iter().map(|frame| frame.collide_strength);
        for (own, (strength, built)) in (0..).zip(cloths.zip(nucleus.model().cloths())) {
            let points = PermeablePoints::of(strength, &built.vertex_maps.collide_strength);
            let object = ObjectKind::Cloth(cloth(ClothId(own)));
            self.permeable.extend(points.map(|points| (object, points)));
        }
        let colliders = input.colliders.iter().map(|frame| frame.collide_strength);
        for (own, (strength, maps)) in (0..).zip(colliders.zip(nucleus.model().collider_maps())) {
            let points = PermeablePoints::of(strength, &maps.collide_strength);
            let object = ObjectKind::Collider(collider(ColliderId(own)));
            self.permeable.extend(points.map(|points| (object, points)));
        }
        let side = |side: &ExcludedSide| match side {
            ExcludedSide::Everything => ExcludedSide::Everything,
            ExcludedSide::Points(of_cloths, of_colliders) => ExcludedSide::Points(
                of_cloths.iter().map(|&(own, point)| (cloth(own), point)).collect(),
                of_colliders.iter().map(|&(own, point)| (collider(own), point)).collect(),
            ),
        };
        let exclusion =
            |own: &Arc<Exclusion>| Exclusion { sides: [side(&own.sides[0]), side(&own.sides[1])] };
        self.exclusions.extend(input.exclusions.iter().map(exclusion));
    }
}

/// Which points of an object have a `collideStrength` below 1.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum PermeablePoints {
    /// All of them.
    All,
    /// Some, by their index.
    Some(Vec<usize>),
}

impl PermeablePoints {
    /// Of an object with this strength, and this vertex map on it; `None` without such points.
    pub(crate) fn of(strength: f64, map: &[f64]) -> Option<Self> {
        if strength < 1.0 {
            return Some(Self::All);
        }
        let below = (0..).zip(map).filter(|(_, factor)| **factor < 1.0);
        let points: Vec<usize> = below.map(|(point, _)| point).collect();
        (!points.is_empty()).then_some(Self::Some(points))
    }
}

/// The points of an object of the program in the audit.
struct Located<'a> {
    program: &'a Program,
    world: &'a CollisionMesh,
}

impl Located<'_> {
    fn point(&self, kind: ObjectKind, point: PointId) -> Option<usize> {
        let body = self.program.objects().iter().position(|object| object.kind == kind)?;
        self.world.points_of(body).nth(point.index())
    }

    fn points(&self, side: &ExcludedSide) -> Option<Vec<usize>> {
        let ExcludedSide::Points(cloths, colliders) = side else { return None };
        let of_cloths = cloths.iter().map(|&(cloth, point)| (ObjectKind::Cloth(cloth), point));
        let of_colliders = colliders.iter().map(|&(collider, point)| (ObjectKind::Collider(collider), point));
        Some(of_cloths.chain(of_colliders).filter_map(|(kind, point)| self.point(kind, point)).collect())
    }
}

/// Adds welds and exclusions of a frame to the rules.
fn add_constraints(rules: &mut CollisionFilter, scope: &AuditScope, located: &Located<'_>) {
    let count = located.world.points();
    for weld in &scope.welds {
        let [a, b] = weld.map(|(cloth, point)| located.point(ObjectKind::Cloth(cloth), point));
        if let (Some(a), Some(b)) = (a, b) {
            rules.weld(count, a, b);
        }
    }
    for (object, points) in &scope.permeable {
        let Some(body) = located.program.objects().iter().position(|own| own.kind == *object) else {
            continue;
        };
        let own = located.world.points_of(body);
        match points {
            PermeablePoints::All => own.for_each(|point| rules.set_permeable(point)),
            PermeablePoints::Some(points) => {
                points.iter().for_each(|point| rules.set_permeable(own.start + point));
            }
        }
    }
    for (number, exclusion) in (0..MAX_EXCLUSIONS as u32).zip(&scope.exclusions) {
        for (side, members) in exclusion.sides.iter().enumerate() {
            match located.points(members) {
                Some(points) => rules.exclude(count, points.into_iter(), number, side),
                None => rules.exclude_everything(count, number, side),
            }
        }
    }
}

/// The rules of the frame that ends at `frame`, over all objects in their order. Colliders and pinned points follow the
/// animation, so the solver cannot keep them apart from each other.
pub(crate) fn collision_rules(
    program: &Program,
    frame: i64,
    scope: &AuditScope,
    world: &CollisionMesh,
) -> CollisionFilter {
    let mut rules = CollisionFilter::default();
    let objects = program.objects();
    let moment = program.graph().at(frame as f64);
    let settings: Vec<_> =
        objects.iter().map(|object| CollisionSettings::of(program, object, &moment)).collect();
    for a in 0..objects.len() {
        if !settings[a].self_collides {
            rules.ignore(a, a);
        }
        for b in a + 1..objects.len() {
            if !settings[a].collides_with(&settings[b]) {
                rules.ignore(a, b);
            }
        }
        if let ObjectKind::Collider(_) = objects[a].kind {
            world.points_of(a).for_each(|point| rules.set_kinematic(point));
        }
    }
    for pin in &scope.pins {
        let is_pinned = |object: &Object| object.kind == ObjectKind::Cloth(pin.cloth);
        let cloth = objects.iter().position(is_pinned).map(|cloth| world.points_of(cloth));
        cloth.into_iter().for_each(|points| rules.set_kinematic(points.start + pin.point.index()));
    }
    add_constraints(&mut rules, scope, &Located { program, world });
    rules
}

/// What decides at a frame which objects an object collides with.
struct CollisionSettings {
    kind: ObjectKind,
    nucleus: NodeId,
    self_collides: bool,
    collide: bool,
    layer: f64,
    /// Layers that differ by less collide.
    layer_range: f64,
}

impl CollisionSettings {
    fn of(program: &Program, object: &Object, moment: &EvalContext) -> Self {
        let (node, nucleus) = program.node_of(object.kind);
        Self {
            kind: object.kind,
            nucleus: nucleus.node(),
            self_collides: self_collides(moment, node),
            collide: moment.get(node, &n_base::COLLIDE),
            layer: moment.get(node, &n_base::COLLISION_LAYER),
            layer_range: moment.get(nucleus.node(), &nucleus::COLLISION_LAYER_RANGE),
        }
    }

    /// Whether the two collide. Objects of different nuclei never do.
    fn collides_with(&self, other: &Self) -> bool {
        // A collider has effect on its own layer and on higher ones.
        let is_in_range = |cloth: &Self, collider: &Self| {
            cloth.layer >= collider.layer && cloth.layer - collider.layer < self.layer_range
        };
        self.nucleus == other.nucleus
            && self.collide
            && other.collide
            && match [self.kind, other.kind] {
                [ObjectKind::Cloth(_), ObjectKind::Cloth(_)] => {
                    (self.layer - other.layer).abs() < self.layer_range
                }
                [ObjectKind::Cloth(_), ObjectKind::Collider(_)] => is_in_range(self, other),
                [ObjectKind::Collider(_), ObjectKind::Cloth(_)] => is_in_range(other, self),
                [ObjectKind::Collider(_), ObjectKind::Collider(_)] => false,
            }
    }
}
