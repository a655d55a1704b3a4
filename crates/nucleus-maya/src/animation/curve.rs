//! Keyed curves of Maya: tangents on both sides of a key, weighted or not, and infinities.

use nucleus_graph::animation::{Curve, Infinity, Key, Tangent};

use crate::scene::{MayaScene, NodeId, Quantity};

/// The tangent of one side of a key, by Maya's number.
const FIXED: u8 = 1;
const LINEAR: u8 = 2;
const FLAT: u8 = 3;
const STEPPED: u8 = 5;
const SLOW: u8 = 6;
const SPLINE: u8 = 9;
const CLAMPED: u8 = 10;
const PLATEAU: u8 = 16;
const STEPPED_NEXT: u8 = 17;
const AUTO: u8 = 18;

/// A curve as a file stores it. Frames along one axis; values in the unit of the file along the other.
#[derive(Debug, Clone, PartialEq)]
pub struct MayaCurve {
    keys: Vec<MayaKey>,
    is_weighted: bool,
    before: Infinity,
    after: Infinity,
}

/// A key. Tangent vectors are `(frames, values)`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct MayaKey {
    frame: f64,
    value: f64,
    kinds: [u8; 2],
    vectors: [[f64; 2]; 2],
}

impl MayaCurve {
    /// The curve of an `animCurve` node; `None` if it has no key, or a broken one.
    pub fn read(scene: &MayaScene, id: NodeId) -> Option<Self> {
        let pairs =
            scene.array(id, &["ktv", "keyTimeValue"], 2, &[&["kt", "keyTime"], &["kv", "keyValue"]])?;
        let list = |names: &[&str]| scene.array(id, names, 1, &[]).unwrap_or_default();
        let kinds = [list(&["kit", "keyTanInType"]), list(&["kot", "keyTanOutType"])];
        let x = [list(&["kix", "keyTanInX"]), list(&["kox", "keyTanOutX"])];
        let y = [list(&["kiy", "keyTanInY"]), list(&["koy", "keyTanOutY"])];
        let usual = scene.stored_or(id, &["tan", "tangentType"], f64::from(SPLINE)) as u8;
        let [per_frame, per_value] = tangent_units(scene, scene.kind(id));
        let [frames, values] = key_units(scene, id);
        let at = |list: &[f64], k: usize| list.get(k).copied().unwrap_or(0.0);
        let key = |(k, pair): (usize, &[f64])| MayaKey {
            frame: pair[0] * frames,
            value: pair[1] * values,
            kinds: [0, 1].map(|side| match at(&kinds[side], k) as u8 {
                0 => usual,
                kind => kind,
            }),
            vectors: [0, 1].map(|side| [at(&x[side], k) * per_frame, at(&y[side], k) * per_value]),
        };
        let mut keys: Vec<MayaKey> = pairs.chunks_exact(2).enumerate().map(key).collect();
        if keys.iter().any(|key| !(key.frame.abs() < 1e12 && key.value.abs() < 1e300)) {
            return None;
        }
        keys.sort_by(|a, b| a.frame.total_cmp(&b.frame));
        keys.dedup_by(|a, b| a.frame == b.frame);
        let infinity = |names: &[&str]| match scene.stored_or(id, names, 0.0) as u8 {
            1 => Infinity::Linear,
            3 => Infinity::Cycle,
            4 => Infinity::CycleOffset,
            5 => Infinity::Oscillate,
            _ => Infinity::Constant,
        };
        let (before, after) = (infinity(&["pre", "preInfinity"]), infinity(&["pst", "postInfinity"]));
        let is_weighted = scene.switch_or(id, &["wgt", "weightedTangents"], false);
        (!keys.is_empty()).then_some(Self { keys, is_weighted, before, after })
    }

