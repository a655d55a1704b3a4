//! The contents of a picture: objects, the bounding boxes around them, and the style in which they are drawn.

use nucleus_core::{Faces, ParticleLook};

/// A 3-vector: a point or direction in scene units, or a linear colour.
pub(super) type Vec3 = nalgebra::Vector3<f32>;

/// An object to draw, at one point in time.
#[derive(Debug, Clone, Copy)]
pub struct Object<'a> {
    /// Its name in the scene. Colours depend on the order of the objects, not on their names.
    pub name: &'a str,
    /// Its kind, which decides its colours and the shading of its edges.
    pub kind: Kind,
    /// Its faces; none for particles.
    pub faces: &'a Faces,
    /// Its points, in scene units.
    pub positions: &'a [[f32; 3]],
    /// Its points at rest, as many as `positions`; required for strain.
    pub rest: Option<&'a [[f32; 3]]>,
    /// Radius of its particles, in scene units; without it they are drawn just large enough to see.
    pub radius: Option<f32>,
    /// The looks of its particles, as many as `positions`; without them all look the same.
    pub looks: Option<&'a [ParticleLook]>,
}

/// Kinds of objects, which are drawn differently.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A cloth: smooth shading, a saturated colour.
    Cloth,
    /// A collider: grey, with hard edges.
    Collider,
    /// Particles: spheres.
    Particles,
}

/// The style of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples along each side of a pixel, 1 to 8: supersampling.
    pub samples: u32,
    /// The background, behind the objects and the floor.
    pub background: Background,
    /// Whether the picture keeps its linear colours, which an EXR file holds.
    pub keeps_linear: bool,
    /// Linear colours of objects by their names, instead of those by their order.
    pub tints: Vec<(String, [f32; 3])>,
    /// Names of objects that are not drawn. They cast no shadow, and an automatic camera does not frame them; the others keep
    /// their colours.
    pub hidden: Vec<String>,
    /// The quantity that the colour of a cloth shows.
    pub colouring: Colouring,
    /// Whether the edges of the faces are drawn.
    pub wireframe: bool,
    /// Whether the pictures of a cache show the surface of particles as a mesh, instead of the particles.
    pub surfaces: bool,
    /// Where the floor is.
    pub ground: Ground,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            size: [960, 540],
            samples: 3,
            background: Background::Studio,
            keeps_linear: false,
            tints: Vec::new(),
            hidden: Vec::new(),
            colouring: Colouring::Objects,
            wireframe: false,
            surfaces: false,
            ground: Ground::Below,
        }
    }
}

impl Style {
    /// Whether an object of this name is drawn.
    pub fn shows(&self, name: &str) -> bool {
        self.hidden.iter().all(|hidden| hidden != name)
    }
}

/// The background, behind the objects and the floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Background {
    /// A grey that darkens downwards.
    Studio,
    /// One linear colour.
    Colour([f32; 3]),
    /// Nothing: the picture has opacities, and no floor.
    Transparent,
}

/// The floor of a picture, a plane. It casts no shadow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ground {
    /// No floor.
    None,
    /// Below all objects.
    Below,
    /// Level, at this height, in scene units.
    At(f32),
    /// Through a point, in scene units; objects are on the side of the normal.
    Plane {
        /// The point.
        origin: [f32; 3],
        /// The normal, of any length.
        normal: [f32; 3],
    },
}

/// The quantity that the colour of a cloth shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Colouring {
    /// A colour per object.
    Objects,
    /// The strain of its edges: blue where they are shorter than at rest, red where they are longer.
    /// A point shows the strain of largest magnitude among its edges.
    Strain {
        /// The strain of full saturation: 0.05 is 5 %.
        full_scale: f32,
    },
}

/// An axis-aligned bounding box, in scene units. The default is empty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates.
    pub low: [f32; 3],
    /// Largest coordinates.
    pub high: [f32; 3],
}

/// Number of particles from which on a camera leaves some out.
const FEW: usize = 20;

impl Default for Bounds {
    fn default() -> Self {
        Self { low: [f32::INFINITY; 3], high: [f32::NEG_INFINITY; 3] }
    }
}

