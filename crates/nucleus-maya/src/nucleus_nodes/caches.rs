//! Recorded results (`playFromCache`): an object whose nCache lies with the scene plays it, as in Maya.
//!
//! Its positions are written as an OBJ file for each frame, in world space. Where the cache is missing, or cannot be played,
//! the object is simulated, and the omissions say so.

use std::fmt::{self, Write};
use std::ops::RangeInclusive;

use nucleus_graph::animation::{Curve, Key, Tangent};
use nucleus_graph::attributes::{Value, n_base, n_cloth, n_particle};
use nucleus_graph::graph::{NodeId as OwnId, Setting};

use crate::omissions::Cause;
use crate::scene::NodeId;

use super::importer::Importer;
use super::tracks::{CacheInput, Tracks};

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
            let caches = self.caches_of(from);
            if caches.is_empty() {
                continue;
            }
            let name = self.graph.node(to).name().to_owned();
            caches.iter().for_each(|input| self.report_changes(input));
            let how = match self.play_cache(from, &caches, to)? {
                Ok(how) => how,
                Err(why) => format!("it is simulated instead: {why}"),
            };
            self.omissions.add(name, Cause::Cache(how));
        }
        Ok(())
    }

    /// Writes the positions of a cache, and sets the object to play them. The text says what it plays; else why it does not.
    /// The outer error is that of writing a file.
    fn play_cache(
        &mut self,
        from: NodeId,
        caches: &[CacheInput],
        to: OwnId,
    ) -> Result<Result<String, String>, String> {
        let recorded = match self.recorded_frames(from, caches, to) {
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
        Ok(Ok(format!("it plays {recorded}; `nucleus import --simulate` solves it instead")))
    }

    /// The positions of an object at the frames that its caches have, in world space; else why they cannot be played.
    fn recorded_frames(&self, from: NodeId, caches: &[CacheInput], to: OwnId) -> Result<Recorded, String> {
        let compare = format!("`nucleus diff` compares the run with `{}.xml`", self.name_of(&caches[0]));
        if self.options.simulate {
            return Err(format!("`--simulate` says so; {compare}"));
        }
        let Tracks { all, unread } = self.tracks(caches)?;
        let name = all.iter().map(|track| format!("`{}`", track.name)).collect::<Vec<_>>().join(" and ");
        let mut recorded = Recorded { name: name.clone(), frames: Vec::new(), alone: 0, unread };
        for frame in self.frames[0]..=self.frames[1] {
            if let Some(blended) = self.blended(&all, from, frame as f64) {
                recorded.alone += usize::from(blended.is_alone);
                recorded.frames.push((frame, blended.points));
            }
        }
        let frames = &recorded.frames;
        let counts = frames.windows(2).find(|pair| pair[1].1.len() < pair[0].1.len());
        if let Some(pair) = counts {
            return Err(format!("points of {name} die at frame {}; {compare}", pair[1].0));
        }
        if frames.is_empty() {
            return Err(format!("{name} has no positions of it at the frames of the scene; {compare}"));
        }
        let is_cloth = self.graph.node(to).node_type().is_a(&n_cloth::N_CLOTH);
        let points = self.points_of(to).filter(|_| is_cloth);
        match points.filter(|points| frames.iter().any(|(_, all)| all.len() != *points)) {
            Some(points) => {
                Err(format!("{name} has {} points, its mesh {points}; {compare}", frames[0].1.len()))
            }
            None => Ok(recorded),
        }
    }

    /// Notes changes of a recording that are not carried out: outside of its range, backwards, for single points.
    fn report_changes(&mut self, &CacheInput { cache, blend }: &CacheInput) {
        let weights: &[&str] = &["ppw", "perPtWeights"];
        if let Some((node, _)) = blend
            && (self.scene.value(node, weights).is_some() || !self.scene.sources(node, weights).is_empty())
        {
            let what = format!("{}.perPtWeights", self.scene.name(node));
            let why = "all points of a cache are blended by its weight".to_owned();
            self.omissions.add(what, Cause::Approximate(why));
        }
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
}

/// Recorded positions in world space, by frame of the scene.
struct Recorded {
    /// The names of the caches.
    name: String,
    frames: Vec<(i64, Vec<[f64; 3]>)>,
    /// Frames at which the heaviest cache of a blend plays alone.
    alone: usize,
    /// Why other caches of a blend are not read.
    unread: Vec<String>,
}

impl fmt::Display for Recorded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [first, last] = self.ends();
        write!(f, "frames {first} to {last} of {}", self.name)?;
        match last + 1 - first - self.frames.len() as i64 {
            0 => {}
            missing => write!(f, ", but simulates {missing} of these, which the cache does not have")?,
        }
        if self.alone > 0 {
            let alone = self.alone;
            write!(
                f,
                ", at {alone} of these only the heaviest: the others have other points or no sample there"
            )?;
        }
        self.unread.iter().try_for_each(|why| write!(f, ", not a further cache: {why}"))
    }
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
