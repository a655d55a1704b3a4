//! A setting: values of the attributes that trade time for accuracy.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Interpretation of resistances (`resistanceModel`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Reading {
    /// Iteration counts.
    Classic,
    /// Stiffnesses, solved with a budget of evaluations.
    Physical,
}

/// Values on the nucleus and on cloth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// `resistanceModel`.
    pub reading: Reading,
    /// `subSteps`, per frame.
    pub substeps: u32,
    /// `maxCollisionIterations`, per 1/24 s.
    pub collision_iterations: u32,
    /// Physical: `evaluations` per 1/24 s; for a keyed attribute the maximum, with the other keys in proportion.
    pub evaluations: f64,
    /// Classic: factor on stretch, compression and shear resistance.
    pub resistance: f64,
    /// Physical: `tethers` on every cloth that hangs by pins; off, each cloth has its own.
    #[serde(default)]
    pub tethers: bool,
}

impl Setting {
    /// The same setting with so many evaluations.
    pub fn with_evaluations(self, evaluations: f64) -> Self {
        Self { evaluations, ..self }
    }

    /// Unique name, for files and lists.
    pub fn key(&self) -> String {
        let Self { substeps, collision_iterations: passes, evaluations, resistance, .. } = self;
        let tethers = if self.tethers { "-t" } else { "" };
        match self.reading {
            Reading::Physical => format!("physical-s{substeps}-c{passes}-e{evaluations}{tethers}"),
            Reading::Classic => format!("classic-s{substeps}-c{passes}-x{resistance}"),
        }
    }
}

/// Human-readable: `192 evaluations in 3 substeps`.
impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { substeps, collision_iterations: passes, evaluations, resistance, .. } = self;
        let plural = if *substeps == 1 { "" } else { "s" };
        match self.reading {
            Reading::Physical => {
                let tethers = if self.tethers { " with tethers" } else { "" };
                write!(f, "{evaluations} evaluations in {substeps} substep{plural}{tethers}")
            }
            Reading::Classic => {
                write!(f, "{substeps} substep{plural}, {passes} collision iterations")?;
                if *resistance == 1.0 { Ok(()) } else { write!(f, ", resistances x {resistance}") }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_have_unique_keys_and_readable_names() {
        let physical = Setting {
            reading: Reading::Physical,
            substeps: 1,
            collision_iterations: 4,
            evaluations: 96.0,
            resistance: 1.0,
            tethers: false,
        };
        let tethered = Setting { tethers: true, ..physical };
        assert_eq!(tethered.to_string(), "96 evaluations in 1 substep with tethers");
        assert_ne!(physical.key(), tethered.key());
        let classic = Setting { reading: Reading::Classic, substeps: 8, resistance: 0.25, ..physical };
        assert_eq!(physical.to_string(), "96 evaluations in 1 substep");
        assert_eq!(classic.to_string(), "8 substeps, 4 collision iterations, resistances x 0.25");
        assert_ne!(physical.key(), classic.key());
        assert_ne!(physical.key(), Setting { collision_iterations: 5, ..physical }.key());
    }
}
