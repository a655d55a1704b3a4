//! The input mesh of a cloth: what it attracts and locks, and the shape at rest where that is not the input mesh.

use std::collections::BTreeSet;

use nalgebra::Vector3;
use nucleus_core::{ClothId, InputAttract, InputMesh, Pin, PointId, Surface};

use crate::attributes::{Choice, Key, n_cloth, particle};
use crate::graph::{EvalContext, NodeId};

use super::compiler::Compiler;
use super::map_values::MapOfCloth;
use super::program::EvaluationInterval;
use super::sources::{ClothSource, FollowedMesh};
use super::vertex_maps::WRINKLE;

/// `inputAttractMethod: lockValuesOf10OrGreater`.
const LOCKS: Choice = Choice(1);

impl EvaluationInterval<'_> {
    /// How a cloth is drawn to its input mesh.
    pub(super) fn input_attract(&self, source: &ClothSource) -> InputAttract {
        let number = |key: &Key<f64>| self.to.get(source.node, key);
        InputAttract {
            strength: number(&n_cloth::INPUT_MESH_ATTRACT) * source.scales.input_attract,
            damp: number(&n_cloth::INPUT_ATTRACT_DAMP),
            motion_drag: number(&n_cloth::INPUT_MOTION_DRAG),
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
        let held: BTreeSet<_> = pins.iter().map(|pin| (pin.cloth, pin.point)).collect();
        for (cloth, source) in (0..).map(ClothId).zip(&self.nucleus.cloths) {
            let Some(followed) = &source.followed else { continue };
            let is_dynamic = !self.rests(source);
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

    /// Whether an object is not dynamic: cloth follows its input mesh, and particles stay where they are.
    pub(super) fn rests(&self, source: &ClothSource) -> bool {
        !self.to.get(source.node, &particle::IS_DYNAMIC)
    }

    /// The points of an input mesh in metres.
    fn followed_points(
        &self,
        source: &ClothSource,
        followed: &FollowedMesh,
        moment: &EvalContext,
    ) -> Vec<Vector3<f64>> {
        let (placement, points) = (moment.placement(followed.mesh), followed.shape.at(moment));
        let mut points: Vec<Vector3<f64>> = self.nucleus.units.placed(&placement, &points);
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
            let faces = self.geometry.surface(self.scene, source, self.findings)?.faces.clone();
            let of_input = &self.geometry.surface(self.scene, mesh, self.findings)?.faces;
            if shape.len() != input.positions.len() || faces != *of_input {
                let [name, source] = [cloth, source].map(|id| self.scene.graph.node(id).name());
                let place = self.scene.source.place(&format!("{name}.restShapeMesh"));
                let message = format!(
                    "`{source}` cannot be the rest shape of `{name}`: it has {} points and {} faces, the input mesh {} and {}",
                    shape.len(),
                    faces.len(),
                    input.positions.len(),
                    input.faces.len()
                );
                let error = self.findings.error(&place, message);
                error.help("a rest shape has the points and faces of the input mesh, elsewhere");
                return None;
            }
            self.warn_of_moving_rest_shape(cloth, source);
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
}

impl Compiler<'_> {
    /// Warns of a rest shape that changes size or form: it is read at the start. Translation and rotation change no length.
    fn warn_of_moving_rest_shape(&mut self, cloth: NodeId, source: NodeId) {
        let is_fixed = self.geometry.is_fixed(self.scene, source, self.findings);
        let graph = &self.scene.graph;
        if is_fixed && !graph.changes_size(source) {
            return;
        }
        let [name, source] = [cloth, source].map(|id| graph.node(id).name());
        let place = self.scene.source.place(&format!("{name}.restShapeMesh"));
        let message = format!(
            "`{name}` rests in the shape of `{source}` at the start, and does not follow its changes"
        );
        let help = "key `restLengthScale` to change the size at rest";
        self.findings.warning(&place, message).help(help);
    }
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
