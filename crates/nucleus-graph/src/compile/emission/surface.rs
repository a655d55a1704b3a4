//! Emission from the surface of a mesh, which the emitter has as its parent.

use std::sync::Arc;

use nalgebra::Vector3;

use crate::animation::sin_cos_degrees;
use crate::attributes::{n_base, n_cloth, point_emitter, surface_shape};
use crate::compile::compiler::Compiler;
use crate::compile::geometry::placed_faces;
use crate::compile::sources::{EmittingMesh, RateMap};
use crate::graph::{EvalContext, NodeId};
use crate::mesh::doubled_area;

use super::random::Random;
use super::start::{Speed, Start, turned_to};

type Vec3 = Vector3<f64>;

impl Compiler<'_> {
    /// The mesh of a surface emitter; `None` after an error, which is reported.
    pub(super) fn emitting_surface(&mut self, emitter: NodeId) -> Option<EmittingMesh> {
        let graph = &self.scene.graph;
        let node = graph.node(emitter);
        let is_mesh = |id: &NodeId| graph.node(*id).node_type().is_a(&surface_shape::SURFACE_SHAPE);
        let place = self.scene.source.place(&format!("{}.emitterType", node.name()));
        let Some(mesh) = node.parent().filter(is_mesh) else {
            let message = format!("`{}` emits from a surface, and no mesh is its parent", node.name());
            self.findings.error(&place, message).help("name the mesh: `parent: \"plane\"`");
            return None;
        };
        if self.broken.contains(&mesh) {
            return None;
        }
        let feeds = |cloth: &NodeId| graph.source(*cloth, &n_base::INPUT_MESH) == Some(mesh);
        if let Some(cloth) = graph.of_type(&n_cloth::N_CLOTH).map(|(cloth, _)| cloth).find(feeds) {
            let [mesh, cloth] = [mesh, cloth].map(|id| graph.node(id).name());
            let message = format!(
                "`{}` emits from `{mesh}` where it is animated, and not where the cloth `{cloth}` goes",
                node.name()
            );
            let warning = self.findings.warning(&place, message);
            warning.help("nothing emits from simulated cloth yet: emit from a mesh that moves with it");
        }
        let shape = self.geometry.animated(self.scene, mesh, self.findings)?;
        let faces = self.geometry.surface(self.scene, mesh, self.findings)?.faces.clone();
        let triangles = placed_faces(&faces, &self.start.placement(mesh)).triangles().collect();
        let rate = self.rate_map(emitter, mesh, &faces)?.map(Arc::new);
        let emitting = EmittingMesh { mesh, shape, triangles, rate };
        let area = emitting.area(&self.start);
        if area.is_nan() || area <= 0.0 {
            let name = graph.node(mesh).name();
            let message = format!("`{}` emits from `{name}`, which has no area", node.name());
            self.findings.error(&place, message).help("give the mesh faces, or use `emitterType: Omni`");
            return None;
        }
        Some(emitting)
    }
}

impl EmittingMesh {
    /// Its area at a time, in square scene units.
    pub(super) fn area(&self, moment: &EvalContext) -> f64 {
        let points = self.points(moment);
        self.triangles.iter().map(|corners| doubled_area(&points, *corners).norm() / 2.0).sum()
    }

    fn points(&self, moment: &EvalContext) -> Vec<Vec3> {
        let placement = moment.placement(self.mesh);
        self.shape.at(moment).iter().map(|point| placement.point(*point)).collect()
    }

    /// The surface in an interval, from its start to its end.
    pub(super) fn patches(&self, emitter: NodeId, [from, to]: [&EvalContext; 2]) -> Patches {
        let ends = [self.points(from), self.points(to)];
        let mut sums = Vec::with_capacity(self.triangles.len());
        let mut sum = 0.0;
        for &corners in &self.triangles {
            sum += doubled_area(&ends[1], corners).norm();
            sums.push(sum);
        }
        let get = |key| to.get(emitter, key);
        let least = get(&point_emitter::MIN_DISTANCE).max(0.0);
        Patches {
            ends,
            triangles: self.triangles.clone(),
            rate: self.rate.clone(),
            sums,
            normal: get(&point_emitter::NORMAL_SPEED),
            tangent: get(&point_emitter::TANGENT_SPEED),
            distance: [least, get(&point_emitter::MAX_DISTANCE).max(least)],
            speed: Speed::new(emitter, to),
        }
    }
}

/// A surface in an interval.
pub(super) struct Patches {
    /// World positions at both ends, in scene units.
    ends: [Vec<Vec3>; 2],
    triangles: Vec<[u32; 3]>,
    /// The share of the rate at each place; `None` where it is all of it.
    rate: Option<Arc<RateMap>>,
    /// Twice the area up to each triangle.
    sums: Vec<f64>,
    normal: f64,
    tangent: f64,
    distance: [f64; 2],
    speed: Speed,
}

impl Patches {
    /// The start of a particle, evenly spread over the area; `None` where there is none, and where
    /// the rate map leaves it out.
    pub(super) fn draw(&self, time: f64, seconds: f64, random: &mut Random) -> Option<Start> {
        let all = *self.sums.last().filter(|sum| **sum > 0.0)?;
        let drawn = random.next() * all;
        let triangle = self.sums.partition_point(|sum| *sum <= drawn).min(self.triangles.len() - 1);
        let corners = self.triangles[triangle];
        // Evenly spread over a triangle: fold the unit square along its diagonal.
        let (u, v) = (random.next(), random.next());
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let weights = [1.0 - u - v, u, v];
        if let Some(rate) = &self.rate
            && random.next() >= rate.at(triangle, weights)
        {
            return None;
        }
        let at = |points: &[Vec3]| -> Vec3 {
            corners.iter().zip(weights).map(|(&corner, weight)| points[corner as usize] * weight).sum()
        };
        let [from, to] = [at(&self.ends[0]), at(&self.ends[1])];
        let placed = corners.map(|corner| {
            let [from, to] = self.ends.each_ref().map(|points| points[corner as usize]);
            from + (to - from) * time
        });
        let normal = doubled_area(&placed, [0, 1, 2]).try_normalize(0.0).unwrap_or_default();
        let around = turned_to(normal, flat(random));
        let own = (normal * self.normal + around * self.tangent) * self.speed.draw(random);
        let distance = random.between(self.distance[0], self.distance[1]);
        Some(Start {
            position: from + (to - from) * time + normal * distance,
            velocity: own,
            carried: (to - from) / seconds,
        })
    }
}

/// A direction across +z.
fn flat(random: &mut Random) -> Vec3 {
    let (sin, cos) = sin_cos_degrees(random.between(0.0, 360.0));
    Vec3::new(cos, sin, 0.0)
}
