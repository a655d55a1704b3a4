//! Impact: a collider that goes farther in a time step than the cloth's faces are wide would leap over them, and one
//! that takes cloth along faster than its links pull the rest of it after would stretch it beyond measure.
//! While it is about to meet cloth, time steps are split so that it does neither.

use nalgebra::Vector3;

use crate::contact::collider::ColliderState;
use crate::input::frame::FrameInput;
use crate::math::Real;
use crate::schedule::{Schedule, StepInterval};
use crate::solver::Solver;

/// Edge lengths of a cloth that a collider may go in a time step.
const LEAP: f64 = 1.0;
/// Edge lengths that it has to go in a time step to tear at a cloth.
const TUG: f64 = 1.0 / 64.0;
/// Strain of a link from which on it is torn at. A sweep makes a link no stiffer than m / 2h², however stiff the cloth
/// is: what it can hold grows with the square of the parts.
const TORN: f64 = 0.25;
/// Parts of a time step, at most: for a leap, and for what is torn at.
const MOST_PARTS: f64 = 256.0;
const MOST_PULLS: f64 = 8.0;

impl<R: Real> Solver<R> {
    /// Into how many parts a time step is to be split.
    pub(crate) fn parts(
        &self,
        frame: &FrameInput,
        schedule: &Schedule<R>,
        span: StepInterval,
        max_speed: &[f64],
    ) -> u32 {
        let mut parts = 1.0f64;
        for (at, collider) in self.contact.collider_states.iter().enumerate() {
            let leap = collider.way * (span.to - span.from);
            if leap == 0.0 {
                continue;
            }
            for (index, cloth) in self.model.cloths.iter().enumerate() {
                let Some(terms) = &self.terms_of(index)[at] else { continue };
                let edges = leap / cloth.edge_length;
                let room = terms.thickness + max_speed[index] * schedule.h;
                // A cloth without edges is points, which nothing can leap over.
                if edges.is_finite() && edges > TUG && self.is_near(index, collider, span, room) {
                    let pulls = (self.largest_strain(index, frame.cloths[index].rest_length_scale) / TORN)
                        .min(MOST_PULLS);
                    parts = parts.max(edges / LEAP).max(pulls);
                }
            }
        }
        parts.ceil().min(MOST_PARTS) as u32
    }

    /// The largest strain of any link of a cloth.
    fn largest_strain(&self, cloth: usize, rest_scale: f64) -> f64 {
        let rest_scale = R::from_f64(rest_scale);
        let groups = self.model.cloths[cloth].stretch.groups().iter();
        let strains = groups.flat_map(|group| group.strain(&self.state.displacement, rest_scale));
        strains.fold(R::ZERO, |most, strain| if strain > most { strain } else { most }).to_f64()
    }

    /// Whether a collider comes near a cloth in a time step, by the boxes round them.
    fn is_near(&self, cloth: usize, collider: &ColliderState, span: StepInterval, room: f64) -> bool {
        let place = |row: u32| Vector3::from(self.state.position(row));
        let points = self.model.cloths[cloth].points();
        let first = place(points.start);
        let cloth =
            points.fold([first, first], |[low, high], row| [low.inf(&place(row)), high.sup(&place(row))]);
        let [from, to] = [span.from, span.to].map(|time| collider.bounds(time));
        let theirs = [from[0].inf(&to[0]), from[1].sup(&to[1])];
        (0..3).all(|k| cloth[0][k] - room <= theirs[1][k] && theirs[0][k] <= cloth[1][k] + room)
    }
}
