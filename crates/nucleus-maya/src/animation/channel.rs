//! A driven attribute as Nucleus keys: the same keys where that is exact, else a key at every frame.

use nucleus_graph::animation::{Curve, Key, Tangent};
use nucleus_graph::graph::Channel;

use crate::omissions::{Cause, Omissions};
use crate::scene::{NodeId, Vector3, Wire};

use super::evaluator::{Evaluator, MAX_DEPTH, is_conversion};

/// Most frames that are sampled.
const MAX_FRAMES: i64 = 100_000;

/// The frames over which values are sampled, both included.
pub(crate) type Frames = [i64; 2];

impl Evaluator<'_> {
    /// The frames of a range, at most [`MAX_FRAMES`].
    pub(crate) fn sampled([start, end]: Frames) -> impl Iterator<Item = i64> {
        start..=end.clamp(start, start.saturating_add(MAX_FRAMES))
    }

    /// A number over time, times a factor; `what` names it in omissions. `None` if it is neither stored nor driven.
    pub(crate) fn channel(
        &self,
        (id, names): (NodeId, &[&str]),
        factor: f64,
        frames: Frames,
        omissions: &mut Omissions,
    ) -> Option<Channel> {
        let stored = self.scene.stored(id, names);
        match self.scene.source(id, names, None) {
            None => stored.map(|x| Channel::Fixed(x * factor)),
            Some(wire) => {
                let what = || format!("{}.{}", self.scene.name(id), names.last().unwrap_or(&""));
                let driven = self.driven(wire, factor, frames, &what, omissions);
                driven.or(stored.map(|x| Channel::Fixed(x * factor)))
            }
        }
    }

    /// The three components of a vector over time.
    pub(crate) fn channels(
        &self,
        (id, vector): (NodeId, Vector3),
        (factor, default): (f64, f64),
        frames: Frames,
        omissions: &mut Omissions,
    ) -> [Channel; 3] {
        let stored = self.scene.stored_vector(id, vector, [default; 3]);
        let whole = self.scene.source(id, vector.whole, None);
        [0, 1, 2].map(|part| {
            let fixed = Channel::Fixed(stored[part] * factor);
            if let Some(wire) = self.scene.source(id, vector.parts[part], None) {
                let what = || format!("{}.{}", self.scene.name(id), vector.parts[part][1]);
                return self.driven(wire, factor, frames, &what, omissions).unwrap_or(fixed);
            }
            let Some(wire) = whole else { return fixed };
            let sample = |frame: i64| self.part_of(wire, part, frame as f64).map(|x| x * factor);
            match keys_at_every_frame(frames, sample) {
                Some(channel) => channel,
                None => {
                    let what = format!("{}.{}", self.scene.name(id), vector.whole[1]);
                    omissions.add(what, Cause::Driven(self.scene.kind(wire.from.node).to_owned()));
                    fixed
                }
            }
        })
    }

    /// The source of a driven attribute.
    pub(crate) fn driven(
        &self,
        wire: Wire,
        factor: f64,
        frames: Frames,
        what: &dyn Fn() -> String,
        omissions: &mut Omissions,
    ) -> Option<Channel> {
        let (mut source, mut total, mut passed) = (wire.from, factor, 0);
        while is_conversion(self.scene.kind(source.node)) {
            passed += 1;
            if passed > MAX_DEPTH {
                omissions.add(what(), Cause::Driven(self.scene.kind(source.node).to_owned()));
                return None;
            }
            total *= self.conversion(source.node);
            source = self.scene.source(source.node, &["i", "input"], None)?.from;
        }
        let kind = self.scene.kind(source.node);
        if kind.starts_with("animCurveT")
            && let Some(curve) = self.curve(source.node).and_then(|curve| curve.exact(total))
        {
            return Some(Channel::Keyed(curve));
        }
        if kind == "expression" {
            match &*self.script(source.node) {
                Err(why) => {
                    omissions.add(what(), Cause::Expression(why.clone()));
                    return None;
                }
                Ok(script) if script.uses_noise() => {
                    let how = "its noise has the size and the period of Maya's, but other numbers".to_owned();
                    omissions.add(what(), Cause::Approximate(how));
                }
                Ok(_) => {}
            }
        }
        let sample = |frame: i64| self.output(wire.from, frame as f64).map(|x| x * factor);
        let channel = keys_at_every_frame(frames, sample);
        if channel.is_none() {
            omissions.add(what(), Cause::Driven(kind.to_owned()));
        }
        channel
    }
}

/// A linear key at every frame, without those between equal ones; one value if it never changes. `None` if there is no
/// value at a frame.
pub(crate) fn keys_at_every_frame(frames: Frames, sample: impl Fn(i64) -> Option<f64>) -> Option<Channel> {
    let mut keys: Vec<Key> = Vec::new();
    for frame in Evaluator::sampled(frames) {
        let key = Key { frame: frame as f64, value: sample(frame)?, tangent: Tangent::Linear };
        let flat =
            |keys: &[Key]| keys.len() >= 2 && keys[keys.len() - 2..].iter().all(|old| old.value == key.value);
        if flat(&keys) {
            keys.pop();
        }
        keys.push(key);
    }
    let first = keys.first()?.value;
    if keys.iter().all(|key| key.value == first) {
        return Some(Channel::Fixed(first));
    }
    Curve::new(keys).ok().map(Channel::Keyed)
}
