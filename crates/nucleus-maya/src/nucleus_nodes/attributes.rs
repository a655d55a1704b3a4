//! Values of attributes, by the tables of our node types.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use nucleus_graph::attributes::{
    Attribute, Choice, ColorPoint, Effect, Kind, NodeType, Painting, RampPoint, Value, n_base, n_particle,
    n_rigid, nucleus, particle, transform,
};
use nucleus_graph::graph::{Channel, NodeId as OwnId, Setting};

use crate::animation::names;
use crate::omissions::Cause;
use crate::scene::{ANY, NodeId, Quantity, Set};

use super::importer::Importer;
use super::kept::{MARK_AUTOMATIC, MARK_NAME, MARK_PAINT};

/// Attributes of any node of Maya's that say nothing about a simulation.
const SILENT: [&str; 44] = [
    "v",
    "visibility",
    "ihi",
    "isHistoricallyInteresting",
    "iog",
    "instObjGroups",
    "rnd",
    "renderLayerInfo",
    "tmp",
    "template",
    "lodv",
    "lodVisibility",
    "uvst",
    "cuvs",
    "currentUVSet",
    "dcc",
    "displayColorChannel",
    "covm",
    "cdvm",
    "io",
    "intermediateObject",
    "gf",
    "geometry",
    "idt",
    "instanceData",
    "cts",
    "countSave",
    "chw",
    "cacheWidth",
    "icx",
    "irbx",
    "irax",
    "ove",
    "overrideEnabled",
    "ovc",
    "overrideColor",
    "uoc",
    "useObjectColor",
    "oc",
    "objectColor",
    "isc",
    "iconName",
    "nts",
    "notes",
];

