//! Numbers in messages and reports.

/// `812 bytes`, `3.4 kB`, `12.0 MB`.
pub fn bytes(bytes: u64) -> String {
    const UNITS: [&str; 4] = ["kB", "MB", "GB", "TB"];
    if bytes < 1000 {
        return count(bytes as usize, "byte");
    }
    let mut scaled = bytes as f64 / 1000.0;
    let mut unit = 0;
    while scaled >= 999.95 && unit + 1 < UNITS.len() {
        scaled /= 1000.0;
        unit += 1;
    }
    format!("{scaled:.1} {}", UNITS[unit])
}

/// `1 frame`, `3 frames`.
pub fn count(number: usize, noun: &str) -> String {
    format!("{number} {noun}{}", if number == 1 { "" } else { "s" })
}

/// Up to four significant digits, without trailing zeros: `0.0125`, `24`, `1.5`.
pub fn number(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let magnitude = x.abs().log10().floor() as i32;
    if magnitude < -6 {
        return format!("{x:.3e}");
    }
    let digits = (3 - magnitude).clamp(0, 12) as usize;
    let text = format!("{x:.digits$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

/// A share as a percentage: `1.25 %`.
pub fn percent(share: f64) -> String {
    format!("{} %", number(100.0 * share))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_scaled_to_a_unit_below_a_thousand() {
        assert_eq!(bytes(1), "1 byte");
        assert_eq!(bytes(999), "999 bytes");
        assert_eq!(bytes(1000), "1.0 kB");
        assert_eq!(bytes(999_960), "1.0 MB");
        assert_eq!(bytes(12_340_000_000), "12.3 GB");
    }

    #[test]
    fn numbers_show_four_significant_digits() {
        assert_eq!(number(0.012_345_6), "0.01235");
        assert_eq!(number(24.0), "24");
        assert_eq!(number(-1.5), "-1.5");
        assert_eq!(number(123_456.0), "123456");
        assert_eq!(number(0.0), "0");
        assert_eq!(number(-1.234_56e-9), "-1.235e-9");
        assert_eq!(number(2e-40), "2.000e-40");
        assert_eq!(number(f64::INFINITY), "inf");
    }
}
