//! Widths that no scene can mean: larger than everything that is there.

use nalgebra::Vector3;
use nucleus_core::MAX_COORDINATE;

use crate::attributes::{Key, n_base, n_cloth, n_particle};
use crate::graph::NodeId;

use super::objects::Compiler;
use super::shaped::Shaped;

/// The attributes that are widths; `true` for those held against the size of the scene. Few particles may well be wider than
/// the space they are in.
static WIDTHS: [(&Key<f64>, bool); 3] =
    [(&n_base::THICKNESS, true), (&n_base::PUSH_OUT_RADIUS, false), (&n_particle::RADIUS, false)];
/// Factors on them, and on which.
static SCALES: [(&Key<f64>, &Key<f64>); 3] = [
    (&n_cloth::SELF_COLLIDE_WIDTH_SCALE, &n_base::THICKNESS),
    (&n_particle::COLLIDE_WIDTH_SCALE, &n_particle::RADIUS),
    (&n_particle::SELF_COLLIDE_WIDTH_SCALE, &n_particle::RADIUS),
];

impl Compiler<'_> {
    /// Keeps in mind how much space objects take at the start.
    pub(super) fn note_extent(&mut self, shaped: &[Shaped]) {
        for point in shaped.iter().flat_map(|shaped| &shaped.surface.positions) {
            let [low, high] = self.bounds.unwrap_or([*point; 2]);
            self.bounds = Some([low.inf(point), high.sup(point)]);
        }
    }

    /// Says so where an object is wider at the start than all objects of its nucleus together.
    pub(super) fn check_widths(&mut self, objects: &[NodeId]) {
        let extent = self.bounds.map_or(0.0, |[low, high]: [Vector3<f64>; 2]| (high - low).norm());
        for &object in objects {
            for (key, is_bounded) in WIDTHS {
                self.check_width(object, key, 1.0, extent, is_bounded);
            }
            for (scale, key) in SCALES {
                let is_bounded = WIDTHS.iter().any(|(width, is_bounded)| width.row == key.row && *is_bounded);
                if self.has(object, key) && self.has(object, scale) {
                    let width = self.start.get(object, key);
                    self.check_width(object, scale, width, extent, is_bounded);
                }
            }
        }
    }

    fn has(&self, object: NodeId, key: &Key<f64>) -> bool {
        self.scene.graph.node(object).node_type().attribute(key.row.name).is_some()
    }

    fn check_width(&mut self, object: NodeId, key: &Key<f64>, factor: f64, extent: f64, is_bounded: bool) {
        let graph = &self.scene.graph;
        if !self.has(object, key) || !graph.is_given(object, key) {
            return;
        }
        let value = self.start.get(object, key);
        let width = value * factor;
        let name = graph.node(object).name();
        let place = self.scene.source.place(&format!("{name}.{}", key.row.name));
        let label = format!("`{}` of `{name}`", key.row.name);
        let help = "widths are in scene units, thickness mostly a hundredth of the object";
        if self.whole.units.length(width) > MAX_COORDINATE {
            let message = format!("{label} is {value:e}, which makes it wider than {MAX_COORDINATE:e} m");
            self.findings.error(&place, message).help(help);
        } else if is_bounded && extent > 0.0 && width > extent {
            let message = format!(
                "{label} is {value}, which makes it wider than all objects together, which take {extent:.3} from corner \
                 to corner"
            );
            self.findings.warning(&place, message).help(help);
        }
    }
}
