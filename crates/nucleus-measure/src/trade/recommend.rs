//! Which setting to take.

use super::found::{Point, Trade};

/// A setting that was looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Choice<'a> {
    /// It does what was asked for.
    Found(&'a Point),
    /// None does; this comes nearest.
    Nearest(&'a Point),
    /// The references differ by too much to tell whether one does; this is the most exact as far as can be told.
    Untold(&'a Point),
    /// There is no sound setting at all.
    None,
}

impl<'a> Choice<'a> {
    /// The setting, whether it does what was asked for or only comes near.
    pub fn point(&self) -> Option<&'a Point> {
        match self {
            Self::Found(point) | Self::Nearest(point) | Self::Untold(point) => Some(point),
            Self::None => None,
        }
    }

    fn of(found: Option<&'a Point>, nearest: Option<&'a Point>) -> Self {
        found.map(Self::Found).or(nearest.map(Self::Nearest)).unwrap_or(Self::None)
    }
}

/// The cheapest setting whose error is not above this, or else the most exact. What cannot be told is not promised.
pub fn for_error(trade: &Trade, error: f64) -> Choice<'_> {
    match (trade.can_tell(error), trade.frontier().last()) {
        (false, Some(best)) => Choice::Untold(best),
        (_, best) => Choice::of(trade.cheapest(error), best),
    }
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
            Choice::Nearest(point) | Choice::Untold(point) => Err(point.ms),
            Choice::None => Err(0.0),
        };
        assert_eq!(ms(for_error(&trade, 0.05)), Ok(2.0));
        assert_eq!(ms(for_error(&trade, 0.001)), Err(8.0));
        assert_eq!(ms(for_time(&trade, 5.0)), Ok(4.0));
        assert_eq!(ms(for_time(&trade, 0.5)), Err(1.0));
    }

    #[test]
    fn an_error_that_the_references_cannot_tell_is_not_promised() {
        let trade = Trade { floor: Some(0.004), ..trade(vec![point(1.0, 0.1), point(2.0, 0.001)]) };
        assert!(matches!(for_error(&trade, 0.007), Choice::Untold(point) if point.ms == 2.0));
        assert!(matches!(for_error(&trade, 0.009), Choice::Found(point) if point.ms == 2.0));
    }

    #[test]
    fn where_nothing_is_sound_nothing_is_recommended() {
        let trade = trade(vec![Point { pairs_unresolved: 3, ..point(1.0, 0.1) }]);
        assert_eq!(for_error(&trade, 1.0), Choice::None);
        assert_eq!(for_time(&trade, 9.0).point(), None);
    }
}
