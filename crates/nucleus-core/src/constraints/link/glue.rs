//! Glue: links that break under load.
//!
//! The load of a link is the mean force that it carries over a substep, from the impulses of its projections, per length
//! of the edge that it stands for. It follows from the balance of momentum alone, so it depends on neither mesh, time step
//! nor the solver's stiffness. At the end of a substep all links above their breaking load break at once.

use nalgebra::Vector3;

use crate::input::frame::FrameInput;
use crate::input::links::{ConstraintFrame, Link};
use crate::math::Real;

use super::lists::{CombinedList, ConstraintLinks, Links};
use super::rows::NO_LINK;

/// Load in N/m that breaks half-strong glue (`glueStrength` 0.5).
pub const LOAD_OF_HALF: f64 = 100.0;

/// The breaking load in N/m of a glue strength: zero at 0, any load at 1.
pub fn breaking_load(glue_strength: f64) -> f64 {
    match glue_strength {
        glue if glue >= 1.0 => f64::INFINITY,
        glue => LOAD_OF_HALF * glue.max(0.0) / (1.0 - glue.max(0.0)),
    }
}

impl<R: Real, const N: usize> CombinedList<R, N> {
    /// Calls `each` with every link and the impulse that it carried in N·s, and starts anew.
    fn take_impulses(&mut self, mut each: impl FnMut(u32, Vector3<f64>)) {
        for (group, impulse) in self.rows.groups().iter().zip(&mut self.impulses) {
            for lane in (0..4).filter(|&lane| group.link[lane] != NO_LINK) {
                each(group.link[lane], Vector3::from([0, 1, 2].map(|axis| impulse[axis][lane].to_f64())));
            }
            *impulse = [[R::ZERO; 4]; 3];
        }
    }

    /// Takes broken links out of the sweeps.
    fn release(&mut self, broken: &[bool]) {
        for group in self.rows.groups_mut() {
            for lane in (0..4).filter(|&lane| group.link[lane] != NO_LINK) {
                if broken[group.link[lane] as usize] {
                    group.factor[lane] = R::ZERO;
                }
            }
        }
    }
}

impl<R: Real> ConstraintLinks<R> {
    /// Breaks all links whose load in a substep of `length` seconds was above theirs. Whether there were any.
    fn break_links(&mut self, settings: &ConstraintFrame, length: f64) -> bool {
        let Self { links, broken, one, two, three, four, five, six, surface, .. } = self;
        let mut any = false;
        let mut judge = |at: u32, impulse: Vector3<f64>| {
            let (link, broken): (&Link, &mut bool) = (&links[at as usize], &mut broken[at as usize]);
            let limit = breaking_load(settings.glue_strength * link.glue) * settings.glue_scale;
            if !*broken && impulse.norm() > limit * link.length * length {
                (*broken, any) = (true, true);
            }
        };
        one.take_impulses(&mut judge);
        two.take_impulses(&mut judge);
        three.take_impulses(&mut judge);
        four.take_impulses(&mut judge);
        five.take_impulses(&mut judge);
        six.take_impulses(&mut judge);
        for row in surface {
            judge(row.link, std::mem::take(&mut row.impulse));
        }
        if any {
            one.release(broken);
            two.release(broken);
            three.release(broken);
            four.release(broken);
            five.release(broken);
            six.release(broken);
        }
        any
    }
}

/// Breaks links at the end of a substep of `length` seconds. Whether any broke.
pub fn break_links<R: Real>(links: &mut Links<R>, frame: &FrameInput, length: f64) -> bool {
    let pairs = links.constraints.iter_mut().zip(&frame.constraints);
    let mut any = false;
    for (own, settings) in pairs.filter(|(_, settings)| settings.can_break) {
        any |= own.break_links(settings, length);
    }
    any
}
