//! Which setting to take.

use super::found::{Point, Trade};

/// A setting that was looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Choice<'a> {
    /// It does what was asked for.
    Found(&'a Point),
    /// None does; this comes nearest.
    Nearest(&'a Point),
    /// There is no sound setting at all.
    None,
}

impl<'a> Choice<'a> {
    /// The setting, whether it does what was asked for or only comes near.
    pub fn point(&self) -> Option<&'a Point> {
        match self {
            Self::Found(point) | Self::Nearest(point) => Some(point),
            Self::None => None,
        }
    }

    fn of(found: Option<&'a Point>, nearest: Option<&'a Point>) -> Self {
        found.map(Self::Found).or(nearest.map(Self::Nearest)).unwrap_or(Self::None)
    }
}

/// The cheapest setting whose error is not above this, or else the most exact.
pub fn for_error(trade: &Trade, error: f64) -> Choice<'_> {
    Choice::of(trade.cheapest(error), trade.frontier().last())
}

/// The most exact setting that takes no more milliseconds a frame, or else the cheapest.
pub fn for_time(trade: &Trade, ms: f64) -> Choice<'_> {
    Choice::of(trade.frontier().take_while(|point| point.ms <= ms).last(), trade.frontier().next())
}

#[cfg(test)]
mod tests {
    use super::super::found::tests::{point, trade};
    use super::*;

    #[test]
    fn an_error_gets_the_cheapest_that_reaches_it_and_a_time_the_most_exact_within_it() {
        let trade = trade(vec![point(1.0, 0.1), point(2.0, 0.05), point(4.0, 0.01), point(8.0, 0.002)]);
        let ms = |choice: Choice| match choice {
            Choice::Found(point) => Ok(point.ms),
            Choice::Nearest(point) => Err(point.ms),
            Choice::None => Err(0.0),
        };
        assert_eq!(ms(for_error(&trade, 0.05)), Ok(2.0));
        assert_eq!(ms(for_error(&trade, 0.001)), Err(8.0));
        assert_eq!(ms(for_time(&trade, 5.0)), Ok(4.0));
        assert_eq!(ms(for_time(&trade, 0.5)), Err(1.0));
    }

    #[test]
    fn where_nothing_is_sound_nothing_is_recommended() {
        let trade = trade(vec![Point { crossed: 3, ..point(1.0, 0.1) }]);
        assert_eq!(for_error(&trade, 1.0), Choice::None);
        assert_eq!(for_time(&trade, 9.0).point(), None);
    }
}