impl Importer<'_> {
    /// Sets the values of a node that have a row in the table of its type.
    pub(super) fn set_values(&mut self, from: NodeId, to: OwnId, node_type: &'static NodeType) {
        let (mut rows, mut unknown, mut painted) = (BTreeMap::new(), BTreeSet::new(), Vec::new());
        let scene = self.scene;
        let automatic = scene.string(from, &[MARK_AUTOMATIC]).unwrap_or_default();
        let automatic: BTreeSet<&str> = automatic.split(' ').collect();
        let given =
            scene.assigned(from, ANY).filter(|set| !set.values.is_empty()).map(|set| set.segment.name);
        let driven =
            scene.arriving(from).filter_map(|wire| scene.path(wire.to).segments().next().map(|s| s.name));
        for name in given.chain(driven) {
            match node_type.attribute(name).or_else(|| node_type.part(name).map(|(row, _)| row)) {
                Some(row) => {
                    rows.insert(row.name, row);
                }
                None if SILENT.contains(&name) || name == MARK_AUTOMATIC || name == MARK_NAME => {}
                // The placement is set apart from the values.
                None if names::is_of_placement(name) && node_type.is_a(&transform::TRANSFORM) => {}
                None if self.is_own && name.starts_with(MARK_PAINT) => {
                    let row = node_type.attribute(&name[MARK_PAINT.len()..]);
                    painted.extend(row.zip(scene.string(from, &[name])));
                }
                None => {
                    unknown.insert(name);
                }
            }
        }
        for (name, row) in rows {
            let is_added = || scene.node(from).added.iter().any(|(long, _)| **long == *name);
            if self.is_placed_elsewhere(row) || automatic.contains(name) || (row.extension && !is_added()) {
                continue;
            }
            if let Some(setting) = self.setting(from, row, node_type) {
                self.set(to, row, setting);
            }
        }
        for (row, text) in painted {
            let painting = match text.split_once(':') {
                Some(("file", file)) => Painting::File(file.to_owned()),
                Some(("selection", text)) => Painting::Selection(text.to_owned()),
                Some((_, expression)) => Painting::Expression(expression.to_owned()),
                None => continue,
            };
            self.set(to, row, Setting::Fixed(Value::Painting(painting)));
        }
        if !self.is_own {
            self.report_others(from, &unknown);
        }
    }

    /// Lists attributes without a row: those that a user has added, which no solver reads, and those that are not known.
    fn report_others(&mut self, from: NodeId, names: &BTreeSet<&str>) {
        let scene = self.scene;
        let is_added = |name: &str| {
            scene.node(from).added.iter().any(|(long, short)| **long == *name || **short == *name)
        };
        let (added, unknown): (Vec<&str>, Vec<&str>) = names.iter().partition(|name| is_added(name));
        for (names, cause) in [(added, Cause::Unused as fn(String) -> Cause), (unknown, Cause::Unknown)] {
            if !names.is_empty() {
                self.omissions.add(scene.name(from), cause(first_names(&names)));
            }
        }
    }

    /// Lists the expressions that Maya runs for each particle, which are no values.
    pub(super) fn report_expressions(&mut self, from: NodeId, to: OwnId) {
        let rows = [
            &particle::INTERNAL_CREATION_EXPRESSION.row,
            &particle::INTERNAL_RUNTIME_BEFORE_DYNAMICS_EXPRESSION.row,
            &particle::INTERNAL_RUNTIME_AFTER_DYNAMICS_EXPRESSION.row,
        ];
        for row in rows {
            if self.graph.unset(to, row) {
                let what = format!("{}.{}", self.scene.name(from), row.name);
                self.omissions.add(what, Cause::ParticleExpression);
            }
        }
    }

    /// Rows that other modules set: the transform, the start frame, components.
    fn is_placed_elsewhere(&self, row: &Attribute) -> bool {
        use nucleus_graph::attributes::{dynamic_constraint, n_component};
        let placed = [
            &transform::TRANSLATE.row,
            &transform::ROTATE.row,
            &transform::SCALE.row,
            &transform::ROTATE_ORDER.row,
            &transform::VISIBILITY.row,
            &nucleus::START_FRAME.row,
            &particle::START_FRAME.row,
            &n_component::COMPONENT_INDICES.row,
            &dynamic_constraint::COMPONENTS.row,
        ];
        placed.contains(&row)
    }

    /// Sets an attribute. A value outside the hard range becomes the nearest inside.
    pub(super) fn set(&mut self, to: OwnId, row: &'static Attribute, setting: Setting) {
        if !self.is_own && !self.is_worth(to, row, &setting) {
            return;
        }
        let what = format!("{}.{}", self.graph.node(to).name(), row.name);
        let setting = self.at_start(&what, row, setting);
        let is_passive = self.graph.node(to).node_type().is_a(&n_rigid::N_RIGID);
        let fitted = match setting.fits(row) && (is_passive || !is_massless(&setting, row)) {
            true => Some(setting),
            false => self.fitted(&what, row, &setting),
        };
        match fitted {
            Some(fitting) => {
                if self.graph.set(to, row, fitting).is_err() {
                    self.omissions.add(what, Cause::Value("the value does not fit the attribute".to_owned()));
                }
            }
            None => {
                self.omissions.add(what, Cause::Value(format!("the attribute takes {}", row.kind.expects())))
            }
        }
    }

    /// A curve of an attribute that is read once as its value at the first frame, which is listed.
    fn at_start(&mut self, what: &str, row: &'static Attribute, setting: Setting) -> Setting {
        let start = self.frames[0] as f64;
        let held = |channel: Channel| match channel {
            Channel::Keyed(curve) => Channel::Fixed(curve.value_at(start)),
            fixed => fixed,
        };
        match setting {
            setting if row.keyable || !setting.changes() => setting,
            Setting::Fixed(_) => setting,
            Setting::Keyed(curve) => {
                self.omissions.add(what, Cause::Keys);
                of_channel(held(Channel::Keyed(curve)), row)
            }
            Setting::Parts(channels) => {
                self.omissions.add(what, Cause::Keys);
                Setting::Parts(channels.map(held))
            }
        }
    }

    /// The nearest valid setting. A number that changes is listed.
    fn fitted(&mut self, what: &str, row: &'static Attribute, setting: &Setting) -> Option<Setting> {
        let made = fitted(setting, row)?;
        if let Some(change) = first_change(row, setting, &made) {
            self.omissions.add(what, Cause::Range(change));
        }
        Some(made)
    }

    /// Whether a value says anything: Maya writes some attributes always, at their defaults, and data of its own.
    fn is_worth(&self, to: OwnId, row: &'static Attribute, setting: &Setting) -> bool {
        if matches!(row.effect, Effect::Solved(_)) && !matches!(row.kind, Kind::Ramp | Kind::ColorRamp) {
            return true;
        }
        let node_type = self.graph.node(to).node_type();
        let is_internal = !matches!(row.effect, Effect::Solved(_)) && node_type.keeps_from_view(row);
        let default = row.default.as_ref().map(|value| Setting::from(value.clone()));
        !is_internal && default.as_ref() != Some(setting)
    }

    /// The setting of an attribute.
    fn setting(
        &mut self,
        from: NodeId,
        row: &'static Attribute,
        node_type: &'static NodeType,
    ) -> Option<Setting> {
        let names = [row.short, row.name];
        let scene = self.scene;
        match row.kind {
            Kind::Bool | Kind::Int | Kind::Float | Kind::Choice(_) => {
                if self.is_fed_by_kept(from, &names) {
                    return None;
                }
                let factor = scene.units.of(Quantity::of(scene.kind(from), row.name));
                let channel =
                    self.values.channel((from, &names[..]), factor, self.frames, &mut self.omissions)?;
                Some(of_channel(channel, row))
            }
            Kind::Texture => {
                if let Some(file) = self.texture(from, &names) {
                    return Some(Setting::Fixed(Value::Painting(Painting::Texture(file))));
                }
                scene.stored(from, &names).filter(|_| self.is_own).map(|x| Setting::Fixed(Value::Float(x)))
            }
            Kind::Vector(_) => self.vector(from, row),
            Kind::Text => scene
                .string(from, &names)
                .filter(|text| self.is_own || !text.is_empty())
                .map(|text| Setting::Fixed(Value::Text(text))),
            Kind::Ints => Some(Setting::Fixed(Value::Ints(scene.listed(from, &names)))),
            Kind::Floats | Kind::Vectors => self.list(from, row, node_type),
            Kind::Ramp => ramp(&self.array_sets(from, &names))
                .map(|points| Setting::Fixed(Value::Ramp(Cow::Owned(points)))),
            Kind::ColorRamp => color_ramp(&self.array_sets(from, &names))
                .map(|points| Setting::Fixed(Value::ColorRamp(Cow::Owned(points)))),
            Kind::Texts => scene
                .value(from, &names)
                .map(|values| values.strings().collect::<Vec<_>>())
                .filter(|texts| !texts.is_empty())
                .map(|texts| Setting::Fixed(Value::Texts(texts))),
            Kind::Components | Kind::Node(_) | Kind::Together(_) | Kind::Plug(_) => None,
        }
    }

    fn array_sets(&self, from: NodeId, names: &[&str]) -> Vec<Set<'_>> {
        let names: Vec<&str> = names.to_vec();
        let scene = self.scene;
        scene.assigned(from, ANY).filter(|set| names.contains(&set.segment.name)).collect()
    }

    /// Whether a plug that is carried over, too, drives an attribute: then a connection says so.
    ///
    /// A cache that drives `playFromCache` is reported with its object.
    pub(super) fn is_fed_by_kept(&self, from: NodeId, names: &[&str]) -> bool {
        let Some(wire) = self.scene.source(from, names, None) else { return false };
        let is_apart = matches!(self.scene.kind(wire.from.node), "time" | "cacheFile" | "cacheBlend");
        is_apart || self.plug(wire.from).is_some()
    }

    fn vector(&mut self, from: NodeId, row: &'static Attribute) -> Option<Setting> {
        let parts = row.parts()?;
        let scene = self.scene;
        let whole = [row.short, row.name];
        let names: Vec<[&str; 2]> = parts.iter().map(|(long, short)| [*short, long.as_str()]).collect();
        let given =
            |names: &[&str]| scene.value(from, names).is_some() || scene.source(from, names, None).is_some();
        if !given(&whole) && !names.iter().any(|names| given(names)) {
            return None;
        }
        if self.is_fed_by_kept(from, &whole) {
            return None;
        }
        let default = match row.default {
            Some(Value::Vector(default)) => default,
            _ => [0.0; 3],
        };
        let stored: Vec<f64> =
            scene.value(from, &whole).map(|values| values.numbers().take(3).collect()).unwrap_or_default();
        let mut channels =
            [0, 1, 2].map(|part| Channel::Fixed(stored.get(part).copied().unwrap_or(default[part])));
        for part in 0..3 {
            if self.is_fed_by_kept(from, &names[part]) {
                continue;
            }
            if let Some(own) =
                self.values.channel((from, &names[part][..]), 1.0, self.frames, &mut self.omissions)
            {
                channels[part] = own;
            }
        }
        Some(Setting::Parts(channels))
    }

    /// Numbers or vectors for each point. A vertex map counts only where its type says so.
    fn list(
        &mut self,
        from: NodeId,
        row: &'static Attribute,
        node_type: &'static NodeType,
    ) -> Option<Setting> {
        let scene = self.scene;
        let names = [row.short, row.name];
        if !self.is_own
            && let Some(stem) = row.name.strip_suffix("PerVertex")
            && let Some(kind) = node_type.attribute(&format!("{stem}MapType"))
            && scene.stored(from, &[kind.short, kind.name]) != Some(1.0)
        {
            return None;
        }
        let width = if matches!(row.kind, Kind::Vectors) { 3 } else { 1 };
        let values = scene.value(from, &names)?;
        let is_counted =
            values.data_type.is_some_and(|name| name.ends_with("Array") || name.ends_with("Cache"));
        let numbers = match is_counted {
            true => match values.counted(width) {
                Ok(numbers) => numbers,
                Err((found, expected)) => {
                    let why = format!("the file promises {expected} numbers and gives {found}");
                    self.omissions.add(format!("{}.{}", scene.name(from), row.name), Cause::Value(why));
                    return None;
                }
            },
            false => scene.array(from, &names, width, &[])?,
        };
        if numbers.is_empty() && !self.is_own {
            return None;
        }
        if numbers.iter().any(|x| !x.is_finite()) {
            let why = "a number of the list is not finite".to_owned();
            self.omissions.add(format!("{}.{}", scene.name(from), row.name), Cause::Value(why));
            return None;
        }
        Some(Setting::Fixed(match row.kind {
            Kind::Vectors => Value::Vectors(numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()),
            _ => Value::Floats(numbers),
        }))
    }

    /// The image of a file texture that is connected to a map.
    fn texture(&mut self, from: NodeId, names: &[&str]) -> Option<String> {
        let scene = self.scene;
        let wire = scene.source(from, names, None)?;
        let what = format!("{}.{}", scene.name(from), names[names.len() - 1]);
        if scene.kind(wire.from.node) != "file" {
            self.omissions.add(what, Cause::Driven(scene.kind(wire.from.node).to_owned()));
            return None;
        }
        let path = scene.string(wire.from.node, &["ftn", "fileTextureName"])?;
        match self.locate(&path) {
            Some(found) => Some(found),
            None => {
                self.omissions
                    .add(what, Cause::Value(format!("the texture `{path}` is not there, or is no PNG")));
                None
            }
        }
    }
}

