//! What error means for a scene.

use serde::{Deserialize, Serialize};

use super::run::Run;
use crate::metrics::root_mean_square;
use crate::reference::Horizon;

/// What the error of a run is. One for all runs of a scene, so that they can be compared.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "of")]
pub enum Measure {
    /// How far points are from the reference's, RMS over points and frames, over the cloth's size.
    Position {
        /// Over so many frames, to the horizon.
        frames: usize,
    },
    /// How far the strain that 99 % of the edges stay below is from the reference's, RMS over frames. For scenes whose
    /// references part early: where a fold falls is chance there, how far cloth is stretched is not.
    StrainAgainstReference,
    /// The strain that 99 % of the edges stay below, RMS over frames, as such: Classic cloth is meant not to stretch.
    Strain,
}

impl Measure {
    /// The measure for a scene whose references go together so far; nothing if it has none.
    pub fn choose(horizon: Option<&Horizon>) -> Self {
        match horizon {
            None => Self::Strain,
            Some(horizon) if horizon.is_far() => Self::Position { frames: horizon.frames },
            Some(_) => Self::StrainAgainstReference,
        }
    }

    /// The error of a run. Endless if it was not finite in all frames.
    pub fn error(&self, run: &Run, reference: Option<&Run>) -> f64 {
        if !run.is_finite() {
            return f64::INFINITY;
        }
        let strain_of =
            |frame: usize| reference.and_then(|run| run.frames.get(frame)).map_or(0.0, |f| f.strain);
        let frames = run.frames.iter();
        match self {
            Self::Position { frames: count } => root_mean_square(
                frames.take(*count).map(|frame| frame.apart.map_or(f64::NAN, |[rms, _]| rms)),
            ),
            Self::StrainAgainstReference => {
                root_mean_square(frames.enumerate().map(|(k, frame)| frame.strain - strain_of(k)))
            }
            Self::Strain => root_mean_square(frames.map(|frame| frame.strain)),
        }
    }

    /// What it is called on an axis.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Position { .. } => "error of position",
            Self::StrainAgainstReference => "error of strain",
            Self::Strain => "strain",
        }
    }

    /// What it is, in a sentence.
    pub fn sentence(&self) -> String {
        match self {
            Self::Position { frames } => format!(
                "The error is the distance of points from the reference's, RMS over all points and the first {frames} \
                 frames, in percent of the cloth's size."
            ),
            Self::StrainAgainstReference => "The two references part too early for positions to be compared. The \
                 error is the difference from the reference in strain (the strain that 99 % of the edges stay below), \
                 RMS over all frames, in percentage points."
                .to_owned(),
            Self::Strain => "Read as Classic, cloth becomes another with every setting, so that there is no reference. \
                 The error is the strain that 99 % of the edges stay below, RMS over all frames: cloth is meant not to \
                 stretch."
                .to_owned(),
        }
    }
}
