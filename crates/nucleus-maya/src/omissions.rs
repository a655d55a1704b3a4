//! Omissions of an import: parts that it leaves out or changes, each with the node, the reason and the effect on the
//! result.

use std::collections::BTreeMap;
use std::fmt;

/// Why something is left out.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Cause {
    /// The file ends inside a statement.
    Cut,
    /// A command that only Maya can carry out.
    Command,
    /// A unit that is not known.
    Unit,
    /// A unit of time whose frames are longer than a scene allows.
    FrameRate,
    /// A referenced file that is not there.
    NoFile,
    /// A file that refers to itself.
    Recursion,
    /// A referenced file that cannot be read, and why.
    Unreadable(String),
    /// An edit of a node that no file holds.
    EditOfMissing,
    /// An instance of a node, by its parent or its number.
    Instance(String),
    /// A node that belongs to no nucleus, or whose nucleus is missing.
    NoNucleus,
    /// A nucleus without members.
    EmptyNucleus,
    /// An object of a nucleus that Nucleus does not have, by its type.
    OtherMember(String),
    /// A mesh that cannot be built, and why.
    Mesh(String),
    /// A node in the history or deformation of a mesh that is passed over, by its type.
    Operator(String),
    /// Skinning by dual quaternions, or by a blend of both methods.
    Skinning,
    /// A mesh file of a Nucleus scene that is not beside the new scene.
    NoMeshFile(String),
    /// A file of values or a texture that a Nucleus scene names, and that is not there.
    NoValueFile(String),
    /// An attribute whose value does not fit, and why.
    Value(String),
    /// A value outside the range of an attribute, and which one takes its place.
    Range(String),
    /// Keys on an attribute that is read once, at the start.
    Keys,
    /// Attributes that the simulation has no use for.
    Unused(String),
    /// Attributes that are in no table.
    Unknown(String),
    /// An expression that Maya runs for each particle.
    ParticleExpression,
    /// An attribute that another node drives in a way that is not read; its type.
    Driven(String),
    /// An expression that cannot be translated, and why.
    Expression(String),
    /// Something that is carried over as an approximation, and how.
    Approximate(String),
    /// A mesh that is written at its first frame only, and why.
    Motion(String),
    /// Particles whose transform is animated.
    MovingParticles,
    /// A part of a constraint.
    Component(String),
    /// A connection between nodes that are carried over.
    Connection(String),
    /// A connection to an attribute without effect, and why it has none.
    NoEffect(String),
    /// Playback of a cache outside of its range, or backwards.
    CacheRange,
    /// Recorded results that lie beside the scene.
    Cache(String),
}

impl Cause {
    /// Why it is left out.
    pub fn reason(&self) -> String {
        match self {
            Self::Cut => "the file ends inside this statement: it was cut off".to_owned(),
            Self::Command => "this command is not carried out; nothing in a scene is".to_owned(),
            Self::Unit => "the unit is not known".to_owned(),
            Self::FrameRate => {
                "a frame in this unit is longer than the 1000 s that a scene allows".to_owned()
            }
            Self::NoFile => "the referenced file is not there".to_owned(),
            Self::Recursion => "the file refers to itself".to_owned(),
            Self::Unreadable(why) => format!("the referenced file cannot be read: {why}"),
            Self::EditOfMissing => {
                "an edit of a reference names a node or a connection that no file holds".to_owned()
            }
            Self::Instance(which) => format!("the instance `{which}` is not read"),
            Self::NoNucleus => "it is connected to no nucleus".to_owned(),
            Self::EmptyNucleus => "nothing is connected to it".to_owned(),
            Self::OtherMember(kind) => format!("a {kind} is not solved"),
            Self::Mesh(why) => format!("its mesh cannot be built: {why}"),
            Self::Operator(kind) => format!("{kind} is not carried out"),
            Self::Skinning => "skinning by dual quaternions is carried out linearly".to_owned(),
            Self::NoMeshFile(file) => format!("`{file}` is not there: the mesh in the Maya scene is used"),
            Self::NoValueFile(file) => {
                format!("`{file}` is neither beside the Maya scene nor beside the new one")
            }
            Self::Value(why)
            | Self::Range(why)
            | Self::Component(why)
            | Self::Approximate(why)
            | Self::Motion(why) => why.clone(),
            Self::Keys => "it is animated, but here it is read once, at the start".to_owned(),
            Self::Unused(names) => format!("the simulation has no use for {names}"),
            Self::Unknown(names) => format!("these attributes are unknown: {names}"),
            Self::ParticleExpression => "Maya's expressions of particles are not run".to_owned(),
            Self::Driven(kind) => format!("it is driven by a {kind}, which is not read"),
            Self::Expression(why) => format!("the expression cannot be translated: {why}"),
            Self::Connection(why) => format!("the connection is refused: {why}"),
            Self::NoEffect(lack) => format!("the attribute {lack}"),
            Self::MovingParticles => "the transform of these particles is animated".to_owned(),
            Self::CacheRange => "caches are played forwards, once".to_owned(),
            Self::Cache(_) => "the scene plays recorded results".to_owned(),
        }
    }

