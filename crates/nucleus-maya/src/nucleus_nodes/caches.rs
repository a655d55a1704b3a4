//! Recorded results (`playFromCache`): an object whose nCache lies with the scene plays it, as in Maya.
//!
//! Its positions are written as an OBJ file for each frame, in world space. Where the cache is missing, or cannot be played,
//! the object is simulated, and the omissions say so.

use std::fmt::Write;
use std::ops::RangeInclusive;

use nucleus_graph::animation::{Curve, Key, Tangent};
use nucleus_graph::attributes::{Value, n_base, n_cloth, n_particle};
use nucleus_graph::graph::{NodeId as OwnId, Setting};

use crate::animation::Matrix;
use crate::ncache::{CacheChannel, CacheSample, NCache};
use crate::omissions::Cause;
use crate::scene::{NodeId, locate};

use super::importer::Importer;

/// Which frames of a cache a scene plays.
struct Clip {
    /// The frame of the scene at which the source begins, and the first and last frame of the source.
    start: f64,
    source: [f64; 2],
    /// Frames of the scene in one of the source.
    scale: f64,
}

impl Clip {
    /// The frame of the cache at a frame of the scene, if it is played there.
    fn at(&self, frame: f64) -> Option<f64> {
        let [first, last] = self.source;
        let at = first + (frame - self.start) / self.scale;
        (first..=last).contains(&at).then_some(at)
    }
}

