//! Transforms of Maya as Nucleus transforms, which have no pivots: the same placement at every frame, with the same keys.
//!
//! A point goes through `-sp S Sh sp spt -rp RA R rp rpt T` in Maya (for joints `S RA R JO IS T`), and through `S R T` in
//! ours. Fixed turns and scales fold pivots into the translation. Where they are animated, the transform becomes a chain:
//! scale of the segment, orientation, rotation, axis, shear, scale. Animated shear is a rotation, a scale and a rotation for
//! each of its components.

use nucleus_graph::animation::{Curve, Key};
use nucleus_graph::attributes::{Attribute, Choice, Value, n_particle, transform};
use nucleus_graph::graph::{Channel, NodeId as OwnId, Setting};

use crate::animation::{Evaluator, Matrix, keys_at_every_frame, names};
use crate::omissions::Cause;
use crate::scene::{NodeId, is_shape};

use super::attributes::of_channel;
use super::importer::Importer;

/// Channels of translate, rotate and scale, and the rotation order.
struct Parts {
    translate: [Channel; 3],
    rotate: [Channel; 3],
    scale: [Channel; 3],
    order: usize,
}

fn is_fixed(channels: &[Channel; 3]) -> bool {
    channels.iter().all(|channel| matches!(channel, Channel::Fixed(_)))
}

fn fixed(values: [f64; 3]) -> [Channel; 3] {
    values.map(Channel::Fixed)
}

/// A channel moved by an offset.
fn shifted(channel: &Channel, by: f64) -> Channel {
    match channel {
        Channel::Fixed(x) => Channel::Fixed(x + by),
        Channel::Keyed(curve) => {
            let keys = curve.keys().iter().map(|key| Key { value: key.value + by, ..*key }).collect();
            let [before, after] = curve.infinities();
            // Moving finite keys by a finite offset keeps them valid.
            Curve::new(keys)
                .map_or_else(|_| channel.clone(), |moved| Channel::Keyed(moved.with_infinity(before, after)))
        }
    }
}

fn all_shifted(channels: &[Channel; 3], by: [f64; 3]) -> [Channel; 3] {
    [0, 1, 2].map(|k| shifted(&channels[k], by[k]))
}

/// The parts of Maya's matrix that our transforms have not: pivots in scene units, angles in degrees, shear.
struct Pivots {
    rotate: [f64; 3],
    rotate_translate: [f64; 3],
    scale: [f64; 3],
    scale_translate: [f64; 3],
    axis: [f64; 3],
    orient: [f64; 3],
    shear: [Channel; 3],
}

impl Pivots {
    fn are_zero(&self) -> bool {
        let Self { rotate, rotate_translate, scale, scale_translate, axis, orient, shear } = self;
        is_zero(&[*rotate, *rotate_translate, *scale, *scale_translate, *axis, *orient])
            && *shear == fixed([0.0; 3])
    }

    /// Those of a joint, whose matrix has no pivots.
    fn of_joint(self) -> Self {
        let zero = [0.0; 3];
        Self { rotate: zero, rotate_translate: zero, scale: zero, scale_translate: zero, ..self }
    }
}

/// A channel, as a fixed one if all its keys are zero: no tangent has a slope of its own.
fn without_zero_keys(channel: Channel) -> Channel {
    match channel {
        Channel::Keyed(curve) if curve.keys().iter().all(|key| key.value == 0.0) => Channel::Fixed(0.0),
        other => other,
    }
}

fn is_zero(all: &[[f64; 3]]) -> bool {
    all.iter().flatten().all(|x| *x == 0.0)
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] + b[k])
}

fn minus(a: [f64; 3]) -> [f64; 3] {
    a.map(|x| -x)
}