    /// The value at a frame.
    pub fn value_at(&self, frame: f64) -> f64 {
        let (first, last) = (self.keys[0], self.keys[self.keys.len() - 1]);
        let span = last.frame - first.frame;
        if frame >= first.frame && frame <= last.frame {
            return self.inside(frame);
        }
        let (end, infinity) = if frame < first.frame { (first, self.before) } else { (last, self.after) };
        if span == 0.0 {
            return end.value;
        }
        let rounds = ((frame - first.frame) / span).floor();
        let rest = (frame - first.frame).rem_euclid(span);
        match infinity {
            Infinity::Constant => end.value,
            // A stepped segment has no slope to lead on with.
            Infinity::Linear if self.ends_stepped(frame < first.frame) => end.value,
            Infinity::Linear if frame < first.frame => end.value + (frame - first.frame) * self.slope(0, 1),
            Infinity::Linear => end.value + (frame - last.frame) * self.slope(self.keys.len() - 1, 0),
            Infinity::Cycle => self.inside(first.frame + rest),
            Infinity::CycleOffset => self.inside(first.frame + rest) + rounds * (last.value - first.value),
            Infinity::Oscillate if rounds % 2.0 == 0.0 => self.inside(first.frame + rest),
            Infinity::Oscillate => self.inside(last.frame - rest),
        }
    }

    /// Whether the segment at one end is stepped.
    fn ends_stepped(&self, at_first: bool) -> bool {
        let start = if at_first { 0 } else { self.keys.len() - 2 };
        matches!(self.keys[start].kinds[1], STEPPED | STEPPED_NEXT)
    }

    /// The value between the first and the last key.
    fn inside(&self, frame: f64) -> f64 {
        let after = self.keys.partition_point(|key| key.frame <= frame);
        if after == 0 || after == self.keys.len() {
            return self.keys[after.saturating_sub(1)].value;
        }
        let (from, to) = (self.keys[after - 1], self.keys[after]);
        match from.kinds[1] {
            STEPPED => return from.value,
            STEPPED_NEXT => return if frame == from.frame { from.value } else { to.value },
            _ => {}
        }
        let frames = to.frame - from.frame;
        let s = (frame - from.frame) / frames;
        if self.is_weighted && (from.kinds[1] == FIXED || to.kinds[0] == FIXED) {
            return self.weighted(after - 1, frame);
        }
        let (leaving, arriving) = (self.slope(after - 1, 1) * frames, self.slope(after, 0) * frames);
        let rest = 1.0 - s;
        from.value
            + (to.value - from.value) * (s * s * (3.0 - 2.0 * s))
            + s * rest * (leaving * rest - arriving * s)
    }

    /// The value of a segment whose handles have lengths: a Bézier curve, whose parameter is found by bisection.
    fn weighted(&self, start: usize, frame: f64) -> f64 {
        let (from, to) = (self.keys[start], self.keys[start + 1]);
        let frames = to.frame - from.frame;
        let handle = |key: usize, side: usize| {
            let MayaKey { kinds, vectors, .. } = self.keys[key];
            match kinds[side] {
                // A handle is a third of its vector; it stays within the segment.
                FIXED if vectors[side][0] > 0.0 => {
                    let shrink = (frames / (vectors[side][0] / 3.0)).min(1.0);
                    vectors[side].map(|x| x / 3.0 * shrink)
                }
                _ => [frames / 3.0, self.slope(key, side) * frames / 3.0],
            }
        };
        let (out, back) = (handle(start, 1), handle(start + 1, 0));
        let x = [from.frame, from.frame + out[0], to.frame - back[0], to.frame];
        let y = [from.value, from.value + out[1], to.value - back[1], to.value];
        let at = |p: &[f64; 4], s: f64| {
            let r = 1.0 - s;
            r * r * r * p[0] + 3.0 * r * r * s * p[1] + 3.0 * r * s * s * p[2] + s * s * s * p[3]
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if at(&x, middle) < frame { low = middle } else { high = middle }
        }
        at(&y, 0.5 * (low + high))
    }