impl Bounds {
    /// The box around the simulated objects, cloths and most particles; around all objects if none is simulated.
    pub fn of_interest(objects: &[Object]) -> Self {
        let mut simulated = Self::default();
        let mut all = Self::default();
        for object in objects {
            all.include(object.positions);
            match object.kind {
                Kind::Cloth => simulated.include(object.positions),
                Kind::Particles => simulated.merge(&Self::of_most(object.positions)),
                Kind::Collider => {}
            }
        }
        if simulated.is_empty() { all } else { simulated }
    }

    /// The box that an automatic camera frames: the simulated objects, and the colliders near them.
    ///
    /// A collider counts if it comes within half the extent of the simulated objects beside them. A collider of more than
    /// three times their extent, such as a landscape, does not count.
    pub fn to_frame(objects: &[Object]) -> Self {
        let simulated = Self::of_interest(objects);
        let (extent, near) = (simulated.extent(), simulated.grown(0.5 * simulated.extent()));
        let mut framed = simulated;
        for object in objects.iter().filter(|object| object.kind == Kind::Collider) {
            let mut collider = Self::default();
            collider.include(object.positions);
            if collider.extent() <= 3.0 * extent && !collider.intersection(&near).is_empty() {
                framed.merge(&collider);
            }
        }
        framed
    }

    /// The box that has 95 % of the points below and above each of its sides: a few stray drops must not make everything
    /// else small. Of fewer than [`FEW`] points it has all.
    fn of_most(positions: &[[f32; 3]]) -> Self {
        let mut all = Self::default();
        all.include(positions);
        let beyond = positions.len() / 20;
        if positions.len() < FEW || all.is_empty() {
            return all;
        }
        for axis in 0..3 {
            let drawable = positions.iter().filter(|point| is_drawable(point));
            let mut along: Vec<f32> = drawable.map(|point| point[axis]).collect();
            let last = along.len() - 1;
            let low = beyond.min(last);
            all.low[axis] = *along.select_nth_unstable_by(low, f32::total_cmp).1;
            all.high[axis] = *along.select_nth_unstable_by(last.saturating_sub(beyond), f32::total_cmp).1;
        }
        all
    }

    /// Extends the box to points. Points that cannot be drawn are ignored.
    pub fn include(&mut self, positions: &[[f32; 3]]) {
        for point in positions.iter().filter(|point| is_drawable(point)) {
            for axis in 0..3 {
                self.low[axis] = self.low[axis].min(point[axis]);
                self.high[axis] = self.high[axis].max(point[axis]);
            }
        }
    }

    /// Extends the box to an object; particles are balls.
    pub(super) fn include_object(&mut self, object: &Object) {
        let mut own = Self::default();
        own.include(object.positions);
        let radius = object.radius.filter(|_| object.kind == Kind::Particles).unwrap_or(0.0);
        self.merge(&own.grown(radius));
    }

    /// Extends the box to another box.
    pub fn merge(&mut self, other: &Self) {
        if !other.is_empty() {
            self.include(&[other.low, other.high]);
        }
    }

    /// Whether it holds no point.
    pub fn is_empty(&self) -> bool {
        (0..3).any(|axis| self.low[axis] > self.high[axis])
    }

    /// The height of a floor below all objects: below those that a camera frames, but not far below the simulated ones, since
    /// another collider may be a landscape.
    pub(super) fn floor_below(&self, framed: &Self, simulated: &Self) -> f32 {
        if self.is_empty() || framed.is_empty() || simulated.is_empty() {
            return 0.0;
        }
        self.low[1].max(simulated.low[1] - 1.5 * simulated.extent()).min(framed.low[1])
    }

    /// The longest side; 0 if empty.
    pub fn extent(&self) -> f32 {
        (0..3).map(|axis| self.high[axis] - self.low[axis]).fold(0.0, f32::max)
    }

    fn grown(&self, by: f32) -> Self {
        Self { low: self.low.map(|x| x - by), high: self.high.map(|x| x + by) }
    }

    fn intersection(&self, other: &Self) -> Self {
        Self {
            low: [0, 1, 2].map(|axis| self.low[axis].max(other.low[axis])),
            high: [0, 1, 2].map(|axis| self.high[axis].min(other.high[axis])),
        }
    }

    pub(super) fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|corner| {
            Vec3::from_fn(|axis, _| if corner >> axis & 1 == 0 { self.low[axis] } else { self.high[axis] })
        })
    }

    pub(super) fn centre(&self) -> Vec3 {
        (Vec3::from(self.low) + Vec3::from(self.high)) * 0.5
    }
}

