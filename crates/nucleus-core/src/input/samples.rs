//! Ramps as evenly spaced samples.

/// The number of samples of a falloff.
pub const FALLOFF_SAMPLES: usize = 17;

/// The value at a share of the way from the first sample to the last, between samples in straight lines. Before the first and
/// behind the last it is constant.
pub fn sample_at(samples: &[f64], share: f64) -> f64 {
    let last = samples.len() - 1;
    let along = share.clamp(0.0, 1.0) * last as f64;
    let low = (along as usize).min(last.saturating_sub(1));
    let [a, b] = [samples[low], samples[(low + 1).min(last)]];
    a + (b - a) * (along - low as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_met_and_joined_by_straight_lines() {
        let samples = [1.0, 3.0, 2.0];
        let at = [-1.0, 0.0, 0.25, 0.5, 0.75, 1.0, 2.0].map(|share| sample_at(&samples, share));
        assert_eq!(at, [1.0, 1.0, 2.0, 3.0, 2.5, 2.0, 2.0]);
        assert_eq!(sample_at(&[4.0], 0.7), 4.0);
    }
}
