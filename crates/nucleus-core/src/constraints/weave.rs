//! Woven cloth: links as stiff as the cloth is along them, and compression that gives way where an element would buckle.
//!
//! A link at an angle φ to the warp has the modulus of an orthotropic sheet in uniaxial tension (Jones, *Mechanics of
//! Composite Materials*, 2nd ed., eq. 2.97, without the term of Poisson's ratio):
//!
//! ```text
//! 1/K(φ) = cos⁴φ / K_warp + sin⁴φ / K_weft + cos²φ sin²φ / K_shear
//! ```
//!
//! It is linear in the compliances, so a row needs one number, cos²φ. Shorter than at rest, warp and weft both have the
//! compression stiffness.
//!
//! **Buckling.** The shortest fold that a mesh can show is a zigzag of two edges, whose hinges resist it. An edge of length l
//! that is compressed between two points stays straight and pushes back with its whole stiffness, where cloth would fold: a
//! column whose ends turn with the mesh, clamped, carries N = 4π² B / l² per width (Euler), and N (1 + ε/2) when it is
//! shortened by the strain ε beyond (elastica, first order). With `buckling` a link shorter than at rest resists with the
//! smaller of the two. It then stands for the folds that the mesh cannot show; those that it can show buckle first.

use crate::constraints::projection::{LinkLaw, LinkProjection};
use crate::constraints::strength_map::{Sides, StrengthMap};
use crate::constraints::stretch::LinkRow;
use crate::math::{Lanes, Real};
use crate::model::rows::Row;
use crate::schedule::resistance::PhysicalStiffness;

/// The direction of four links side by side.
#[derive(Debug, Clone, Copy)]
pub struct WeaveGroup<R> {
    /// Squared cosine of the angle between link and warp at rest.
    pub warp: [R; 4],
}

/// The direction of a link, before it is laid out like the link itself.
#[derive(Debug, Clone, Copy)]
pub struct WeaveRow<R> {
    ends: [u32; 2],
    warp: R,
}

impl<R: Real> WeaveRow<R> {
    /// The direction of a link.
    pub fn new(link: &LinkRow<R>) -> Self {
        Self { ends: link.ends, warp: link.warp }
    }
}

impl<R: Real> Row for WeaveRow<R> {
    type Group = WeaveGroup<R>;
    const POINTS: usize = 2;
    const GROUPS: usize = LinkRow::<R>::GROUPS;

    fn point(&self, k: usize) -> u32 {
        self.ends[k]
    }

    fn idle(padding_point: u32) -> Self {
        Self { ends: [padding_point; 2], warp: R::ONE }
    }

    fn group(rows: [Self; 4]) -> WeaveGroup<R> {
        WeaveGroup { warp: rows.map(|row| row.warp) }
    }
}

/// The strength of a sweep over the links of woven cloth: 1 / (stiffness h²) in 1/kg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeaveStrength<R> {
    /// Along the warp.
    pub warp: Sides<R>,
    /// Along the weft.
    pub weft: Sides<R>,
    /// Against shear.
    pub shear: R,
    /// 4π² B h² in kg·m², or [`NO_BUCKLING`].
    pub buckling: R,
}

/// A load that no link reaches.
const NO_BUCKLING: f64 = 1e20;
/// Upper bound of a compliance, finite in `f32` also times the slenderness of a link.
const MAX_COMPLIANCE: f64 = 1e25;
/// Square of 2π.
const FOUR_PI_SQUARED: f64 = 4.0 * std::f64::consts::PI * std::f64::consts::PI;

impl<R: Real> WeaveStrength<R> {
    /// Rigid links, which do not buckle: of sweeps without compliance.
    pub fn rigid() -> Self {
        let rigid = Sides { above: R::ZERO, below: R::ZERO };
        Self { warp: rigid, weft: rigid, shear: R::ZERO, buckling: R::from_f64(NO_BUCKLING) }
    }

