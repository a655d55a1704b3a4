//! N2.4-13: more substeps can be faster.

use super::scenes::{Parameters, drape, pairs_per_query, strain};
use super::{ClaimResult, Experiment, Status};
use crate::report::{figure, percent};
use crate::trade::Reading;

pub const FASTER: Experiment = Experiment {
    claim: "N2.4-13",
    says: "More substeps can be faster, since smaller steps find fewer pairs.",
    scene: "A ball is driven into a sheet at 0.9 m/s, 1 to 16 substeps; the same work in all, read as Physical.",
    run: || [Reading::Physical, Reading::Classic].map(run).to_vec(),
};

/// Substeps that are tried.
const SUBSTEPS: [u32; 5] = [1, 2, 4, 8, 16];

fn run(reading: Reading) -> ClaimResult {
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
        "a search finds {} pairs at 1 substep and {} at 16 ({}); the cheapest is {} substep(s) with {} ms, 1 takes {} ms",
        figure(pairs_per_query(&runs[0])),
        figure(pairs_per_query(&runs[4])),
        if fewer { "never more with more" } else { "not always fewer with more" },
        SUBSTEPS[cheapest],
        figure(runs[cheapest].ms()),
        figure(runs[0].ms()),
    );
    ClaimResult {
        reading: super::page::name(reading),
        status: Status::of(cheapest > 0),
        reason,
        table: (vec!["substeps", "pairs a search", "searches a frame", "ms", "strain, 99 %"], rows.collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // EVIDENCE: N2.4-13  more substeps find fewer pairs each
    #[test]
    fn a_search_finds_fewer_pairs_when_there_are_more_substeps() {
        for reading in [Reading::Classic, Reading::Physical] {
            let pairs = [1, 4, 16].map(|substeps| {
                pairs_per_query(&drape(&Parameters { substeps, ..Parameters::new(reading) }))
            });
            assert!(pairs[1] < 0.7 * pairs[0] && pairs[2] < pairs[1], "{pairs:?}");
        }
    }
}
