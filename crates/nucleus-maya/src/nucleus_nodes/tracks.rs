//! Caches that an object plays: one, or a blend of several.

use std::collections::BTreeMap;

use crate::animation::Matrix;
use crate::ncache::{CacheChannel, CacheSample, NCache};
use crate::scene::{NodeId, PlugRef, Wire, locate};

use super::importer::Importer;

/// A `cacheFile`, and the `cacheBlend` that weighs it with its index there.
#[derive(Debug, Clone, Copy)]
pub(super) struct CacheInput {
    pub(super) cache: NodeId,
    pub(super) blend: Option<(NodeId, u32)>,
}

/// A cache that is read.
pub(super) struct Track {
    pub(super) name: String,
    input: CacheInput,
    recording: NCache,
    clip: Clip,
}

/// The caches that can be read, and why others cannot.
pub(super) struct Tracks {
    pub(super) all: Vec<Track>,
    pub(super) unread: Vec<String>,
}

/// Positions at a frame.
pub(super) struct Blended {
    pub(super) points: Vec<[f64; 3]>,
    /// Whether caches of other points, or without a sample, are left out.
    pub(super) is_alone: bool,
}

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
    /// The `cacheFile` nodes that drive `playFromCache`, directly or by a `cacheBlend`, in the order of its indices.
    pub(super) fn caches_of(&self, object: NodeId) -> Vec<CacheInput> {
        let scene = self.scene;
        let Some(wire) = scene.source(object, &["pfc", "playFromCache"], None) else { return Vec::new() };
        let node = wire.from.node;
        if scene.kind(node) == "cacheFile" {
            return vec![CacheInput { cache: node, blend: None }];
        }
        let index = |wire: &Wire| scene.path(wire.to).segments().last()?.range.map(|range| range.0);
        let outer = |wire: &Wire| scene.path(wire.to).segments().next()?.range.map(|range| range.0);
        let mut found: BTreeMap<NodeId, u32> = BTreeMap::new();
        for wire in scene.arriving(node).filter(|wire| scene.kind(wire.from.node) == "cacheFile") {
            // `cd[i].ra` and `inc[k].vin[i]` name the same cache.
            found.entry(wire.from.node).or_insert(index(&wire).or(outer(&wire)).unwrap_or(0));
        }
        let mut all: Vec<(u32, NodeId)> = found.into_iter().map(|(cache, index)| (index, cache)).collect();
        all.sort();
        all.into_iter().map(|(index, cache)| CacheInput { cache, blend: Some((node, index)) }).collect()
    }

    /// The name of a cache, which is no path.
    pub(super) fn name_of(&self, input: &CacheInput) -> String {
        let name = self.scene.string(input.cache, &["cn", "cacheName"]).unwrap_or_default();
        name.rsplit(['/', '\\']).next().unwrap_or_default().to_owned()
    }

    /// Reads caches.
    ///
    /// # Errors
    /// Why none of them can be played.
    pub(super) fn tracks(&self, inputs: &[CacheInput]) -> Result<Tracks, String> {
        let is_on = |input: &&CacheInput| {
            let is_blended = |node| !self.scene.switch_or(node, &["da", "disableAll"], false);
            self.scene.switch_or(input.cache, &["e", "en", "enb", "enable"], true)
                && input.blend.is_none_or(|(node, _)| is_blended(node))
        };
        let (mut all, mut unread) = (Vec::new(), Vec::new());
        for input in inputs.iter().filter(is_on) {
            match self.track(*input) {
                Ok(track) => all.push(track),
                Err(why) => unread.push(why),
            }
        }
        match (all.is_empty(), unread.first()) {
            (false, _) => Ok(Tracks { all, unread }),
            (true, Some(why)) => Err(why.clone()),
            (true, None) => Err("its cache is switched off".to_owned()),
        }
    }

    fn track(&self, input: CacheInput) -> Result<Track, String> {
        let scene = self.scene;
        let name = self.name_of(&input);
        let folder = scene.string(input.cache, &["cp", "cachePath"]).unwrap_or_default();
        let path = format!("{}/{name}.xml", folder.trim_end_matches(['/', '\\']));
        let scene_file = scene.texts.first().map(|text| text.path.clone()).unwrap_or_default();
        let found = locate(&scene_file, &path, "xml").ok_or_else(|| {
            format!(
                "there is no `{name}.xml` in `{folder}`, or beside the scene; \
                 `nucleus diff` compares the run with `{name}.xml`"
            )
        })?;
        let recording = NCache::read(&found).map_err(|error| error.to_string())?;
        Ok(Track { name, input, recording, clip: self.clip(input.cache) })
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

    /// The mean of the caches that play at a frame of the scene, by their weights, whose sum Maya scales to 1. Caches with
    /// other points, or without a sample, are not blended: then the heaviest plays alone.
    pub(super) fn blended(&self, tracks: &[Track], object: NodeId, frame: f64) -> Option<Blended> {
        let mut playing: Vec<(f64, Vec<[f64; 3]>)> = Vec::new();
        let mut lacking = 0;
        for track in tracks {
            let (Some(at), weight) = (track.clip.at(frame), self.weight(track.input, frame)) else {
                continue;
            };
            if weight <= 0.0 {
                continue;
            }
            match self.positions(&track.recording, object, at, frame) {
                Some(points) => playing.push((weight, points)),
                None => lacking += 1,
            }
        }
        let first = playing.first()?.1.len();
        let is_alone = lacking > 0 || playing.iter().any(|(_, points)| points.len() != first);
        if is_alone {
            // Of several that weigh the same, the first.
            let heaviest = playing.into_iter().rev().max_by(|(a, _), (b, _)| a.total_cmp(b))?;
            return Some(Blended { points: heaviest.1, is_alone });
        }
        let total: f64 = playing.iter().map(|(weight, _)| weight).sum();
        let mut points = vec![[0.0; 3]; first];
        for (weight, own) in &playing {
            for (point, own) in points.iter_mut().zip(own) {
                (0..3).for_each(|k| point[k] += own[k] * weight / total);
            }
        }
        Some(Blended { points, is_alone })
    }

    /// The weight of a cache at a frame of the scene.
    fn weight(&self, input: CacheInput, frame: f64) -> f64 {
        let Some((node, index)) = input.blend else { return 1.0 };
        let (data, names): (&[&str], [&str; 2]) = (&["cd", "cacheData"], ["w", "weight"]);
        let mut wires = self.scene.sources(node, data).into_iter();
        let is_own =
            |(of, wire): &(u32, Wire)| *of == index && names.contains(&self.scene.path(wire.to).last().name);
        let source: Option<PlugRef> = wires.find(is_own).map(|(_, wire)| wire.from);
        let stored = self.scene.assigned(node, data).filter(|set| {
            set.segment.range.is_some_and(|range| range.0 == index) && names.contains(&set.rest.last().name)
        });
        let stored = stored.last().and_then(|set| set.values.number()).filter(|x| x.is_finite());
        source.and_then(|plug| self.values.output(plug, frame)).or(stored).unwrap_or(1.0)
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
        let is_output = |wire: &Wire| matches!(scene.path(wire.from).last().name, "omsh" | "outputMesh");
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
