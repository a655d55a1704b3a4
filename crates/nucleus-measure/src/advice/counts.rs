//! N2.4-13, N2.4-17 and N2.4-18: numbers of substeps and iterations, for pairs, for particles, and for propagation.

use super::claim::{ClaimResult, Experiment, Status, name};
use super::scenes::{Parameters, drape, late_strain, pairs_per_query, particles, strain, strip};

use crate::report::{figure, percent};
use crate::trade::Reading;
use crate::trade::run::Run;

pub const FASTER: Experiment = Experiment {
    claim: "N2.4-13",
    says: "More substeps can be faster, because smaller steps find fewer pairs.",
    scene: "A ball is driven into a sheet at 0.9 m/s, with 1 to 16 substeps; read as Physical, the total work is the \
        same.",
    run: || [Reading::Physical, Reading::Classic].map(substep_cost).to_vec(),
};

/// Tested substeps.
const SUBSTEPS: [u32; 5] = [1, 2, 4, 8, 16];

fn substep_cost(reading: Reading) -> ClaimResult {
    let runs = SUBSTEPS.map(|substeps| drape(&Parameters { substeps, ..Parameters::new(reading) }));
    let rows = SUBSTEPS.iter().zip(&runs).map(|(substeps, run)| {
        vec![
            substeps.to_string(),
            figure(pairs_per_query(run)),
            figure(run.queries as f64 / run.frames.len() as f64),
            figure(run.ms()),
            percent(strain(run)),
        ]
    });
    let cheapest = (0..runs.len()).min_by(|&a, &b| runs[a].ms().total_cmp(&runs[b].ms())).unwrap_or(0);
    let fewer = runs.windows(2).all(|pair| pairs_per_query(&pair[1]) <= pairs_per_query(&pair[0]));
    let reason = format!(
        "a query finds {} pairs at 1 substep and {} at 16 ({}); the cheapest is {} substep(s) with {} ms, 1 takes {} ms",
        figure(pairs_per_query(&runs[0])),
        figure(pairs_per_query(&runs[4])),
        if fewer { "never more with more substeps" } else { "not always fewer with more substeps" },
        SUBSTEPS[cheapest],
        figure(runs[cheapest].ms()),
        figure(runs[0].ms()),
    );
    ClaimResult {
        reading: name(reading),
        status: Status::of(cheapest > 0),
        reason,
        table: (
            vec!["substeps", "pairs per query", "queries per frame", "ms", "strain, 99 %"],
            rows.collect(),
        ),
    }
}

pub const ONE_IS_ENOUGH: Experiment = Experiment {
    claim: "N2.4-17",
    says: "Particles that collide only with objects need 1 substep and 1 collision iteration.",
    scene: "256 points without links (a cloth without resistances) fall on a ball and the ground.",
    run: || [Reading::Classic, Reading::Physical].map(particles_at_one).to_vec(),
};

fn particles_at_one(reading: Reading) -> ClaimResult {
    let runs = [(1, 1), (3, 4), (16, 16)].map(|(substeps, collision_iterations)| {
        // Points have no links: one evaluation is one time step.
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
        reading: name(reading),
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

pub const STEEP: Experiment = Experiment {
    claim: "N2.4-18",
    says: "Networks through which an effect propagates need more iterations, and the number grows steeply.",
    scene: "Strips of 8 to 64 cells hang from one edge: the smallest count (a power of two) at which their final stretch \
        is at most 5 %.",
    run: || [Reading::Classic, Reading::Physical].map(growth_of_need).to_vec(),
};

/// Cells of the strips.
const CELLS: [u32; 4] = [8, 16, 32, 64];

/// Tolerated stretch.
const ALLOWED: f64 = 0.05;

fn growth_of_need(reading: Reading) -> ClaimResult {
    let needed = CELLS.map(|cells| need(reading, cells));
    let rows = CELLS
        .iter()
        .zip(&needed)
        .map(|(cells, (count, strain))| vec![cells.to_string(), figure(*count), percent(*strain)]);
    let power = (needed[3].0 / needed[0].0).log2() / 3.0;
    ClaimResult {
        reading: name(reading),
        status: Status::of(power > 1.2),
        reason: format!("the count grows with the power {power:.2} of the length"),
        table: (vec!["cells", "count needed", "strain, 99 %"], rows.collect()),
    }
}

/// The smallest sufficient count, and its strain. Counts are resistances for Classic, evaluations for Physical.
fn need(reading: Reading, cells: u32) -> (f64, f64) {
    let counts = (0..16).map(|k| f64::from(1 << k));
    let mut last = (f64::INFINITY, f64::INFINITY);
    for count in counts {
        let parameters = match reading {
            Reading::Classic => Parameters { stretch: count, substeps: 1, ..Parameters::new(reading) },
            Reading::Physical => {
                Parameters { evaluations: count, stretch: 200.0, substeps: 1, ..Parameters::new(reading) }
            }
        };
        last = (count, late_strain(&strip(&parameters, cells)));
        if last.1 <= ALLOWED {
            break;
        }
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;

    // EVIDENCE: N2.4-13  more substeps find fewer pairs each
    #[test]
    fn a_query_finds_fewer_pairs_when_there_are_more_substeps() {
        for reading in [Reading::Classic, Reading::Physical] {
            let pairs = [1, 4, 16].map(|substeps| {
                pairs_per_query(&drape(&Parameters { substeps, ..Parameters::new(reading) }))
            });
            assert!(pairs.is_sorted_by(|fewer_substeps, more| fewer_substeps > more), "{pairs:?}");
        }
    }

    // EVIDENCE: N2.4-17  points that meet only objects need one substep and one collision iteration
    #[test]
    fn points_without_links_keep_their_distance_at_one_substep_and_one_iteration() {
        for result in (ONE_IS_ENOUGH.run)() {
            assert_eq!(result.status, Status::Holds, "{}: {}", result.reading, result.reason);
        }
    }

    // EVIDENCE: N2.4-18  the iterations that a hanging strip needs grow faster than its length
    #[test]
    fn a_strip_twice_as_long_needs_more_than_twice_the_iterations() {
        let result = growth_of_need(Reading::Classic);
        assert_eq!(result.status, Status::Holds, "{}: {:?}", result.reason, result.table);
    }
}
