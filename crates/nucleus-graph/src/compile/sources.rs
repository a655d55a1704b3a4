//! Sources of a frame's input: the nodes that each object and constraint is evaluated from, and constants fixed at
//! compile time.

use std::sync::Arc;

use nalgebra::Vector3;
use nucleus_core::{ClothId, PointId};

use crate::graph::NodeId;
use crate::paint::Texture;

use super::animated_mesh::{AnimatedMesh, Points};
use super::constraints::split_mesh::Tearing;

/// Source of the frames of a cloth or of particles.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ClothSource {
    pub(super) node: NodeId,
    /// Particles are a cloth of points alone (N1.1-4).
    pub(super) is_particles: bool,
    /// Thickness where `thickness` is not given, in scene units.
    pub(super) default_thickness: f64,
    /// Whether the edge length limits `default_thickness`.
    pub(super) is_dense: bool,
    /// The uniform vertex maps.
    pub(super) scales: MapScales,
    /// How many faces it has.
    pub(super) faces: usize,
    /// Its area at rest in m².
    pub(super) area: f64,
    /// The live input mesh, where anything follows it.
    pub(super) followed: Option<FollowedMesh>,
    /// How its mesh is split, where it can tear.
    pub(super) tearing: Option<Tearing>,
    /// The recorded positions that it plays, where it plays any.
    pub(super) recorded: Option<RecordedPoints>,
}

/// The live input mesh of a cloth that follows it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FollowedMesh {
    pub(super) mesh: NodeId,
    pub(super) shape: AnimatedMesh,
    /// Factors on the attraction, by point; empty where they are uniform.
    pub(super) factors: Vec<f64>,
}

/// Source of the frames of a collider.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ColliderSource {
    pub(super) node: NodeId,
    pub(super) mesh: NodeId,
    /// Thickness where `thickness` is not given, in scene units.
    pub(super) default_thickness: f64,
    /// Its points in mesh space, in scene units; `None` if it never moves.
    pub(super) motion: Option<AnimatedMesh>,
}

/// Source of the pins of a transform constraint.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AttachmentSource {
    pub(super) constraint: NodeId,
    pub(super) points: Vec<AttachedPoint>,
    /// Whether the transform of the constraint is ever animated.
    pub(super) moves: bool,
}

/// A point that a transform constraint holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AttachedPoint {
    pub(super) cloth: ClothId,
    pub(super) point: PointId,
    /// Initial position in metres.
    pub(super) start: Vector3<f64>,
}

/// An emitter of one object of particles.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Emitter {
    /// Its node.
    pub(super) node: NodeId,
    /// The node of the particles, and their object.
    pub(super) particles: NodeId,
    pub(super) cloth: ClothId,
    /// The mesh that it emits from.
    pub(super) mesh: Option<EmittingMesh>,
    /// Which of the object's emitters it is.
    pub(super) place: u64,
}

/// A mesh that an emitter emits from.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct EmittingMesh {
    pub(super) mesh: NodeId,
    pub(super) shape: AnimatedMesh,
    pub(super) triangles: Vec<[u32; 3]>,
    /// The share of the rate at each place; `None` where it is all of it.
    pub(super) rate: Option<Arc<RateMap>>,
}

/// The share of the rate of an emitter at each place of a mesh: a texture.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RateMap {
    pub(super) texture: Texture,
    /// Texture coordinates of the corners of each triangle.
    pub(super) uvs: Vec<[[f64; 2]; 3]>,
    pub(super) emits_from_dark: bool,
}

impl RateMap {
    /// The share of the rate, from 0 to 1, at a place in a triangle.
    pub(super) fn at(&self, triangle: usize, weights: [f64; 3]) -> f64 {
        let corners = &self.uvs[triangle];
        let along = |axis: usize| corners.iter().zip(weights).map(|(uv, weight)| uv[axis] * weight).sum();
        let value = self.texture.at([along(0), along(1)]);
        if self.emits_from_dark { 1.0 - value } else { value }
    }
}

/// The state of an emitter from frame to frame.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct EmitterState {
    /// Particles emitted so far.
    pub(crate) emitted: u64,
    /// Part of the next particle, 0 to 1.
    pub(crate) remainder: f64,
}

/// A field, and the objects that it acts on, each with its node.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FieldSource {
    pub(super) node: NodeId,
    pub(super) targets: Vec<(ClothId, NodeId)>,
}

/// Factors on the attributes of a cloth from vertex maps that are uniform.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MapScales {
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
    pub(super) input_attract: f64,
    pub(super) rigidity: f64,
    pub(super) deform: f64,
    pub(super) angle_dropoff: f64,
    pub(super) restitution_angle: f64,
    pub(super) field_magnitude: f64,
}

impl MapScales {
    /// Without vertex maps.
    pub(super) const ONE: Self = Self {
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
        input_attract: 1.0,
        rigidity: 1.0,
        deform: 1.0,
        angle_dropoff: 1.0,
        restitution_angle: 1.0,
        field_magnitude: 1.0,
    };
}

/// Recorded positions of an object in metres.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RecordedPoints {
    pub(super) first: i64,
    /// The positions from the first frame on; nothing where the object is solved.
    pub(super) frames: Vec<Option<Points>>,
}

impl RecordedPoints {
    /// The points at a frame, linear between two whole ones; nothing where one of both is not played.
    pub(super) fn at(&self, frame: f64) -> Option<Points> {
        let before = frame.floor();
        let at = |frame: f64| self.frames.get(usize::try_from(frame as i64 - self.first).ok()?)?.clone();
        let from = at(before)?;
        if frame == before {
            return Some(from);
        }
        let to = at(before + 1.0)?;
        let share = frame - before;
        Some(from.iter().zip(to.iter()).map(|(a, b)| a + (b - a) * share).collect())
    }

    /// The largest number of points.
    pub(super) fn most(&self) -> usize {
        self.frames.iter().flatten().map(|points| points.len()).max().unwrap_or_default()
    }

    /// Splits the points as the mesh is split.
    pub(super) fn extend(&mut self, tearing: &Tearing) {
        for points in self.frames.iter_mut().flatten() {
            let mut all = points.to_vec();
            tearing.extend(&mut all);
            *points = all.into();
        }
    }
}