/// The first twelve names of a list, and how many follow.
fn first_names(names: &[&str]) -> String {
    const MOST: usize = 12;
    let mut text = names.iter().take(MOST).copied().collect::<Vec<_>>().join(", ");
    if names.len() > MOST {
        text += &format!(" and {} more", names.len() - MOST);
    }
    text
}

/// A channel as the setting of a row.
pub(super) fn of_channel(channel: Channel, row: &Attribute) -> Setting {
    match channel {
        Channel::Fixed(x) => Setting::Fixed(match row.kind {
            Kind::Bool => Value::Bool(x != 0.0),
            Kind::Int => Value::Int(x.round() as i64),
            Kind::Choice(_) => Value::Choice(Choice(x.round() as i32)),
            _ => Value::Float(x),
        }),
        Channel::Keyed(curve) => Setting::Keyed(curve),
    }
}

/// Whether a setting is a mass of 0, which Maya accepts and the solver does not.
fn is_massless(setting: &Setting, row: &Attribute) -> bool {
    is_mass(row) && *setting == Setting::Fixed(Value::Float(0.0))
}

fn is_mass(row: &Attribute) -> bool {
    [&n_base::POINT_MASS.row, &n_particle::POINT_MASS.row].contains(&row)
}

/// What takes the place of a value of 0 or less that has no meaning here: of a mass the least of its slider, and of a scale
/// of space, which Maya does not bound either, its default. The least valid one would shrink a scene to nothing.
fn in_place_of_zero(row: &Attribute) -> Option<f64> {
    match &row.default {
        _ if is_mass(row) => row.range.soft.map(|(least, _)| least),
        Some(Value::Float(default)) if row == &nucleus::SPACE_SCALE.row => Some(*default),
        _ => None,
    }
}

