//! The connections of Maya's creation commands: for cloth, colliders and particles of a nucleus, for constraints
//! on components, and for fields and emitters of an object.

use crate::attributes::{
    Choice, Component, ElementKind, Key, Plugged, Selection, Value, Which, dyn_base, dynamic_constraint,
    field, mesh, n_base, n_cloth, n_component, n_particle, n_rigid, nucleus, particle, point_emitter,
    surface_shape, time,
};

use super::error::GraphError;
use super::node::{NodeId, Plug};
use super::nodes::Graph;
use super::setting::Setting;

/// The arguments of a creation command.
#[derive(Debug, Clone, PartialEq)]
pub enum Creation {
    /// An object of a nucleus. Cloth and colliders need a mesh.
    Object {
        /// The mesh, for cloth and colliders.
        mesh: Option<NodeId>,
        /// The nucleus.
        nucleus: NodeId,
    },
    /// A constraint on parts of objects.
    Constraint {
        /// The parts.
        components: Vec<Component>,
        /// The nucleus.
        nucleus: NodeId,
    },
    /// A field or an emitter of an object.
    Effect {
        /// The object that the field acts on, or the particles that the emitter adds to.
        target: NodeId,
    },
}

impl Graph {
    /// Makes the connections of Maya's creation command for a node.
    ///
    /// # Errors
    /// When the node is connected already.
    pub fn create(&mut self, node: NodeId, creation: &Creation) -> Result<(), GraphError> {
        let node_type = self.node(node).node_type();
        match creation {
            Creation::Object { mesh: Some(mesh), nucleus } if node_type.is_a(&n_cloth::N_CLOTH) => {
                self.create_cloth(node, *mesh, *nucleus)
            }
            Creation::Object { mesh: Some(mesh), nucleus } if node_type.is_a(&n_rigid::N_RIGID) => {
                self.create_collider(node, *mesh, *nucleus)
            }
            Creation::Object { nucleus, .. } => self.create_particles(node, *nucleus),
            Creation::Constraint { components, nucleus } => {
                self.create_constraint(node, components, *nucleus)
            }
            Creation::Effect { target } if node_type.is_a(&field::FIELD) => self.create_field(node, *target),
            Creation::Effect { target } => self.create_emitter(node, *target),
        }
    }

    /// The arguments of the creation command that gives a node its connections. `None` if they come from no
    /// command.
    pub fn creation(&self, node: NodeId) -> Option<Creation> {
        let node_type = self.node(node).node_type();
        if node_type.is_a(&n_base::N_BASE) {
            let mesh = self.source(node, &n_base::INPUT_MESH);
            let nucleus = self.targets(node, &n_base::CURRENT_STATE).next()?.node;
            if node_type.is_a(&n_particle::N_PARTICLE) {
                return Some(Creation::Object { mesh: None, nucleus });
            }
            return mesh.map(|mesh| Creation::Object { mesh: Some(mesh), nucleus });
        }
        if node_type.is_a(&dynamic_constraint::DYNAMIC_CONSTRAINT) {
            let nucleus = self.targets(node, &dynamic_constraint::EVAL_START).next()?.node;
            self.node(node).setting(&dynamic_constraint::COMPONENTS)?;
            let components = self.node(node).get(&dynamic_constraint::COMPONENTS);
            return Some(Creation::Constraint { components, nucleus });
        }
        if node_type.is_a(&dyn_base::DYN_BASE) {
            let mut fed = self.leaving(node).filter(|wire| wire.from.index == Some(0));
            let target = fed.find(|wire| self.node(wire.to.node).node_type().is_a(&particle::PARTICLE))?;
            return Some(Creation::Effect { target: target.to.node });
        }
        None
    }

    /// Makes a mesh the input of a cloth, and the cloth an active object of a nucleus.
    ///
    /// # Errors
    /// When the cloth is connected already.
    pub fn create_cloth(&mut self, cloth: NodeId, mesh: NodeId, nucleus: NodeId) -> Result<(), GraphError> {
        self.drive_by_time(cloth, &particle::CURRENT_TIME, Some(nucleus))?;
        self.connect(
            Plug::element(mesh, &surface_shape::WORLD_MESH, 0),
            Plug::new(cloth, &n_base::INPUT_MESH),
        )?;
        let output = self.add_created("outputCloth", &mesh::MESH, cloth);
        self.connect(Plug::new(cloth, &n_cloth::OUTPUT_MESH), Plug::new(output, &surface_shape::IN_MESH))?;
        self.connect_active(cloth, nucleus)
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
        self.drive_by_time(collider, &particle::CURRENT_TIME, Some(nucleus))?;
        self.connect(
            Plug::element(mesh, &surface_shape::WORLD_MESH, 0),
            Plug::new(collider, &n_base::INPUT_MESH),
        )?;
        let (state, start) =
            (Plug::new(collider, &n_base::CURRENT_STATE), Plug::new(collider, &n_base::START_STATE));
        let j = self.free_index(nucleus, [&nucleus::INPUT_PASSIVE, &nucleus::INPUT_PASSIVE_START]);
        self.connect(state, Plug::element(nucleus, &nucleus::INPUT_PASSIVE, j))?;
        self.connect(start, Plug::element(nucleus, &nucleus::INPUT_PASSIVE_START, j))?;
        self.connect(Plug::new(nucleus, &nucleus::START_FRAME), Plug::new(collider, &particle::START_FRAME))
    }