/// Whether a point can be drawn: its coordinates are finite, and so small that their squares are.
pub(super) fn is_drawable(point: &[f32; 3]) -> bool {
    const MAX_COORDINATE: f32 = 1e9;
    point.iter().all(|x| x.abs() <= MAX_COORDINATE) // false for NaN
}

/// The unit vector of this direction; +Y for a zero vector.
pub(super) fn unit(vector: &Vec3) -> Vec3 {
    let length = vector.norm();
    if length > 0.0 && length.is_finite() { vector / length } else { Vec3::y() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The corners of a cube.
    fn cube(centre: [f32; 3], half: f32) -> Vec<[f32; 3]> {
        let corner =
            |k: usize| [0, 1, 2].map(|axis| centre[axis] + if k >> axis & 1 == 1 { half } else { -half });
        (0..8).map(corner).collect()
    }

    fn object<'a>(kind: Kind, faces: &'a Faces, positions: &'a [[f32; 3]]) -> Object<'a> {
        Object { name: "", kind, faces, positions, rest: None, radius: None, looks: None }
    }

    #[test]
    fn a_camera_frames_the_cloth_and_the_colliders_near_it() {
        let (faces, cloth) = (Faces::default(), cube([0.0; 3], 1.0));
        let colliders =
            [cube([1.5, 0.0, 0.0], 0.4), cube([0.0, -30.0, 0.0], 30.0), cube([9.0, 0.0, 0.0], 1.0)];
        let framed = |colliders: &[Vec<[f32; 3]>]| {
            let mut objects = vec![object(Kind::Cloth, &faces, &cloth)];
            objects.extend(colliders.iter().map(|points| object(Kind::Collider, &faces, points)));
            Bounds::to_frame(&objects)
        };
        let alone = Bounds { low: [-1.0; 3], high: [1.0; 3] };
        assert_eq!(framed(&[]), alone);
        assert_eq!(framed(&colliders[..1]), Bounds { high: [1.9, 1.0, 1.0], ..alone }, "beside the cloth");
        assert_eq!(framed(&colliders[1..2]), alone, "a landscape");
        assert_eq!(framed(&colliders[2..]), alone, "far away");
        let table = [cube([0.0, -1.5, 0.0], 2.5)];
        assert_eq!(
            framed(&table),
            Bounds { low: [-2.5, -4.0, -2.5], high: [2.5, 1.0, 2.5] },
            "a whole table"
        );
    }

    #[test]
    fn a_few_stray_particles_are_not_framed() {
        let faces = Faces::default();
        let mut drops: Vec<[f32; 3]> = (0..100).map(|k| [k as f32 / 99.0, 0.5, -0.5]).collect();
        let framed = |drops: &[[f32; 3]]| Bounds::to_frame(&[object(Kind::Particles, &faces, drops)]);
        let before = framed(&drops);
        assert!(before.low[0] > 0.0 && before.high[0] < 1.0 && before.extent() > 0.85, "{before:?}");
        drops[..3].copy_from_slice(&[[900.0, 0.0, 0.0], [0.0, -700.0, 0.0], [f32::NAN; 3]]);
        let after = framed(&drops);
        assert!(after.low.iter().chain(&after.high).all(|x| x.abs() <= 1.0), "{after:?}");
        assert_eq!(framed(&drops[..10]).high[0], 900.0, "of few, all are framed");
    }

    #[test]
    fn the_floor_is_below_the_colliders_that_are_framed() {
        let faces = Faces::default();
        let floor = |cloth: &[[f32; 3]], collider: &[[f32; 3]]| {
            let objects = [object(Kind::Cloth, &faces, cloth), object(Kind::Collider, &faces, collider)];
            let mut all = Bounds::default();
            objects.iter().for_each(|object| all.include(object.positions));
            all.floor_below(&Bounds::to_frame(&objects), &Bounds::of_interest(&objects))
        };
        let scarf = cube([0.0, 176.0, 0.0], 30.0);
        let column: Vec<[f32; 3]> = vec![[-15.0, 0.0, -15.0], [15.0, 170.0, 15.0]];
        assert_eq!(floor(&scarf, &column), 0.0);
        let valley = cube([0.0, -900.0, 0.0], 500.0);
        assert_eq!(floor(&scarf, &valley), 146.0 - 90.0, "a landscape");
    }
}
