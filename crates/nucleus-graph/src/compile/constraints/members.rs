//! From the nodes of a constraint to its members and sources.

use std::collections::BTreeSet;
use std::sync::Arc;

use nucleus_core::{ClothId, ColliderId, ExcludedSide, Exclusion, Faces, MAX_EXCLUSIONS, PointId, Surface};

use crate::attributes::{ElementKind, dynamic_constraint as con, n_base, n_cloth, n_component, nucleus};
use crate::compile::compiler::Compiler;
use crate::compile::map_values::{MapAttributes, MapOfCloth};
use crate::compile::program::NamedSelection;
use crate::compile::select::{Elements, Selected};
use crate::graph::NodeId;

use super::kinds::{self, Values};
use super::member::{ConstraintSource, Member, MemberObject, Part};
use super::split_mesh::Tearing;

static STRENGTH: MapAttributes = MapAttributes {
    values: &n_component::STRENGTH_PER_VERTEX,
    texture: &n_component::STRENGTH_MAP,
    kind: &n_component::STRENGTH_MAP_TYPE,
};
static GLUE: MapAttributes = MapAttributes {
    values: &n_component::GLUE_STRENGTH_PER_VERTEX,
    texture: &n_component::GLUE_STRENGTH_MAP,
    kind: &n_component::GLUE_STRENGTH_MAP_TYPE,
};
static WEIGHT: MapAttributes = MapAttributes {
    values: &n_component::WEIGHT_PER_VERTEX,
    texture: &n_component::WEIGHT_MAP,
    kind: &n_component::WEIGHT_MAP_TYPE,
};

