//! N2.4-18: what has to propagate.

use super::scenes::{Parameters, late_strain, strip};
use super::{ClaimResult, Experiment, Status};
use crate::report::{figure, percent};
use crate::trade::Reading;

pub const STEEP: Experiment = Experiment {
    claim: "N2.4-18",
    says: "Networks through which something must propagate need more iterations, and the need grows steeply.",
    scene: "Strips of 8 to 64 cells hang by one edge: the least count (a power of two) at which they stretch by no more than 5 % in the end.",
    run: || [Reading::Classic, Reading::Physical].map(run).to_vec(),
};

/// Cells of the strips, each twice the one before.
const CELLS: [u32; 4] = [8, 16, 32, 64];

/// The stretch that is allowed.
const ALLOWED: f64 = 0.05;

fn run(reading: Reading) -> ClaimResult {
    let needed = CELLS.map(|cells| need(reading, cells));
    let rows = CELLS
        .iter()
        .zip(&needed)
        .map(|(cells, (count, strain))| vec![cells.to_string(), figure(*count), percent(*strain)]);
    let power = (needed[3].0 / needed[0].0).log2() / 3.0;
    ClaimResult {
        reading: super::page::name(reading),
        status: Status::of(power > 1.2),
        reason: format!("the need grows with the power {power:.2} of the length"),
        table: (vec!["cells", "count needed", "strain, 99 %"], rows.collect()),
    }
}

/// The least count, and the strain at it. Read as Classic it is the resistance, as Physical the evaluations.
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

    // EVIDENCE: N2.4-18  the iterations that a hanging strip needs grow faster than its length
    #[test]
    fn a_strip_twice_as_long_needs_more_than_twice_the_iterations() {
        let result = run(Reading::Classic);
        assert_eq!(result.status, Status::Holds, "{}: {:?}", result.reason, result.table);
    }
}