impl Importer<'_> {
    /// Lets objects play their caches; an object that cannot is reported.
    pub(super) fn play_caches(&mut self, objects: &[(NodeId, OwnId)]) -> Result<(), String> {
        for &(from, to) in objects {
            let node_type = self.graph.node(to).node_type();
            if self.is_own || !(node_type.is_a(&n_cloth::N_CLOTH) || node_type.is_a(&n_particle::N_PARTICLE))
            {
                continue;
            }
            self.graph.unset(to, &n_base::PLAY_FROM_CACHE.row);
            let Some(cache) = self.cache_of(from) else { continue };
            let name = self.graph.node(to).name().to_owned();
            self.report_cycles(cache);
            let how = match self.play_cache([from, cache], to)? {
                Ok(how) => how,
                Err(why) => format!("it is simulated instead: {why}"),
            };
            self.omissions.add(name, Cause::Cache(how));
        }
        Ok(())
    }

    /// The `cacheFile` node that drives `playFromCache`, directly or by a `cacheBlend`.
    fn cache_of(&self, object: NodeId) -> Option<NodeId> {
        let scene = self.scene;
        let node = scene.source(object, &["pfc", "playFromCache"], None)?.from.node;
        match scene.kind(node) {
            "cacheFile" => Some(node),
            _ => scene.arriving(node).map(|wire| wire.from.node).find(|id| scene.kind(*id) == "cacheFile"),
        }
    }

    /// Writes the positions of a cache, and sets the object to play them. The text says what it plays; else why it does not.
    /// The outer error is that of writing a file.
    fn play_cache(
        &mut self,
        [from, cache]: [NodeId; 2],
        to: OwnId,
    ) -> Result<Result<String, String>, String> {
        let recorded = match self.recorded_frames([from, cache], to) {
            Ok(recorded) => recorded,
            Err(why) => return Ok(Err(why)),
        };
        let stem = format!("{}_cache", self.file_stem(to));
        for (frame, points) in &recorded.frames {
            (self.options.write)(&format!("{stem}.{frame:04}.obj"), obj_text(points))?;
        }
        let file = Value::Text(format!("{stem}.####.obj"));
        self.set(to, &n_base::CACHE_FILE.row, Setting::Fixed(file));
        self.set(to, &n_base::PLAY_FROM_CACHE.row, recorded.switch(self.frames[0]..=self.frames[1]));
        let [first, last] = recorded.ends();
        let name = &recorded.name;
        let without = match last + 1 - first - recorded.frames.len() as i64 {
            0 => String::new(),
            missing => format!(", but simulates {missing} of these, which the cache does not have"),
        };
        Ok(Ok(format!(
            "it plays frames {first} to {last} of `{name}`{without}; `nucleus import --simulate` solves it instead",
        )))
    }

    /// The positions of an object at the frames that its cache has, in world space; else why it cannot be played.
    fn recorded_frames(&self, [from, cache]: [NodeId; 2], to: OwnId) -> Result<Recorded, String> {
        let scene = self.scene;
        if !scene.switch_or(cache, &["e", "en", "enb", "enable"], true) {
            return Err("its cache is switched off".to_owned());
        }
        let text = |names: &[&str]| scene.string(cache, names).unwrap_or_default();
        let (name, folder) = (text(&["cn", "cacheName"]), text(&["cp", "cachePath"]));
        // A name is no path.
        let name = name.rsplit(['/', '\\']).next().unwrap_or_default().to_owned();
        let compare = format!("`nucleus diff` compares the run with `{name}.xml`");
        if self.options.simulate {
            return Err(format!("`--simulate` says so; {compare}"));
        }
        let path = format!("{}/{name}.xml", folder.trim_end_matches(['/', '\\']));
        let scene_file = scene.texts.first().map(|text| text.path.clone()).unwrap_or_default();
        let found = locate(&scene_file, &path, "xml").ok_or_else(|| {
            format!("there is no `{name}.xml` in `{folder}`, or beside the scene; {compare}")
        })?;
        let read = NCache::read(&found).map_err(|error| error.to_string())?;
        let clip = self.clip(cache);
        let mut frames: Vec<(i64, Vec<[f64; 3]>)> = Vec::new();
        for frame in self.frames[0]..=self.frames[1] {
            let Some(at) = clip.at(frame as f64) else { continue };
            frames.extend(self.positions(&read, from, at, frame as f64).map(|points| (frame, points)));
        }
        let counts = frames.windows(2).find(|pair| pair[1].1.len() < pair[0].1.len());
        if let Some(pair) = counts {
            return Err(format!("points of `{name}` die at frame {}; {compare}", pair[1].0));
        }
        if frames.is_empty() {
            return Err(format!("`{name}` has no positions of it at the frames of the scene; {compare}"));
        }
        let is_cloth = self.graph.node(to).node_type().is_a(&n_cloth::N_CLOTH);
        let points = self.points_of(to).filter(|_| is_cloth);
        match points.filter(|points| frames.iter().any(|(_, all)| all.len() != *points)) {
            Some(points) => {
                Err(format!("`{name}` has {} points, its mesh {points}; {compare}", frames[0].1.len()))
            }
            None => Ok(Recorded { name, frames }),
        }
    }

    /// Notes what a cache plays outside of its range, or backwards, which is not carried out.
    fn report_cycles(&mut self, cache: NodeId) {
        let names: [&[&str]; 4] = [
            &["hold", "h", "ho", "hld"],
            &["preCycle", "prc", "prec"],
            &["postCycle", "poc", "posc"],
            &["reverse", "r", "rev"],
        ];
        for names in names.into_iter().filter(|names| self.scene.stored_or(cache, names, 0.0) != 0.0) {
            let what = format!("{}.{}", self.scene.name(cache), names[0]);
            self.omissions.add(what, Cause::CacheRange);
        }
    }

    /// A file leaves out values at Maya's default, which is 0; without a source range its frames are those of the scene.
    fn clip(&self, cache: NodeId) -> Clip {
        let stored = |names: [&str; 2]| self.scene.stored(cache, &names);
        let first = stored(["ss", "sourceStart"]).unwrap_or(0.0);
        let last = if first < 0.0 { 0.0 } else { f64::MAX };
        Clip {
            start: stored(["sf", "startFrame"]).unwrap_or(0.0),
            source: [first, stored(["se", "sourceEnd"]).unwrap_or(last)],
            scale: stored(["sc", "scale"]).filter(|scale| *scale > 0.0).unwrap_or(1.0),
        }
    }

    /// The positions of an object in world space: `at` is the frame of the cache, `frame` that of the scene.
    ///
    /// Between samples they are interpolated linearly, as in Maya, if both have as many points.
    fn positions(&self, cache: &NCache, object: NodeId, at: f64, frame: f64) -> Option<Vec<[f64; 3]>> {
        let channel = self.channel_of(cache, object)?;
        let is_particle = self.scene.kind(object) == "nParticle";
        let of = |sample| recorded(sample, channel, is_particle);
        let (points, is_world) = match cache.sample_at(at) {
            Some(sample) => of(sample).map(|(points, is_world)| (points.to_vec(), is_world))?,
            None => {
                let ([before, after], share) = cache.samples_around(at)?;
                let ((a, is_world), (b, is_same)) = (of(before)?, of(after)?);
                (a.len() == b.len() && is_world == is_same).then(|| (mixed(a, b, share), is_world))?
            }
        };
        let space = if is_world { Matrix::IDENTITY } else { self.space_of(object, frame) };
        Some(points.into_iter().map(|point| space.point(point)).collect())
    }

    /// The object of a cache whose positions an object plays.
    fn channel_of<'c>(&self, cache: &'c NCache, object: NodeId) -> Option<&'c str> {
        let names = cache.objects();
        let own = self.scene.name(object).rsplit(':').next().unwrap_or_default();
        let is_own = |name: &&&str| name.rsplit(':').next() == Some(own);
        names.iter().find(is_own).or(names.first().filter(|_| names.len() == 1)).copied()
    }

    /// The space of recorded positions: that of particles, that of the mesh that shows a cloth, or the world.
    fn space_of(&self, object: NodeId, frame: f64) -> Matrix {
        let scene = self.scene;
        if scene.kind(object) == "nParticle" {
            return self.values.world(object, frame);
        }
        let is_local = scene.switch_or(object, &["lsou", "localSpaceOutput"], false);
        let is_output =
            |wire: &crate::scene::Wire| matches!(scene.path(wire.from).last().name, "omsh" | "outputMesh");
        let shown = scene.leaving(object).find(is_output).filter(|_| is_local);
        shown.map_or(Matrix::IDENTITY, |wire| self.values.world(wire.to.node, frame))
    }
}

