//! Objects that play recorded positions in place of being solved (`playFromCache`), in SI units.
//!
//! A file for each frame holds the positions of all points in world space. Where the attribute is on, pins move the points
//! from frame to frame: other objects collide with them and are moved by them, and nothing pushes them. Where it goes off,
//! the object is solved on from there with the velocities of its last three samples, to second order.
//!
//! Particles are born at the frame in which a file has more of them; an empty file, or an OBJ object without vertices, has
//! none. A file that has fewer is an error: positions alone do not tell which of them died.

use nalgebra::Vector3;
use nucleus_core::{Birth, ClothId, MAX_COORDINATE, Pin, PointId, StartVelocity};

use crate::attributes::{n_base, nucleus};
use crate::graph::NodeId;
use crate::memory;

use super::animated_mesh::{NumberedFile, Points};
use super::compiler::Compiler;
use super::program::EvaluationInterval;
use super::sources::{ClothSource, RecordedPoints};

impl Compiler<'_> {
    /// Whether an object plays recorded positions at the start frame.
    pub(super) fn plays_from_start(&self, object: NodeId) -> bool {
        self.start.get(object, &n_base::PLAY_FROM_CACHE)
    }

    /// The recorded positions that an object plays, or `Some(None)` if it is solved throughout; `None` after an error, which
    /// is reported. `mesh` is the mesh of a cloth and the number of its points.
    pub(super) fn recorded(
        &mut self,
        object: NodeId,
        mesh: Option<(NodeId, usize)>,
    ) -> Option<Option<RecordedPoints>> {
        let (graph, key) = (&self.scene.graph, &n_base::PLAY_FROM_CACHE);
        if !graph.changes(object, key) && !self.plays_from_start(object) {
            return Some(None);
        }
        let first = self.program.start;
        let mut frames: Vec<Option<Points>> = Vec::new();
        for frame in first..=self.scene.time.end.max(first) {
            if !graph.at(frame as f64).get(object, key) {
                frames.push(None);
                continue;
            }
            let before = frames.last().and_then(|points| points.as_ref()).map_or(0, |points| points.len());
            match self.recorded_points(object, frame, (mesh, before)) {
                Ok(points) => frames.push(Some(points)),
                Err(message) => {
                    let row = match graph.is_given(object, &n_base::CACHE_FILE) {
                        true => &n_base::CACHE_FILE.row,
                        false => &key.row,
                    };
                    let error = self.findings.error(&self.place(object, row), message);
                    error.help(
                        "`nucleus import cache.xml -o points` makes the files of an nCache; without `playFromCache` the \
                         object is solved",
                    );
                    return None;
                }
            }
        }
        Some(Some(RecordedPoints { first, frames }))
    }

    /// The positions of an object at a frame in metres; else the reason why there are none. `before` is their number in the
    /// frame before.
    fn recorded_points(
        &mut self,
        object: NodeId,
        frame: i64,
        (mesh, before): (Option<(NodeId, usize)>, usize),
    ) -> Result<Points, String> {
        let vectors = self.recorded_file(object, frame)?;
        let (name, count) = (self.scene.graph.node(object).name(), vectors.len());
        match mesh {
            Some((mesh, points)) if points != count => {
                let mesh = self.scene.graph.node(mesh).name();
                return Err(format!(
                    "the cache of `{name}` has {count} points at frame {frame}, but `{mesh}` has {points}"
                ));
            }
            None if count < before => {
                return Err(format!(
                    "the cache of `{name}` has {count} particles at frame {frame} after {before}: deaths are not played"
                ));
            }
            _ => {}
        }
        let claimed = self.geometry.budget.claim(count as u64 * memory::SHAPE_POINT);
        claimed.map_err(|refused| format!("the cache of `{name}` takes {refused}"))?;
        let points: Points =
            vectors.into_iter().map(|vector| self.program.units.point(vector.into())).collect();
        match points.iter().position(|point: &Vector3<f64>| point.amax() > MAX_COORDINATE) {
            Some(at) => Err(format!(
                "the cache of `{name}` is more than {MAX_COORDINATE:e} m at point {at} of frame {frame}"
            )),
            None => Ok(points),
        }
    }

    /// The recorded positions of an object at a frame in scene units; else the reason why they cannot be read.
    pub(super) fn recorded_file(&self, object: NodeId, frame: i64) -> Result<Vec<[f64; 3]>, String> {
        let node = self.scene.graph.node(object);
        let file = node.get(&n_base::CACHE_FILE);
        if file.is_empty() {
            return Err(format!("`{}` plays a cache, but has no `cacheFile`", node.name()));
        }
        match NumberedFile::new(&file) {
            Some(numbered) => {
                let file = numbered.at(frame);
                let about = std::fs::metadata(self.scene.source.path(&file));
                // An empty file: no particles.
                if about.is_ok_and(|about| about.is_file() && about.len() == 0) {
                    return Ok(Vec::new());
                }
                self.vectors_of_file(&file)
            }
            None => {
                Err(format!("`cacheFile` of `{}` has no `####` in place of the frame: `{file}`", node.name()))
            }
        }
    }

    /// A collider moves with its mesh.
    pub(super) fn warn_of_recorded_collider(&mut self, collider: NodeId, mesh: NodeId) {
        let graph = &self.scene.graph;
        if graph.node(collider).setting(&n_base::PLAY_FROM_CACHE).is_none() {
            return;
        }
        let [name, mesh] = [collider, mesh].map(|id| graph.node(id).name());
        let message =
            format!("`playFromCache` of `{name}` has no effect: a collider moves with its mesh `{mesh}`");
        let place = self.place(collider, &n_base::PLAY_FROM_CACHE.row);
        let warning = self.findings.warning(&place, message);
        warning.help("give the mesh a file for each frame: `file: \"points/collider.####.obj\"`");
    }
}

