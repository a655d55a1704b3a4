//! The error of a run: one figure for each quantity that an artist looks at, each against the reference and with the
//! noise of the reference itself.
//!
//! A single figure misleads: cloth can be in the right position and still be visibly stretched. The noise floor of a
//! quantity is its difference between two references of steps h and h/2. Which errors meet a wanted one, `request.rs`
//! says.

use serde::{Deserialize, Serialize};

use super::benchmark::Benchmark;
use super::reference::{Horizon, ReferenceRun};
use super::run::{Run, Trajectory};
use crate::metrics::root_mean_square;
use crate::metrics::shape::Outline;

/// Something that can be wrong in a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Distance of the points from the reference, RMS over points and comparable frames, over the cloth's size.
    Position,
    /// Difference from the reference in the strain that 99 % of the edges stay below, RMS over all frames.
    Stretch,
    /// Difference from the reference in the largest strain, RMS over all frames.
    WorstStretch,
    /// Distance of the surfaces in the last frame, RMS, over the cloth's size.
    Shape,
    /// Difference of the outlines in the last frame, over their area.
    Silhouette,
    /// Difference of kinetic plus potential energy, RMS over all frames, over that of a fall by the cloth's own size.
    Energy,
    /// Without a reference: the strain that 99 % of the edges stay below, RMS over all frames.
    Strain,
}

impl Quantity {
    /// All that are measured against a reference.
    pub const AGAINST_REFERENCE: [Self; 6] =
        [Self::Position, Self::Stretch, Self::WorstStretch, Self::Shape, Self::Silhouette, Self::Energy];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Stretch => "stretch",
            Self::WorstStretch => "worst stretch",
            Self::Shape => "shape",
            Self::Silhouette => "silhouette",
            Self::Energy => "energy",
            Self::Strain => "strain",
        }
    }

    /// Whether it is a strain of edges.
    fn is_strain(self) -> bool {
        matches!(self, Self::Stretch | Self::WorstStretch | Self::Strain)
    }

    /// Whether every recommendation rests on it.
    fn is_essential(self) -> bool {
        matches!(self, Self::Position | Self::Stretch | Self::Strain)
    }
}

/// One quantity of a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Component {
    /// Which.
    pub quantity: Quantity,
    /// Its error, as a share.
    pub error: f64,
    /// Difference of the two references in it.
    pub floor: f64,
}

impl Component {
    /// The largest error that it may be against another reference.
    pub fn largest(&self) -> f64 {
        self.error + self.floor
    }
}

/// How the runs of a scene are measured: the quantities with their noise floors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorMeasure {
    /// Number of frames over which positions can be compared; 0 if the references diverge too early.
    pub comparable: usize,
    /// Each measured quantity with the difference of the two references in it.
    pub floors: Vec<(Quantity, f64)>,
}

impl ErrorMeasure {
    /// The measure of a scene without a reference: Classic is a different material at every setting, and meant not to
    /// stretch.
    pub fn without_reference() -> Self {
        Self { comparable: 0, floors: vec![(Quantity::Strain, 0.0)] }
    }

    /// The measure of a scene with these references.
    pub fn new(benchmark: &Benchmark, coarse: &ReferenceRun, fine: &ReferenceRun, horizon: &Horizon) -> Self {
        let comparable = if horizon.is_usable() { horizon.frames } else { 0 };
        let outline = outline(benchmark, &coarse.trajectory, &fine.trajectory);
        let coarse = Run { outline, ..with_divergence(&coarse.run, &horizon.divergence) };
        let found = |quantity| {
            raw(quantity, comparable, benchmark.fall_energy(), &coarse, &fine.run)
                .map(|floor| (quantity, floor))
        };
        let can_be = |quantity: &Quantity| benchmark.has_edges() || !quantity.is_strain();
        let quantities = Quantity::AGAINST_REFERENCE.into_iter().filter(can_be);
        Self { comparable, floors: quantities.filter_map(found).collect() }
    }

    /// The error of a run in each quantity. Empty if the run was not finite.
    pub fn of(&self, benchmark: &Benchmark, run: &Run, reference: Option<&Run>) -> Vec<Component> {
        if !run.is_finite() {
            return Vec::new();
        }
        let error = |quantity| match reference {
            Some(reference) => raw(quantity, self.comparable, benchmark.fall_energy(), run, reference),
            None => Some(root_mean_square(run.frames.iter().map(|frame| frame.strain))),
        };
        let component = |&(quantity, floor): &(Quantity, f64)| {
            error(quantity).filter(|x| x.is_finite()).map(|error| Component { quantity, error, floor })
        };
        self.floors.iter().filter_map(component).collect()
    }

    /// Difference of the two references in a quantity.
    pub fn floor(&self, quantity: Quantity) -> Option<f64> {
        self.floors.iter().find(|(of, _)| *of == quantity).map(|(_, floor)| *floor)
    }

    /// The largest difference of the two references in position and stretch; `None` if neither is measured.
    pub fn essential_floor(&self) -> Option<f64> {
        let essential = self.floors.iter().filter(|(quantity, _)| quantity.is_essential());
        essential.map(|(_, floor)| *floor).reduce(f64::max)
    }