/// The positions of an object in a sample, and whether they are in world space whatever the object's own space is.
fn recorded<'c>(sample: &'c CacheSample, object: &str, is_particle: bool) -> Option<(&'c [[f64; 3]], bool)> {
    let part = |part: &str| sample.channel(&format!("{object}_{part}"));
    if let (true, Some(points)) = (is_particle, part("worldPosition").and_then(CacheChannel::vectors)) {
        return Some((points, true));
    }
    // Before the first birth a cache has a count alone.
    if is_particle && part("position").is_none() && part("count").is_some_and(|one| one.vectors().is_none()) {
        return Some((&[], true));
    }
    Some((sample.positions(object)?, false))
}

/// Points between two samples.
fn mixed(before: &[[f64; 3]], after: &[[f64; 3]], share: f64) -> Vec<[f64; 3]> {
    let mix = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * share);
    before.iter().zip(after).map(mix).collect()
}

/// Recorded positions in world space, by frame of the scene.
struct Recorded {
    name: String,
    frames: Vec<(i64, Vec<[f64; 3]>)>,
}

impl Recorded {
    /// The first and the last frame.
    fn ends(&self) -> [i64; 2] {
        [0, self.frames.len().saturating_sub(1)].map(|at| self.frames.get(at).map_or(0, |(frame, _)| *frame))
    }

    /// `playFromCache`: on throughout, or at the frames that there are.
    fn switch(&self, frames: RangeInclusive<i64>) -> Setting {
        let has = |frame: i64| self.frames.binary_search_by_key(&frame, |(own, _)| *own).is_ok();
        let mut keys: Vec<Key> = Vec::new();
        for frame in frames {
            let value = f64::from(u8::from(has(frame)));
            if keys.last().is_none_or(|key| key.value != value) {
                keys.push(Key { frame: frame as f64, value, tangent: Tangent::Stepped });
            }
        }
        match Curve::new(keys) {
            Ok(curve) if !curve.is_constant() => Setting::Keyed(curve),
            _ => Setting::Fixed(Value::Bool(true)),
        }
    }
}

/// The points as an OBJ file without faces.
fn obj_text(points: &[[f64; 3]]) -> String {
    let mut text = String::new();
    for [x, y, z] in points {
        _ = writeln!(text, "v {x} {y} {z}");
    }
    text
}