impl Compiler<'_> {
    /// All constraints that are links or exclusions, in the order of their names.
    pub(crate) fn constraint_sources(&mut self) -> Vec<ConstraintSource> {
        let mut sources = Vec::new();
        for node in self.constraints() {
            if Values::new(&self.start, node).pins() {
                self.warn_of_unused_attributes(node, &[]);
                continue;
            }
            let before = self.findings.errors();
            let members = self.members_of(node);
            if self.findings.errors() > before {
                continue;
            }
            if self.check_members(node, &members) {
                self.warn_of_unused_attributes(node, &members);
                self.warn_of_keyed_pairing(node);
                self.warn_of_disabled_objects(node, &members);
                sources.extend(self.sources_of(node, members));
            }
        }
        let exclusions = sources.iter().filter(|source| source.exclusion.is_some()).count();
        if exclusions > MAX_EXCLUSIONS {
            let place = self.scene.source.place(self.scene.graph.node(self.program.node).name());
            let message = format!("{exclusions} constraints exclude collisions, and {MAX_EXCLUSIONS} can");
            self.findings.error(&place, message).help("join several of them into one");
        }
        sources
    }

    /// The constraints of the nucleus, in the order of their names.
    pub(crate) fn constraints(&self) -> Vec<NodeId> {
        let graph = &self.scene.graph;
        let elements = graph.elements(self.program.node, &nucleus::INPUT_CURRENT);
        let mut constraints: Vec<NodeId> = elements.into_iter().map(|(_, plug)| plug.node).collect();
        constraints.sort_by_key(|id| graph.node(*id).name());
        constraints.dedup();
        constraints.retain(|id| !self.broken.contains(id));
        constraints
    }

    /// The links of a constraint, a force to its origin, and its collision exclusions.
    fn sources_of(&self, node: NodeId, members: Vec<Member>) -> Vec<ConstraintSource> {
        let values = Values::new(&self.start, node);
        let to_space = values.choice(&con::CONSTRAINT_RELATION) == 0;
        let forces = values.ever(&con::FORCE, |force| force != 0.0);
        let excludes = values.toggle(&con::EXCLUDE_COLLISIONS);
        let can_break = can_break(&values, &members);
        let mut parts = Vec::new();
        if has_links(&values) || forces && !to_space {
            parts.push(Some(Part::Links));
        }
        if forces && to_space {
            parts.push(Some(Part::ForceToOrigin));
        }
        let mut exclusion = excludes.then(|| Arc::new(exclusion(&values, &members)));
        if parts.is_empty() && excludes {
            parts.push(None);
        }
        let source = |part| ConstraintSource {
            node,
            members: members.clone(),
            moves: self.scene.graph.moves(node),
            part,
            exclusion: exclusion.take(),
            can_break,
            seams: self.seams_of(node),
            creases: self.creases_of(node),
            kept_bend: self.kept_bend(&values, &members),
        };
        parts.into_iter().map(source).collect()
    }

    /// The welds of a tearable surface.
    fn seams_of(&self, node: NodeId) -> Vec<(ClothId, [u32; 2], [u32; 2])> {
        let of_cloth = |(cloth, tearing): (ClothId, &Tearing)| {
            let own = tearing.seams.iter().filter(|seam| seam.constraint == node);
            own.map(|seam| (cloth, seam.points, seam.edge)).collect::<Vec<_>>()
        };
        let cloths = (0..).map(ClothId).zip(&self.program.cloths);
        cloths
            .filter_map(|(cloth, source)| Some((cloth, source.tearing.as_ref()?)))
            .flat_map(of_cloth)
            .collect()
    }

    /// The edges of these welds.
    fn creases_of(&self, node: NodeId) -> Vec<(ClothId, [[u32; 4]; 2])> {
        let cloths = (0..).map(ClothId).zip(&self.program.cloths);
        let tearing = cloths.filter_map(|(cloth, source)| Some((cloth, source.tearing.as_ref()?)));
        let of_cloth = |(cloth, tearing): (ClothId, &Tearing)| {
            let own = tearing.creases.iter().filter(|crease| crease.constraint == node);
            own.map(|crease| (cloth, crease.sides)).collect::<Vec<_>>()
        };
        tearing.flat_map(of_cloth).collect()
    }

    /// Maya creates a tearable surface with `bend` where the cloth resists bending by more than this.
    fn kept_bend(&self, values: &Values<'_>, members: &[Member]) -> Option<f64> {
        const LEAST_BEND: f64 = 0.2;
        let is_open = values.kind == kinds::TEARABLE && !self.scene.graph.is_given(values.node, &con::BEND);
        let of_cloth = |member: &Member| match member.object {
            MemberObject::Cloth(cloth) if self.program.cloths[cloth.index()].tearing.is_some() => {
                self.start.get(self.program.cloths[cloth.index()].node, &n_cloth::BEND_RESISTANCE)
            }
            _ => 0.0,
        };
        let most = members.iter().map(of_cloth).fold(0.0, f64::max);
        (is_open && most > LEAST_BEND).then_some(most)
    }

    /// Reports members that a constraint cannot join.
    fn check_members(&mut self, node: NodeId, members: &[Member]) -> bool {
        let values = Values::new(&self.start, node);
        let name = self.scene.graph.node(node).name();
        let listed = self.scene.graph.node(node).setting(&con::COMPONENTS).is_some();
        if members.is_empty() {
            let message = format!("`{name}` does nothing: it has no members");
            if listed || !self.scene.graph.elements(node, &con::COMPONENT_IDS).is_empty() {
                self.findings.warning(&self.scene.source.place(name), message);
            }
            return false;
        }
        let bends = values.toggle(&con::BEND) && values.kind != kinds::TEARABLE;
        let problem = problem_of(&values, members);
        if bends {
            self.check_bend(name, members);
        }
        if let Some((problem, help)) = problem {
            let place = self.scene.source.place(&format!("{name}.components"));
            let names: Vec<&str> = members.iter().map(|member| member.name.as_str()).collect();
            let message = format!("`{name}` {problem}: {}", crate::diagnostic::listed(&names));
            self.findings.error(&place, message).help(help);
        }
        problem.is_none()
    }

    /// Reports a constraint that bends and has no edges.
    fn check_bend(&mut self, name: &str, members: &[Member]) {
        if members.iter().any(|member| member.kind == ElementKind::Edge) {
            return;
        }
        let place = self.scene.source.place(&format!("{name}.{}", con::BEND.row.name));
        let message = format!("`bend` of `{name}` has no effect: none of its components are edges");
        self.findings.warning(&place, message).help("edges bend about each other: name `cloth1.e[border]`");
    }

    /// The members of a constraint with their elements.
    pub(crate) fn members_of(&mut self, constraint: NodeId) -> Vec<Member> {
        let graph = &self.scene.graph;
        let kind = Values::new(&self.start, constraint).kind;
        let surfaces = matches!(kind, kinds::POINT_TO_SURFACE | kinds::SLIDE_ON_SURFACE);
        let (mut members, mut strangers) = (Vec::new(), Vec::new());
        for (_, plug) in graph.elements(constraint, &con::COMPONENT_IDS) {
            let Some(object) = graph.source(plug.node, &n_component::OBJECT_ID) else { continue };
            let Some(target) = self.member_object(object) else {
                strangers.push(object);
                continue;
            };
            let role = match kind {
                kinds::WELD_BORDERS => Role::Border,
                _ if surfaces && members.is_empty() => Role::Surface,
                _ => Role::Elements,
            };
            if let Some(mut member) = self.member([constraint, plug.node, object], target, role) {
                if role == Role::Surface {
                    member.sheet = self.sheet_of(&member);
                }
                members.push(member);
            }
        }
        strangers.into_iter().for_each(|object| self.refuse_stranger(constraint, object));
        members
    }

    /// Reports an object that another nucleus solves. One with errors of its own is not solved at all.
    fn refuse_stranger(&mut self, constraint: NodeId, object: NodeId) {
        if self.broken.contains(&object) || self.findings.errors() > 0 {
            return;
        }
        let graph = &self.scene.graph;
        let [name, object, own] = [constraint, object, self.program.node].map(|id| graph.node(id).name());
        let place = self.scene.source.place(&format!("{name}.components"));
        let message = format!("`{name}` joins `{object}`, which `{own}` does not solve");
        let help = "a constraint and all of its members need the same nucleus: set `nucleus` of each";
        self.findings.error(&place, message).help(help);
    }

    fn member_object(&self, object: NodeId) -> Option<MemberObject> {
        let cloth = self.cloth_of(object).map(MemberObject::Cloth);
        let collider = self.program.colliders.iter().position(|collider| collider.node == object);
        cloth.or(collider.map(|at| MemberObject::Collider(ColliderId(at as u32))))
    }

    /// The faces that links may slide on besides those of the member; empty where it has them all.
    fn sheet_of(&self, member: &Member) -> Faces {
        let faces = &self.solver_mesh(member.object).faces;
        if faces.len() > member.elements.len() { faces.clone() } else { Faces::default() }
    }

    /// One member.
    fn member(
        &mut self,
        [constraint, component, object]: [NodeId; 3],
        target: MemberObject,
        role: Role,
    ) -> Option<Member> {
        let mesh = self.scene.graph.source(object, &n_base::INPUT_MESH).unwrap_or(object);
        let (faces, points) = self.given_mesh(mesh, target);
        let elements = Elements::new(&faces, points);
        let (kind, chosen) =
            self.elements_of_role(&Selected { owner: constraint, object, mesh }, component, &elements, role);
        let spans = match role {
            Role::Border if kind != ElementKind::Edge => elements.spans(),
            _ => Vec::new(),
        };
        self.name_selection([constraint, object], &elements, kind, &chosen);
        let capacity = self.capacity_of(component, target);
        let excludes = kinds::excludes(Values::new(&self.start, constraint).kind);
        if chosen.is_empty() && !(excludes && capacity.is_some()) {
            return None;
        }
        let tearing = self.tearing_of(target);
        let all = solver_elements(&self.solver_mesh(target).faces, tearing, &elements, kind, &chosen);
        let twins = tearing.map(|tearing| tearing.twins.clone()).unwrap_or_default();
        let number = |key| self.start.get(component, key);
        let scalars = [
            number(&n_component::STRENGTH),
            number(&n_component::TANGENT_STRENGTH),
            number(&n_component::GLUE_STRENGTH),
            number(&n_component::WEIGHT),
        ];
        let maps = [&STRENGTH, &GLUE, &WEIGHT].map(|map| {
            let mut values =
                self.map_values(&MapOfCloth { cloth: component, mesh, points, map }).unwrap_or_default();
            if !values.is_empty() {
                let more: Vec<f64> = twins.iter().map(|&twin| values[twin as usize]).collect();
                values.extend(more);
            }
            values
        });
        let behind = match kind {
            ElementKind::Edge => chosen.iter().map(|&at| elements.behind(at)).collect(),
            _ => Vec::new(),
        };
        Some(Member {
            object: target,
            kind,
            elements: all,
            behind,
            spans: with_twins(spans, points, &twins),
            sheet: Faces::default(),
            scalars,
            maps,
            name: self.scene.graph.node(object).name().to_owned(),
            capacity,
        })
    }

    /// The room for particles of a whole object of which they come and go.
    fn capacity_of(&self, component: NodeId, target: MemberObject) -> Option<u32> {
        let is_whole =
            self.scene.graph.node(component).get(&n_component::COMPONENT_TYPE) == n_component::OBJECT;
        let MemberObject::Cloth(cloth) = target else { return None };
        let particles = self.program.model.cloths()[cloth.index()].particles.as_ref();
        particles.filter(|_| is_whole).map(|particles| particles.capacity as u32)
    }

    /// The faces and the number of points of a mesh as it was given, by which its elements are numbered; of particles their
    /// number.
    fn given_mesh(&mut self, mesh: NodeId, target: MemberObject) -> (Faces, usize) {
        match self.geometry.surface(self.scene, mesh, self.findings) {
            Some(surface) => (surface.faces.clone(), surface.positions.len()),
            None => (Faces::default(), self.solver_mesh(target).positions.len()),
        }
    }

    /// The mesh of the solver: one that can tear is split, and one that is mirrored has its faces turned.
    fn solver_mesh(&self, target: MemberObject) -> &Surface {
        match target {
            MemberObject::Cloth(cloth) => &self.program.model.cloths()[cloth.index()].surface,
            MemberObject::Collider(collider) => &self.program.model.colliders()[collider.index()].surface,
        }
    }

    fn tearing_of(&self, target: MemberObject) -> Option<&Tearing> {
        match target {
            MemberObject::Cloth(cloth) => self.program.cloths[cloth.index()].tearing.as_ref(),
            MemberObject::Collider(_) => None,
        }
    }

    /// The elements that a component stands for in its role.
    fn elements_of_role(
        &mut self,
        of: &Selected,
        component: NodeId,
        elements: &Elements<'_>,
        role: Role,
    ) -> (ElementKind, Vec<u32>) {
        let node = self.scene.graph.node(component);
        let is_whole = node.get(&n_component::COMPONENT_TYPE) == n_component::OBJECT;
        let is_border = node.get(&n_component::ELEMENTS) == n_component::BORDERS;
        let border = elements.border(ElementKind::Edge);
        let faces = elements.faces.len() as u32;
        match role {
            Role::Surface if is_whole && faces > 0 => (ElementKind::Face, (0..faces).collect()),
            // A closed object has no border: its points are welded.
            Role::Border if (is_whole || is_border) && !border.is_empty() => (ElementKind::Edge, border),
            _ => self.selected(of, component, elements),
        }
    }

    /// Records the elements of an object that a constraint names.
    fn name_selection(
        &mut self,
        [constraint, object]: [NodeId; 2],
        elements: &Elements<'_>,
        kind: ElementKind,
        chosen: &[u32],
    ) {
        let [owner, object] = [constraint, object].map(|id| self.scene.graph.node(id).name().to_owned());
        let corners: BTreeSet<u32> = chosen.iter().flat_map(|at| elements.corners(kind, *at)).collect();
        let points = corners.into_iter().collect();
        self.program.selections.push(NamedSelection {
            owner,
            object,
            kind,
            elements: chosen.to_vec(),
            points,
        });
    }
}

