//! The nodes that a simulation needs, and their names in our scene.
//!
//! In Maya, a mesh is a shape under a transform. Ours is one node, named as the transform, which is what artists see.

use std::collections::{BTreeMap, BTreeSet};

use nucleus_graph::attributes::{self, NodeType};
use nucleus_graph::graph::is_a_name;

use crate::omissions::{Cause, Omissions};
use crate::scene::{MayaScene, NodeId, is_shape};

/// `fileInfo` key of files that this crate writes: their values are taken as they are.
pub(crate) const OWN_FILE: &str = "nucleusScene";
/// Added attribute: the name of a node, where Maya does not allow it.
pub(crate) const MARK_NAME: &str = "nucleusName";
/// Added attribute: attributes whose values follow from the mesh, as Maya's creation commands compute them.
pub(crate) const MARK_AUTOMATIC: &str = "nucleusAutomatic";
/// Added attribute, before the name of another: where its values for points come from.
pub(crate) const MARK_PAINT: &str = "nucleusPaint_";

/// A node that is carried over.
#[derive(Debug, Clone)]
pub(super) struct Kept {
    /// The shape, or a node without one.
    pub(super) node: NodeId,
    /// The transform that becomes one node with it.
    pub(super) transform: Option<NodeId>,
    /// The type of our node; `None` for a mesh until its kind is known.
    pub(super) node_type: Option<&'static NodeType>,
    /// The name of our node.
    pub(super) name: String,
}

/// The nodes to carry over.
#[derive(Debug, Default)]
pub(super) struct KeptNodes {
    /// In the order of names.
    pub(super) all: Vec<Kept>,
    /// By shape and by transform.
    pub(super) by_node: BTreeMap<NodeId, usize>,
    names: BTreeSet<String>,
}

impl KeptNodes {
    /// Chooses the nodes.
    pub(super) fn of(scene: &MayaScene, is_own: bool, omissions: &mut Omissions) -> Self {
        let mut chosen: BTreeSet<NodeId> = BTreeSet::new();
        let nuclei = nuclei(scene, is_own, omissions);
        chosen.extend(&nuclei);
        for id in scene.ids() {
            let joined = match scene.kind(id) {
                "nCloth" | "nRigid" | "nParticle" => member_of(scene, id, &nuclei),
                "dynamicConstraint" => member_of(scene, id, &nuclei),
                "hairSystem" if member_of(scene, id, &nuclei) => {
                    omissions.add(scene.name(id), Cause::OtherMember("hairSystem".to_owned()));
                    continue;
                }
                _ => continue,
            };
            if joined || (is_own && scene.kind(id) != "mesh") {
                chosen.insert(id);
            } else {
                omissions.add(scene.name(id), Cause::NoNucleus);
            }
        }
        let objects: Vec<NodeId> = chosen.iter().copied().collect();
        for id in objects {
            chosen.extend(sources_of(scene, id));
        }
        let effects = effects(scene, &chosen, is_own);
        chosen.extend(effects.iter().filter_map(|id| surface_of(scene, *id)));
        chosen.extend(effects);
        chosen.extend(cameras(scene));
        let everything = is_own || nuclei.is_empty();
        if everything {
            chosen.extend(
                scene
                    .of_kind("mesh")
                    .filter(|id| !is_output(scene, *id))
                    .filter(|id| is_own || !scene.switch_or(*id, &["io", "intermediateObject"], false)),
            );
        }
        if is_own {
            let shapes = scene.children();
            let is_bare = |id: &NodeId| {
                shapes.get(id).is_none_or(|all| all.iter().all(|child| scene.kind(*child) == "transform"))
            };
            chosen.extend(scene.of_kind("transform").filter(is_bare));
        }
        Self::named(scene, chosen)
    }

    /// Adds the ancestors, and gives all nodes their names.
    fn named(scene: &MayaScene, chosen: BTreeSet<NodeId>) -> Self {
        let mut kept = Self::default();
        let mut taken: BTreeSet<NodeId> = BTreeSet::new();
        // The first shape of a transform becomes one node with it; an nBase never moves and only takes its name.
        let mut order: Vec<NodeId> = chosen.iter().copied().collect();
        order.sort_by_key(|id| (scene.kind(*id).starts_with('n'), *id));
        let mut entries: Vec<(NodeId, Option<NodeId>)> = Vec::new();
        for id in order {
            let below = scene.node(id).parent.filter(|_| is_shape(scene.kind(id)));
            let transform = below.filter(|parent| taken.insert(*parent));
            entries.push((id, transform));
        }
        let mut ancestors: BTreeSet<NodeId> = BTreeSet::new();
        for (id, transform) in &entries {
            if scene.kind(*id).starts_with('n') && scene.kind(*id) != "nucleus" {
                continue;
            }
            for node in scene.self_and_ancestors(transform.unwrap_or(*id)).into_iter().skip(1) {
                ancestors.insert(node);
            }
        }
        let known: BTreeSet<NodeId> =
            entries.iter().flat_map(|(id, transform)| [Some(*id), *transform]).flatten().collect();
        entries.extend(ancestors.into_iter().filter(|id| !known.contains(id)).map(|id| (id, None)));
        entries.sort();
        for (node, transform) in entries {
            let visible = transform.unwrap_or(node);
            let marked = scene.string(node, &[MARK_NAME]).or_else(|| scene.string(visible, &[MARK_NAME]));
            let name = kept.free_name(&marked.unwrap_or_else(|| scene.name(visible).to_owned()));
            let node_type = match scene.kind(node) {
                "mesh" => None,
                kind => attributes::node_type(kind).or(Some(&attributes::transform::TRANSFORM)),
            };
            kept.all.push(Kept { node, transform, node_type, name });
        }
        kept.all.sort_by(|a, b| a.name.cmp(&b.name));
        for (index, one) in kept.all.iter().enumerate() {
            kept.by_node.insert(one.node, index);
            one.transform.into_iter().for_each(|transform| {
                kept.by_node.insert(transform, index);
            });
        }
        kept
    }

