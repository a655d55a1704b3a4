//! Error measures of a run, each a small function with its unit and its source.
//!
//! | Question                                                   | Module             |
//! |------------------------------------------------------------|--------------------|
//! | deviation of positions, strain of edges, contact gaps      | [`deformation`]    |
//! | distance of surfaces, difference of outlines               | [`shape`]          |
//! | energy, momentum, enclosed volume                          | [`conservation`]   |
//!
//! Units are metres, kilograms and seconds; positions come in the order of the mesh. A value that is not finite makes
//! the measure not finite, so that a diverged point never looks accurate.

pub mod conservation;
pub mod deformation;
pub mod shape;

/// Root mean square; 0 for no values.
pub fn root_mean_square(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = values.into_iter().fold((0.0, 0u64), |(sum, count), x| (sum + x * x, count + 1));
    if count == 0 { 0.0 } else { (sum / count as f64).sqrt() }
}

/// The maximum of two values; NaN if either is NaN.
pub(crate) fn max_or_nan(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// The median; the upper of the two middle values of an even count, `None` for no values.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut all: Vec<f64> = values.into_iter().collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_mean_square_is_the_root_of_the_mean_of_squares() {
        assert_eq!(root_mean_square([3.0, 4.0]), 12.5f64.sqrt());
        assert_eq!(root_mean_square([]), 0.0);
        assert!(root_mean_square([1.0, f64::NAN]).is_nan());
    }

    #[test]
    fn nan_is_larger_than_any_number() {
        assert!(max_or_nan(1.0, f64::NAN).is_nan() && max_or_nan(f64::NAN, 1.0).is_nan());
        assert_eq!(max_or_nan(1.0, 2.0), 2.0);
    }

    #[test]
    fn an_outlier_does_not_change_the_median() {
        assert_eq!(median([3.0, 1.0, 1e9]), Some(3.0));
        assert_eq!(median([]), None);
    }
}
