//! Checks of a run: `checks: [noPenetration, maxStretch(0.02)]`.
//!
//! A check is a figure of each frame and a bound on it. A new kind of check is a new row of `FORMS`. A check whose first
//! parameter is `frame` applies from that frame on; the last other parameter is its limit.

use std::fmt;

use nucleus_core::StepReport;

/// A check of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    form: &'static Form,
    arguments: Vec<f64>,
}

/// A kind of check.
#[derive(Debug)]
pub struct Form {
    /// Its name in scenes.
    pub name: &'static str,
    /// Description in one line.
    pub doc: &'static str,
    /// Names of its arguments.
    pub parameters: &'static [&'static str],
    /// Their type.
    pub values: Values,
    bound: Bound,
    /// The figure of a frame; `None` if the run has none.
    figure: fn(&Sample) -> Option<f64>,
}

/// The type of the arguments of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Values {
    /// Any number.
    Numbers,
    /// Whole numbers, at least 0.
    Counts,
    /// Gap ratios, at most [`MAX_MEASURED_GAP`].
    Gaps,
}

/// The direction of a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bound {
    /// The figure must not be larger.
    AtMost,
    /// The figure must not be smaller.
    AtLeast,
}

/// The result of a check.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The check.
    pub check: Check,
    /// Whether it held in every frame that it applies to, and it applied to at least one.
    pub passed: bool,
    /// The worst figure and its first frame; `None` if it applied to no frame.
    pub worst: Option<(f64, i64)>,
}

/// The result of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameReport {
    /// The frame. If the observer stopped the run, it is the frame that was not completed.
    pub frame: i64,
    /// The report of the solver, combined over all nuclei.
    pub report: StepReport,
    /// Count of penetrations that the audit found in the frame; `None` without an audit.
    pub passed_through: Option<u64>,
}

/// Evaluates checks frame by frame.
#[derive(Debug, Clone)]
pub struct Judge {
    outcomes: Vec<Outcome>,
    mass: f64,
}

/// The input of a check at one frame.
struct Sample<'a> {
    report: &'a StepReport,
    /// Count of penetrations; `None` without an audit.
    passed_through: Option<u64>,
    /// Total mass of all cloths in kilograms.
    mass: f64,
}

/// The first parameter of a check that applies from a frame on.
const FRAME: &str = "frame";

/// The check that requires an audit.
const NO_SELF_INTERSECTION: &str = "noSelfIntersection";

/// Largest gap ratio that is measured: a collider farther away than the thickness may be no contact candidate.
pub const MAX_MEASURED_GAP: f64 = 1.0;

/// A gap ratio of the solver as far as it is measured: 1 is a gap of at least the thickness.
pub fn measured_gap(min_gap: f64) -> f64 {
    // `f64::min` would turn NaN into 1.
    if min_gap > MAX_MEASURED_GAP { MAX_MEASURED_GAP } else { min_gap }
}

/// The check of unresolved pairs. A run without it fails at the first.
pub const MAX_UNRESOLVED: &str = "maxUnresolved";
/// The check of points inside colliders. A run without it fails if it ends with any.
pub const MAX_DEPENETRATING: &str = "maxDepenetrating";
/// The check of cloth edges that intersect cloth faces. A run without it fails if it ends with any.
pub const MAX_INTERSECTIONS: &str = "maxIntersections";
/// The check of the volume of liquids. A run without it warns of large compression.
pub const VOLUME_ERROR: &str = "volumeError";
/// The check of strain. A run without it warns of large strain.
pub const MAX_STRETCH: &str = "maxStretch";

/// Former names of checks, each with the name of today. A scene may use either; a former name is a warning.
pub const RENAMED: &[(&str, &str)] = &[
    ("maxTrapped", MAX_DEPENETRATING),
    ("maxTangled", MAX_INTERSECTIONS),
    ("noCrossing", NO_SELF_INTERSECTION),
    ("restsBy", "atRestBy"),
    ("separatedBy", "noIntersectionsAfter"),
    ("untangledBy", "noIntersectionsAfter"),
];

