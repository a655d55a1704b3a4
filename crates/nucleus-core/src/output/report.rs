//! What the solver says about a frame: counts and worst values. A step cannot fail; what could not be
//! satisfied is counted here.

use crate::input::validation::Sanitized;

/// The account of one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport {
    /// Largest stretch of any link at the end of the frame: length over rest length, less one.
    pub max_strain: f64,
    /// The stretch that 99 % of the links stay below.
    pub strain_99: f64,
    /// Smallest distance between a point and a collider or the plane at the end of the frame, over the
    /// thickness held there: 1 is touching, below 1 is pressed in. Infinite when nothing is near.
    pub min_gap: f64,
    /// The same between two elements of cloth that met at the end of the frame, over the thickness kept
    /// between them. Infinite when none did.
    pub min_cloth_gap: f64,
    /// Pairs of neighbours in a cloth that keep less than its thickness, because they are nearer at rest.
    pub rest_limited: u64,
    /// Contacts that pushed, over all passes of the frame.
    pub contacts: u64,
    /// Candidate pairs found by the broad phase, over all its runs in the frame.
    pub candidate_pairs: u64,
    /// Runs of the broad phase: one per substep, and one more wherever motion outran its margin.
    pub broad_phases: u32,
    /// Pairs of elements, of cloth and a collider or of two cloths, that would have passed each other and whose motion
    /// was undone or cut short, once for each time.
    pub pairs_reverted: u64,
    /// Such pairs for which nothing helped, so that one may have passed the other, once for each time step. They are
    /// between pins or colliders that leave no way out, or touched when the time step began.
    pub pairs_unresolved: u64,
    /// Points that are inside a closed collider, and are being led out.
    pub depenetrating: u64,
    /// Edges of cloth that go through faces of cloth at the end of the frame, and are being worked apart.
    pub intersections: u64,
    /// Kinetic energy at the end of the frame in joules.
    pub kinetic_energy: f64,
    /// Whether every position and velocity is a finite number.
    pub finite: bool,
    /// What the frame brought and was no number: held or left out.
    pub sanitized: Sanitized,
    /// Whether the observer ended the frame before its end; the other figures then mean nothing.
    pub stopped: bool,
}

impl Default for StepReport {
    fn default() -> Self {
        Self {
            max_strain: 0.0,
            strain_99: 0.0,
            min_gap: f64::INFINITY,
            min_cloth_gap: f64::INFINITY,
            rest_limited: 0,
            contacts: 0,
            candidate_pairs: 0,
            broad_phases: 0,
            pairs_reverted: 0,
            pairs_unresolved: 0,
            depenetrating: 0,
            intersections: 0,
            kinetic_energy: 0.0,
            finite: true,
            sanitized: Sanitized::default(),
            stopped: false,
        }
    }
}
