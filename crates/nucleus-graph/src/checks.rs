//! Checks of a run: `checks: [noPenetration, maxStretch(0.02)]`.
//!
//! A check is a figure of each frame and a bound on it. A new kind of check is a new row of `FORMS`.

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
    limit: fn(&[f64]) -> f64,
    figure: fn(&Sample, &[f64]) -> Option<f64>,
}

/// The type of the arguments of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Values {
    /// Any number.
    Numbers,
    /// Whole numbers, at least 0.
    Counts,
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
    frame: i64,
    report: &'a StepReport,
    /// Count of penetrations; `None` without an audit.
    passed_through: Option<u64>,
    /// Total mass of all cloths in kilograms.
    mass: f64,
}

/// The check that requires an audit.
const NO_CROSSING: &str = "noCrossing";

/// The check of unresolved pairs. A run without it fails at the first.
pub const MAX_UNRESOLVED: &str = "maxUnresolved";
/// The check of points inside colliders. A run without it fails if it ends with any.
pub const MAX_DEPENETRATING: &str = "maxDepenetrating";
/// The check of cloth edges that intersect cloth faces. A run without it fails if it ends with any.
pub const MAX_INTERSECTIONS: &str = "maxIntersections";
/// The check of strain. A run without it warns of large strain.
pub const MAX_STRETCH: &str = "maxStretch";

/// Former names of checks, each with the name of today. A scene may use either; a former name is a warning.
pub const RENAMED: &[(&str, &str)] =
    &[("maxTrapped", MAX_DEPENETRATING), ("maxTangled", MAX_INTERSECTIONS), ("untangledBy", "separatedBy")];

