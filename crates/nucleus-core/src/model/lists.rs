//! The lists of rows that a cloth is built with, and the attributes that need them.

use crate::input::frame::{BendSolver, ClothFrame, Pressure};

/// The lists that a cloth can ever need. A list that is off is never built and never swept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ClothLists {
    /// Links along edges: stretch or compression resistance is ever non-zero.
    pub stretch: bool,
    /// Cross links of quads among them, so that stretch resistance also resists shear (`addCrossLinks`).
    pub cross_links: bool,
    /// A second list of the cross links of quads: shear resistance is ever non-zero.
    pub shear: bool,
    /// Hinges between faces: bend resistance is ever non-zero.
    pub bend: bool,
    /// Drag, lift or wind is ever non-zero.
    pub air: bool,
    /// Damping of relative velocities is ever non-zero.
    pub damp: bool,
    /// Self-collision is ever on.
    pub self_collision: bool,
    /// Hinges that are bent at rest have signed angles (`bendSolver` above Simple).
    pub signed_bend: bool,
    /// All hinges have signed angles: for an angle scale, a dropoff, flip tracking or permanent bends.
    pub bend_angles: bool,
    /// Pressure is ever non-zero.
    pub pressure: bool,
    /// Rigidity or deform resistance is ever non-zero.
    pub shape: bool,
    /// Unconnected parts of the mesh keep their shapes each on its own (`usePolygonShells`).
    pub shells: bool,
    /// Links or bends can stay as they are deformed.
    pub plastic: bool,
    /// Points are tethered to pins at some time.
    pub tethers: bool,
    /// Tethered cloth has long links between its points too.
    pub long_links: bool,
    /// Links buckle at some time.
    pub buckling: bool,
}

impl ClothLists {
    /// What cloth with default attributes needs.
    pub const DEFAULT: Self = Self {
        stretch: true,
        cross_links: true,
        shear: true,
        bend: true,
        air: true,
        damp: true,
        self_collision: true,
        ..Self::NONE
    };

    /// Everything off: free points.
    pub const NONE: Self = Self {
        stretch: false,
        cross_links: false,
        shear: false,
        bend: false,
        air: false,
        damp: false,
        self_collision: false,
        signed_bend: false,
        bend_angles: false,
        pressure: false,
        shape: false,
        shells: false,
        plastic: false,
        tethers: false,
        long_links: false,
        buckling: false,
    };

    /// The first attribute of a cloth that has no effect because its list is off, and the name of the list. An attribute at
    /// its default is none: a frame starts with those.
    pub fn missing_for(&self, cloth: &ClothFrame) -> Option<[&'static str; 2]> {
        const DEFAULT: ClothFrame = ClothFrame::DEFAULT;
        let ClothFrame { stiffness, bending, .. } = cloth;
        let is_set = |value: f64, default: f64| value > 0.0 && value != default;
        let is_given = |stiffness: Option<f64>| stiffness.is_some_and(|stiffness| stiffness > 0.0);
        let bends = bending.yield_sine.is_finite() || bending.yield_half_angle.is_finite();
        let angles = bends || bending.angle_scale != 1.0 || bending.angle_dropoff > 0.0;
        let has_angles = self.bend_angles || self.signed_bend && !angles;
        #[rustfmt::skip]
        let needs = [
            (self.stretch, "stretch", "stretch_resistance", is_set(cloth.stretch_resistance, DEFAULT.stretch_resistance)),
            (self.stretch, "stretch", "compression_resistance", is_set(cloth.compression_resistance, DEFAULT.compression_resistance)),
            (self.stretch, "stretch", "stiffness.stretch", is_given(stiffness.stretch)),
            (self.stretch, "stretch", "stiffness.compression", is_given(stiffness.compression)),
            (self.shear, "shear", "shear_resistance", cloth.shear_resistance > 0.0),
            (self.shear, "shear", "stiffness.shear", is_given(stiffness.shear)),
            (self.bend, "bend", "bend_resistance", is_set(cloth.bend_resistance, DEFAULT.bend_resistance)),
            (self.bend, "bend", "stiffness.bend", is_given(stiffness.bend)),
            (has_angles, "bend_angles", "bending", angles || bending.solver == BendSolver::FlipTracking),
            (has_angles, "signed_bend", "bending.solver", bending.solver == BendSolver::Signed),
            (self.air, "air", "drag", is_set(cloth.drag, DEFAULT.drag)),
            (self.air, "air", "lift", is_set(cloth.lift, DEFAULT.lift)),
            (self.damp, "damp", "stretch_damp", is_set(cloth.stretch_damp, DEFAULT.stretch_damp)),
            (self.damp, "damp", "damp", cloth.damp > 0.0),
            (self.self_collision, "self_collision", "self_collision", cloth.self_collision.on),
            (self.pressure, "pressure", "pressure", cloth.pressure != Pressure::Off),
            (self.shape, "shape", "rigidity", cloth.rigidity > 0.0),
            (self.shape, "shape", "deform_resistance", cloth.deform_resistance > 0.0),
            (self.plastic, "plastic", "yield_strain", cloth.yield_strain.is_finite()),
            (self.tethers, "tethers", "tethers", cloth.tethers.is_some()),
            (self.buckling, "buckling", "buckles", cloth.buckles),
        ];
        let missing = needs.into_iter().find(|(has_list, _, _, acts)| *acts && !has_list);
        missing.map(|(_, list, attribute, _)| [attribute, list])
    }
}

impl Default for ClothLists {
    fn default() -> Self {
        Self::DEFAULT
    }
}