/// The first number that differs between a setting and the valid one that takes its place. Rounding is as in Maya.
fn first_change(row: &Attribute, from: &Setting, to: &Setting) -> Option<String> {
    let numbers = |setting: &Setting| -> Vec<f64> {
        let of = |channel: &Channel| match channel {
            Channel::Fixed(x) => vec![*x],
            Channel::Keyed(curve) => curve.keys().iter().map(|key| key.value).collect(),
        };
        match setting {
            Setting::Fixed(Value::Float(x)) => vec![*x],
            Setting::Fixed(Value::Int(x)) => vec![*x as f64],
            Setting::Fixed(Value::Choice(choice)) => vec![f64::from(choice.0)],
            Setting::Keyed(curve) => curve.keys().iter().map(|key| key.value).collect(),
            Setting::Parts(channels) => channels.iter().flat_map(of).collect(),
            Setting::Fixed(_) => Vec::new(),
        }
    };
    let rounding = if row.kind == Kind::Float || matches!(row.kind, Kind::Vector(_)) { 0.0 } else { 0.5 };
    let pairs = numbers(from).into_iter().zip(numbers(to));
    let (old, new) = pairs.into_iter().find(|(old, new)| (old - new).abs() > rounding || old.is_nan())?;
    Some(format!("{old} is not valid here: {new} takes its place"))
}