impl Importer<'_> {
    /// Places our node as the transform, or the node with a transform of its own, is in Maya.
    pub(super) fn place(&mut self, from: NodeId, to: OwnId) {
        let scene = self.scene;
        if is_shape(scene.kind(from)) {
            // A further shape of a transform.
            self.hang(to, self.placed_parent(from));
            return;
        }
        let parts = self.parts(from);
        let parent = self.parent_with_offset(from, to);
        let pivots = self.pivots(from);
        let compensation = self.compensation(from);
        self.refuse_animated_pivots(from);
        if pivots.are_zero() && compensation.is_none() {
            self.hang(to, parent);
            self.set_parts(from, to, &parts);
            return;
        }
        if [&parts.rotate, &parts.scale, &pivots.shear].into_iter().chain(&compensation).all(is_fixed) {
            self.place_folded(from, to, parent, &parts);
            return;
        }
        let is_joint = scene.kind(from) == "joint";
        let pivots = if is_joint { pivots.of_joint() } else { pivots };
        self.place_as_chain(to, parent, parts, &pivots, compensation);
    }

    /// The parent of a placed node: that in Maya, with the offset matrix of the node as a transform of its own.
    fn parent_with_offset(&mut self, from: NodeId, to: OwnId) -> Option<OwnId> {
        let inherits = self.scene.switch_or(from, names::INHERITS, true);
        let parent = if inherits { self.placed_parent(from) } else { None };
        let offset = self.scene.matrix(from, names::OFFSET, None).map(Matrix::of_rows);
        let Some(offset) = offset.filter(|offset| !offset.is_identity()) else { return parent };
        let chain = self.add_transform(to, "offset");
        self.hang(chain, parent);
        Some(self.set_matrix(chain, &offset, "offset2"))
    }

    fn pivots(&mut self, from: NodeId) -> Pivots {
        let start = self.frames[0] as f64;
        let shear = self.values.channels((from, names::SHEAR), (1.0, 0.0), self.frames, &mut self.omissions);
        let vector = |vector| self.values.lengths(from, vector, start);
        let is_joint = self.scene.kind(from) == "joint";
        Pivots {
            rotate: vector(names::ROTATE_PIVOT),
            rotate_translate: vector(names::ROTATE_PIVOT_TRANSLATE),
            scale: vector(names::SCALE_PIVOT),
            scale_translate: vector(names::SCALE_PIVOT_TRANSLATE),
            axis: self.values.degrees(from, names::ROTATE_AXIS, start),
            orient: if is_joint { self.values.degrees(from, names::JOINT_ORIENT, start) } else { [0.0; 3] },
            shear: shear.map(without_zero_keys),
        }
    }

    /// Places a node below a transform for each part of Maya's matrix that ours have not, because keys move some of them.
    fn place_as_chain(
        &mut self,
        to: OwnId,
        parent: Option<OwnId>,
        parts: Parts,
        pivots: &Pivots,
        compensation: Option<[Channel; 3]>,
    ) {
        let mut outer = (parent, all_shifted(&parts.translate, add(pivots.rotate, pivots.rotate_translate)));
        if let Some(scale) = compensation {
            outer = self.add_outer(to, "segment", outer, (&transform::SCALE.row, scale, 1.0));
        }
        if pivots.orient != [0.0; 3] {
            let orient = (&transform::ROTATE.row, fixed(pivots.orient), 0.0);
            outer = self.add_outer(to, "orient", outer, orient);
        }
        let (parent, translate) = outer;
        let turn = self.add_transform(to, "rotate");
        self.hang(turn, parent);
        self.set_channels(turn, &transform::TRANSLATE.row, translate, 0.0);
        self.set_channels(turn, &transform::ROTATE.row, parts.rotate, 0.0);
        self.set_order(turn, parts.order);
        let mut inner = turn;
        if pivots.axis != [0.0; 3] {
            inner = self.add_transform(to, "axis");
            self.hang(inner, Some(turn));
            self.set_channels(inner, &transform::ROTATE.row, fixed(pivots.axis), 0.0);
        }
        let mut between = add(add(pivots.scale, pivots.scale_translate), minus(pivots.rotate));
        if pivots.shear != fixed([0.0; 3]) {
            let sheared = self.add_transform(to, "shear");
            self.hang(sheared, Some(inner));
            inner = self.set_shear(sheared, &pivots.shear, between);
            between = [0.0; 3];
        }
        self.place_scaled(to, inner, between, parts.scale, pivots.scale);
    }

    /// Sets the shear of Maya, then a translation, on a transform and on those that it needs below; the innermost of them.
    fn set_shear(&mut self, to: OwnId, shear: &[Channel; 3], translate: [f64; 3]) -> OwnId {
        let values = [0, 1, 2].map(|k| match &shear[k] {
            Channel::Fixed(x) => Some(*x),
            Channel::Keyed(_) => None,
        });
        if let [Some(xy), Some(xz), Some(yz)] = values {
            let matrix = Matrix::shearing([xy, xz, yz]).then(&Matrix::translation(translate));
            return self.set_matrix(to, &matrix, "shear2");
        }
        self.set_channels(to, &transform::TRANSLATE.row, fixed(translate), 0.0);
        // The shear is that along y by z, after those along x.
        let components = [(&shear[2], [1, 2]), (&shear[1], [0, 2]), (&shear[0], [0, 1])];
        let sheared = components.into_iter().filter(|(shear, _)| **shear != Channel::Fixed(0.0));
        let mut at = to;
        for (index, (shear, axes)) in sheared.enumerate() {
            if index > 0 {
                let next = self.add_transform(to, "next");
                self.hang(next, Some(at));
                at = next;
            }
            at = self.set_shear_of_axes(at, shear, axes);
        }
        at
    }

    /// A shear along the first of two axes by the second: a rotation, a scale and a rotation, whose angles and factors are
    /// smooth functions of the shear. The inner rotation is that of a further transform, which is returned.
    fn set_shear_of_axes(&mut self, outer: OwnId, shear: &Channel, [along, by]: [usize; 2]) -> OwnId {
        let frames = self.frames;
        let sampled = |value: &dyn Fn(f64) -> f64| {
            let sample = |frame: i64| match shear {
                Channel::Fixed(x) => Some(value(*x)),
                Channel::Keyed(curve) => Some(value(curve.value_at(frame as f64))),
            };
            keys_at_every_frame(frames, sample).unwrap_or(Channel::Fixed(value(0.0)))
        };
        // [1 s; 0 1] = R(90° - a) diag(k, 1/k) R(-a) with k - 1/k = s and tan 2a = -2/s.
        let angle = |s: f64| libm::atan2(2.0, -s) * 90.0 / std::f64::consts::PI;
        let factor = |s: f64| (s + (s * s + 4.0).sqrt()) / 2.0;
        // The axis of a rotation from the first axis to the second: z, -y or x.
        let axis = 3 - along - by;
        let sign = if axis == 1 { -1.0 } else { 1.0 };
        let mut turn = fixed([0.0; 3]);
        turn[axis] = sampled(&|s| sign * (90.0 - angle(s)));
        let mut scale = fixed([1.0; 3]);
        (scale[along], scale[by]) = (sampled(&factor), sampled(&|s| 1.0 / factor(s)));
        self.set_channels(outer, &transform::ROTATE.row, turn, 0.0);
        self.set_channels(outer, &transform::SCALE.row, scale, 1.0);
        let inner = self.add_transform(outer, "back");
        self.hang(inner, Some(outer));
        let mut back = fixed([0.0; 3]);
        back[axis] = sampled(&|s| -sign * angle(s));
        self.set_channels(inner, &transform::ROTATE.row, back, 0.0);
        inner
    }

    /// Adds a transform with one of its channels set, which takes over the translation; the parent of the next and what is left
    /// of the translation.
    fn add_outer(
        &mut self,
        to: OwnId,
        suffix: &str,
        (parent, translate): (Option<OwnId>, [Channel; 3]),
        (row, channels, default): (&'static Attribute, [Channel; 3], f64),
    ) -> (Option<OwnId>, [Channel; 3]) {
        let chain = self.add_transform(to, suffix);
        self.hang(chain, parent);
        self.set_channels(chain, &transform::TRANSLATE.row, translate, 0.0);
        self.set_channels(chain, row, channels, default);
        (Some(chain), fixed([0.0; 3]))
    }

    /// Places a node below `parent`, scaled about a pivot.
    fn place_scaled(
        &mut self,
        to: OwnId,
        parent: OwnId,
        translate: [f64; 3],
        scale: [Channel; 3],
        pivot: [f64; 3],
    ) {
        let scaled = if pivot == [0.0; 3] { to } else { self.add_transform(to, "scale") };
        self.hang(scaled, Some(parent));
        self.set_channels(scaled, &transform::TRANSLATE.row, fixed(translate), 0.0);
        self.set_channels(scaled, &transform::SCALE.row, scale, 1.0);
        if scaled != to {
            self.hang(to, Some(scaled));
            self.set_channels(to, &transform::TRANSLATE.row, fixed(minus(pivot)), 0.0);
        }
    }

    /// Takes the initial state of particles from the space of their transform to world space, in which ours are.
    pub(super) fn place_particles(&mut self, from: NodeId, to: OwnId) {
        let world = self.values.world(from, self.frames[0] as f64);
        let rows: [(&'static Attribute, bool); 4] = [
            (&n_particle::POSITION0.row, true),
            (&n_particle::POSITION.row, true),
            (&n_particle::VELOCITY0.row, false),
            (&n_particle::VELOCITY.row, false),
        ];
        for (row, is_place) in rows {
            let stored = self.graph.node(to).settings().get(row.name);
            let Some(Setting::Fixed(Value::Vectors(all))) = stored else { continue };
            let image = |p: &[f64; 3]| if is_place { world.point(*p) } else { world.direction(*p) };
            let placed = all.iter().map(image).collect();
            self.set(to, row, Setting::Fixed(Value::Vectors(placed)));
        }
        let moves = |frame: i64| self.values.world(from, frame as f64) != world;
        if Evaluator::sampled(self.frames).any(moves) {
            self.omissions.add(self.graph.node(to).name(), Cause::MovingParticles);
        }
    }

    /// The scale by which a joint undoes that of its parent; `None` if that is 1 throughout.
    fn compensation(&self, from: NodeId) -> Option<[Channel; 3]> {
        let part = |part: usize, frame: i64| {
            Some(self.values.compensation(from, frame as f64).map_or(1.0, |scale| scale[part]))
        };
        let channels = [0, 1, 2]
            .map(|k| keys_at_every_frame(self.frames, |frame| part(k, frame)).unwrap_or(Channel::Fixed(1.0)));
        channels.iter().any(|channel| *channel != Channel::Fixed(1.0)).then_some(channels)
    }

    /// Fixed turns and scales: one transform, or two if there is shear. The translation may be animated.
    fn place_folded(&mut self, from: NodeId, to: OwnId, parent: Option<OwnId>, parts: &Parts) {
        let start = self.frames[0] as f64;
        let mut whole = self.values.local(from, start);
        if let Some(offset) = self.scene.matrix(from, names::OFFSET, None).map(Matrix::of_rows)
            && let Some(back) = offset.inverse()
        {
            whole = whole.then(&back);
        }
        let at = self.values.lengths(from, names::TRANSLATE, start);
        let by = [0, 1, 2].map(|k| whole.0[3][k] - at[k]);
        match whole.decomposed(parts.order) {
            Some([_, rotate, scale]) => {
                self.hang(to, parent);
                self.set_channels(to, &transform::TRANSLATE.row, all_shifted(&parts.translate, by), 0.0);
                self.set_channels(to, &transform::ROTATE.row, fixed(rotate), 0.0);
                self.set_channels(to, &transform::SCALE.row, fixed(scale), 1.0);
                self.set_order(to, parts.order);
            }
            None => {
                let outer = self.add_transform(to, "shear");
                self.hang(outer, parent);
                let inner = self.set_sheared(outer, to, &whole);
                self.hang(inner, Some(outer));
                self.set_channels(outer, &transform::TRANSLATE.row, all_shifted(&parts.translate, by), 0.0);
            }
        }
    }

    /// Gives a transform the placement of a matrix; with shear, it takes a second one below it. Returns the lower one.
    fn set_matrix(&mut self, to: OwnId, matrix: &Matrix, suffix: &str) -> OwnId {
        let at = [0, 1, 2].map(|k| matrix.0[3][k]);
        self.set_channels(to, &transform::TRANSLATE.row, fixed(at), 0.0);
        if let Some([_, rotate, scale]) = matrix.decomposed(0) {
            self.set_channels(to, &transform::ROTATE.row, fixed(rotate), 0.0);
            self.set_channels(to, &transform::SCALE.row, fixed(scale), 1.0);
            return to;
        }
        let inner = self.add_transform(to, suffix);
        self.hang(inner, Some(to));
        self.set_sheared(to, inner, matrix)
    }

    /// A map with shear is a rotation, a scale and a rotation (singular value decomposition): `A` below, `Σ B` above.
    fn set_sheared(&mut self, outer: OwnId, inner: OwnId, matrix: &Matrix) -> OwnId {
        let linear = nalgebra::Matrix3::from_fn(|row, column| matrix.0[row][column]);
        let svd = linear.svd(true, true);
        let (Some(mut a), Some(mut b)) = (svd.u, svd.v_t) else { return inner };
        let mut stretch: [f64; 3] = svd.singular_values.into();
        // Both must be rotations: a mirror moves into the scale.
        for (m, is_column) in [(&mut a, true), (&mut b, false)] {
            if m.determinant() < 0.0 {
                (0..3).for_each(|k| if is_column { m[(k, 2)] = -m[(k, 2)] } else { m[(2, k)] = -m[(2, k)] });
                stretch[2] = -stretch[2];
            }
        }
        for (to, turn) in [(inner, a), (outer, b)] {
            let mut own = Matrix::IDENTITY;
            (0..9).for_each(|k| own.0[k / 3][k % 3] = turn[(k / 3, k % 3)]);
            if let Some([_, rotate, _]) = own.decomposed(0) {
                self.set_channels(to, &transform::ROTATE.row, fixed(rotate), 0.0);
            }
        }
        self.set_channels(outer, &transform::SCALE.row, fixed(stretch), 1.0);
        inner
    }

    /// The channels of a transform, in centimetres and degrees.
    fn parts(&mut self, from: NodeId) -> Parts {
        let units = self.scene.units;
        let mut channels = |vector, factor: f64, default: f64| {
            self.values.channels((from, vector), (factor, default), self.frames, &mut self.omissions)
        };
        Parts {
            translate: channels(names::TRANSLATE, units.centimetres, 0.0),
            rotate: channels(names::ROTATE, units.degrees, 0.0),
            scale: channels(names::SCALE, 1.0, 1.0),
            order: self.scene.stored_or(from, names::ROTATE_ORDER, 0.0).clamp(0.0, 5.0) as usize,
        }
    }

    /// Sets the channels that the file sets.
    fn set_parts(&mut self, from: NodeId, to: OwnId, parts: &Parts) {
        let given = |vector: crate::scene::Vector3| {
            let mut all = vector.parts.iter().chain(std::iter::once(&vector.whole));
            all.any(|names| {
                self.scene.value(from, names).is_some() || self.scene.source(from, names, None).is_some()
            })
        };
        let is_own = self.is_own;
        let sets = [
            (&transform::TRANSLATE.row, &parts.translate, 0.0, given(names::TRANSLATE)),
            (&transform::ROTATE.row, &parts.rotate, 0.0, given(names::ROTATE)),
            (&transform::SCALE.row, &parts.scale, 1.0, given(names::SCALE)),
        ];
        for (row, channels, default, given) in sets {
            if given {
                // A file of this crate sets values explicitly, even if they are the default.
                let default = if is_own { f64::NAN } else { default };
                self.set_channels(to, row, channels.clone(), default);
            }
        }
        if self.scene.value(from, names::ROTATE_ORDER).is_some() {
            self.set_order(to, parts.order);
        }
        let visibility = &transform::VISIBILITY.row;
        let names: &[&str] = &["v", "visibility"];
        if is_own
            && let Some(visible) = self.values.channel((from, names), 1.0, self.frames, &mut self.omissions)
        {
            self.set(to, visibility, of_channel(visible, visibility));
        }
    }

    /// Sets a vector, unless all of it is at its default.
    fn set_channels(&mut self, to: OwnId, row: &'static Attribute, channels: [Channel; 3], default: f64) {
        if channels.iter().all(|channel| *channel == Channel::Fixed(default)) {
            return;
        }
        self.set(to, row, Setting::Parts(channels));
    }

    fn set_order(&mut self, to: OwnId, order: usize) {
        if order != 0 || self.is_own {
            self.set(to, &transform::ROTATE_ORDER.row, Setting::Fixed(Value::Choice(Choice(order as i32))));
        }
    }

    fn add_transform(&mut self, of: OwnId, suffix: &str) -> OwnId {
        let name = format!("{}_{suffix}", self.graph.node(of).name());
        let name = self.kept.free_name(&name);
        // The name is free and valid.
        self.graph.add(&name, &transform::TRANSFORM).unwrap_or(of)
    }

    fn hang(&mut self, node: OwnId, parent: Option<OwnId>) {
        if let Some(parent) = parent {
            // Maya's parents form no cycle either.
            let _ = self.graph.set_parent(node, parent);
        }
    }

    /// Our node for the parent of a transform.
    fn placed_parent(&self, from: NodeId) -> Option<OwnId> {
        let parent = self.scene.node(from).parent?;
        self.own_of(parent)
    }

    fn refuse_animated_pivots(&mut self, from: NodeId) {
        let vectors = [
            names::ROTATE_PIVOT,
            names::SCALE_PIVOT,
            names::ROTATE_PIVOT_TRANSLATE,
            names::SCALE_PIVOT_TRANSLATE,
            names::ROTATE_AXIS,
            names::JOINT_ORIENT,
        ];
        let is_driven = |vector: &crate::scene::Vector3| {
            let mut all = vector.parts.iter().chain(std::iter::once(&vector.whole));
            all.any(|names| self.scene.source(from, names, None).is_some())
        };
        for vector in vectors.into_iter().filter(is_driven) {
            let what = format!("{}.{}", self.scene.name(from), vector.whole[1]);
            let why = "curve or a node; pivots and orientations stay as they are".to_owned();
            self.omissions.add(what, Cause::Driven(why));
        }
    }
}
