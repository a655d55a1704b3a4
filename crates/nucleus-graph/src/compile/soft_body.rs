//! What an nCloth has beyond links, in SI units: angles, deformation that stays, pressure, shape, and the input mesh.

use nalgebra::Vector3;
use nucleus_core::{
    BendSolver, Bending, COUNT_PERIOD, ClothId, ClothLists, FieldSide, ForceField, InputAttract, InputMesh,
    LinkOrder, PASCALS_PER_PRESSURE, Pin, PointField, PointId, Pressure, Surface, WindField,
};

use crate::animation::sin_cos_degrees;
use crate::attributes::{Choice, Key, RampPoint, n_base, n_cloth, nucleus, particle};
use crate::graph::{EvalContext, Graph, NodeId};

use super::compiler::Compiler;
use super::map_values::MapOfCloth;
use super::program::EvaluationInterval;
use super::sources::{ClothSource, FollowedMesh};
use super::units::CLASSIC;
use super::vertex_maps::WRINKLE;

/// `bendSolver: simple` and `flipTracking`.
const SIMPLE: Choice = Choice(0);
const FLIP_TRACKING: Choice = Choice(2);
/// `pressureMethod: manualPressureSetting`.
const MANUAL: Choice = Choice(0);
/// `inputAttractMethod: lockValuesOf10OrGreater`.
const LOCKS: Choice = Choice(1);
/// `evaluationOrder: parallel`.
const PARALLEL: Choice = Choice(1);
/// `scalingRelation`.
const LINK: Choice = Choice(0);
const OBJECT_SPACE: Choice = Choice(1);
/// `restitutionTension` from which on nothing stays, and `restitutionAngle` in degrees: Maya's defaults.
const NO_TENSION: f64 = 1000.0;
const NO_ANGLE: f64 = 360.0;
/// Pa·s for a `pressureDamping` of 1: it takes up a pressure of 1 at one volume in 1/24 s.
const DAMPING: f64 = PASCALS_PER_PRESSURE / 24.0;
/// Interpolations of ramps.
const STEP: Choice = Choice(0);
const LINEAR: Choice = Choice(1);
/// m/s² for a `fieldMagnitude` of 1.
pub(super) const FIELD_ACCELERATION: f64 = 10.0;
/// Faces of the mesh for which Object Space means the same as Link: those of a polyPlane as Maya makes it.
const REFERENCE_FACES: f64 = 100.0;

/// The lists that a cloth needs beyond links; `lists` has the others.
pub(super) fn lists(graph: &Graph, cloth: NodeId, lists: ClothLists) -> ClothLists {
    use n_cloth::{
        BEND_ANGLE_DROPOFF, BEND_ANGLE_SCALE, BEND_SOLVER, DEFORM_RESISTANCE, PRESSURE, PRESSURE_METHOD,
        RESTITUTION_ANGLE, RESTITUTION_TENSION, RIGIDITY, USE_POLYGON_SHELLS,
    };
    let node = graph.node(cloth);
    let used = |key: &Key<f64>| graph.is_ever_nonzero(cloth, key);
    let below = |key: &Key<f64>, limit: f64| graph.changes(cloth, key) || node.get(key) < limit;
    let yields_bends = below(&RESTITUTION_ANGLE, NO_ANGLE);
    let scaled = graph.changes(cloth, &BEND_ANGLE_SCALE) || node.get(&BEND_ANGLE_SCALE) != 1.0;
    let shape = used(&RIGIDITY) || used(&DEFORM_RESISTANCE);
    let by_volume = graph.changes(cloth, &PRESSURE_METHOD) || node.get(&PRESSURE_METHOD) != MANUAL;
    let pressure = by_volume || used(&PRESSURE);
    ClothLists {
        signed_bend: lists.bend && node.get(&BEND_SOLVER) != SIMPLE,
        bend_angles: lists.bend
            && (used(&BEND_ANGLE_DROPOFF)
                || scaled
                || yields_bends
                || graph.changes(cloth, &BEND_SOLVER)
                || node.get(&BEND_SOLVER) == FLIP_TRACKING),
        pressure,
        shape,
        shells: shape && node.get(&USE_POLYGON_SHELLS),
        plastic: lists.stretch && below(&RESTITUTION_TENSION, NO_TENSION),
        ..lists
    }
}

