//! Numbers in reports.

/// A number with three significant digits, without trailing zeros: `0.0125`, `24`, `1.5`.
pub fn figure(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let digits = (2 - x.abs().log10().floor() as i32).clamp(0, 9) as usize;
    let text = format!("{x:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A ratio in percent: `1.25 %`.
pub fn percent(share: f64) -> String {
    format!("{} %", figure(100.0 * share))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_significant_digits() {
        assert_eq!([0.012_345, 24.0, 123.456, 9.996, 0.0].map(figure), ["0.0123", "24", "123", "10", "0"]);
        assert_eq!(percent(0.0125), "1.25 %");
    }
}
