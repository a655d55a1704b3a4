//! Euler's elastica, the inextensible strip under bending, by shooting.

/// Tip of a clamped strip of unit length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    /// Angle below the horizontal, in radians.
    pub tip_angle: f64,
    /// Horizontal displacement from the clamp, over the length.
    pub out: f64,
    /// Vertical displacement, over the length.
    pub down: f64,
}

/// Steps of the integration.
const STEPS: u32 = 20_000;

/// Under its own weight: `gamma` = weight per length · L³ / B.
pub fn heavy(gamma: f64) -> Curve {
    shoot(|from_tip, angle| -gamma * from_tip * angle.cos())
}

/// Under a load at the tip that keeps its direction: `load` = P L² / B.
pub fn tip_loaded(load: f64) -> Curve {
    shoot(|_, angle| -load * angle.cos())
}

/// Bisects for the tip angle at which the clamp is horizontal. Integration starts at the tip, where the moment is
/// zero; `bend(s, angle)` is the derivative of the curvature. The unknown is the logarithm of the complement of the
/// angle, because under a large load the tip is vertical up to 1e-10.
fn shoot(bend: impl Fn(f64, f64) -> f64) -> Curve {
    let angle = |log: f64| std::f64::consts::FRAC_PI_2 - log.exp();
    let (mut low, mut high) = (-60.0f64, std::f64::consts::FRAC_PI_2.ln());
    for _ in 0..100 {
        let middle = (low + high) / 2.0;
        // The closer the tip is to vertical, the farther the clamp is from horizontal.
        if integrate(angle(middle), &bend).1 > 0.0 { low = middle } else { high = middle }
    }
    let (curve, _) = integrate(angle((low + high) / 2.0), &bend);
    curve
}

/// Integrates from the tip to the clamp (Runge-Kutta, fourth order); the curve, and the angle at the clamp.
fn integrate(tip_angle: f64, bend: &impl Fn(f64, f64) -> f64) -> (Curve, f64) {
    let h = 1.0 / f64::from(STEPS);
    // Angle, curvature, out, down.
    let slope =
        |s: f64, [angle, curvature, ..]: [f64; 4]| [curvature, bend(s, angle), angle.cos(), angle.sin()];
    let add = |y: [f64; 4], k: [f64; 4], f: f64| std::array::from_fn(|i| y[i] + f * k[i]);
    let mut y = [tip_angle, 0.0, 0.0, 0.0];
    for step in 0..STEPS {
        let s = f64::from(step) * h;
        let k1 = slope(s, y);
        let k2 = slope(s + h / 2.0, add(y, k1, h / 2.0));
        let k3 = slope(s + h / 2.0, add(y, k2, h / 2.0));
        let k4 = slope(s + h, add(y, k3, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        // Past horizontal the sign is known, and the curve is meaningless.
        if y[0] < -1.0 {
            break;
        }
    }
    (Curve { tip_angle, out: y[2], down: y[3] }, y[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_heavy_strip_agrees_with_an_independent_table() {
        // Gamma, tip angle in degrees, W / L, H / L.
        let table = [
            (0.1, 0.955, 0.999_911, 0.012_498),
            (1.0, 9.460, 0.991_246, 0.123_471),
            (10.0, 60.312, 0.656_354, 0.700_200),
            (100.0, 89.617, 0.159_223, 0.937_524),
            (1000.0, 90.0, 0.045_986, 0.981_141),
        ];
        for (gamma, degrees, out, down) in table {
            let curve = heavy(gamma);
            assert!((curve.tip_angle.to_degrees() - degrees).abs() < 1e-3, "{gamma}: {curve:?}");
            assert!((curve.out - out).abs() < 2e-6 && (curve.down - down).abs() < 2e-6, "{gamma}: {curve:?}");
        }
    }

    #[test]
    fn the_loaded_strip_agrees_with_an_independent_table() {
        for (load, degrees, out, down) in [
            (0.25, 7.121, 0.995_882, 0.082_746),
            (2.0, 44.791, 0.839_358, 0.493_457),
            (10.0, 81.949, 0.445_004, 0.810_609),
        ] {
            let curve = tip_loaded(load);
            assert!((curve.tip_angle.to_degrees() - degrees).abs() < 1e-3, "{load}: {curve:?}");
            assert!((curve.out - out).abs() < 2e-6 && (curve.down - down).abs() < 2e-6, "{load}: {curve:?}");
        }
    }
}