impl EvaluationInterval<'_> {
    /// How the hinges of a cloth measure their angles.
    pub(super) fn bending(&self, source: &ClothSource) -> Bending {
        let number = |key: &Key<f64>| self.to.get(source.node, key);
        let given = number(&n_cloth::RESTITUTION_ANGLE);
        let limit = if given < NO_ANGLE { given * source.scales.restitution_angle } else { given };
        Bending {
            angle_scale: number(&n_cloth::BEND_ANGLE_SCALE),
            angle_dropoff: number(&n_cloth::BEND_ANGLE_DROPOFF) * source.scales.angle_dropoff,
            solver: match self.to.get(source.node, &n_cloth::BEND_SOLVER) {
                SIMPLE => BendSolver::Simple,
                FLIP_TRACKING => BendSolver::FlipTracking,
                _ => BendSolver::Signed,
            },
            yield_sine: match limit < NO_ANGLE {
                // Beyond 180° half the angle has a smaller sine again: such a bend is never reached.
                true if limit < 180.0 => sin_cos_degrees(limit.max(0.0) / 2.0).0,
                _ => f64::INFINITY,
            },
            yield_half_angle: if given < NO_ANGLE { limit.to_radians() / 2.0 } else { f64::INFINITY },
        }
    }

    /// The strain at which links of a resistance give way: the tension of a link is its resistance times its strain.
    pub(super) fn yield_strain(&self, node: NodeId, resistance: f64) -> f64 {
        let tension = self.to.get(node, &n_cloth::RESTITUTION_TENSION);
        if tension >= NO_TENSION || resistance <= 0.0 { f64::INFINITY } else { tension.max(0.0) / resistance }
    }

    /// Pressure in pascals.
    pub(super) fn pressure(&self, node: NodeId) -> Pressure {
        let number = |key: &Key<f64>| self.to.get(node, key);
        let damping = number(&n_cloth::PRESSURE_DAMPING) * DAMPING;
        if self.to.get(node, &n_cloth::PRESSURE_METHOD) == MANUAL {
            let pascals = number(&n_cloth::PRESSURE) * PASCALS_PER_PRESSURE;
            return if pascals == 0.0 { Pressure::Off } else { Pressure::Manual { pascals, damping } };
        }
        Pressure::Gas {
            start: number(&n_cloth::START_PRESSURE),
            bulk: number(&n_cloth::INCOMPRESSIBILITY) * PASCALS_PER_PRESSURE,
            pump: number(&n_cloth::PUMP_RATE),
            tightness: number(&n_cloth::AIR_TIGHTNESS),
            damping,
            sealed: self.to.get(node, &n_cloth::SEAL_HOLES),
        }
    }

    /// How a cloth is drawn to its input mesh.
    pub(super) fn input_attract(&self, source: &ClothSource) -> InputAttract {
        let number = |key: &Key<f64>| self.to.get(source.node, key);
        InputAttract {
            strength: number(&n_cloth::INPUT_MESH_ATTRACT) * source.scales.input_attract,
            damp: number(&n_cloth::INPUT_ATTRACT_DAMP),
            motion_drag: number(&n_cloth::INPUT_MOTION_DRAG),
        }
    }

    /// The force field of an object. Its magnitude of 1 is an acceleration of 10 m/s² at the surface, about that of
    /// gravity. `scale` is a factor on it.
    pub(super) fn force_field(&self, node: NodeId, scale: f64) -> Option<ForceField> {
        let side = match self.to.get(node, &n_base::FORCE_FIELD) {
            Choice(1) => FieldSide::AlongNormal,
            Choice(2) => FieldSide::Single,
            Choice(3) => FieldSide::Double,
            _ => return None,
        };
        let ramp = self.to.get(node, &n_base::FIELD_SCALE);
        Some(ForceField {
            side,
            magnitude: self.to.get(node, &n_base::FIELD_MAGNITUDE) * FIELD_ACCELERATION * scale,
            distance: self.nucleus.units.length(self.to.get(node, &n_base::FIELD_DISTANCE)),
            falloff: samples(&ramp),
        })
    }

    /// The force fields round the points of an object of this thickness in metres.
    pub(super) fn point_field(&self, node: NodeId, thickness: f64) -> Option<PointField> {
        let number = |key: &Key<f64>| self.to.get(node, key);
        let relative = match self.to.get(node, &n_base::POINT_FORCE_FIELD) {
            Choice(1) => true,
            Choice(2) => false,
            _ => return None,
        };
        let units = self.nucleus.units;
        let scale = if relative { thickness * units.per_metre() } else { 1.0 };
        Some(PointField {
            magnitude: number(&n_base::POINT_FIELD_MAGNITUDE) * FIELD_ACCELERATION * scale,
            self_attract: number(&n_base::SELF_ATTRACT) * FIELD_ACCELERATION * scale,
            radius: thickness,
            distance: units.length(number(&n_base::POINT_FIELD_DISTANCE) * scale),
            falloff: samples(&self.to.get(node, &n_base::POINT_FIELD_DROPOFF)),
        })
    }

    /// What an object does to the wind that others feel.
    pub(super) fn wind_field(&self, node: NodeId) -> WindField {
        let number = |key: &Key<f64>| self.to.get(node, key);
        WindField {
            shadow_distance: self.nucleus.units.length(number(&n_base::WIND_SHADOW_DISTANCE)),
            shadow_diffusion: number(&n_base::WIND_SHADOW_DIFFUSION),
            self_shadow: false,
            push_distance: self.nucleus.units.length(number(&n_base::AIR_PUSH_DISTANCE)),
            push_vorticity: number(&n_base::AIR_PUSH_VORTICITY),
        }
    }

    /// A resistance as the solver takes it. Physical: as it is. Classic: a count, scaled as `scalingRelation` says and no
    /// higher than `maxIterations`.
    /// `minimal` limits it to one iteration in a substep.
    pub(super) fn resistance(&self, source: &ClothSource, value: f64, minimal: &Key<bool>) -> f64 {
        if self.to.get(self.nucleus.node, &nucleus::RESISTANCE_MODEL) != CLASSIC {
            return value;
        }
        let limit = self.to.get(source.node, &n_base::MAX_ITERATIONS).max(0) as f64;
        let count = (value * self.count_scale(source)).min(limit);
        if self.to.get(source.node, minimal) { count.min(self.substeps_per_count()) } else { count }
    }

    /// Substeps in the time that counts are given for.
    fn substeps_per_count(&self) -> f64 {
        let seconds = self.to.get(self.nucleus.node, &nucleus::TIME_SCALE) * self.seconds;
        self.to.get(self.nucleus.node, &nucleus::SUB_STEPS) as f64 * COUNT_PERIOD / seconds
    }

    /// Factor on the counts of a cloth in the Classic reading: `scalingRelation`. In Object Space the count grows with the
    /// number of faces, so that a finer mesh is no softer; in World Space it also goes with the inverse area of the object
    /// in m², so that a larger one is no stiffer.
    fn count_scale(&self, source: &ClothSource) -> f64 {
        let faces = source.faces as f64 / REFERENCE_FACES;
        match self.to.get(source.node, &n_cloth::SCALING_RELATION) {
            LINK => 1.0,
            OBJECT_SPACE => faces,
            _ => faces / source.area.max(f64::MIN_POSITIVE),
        }
    }

    /// The input meshes that attract or drag their cloth.
    pub(super) fn input_meshes(&self) -> Vec<InputMesh> {
        let mut meshes = Vec::new();
        for (cloth, source) in (0..).map(ClothId).zip(&self.nucleus.cloths) {
            let Some(followed) = &source.followed else { continue };
            if self.input_attract(source).is_on() {
                let [start, end] =
                    [&self.from, &self.to].map(|moment| self.followed_points(source, followed, moment));
                meshes.push(InputMesh { cloth, start, end });
            }
        }
        meshes
    }

    /// Adds pins for points that are locked to their input mesh: all of a cloth that is not dynamic, and those whose
    /// attraction is 1 or greater where `inputAttractMethod` locks them. `pins` hold their points first.
    pub(super) fn lock_to_input_meshes(&self, pins: &mut Vec<Pin>) {
        let held: std::collections::BTreeSet<_> = pins.iter().map(|pin| (pin.cloth, pin.point)).collect();
        for (cloth, source) in (0..).map(ClothId).zip(&self.nucleus.cloths) {
            let Some(followed) = &source.followed else { continue };
            let is_dynamic = self.to.get(source.node, &particle::IS_DYNAMIC);
            let locks = self.to.get(source.node, &n_cloth::INPUT_ATTRACT_METHOD) == LOCKS;
            let strength = self.input_attract(source).strength;
            if is_dynamic && (!locks || strength <= 0.0) {
                continue;
            }
            let [start, end] =
                [&self.from, &self.to].map(|moment| self.followed_points(source, followed, moment));
            for (index, (start, end)) in start.into_iter().zip(end).enumerate() {
                let point = PointId(index as u32);
                let factor = followed.factors.get(index).copied().unwrap_or(1.0);
                let is_locked = !is_dynamic || strength * factor >= 1.0;
                if is_locked && !held.contains(&(cloth, point)) {
                    pins.push(Pin { cloth, point, start, end });
                }
            }
        }
    }

    /// The points of an input mesh in metres.
    fn followed_points(
        &self,
        source: &ClothSource,
        followed: &FollowedMesh,
        moment: &EvalContext,
    ) -> Vec<Vector3<f64>> {
        let (placement, points) = (moment.placement(followed.mesh), followed.shape.at(moment));
        let mut points: Vec<Vector3<f64>> =
            points.iter().map(|point| self.nucleus.units.point(placement.point(*point))).collect();
        source.tearing.iter().for_each(|tearing| tearing.extend(&mut points));
        points
    }
}