impl EvaluationInterval<'_> {
    /// Whether an object plays recorded positions in the interval.
    pub(super) fn plays(&self, source: &ClothSource) -> bool {
        source.recorded.is_some() && self.to.get(source.node, &n_base::PLAY_FROM_CACHE)
    }

    /// The recorded positions of an object at both ends of the interval; those at the start only if they were played before.
    fn recorded_ends(&self, source: &ClothSource) -> Option<(Option<Points>, Points)> {
        let recorded = source.recorded.as_ref().filter(|_| self.plays(source))?;
        Some((recorded.at(self.from.frame()), recorded.at(self.to.frame())?))
    }

    /// Pins all points of the objects that play recorded positions. One that begins to do so moves there from `position`.
    pub(super) fn play_recorded(
        &self,
        pins: &mut Vec<Pin>,
        position: &dyn Fn(ClothId, PointId) -> Vector3<f64>,
    ) {
        for (cloth, source) in (0..).map(ClothId).zip(&self.nucleus.cloths) {
            let Some((from, to)) = self.recorded_ends(source) else { continue };
            pins.retain(|pin| pin.cloth != cloth);
            let known = from.as_ref().map_or(to.len(), |from| from.len());
            for (point, &end) in (0..).map(PointId).zip(&to[..known.min(to.len())]) {
                let start = from.as_ref().map_or_else(|| position(cloth, point), |from| from[point.index()]);
                pins.push(Pin { cloth, point, start, end });
            }
        }
    }

    /// The velocities of objects whose playback has ended with the interval before. The pins there leave the mean velocity of
    /// that interval, which is half an interval old; the parabola through three samples has the one at its end.
    pub(super) fn velocities_after_playback(&self) -> Vec<StartVelocity> {
        let (from, length) = (self.from.frame(), self.to.frame() - self.from.frame());
        let seconds = self.from.get(self.nucleus.node, &nucleus::TIME_SCALE) * length / self.fps;
        let mut velocities = Vec::new();
        if self.is_discontinuous || seconds <= 0.0 {
            return velocities;
        }
        for (cloth, source) in (0..).map(ClothId).zip(&self.nucleus.cloths) {
            let Some(recorded) = source.recorded.as_ref().filter(|_| !self.plays(source)) else { continue };
            let samples = [0.0, 1.0, 2.0].map(|back| recorded.at(from - back * length));
            let [Some(now), Some(last), Some(before)] = samples else { continue };
            let known = now.iter().zip(last.iter()).zip(before.iter());
            velocities.extend((0..).map(PointId).zip(known).map(|(point, ((now, last), before))| {
                let acceleration = (now - last * 2.0 + before) / (seconds * seconds);
                let velocity = (now - last) / seconds + acceleration * (seconds / 2.0);
                StartVelocity { cloth, point, velocity, acceleration }
            }));
        }
        velocities
    }

    /// Adds the particles of which a recording has more at the end of the interval than at its start.
    pub(super) fn recorded_births(&self, births: &mut Vec<Birth>) {
        for (cloth, source) in (0..).map(ClothId).zip(&self.nucleus.cloths) {
            let Some((Some(from), to)) = self.recorded_ends(source).filter(|_| source.is_particles) else {
                continue;
            };
            let born = |&position: &Vector3<f64>| Birth {
                cloth,
                time: 1.0,
                position,
                velocity: Vector3::zeros(),
                lifespan: f64::INFINITY,
            };
            births.extend(to.iter().skip(from.len()).map(born));
        }
    }
}