    /// Whether every recommendation rests on a quantity: position and stretch, and the shape where positions can be
    /// compared in no frame.
    pub fn is_essential(&self, quantity: Quantity) -> bool {
        quantity.is_essential() || self.comparable == 0 && quantity == Quantity::Shape
    }

    /// Whether a quantity says where the points are, or how far the cloth gives in to its load.
    pub(super) fn shows_motion(&self) -> bool {
        let shows = |quantity| matches!(quantity, Quantity::Position | Quantity::Shape | Quantity::Strain);
        self.floors.iter().any(|(quantity, _)| shows(*quantity))
    }

    /// The quantities and the frames over which each is compared: `position over frames 2 to 13, stretch over 2 to 24`.
    pub fn windows(&self, [start, end]: [i64; 2]) -> String {
        if self.floor(Quantity::Strain).is_some() {
            return format!("strain over frames {} to {end}", start + 1);
        }
        let first = start + 1;
        let last = start + self.comparable as i64;
        let position = match self.comparable {
            0 => "position in no frame (the references diverge too early)".to_owned(),
            _ if last >= end => format!("position over frames {first} to {end}"),
            _ => format!("position over frames {first} to {last} (the references diverge after)"),
        };
        let measured = |quantities: &[Quantity]| {
            let all = quantities.iter().filter(|quantity| self.floor(**quantity).is_some());
            all.map(|quantity| quantity.name()).collect::<Vec<_>>().join(" and ")
        };
        let always = measured(&[Quantity::Stretch, Quantity::Energy]);
        let last = measured(&[Quantity::Shape, Quantity::Silhouette]);
        let always = Some(always).filter(|all| !all.is_empty());
        let last = Some(last).filter(|all| !all.is_empty());
        let windows = [
            Some(position),
            always.map(|all| format!("{all} over frames {first} to {end}")),
            last.map(|all| format!("{all} in frame {end}")),
        ];
        windows.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}

/// How the last frames of two runs differ in shape; `None` if either has not all frames, or there are no faces.
fn outline(benchmark: &Benchmark, a: &Trajectory, b: &Trajectory) -> Option<Outline> {
    let last = benchmark.frames().checked_sub(1)?;
    if a.frames() <= last || b.frames() <= last {
        return None;
    }
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    a.frame(last, &mut ours);
    b.frame(last, &mut theirs);
    benchmark.outline_of(&ours, &theirs)
}

/// A run whose frames have a known distance from the other reference.
fn with_divergence(run: &Run, divergence: &[f64]) -> Run {
    let mut run = run.clone();
    for (frame, divergence) in run.frames.iter_mut().zip(divergence) {
        frame.divergence = Some([*divergence, *divergence]);
    }
    run
}

/// The error of a run in a quantity; `None` where it is not measured.
fn raw(quantity: Quantity, comparable: usize, fall: f64, run: &Run, reference: &Run) -> Option<f64> {
    let pairs = || run.frames.iter().zip(&reference.frames);
    let outline = |of: fn(&Outline) -> f64| run.outline.as_ref().map(of);
    match quantity {
        Quantity::Position => {
            let frames = run.frames.iter().take(comparable);
            let rms = frames.map(|frame| frame.divergence.map_or(f64::NAN, |[rms, _]| rms));
            (comparable > 0).then(|| root_mean_square(rms))
        }
        Quantity::Stretch => Some(root_mean_square(pairs().map(|(a, b)| a.strain - b.strain))),
        Quantity::WorstStretch => Some(root_mean_square(pairs().map(|(a, b)| a.max_strain - b.max_strain))),
        Quantity::Shape => outline(|outline| outline.distance),
        Quantity::Silhouette => outline(|outline| outline.silhouette),
        Quantity::Energy => {
            (fall > 0.0).then(|| root_mean_square(pairs().map(|(a, b)| (a.energy - b.energy) / fall)))
        }
        Quantity::Strain => None,
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A component with a small floor.
    pub fn component(quantity: Quantity, error: f64) -> Component {
        Component { quantity, error, floor: 1e-4 }
    }

    #[test]
    fn the_windows_name_the_frames_of_each_quantity() {
        let measure = |comparable| ErrorMeasure { comparable, floors: vec![(Quantity::Position, 0.0)] };
        assert!(
            measure(12)
                .windows([1, 24])
                .starts_with("position over frames 2 to 13 (the references diverge after)")
        );
        assert!(measure(23).windows([1, 24]).starts_with("position over frames 2 to 24"));
        assert!(measure(0).windows([1, 24]).starts_with("position in no frame"));
        let beads = ErrorMeasure { comparable: 0, floors: vec![(Quantity::Energy, 0.1)] };
        assert!(
            beads
                .windows([1, 24])
                .ends_with("(the references diverge too early), energy over frames 2 to 24")
        );
        assert_eq!(ErrorMeasure::without_reference().windows([1, 24]), "strain over frames 2 to 24");
    }
}