impl Compiler<'_> {
    /// The input mesh of a cloth, if anything in the run follows it.
    pub(super) fn followed_mesh(
        &mut self,
        cloth: NodeId,
        mesh: NodeId,
        factors: &[f64],
    ) -> Option<FollowedMesh> {
        let graph = &self.scene.graph;
        let is_used = |key: &Key<f64>| graph.is_ever_nonzero(cloth, key);
        let rests =
            graph.changes(cloth, &particle::IS_DYNAMIC) || !graph.node(cloth).get(&particle::IS_DYNAMIC);
        if !(is_used(&n_cloth::INPUT_MESH_ATTRACT) || is_used(&n_cloth::INPUT_MOTION_DRAG) || rests) {
            return None;
        }
        let shape = self.geometry.animated(self.scene, mesh, self.findings)?;
        Some(FollowedMesh { mesh, shape, factors: factors.to_vec() })
    }

    /// The shape of a cloth at rest, in scene units, where that is not its input mesh: `restShapeMesh`, and wrinkles along
    /// the normals of either. Nothing if something is wrong, which has been said then.
    pub(super) fn rest_surface(
        &mut self,
        cloth: NodeId,
        mesh: NodeId,
        input: &Surface,
    ) -> Option<Option<Surface>> {
        let mut rest = None;
        if let Some(source) = self.scene.graph.source(cloth, &n_cloth::REST_SHAPE_MESH) {
            let placement = self.start.placement(source);
            let shape = self.geometry.animated(self.scene, source, self.findings)?.at(&self.start);
            let given = self.geometry.surface(self.scene, source, self.findings)?;
            if shape.len() != input.positions.len() || given.faces != input.faces {
                let [name, source] = [cloth, source].map(|id| self.scene.graph.node(id).name());
                let place = self.scene.source.place(&format!("{name}.restShapeMesh"));
                let message = format!(
                    "`{source}` cannot be the rest shape of `{name}`: it has {} points and {} faces, the input mesh {} and {}",
                    shape.len(),
                    given.faces.len(),
                    input.positions.len(),
                    input.faces.len()
                );
                let error = self.findings.error(&place, message);
                error.help("a rest shape has the points and faces of the input mesh, elsewhere");
                return None;
            }
            let positions = shape.iter().map(|point| placement.point(*point)).collect();
            rest = Some(Surface { positions, faces: input.faces.clone() });
        }
        let before = self.findings.errors();
        let points = input.positions.len();
        let wrinkles = self.map_values(&MapOfCloth { cloth, mesh, points, map: &WRINKLE });
        if self.findings.errors() > before {
            return None;
        }
        if let Some(heights) = wrinkles {
            let scale = self.start.get(cloth, &n_cloth::WRINKLE_MAP_SCALE);
            let mut surface = rest.unwrap_or_else(|| input.clone());
            let normals = normals(&surface);
            for ((position, normal), height) in surface.positions.iter_mut().zip(normals).zip(heights) {
                *position += normal * (height * scale);
            }
            rest = Some(surface);
        }
        Some(rest)
    }

    /// The order in which the links of each cloth are solved; the constraints are compiled before.
    pub(super) fn order_links(&mut self) {
        let graph = &self.scene.graph;
        for (cloth, source) in (0..).map(ClothId).zip(&self.program.cloths) {
            let node = graph.node(source.node);
            if !node.node_type().is_a(&n_cloth::N_CLOTH) {
                continue;
            }
            if self.start.get(source.node, &n_cloth::EVALUATION_ORDER) == PARALLEL {
                self.program.model.set_link_order(cloth, LinkOrder::Parallel);
            } else if self.start.get(source.node, &n_cloth::SORT_LINKS) {
                let held = self.program.attachments.iter().flat_map(|attachment| &attachment.points);
                let held: Vec<PointId> =
                    held.filter(|held| held.cloth == cloth).map(|held| held.point).collect();
                if held.is_empty() {
                    let place = self.scene.source.place(&format!("{}.sortLinks", node.name()));
                    let message = format!(
                        "`sortLinks` of `{}` has no effect: no constraint holds a point of it",
                        node.name()
                    );
                    self.findings.warning(&place, message);
                }
                self.program.model.set_link_order(cloth, LinkOrder::Outwards(held));
            } else if self.start.get(self.program.node, &nucleus::RESISTANCE_MODEL) == CLASSIC {
                self.program.model.set_link_order(cloth, LinkOrder::Mesh);
            }
        }
    }

    /// Warns of pressure in a mesh that cannot hold it.
    pub(super) fn check_pressure(&mut self, cloth: NodeId, surface: &Surface) {
        let node = self.scene.graph.node(cloth);
        let is_manual = self.start.get(cloth, &n_cloth::PRESSURE_METHOD) == MANUAL;
        if is_manual && !self.scene.graph.is_ever_nonzero(cloth, &n_cloth::PRESSURE) {
            return;
        }
        let middle = surface.positions.iter().sum::<Vector3<f64>>() / surface.positions.len() as f64;
        let corners = |triangle: [u32; 3]| triangle.map(|k| surface.positions[k as usize] - middle);
        let volume: f64 =
            surface.faces.triangles().map(corners).map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0).sum();
        let area = area(surface);
        // A sphere has 0.094.
        let is_flat = volume.abs() < 1e-4 * area.powf(1.5);
        let attribute = if is_manual { &n_cloth::PRESSURE.row } else { &n_cloth::PRESSURE_METHOD.row };
        let name = node.name();
        let (message, help) = match is_manual {
            true if is_open(surface) => (
                format!(
                    "`{name}` has open edges: pressure set by hand pushes its faces along their normals, and the whole of it \
                     away"
                ),
                "close the mesh, hold it by a constraint, or write `pressureMethod: volumeTrackingModel`, which seals holes",
            ),
            true if volume < 0.0 => (
                format!("the faces of `{name}` face inwards: a pressure above 0 turns it inside out"),
                "reverse its normals, or the sign of `pressure`",
            ),
            false if is_flat => (
                format!("`{name}` encloses no volume, so no air is held in it"),
                "use a closed mesh, or `pressureMethod: manualPressureSetting`",
            ),
            false if volume < 0.0 => (
                format!("the faces of `{name}` face inwards"),
                "its air is kept inside all the same; drag and push-out see it reversed",
            ),
            _ => return,
        };
        let place = self.scene.source.place(&format!("{name}.{}", attribute.name));
        self.findings.warning(&place, message).help(help);
    }
}

