//! Audited runs, for tests that nothing passes through anything.

use nucleus_audit::AuditCounts;
use nucleus_graph::Simulation;
use nucleus_graph::audit::Closeness;
use nucleus_graph::compile::Program;

/// The result of an audit.
#[derive(Debug)]
pub struct Audited {
    /// The counts.
    pub account: AuditCounts,
    /// The first findings, in words.
    pub findings: Vec<String>,
}

impl Audited {
    /// Panics with the first findings unless there are none.
    pub fn assert_clean(&self, name: &str) {
        let first = &self.findings[..self.findings.len().min(5)];
        assert!(self.account.is_clean(), "{name}: {:?} {first:#?}", self.account);
    }
}

/// Runs a program for `frames` frames and audits every time step.
pub fn audited(program: &Program, frames: usize, threads: usize) -> Audited {
    let mut run = Simulation::<f32>::new(program, threads);
    run.begin_audit(Closeness::Steps);
    for _ in 0..frames {
        run.advance(&mut ());
    }
    let audit = run.audit().expect("the audit has begun");
    Audited { account: audit.account(), findings: audit.findings().collect() }
}