    /// The slope at a key on one side (0 in, 1 out), per frame.
    fn slope(&self, key: usize, side: usize) -> f64 {
        let at = self.keys[key];
        let to = |other: usize| {
            let other = self.keys[other];
            (other.value - at.value) / (other.frame - at.frame)
        };
        let before = key.checked_sub(1);
        let after = (key + 1 < self.keys.len()).then_some(key + 1);
        let own_side = if side == 0 { before } else { after };
        let (Some(before), Some(after)) = (before, after) else {
            return match at.kinds[side] {
                FIXED => fixed(at.vectors[side]),
                // At an end, a smooth tangent points to the neighbouring key.
                LINEAR | SPLINE | CLAMPED => before.or(after).map_or(0.0, to),
                _ => 0.0,
            };
        };
        let (coming, going) = (to(before), to(after));
        let (previous, next) = (self.keys[before], self.keys[after]);
        let through = (next.value - previous.value) / (next.frame - previous.frame);
        match at.kinds[side] {
            FIXED => fixed(at.vectors[side]),
            LINEAR | STEPPED | STEPPED_NEXT => own_side.map_or(0.0, to),
            FLAT | SLOW => 0.0,
            CLAMPED if coming == 0.0 || going == 0.0 => 0.0,
            PLATEAU | AUTO => {
                if coming * going <= 0.0 {
                    return 0.0;
                }
                let limit = 3.0 * coming.abs().min(going.abs());
                through.clamp(-limit, limit)
            }
            _ => through,
        }
    }

    /// The curve as a Nucleus curve, times a factor: with the same keys if that is exact, else `None`.
    pub fn exact(&self, factor: f64) -> Option<Curve> {
        let last = self.keys.len() - 1;
        let tangent = |k: usize| -> Tangent {
            let [into, out] = self.keys[k].kinds;
            let is_end = k == 0 || k == last;
            match if k == last && out != STEPPED { into } else { out } {
                STEPPED => Tangent::Stepped,
                LINEAR => Tangent::Linear,
                // At its ends our spline is flat, as Maya's plateau.
                PLATEAU if is_end => Tangent::Spline,
                PLATEAU | AUTO => Tangent::Auto,
                SPLINE | CLAMPED if is_end => Tangent::Linear,
                SPLINE | CLAMPED if self.slope(k, 0) != 0.0 => Tangent::Spline,
                SPLINE => Tangent::Spline,
                _ => Tangent::Flat,
            }
        };
        let key = |(k, key): (usize, &MayaKey)| Key {
            frame: key.frame,
            value: key.value * factor,
            tangent: tangent(k),
        };
        let keys: Vec<Key> = self.keys.iter().enumerate().map(key).collect();
        let curve = Curve::new(keys).ok()?.with_infinity(self.before, self.after);
        self.is_followed_by(&curve, factor).then_some(curve)
    }

    /// Whether a curve has the same values: between all keys, and beyond them.
    fn is_followed_by(&self, curve: &Curve, factor: f64) -> bool {
        let (first, last) = (self.keys[0].frame, self.keys[self.keys.len() - 1].frame);
        let largest = self.keys.iter().map(|key| (key.value * factor).abs()).fold(1e-3, f64::max);
        let same =
            |frame: f64| (self.value_at(frame) * factor - curve.value_at(frame)).abs() <= 1e-7 * largest;
        let inside = self.keys.windows(2).all(|pair| {
            let frames = pair[1].frame - pair[0].frame;
            [0.21, 0.5, 0.83].iter().all(|share| same(pair[0].frame + share * frames))
        });
        inside && same(first - 3.7) && same(last + 3.7)
    }
}

fn fixed([frames, values]: [f64; 2]) -> f64 {
    if frames > 0.0 { values / frames } else { 0.0 }
}

/// Frames and values of the scene in those of the file of a curve.
fn key_units(scene: &MayaScene, id: NodeId) -> [f64; 2] {
    let (own, units) = (scene.units_of(id), scene.units);
    let kind = scene.kind(id);
    let quantity = Quantity::of(kind, "output");
    let frames = if kind.starts_with("animCurveU") { 1.0 } else { units.fps / own.fps };
    [frames, own.of(quantity) / units.of(quantity)]
}

