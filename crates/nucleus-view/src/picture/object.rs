//! What is drawn, and how.

use nucleus_core::Faces;

/// One thing to draw, at one moment.
#[derive(Debug, Clone, Copy)]
pub struct Object<'a> {
    /// Name, as in the scene. Colours follow the order of objects, not their names.
    pub name: &'a str,
    /// What it is: this decides its colour and the way its edges are shaded.
    pub kind: Kind,
    /// Its faces; none for particles.
    pub faces: &'a Faces,
    /// Its points, in scene units.
    pub positions: &'a [[f32; 3]],
    /// Its points at rest, as many as `positions`; without them it has no strain to show.
    pub rest: Option<&'a [[f32; 3]]>,
    /// Radius of its particles, in scene units; without it they are as small as can be seen.
    pub radius: Option<f32>,
}

/// The kinds of object that are drawn differently.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A cloth: smooth everywhere, in a colour of its own.
    Cloth,
    /// A collider: grey, with its sharp edges kept sharp.
    Collider,
    /// Particles: balls.
    Particles,
}

/// How a picture looks.
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples along each side of a pixel, 1 to 4.
    pub samples: u32,
    /// What the colour of a cloth tells.
    pub colouring: Colouring,
    /// Whether the edges of faces are drawn over them.
    pub wireframe: bool,
    /// Where the floor is.
    pub ground: Ground,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            size: [960, 540],
            samples: 2,
            colouring: Colouring::Objects,
            wireframe: false,
            ground: Ground::Below,
        }
    }
}

/// Where the floor of a picture is. It is seen only from above or below, and casts no shadow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ground {
    /// There is none.
    None,
    /// Under everything that is drawn.
    Below,
    /// At this height, in scene units.
    At(f32),
}

/// What the colour of a cloth tells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Colouring {
    /// Which object it is.
    Objects,
    /// How far its edges are from their rest length: blue is shorter, red is longer.
    /// A point shows the largest strain of the edges that meet in it.
    Strain {
        /// The strain that has the full colour: 0.05 is 5 %.
        full_scale: f32,
    },
}
