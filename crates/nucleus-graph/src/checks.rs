//! What must hold during a run: `checks: [noPenetration, maxStretch(0.02)]`.
//!
//! Every check is a row: a figure that is read off each frame, and a bound on it. To add one, add a row to
//! `FORMS`.

use std::fmt;

use nucleus_core::StepReport;

use crate::simulation::FrameReport;

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
    /// What it says, in one line.
    pub doc: &'static str,
    /// Names of its arguments.
    pub parameters: &'static [&'static str],
    /// Which values they take.
    pub values: Values,
    bound: Bound,
    limit: fn(&[f64]) -> f64,
    figure: fn(&Seen, &[f64]) -> Option<f64>,
}

/// Which values the arguments of a check take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Values {
    /// Any number.
    Numbers,
    /// Whole numbers from 0.
    Counts,
}

/// On which side of its limit a figure has to stay.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Bound {
    /// It must not be larger.
    AtMost,
    /// It must not be smaller.
    AtLeast,
}

/// How a check ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The check.
    pub check: Check,
    /// Whether it held in every frame it is about, and there was at least one.
    pub passed: bool,
    /// The worst figure, and the first frame that had it; `None` when no frame was looked at.
    pub worst: Option<(f64, i64)>,
}

/// Follows a run and judges it.
#[derive(Debug, Clone)]
pub struct Judge {
    outcomes: Vec<Outcome>,
    mass: f64,
}

/// What a check can look at.
struct Seen<'a> {
    frame: i64,
    report: &'a StepReport,
    /// Nothing where no audit looks.
    passed_through: Option<u64>,
    /// All points together, in kilograms.
    mass: f64,
}

/// The check that only an audit can answer.
const NO_CROSSING: &str = "noCrossing";

/// The check that limits unresolved pairs; a run without it is held to none.
pub const MAX_UNRESOLVED: &str = "maxUnresolved";
/// The check that limits points inside colliders; a run without it has to end with none.
pub const MAX_TRAPPED: &str = "maxTrapped";
/// The check that limits edges of cloth through faces; a run without it has to end with none.
pub const MAX_TANGLED: &str = "maxTangled";
/// The check that limits strain; a run without it warns of large strain.
pub const MAX_STRETCH: &str = "maxStretch";

static FORMS: [Form; 12] = [
    Form {
        name: "noPenetration",
        doc: "No pair of elements of cloth, or of cloth and a collider, is unresolved at the end of a time step.",
        parameters: &[],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |_| 0.0,
        figure: |seen, _| Some(seen.report.pairs_unresolved as f64),
    },
    Form {
        name: MAX_UNRESOLVED,
        doc: "No frame leaves more pairs of elements unresolved than this. Without this check a run fails with the first.",
        parameters: &["pairs"],
        values: Values::Counts,
        bound: Bound::AtMost,
        limit: |arguments| arguments[0],
        figure: |seen, _| Some(seen.report.pairs_unresolved as f64),
    },
    Form {
        name: MAX_TRAPPED,
        doc: "No frame has more points inside closed colliders than this. Without this check a run fails if it ends with any.",
        parameters: &["points"],
        values: Values::Counts,
        bound: Bound::AtMost,
        limit: |arguments| arguments[0],
        figure: |seen, _| Some(seen.report.depenetrating as f64),
    },
    Form {
        name: MAX_TANGLED,
        doc: "No frame has more edges of cloth through faces of cloth than this. Without this check a run fails if it ends with any.",
        parameters: &["edges"],
        values: Values::Counts,
        bound: Bound::AtMost,
        limit: |arguments| arguments[0],
        figure: |seen, _| Some(seen.report.intersections as f64),
    },
    Form {
        name: NO_CROSSING,
        doc: "Nothing is inside anything at the end of a frame that was not so at the start: cloth in itself, in other cloth, in a collider. With `--audit` nothing passes through on the way either.",
        parameters: &[],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |_| 0.0,
        figure: |seen, _| seen.passed_through.map(|count| count as f64),
    },
    Form {
        name: MAX_STRETCH,
        doc: "No link is longer than at rest by more than this share.",
        parameters: &["strain"],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |arguments| arguments[0],
        figure: |seen, _| Some(seen.report.max_strain),
    },
    Form {
        name: "maxStretch99",
        doc: "99 % of the links are not longer than at rest by more than this share.",
        parameters: &["strain"],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |arguments| arguments[0],
        figure: |seen, _| Some(seen.report.strain_99),
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
        figure: |seen, _| Some(seen.report.min_gap),
    },
    Form {
        name: "finite",
        doc: "Every position and velocity is a finite number.",
        parameters: &[],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |_| 0.0,
        figure: |seen, _| Some(if seen.report.finite { 0.0 } else { 1.0 }),
    },
    Form {
        name: "untangledBy",
        doc: "From this frame on no edge of cloth goes through a face of cloth.",
        parameters: &["frame"],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |_| 0.0,
        figure: |seen, arguments| {
            (seen.frame as f64 >= arguments[0]).then_some(seen.report.intersections as f64)
        },
    },
    Form {
        name: "restsBy",
        doc: "From this frame on the root mean square speed, in m/s, is not above this.",
        parameters: &["frame", "speed"],
        values: Values::Numbers,
        bound: Bound::AtMost,
        limit: |arguments| arguments[1],
        figure: |seen, arguments| (seen.frame as f64 >= arguments[0]).then(|| seen.speed()),
    },
];

