//! The order of the fallbacks of the [`safeguard`](super::safeguard), and how often each is tried: for cloth, for free
//! points with lists of contacts, and for runs of free points alike.

/// What is done to contacts without certificate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fallback {
    /// Contacts push again.
    Push,
    /// Motion is truncated at a division plane, or reverted in the moving frame of the surface.
    Truncate,
    /// Points freeze at the start of the step, or move with what carries them.
    Freeze,
}

/// One attempt to reach a certificate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attempt {
    /// What it does.
    pub fallback: Fallback,
    /// How often that was tried before in this time step.
    pub number: usize,
    /// Factor on the thickness by which contacts push.
    pub thickness_scale: f64,
}

impl Attempt {
    /// Whether nothing of its kind was tried before in this time step.
    pub fn is_first(&self) -> bool {
        self.number == 0
    }
}

/// Pushes by the whole thickness.
const FULL_PUSHES: usize = 4;
/// Pushes by a share of it that halves each time: two bodies may leave too little space for all of it.
const SCALED_PUSHES: usize = 6;
/// Attempts to truncate motion.
pub const TRUNCATIONS: usize = 8;
/// Attempts to freeze points.
const FREEZES: usize = 32;

const SEQUENCE: [(Fallback, usize); 3] = [
    (Fallback::Push, FULL_PUSHES + SCALED_PUSHES),
    (Fallback::Truncate, TRUNCATIONS),
    (Fallback::Freeze, FREEZES),
];

/// The attempts for contacts of cloth.
pub fn attempts_for_cloth() -> impl Iterator<Item = Attempt> {
    attempts(&SEQUENCE)
}

/// The attempts for a free point. Nothing carries it, so that it does not freeze.
pub fn attempts_for_free_points() -> impl Iterator<Item = Attempt> {
    attempts(&SEQUENCE[..2])
}

fn attempts(sequence: &[(Fallback, usize)]) -> impl Iterator<Item = Attempt> + '_ {
    let each =
        sequence.iter().flat_map(|&(fallback, count)| (0..count).map(move |number| (fallback, number)));
    each.enumerate().map(|(at, (fallback, number))| {
        let halvings = (at + 1).saturating_sub(FULL_PUSHES).min(SCALED_PUSHES);
        Attempt { fallback, number, thickness_scale: 0.5f64.powi(halvings as i32) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contacts_push_then_truncate_then_freeze() {
        let of = |fallback| attempts_for_cloth().filter(move |attempt| attempt.fallback == fallback);
        let pushes = [1.0, 1.0, 1.0, 1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125, 0.015625];
        assert!(of(Fallback::Push).map(|attempt| attempt.thickness_scale).eq(pushes));
        assert_eq!([of(Fallback::Truncate).count(), of(Fallback::Freeze).count()], [8, 32]);
        assert!(attempts_for_free_points().eq(attempts_for_cloth().take(18)));
    }
}
