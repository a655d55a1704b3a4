//! Sweeps: each list of a round once, blocks side by side, then what crosses them, colour by colour.

use crate::columns::Shared;
use crate::constraints::{bend, stretch};
use crate::model::{Blocks, RowList};
use crate::scalar::Real;
use crate::schedule::{Effect, Sweep};
use crate::solver::Solver;
use crate::team::Team;

/// Does the sweeps of a round. Inner rows of all lists come first, block by block, while the block is in the
/// core's cache; then cross rows, list by list.
pub fn sweep<R: Real>(solver: &mut Solver<R>, sweeps: &[Sweep<R>]) {
    let Solver { cloths, state, team, .. } = solver;
    let points = Shared::new(&mut state.displacement);
    for of_cloth in sweeps.chunk_by(|a, b| a.cloth == b.cloth) {
        let Some(cloth) = of_cloth.first().map(|sweep| &cloths[sweep.cloth]) else { continue };
        // SAFETY (of all blocks below): inner rows of two blocks, and cross rows of one colour, share no point;
        // the lists are laid out so, and tests hold them to it.
        #[allow(unsafe_code)]
        team.phase(cloth.blocks.len(), |block| {
            for sweep in of_cloth {
                match &sweep.effect {
                    Effect::Stretch(strength) => unsafe {
                        stretch::relax(points, cloth.stretch.inner(block), strength);
                    },
                    Effect::Shear(strength) => unsafe {
                        stretch::relax(points, cloth.shear.inner(block), strength);
                    },
                    Effect::Bend(strength) => unsafe {
                        bend::relax(points, cloth.bend.inner(block), strength);
                    },
                }
            }
        });
        #[allow(unsafe_code)]
        for sweep in of_cloth {
            match &sweep.effect {
                Effect::Stretch(strength) => {
                    over_cross(team, &cloth.stretch, |rows| unsafe {
                        stretch::relax(points, rows, strength)
                    });
                }
                Effect::Shear(strength) => {
                    over_cross(team, &cloth.shear, |rows| unsafe { stretch::relax(points, rows, strength) });
                }
                Effect::Bend(strength) => {
                    over_cross(team, &cloth.bend, |rows| unsafe { bend::relax(points, rows, strength) });
                }
            }
        }
    }
}

/// Does `work` on all rows of a list once: inner rows, then cross rows.
pub fn over_list<G: Sync>(team: &Team, blocks: &Blocks, list: &RowList<G>, work: impl Fn(&[G]) + Sync) {
    team.phase(blocks.len(), |block| work(list.inner(block)));
    over_cross(team, list, work);
}

/// Does `work` on the cross rows of a list, colour by colour.
fn over_cross<G: Sync>(team: &Team, list: &RowList<G>, work: impl Fn(&[G]) + Sync) {
    for colour in 0..list.cross_colours() {
        team.phase(list.cross_tasks(colour), |task| work(list.cross(colour, task)));
    }
}