static FORMS: [Form; 18] = [
    at_most(
        "noPenetration",
        &[],
        |sample| Some(sample.report.pairs_unresolved as f64),
        "No pair of elements of cloth, or of cloth and a collider, that the solver tests is unresolved at the end of a time step. Edges of a cloth are tested with each other by `selfCollisionFlag: fullSurface`, the default in Physical alone; `noSelfIntersection` counts the others.",
    ),
    at_most(
        MAX_UNRESOLVED,
        &["pairs"],
        |sample| Some(sample.report.pairs_unresolved as f64),
        "No frame leaves more pairs of elements unresolved than this. Without this check a run fails with the first.",
    ).taking(Values::Counts),
    at_most(
        MAX_DEPENETRATING,
        &["points"],
        |sample| Some(sample.report.depenetrating as f64),
        "No frame has more points inside closed colliders than this. Without this check a run fails if it ends with any.",
    ).taking(Values::Counts),
    at_most(
        MAX_INTERSECTIONS,
        &["edges"],
        |sample| Some(sample.report.intersections as f64),
        "No frame has more edges of cloth through faces of cloth than this. Without this check a run fails if it ends with any.",
    ).taking(Values::Counts),
    at_most(
        NO_SELF_INTERSECTION,
        &[],
        |sample| sample.passed_through.map(|count| count as f64),
        "No frame ends with an intersection that the start state does not have: of cloth with itself, with other cloth, or with a collider. With `--audit`, nothing passes through between frames either.",
    ),
    at_most(
        MAX_STRETCH,
        &["strain"],
        |sample| Some(sample.report.max_strain),
        "No link is longer than at rest by more than this share.",
    ),
    at_most(
        "maxStretch99",
        &["strain"],
        |sample| Some(sample.report.strain_99),
        "99 % of the links are not longer than at rest by more than this share.",
    ),
    at_most(
        "settledStretch99",
        &["frame", "strain"],
        |sample| Some(sample.report.strain_99),
        "From this frame on 99 % of the links are not longer than at rest by more than this share.",
    ),
    at_least(
        "minGap",
        &["gap"],
        |sample| Some(measured_gap(sample.report.min_gap)),
        "The gap between cloth and colliders is at least this share of the thickness, at most 1: larger gaps are not measured.",
    ).taking(Values::Gaps),
    at_most(
        "finite",
        &[],
        |sample| Some(if sample.report.finite { 0.0 } else { 1.0 }),
        "Every position and velocity is a finite number.",
    ),
    at_most(
        "maxWeldGap",
        &["distance"],
        |sample| Some(sample.report.max_weld_gap),
        "Welded elements are farther apart than at rest by at most this many metres.",
    ),
    at_most(
        "maxBroken",
        &["links"],
        |sample| Some(sample.report.broken_links as f64),
        "At most this many links of constraints break.",
    ).taking(Values::Counts),
    at_least(
        "tornBy",
        &["frame", "links"],
        |sample| Some(sample.report.broken_links as f64),
        "From this frame on at least this many links of constraints are broken.",
    ).taking(Values::Counts),
    at_least(
        "minParticles",
        &["frame", "particles"],
        |sample| Some(sample.report.particles as f64),
        "From this frame on there are at least this many particles in objects with births and deaths.",
    ).taking(Values::Counts),
    at_most(
        "maxParticles",
        &["particles"],
        |sample| Some(sample.report.particles as f64),
        "No frame has more particles than this in objects with births and deaths.",
    ).taking(Values::Counts),
    at_most(
        VOLUME_ERROR,
        &["frame", "share"],
        |sample| Some(sample.report.density_error),
        "From this frame on the mean excess density of liquids is at most this share of their rest density.",
    ),
    at_most(
        "noIntersectionsAfter",
        &["frame"],
        |sample| Some(sample.report.intersections as f64),
        "From this frame on no edge of cloth goes through a face of cloth.",
    ),
    at_most(
        "atRestBy",
        &["frame", "speed"],
        |sample| Some(sample.speed()),
        "From this frame on the root mean square speed is at most this, in m/s.",
    ),
];

/// A check that a figure is not above its last argument, or 0 without one.
const fn at_most(
    name: &'static str,
    parameters: &'static [&'static str],
    figure: fn(&Sample) -> Option<f64>,
    doc: &'static str,
) -> Form {
    Form { name, doc, parameters, values: Values::Numbers, bound: Bound::AtMost, figure }
}

/// A check that a figure is not below its last argument.
const fn at_least(
    name: &'static str,
    parameters: &'static [&'static str],
    figure: fn(&Sample) -> Option<f64>,
    doc: &'static str,
) -> Form {
    Form { bound: Bound::AtLeast, ..at_most(name, parameters, figure, doc) }
}

impl Sample<'_> {
    /// Root mean square speed in m/s.
    fn speed(&self) -> f64 {
        if self.mass > 0.0 { (2.0 * self.report.kinetic_energy / self.mass).sqrt() } else { 0.0 }
    }
}

