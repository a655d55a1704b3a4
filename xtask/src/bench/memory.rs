//! Peak memory of this process.

use std::fs;

/// Resets the peak; on systems without this feature, figures include earlier runs.
pub fn reset_peak() {
    // Without this file there is no figure either.
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// Peak since the last reset, in bytes; `None` on systems that do not report it.
pub fn peak() -> Option<u64> {
    peak_of(&fs::read_to_string("/proc/self/status").ok()?)
}

/// The peak in `/proc/self/status`, in bytes.
fn peak_of(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse().ok().map(|kilobytes: u64| 1024 * kilobytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_is_converted_to_bytes() {
        let status = "VmPeak:\t    9000 kB\nVmHWM:\t    1234 kB\nVmRSS:\t     800 kB\n";
        assert_eq!(peak_of(status), Some(1234 * 1024));
        assert_eq!(peak_of("VmRSS:\t     800 kB\n"), None);
    }
}