    /// Makes particles an active object of a nucleus.
    ///
    /// # Errors
    /// When the particles are connected already.
    pub fn create_particles(&mut self, particles: NodeId, nucleus: NodeId) -> Result<(), GraphError> {
        self.drive_by_time(particles, &particle::CURRENT_TIME, Some(nucleus))?;
        self.connect_active(particles, nucleus)
    }

    /// Makes a mesh the rest shape of a cloth.
    ///
    /// # Errors
    /// When the cloth has a rest shape already.
    pub fn set_rest_shape(&mut self, cloth: NodeId, mesh: NodeId) -> Result<(), GraphError> {
        let shape = Plug::element(mesh, &surface_shape::WORLD_MESH, 0);
        self.connect(shape, Plug::new(cloth, &n_cloth::REST_SHAPE_MESH))
    }

    /// The mesh that [`Graph::set_rest_shape`] gives a cloth.
    pub fn rest_shape(&self, cloth: NodeId) -> Option<NodeId> {
        let is_mesh = |plug: &Plug| *plug == Plug::element(plug.node, &surface_shape::WORLD_MESH, 0);
        let from = self.sources(cloth, n_cloth::REST_SHAPE_MESH.row.name).next().map(|wire| wire.from);
        from.filter(is_mesh).map(|plug| plug.node)
    }

    /// Makes an emitter emit into particles.
    ///
    /// # Errors
    /// When the emitter is connected already.
    pub fn create_emitter(&mut self, emitter: NodeId, particles: NodeId) -> Result<(), GraphError> {
        self.drive_by_time(emitter, &point_emitter::CURRENT_TIME, None)?;
        let m = self.free_index(particles, [&particle::NEW_PARTICLES]);
        let output = Plug::element(emitter, &point_emitter::OUTPUT, 0);
        self.connect(output, Plug::element(particles, &particle::NEW_PARTICLES, m))?;
        self.connect(
            Plug::new(particles, &particle::IS_FULL),
            Plug::element(emitter, &point_emitter::IS_FULL, 0),
        )?;
        let step = Plug::new(particles, &particle::TIME_STEP_SIZE);
        self.connect(step, Plug::element(emitter, &point_emitter::DELTA_TIME, 0))?;
        let inherit = Plug::new(particles, &particle::INHERIT_FACTOR);
        self.connect(inherit, Plug::element(emitter, &point_emitter::INHERIT_FACTOR, 0))?;
        let start = Plug::new(particles, &particle::START_TIME);
        self.connect(start, Plug::element(emitter, &point_emitter::START_TIME, 0))?;
        let seed = Plug::element(particles, &particle::SEED, m);
        self.connect(seed, Plug::element(emitter, &point_emitter::SEED, 0))
    }

    /// Makes a field act on an object.
    ///
    /// # Errors
    /// When the field is connected already.
    pub fn create_field(&mut self, field: NodeId, object: NodeId) -> Result<(), GraphError> {
        self.connect(Plug::new(object, &particle::FIELD_DATA), Plug::element(field, &field::INPUT_DATA, 0))?;
        let q = self.leaving.first_free(object, &[particle::PP_FIELD_DATA.row.name]);
        let settings = Plug::element(object, &particle::PP_FIELD_DATA, q);
        self.connect(settings, Plug::element(field, &field::INPUT_PP_DATA, 0))?;
        let r = self.free_index(object, [&particle::INPUT_FORCE]);
        let force = Plug::element(field, &field::OUTPUT_FORCE, 0);
        self.connect(force, Plug::element(object, &particle::INPUT_FORCE, r))
    }

    /// Connects an object to the first free index on three plugs of the nucleus, and the start frame back.
    fn connect_active(&mut self, object: NodeId, nucleus: NodeId) -> Result<(), GraphError> {
        let i = self.free_index(nucleus, [&nucleus::INPUT_ACTIVE, &nucleus::INPUT_ACTIVE_START]);
        let (state, start) =
            (Plug::new(object, &n_base::CURRENT_STATE), Plug::new(object, &n_base::START_STATE));
        self.connect(state, Plug::element(nucleus, &nucleus::INPUT_ACTIVE, i))?;
        self.connect(start, Plug::element(nucleus, &nucleus::INPUT_ACTIVE_START, i))?;
        let solved = Plug::element(nucleus, &nucleus::OUTPUT_OBJECTS, i);
        self.connect(solved, Plug::new(object, &n_base::NEXT_STATE))?;
        self.connect(Plug::new(nucleus, &nucleus::START_FRAME), Plug::new(object, &particle::START_FRAME))
    }

