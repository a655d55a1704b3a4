//! Material attributes of a cloth: stiffness, bending, pressure, attraction to its input mesh, and liquids.

/// Measured stiffnesses of a cloth. One that is given replaces the resistance of the same effect; zero switches the
/// effect off. Only the Physical reading uses them: in the Classic reading stiffness follows from mesh and substeps.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stiffness {
    /// Of links longer than at rest, in N/m: Young's modulus times the thickness of the cloth.
    pub stretch: Option<f64>,
    /// Of links shorter than at rest, in N/m.
    pub compression: Option<f64>,
    /// Against shear, in N/m, in addition to that of stretch through cross links.
    pub shear: Option<f64>,
    /// Against bending, in N·m: moment per width, over curvature.
    pub bend: Option<f64>,
    /// Of links along the warp of woven cloth that are longer than at rest, in N/m, in place of `stretch`.
    pub warp: Option<f64>,
    /// The same along the weft.
    pub weft: Option<f64>,
}

impl Stiffness {
    /// None given: resistances count.
    pub const NONE: Self =
        Self { stretch: None, compression: None, shear: None, bend: None, warp: None, weft: None };
}

/// How a hinge measures its angle (`bendSolver`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BendSolver {
    /// The size of the angle alone: a crease has no side.
    Simple,
    /// The angle with its sign, up to 180° either way.
    Signed,
    /// The same; a hinge that is folded past 180° is unfolded in the direction it came from.
    FlipTracking,
}

/// Attributes of bending other than its resistance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bending {
    /// Factor on rest angles (`bendAngleScale`): 0 is flat, 1 as modelled.
    pub angle_scale: f64,
    /// Share of the resistance that grows with the angle (`bendAngleDropoff`), 0 to 1.
    pub angle_dropoff: f64,
    /// How angles are measured.
    pub solver: BendSolver,
    /// Sine of half the angle beyond which bends become permanent (`restitutionAngle`); infinite for none.
    pub yield_sine: f64,
    /// Half that angle in radians, for a vertex map to scale; infinite for none.
    pub yield_half_angle: f64,
}

impl Bending {
    /// Maya's defaults, but for the sign of angles, which costs a little and matters only to cloth that is bent at rest.
    pub const DEFAULT: Self = Self {
        angle_scale: 1.0,
        angle_dropoff: 0.0,
        solver: BendSolver::Simple,
        yield_sine: f64::INFINITY,
        yield_half_angle: f64::INFINITY,
    };
}

/// Pressure inside a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pressure {
    /// None.
    Off,
    /// A gauge pressure set by hand.
    Manual {
        /// In pascals, along the faces' normals.
        pascals: f64,
        /// Damping of the volume's rate of change, in Pa·s.
        damping: f64,
    },
    /// An ideal gas: gauge pressure `bulk` (n V_0 / V - 1) with n times the air that fills the volume at the start.
    Gas {
        /// n at the start, less one (`startPressure`).
        start: f64,
        /// Bulk modulus in pascals (`incompressibility`).
        bulk: f64,
        /// Start volumes of air pumped in per second (`pumpRate`).
        pump: f64,
        /// Share of the air that stays inside, 0 to 1 (`airTightness`).
        tightness: f64,
        /// Damping of the volume's rate of change, in Pa·s.
        damping: f64,
        /// Whether openings are closed (`sealHoles`); else air streams through them.
        sealed: bool,
    },
}

/// Attraction of a cloth to its live input mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InputAttract {
    /// `inputMeshAttract`: 0 none, 1 firm.
    pub strength: f64,
    /// `inputAttractDamp`: 0 springs, 1 does not overshoot a mesh at rest.
    pub damp: f64,
    /// `inputMotionDrag`: how fast velocities take up those of the input mesh.
    pub motion_drag: f64,
}

impl InputAttract {
    /// None.
    pub const OFF: Self = Self { strength: 0.0, damp: 0.0, motion_drag: 0.0 };

    /// Whether there is any.
    pub fn is_on(&self) -> bool {
        self.strength > 0.0 || self.motion_drag > 0.0
    }
}

/// A liquid of particles (Maya's Liquid Simulation).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Liquid {
    /// Distance of particles at rest in metres: each stands for a cube of this edge.
    pub spacing: f64,
    /// `incompressibility`: from 1 on the liquid keeps its volume, below it is soft, at 0 nothing resists.
    pub incompressibility: f64,
    /// Kinematic viscosity in m²/s.
    pub viscosity: f64,
    /// Surface tension over density in m³/s².
    pub surface_tension: f64,
}
