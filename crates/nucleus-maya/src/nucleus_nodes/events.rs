//! Collision events of particles. Maya keeps an element of several arrays for each event, and a connection to its target.

use std::collections::BTreeMap;

use nucleus_graph::attributes::{Attribute, Value, n_particle, particle};
use nucleus_graph::graph::{NodeId as OwnId, Setting};

use crate::omissions::Cause;
use crate::scene::NodeId;

use super::importer::Importer;

/// The lists of events, with the value of an event that a list leaves out.
fn rows() -> [(&'static Attribute, f64); 6] {
    [
        (&particle::EVENT_COUNT.row, 0.0),
        (&particle::EVENT_EMIT.row, 0.0),
        (&particle::EVENT_SPLIT.row, 0.0),
        (&particle::EVENT_DIE.row, 0.0),
        (&particle::EVENT_RANDOM.row, 0.0),
        (&particle::EVENT_SPREAD.row, 0.5),
    ]
}

impl Importer<'_> {
    /// Sets the collision events of particles. All of them are left out where one emits into an object that is
    /// no nParticle of the scene.
    pub(super) fn set_events(&mut self, from: NodeId, to: OwnId) {
        let lists = rows().map(|(row, _)| self.elements_of(from, row));
        let valid = self.elements_of(from, &particle::EVENT_VALID.row);
        // Deleted events leave gaps.
        let mut events: Vec<u32> = lists.iter().flat_map(|list| list.keys().copied()).collect();
        events.retain(|event| valid.get(event) != Some(&0.0));
        events.sort_unstable();
        events.dedup();
        let emitting: Vec<u32> =
            events.iter().copied().filter(|event| lists[1].get(event).is_some_and(|x| *x > 0.0)).collect();
        match self.event_targets(from, to, (&events, &emitting)) {
            Ok(names) if names.is_empty() => {}
            Ok(names) => {
                self.set(to, &n_particle::EVENT_PARTICLES.row, Setting::Fixed(Value::Texts(names)));
            }
            Err(why) => {
                let what = format!("{}.{}", self.scene.name(from), particle::EVENT_TARGET.row.name);
                let why = format!("{why}; none of its collision events is carried over");
                self.omissions.add(what, Cause::Value(why));
                events.clear();
            }
        }
        for ((row, default), list) in rows().into_iter().zip(lists) {
            self.graph.unset(to, row);
            // Maya marks an element without a value by -1.
            let value = |event: &u32| list.get(event).copied().filter(|x| *x >= 0.0).unwrap_or(default);
            let values: Vec<f64> = events.iter().map(value).collect();
            if !values.is_empty() {
                self.set(to, row, Setting::Fixed(Value::Floats(values)));
            }
        }
        self.report_procedures(from, &events);
    }

    /// The names of the nParticles that events emit into: one for all, or one per event where they differ, empty for their
    /// own; none where all emit into their own.
    ///
    /// # Errors
    /// When one is not carried over.
    fn event_targets(
        &self,
        from: NodeId,
        to: OwnId,
        (events, emitting): (&[u32], &[u32]),
    ) -> Result<Vec<String>, String> {
        let row = &particle::EVENT_TARGET.row;
        let wires: BTreeMap<u32, NodeId> = self
            .scene
            .sources(from, &[row.short, row.name])
            .into_iter()
            .map(|(event, wire)| (event, wire.from.node))
            .collect();
        let target = |event: &u32| match wires.get(event).filter(|_| emitting.contains(event)) {
            None => Ok(String::new()),
            Some(node) => self
                .own_of(*node)
                .filter(|own| self.graph.node(*own).node_type().is_a(&n_particle::N_PARTICLE))
                .map(|own| if own == to { String::new() } else { self.graph.node(own).name().to_owned() })
                .ok_or_else(|| {
                    let name = self.scene.name(*node);
                    format!("`{name}`, which an event emits into, is not carried over")
                }),
        };
        let names = events.iter().map(target).collect::<Result<Vec<String>, String>>()?;
        let mut of_emitting = events.iter().zip(&names).filter(|(event, _)| emitting.contains(event));
        let first = of_emitting.next().map_or("", |(_, name)| name);
        Ok(match of_emitting.all(|(_, name)| name == first) {
            true if first.is_empty() => Vec::new(),
            true => vec![first.to_owned()],
            false => names,
        })
    }

    fn report_procedures(&mut self, from: NodeId, events: &[u32]) {
        let row = &particle::EVENT_PROC.row;
        let names = [row.short, row.name];
        let called = self.scene.assigned(from, &names).filter_map(|set| {
            let (event, _) = set.segment.range?;
            set.values.text().filter(|text| events.contains(&event) && !text.is_empty())
        });
        for procedure in called.collect::<Vec<_>>() {
            let what = format!("{}.{}", self.scene.name(from), row.name);
            self.omissions.add(what, Cause::Value(format!("the procedure `{procedure}` is not called")));
        }
    }

    /// The elements of an array that files give, by their index.
    fn elements_of(&self, from: NodeId, row: &Attribute) -> BTreeMap<u32, f64> {
        let names = [row.short, row.name];
        let sets =
            self.scene.assigned(from, &names).filter_map(|set| Some((set.segment.range?.0, set.values)));
        let mut all = BTreeMap::new();
        sets.for_each(|(first, values)| {
            all.extend((first..).zip(values.numbers().filter(|x| x.is_finite())))
        });
        all
    }
}