/// Frames and values of the scene in the units of a stored tangent: seconds, and centimetres or radians.
fn tangent_units(scene: &MayaScene, kind: &str) -> [f64; 2] {
    let units = scene.units;
    let value = match kind {
        "animCurveTL" | "animCurveUL" => 1.0 / units.centimetres,
        "animCurveTA" | "animCurveUA" => 180.0 / std::f64::consts::PI / units.degrees,
        _ => 1.0,
    };
    let frame = if kind.starts_with("animCurveU") { 1.0 } else { units.fps };
    [frame, value]
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::ascii::SourceText;

    fn curve(kind: &str, attributes: &str) -> MayaCurve {
        let text = format!("//Maya ASCII 2016 scene\ncreateNode {kind} -n \"c\";\n{attributes}");
        let text = SourceText::from_bytes(Path::new("a.ma"), text.into_bytes()).unwrap();
        let scene = MayaScene::of_text(text).unwrap();
        MayaCurve::read(&scene, scene.find("c").unwrap()).unwrap()
    }

    fn near(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-9, "{a} is not {b}");
    }

    #[test]
    fn automatic_tangents_ease_in_and_out() {
        let c = curve(
            "animCurveTU",
            "setAttr \".tan\" 18; setAttr \".wgt\" no; setAttr -s 2 \".ktv[0:1]\" 1 0 11 10;",
        );
        near(c.value_at(6.0), 5.0);
        // 3 s² - 2 s³ at a fifth.
        near(c.value_at(3.0), 1.04);
        assert!(c.exact(1.0).is_some());
    }

    #[test]
    fn two_spline_keys_are_a_line() {
        let c = curve("animCurveTU", "setAttr \".tan\" 9; setAttr -s 2 \".ktv[0:1]\" 1 0 11 10;");
        near(c.value_at(3.0), 2.0);
        near(c.exact(2.0).unwrap().value_at(3.0), 4.0);
    }

    #[test]
    fn a_stored_tangent_is_in_seconds_and_radians() {
        // At 24 frames per second, a slope of (1/24 s, 1 rad) is one radian per frame.
        let text = "setAttr \".tan\" 1; setAttr -s 2 \".ktv[0:1]\" 0 0 10 0; setAttr -s 2 \".kox[0:1]\" 0.0416666666666666667 1; \
                    setAttr -s 2 \".koy[0:1]\" 1 0; setAttr -s 2 \".kix[0:1]\" 1 1; setAttr -s 2 \".kiy[0:1]\" 0 0;";
        let c = curve("animCurveTA", text);
        let degrees = 180.0 / std::f64::consts::PI;
        // A Hermite cubic with one slope m: m s (1 - s)² times its length.
        near(c.value_at(5.0), degrees * 10.0 * 0.5 * 0.25);
        assert!(c.exact(1.0).is_none(), "ours has no such tangent");
    }

    #[test]
    fn a_weighted_handle_bends_time_as_well() {
        // Handles of two seconds reach over a third of them. By symmetry the value is half way at half time.
        let text = "setAttr \".tan\" 1; setAttr \".wgt\" yes; setAttr -s 2 \".ktv[0:1]\" 0 0 24 1; setAttr -s 2 \".kox[0:1]\" 2 2; \
                    setAttr -s 2 \".koy[0:1]\" 0 0; setAttr -s 2 \".kix[0:1]\" 2 2; setAttr -s 2 \".kiy[0:1]\" 0 0;";
        let c = curve("animCurveTU", text);
        near(c.value_at(12.0), 0.5);
        assert!(c.value_at(6.0) < 0.1, "long flat handles keep the value longer: {}", c.value_at(6.0));
    }

    #[test]
    fn infinities_repeat_mirror_and_lead_on() {
        let with = |number: u32| {
            let text = format!(
                "setAttr \".tan\" 2; setAttr -s 2 \".ktv[0:1]\" 0 0 10 5; setAttr \".pst\" {number};"
            );
            curve("animCurveTU", &text)
        };
        for (number, value) in [(0, 5.0), (1, 6.0), (3, 1.0), (4, 6.0), (5, 4.0)] {
            near(with(number).value_at(12.0), value);
            near(with(number).exact(1.0).unwrap().value_at(12.0), value);
        }
    }

    #[test]
    fn sparse_tangents_fill_up_with_the_usual_one() {
        let c = curve(
            "animCurveTU",
            "setAttr \".tan\" 2; setAttr -s 3 \".ktv[0:2]\" 0 0 10 5 20 0; setAttr -s 3 \".kot[1]\" 5;",
        );
        near(c.value_at(5.0), 2.5);
        near(c.value_at(15.0), 5.0);
        assert_eq!(c.exact(1.0).unwrap().keys()[1].tangent, Tangent::Stepped);
    }
}