    /// The strength of a sweep in a time step of `h` seconds.
    pub fn new(stiffness: &PhysicalStiffness, buckles: bool, h: f64) -> Self {
        let compliance = |stiffness: f64| R::from_f64((1.0 / (stiffness * h * h)).min(MAX_COMPLIANCE));
        let below = compliance(stiffness.compression);
        let load =
            if buckles { (FOUR_PI_SQUARED * stiffness.bend * h * h).min(NO_BUCKLING) } else { NO_BUCKLING };
        Self {
            warp: Sides { above: compliance(stiffness.warp), below },
            weft: Sides { above: compliance(stiffness.weft), below },
            shear: compliance(stiffness.shear),
            buckling: R::from_f64(load),
        }
    }
}

/// The law of woven links.
#[derive(Debug, Clone, Copy)]
pub struct Woven<'a, R, P> {
    /// Their directions, one entry per group.
    pub groups: &'a [WeaveGroup<R>],
    /// The strength of the sweep.
    pub strength: &'a WeaveStrength<R>,
    /// Their vertex map.
    pub map: P,
}

impl<R: Real, P: StrengthMap<R>> StrengthMap<R> for Woven<'_, R, P> {
    #[inline(always)]
    fn scale<L: Lanes<R>>(self, at: usize, c: L, share: L, compliance: L) -> (L, L) {
        self.map.scale(at, c, share, compliance)
    }
}

impl<R: Real, P: StrengthMap<R>> LinkLaw<R> for Woven<'_, R, P> {
    #[inline(always)]
    fn multiplier<L: Lanes<R>>(
        self,
        at: usize,
        projection: &LinkProjection<L>,
        [rest, slenderness]: [L; 2],
        [length, mobility]: [L; 2],
    ) -> L {
        let splat = L::splat;
        let (zero, one, tiny) = (splat(R::ZERO), splat(R::ONE), splat(R::MIN_DENOMINATOR));
        let WeaveStrength { warp, weft, shear, buckling } = self.strength;
        let [c, share, _] = projection.violation(length, rest);
        let rest = rest * projection.rest_scale();
        let along = L::of_groups(|k| self.groups[at + k].warp);
        let across = one - along;
        let side = |sides: &Sides<R>| c.choose_by_sign(splat(sides.above), splat(sides.below));
        let threads = along * along * side(warp) + across * across * side(weft);
        let compliance = threads + along * across * splat(*shear);
        let (share, compliance) = self.scale(at, c, share, compliance);
        let elastic = share * c / ((mobility + compliance * slenderness) * length + tiny);
        // λ = -P (2 l - c) / (2 l² s + P w) solves λ = -h² N (1 + ε/2) · width at the end of the step.
        let load = splat(*buckling);
        let twice = rest + rest;
        let room = twice * rest * slenderness + load * mobility;
        let buckled = zero - share * load * (twice - c) / (room * length + tiny);
        c.choose_by_sign(elastic, elastic.most(buckled))
    }
}

/// The energy in joules of a link whose length differs by `c` metres from its rest length `rest`.
pub fn energy(
    stiffness: &PhysicalStiffness,
    buckles: bool,
    along: f64,
    share: f64,
    [c, rest, slenderness]: [f64; 3],
) -> f64 {
    let side = |above: f64| if c > 0.0 { above } else { stiffness.compression };
    let term = |weight: f64, stiffness: f64| if weight > 0.0 { weight / stiffness } else { 0.0 };
    let across = 1.0 - along;
    let threads = term(along * along, side(stiffness.warp)) + term(across * across, side(stiffness.weft));
    let elastic = share / (threads + term(along * across, stiffness.shear)) / slenderness;
    let half = |c: f64| elastic * c * c / 2.0;
    if !buckles || c >= 0.0 || rest <= 0.0 {
        return half(c);
    }
    // Force N (1 + s / 2l) over the width l / slenderness, from where it is below that of the elastic link.
    let load = FOUR_PI_SQUARED * stiffness.bend / (rest * slenderness);
    let soft = load / (2.0 * rest);
    let start = if elastic > soft { load / (elastic - soft) } else { f64::INFINITY };
    let s = -c;
    if s <= start { half(c) } else { half(start) + load * (s - start) + soft * (s * s - start * start) / 2.0 }
}