/// A ramp at evenly spaced positions.
fn samples(ramp: &[RampPoint]) -> [f64; ForceField::SAMPLES] {
    std::array::from_fn(|k| ramp_at(ramp, k as f64 / (ForceField::SAMPLES - 1) as f64))
}

/// A ramp at a position: before its first point and behind its last it is constant.
pub(super) fn ramp_at(ramp: &[RampPoint], position: f64) -> f64 {
    let mut points: Vec<RampPoint> = ramp.to_vec();
    points.sort_by(|a, b| a.position.total_cmp(&b.position));
    let next = points.partition_point(|point| point.position <= position);
    let (Some(a), b) = (points.get(next.wrapping_sub(1)).or(points.first()), points.get(next)) else {
        return 0.0;
    };
    let Some(b) = b.filter(|b| b.position > a.position && position > a.position) else { return a.value };
    let share = (position - a.position) / (b.position - a.position);
    let share = match a.interpolation {
        STEP => 0.0,
        LINEAR => share,
        // Smooth and spline: no overshoot.
        _ => share * share * (3.0 - 2.0 * share),
    };
    a.value + (b.value - a.value) * share
}

/// Whether an edge of a surface belongs to one face only.
fn is_open(surface: &Surface) -> bool {
    let sides = |face: &[u32]| {
        let next = face.iter().cycle().skip(1);
        let side = |(&a, &b): (&u32, &u32)| [a.min(b), a.max(b)];
        face.iter().zip(next).map(side).collect::<Vec<_>>()
    };
    let mut edges: Vec<[u32; 2]> = surface.faces.iter().flat_map(sides).collect();
    edges.sort_unstable();
    edges.chunk_by(|a, b| a == b).any(|uses| uses.len() == 1)
}

/// Area of a surface in the square of its unit.
pub(super) fn area(surface: &Surface) -> f64 {
    let corners = |triangle: [u32; 3]| triangle.map(|k| surface.positions[k as usize]);
    surface.faces.triangles().map(corners).map(|[a, b, c]| (b - a).cross(&(c - a)).norm() / 2.0).sum()
}

/// Normals of unit length, weighted by area; zero for a point of no face.
pub(super) fn normals(surface: &Surface) -> Vec<Vector3<f64>> {
    let mut normals = vec![Vector3::zeros(); surface.positions.len()];
    for triangle in surface.faces.triangles() {
        let [a, b, c] = triangle.map(|k| surface.positions[k as usize]);
        let normal = (b - a).cross(&(c - a));
        triangle.iter().for_each(|&k| normals[k as usize] += normal);
    }
    normals.iter().map(|normal| normal.try_normalize(0.0).unwrap_or_default()).collect()
}