impl Seen<'_> {
    fn speed(&self) -> f64 {
        if self.mass > 0.0 { (2.0 * self.report.kinetic_energy / self.mass).sqrt() } else { 0.0 }
    }
}

/// There is one static per kind, compared by identity.
impl PartialEq for Form {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
    }
}

impl Check {
    /// A check by its name; `None` when there is none of this name that takes so many arguments.
    pub fn new(name: &str, arguments: &[f64]) -> Option<Self> {
        let form = Form::all().iter().find(|form| form.name == name)?;
        (form.parameters.len() == arguments.len()).then(|| Self { form, arguments: arguments.to_vec() })
    }

    /// What kind of check it is.
    pub fn form(&self) -> &'static Form {
        self.form
    }

    /// Its arguments, in the order of [`Form::parameters`].
    pub fn arguments(&self) -> &[f64] {
        &self.arguments
    }

    /// Whether it is answered only where the run is audited.
    pub fn needs_audit(&self) -> bool {
        self.form.name == NO_CROSSING
    }

    /// Which side of which limit its figure has to keep to.
    pub fn limit(&self) -> (Bound, f64) {
        (self.form.bound, (self.form.limit)(&self.arguments))
    }

    /// Whether a figure is on the right side. NaN never is.
    pub fn accepts(&self, figure: f64) -> bool {
        match self.limit() {
            (Bound::AtMost, limit) => figure <= limit,
            (Bound::AtLeast, limit) => figure >= limit,
        }
    }

    /// Whether one figure is worse than another. NaN is the worst.
    fn is_worse(&self, figure: f64, than: f64) -> bool {
        let farther = match self.form.bound {
            Bound::AtMost => figure > than,
            Bound::AtLeast => figure < than,
        };
        farther || (figure.is_nan() && !than.is_nan())
    }
}

/// As a scene writes it: `noPenetration`, `maxStretch(0.02)`, `restsBy(frame: 100, speed: 0.01)`.
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
    /// All kinds of checks.
    pub fn all() -> &'static [Form] {
        &FORMS
    }
}

impl Judge {
    /// Begins with checks of which nothing is known. `mass` is that of all cloth together in kilograms.
    pub fn new(checks: &[Check], mass: f64) -> Self {
        let open = |check: &Check| Outcome { check: check.clone(), passed: false, worst: None };
        Self { outcomes: checks.iter().map(open).collect(), mass }
    }

    /// Looks at the next frame.
    pub fn see(&mut self, frame: &FrameReport) {
        let FrameReport { frame, ref report, passed_through } = *frame;
        let seen = Seen { frame, report, passed_through, mass: self.mass };
        for outcome in &mut self.outcomes {
            let check = &outcome.check;
            let Some(figure) = (check.form.figure)(&seen, &check.arguments) else { continue };
            if outcome.worst.is_none_or(|(worst, _)| check.is_worse(figure, worst)) {
                outcome.worst = Some((figure, frame));
                outcome.passed = check.accepts(figure);
            }
        }
    }

    /// How every check stands, in the order of the scene.
    pub fn outcomes(&self) -> &[Outcome] {
        &self.outcomes
    }
}

#[cfg(test)]
mod tests;
