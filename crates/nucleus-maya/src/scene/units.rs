//! Units of a file: `currentUnit -l centimeter -a degree -t film`.

/// The units of a file in Maya's internal units: centimetres, degrees and frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Units {
    /// Centimetres in a unit of length.
    pub centimetres: f64,
    /// Degrees in a unit of angle.
    pub degrees: f64,
    /// Frames per second.
    pub fps: f64,
}

impl Default for Units {
    fn default() -> Self {
        Self { centimetres: 1.0, degrees: 1.0, fps: 24.0 }
    }
}

/// Whether a node is the shape below a transform, which has no placement of its own.
pub(crate) fn is_shape(kind: &str) -> bool {
    const SHAPES: [&str; 12] = [
        "mesh",
        "nCloth",
        "nRigid",
        "nParticle",
        "particle",
        "dynamicConstraint",
        "camera",
        "locator",
        "hairSystem",
        "nurbsCurve",
        "nurbsSurface",
        "follicle",
    ];
    SHAPES.contains(&kind)
}

/// What an attribute measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// A length: in a file, in its unit of length.
    Length,
    /// An angle: in a file, in its unit of angle.
    Angle,
    /// A time: in a file, in its frames.
    Time,
    /// A number without a unit.
    Number,
}

impl Quantity {
    /// That of an attribute of a node of a type, or of a component of it.
    pub fn of(kind: &str, name: &str) -> Self {
        match (kind, name) {
            (kind, name) if is_shape(kind) => Self::of_shape(kind, name),
            ("pointEmitter", "max" | "maxDistance" | "min" | "minDistance" | "vsr" | "sectionRadius") => {
                Self::Length
            }
            ("pointEmitter", "vsw" | "volumeSweep") => Self::Angle,
            // The same names are other attributes on nodes of construction history.
            (kind, _) if kind.starts_with("poly") => Self::Number,
            ("time", _) => Self::Time,
            (kind, _) if kind.starts_with("animCurve") => Self::of_curve(kind, name),
            ("pairBlend", _) => Self::of_prefix(
                name,
                ["it", "ot", "inTranslate", "outTranslate"],
                ["ir", "or", "inRotate", "outRotate"],
            ),
            ("parentConstraint" | "pointConstraint" | "orientConstraint", _) => {
                Self::of_prefix(name, ["ct", "constraintTranslate"], ["cr", "constraintRotate"])
            }
            _ => Self::of_transform(name),
        }
    }

    /// The letters after `animCurve` say what a curve depends on, and what it gives.
    fn of_curve(kind: &str, name: &str) -> Self {
        match (kind.as_bytes(), name) {
            ([.., b'L'], "o" | "output") => Self::Length,
            ([.., b'A'], "o" | "output") => Self::Angle,
            ([.., b'T'], "o" | "output") | ([.., b'T', _], "i" | "input") => Self::Time,
            _ => Self::Number,
        }
    }

    /// Shapes have short names of transforms for other attributes: `ra` of an nParticle is its radius.
    fn of_shape(kind: &str, name: &str) -> Self {
        match (kind, name) {
            ("nCloth", "reae" | "restitutionAngle") => Self::Angle,
            _ => Self::Number,
        }
    }

    fn of_prefix<const N: usize>(name: &str, lengths: [&str; N], angles: [&str; N]) -> Self {
        let begins = |all: [&str; N]| all.iter().any(|prefix| name.starts_with(prefix));
        match (begins(lengths), begins(angles)) {
            (true, _) => Self::Length,
            (_, true) => Self::Angle,
            _ => Self::Number,
        }
    }