    /// How the result differs for it.
    pub fn effect(&self) -> &str {
        match self {
            Self::Cut => "everything after it is missing",
            Self::Command | Self::Unused(_) | Self::EmptyNucleus => "none on the simulation",
            Self::Unit => "the unit stays Maya's default",
            Self::FrameRate => {
                "the scene is refused until `fps` is a rate; or save it with frames as the unit of time in Maya"
            }
            Self::Unknown(_) => "they are left out; the result differs if Maya's depends on them",
            Self::ParticleExpression => {
                "it is left out; write it as `creationExpression` or `runtimeExpression` of the nParticle"
            }
            Self::NoFile | Self::Recursion | Self::Unreadable(_) => "its nodes are missing",
            Self::EditOfMissing => "the edit is left out",
            Self::Instance(_) => "the first instance stands for it, at its own place",
            Self::NoNucleus => "it is not simulated, as in Maya",
            Self::OtherMember(_) => "other members do not feel it",
            Self::Mesh(_) => "its object is left out; give the mesh with `--mesh NAME=FILE.obj`",
            Self::Operator(_) => {
                "the mesh is as before this node; give it with `--mesh NAME=FILE.obj` if that matters"
            }
            Self::Skinning => "the mesh is thinner where joints twist or bend far",
            Self::NoMeshFile(_) => "the mesh stands still, with its points at the first frame",
            Self::NoValueFile(_) => "the scene is refused until the file is there",
            Self::Value(_) => "the attribute keeps its default, or the nearest valid value",
            Self::Range(_) => "a valid value takes its place",
            Self::Keys => "it keeps its value at the first frame",
            Self::Driven(_) | Self::Expression(_) => "it keeps the value stored in the file",
            Self::Approximate(_) => "small differences",
            Self::Motion(_) => "it stands still; import its file into Maya for the motion",
            Self::MovingParticles => "particles start at its first placement, and do not move with it",
            Self::Component(_) => "this part of the constraint does not act",
            Self::Connection(_) | Self::NoEffect(_) => "the connection is left out",
            Self::CacheRange => "outside of the range of the cache the object is simulated",
            Self::Cache(how) => how,
        }
    }
}

/// The omissions of an import: what, why, and how often. Equal ones are counted, not repeated.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Omissions {
    all: BTreeMap<(String, Cause), usize>,
}

/// Omissions beyond this number are only counted.
const MAX: usize = 10_000;

impl Omissions {
    /// Adds an omission: a node, an attribute, a file or a command, and why.
    pub fn add(&mut self, what: impl Into<String>, cause: Cause) {
        let key = (what.into(), cause);
        if self.all.len() < MAX || self.all.contains_key(&key) {
            *self.all.entry(key).or_default() += 1;
        }
    }

    /// All of them, by name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Cause)> {
        self.all.keys().map(|(what, cause)| (what.as_str(), cause))
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Adds all of another list.
    pub fn extend(&mut self, other: Self) {
        other.all.into_keys().for_each(|(what, cause)| self.add(what, cause));
    }
}

/// One line for each.
impl fmt::Display for Omissions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (what, cause) in self.iter() {
            // A name in a file may hold anything, but a line here is one line.
            let what: String = what.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
            let reason: String =
                cause.reason().chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
            writeln!(f, "`{what}`: {reason}; effect: {}", cause.effect())?;
        }
        Ok(())
    }
}