    /// Connects a constraint to a nucleus, and its components to the constraint: one component node per object and
    /// kind of elements. Components of objects that do not exist are left out.
    ///
    /// # Errors
    /// When the constraint is connected already.
    pub fn create_constraint(
        &mut self,
        constraint: NodeId,
        components: &[Component],
        nucleus: NodeId,
    ) -> Result<(), GraphError> {
        let part = |component: &Component| (component.object.clone(), component_type(&component.selection));
        let mut parts: Vec<(String, Choice)> = Vec::new();
        for component in components {
            if !parts.contains(&part(component)) {
                parts.push(part(component));
            }
        }
        for (c, own) in (0..).zip(parts) {
            let object = self.find(&own.0).filter(|id| self.node(*id).node_type().is_a(&n_base::N_BASE));
            let Some(object) = object else { continue };
            let selections = components.iter().filter(|component| part(component) == own);
            let selections = selections.map(|component| &component.selection);
            let member = self.create_member(constraint, own.1, selections)?;
            self.connect(Plug::new(object, &n_base::NUCLEUS_ID), Plug::new(member, &n_component::OBJECT_ID))?;
            let id = Plug::element(constraint, &dynamic_constraint::COMPONENT_IDS, c);
            self.connect(Plug::new(member, &n_component::OUT_COMPONENT), id)?;
        }
        self.join_constraint(constraint, nucleus)
    }

    /// Connects the clock to a constraint, and the constraint to the first free index of a nucleus.
    ///
    /// # Errors
    /// When the constraint is connected already.
    pub fn join_constraint(&mut self, constraint: NodeId, nucleus: NodeId) -> Result<(), GraphError> {
        self.drive_by_time(constraint, &dynamic_constraint::CURRENT_TIME, Some(nucleus))?;
        let k = self.free_index(nucleus, [&nucleus::INPUT_START, &nucleus::INPUT_CURRENT]);
        let start = Plug::element(constraint, &dynamic_constraint::EVAL_START, 0);
        self.connect(start, Plug::element(nucleus, &nucleus::INPUT_START, k))?;
        let current = Plug::element(constraint, &dynamic_constraint::EVAL_CURRENT, 0);
        self.connect(current, Plug::element(nucleus, &nucleus::INPUT_CURRENT, k))
    }

    /// Adds the component node of elements of one kind. Selections by meaning, other than all borders, are the text of
    /// `select`, one after another with semicolons between.
    fn create_member<'a>(
        &mut self,
        constraint: NodeId,
        component_type: Choice,
        selections: impl Iterator<Item = &'a Selection>,
    ) -> Result<NodeId, GraphError> {
        let member = self.add_created("nComponent", &n_component::N_COMPONENT, constraint);
        let (mut elements, mut listed, mut meanings) = (n_component::LISTED, Vec::new(), Vec::new());
        for selection in selections {
            match selection {
                Selection::Object | Selection::Elements(_, Which::All) => elements = n_component::ALL,
                Selection::Elements(_, Which::Range(first, last)) => listed.extend(*first..=*last),
                Selection::Elements(_, meaning) => meanings.push(meaning.to_string()),
            }
        }
        if elements != n_component::ALL && listed.is_empty() && meanings == ["border"] {
            (elements, meanings) = (n_component::BORDERS, Vec::new());
        }
        let mut set = vec![
            (&n_component::COMPONENT_TYPE.row, Value::Choice(component_type)),
            (&n_component::ELEMENTS.row, Value::Choice(elements)),
            (&n_component::COMPONENT_INDICES.row, Value::Ints(listed)),
        ];
        if !meanings.is_empty() {
            set.push((&n_component::SELECT.row, Value::Text(meanings.join("; "))));
        }
        for (row, value) in set {
            self.set_created(member, row, Setting::Fixed(value))?;
        }
        Ok(member)
    }

    /// Connects the clock to a node, and to its nucleus if that has neither a connection nor a time of its own.
    fn drive_by_time(
        &mut self,
        node: NodeId,
        input: &'static Key<f64>,
        nucleus: Option<NodeId>,
    ) -> Result<(), GraphError> {
        let out_time = Plug::new(self.clock(), &time::OUT_TIME);
        if let Some(nucleus) = nucleus
            && self.source(nucleus, &nucleus::CURRENT_TIME).is_none()
            && self.node(nucleus).setting(&nucleus::CURRENT_TIME).is_none()
        {
            self.connect(out_time, Plug::new(nucleus, &nucleus::CURRENT_TIME))?;
        }
        self.connect(out_time, Plug::new(node, input))
    }

    /// The first index that is free on all of these multi inputs.
    fn free_index<const N: usize>(&self, node: NodeId, inputs: [&Key<Plugged>; N]) -> u32 {
        self.arriving.first_free(node, &inputs.map(|key| key.row.name))
    }
}

/// Maya's index of the kind of elements of a selection.
fn component_type(selection: &Selection) -> Choice {
    match selection {
        Selection::Object => n_component::OBJECT,
        Selection::Elements(ElementKind::Point, _) => n_component::POINT,
        Selection::Elements(ElementKind::Edge, _) => n_component::EDGE,
        Selection::Elements(ElementKind::Face, _) => n_component::FACE,
    }
}
