//! The workloads on which the peers were measured. Y is up; metres, kilograms, seconds.

use std::fmt;

use nalgebra::Vector3;
use nucleus_core::{
    BuildError, Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, Elements, FrameInput,
    GroundPlane, Mass, ModelBuilder, Pin, PointId, Stiffness, Surface,
};

use nucleus_measure::fixture;

use super::mesh::{self, Cells};

/// The ball that W2 falls on.
pub const BALL: Ball = Ball { radius: 0.35, start: [0.0, 0.5, 0.0], flight: [0.0; 3] };

pub use nucleus_measure::fixture::{DENSITY, GRAVITY};

/// Distance of contact between cloth and collider, in metres.
const THICKNESS: f64 = 0.005;

/// Friction coefficient of the pair.
const FRICTION: f64 = 0.5;

/// A workload.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Workload {
    /// W1: a horizontal sheet of 1 m, pinned at two corners, swings down.
    Swing,
    /// W2: a sheet of 1.5 m falls on a ball above the ground.
    Drape,
    /// A sheet of 1 m of quads hangs from its upper edge.
    Hang,
}

impl fmt::Display for Workload {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Swing => "W1",
            Self::Drape => "W2",
            Self::Hang => "hang",
        })
    }
}

/// Settings of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Stretch and compression resistance; 20 is 10 kN/m.
    pub resistance: f64,
    /// Bend resistance.
    pub bend: f64,
    /// Evaluations per 1/24 s, over 3 substeps.
    pub evaluations: u32,
    /// Its variant.
    pub variant: Variant,
}

/// Variants of a workload.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variant {
    /// Edges and faces of the cloth collide.
    Plain,
    /// Tethers to the pins.
    Tethers,
    /// Points of the cloth collide alone (`collisionFlag` vertex).
    Points,
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} evaluations, stretch {}", self.evaluations, self.resistance)?;
        if self.bend > 0.0 {
            write!(f, ", bend {}", self.bend)?;
        }
        if self.variant == Variant::Plain { Ok(()) } else { write!(f, ", {}", self.variant) }
    }
}

impl fmt::Display for Variant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Plain => "plain",
            Self::Tethers => "tethers",
            Self::Points => "points alone",
        })
    }
}

/// A workload as input of the solver.
pub struct Scene {
    /// The initial mesh of the cloth, which is its rest shape.
    pub sheet: Surface,
    /// The objects.
    pub builder: ModelBuilder,
    /// The input of every frame; there is no animation.
    pub frame: FrameInput,
}

impl Workload {
    /// Frames of a full run, to the end of the motion.
    pub fn frames(self) -> u32 {
        match self {
            Self::Swing => 120,
            Self::Drape => 96,
            Self::Hang => 60,
        }
    }

    /// The ball, if there is one.
    pub fn ball(self) -> Option<Ball> {
        (self == Self::Drape).then_some(BALL)
    }

    /// The scene with `n` by `n` points of cloth.
    ///
    /// # Errors
    /// When the solver rejects a mesh.
    pub fn scene(self, n: u32, setting: &Setting) -> Result<Scene, BuildError> {
        let sheet = self.sheet(n);
        let mut builder = ModelBuilder::new();
        let lists = ClothLists {
            stretch: true,
            bend: setting.bend > 0.0,
            damp: self == Self::Drape,
            tethers: setting.variant == Variant::Tethers,
            ..ClothLists::NONE
        };
        builder.cloth(Cloth::new(sheet.clone(), Mass::PerArea(DENSITY), lists))?;
        let mut frame = frame(setting);
        let held: Vec<u32> = match self {
            Self::Swing => vec![0, n - 1],
            Self::Drape => Vec::new(),
            Self::Hang => (0..n).collect(),
        };
        frame.pins = held.into_iter().map(|point| pin(&sheet, point)).collect();
        if self == Self::Drape {
            builder.collider(Collider { surface: mesh::sphere(BALL.radius, BALL.start.into()) })?;
            set_ball_and_ground(&mut frame);
        }
        Ok(Scene { sheet, builder, frame })
    }

    fn sheet(self, n: u32) -> Surface {
        let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
        match self {
            Self::Swing => mesh::sheet(n, Cells::Triangles, Vector3::zeros(), x, z),
            Self::Drape => {
                mesh::sheet(n, Cells::Triangles, Vector3::new(-0.75, 0.9, -0.75), x * 1.5, z * 1.5)
            }
            Self::Hang => mesh::sheet(n, Cells::Quads, Vector3::zeros(), x, -y),
        }
    }
}

/// Cloth under gravity alone, with the resistances of a setting, over 3 substeps.
pub fn frame(setting: &Setting) -> FrameInput {
    let mut frame = fixture::gravity_only(f64::from(setting.evaluations));
    frame.substeps = 3;
    let cloth = &mut frame.cloths[0];
    cloth.stiffness = Stiffness::default();
    (cloth.stretch_resistance, cloth.compression_resistance) = (setting.resistance, setting.resistance);
    cloth.bend_resistance = setting.bend;
    cloth.tethers = (setting.variant == Variant::Tethers).then_some(1.0);
    if setting.variant == Variant::Points {
        cloth.elements = Elements::Points;
    }
    frame
}

/// Friction and thickness are summed over both sides; the plane has no thickness. Falling cloth has Maya's default
/// stretch damping.
fn set_ball_and_ground(frame: &mut FrameInput) {
    let (thickness, friction) = (THICKNESS / 2.0, FRICTION / 2.0);
    for cloth in &mut frame.cloths {
        (cloth.thickness, cloth.friction) = (thickness, friction);
        cloth.stretch_damp = ClothFrame::default().stretch_damp;
    }
    frame.colliders = vec![ColliderFrame { collide: true, thickness, friction, ..ColliderFrame::default() }];
    frame.plane = Some(GroundPlane { friction, ..GroundPlane::new(Vector3::zeros(), Vector3::y()) });
}

fn pin(sheet: &Surface, point: u32) -> Pin {
    let place = sheet.positions[point as usize];
    Pin { cloth: ClothId(0), point: PointId(point), start: place, end: place }
}

/// A ball at rest or in uniform motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its radius in metres.
    pub radius: f64,
    /// Initial centre in metres.
    pub start: [f64; 3],
    /// Displacement per frame in metres.
    pub flight: [f64; 3],
}

impl Ball {
    /// Centre after a number of frames, in metres.
    pub fn centre(&self, frames: f64) -> Vector3<f64> {
        Vector3::from(self.start) + Vector3::from(self.flight) * frames
    }

    /// Depth of a point inside the ball after a number of frames, in metres; negative outside.
    pub fn depth(&self, frames: f64, point: &Vector3<f64>) -> f64 {
        self.radius - (point - self.centre(frames)).norm()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_follows_the_motion_of_the_ball() {
        let ball = Ball { radius: 0.5, start: [1.0, 0.0, -2.0], flight: [0.0, 0.0, 0.25] };
        let place = Vector3::new(1.0, 0.0, 0.0);
        assert_eq!([0.0, 7.0, 8.0].map(|frames| ball.depth(frames, &place)), [-1.5, 0.25, 0.5]);
    }
}
