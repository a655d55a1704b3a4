//! Values of attributes, by all names that they may have in a file.

use std::collections::BTreeMap;

use crate::ascii::{PlugPath, Segment, Values};

use super::graph::{Assigned, MayaScene, NodeId, Wire};
use super::units::Quantity;

/// The names of an attribute: short, long, and those of older versions.
pub type Names = &'static [&'static str];

/// A vector attribute: names of the whole and of its components.
#[derive(Debug, Clone, Copy)]
pub struct Vector3 {
    /// The names of the whole.
    pub whole: Names,
    /// The names of x, y and z.
    pub parts: [Names; 3],
}

/// A value that a file gives, with the rest of its path after the name that was asked for.
#[derive(Debug, Clone)]
pub struct Set<'a> {
    /// The step that has the name, with its index range.
    pub segment: Segment<'a>,
    /// The path after it.
    pub rest: PlugPath<'a>,
    /// The values.
    pub values: Values<'a>,
}

/// Names that fit any attribute.
pub const ANY: Names = &[];

impl MayaScene {
    /// All values of an attribute or of parts of it, in the order of the files. [`ANY`] gives those of all attributes.
    pub fn assigned<'a>(&'a self, id: NodeId, names: &'a [&'a str]) -> impl Iterator<Item = Set<'a>> + 'a {
        self.node(id).assigned.iter().filter_map(move |one| {
            let (segment, rest) = PlugPath(self.text(one.plug)).split_first();
            if !names.is_empty() && !names.contains(&segment.name) {
                return None;
            }
            let data_type = Some(self.text(one.data_type)).filter(|name| !name.is_empty());
            Some(Set { segment, rest, values: Values::new(data_type, self.text(one.value)) })
        })
    }

    /// The last value of a plain attribute.
    pub fn value<'a>(&'a self, id: NodeId, names: &'a [&'a str]) -> Option<Values<'a>> {
        self.last_assigned(id, names).map(|(_, values)| values)
    }

    fn last_assigned<'a>(&'a self, id: NodeId, names: &'a [&'a str]) -> Option<(&'a Assigned, Values<'a>)> {
        let all = self.node(id).assigned.iter().rev();
        let mut found = all.filter_map(|one| {
            let path = PlugPath(self.text(one.plug));
            if !names.contains(&path.last().name) {
                return None;
            }
            let data_type = Some(self.text(one.data_type)).filter(|name| !name.is_empty());
            let values = Some(Values::new(data_type, self.text(one.value)));
            Some(one).zip(values.filter(|values| !values.is_empty()))
        });
        found.next()
    }

    /// A stored number, finite. Lengths and angles are in the units of the scene.
    pub fn stored(&self, id: NodeId, names: &[&str]) -> Option<f64> {
        let (assigned, values) = self.last_assigned(id, names)?;
        values.number().map(|x| x * self.unit_factor(id, assigned)).filter(|x| x.is_finite())
    }

    /// Units of the scene in a unit of the file that sets an attribute; 1 for an attribute without a unit.
    fn unit_factor(&self, id: NodeId, assigned: &Assigned) -> f64 {
        let units = self.units_in(assigned.value.file);
        if units == self.units {
            return 1.0;
        }
        let quantity = Quantity::of(self.kind(id), PlugPath(self.text(assigned.plug)).last().name);
        units.of(quantity) / self.units.of(quantity)
    }

    /// A stored number, or a default.
    pub fn stored_or(&self, id: NodeId, names: &[&str], default: f64) -> f64 {
        self.stored(id, names).unwrap_or(default)
    }

    /// A stored whole number, or a default, within 0 to a million.
    pub fn count_or(&self, id: NodeId, names: &[&str], default: u32) -> u32 {
        self.stored(id, names).map_or(default, |x| x.clamp(0.0, 1e6) as u32)
    }

    /// A stored switch, or a default.
    pub fn switch_or(&self, id: NodeId, names: &[&str], default: bool) -> bool {
        self.stored(id, names).map_or(default, |x| x != 0.0)
    }

    /// A stored text.
    pub fn string(&self, id: NodeId, names: &[&str]) -> Option<String> {
        self.value(id, names)?.text()
    }

    /// The stored components of a vector, each with its default where it is not set. Lengths and angles are in the units
    /// of the scene.
    pub fn stored_vector(&self, id: NodeId, vector: Vector3, default: [f64; 3]) -> [f64; 3] {
        let mut value = default;
        for one in &self.node(id).assigned {
            let last = PlugPath(self.text(one.plug)).last();
            let numbers = || {
                let factor = self.unit_factor(id, one);
                let numbers = Values::new(None, self.text(one.value)).numbers();
                numbers.map(move |x| x * factor).filter(|x| x.is_finite())
            };
            if vector.whole.contains(&last.name) {
                numbers().take(3).enumerate().for_each(|(part, x)| value[part] = x);
            } else if let Some(part) = vector.parts.iter().position(|names| names.contains(&last.name)) {
                numbers().take(1).for_each(|x| value[part] = x);
            }
        }
        value
    }

    /// A stored 4 x 4 matrix, row by row.
    pub fn matrix(&self, id: NodeId, names: &[&str], index: Option<u32>) -> Option<[f64; 16]> {
        let found = self.assigned(id, names).filter(|set| match (index, set.segment.range) {
            (Some(index), Some((first, _))) => index == first,
            (None, None) => true,
            _ => false,
        });
        // `-type "matrix" "xform" ...` begins with words.
        let numbers: Vec<f64> = found.last()?.values.numbers().collect();
        <[f64; 16]>::try_from(numbers.get(..16)?).ok().filter(|all| all.iter().all(|x| x.is_finite()))
    }

    /// The numbers of an array attribute, `width` for each element, in the order of the indices. Elements that no file
    /// gives are 0. `None` if an index is far beyond the given elements: a broken file.
    pub fn array(&self, id: NodeId, names: &[&str], width: usize, parts: &[Names]) -> Option<Vec<f64>> {
        let mut all: Vec<f64> = Vec::new();
        let mut given = 0;
        for set in self.assigned(id, names) {
            let Some((first, _)) = set.segment.range else { continue };
            let last = set.rest.last().name;
            let part = parts.iter().position(|names| names.contains(&last));
            let start = (first as usize).checked_mul(width)?.checked_add(part.unwrap_or(0))?;
            let limit = if part.is_some() { 1 } else { usize::MAX };
            for (k, number) in set.values.numbers().take(limit).enumerate() {
                given += 1;
                let at = start + k;
                if at >= all.len() {
                    // Sparse arrays have gaps, but a gap of a million elements is no array.
                    if at > 64 * given + 3_000_000 {
                        return None;
                    }
                    all.resize(at + 1, 0.0);
                }
                all[at] = number;
            }
        }
        let rest = all.len() % width.max(1);
        if rest != 0 {
            all.resize(all.len() + width - rest, 0.0);
        }
        Some(all)
    }

    /// The elements of a list that files give, in the order of their indices: gaps are no elements.
    pub fn listed(&self, id: NodeId, names: &[&str]) -> Vec<u32> {
        let mut all: BTreeMap<u32, u32> = BTreeMap::new();
        for set in self.assigned(id, names) {
            let Some((first, _)) = set.segment.range else { continue };
            all.extend((first..).zip(set.values.numbers().map(|x| x.max(0.0) as u32)));
        }
        all.into_values().collect()
    }

    /// The connection that arrives at an attribute, by the last step of its path. With an index, at that element.
    pub fn source(&self, id: NodeId, names: &[&str], index: Option<u32>) -> Option<Wire> {
        self.arriving(id).rev().find(|wire| {
            let fits = |segment: Segment| {
                names.contains(&segment.name)
                    && index.is_none_or(|index| segment.range.is_none_or(|range| range.0 == index))
            };
            // Only the end of the path counts: `ip[0].ig`, `t.tx`.
            let segments: Vec<Segment> = self.path(wire.to).segments().collect();
            segments.last().is_some_and(|last| fits(*last))
        })
    }

    /// All connections that arrive at elements of an array, by their index.
    pub fn sources(&self, id: NodeId, names: &[&str]) -> Vec<(u32, Wire)> {
        let index = |wire: &Wire| {
            self.path(wire.to)
                .segments()
                .find(|segment| names.contains(&segment.name))?
                .range
                .map(|range| range.0)
        };
        let mut all: Vec<(u32, Wire)> =
            self.arriving(id).filter_map(|wire| Some((index(&wire)?, wire))).collect();
        all.sort_by_key(|(index, _)| *index);
        all
    }
}
