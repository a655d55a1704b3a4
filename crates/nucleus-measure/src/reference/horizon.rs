//! Until when positions can be compared.

/// Two references may differ so much, RMS over the frames and the points and over the cloth's size: by half the error
/// of 1 % that is looked for most often, so that this can still be told.
pub const APART: f64 = 0.005;

/// Positions say something if they can be compared in this share of the frames.
const ENOUGH: f64 = 0.25;

/// How far the two references go together.
#[derive(Debug, Clone, PartialEq)]
pub struct Horizon {
    /// The difference in each frame, RMS over the points and over the cloth's size.
    pub apart: Vec<f64>,
    /// So many frames can be compared.
    pub frames: usize,
    /// The difference over these frames, RMS: an error below it cannot be told from nought.
    pub floor: f64,
}

impl Horizon {
    /// From the difference in each frame: the longest time over which it stays small.
    ///
    /// A hard impact can drive the two apart for some frames; if they come together again, that was no chaos.
    pub fn of(apart: Vec<f64>) -> Self {
        let mut squares = 0.0;
        let (mut frames, mut floor) = (0, 0.0);
        for (frame, apart) in apart.iter().enumerate() {
            squares += apart * apart;
            let so_far = (squares / (frame + 1) as f64).sqrt();
            if so_far <= APART {
                (frames, floor) = (frame + 1, so_far);
            }
        }
        Self { apart, frames, floor }
    }

    /// Whether enough frames can be compared for positions to say something.
    pub fn is_far(&self) -> bool {
        self.frames > 0 && self.frames as f64 >= ENOUGH * self.apart.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_that_stay_together_can_be_compared_to_the_end() {
        let horizon = Horizon::of(vec![1e-4; 48]);
        assert_eq!((horizon.frames, horizon.is_far()), (48, true));
        assert!((horizon.floor - 1e-4).abs() < 1e-12);
    }

    #[test]
    fn what_doubles_in_every_frame_is_given_up_before_it_is_wrong() {
        let horizon = Horizon::of((0..48).map(|frame| 1e-7 * f64::from(frame).exp2()).collect());
        assert!((10..20).contains(&horizon.frames), "{horizon:?}");
        assert!(horizon.floor <= APART && horizon.is_far());
    }

    #[test]
    fn an_impact_after_which_they_come_together_again_does_not_end_the_comparison() {
        let horizon = Horizon::of((0..48).map(|frame| if frame == 8 { 0.02 } else { 1e-3 }).collect());
        assert_eq!(horizon.frames, 48);
        assert!(horizon.floor < APART, "{horizon:?}");
    }

    #[test]
    fn references_that_differ_at_once_cannot_be_compared() {
        let horizon = Horizon::of(vec![0.1; 48]);
        assert_eq!((horizon.frames, horizon.is_far()), (0, false));
        assert!(!Horizon::of(vec![f64::NAN; 4]).is_far());
        assert!(!Horizon::of(Vec::new()).is_far());
    }
}