/// Compares by identity: there is one static per kind.
impl PartialEq for Form {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

impl Check {
    /// A check by its name; `None` if the name is unknown or takes another number of arguments.
    pub fn new(name: &str, arguments: &[f64]) -> Option<Self> {
        let form = Form::all().iter().find(|form| form.name == name)?;
        (form.parameters.len() == arguments.len()).then(|| Self { form, arguments: arguments.to_vec() })
    }

    /// Its kind.
    pub fn form(&self) -> &'static Form {
        self.form
    }

    /// The frame from which on it applies, if it has one.
    pub(crate) fn first_frame(&self) -> Option<f64> {
        self.form.parameters.first().filter(|name| **name == FRAME).and(self.arguments.first().copied())
    }

    /// Whether its limit is below zero, which no figure is.
    pub(crate) fn is_below_zero(&self) -> bool {
        matches!(self.limit(), (Bound::AtMost, limit) if limit < 0.0)
    }

    /// Its arguments, in the order of [`Form::parameters`].
    pub fn arguments(&self) -> &[f64] {
        &self.arguments
    }

    /// Whether it requires an audit.
    pub fn needs_audit(&self) -> bool {
        self.form.name == NO_SELF_INTERSECTION
    }

    /// Its bound and limit.
    pub fn limit(&self) -> (Bound, f64) {
        let last = self.form.parameters.last().filter(|name| **name != FRAME).and(self.arguments.last());
        (self.form.bound, last.copied().unwrap_or(0.0))
    }

    /// Whether it applies to a frame.
    fn applies_to(&self, frame: i64) -> bool {
        self.first_frame().is_none_or(|from| frame as f64 >= from)
    }

    /// Whether a figure is within the limit. NaN never is.
    pub fn accepts(&self, figure: f64) -> bool {
        match self.limit() {
            (Bound::AtMost, limit) => figure <= limit,
            (Bound::AtLeast, limit) => figure >= limit,
        }
    }

    /// Whether one figure is worse than another. NaN is worst.
    fn is_worse(&self, figure: f64, than: f64) -> bool {
        let is_beyond = match self.form.bound {
            Bound::AtMost => figure > than,
            Bound::AtLeast => figure < than,
        };
        is_beyond || (figure.is_nan() && !than.is_nan())
    }
}

/// The syntax of a scene: `noPenetration`, `maxStretch(0.02)`, `atRestBy(frame: 100, speed: 0.01)`.
impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Form { name, parameters, .. } = self.form;
        match self.arguments.as_slice() {
            [] => write!(f, "{name}"),
            [argument] => write!(f, "{name}({argument})"),
            arguments => {
                let named = |(name, value): (&&str, &f64)| format!("{name}: {value}");
                let named: Vec<String> = parameters.iter().zip(arguments).map(named).collect();
                write!(f, "{name}({})", named.join(", "))
            }
        }
    }
}

impl Form {
    /// As a scene writes it, with names for the arguments: `atRestBy(frame: ..., speed: ...)`.
    pub fn usage(&self) -> String {
        match self.parameters {
            [] => self.name.to_owned(),
            [only] => format!("{}({only})", self.name),
            all => {
                let named: Vec<String> = all.iter().map(|name| format!("{name}: ...")).collect();
                format!("{}({})", self.name, named.join(", "))
            }
        }
    }

    /// The same for arguments of another type.
    const fn taking(self, values: Values) -> Self {
        Self { values, ..self }
    }

    /// All kinds of checks.
    pub fn all() -> &'static [Form] {
        &FORMS
    }
}

impl Judge {
    /// Checks that apply to no frame yet. `mass` is the total mass of all cloths in kilograms.
    pub fn new(checks: &[Check], mass: f64) -> Self {
        let open = |check: &Check| Outcome { check: check.clone(), passed: false, worst: None };
        Self { outcomes: checks.iter().map(open).collect(), mass }
    }

    /// Evaluates the checks at the next frame.
    pub fn see(&mut self, frame: &FrameReport) {
        let FrameReport { frame, ref report, passed_through } = *frame;
        let sample = Sample { report, passed_through, mass: self.mass };
        for outcome in &mut self.outcomes {
            let check = &outcome.check;
            let Some(figure) = (check.form.figure)(&sample).filter(|_| check.applies_to(frame)) else {
                continue;
            };
            if outcome.worst.is_none_or(|(worst, _)| check.is_worse(figure, worst)) {
                outcome.worst = Some((figure, frame));
                outcome.passed = check.accepts(figure);
            }
        }
    }

    /// The results so far, in the order of the scene.
    pub fn outcomes(&self) -> &[Outcome] {
        &self.outcomes
    }
}

#[cfg(test)]
mod tests;