/// Elements as the solver has them, given its faces: those of a mesh that can tear have its twins.
fn solver_elements(
    faces: &Faces,
    tearing: Option<&Tearing>,
    elements: &Elements<'_>,
    kind: ElementKind,
    chosen: &[u32],
) -> Faces {
    let mut all = Faces::default();
    for &at in chosen {
        match kind {
            ElementKind::Face => all.push(faces.face(at as usize)),
            _ => all.push(&elements.corners(kind, at)),
        }
    }
    // Points that were split are all of their twins.
    if let Some(tearing) = tearing.filter(|_| kind == ElementKind::Point) {
        tearing.twins_of(chosen).into_iter().for_each(|twin| all.push(&[twin]));
    }
    all
}

/// The part that a component plays in its constraint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// The elements that it names.
    Elements,
    /// The surface of links: a whole object stands for its faces.
    Surface,
    /// A border that is welded: a whole object, or its border, stands for its border edges.
    Border,
}

/// The spans of points, and of the twins of those that were split, which follow them.
fn with_twins(mut spans: Vec<[u32; 2]>, points: usize, twins: &[u32]) -> Vec<[u32; 2]> {
    let given = spans.len();
    for (twin, &point) in (points as u32..).zip(twins) {
        let from = spans[..given].partition_point(|span| span[0] < point);
        let own = spans[from..given].iter().take_while(|span| span[0] == point);
        let own: Vec<[u32; 2]> = own.map(|span| [twin, span[1]]).collect();
        spans.extend(own);
    }
    spans
}

