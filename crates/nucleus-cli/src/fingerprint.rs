//! A number for all that a scene has come to: its nodes, what is set and connected, meshes and maps as they were read.

use std::fmt::Write;

use nucleus_graph::compile::Program;

/// Of a program; the same wherever its files are. Frames, checks and what is recorded have no part in it.
pub fn fingerprint(program: &Program) -> String {
    let mut hash = Hash(0xcbf2_9ce4_8422_2325);
    // Everything that is derived takes part, in the order in which it stands. Writing into a hash cannot fail.
    let _ = write!(hash, "{:?}{:?}", program.universes(), program.graph());
    format!("{:016x}", hash.0)
}

/// FNV-1a.
struct Hash(u64);

impl Write for Hash {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        let mixed = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        self.0 = text.bytes().fold(self.0, mixed);
        Ok(())
    }
}