    /// A name that is valid and not taken yet.
    pub(super) fn free_name(&mut self, wanted: &str) -> String {
        let valid = |c: char| if is_a_name(&c.to_string()) { c } else { '_' };
        let plain: String = wanted.chars().map(valid).collect();
        let plain = if plain.is_empty() { "node".to_owned() } else { plain };
        let mut name = plain.clone();
        let mut number = 2;
        while name == nucleus_graph::graph::CLOCK || !self.names.insert(name.clone()) {
            name = format!("{plain}_{number}");
            number += 1;
        }
        name
    }
}

/// The nuclei with members. One without is only kept in a scene of our own.
fn nuclei(scene: &MayaScene, is_own: bool, omissions: &mut Omissions) -> BTreeSet<NodeId> {
    let mut kept = BTreeSet::new();
    for id in scene.of_kind("nucleus") {
        let inputs: [&[&str]; 3] =
            [&["niao", "inputActive"], &["nipo", "inputPassive"], &["nias", "inputActiveStart"]];
        let has_members = inputs.iter().any(|names| scene.source(id, names, None).is_some());
        if has_members || is_own {
            kept.insert(id);
        } else {
            omissions.add(scene.name(id), Cause::EmptyNucleus);
        }
    }
    kept
}

/// Whether a node feeds one of these nuclei.
fn member_of(scene: &MayaScene, id: NodeId, nuclei: &BTreeSet<NodeId>) -> bool {
    nucleus_of(scene, id).is_some_and(|nucleus| nuclei.contains(&nucleus))
}

/// The nucleus that an object or a constraint is connected to.
pub(super) fn nucleus_of(scene: &MayaScene, id: NodeId) -> Option<NodeId> {
    let outputs = ["cust", "currentState", "stst", "startState", "evs", "evalStart", "evc", "evalCurrent"];
    let wire = scene.leaving(id).find(|wire| {
        outputs.contains(&scene.path(wire.from).last().name) && scene.kind(wire.to.node) == "nucleus"
    });
    wire.map(|wire| wire.to.node)
}

/// The mesh of an object, and its rest shape.
fn sources_of(scene: &MayaScene, id: NodeId) -> Vec<NodeId> {
    let inputs: [&[&str]; 2] = [&["imsh", "inputMesh"], &["rsmh", "restShapeMesh"]];
    let of = |names: &&[&str]| scene.source(id, names, None).map(|wire| wire.from.node);
    if !matches!(scene.kind(id), "nCloth" | "nRigid") {
        return Vec::new();
    }
    inputs.iter().filter_map(of).collect()
}

/// Fields and emitters of objects that are carried over; in a Nucleus scene, all.
fn effects(scene: &MayaScene, chosen: &BTreeSet<NodeId>, is_own: bool) -> Vec<NodeId> {
    let is_effect = |id: &NodeId| {
        let node_type = attributes::node_type(scene.kind(*id));
        node_type.is_some_and(|node_type| node_type.is_a(&attributes::dyn_base::DYN_BASE))
    };
    let acts = |id: &NodeId| scene.leaving(*id).any(|wire| chosen.contains(&wire.to.node));
    scene.ids().filter(|id| is_effect(id) && (is_own || acts(id))).collect()
}

/// The mesh that a surface emitter lies on: a shape of its parent.
fn surface_of(scene: &MayaScene, id: NodeId) -> Option<NodeId> {
    const SURFACE: f64 = 2.0;
    let parent = scene.node(id).parent?;
    let is_surface =
        scene.kind(id) == "pointEmitter" && scene.stored_or(id, &["emt", "emitterType"], 1.0) == SURFACE;
    let is_shown = |mesh: &NodeId| !scene.switch_or(*mesh, &["io", "intermediateObject"], false);
    let shapes = scene.of_kind("mesh").filter(|mesh| scene.node(*mesh).parent == Some(parent));
    shapes.filter(is_shown).find(|mesh| is_surface && !is_output(scene, *mesh))
}

/// Cameras of the artist; else the perspective view that every file has.
fn cameras(scene: &MayaScene) -> Vec<NodeId> {
    let is_flat = |id: &NodeId| scene.switch_or(*id, &["o", "orthographic"], false);
    let all: Vec<NodeId> = scene.of_kind("camera").filter(|id| !is_flat(id)).collect();
    let is_usual = |id: &NodeId| scene.name(*id) == "perspShape";
    let own: Vec<NodeId> = all.iter().copied().filter(|id| !is_usual(id)).collect();
    if own.is_empty() { all } else { own }
}

/// Whether a mesh only displays the result of a cloth.
pub(super) fn is_output(scene: &MayaScene, id: NodeId) -> bool {
    let mut at = id;
    for _ in 0..64 {
        let inputs: [&[&str]; 3] = [&["i", "inMesh"], &["ip", "inputPolymesh"], &["ig", "inputGeometry"]];
        let Some(wire) = inputs.iter().find_map(|names| scene.source(at, names, None)) else { return false };
        at = wire.from.node;
        if matches!(scene.kind(at), "nCloth" | "nParticle") {
            return true;
        }
    }
    false
}