/// Whether a constraint ever pulls, damps or drags along links.
pub(super) fn has_links(values: &Values<'_>) -> bool {
    let used = |key| values.ever(key, |value| value > 0.0);
    let drags = used(&con::DAMP) || used(&con::MOTION_DRAG);
    let bends = values.toggle(&con::BEND) && used(&con::BEND_STRENGTH);
    let welds = values.choice(&con::CONSTRAINT_METHOD) == kinds::WELD && !kinds::excludes(values.kind);
    drags || bends || welds || used(&con::STRENGTH) || used(&con::TANGENT_STRENGTH)
}

/// Whether links of a constraint ever break.
pub(super) fn can_break(values: &Values<'_>, members: &[Member]) -> bool {
    let breaks = |glue: &f64| *glue < 1.0;
    values.ever(&con::GLUE_STRENGTH, |glue| glue < 1.0)
        || members.iter().any(|member| breaks(&member.scalars[2]) || member.maps[1].iter().any(breaks))
}

/// Why a constraint cannot join its members, and what helps.
fn problem_of(values: &Values<'_>, members: &[Member]) -> Option<(&'static str, &'static str)> {
    let (kind, relation) = (values.kind, values.choice(&con::CONSTRAINT_RELATION));
    let within = values.toggle(&con::CONNECT_WITHIN_COMPONENT);
    let is_passive = |member: &Member| matches!(member.object, MemberObject::Collider(_));
    let objects: BTreeSet<_> = members.iter().map(|member| member.object.key()).collect();
    let needs_two = matches!(
        kind,
        kinds::POINT_TO_SURFACE | kinds::SLIDE_ON_SURFACE | kinds::MATCH | kinds::EXCLUDE_PAIRS
    );
    let surface_first = matches!(kind, kinds::POINT_TO_SURFACE | kinds::SLIDE_ON_SURFACE);
    let all_passive = members.iter().all(is_passive) && kind != kinds::DISABLE_COLLISION;
    if all_passive {
        Some(("joins only passive objects, which nothing moves", "name a part of a cloth or of particles"))
    } else if needs_two && members.len() < 2 {
        Some(("has one member, and this kind joins two", "name parts of both objects in `components`"))
    } else if surface_first && members[0].kind != ElementKind::Face {
        Some((
            "needs a surface as its first component",
            "name the surface first: a whole object, or faces (`cloth1.f[*]`)",
        ))
    } else if kind == kinds::SLIDE_ON_SURFACE && objects.len() < 2 {
        Some(("slides an object on itself", "name another object first"))
    } else if kind == kinds::MATCH && members[0].points().len() != members[1].points().len() {
        Some(("matches objects of different numbers of points", "both meshes need the same points"))
    } else if relation == 1 && members.len() == 1 && !within && !joins_itself(kind) {
        Some(("joins a component to itself", "name another component, or set `connectWithinComponent: true`"))
    } else {
        None
    }
}

