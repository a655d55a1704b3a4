//! The attributes of one cloth in one frame.

use nalgebra::Vector3;

use crate::input::frame::contact::{Elements, ForceField, PushOut, SelfCollision};
use crate::input::frame::material::{Bending, InputAttract, Liquid, Pressure, Stiffness};
use crate::input::object_fields::{PointField, WindField};

/// The attributes of one cloth in one frame. A resistance counts evaluations in 1/24 s (Classic) or
/// stands for a stiffness (Physical); see [`ResistanceModel`](crate::input::frame::ResistanceModel).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClothFrame {
    /// Resistance of links longer than at rest.
    pub stretch_resistance: f64,
    /// Resistance of links shorter than at rest.
    pub compression_resistance: f64,
    /// Resistance of the cross links of quads.
    pub shear_resistance: f64,
    /// Resistance of the angle between faces.
    pub bend_resistance: f64,
    /// Measured stiffnesses that replace resistances.
    pub stiffness: Stiffness,
    /// Whether links shorter than at rest resist no more than their buckling load (Physical). It needs
    /// [`ClothLists::buckling`](crate::ClothLists::buckling).
    pub buckles: bool,
    /// Factor on all rest lengths.
    pub rest_length_scale: f64,
    /// Factor on the lengths of tethers (`tetherScale`); `None` without tethers. They need
    /// [`ClothLists::tethers`](crate::ClothLists::tethers).
    pub tethers: Option<f64>,
    /// Damping of the relative velocity along links.
    pub stretch_damp: f64,
    /// Averaging of velocities between linked points.
    pub damp: f64,
    /// Air drag along the normal, per 1/24 s.
    pub drag: f64,
    /// Share of `drag` that also acts along the surface, 0 to 1.
    pub tangential_drag: f64,
    /// Air force at right angles to the motion: acceleration over v² sin α cos α in 1/m, times the mass.
    pub lift: f64,
    /// Whether the solver's gravity acts on this cloth.
    pub feels_gravity: bool,
    /// Whether the solver's wind acts on this cloth.
    pub feels_wind: bool,
    /// Force on every point in newtons (`localForce`).
    pub local_force: Vector3<f64>,
    /// Wind for this cloth alone, in m/s (`localWind`).
    pub local_wind: Vector3<f64>,
    /// Whether it collides with colliders and the ground plane.
    pub collide: bool,
    /// Whether pins move all of its points, and points without a pin stay where they are: other cloth collides with it, and
    /// it has no contacts with colliders, with the ground plane, with itself, or with another such cloth.
    pub is_driven: bool,
    /// Thickness in metres; two objects touch at the sum of theirs.
    pub thickness: f64,
    /// Friction; the two sides' values are added.
    pub friction: f64,
    /// Stickiness, 0 to 2; the two sides' values are added, and at 1 they never separate.
    pub stickiness: f64,
    /// Bounce, 0 to 1; the larger of the two sides' values counts.
    pub bounce: f64,
    /// Strength of contacts; the two sides' values are multiplied. From 1 on nothing passes through, below 1 objects
    /// may, at 0 there is no contact.
    pub collide_strength: f64,
    /// Moves points of other objects to a side of its surface.
    pub push_out: PushOut,
    /// Additional speed of untangling where it intersects other cloth; the two sides' values are added.
    pub crossover_push: f64,
    /// The same where it intersects itself.
    pub self_crossover_push: f64,
    /// Its elements of contact with other cloth (`collisionFlag`).
    pub elements: Elements,
    /// `collisionLayer`: in contacts the cloth in the lower layer is heavier, and from a difference of one on the other
    /// does not move it.
    pub layer: f64,
    /// Self-collision.
    pub self_collision: SelfCollision,
    /// Rest angles, their scale, and permanent bends.
    pub bending: Bending,
    /// Strain above which links lengthen permanently (`restitutionTension` over the stretch resistance);
    /// infinite for none.
    pub yield_strain: f64,
    /// Gas inside the mesh, or pressure set by hand.
    pub pressure: Pressure,
    /// `rigidity`: the mesh moves as one rigid body.
    pub rigidity: f64,
    /// `deformResistance`: the mesh keeps its shape.
    pub deform_resistance: f64,
    /// Attraction to the input mesh.
    pub input_attract: InputAttract,
    /// Its force field on other objects.
    pub field: Option<ForceField>,
    /// The force fields of its points.
    pub point_field: Option<PointField>,
    /// Its wind shadow, and the air that it pushes.
    pub wind_field: WindField,
    /// Attributes of a liquid; `None` if its points are balls.
    pub liquid: Option<Liquid>,
    /// Share of the velocity that particles keep from the start of a frame to its end.
    pub conserve: f64,
    /// Share of its slip that a contact takes from the spin of a particle in Maya's default substep (`rotationFriction`).
    pub rotation_friction: f64,
    /// Rate at which particles lose their spin, in Maya's unit of damping (`rotationDamp`).
    pub rotation_damp: f64,
    /// New particles nearer to others of the object than this share of their contact distance are left out; 0 keeps all
    /// (`emissionOverlapPruning`).
    pub overlap_pruning: f64,
}

impl ClothFrame {
    /// Maya's defaults of an nCloth, except `thickness`, which Maya computes from the mesh.
    pub const DEFAULT: Self = Self {
        stretch_resistance: 20.0,
        compression_resistance: 10.0,
        shear_resistance: 0.0,
        bend_resistance: 0.1,
        stiffness: Stiffness::NONE,
        buckles: false,
        rest_length_scale: 1.0,
        tethers: None,
        stretch_damp: 0.1,
        damp: 0.0,
        drag: 0.05,
        tangential_drag: 0.0,
        lift: 0.05,
        feels_gravity: true,
        feels_wind: true,
        local_force: Vector3::new(0.0, 0.0, 0.0),
        local_wind: Vector3::new(0.0, 0.0, 0.0),
        collide: true,
        is_driven: false,
        thickness: 0.0,
        friction: 0.1,
        stickiness: 0.0,
        bounce: 0.0,
        collide_strength: 1.0,
        push_out: PushOut::OFF,
        crossover_push: 0.0,
        self_crossover_push: 0.0,
        elements: Elements::Faces,
        layer: 0.0,
        self_collision: SelfCollision::OFF,
        bending: Bending::DEFAULT,
        yield_strain: f64::INFINITY,
        pressure: Pressure::Off,
        rigidity: 0.0,
        deform_resistance: 0.0,
        input_attract: InputAttract::OFF,
        field: None,
        point_field: None,
        wind_field: WindField::OFF,
        liquid: None,
        conserve: 1.0,
        rotation_friction: 0.9,
        rotation_damp: 0.001,
        overlap_pruning: 0.0,
    };
}

impl Default for ClothFrame {
    fn default() -> Self {
        Self::DEFAULT
    }
}
