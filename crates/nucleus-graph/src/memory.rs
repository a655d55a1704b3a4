//! The memory limit of a scene. The memory of each part is estimated before it is allocated, and added up. A part that
//! would exceed the limit is an error at its place in the scene.
//!
//! The estimates are measured with `nucleus run` on planes of 90 000 and 360 000 points and on scenes of 50 000 and 200 000
//! nodes. They are typical values, not upper bounds: the memory of contacts depends on their number.

use std::fmt;

/// A limit, in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Memory(pub u64);

/// The limit where the memory of the machine is unknown.
const UNKNOWN: Memory = Memory(16_000_000_000);

impl Memory {
    /// Three quarters of the memory of the machine.
    pub fn of_machine() -> Self {
        let about = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
        let total = about.lines().find_map(|line| line.strip_prefix("MemTotal:"));
        let kilobytes = total.and_then(|rest| rest.trim().strip_suffix("kB")?.trim().parse::<u64>().ok());
        kilobytes.map_or(UNKNOWN, |kilobytes| Self(kilobytes.saturating_mul(1024) / 4 * 3))
    }
}

impl fmt::Display for Memory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let units = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
        let found = units.into_iter().find(|(size, _)| self.0 as f64 >= *size);
        let (size, unit) = found.unwrap_or((1.0, "bytes"));
        let number = self.0 as f64 / size;
        if number < 10.0 { write!(f, "{number:.1} {unit}") } else { write!(f, "{number:.0} {unit}") }
    }
}

/// Size of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Size {
    /// Count of points.
    pub points: u64,
    /// Count of face corners: four for each quad.
    pub corners: u64,
}

/// Memory of an object in bytes per point and per face corner.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cost {
    point: u64,
    corner: u64,
}

impl Cost {
    /// A mesh during its construction.
    pub(crate) const MESH: Self = Self { point: 50, corner: 15 };
    /// Cloth or particles: measured 2.5 to 5.7 kB per point with four corners.
    pub(crate) const CLOTH: Self = Self { point: 600, corner: 500 };
    /// A collider: measured 0.7 kB per point with four corners.
    pub(crate) const COLLIDER: Self = Self { point: 200, corner: 120 };

    /// Bytes for an object of this size.
    pub(crate) fn of(self, size: Size) -> u64 {
        let [points, corners] = [(size.points, self.point), (size.corners, self.corner)];
        let bytes = |(count, each): (u64, u64)| count.saturating_mul(each);
        bytes(points).saturating_add(bytes(corners))
    }
}

/// Bytes per value in the text of a scene.
pub(crate) const VALUE: u64 = 100;
/// Bytes per cross link of a face with more than four corners: measured 74 on faces of 1500 and 3000 corners.
pub(crate) const CROSS_LINK: u64 = 75;
/// Bytes per node of a scene.
pub(crate) const NODE: u64 = 3_000;
/// Bytes per point that a constraint holds.
pub(crate) const HELD_POINT: u64 = 100;
/// Bytes per point and frame of an animated mesh.
pub(crate) const SHAPE_POINT: u64 = 24;
/// Bytes per byte of a mesh file, while it is read: `v 0 0 0` is 24 bytes of position.
pub(crate) const MESH_BYTE: u64 = 8;
/// Bytes per byte of a file of numbers, while it is read.
pub(crate) const NUMBER_BYTE: u64 = 10;

/// A limit, and the memory that is claimed of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Budget {
    limit: Memory,
    taken: u64,
    /// Whether a claim has been refused.
    is_exceeded: bool,
}

/// A part of a scene that would exceed the limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TooLarge {
    part: Memory,
    all: Memory,
    limit: Memory,
    /// The first refusal of a scene. Later ones are not reported.
    pub(crate) is_first: bool,
}

impl Default for Budget {
    fn default() -> Self {
        Self::new(Memory::of_machine())
    }
}

impl Budget {
    pub(crate) fn new(limit: Memory) -> Self {
        Self { limit, taken: 0, is_exceeded: false }
    }

    /// Claims memory for the lifetime of the scene.
    pub(crate) fn claim(&mut self, bytes: u64) -> Result<(), TooLarge> {
        let checked = self.check(bytes);
        match checked {
            Ok(()) => self.taken += bytes,
            Err(_) => self.is_exceeded = true,
        }
        checked
    }

    /// The memory that is claimed.
    pub(crate) fn taken(&self) -> Memory {
        Memory(self.taken)
    }

    /// Checks memory that is freed soon after.
    pub(crate) fn check(&self, bytes: u64) -> Result<(), TooLarge> {
        let all = self.taken.saturating_add(bytes);
        if all <= self.limit.0 {
            return Ok(());
        }
        let is_first = !self.is_exceeded;
        Err(TooLarge { part: Memory(bytes), all: Memory(all), limit: self.limit, is_first })
    }
}

impl fmt::Display for TooLarge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "about {} of memory", self.part)?;
        if self.all != self.part {
            write!(f, ", {} with all before it", self.all)?;
        }
        write!(f, "; the limit is {}", self.limit)
    }
}

impl TooLarge {
    /// Help for the error: `alternative`, or a larger limit.
    pub(crate) fn help(&self, alternative: &str) -> String {
        format!("{alternative}, or allow more: `--memory {}`", self.all.asked())
    }
}

impl Memory {
    /// The argument of `--memory`, rounded up.
    fn asked(self) -> String {
        match self.0 {
            bytes if bytes < 1_000_000_000 => format!("{}M", bytes.div_ceil(1_000_000)),
            bytes => format!("{}G", bytes.div_ceil(1_000_000_000)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_beyond_the_limit_is_refused_with_the_sum_of_all_claims() {
        let mut budget = Budget::new(Memory(3_000_000_000));
        budget.claim(2_000_000_000).unwrap();
        budget.check(1_000_000_000).unwrap();
        let refused = budget.claim(1_100_000_000).unwrap_err();
        assert_eq!(
            refused.to_string(),
            "about 1.1 GB of memory, 3.1 GB with all before it; the limit is 3.0 GB"
        );
        assert_eq!(refused.help("x"), "x, or allow more: `--memory 4G`");
        // A refused claim takes no memory.
        budget.claim(1_000_000_000).unwrap();
    }

    #[test]
    fn estimates_of_huge_sizes_do_not_overflow() {
        let size = Size { points: u64::MAX, corners: u64::MAX };
        assert!(Budget::default().claim(Cost::CLOTH.of(size)).is_err());
    }
}
