//! An experiment on a claim of the paper, its result, and the Markdown page of all.

use std::fmt::Write;

use crate::trade::Reading;

/// An experiment on a claim of the paper.
pub struct Experiment {
    /// Number of the claim.
    pub claim: &'static str,
    /// The claim.
    pub says: &'static str,
    /// The scene, in words.
    pub scene: &'static str,
    /// Runs it.
    pub run: fn() -> Vec<ClaimResult>,
}

/// Result for one reading of resistances.
#[derive(Debug, Clone, PartialEq)]
pub struct ClaimResult {
    /// `Classic`, `Physical`.
    pub reading: &'static str,
    /// Whether the claim holds.
    pub status: Status,
    /// The reason, with the decisive figures.
    pub reason: String,
    /// Column heads, and rows.
    pub table: (Vec<&'static str>, Vec<Vec<String>>),
}

/// Whether a claim holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// It holds.
    Holds,
    /// It does not hold.
    DoesNotHold,
    /// The reading has nothing that the claim is about.
    DoesNotApply,
}

impl Status {
    /// `Holds` or `DoesNotHold`.
    pub fn of(holds: bool) -> Self {
        if holds { Self::Holds } else { Self::DoesNotHold }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::DoesNotHold => "does not hold",
            Self::DoesNotApply => "does not apply",
        }
    }
}

/// Name of a reading on the page.
pub(super) fn name(reading: Reading) -> &'static str {
    match reading {
        Reading::Classic => "Classic",
        Reading::Physical => "Physical",
    }
}

/// The page in Markdown; `machine` describes the machine of the times.
pub fn page(results: &[(Experiment, Vec<ClaimResult>)], machine: &str) -> String {
    let mut text = format!(
        "# The paper's advice, tested\n\nThe white paper on Nucleus gives advice on settings; [`claims.md`](claims.md) numbers it.\nEach piece of advice is an experiment on this solver, for both readings of a resistance.\nCounts and strains are the same on every machine; milliseconds are processor time of one core.\n`cargo xtask book` rewrites this page.\n\n{machine}\n\n| Claim | | Classic | Physical |\n|---|---|---|---|\n"
    );
    for (experiment, results) in results {
        let status = |reading: &str| {
            results.iter().find(|f| f.reading == reading).map_or("not tested", |f| f.status.words())
        };
        let Experiment { claim, says, .. } = experiment;
        put(&mut text, format_args!("| {claim} | {says} | {} | {} |", status("Classic"), status("Physical")));
    }
    for (Experiment { claim, says, scene, .. }, results) in results {
        put(&mut text, format_args!("\n## {claim}\n\n{says}\n\n{scene}"));
        for ClaimResult { reading, status, reason, table: (head, rows) } in results {
            put(&mut text, format_args!("\n**{reading}: {}.** {}.", status.words(), capital(reason)));
            if !rows.is_empty() {
                put(&mut text, format_args!("\n| {} |\n|{}", head.join(" | "), "---:|".repeat(head.len())));
            }
            for row in rows {
                put(&mut text, format_args!("| {} |", row.join(" | ")));
            }
        }
    }
    text
}

fn put(text: &mut String, line: std::fmt::Arguments) {
    // Writing to a string does not fail.
    let _ = writeln!(text, "{line}");
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}