/// The nearest setting that fits a row, or one in place of a zero that has no meaning here.
fn fitted(setting: &Setting, row: &Attribute) -> Option<Setting> {
    use nucleus_graph::animation::{Curve, Key};
    let near = |x: f64| {
        let x = if x.is_finite() { x } else { 0.0 };
        if let (true, Some(other)) = (x <= 0.0, in_place_of_zero(row)) {
            return other;
        }
        let x = row.range.clamp(x);
        match row.kind {
            Kind::Bool => f64::from(u8::from(x >= 0.5)),
            Kind::Int => x.round(),
            Kind::Choice(words) => {
                let distance = |index: i32| (f64::from(index) - x).abs();
                words
                    .iter()
                    .map(|(index, _)| *index)
                    .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
                    .map_or(x, f64::from)
            }
            _ => x,
        }
    };
    let curve = |curve: &Curve| {
        let keys = curve.keys().iter().map(|key| Key { value: near(key.value), ..*key }).collect();
        let [before, after] = curve.infinities();
        Curve::new(keys).ok().map(|made| made.with_infinity(before, after))
    };
    let made = match setting {
        Setting::Fixed(Value::Float(x)) => Setting::Fixed(Value::Float(near(*x))),
        Setting::Fixed(Value::Int(x)) => Setting::Fixed(Value::Int(near(*x as f64) as i64)),
        Setting::Fixed(Value::Choice(choice)) => {
            Setting::Fixed(Value::Choice(Choice(near(f64::from(choice.0)) as i32)))
        }
        Setting::Keyed(keyed) => Setting::Keyed(curve(keyed)?),
        Setting::Parts(channels) => {
            let mut parts = [Channel::Fixed(0.0), Channel::Fixed(0.0), Channel::Fixed(0.0)];
            for (part, channel) in parts.iter_mut().zip(channels) {
                *part = match channel {
                    Channel::Fixed(x) => Channel::Fixed(near(*x)),
                    Channel::Keyed(keyed) => Channel::Keyed(curve(keyed)?),
                };
            }
            Setting::Parts(parts)
        }
        Setting::Fixed(_) => return None,
    };
    made.fits(row).then_some(made)
}

/// The numbers of the points of a ramp: position, value or colour, interpolation; whole or part by part.
fn ramp_numbers(sets: &[Set], width: usize) -> Option<Vec<Vec<f64>>> {
    let mut points: BTreeMap<u32, Vec<f64>> = BTreeMap::new();
    let usual = |points: &mut BTreeMap<u32, Vec<f64>>, index: u32| {
        points.entry(index).or_insert_with(|| vec![0.0; width]);
    };
    for set in sets {
        let Some((first, _)) = set.segment.range else { continue };
        let numbers: Vec<f64> = set.values.numbers().collect();
        let part = set.rest.last().name;
        if part.is_empty() {
            (first..).zip(numbers.chunks_exact(width)).for_each(|(index, point)| {
                points.insert(index, point.to_vec());
            });
            continue;
        }
        usual(&mut points, first);
        let Some(point) = points.get_mut(&first) else { continue };
        // `fieldScale_Position`, `clp`; `..._FloatValue`, `clc`; `..._Interp`, `cli`.
        let at = match part {
            _ if part.ends_with("_Interp") => width - 1,
            _ if part.ends_with("_Position") || part.ends_with('p') => 0,
            _ if part.ends_with('i') => width - 1,
            _ => 1,
        };
        numbers.iter().zip(&mut point[at..]).for_each(|(x, slot)| *slot = *x);
    }
    let all: Vec<Vec<f64>> = points.into_values().collect();
    let is_valid = all.iter().flatten().all(|x| x.is_finite());
    (!all.is_empty() && is_valid).then_some(all)
}

fn interpolation(x: f64) -> Choice {
    Choice(x.clamp(0.0, 3.0) as i32)
}

fn ramp(sets: &[Set]) -> Option<Vec<RampPoint>> {
    let point = |p: Vec<f64>| RampPoint { position: p[0], value: p[1], interpolation: interpolation(p[2]) };
    Some(ramp_numbers(sets, 3)?.into_iter().map(point).collect())
}

fn color_ramp(sets: &[Set]) -> Option<Vec<ColorPoint>> {
    let point = |p: Vec<f64>| ColorPoint {
        position: p[0],
        color: [p[1], p[2], p[3]],
        interpolation: interpolation(p[4]),
    };
    Some(ramp_numbers(sets, 5)?.into_iter().map(point).collect())
}
