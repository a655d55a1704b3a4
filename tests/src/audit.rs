//! Runs under audit, for tests that show that nothing passes through anything.

use nucleus_audit::AuditCounts;
use nucleus_graph::Simulation;
use nucleus_graph::audit::Closeness;
use nucleus_graph::compile::Program;

/// What an audit has come to, and what it found first, in words.
#[derive(Debug)]
pub struct Audited {
    /// The counts.
    pub account: AuditCounts,
    /// The first findings.
    pub findings: Vec<String>,
}

impl Audited {
    /// Fails with the first findings unless nothing was found.
    pub fn assert_clean(&self, name: &str) {
        let first = &self.findings[..self.findings.len().min(5)];
        assert!(self.account.is_clean(), "{name}: {:?} {first:#?}", self.account);
    }
}

/// Runs a program for so many frames, on so many threads, with every state that the solver shows under audit.
pub fn audited(program: &Program, frames: usize, threads: usize) -> Audited {
    let mut run = Simulation::<f32>::new(program, threads);
    run.begin_audit(Closeness::Steps);
    for _ in 0..frames {
        run.advance(&mut ());
    }
    let audit = run.audit().expect("it was begun");
    Audited { account: audit.account(), findings: audit.findings().collect() }
}