static FORMS: [Form; 18] = [
    Form {
        name: "noPenetration",
        doc: "No pair of elements of cloth, or of cloth and a collider, is unresolved at the end of a time step.",
        parameters: &[],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |_| 0.0,
        figure: |sample, _| Some(sample.report.pairs_unresolved as f64),
    },
    Form {
        name: MAX_UNRESOLVED,
        doc: "No frame leaves more pairs of elements unresolved than this. Without this check a run fails with the first.",
        parameters: &["pairs"],
        values: Values::Counts,
        bound: Bound::AtMost,
        limit: |arguments| arguments[0],
        figure: |sample, _| Some(sample.report.pairs_unresolved as f64),
    },
    Form {
        name: MAX_DEPENETRATING,
        doc: "No frame has more points inside closed colliders than this. Without this check a run fails if it ends with any.",
        parameters: &["points"],
        values: Values::Counts,
        bound: Bound::AtMost,
        limit: |arguments| arguments[0],
        figure: |sample, _| Some(sample.report.depenetrating as f64),
    },
    Form {
        name: MAX_INTERSECTIONS,
        doc: "No frame has more edges of cloth through faces of cloth than this. Without this check a run fails if it ends with any.",
        parameters: &["edges"],
        values: Values::Counts,
        bound: Bound::AtMost,
        limit: |arguments| arguments[0],
        figure: |sample, _| Some(sample.report.intersections as f64),
    },
    Form {
        name: NO_CROSSING,
        doc: "Nothing is inside anything at the end of a frame that was not so at the start: cloth in itself, in other cloth, in a collider. With `--audit` nothing passes through on the way either.",
        parameters: &[],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |_| 0.0,
        figure: |sample, _| sample.passed_through.map(|count| count as f64),
    },
    Form {
        name: MAX_STRETCH,
        doc: "No link is longer than at rest by more than this share.",
        parameters: &["strain"],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |arguments| arguments[0],
        figure: |sample, _| Some(sample.report.max_strain),
    },
    Form {
        name: "maxStretch99",
        doc: "99 % of the links are not longer than at rest by more than this share.",
        parameters: &["strain"],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |arguments| arguments[0],
        figure: |sample, _| Some(sample.report.strain_99),
    },
    Form {
        name: "settledStretch99",
        doc: "From this frame on 99 % of the links are not longer than at rest by more than this share.",
        parameters: &["frame", "strain"],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |arguments| arguments[1],
        figure: |seen, arguments| (seen.frame as f64 >= arguments[0]).then_some(seen.report.strain_99),
    },
    Form {
        name: "minGap",
        doc: "Nothing comes closer to a collider than this share of the thickness.",
        parameters: &["gap"],
        values: Values::Numbers,
        bound: Bound::AtLeast,
        limit: |arguments| arguments[0],
        figure: |sample, _| Some(sample.report.min_gap),
    },
    Form {
        name: "finite",
        doc: "Every position and velocity is a finite number.",
        parameters: &[],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |_| 0.0,
        figure: |sample, _| Some(if sample.report.finite { 0.0 } else { 1.0 }),
    },
    Form {
        name: "maxWeldGap",
        doc: "Nothing that is welded is farther apart than at rest by more than this many metres.",
        parameters: &["distance"],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |arguments| arguments[0],
        figure: |sample, _| Some(sample.report.max_weld_gap),
    },
    Form {
        name: "maxBroken",
        doc: "No more links of constraints break than this.",
        parameters: &["links"],
        values: Values::Counts,
        bound: Bound::AtMost,
        limit: |arguments| arguments[0],
        figure: |sample, _| Some(sample.report.broken_links as f64),
    },
    Form {
        name: "tornBy",
        doc: "From this frame on at least so many links of constraints are broken.",
        parameters: &["frame", "links"],
        values: Values::Counts,
        bound: Bound::AtLeast,
        limit: |arguments| arguments[1],
        figure: |sample, arguments| {
            (sample.frame as f64 >= arguments[0]).then_some(sample.report.broken_links as f64)
        },
    },
    Form {
        name: "minParticles",
        doc: "From this frame on there are no fewer particles than this, of objects in which they are born and die.",
        parameters: &["frame", "particles"],
        values: Values::Counts,
        bound: Bound::AtLeast,
        limit: |arguments| arguments[1],
        figure: |sample, arguments| {
            (sample.frame as f64 >= arguments[0]).then_some(sample.report.particles as f64)
        },
    },
    Form {
        name: "maxParticles",
        doc: "No frame has more particles than this, of objects in which they are born and die.",
        parameters: &["particles"],
        values: Values::Counts,
        bound: Bound::AtMost,
        limit: |arguments| arguments[0],
        figure: |sample, _| Some(sample.report.particles as f64),
    },
    Form {
        name: "volumeError",
        doc: "From this frame on liquids are denser than at rest by not more than this share, on average over their particles.",
        parameters: &["frame", "share"],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |arguments| arguments[1],
        figure: |sample, arguments| {
            (sample.frame as f64 >= arguments[0]).then_some(sample.report.density_error)
        },
    },
    Form {
        name: "separatedBy",
        doc: "From this frame on no edge of cloth goes through a face of cloth.",
        parameters: &["frame"],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |_| 0.0,
        figure: |sample, arguments| {
            (sample.frame as f64 >= arguments[0]).then_some(sample.report.intersections as f64)
        },
    },
    Form {
        name: "restsBy",
        doc: "From this frame on the root mean square speed, in m/s, is not above this.",
        parameters: &["frame", "speed"],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |arguments| arguments[1],
        figure: |sample, arguments| (sample.frame as f64 >= arguments[0]).then(|| sample.speed()),
    },
];

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

    /// Its arguments, in the order of [`Form::parameters`].
    pub fn arguments(&self) -> &[f64] {
        &self.arguments
    }

    /// Whether it requires an audit.
    pub fn needs_audit(&self) -> bool {
        self.form.name == NO_CROSSING
    }

    /// Its bound and limit.
    pub fn limit(&self) -> (Bound, f64) {
        (self.form.bound, (self.form.limit)(&self.arguments))
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

/// The syntax of a scene: `noPenetration`, `maxStretch(0.02)`, `restsBy(frame: 100, speed: 0.01)`.
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
    /// As a scene writes it, with names for the arguments: `restsBy(frame: ..., speed: ...)`.
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
        let sample = Sample { frame, report, passed_through, mass: self.mass };
        for outcome in &mut self.outcomes {
            let check = &outcome.check;
            let Some(figure) = (check.form.figure)(&sample, &check.arguments) else { continue };
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
