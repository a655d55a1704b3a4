//! What Maya's creation commands connect when they make cloth from a mesh, a collider from a mesh, or a
//! constraint from components.

use crate::attributes::{
    Choice, Component, Key, Plugged, Selection, Value, dynamic_constraint, mesh, n_base, n_cloth,
    n_component, nucleus, particle, surface_shape, time,
};

use super::error::GraphError;
use super::node::NodeId;
use super::nodes::Graph;
use super::plug::Plug;
use super::setting::Setting;

/// Maya's indices of what a component consists of.
const POINT: Choice = Choice(2);
const OBJECT: Choice = Choice(6);
const LISTED: Choice = Choice(0);
const ALL: Choice = Choice(2);

impl Graph {
    /// Makes a mesh the input of a cloth, and the cloth an active object of a nucleus.
    ///
    /// # Errors
    /// When the cloth is connected already.
    pub fn create_cloth(&mut self, cloth: NodeId, mesh: NodeId, nucleus: NodeId) -> Result<(), GraphError> {
        self.drive_by_time(cloth, nucleus)?;
        self.connect(element(mesh, &surface_shape::WORLD_MESH, 0), plug(cloth, &n_base::INPUT_MESH))?;
        let output = self.make("outputCloth", &mesh::MESH, cloth);
        self.connect(plug(cloth, &n_cloth::OUTPUT_MESH), plug(output, &surface_shape::IN_MESH))?;
        let i = self.free_index(nucleus, &nucleus::INPUT_ACTIVE);
        self.connect(plug(cloth, &n_base::CURRENT_STATE), element(nucleus, &nucleus::INPUT_ACTIVE, i))?;
        self.connect(plug(cloth, &n_base::START_STATE), element(nucleus, &nucleus::INPUT_ACTIVE_START, i))?;
        self.connect(element(nucleus, &nucleus::OUTPUT_OBJECTS, i), plug(cloth, &n_base::NEXT_STATE))?;
        self.connect(plug(nucleus, &nucleus::START_FRAME), plug(cloth, &particle::START_FRAME))
    }

    /// Makes a mesh the input of a collider, and the collider a passive object of a nucleus.
    ///
    /// # Errors
    /// When the collider is connected already.
    pub fn create_collider(
        &mut self,
        collider: NodeId,
        mesh: NodeId,
        nucleus: NodeId,
    ) -> Result<(), GraphError> {
        self.drive_by_time(collider, nucleus)?;
        self.connect(element(mesh, &surface_shape::WORLD_MESH, 0), plug(collider, &n_base::INPUT_MESH))?;
        let j = self.free_index(nucleus, &nucleus::INPUT_PASSIVE);
        self.connect(plug(collider, &n_base::CURRENT_STATE), element(nucleus, &nucleus::INPUT_PASSIVE, j))?;
        self.connect(
            plug(collider, &n_base::START_STATE),
            element(nucleus, &nucleus::INPUT_PASSIVE_START, j),
        )?;
        self.connect(plug(nucleus, &nucleus::START_FRAME), plug(collider, &particle::START_FRAME))
    }

    /// Makes components members of a constraint, one node for each object they are parts of, and the
    /// constraint part of a nucleus. Components of objects that do not exist are left out.
    ///
    /// # Errors
    /// When the constraint is connected already.
    pub fn create_constraint(
        &mut self,
        constraint: NodeId,
        components: &[Component],
        nucleus: NodeId,
    ) -> Result<(), GraphError> {
        let mut objects: Vec<&str> = Vec::new();
        for component in components {
            if !objects.contains(&component.object.as_str()) {
                objects.push(&component.object);
            }
        }
        for (c, name) in (0..).zip(objects) {
            let Some(object) = self.find(name) else { continue };
            let parts = components.iter().filter(|component| component.object == name);
            let member = self.create_member(constraint, parts.map(|component| component.selection))?;
            self.connect(plug(object, &n_base::NUCLEUS_ID), plug(member, &n_component::OBJECT_ID))?;
            let id = element(constraint, &dynamic_constraint::COMPONENT_IDS, c);
            self.connect(plug(member, &n_component::OUT_COMPONENT), id)?;
        }
        self.drive_by_time(constraint, nucleus)?;
        let k = self.free_index(nucleus, &nucleus::INPUT_START);
        let start = element(constraint, &dynamic_constraint::EVAL_START, 0);
        self.connect(start, element(nucleus, &nucleus::INPUT_START, k))?;
        let current = element(constraint, &dynamic_constraint::EVAL_CURRENT, 0);
        self.connect(current, element(nucleus, &nucleus::INPUT_CURRENT, k))
    }

    /// The component node of one object.
    fn create_member(
        &mut self,
        constraint: NodeId,
        parts: impl Iterator<Item = Selection>,
    ) -> Result<NodeId, GraphError> {
        let member = self.make("nComponent", &n_component::N_COMPONENT, constraint);
        let (mut component_type, mut elements, mut listed) = (POINT, LISTED, Vec::new());
        for part in parts {
            match part {
                Selection::Object => (component_type, elements) = (OBJECT, ALL),
                Selection::AllPoints => elements = ALL,
                Selection::Points { first, last } => listed.extend(first..=last),
            }
        }
        let set = [
            (&n_component::COMPONENT_TYPE.row, Value::Choice(component_type)),
            (&n_component::ELEMENTS.row, Value::Choice(elements)),
            (&n_component::COMPONENT_INDICES.row, Value::Ints(listed)),
        ];
        for (row, value) in set {
            self.set(member, row, Setting::Fixed(value))?;
        }
        Ok(member)
    }

    /// Connects the clock to a node and, the first time, to its nucleus.
    fn drive_by_time(&mut self, node: NodeId, nucleus: NodeId) -> Result<(), GraphError> {
        let clock = self.of_type(&time::TIME).next().map(|(id, _)| id);
        let clock = clock.unwrap_or_else(|| self.make("time", &time::TIME, nucleus));
        let out_time = plug(clock, &time::OUT_TIME);
        if self.source(nucleus, &nucleus::CURRENT_TIME).is_none() {
            self.connect(out_time, plug(nucleus, &nucleus::CURRENT_TIME))?;
        }
        let is_constraint = self.node(node).node_type().is_a(&dynamic_constraint::DYNAMIC_CONSTRAINT);
        let input = if is_constraint { &dynamic_constraint::CURRENT_TIME } else { &particle::CURRENT_TIME };
        self.connect(out_time, plug(node, input))
    }

    /// The first index at which nothing is connected.
    fn free_index(&self, node: NodeId, input: &Key<Plugged>) -> u32 {
        let taken = |index| {
            let wanted =
                |to: Plug| to.node == node && to.attribute.name == input.row.name && to.index == Some(index);
            self.connections().iter().any(|connection| wanted(connection.to))
        };
        (0..).find(|&index| !taken(index)).unwrap_or_default()
    }
}

fn plug<T>(node: NodeId, key: &'static Key<T>) -> Plug {
    Plug { node, attribute: &key.row, index: None }
}

fn element<T>(node: NodeId, key: &'static Key<T>, index: u32) -> Plug {
    Plug { node, attribute: &key.row, index: Some(index) }
}