    fn of_transform(name: &str) -> Self {
        match name.strip_suffix(['x', 'y', 'z', 'X', 'Y', 'Z']).unwrap_or(name) {
            "t"
            | "translate"
            | "rp"
            | "rotatePivot"
            | "rpt"
            | "rotatePivotTranslate"
            | "sp"
            | "scalePivot"
            | "spt"
            | "scalePivotTranslate" => Self::Length,
            "r" | "rotate" | "ra" | "rotateAxis" | "jo" | "jointOrient" => Self::Angle,
            _ => Self::Number,
        }
    }
}

/// Maya's ticks in a second.
const TICKS: f64 = 6000.0;

/// Maya's names of frame rates.
const RATES: [(&str, f64); 7] = [
    ("game", 15.0),
    ("film", 24.0),
    ("pal", 25.0),
    ("ntsc", 30.0),
    ("show", 48.0),
    ("palf", 50.0),
    ("ntscf", 60.0),
];

impl Units {
    /// Centimetres, degrees or seconds in a unit of a quantity; 1 for a plain number.
    pub fn of(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Length => self.centimetres,
            Quantity::Angle => self.degrees,
            Quantity::Time => 1.0 / self.fps,
            Quantity::Number => 1.0,
        }
    }

    /// Units in which Maya computes (centimetres, radians, ticks) in a unit of a quantity.
    pub fn internal(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Angle => self.degrees.to_radians(),
            Quantity::Time => TICKS / self.fps,
            _ => self.of(quantity),
        }
    }

    /// Takes a unit of length; returns whether it is known.
    pub fn set_length(&mut self, name: &str) -> bool {
        self.centimetres = match name {
            "mm" | "millimeter" => 0.1,
            "cm" | "centimeter" => 1.0,
            "m" | "meter" => 100.0,
            "km" | "kilometer" => 100_000.0,
            "in" | "inch" => 2.54,
            "ft" | "foot" => 30.48,
            "yd" | "yard" => 91.44,
            "mi" | "mile" => 160_934.4,
            _ => return false,
        };
        true
    }

    /// Takes a unit of angle; returns whether it is known.
    pub fn set_angle(&mut self, name: &str) -> bool {
        self.degrees = match name {
            "deg" | "degree" => 1.0,
            "rad" | "radian" => 180.0 / std::f64::consts::PI,
            _ => return false,
        };
        true
    }

    /// Takes a unit of time; returns whether it is known.
    pub fn set_time(&mut self, name: &str) -> bool {
        let named = RATES.iter().find(|(known, _)| *known == name).map(|(_, fps)| *fps);
        let number = || name.strip_suffix("fps").and_then(|number| number.parse::<f64>().ok());
        let other = || match name {
            // Drop frames change the numbers of a time code, not the rate.
            "29.97df" => Some(29.97),
            "sec" => Some(1.0),
            "min" => Some(1.0 / 60.0),
            "hour" => Some(1.0 / 3600.0),
            "millisec" => Some(1000.0),
            _ => None,
        };
        match named.or_else(number).or_else(other).filter(|fps| *fps > 0.0 && fps.is_finite()) {
            Some(fps) => {
                self.fps = fps;
                true
            }
            None => false,
        }
    }

    /// Whether a scene can have this frame rate.
    pub(crate) fn has_a_frame_rate(&self) -> bool {
        (1e-3..=1e6).contains(&self.fps)
    }

    /// Maya's name of a frame rate.
    pub fn time_name(fps: f64) -> String {
        let named = RATES.iter().find(|(_, known)| *known == fps);
        named.map_or_else(|| format!("{fps}fps"), |(name, _)| (*name).to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_rate_is_read_as_it_is_named() {
        for fps in [15.0, 24.0, 25.0, 30.0, 48.0, 60.0, 23.976, 120.0, 12.5] {
            let mut units = Units::default();
            assert!(units.set_time(&Units::time_name(fps)));
            assert_eq!(units.fps, fps);
        }
        let mut units = Units::default();
        assert!(!units.set_time("fortnight") && !units.set_time("0fps") && !units.set_time("nanfps"));
        assert_eq!(units.fps, 24.0);
    }
}
