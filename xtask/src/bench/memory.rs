//! The most memory that this process has held since it was last asked to forget.

use std::fs;

/// Has the system forget the most that was held before; where it cannot, figures are of all that was run so far.
pub fn reset_peak() {
    // Where there is no such file there is no figure either.
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// The most that was held since, in bytes; nothing where the system does not tell.
pub fn most() -> Option<u64> {
    held(&fs::read_to_string("/proc/self/status").ok()?)
}

/// What the system says of a process, as bytes.
fn held(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse().ok().map(|kilobytes: u64| 1024 * kilobytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_that_was_held_is_told_in_bytes() {
        let status = "VmPeak:\t    9000 kB\nVmHWM:\t    1234 kB\nVmRSS:\t     800 kB\n";
        assert_eq!(held(status), Some(1234 * 1024));
        assert_eq!(held("VmRSS:\t     800 kB\n"), None);
    }
}
