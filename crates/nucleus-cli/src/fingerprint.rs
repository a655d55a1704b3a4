//! A number for all that a scene has come to: its nodes, what is set and connected, meshes and maps as they were read.

use std::fmt::Write;

use nucleus_graph::compile::Program;
use nucleus_measure::result_cache::Fingerprint;

/// Of a program; the same wherever its files are. Frames, checks and what is recorded have no part in it.
pub fn fingerprint(program: &Program) -> String {
    let mut hash = Hash(Fingerprint::default());
    // Everything that is derived takes part, in the order in which it stands. Writing into a hash cannot fail.
    let _ = write!(hash, "{:?}{:?}", program.universes(), program.graph());
    hash.0.name()
}

/// Takes up text as it is written.
struct Hash(Fingerprint);

impl Write for Hash {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0 = self.0.bytes(text.as_bytes());
        Ok(())
    }
}
