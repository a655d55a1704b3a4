//! The internal constraints of cloth: one effect per file, named as the artist names it.
//!
//! A constraint is a function C(x) of a few points that is zero at rest. A Gauss-Seidel sweep projects the rows of a
//! list one after the other (position-based dynamics: Müller et al. 2007, §3.2 and §4.1). With inverse masses w_i, the
//! correction of a row is
//!
//! ```text
//! dx_i = -w_i (grad_i C) lambda,    lambda = s C / (sum_j w_j |grad_j C|² + alpha / h²)
//! ```
//!
//! * **Classic** (§2.2, §2.4 of the Nucleus paper): alpha = 0, several sweeps per time step, and s is the share of the
//!   error that a sweep removes. Stiffness follows from mesh and substeps.
//! * **Physical**: s = 1, and alpha is the compliance, one over the stiffness (XPBD: Macklin et al. 2016, eq. 18). A
//!   substep has many time steps with one sweep each (small steps: Macklin et al. 2019), so the multiplier starts at
//!   zero in every sweep.
//!
//! | Effect | Rows | Read |
//! |---|---|---|
//! | stretch, compression, shear | links | [`stretch`], their sweeps in [`projection`] |
//! | warp and weft of woven cloth; compression up to the buckling load | links | [`weave`] |
//! | links that are all corrected from the same state | links | [`parallel`] |
//! | bending (Bergou et al. 2006) | hinges of four or six points | [`bend`], its rows in [`hinge`] |
//! | tethers to pins | points | [`tether`] |
//! | damping of relative velocities | links | [`damp`] |
//! | angular momentum, which sweeps do not keep | points | [`angular_momentum`] |
//! | signed rest angles, angle scale and dropoff, flip tracking | hinges | [`angle`] |
//! | links and hinges that yield | links and hinges | [`plastic`] |
//! | pressure (ideal gas law) | chambers | [`pressure`] |
//! | `rigidity` and `deformResistance` (shape matching: Müller et al. 2005) | shells | [`shape`] |
//! | attraction to the live input mesh | points | [`attract`] |
//! | links of dynamic constraints: welds, springs, glue, sliding | links | [`link`] |
//! | incompressibility, viscosity and surface tension of liquids | particles | [`liquid`] |
//! | effects that take a cloth as a whole, in one place | all | [`whole`] |
//! | vertex maps of stiffness | beside links and hinges | [`strength_map`] |
//! | the order of rows in a sweep | all | [`sweep`](mod@sweep) |
//! | parallel loops over rows | all | [`row_loops`] |
//! | rows side by side in lanes | all | [`side_by_side`] |

pub mod angle;
pub mod angular_momentum;
pub mod attract;
pub mod bend;
pub mod damp;
pub mod hinge;
pub mod link;
pub mod liquid;
pub mod parallel;
pub mod plastic;
pub mod pressure;
pub mod projection;
pub mod row_loops;
pub mod shape;
pub mod side_by_side;
pub mod strength_map;
pub mod stretch;
pub mod sweep;
pub mod tether;
pub mod weave;
pub mod whole;