/// Whether a kind joins the elements of one component with each other.
fn joins_itself(kind: i32) -> bool {
    matches!(kind, 1 | kinds::WELD_BORDERS | kinds::TEARABLE | kinds::DISABLE_COLLISION)
}

/// The elements that do not collide: for `disableCollision` the members with anything, else the first member with the
/// others, or the only member with itself.
fn exclusion(values: &Values<'_>, members: &[Member]) -> Exclusion {
    let side = |members: &[Member]| {
        let (mut cloths, mut colliders) = (Vec::new(), Vec::new());
        for member in members {
            let points = match member.capacity {
                Some(capacity) => (0..capacity).collect(),
                None => member.points().into_iter().map(|(point, _)| point).collect::<Vec<_>>(),
            };
            let points = points.into_iter().map(PointId);
            match member.object {
                MemberObject::Cloth(cloth) => cloths.extend(points.map(|point| (cloth, point))),
                MemberObject::Collider(collider) => colliders.extend(points.map(|point| (collider, point))),
            }
        }
        ExcludedSide::Points(cloths, colliders)
    };
    let sides = match members {
        _ if values.kind == kinds::DISABLE_COLLISION => [side(members), ExcludedSide::Everything],
        [only] => [side(std::slice::from_ref(only)), side(std::slice::from_ref(only))],
        [first, others @ ..] => [side(std::slice::from_ref(first)), side(others)],
        [] => Default::default(),
    };
    Exclusion { sides }
}
