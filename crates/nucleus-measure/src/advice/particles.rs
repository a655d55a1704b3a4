//! N2.4-17: particles that meet only objects.

use super::scenes::{Parameters, particles};
use super::{ClaimResult, Experiment, Status};
use crate::report::figure;
use crate::trade::Reading;
use crate::trade::run::Run;

pub const ONE_IS_ENOUGH: Experiment = Experiment {
    claim: "N2.4-17",
    says: "Particles that collide only with objects need 1 substep and 1 collision iteration.",
    scene: "256 points without links (a cloth without resistances) fall on a ball and the ground.",
    run: || [Reading::Classic, Reading::Physical].map(run).to_vec(),
};

fn run(reading: Reading) -> ClaimResult {
    let runs = [(1, 1), (3, 4), (16, 16)].map(|(substeps, collision_iterations)| {
        // A point has nothing to be evaluated: one evaluation is one time step.
        let evaluations = f64::from(substeps);
        (
            substeps,
            collision_iterations,
            particles(&Parameters {
                substeps,
                collision_iterations,
                evaluations,
                ..Parameters::new(reading)
            }),
        )
    });
    let least = |run: &Run| run.contact.least_gap.unwrap_or(f64::INFINITY);
    let (_, _, one) = &runs[0];
    let rows = runs.iter().map(|(substeps, passes, run)| {
        vec![
            substeps.to_string(),
            passes.to_string(),
            run.contact.pairs_unresolved.to_string(),
            figure(least(run)),
            figure(run.ms()),
        ]
    });
    ClaimResult {
        reading: super::page::name(reading),
        status: Status::of(one.contact.pairs_unresolved == 0 && least(one) > 0.98 && one.is_finite()),
        reason: format!(
            "at one and one, {} pairs are unresolved and the least gap is {} of the thickness",
            one.contact.pairs_unresolved,
            figure(least(one))
        ),
        table: (
            vec!["substeps", "collision iterations", "pairs unresolved", "least gap", "ms"],
            rows.collect(),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // EVIDENCE: N2.4-17  points that meet only objects need one substep and one collision iteration
    #[test]
    fn points_without_links_keep_their_distance_at_one_substep_and_one_iteration() {
        for result in (ONE_IS_ENOUGH.run)() {
            assert_eq!(result.status, Status::Holds, "{}: {}", result.reading, result.reason);
        }
    }
}
