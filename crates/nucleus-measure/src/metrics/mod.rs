//! What can be wrong with a run, each a small function with its unit and its source.
//!
//! | You want to know...                                 | Read             |
//! |-----------------------------------------------------|------------------|
//! | how far points are from where they should be        | [`distance`]     |
//! | how far cloth is stretched                          | [`strain`]       |
//! | whether energy came from nowhere                    | [`energy`]       |
//! | whether anything came too near, or went through     | [`contact`]      |
//! | whether motion came from nowhere                    | [`momentum`]     |
//! | how much a closed surface holds                     | [`volume()`]     |
//!
//! All are in metres, kilograms and seconds, and take positions in the order of the mesh. A number that is not
//! finite makes the measure not finite: a lost point never looks like a good one.

pub mod contact;
pub mod distance;
pub mod energy;
pub mod momentum;
pub mod strain;
mod volume;

pub use volume::volume;

/// The square root of the mean of squares; nought of nothing.
pub fn root_mean_square(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = values.into_iter().fold((0.0, 0u64), |(sum, count), x| (sum + x * x, count + 1));
    if count == 0 { 0.0 } else { (sum / count as f64).sqrt() }
}

/// The larger of two, where what is not a number is larger than any number.
pub(crate) fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// The middle value; that above the middle of an even number, nothing of nothing.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut all: Vec<f64> = values.into_iter().collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_mean_square_of_three_and_four_is_that_of_their_mean_square() {
        assert_eq!(root_mean_square([3.0, 4.0]), 12.5f64.sqrt());
        assert_eq!(root_mean_square([]), 0.0);
        assert!(root_mean_square([1.0, f64::NAN]).is_nan());
    }

    #[test]
    fn what_is_not_a_number_is_worse_than_any() {
        assert!(worse(1.0, f64::NAN).is_nan() && worse(f64::NAN, 1.0).is_nan());
        assert_eq!(worse(1.0, 2.0), 2.0);
    }

    #[test]
    fn the_median_does_not_mind_one_wild_value() {
        assert_eq!(median([3.0, 1.0, 1e9]), Some(3.0));
        assert_eq!(median([]), None);
    }
}
