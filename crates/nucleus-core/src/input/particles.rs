//! What differs by particle: ramps of attributes, collision events, and changes of single particles.

use nalgebra::Vector3;

use crate::input::ClothId;
use crate::input::samples::sample_at;

/// What a ramp is read by; the right end of a ramp stands at `input_max`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RampInput {
    /// Nothing: the ramp is not read, and its factor is 1.
    Off,
    /// Time since birth in seconds.
    Age,
    /// Age over lifespan; 0 for particles that live forever. It runs from 0 to 1 whatever `input_max`.
    NormalizedAge,
    /// Speed in m/s.
    Speed,
    /// Change of velocity over the last substep, in m/s².
    Acceleration,
    /// The number of the particle.
    Id,
    /// A place at random, the same for the whole life of the particle.
    RandomizedId,
    /// Radius in metres, scaled by its own ramp.
    Radius,
}

/// The attribute that a ramp scales.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RampTarget {
    /// Radius, and the thickness in contact.
    Radius,
    /// Mass.
    Mass,
    /// Friction.
    Friction,
    /// Stickiness.
    Stickiness,
    /// Bounce.
    Bounce,
    /// Collide strength.
    CollideStrength,
    /// Strength of its point force field.
    PointField,
    /// Viscosity of a liquid.
    Viscosity,
    /// Surface tension of a liquid.
    SurfaceTension,
    /// Opacity of its looks.
    Opacity,
    /// A channel of its colour: 0 red, 1 green, 2 blue.
    Color(u8),
    /// A channel of the light it gives off.
    Incandescence(u8),
}

impl RampTarget {
    /// A number for random draws; the channels of a colour have one in common.
    fn key(self) -> u64 {
        match self {
            Self::Radius => 0,
            Self::Mass => 1,
            Self::Friction => 2,
            Self::Stickiness => 3,
            Self::Bounce => 4,
            Self::CollideStrength => 5,
            Self::PointField => 6,
            Self::Viscosity => 7,
            Self::SurfaceTension => 8,
            Self::Opacity => 9,
            Self::Color(_) => 10,
            Self::Incandescence(_) => 11,
        }
    }

    /// Whether it is drawn and acts on nothing.
    pub fn is_look(self) -> bool {
        matches!(self, Self::Opacity | Self::Color(_) | Self::Incandescence(_))
    }
}

/// A factor on an attribute of each particle.
#[derive(Debug, Clone, PartialEq)]
pub struct ParticleRamp {
    /// The attribute.
    pub target: RampTarget,
    /// What it is read by.
    pub input: RampInput,
    /// The input at the right end of the ramp, in the unit of the input.
    pub input_max: f64,
    /// The factor at evenly spaced places from the left end to the right, linear between; at least one.
    pub samples: Vec<f64>,
    /// Variation at random: of the factor, by up to this share of it to both sides; of a colour, of the place on the ramp.
    pub randomize: f64,
}

/// What ramps read of a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleFacts {
    /// Its number.
    pub id: u64,
    /// Time since birth in seconds.
    pub age: f64,
    /// Age of death in seconds; infinite for never.
    pub lifespan: f64,
    /// In m/s.
    pub speed: f64,
    /// In m/s².
    pub acceleration: f64,
    /// In metres.
    pub radius: f64,
}

impl ParticleRamp {
    /// Whether every number of it can be used.
    pub fn is_valid(&self) -> bool {
        let is_factor = |x: f64| (0.0..=1e6).contains(&x);
        !self.samples.is_empty()
            && self.samples.iter().all(|&sample| is_factor(sample))
            && is_factor(self.randomize)
            && self.input_max >= 0.0
    }

    /// The largest factor that it can give.
    pub fn max_factor(&self) -> f64 {
        let most = match self.input {
            RampInput::Off => 1.0,
            _ => self.samples.iter().copied().fold(0.0, f64::max),
        };
        if self.target.is_look() { most } else { most * (1.0 + self.randomize) }
    }

    /// The factor of a particle.
    ///
    /// # Panics
    /// When there are no samples.
    pub fn factor(&self, facts: &ParticleFacts) -> f64 {
        let away = match self.randomize {
            0.0 => 0.0,
            most => most * (2.0 * unit_random([facts.id, self.target.key()]) - 1.0),
        };
        if matches!(self.target, RampTarget::Color(_) | RampTarget::Incandescence(_)) {
            return self.at(self.place(facts).map_or(0.0, |place| place + away));
        }
        let factor = self.place(facts).map_or(1.0, |place| self.at(place));
        (factor * (1.0 + away)).max(0.0)
    }

    /// Where it is read for a particle, 0 to 1; `None` where it is not read.
    fn place(&self, facts: &ParticleFacts) -> Option<f64> {
        let input = match self.input {
            RampInput::Off => return None,
            RampInput::NormalizedAge if facts.lifespan.is_finite() => {
                return Some(if facts.lifespan > 0.0 { facts.age / facts.lifespan } else { 1.0 });
            }
            RampInput::NormalizedAge => return Some(0.0),
            RampInput::RandomizedId => return Some(unit_random([facts.id, u64::MAX])),
            RampInput::Age => facts.age,
            RampInput::Speed => facts.speed,
            RampInput::Acceleration => facts.acceleration,
            RampInput::Id => facts.id as f64,
            RampInput::Radius => facts.radius,
        };
        // Without a width everything but zero is behind the right end.
        Some(if self.input_max > 0.0 { input / self.input_max } else { f64::from(u8::from(input > 0.0)) })
    }

    /// The factor at a place.
    fn at(&self, place: f64) -> f64 {
        sample_at(&self.samples, place)
    }
}

/// A number from 0 to below 1 that depends on a key alone (SplitMix64: Steele et al. 2014).
pub fn unit_random(key: [u64; 2]) -> f64 {
    let mix = |mut x: u64| {
        x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ x >> 31
    };
    let state = key.into_iter().fold(0x9e37_79b9_7f4a_7c15, |state, word: u64| {
        mix(state ^ mix(word.wrapping_add(0x9e37_79b9_7f4a_7c15)))
    });
    (state >> 11) as f64 / (1u64 << 53) as f64
}

/// What happens when a particle collides.
#[derive(Debug, Clone, PartialEq)]
pub struct CollisionEvent {
    /// The collision of the particle at which it happens, from 1; 0 is every one.
    pub count: u32,
    /// Its probability at such a collision, 0 to 1.
    pub probability: f64,
    /// How many particles are emitted; the colliding one lives on.
    pub emit: u32,
    /// How many particles the colliding one becomes, with its age and lifespan; 0 and 1 leave it as it is.
    pub split: u32,
    /// Whether the numbers are drawn from 1 to themselves.
    pub random: bool,
    /// Whether the colliding particle dies.
    pub die: bool,
    /// Angle about the direction of the rebound within which new particles fly, as a share of 90°.
    pub spread: f64,
    /// The object of the emitted particles, which has capacity for particles; those of a split stay in their own.
    pub target: ClothId,
    /// Age in seconds at which emitted particles die, in the mean, and the width of its range.
    pub lifespan: [f64; 2],
}

/// A change of a living particle at the start of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleChange {
    /// The object, in which particles are born and die.
    pub cloth: ClothId,
    /// Its place among the living particles, as in [`StateView::particles`](crate::StateView::particles).
    pub place: usize,
    /// Its new velocity in m/s.
    pub velocity: Option<Vector3<f64>>,
    /// Its new lifespan in seconds.
    pub lifespan: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    const FACTS: ParticleFacts =
        ParticleFacts { id: 7, age: 0.5, lifespan: 2.0, speed: 3.0, acceleration: 9.0, radius: 0.1 };

    fn ramp(input: RampInput, input_max: f64) -> ParticleRamp {
        ParticleRamp { target: RampTarget::Bounce, input, input_max, samples: vec![0.0, 4.0], randomize: 0.0 }
    }

    #[test]
    fn a_linear_ramp_gives_the_share_of_its_input() {
        for (input, value) in [
            (RampInput::Age, 0.5),
            (RampInput::Speed, 3.0),
            (RampInput::Acceleration, 9.0),
            (RampInput::Id, 7.0),
            (RampInput::Radius, 0.1),
        ] {
            assert!((ramp(input, 10.0).factor(&FACTS) - 0.4 * value).abs() < 1e-12, "{input:?}");
            assert_eq!(ramp(input, value / 2.0).factor(&FACTS), 4.0, "{input:?} behind the right end");
        }
        // Normalized age has no other unit than itself.
        assert_eq!(ramp(RampInput::NormalizedAge, 9.0).factor(&FACTS), 1.0);
        let immortal = ParticleFacts { lifespan: f64::INFINITY, ..FACTS };
        assert_eq!(ramp(RampInput::NormalizedAge, 9.0).factor(&immortal), 0.0);
        assert_eq!(ramp(RampInput::Off, 1.0).factor(&FACTS), 1.0);
    }

    #[test]
    fn random_factors_are_evenly_spread_and_belong_to_the_particle() {
        let varied = ParticleRamp { randomize: 0.5, ..ramp(RampInput::Off, 1.0) };
        let of = |id: u64| varied.factor(&ParticleFacts { id, ..FACTS });
        let all: Vec<f64> = (0..20_000).map(of).collect();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        let square = all.iter().map(|x| (x - 1.0) * (x - 1.0)).sum::<f64>() / all.len() as f64;
        // Even from 0.5 to 1.5: the mean is 1, the variance 1/12.
        assert!((mean - 1.0).abs() < 0.01 && (square - 1.0 / 12.0).abs() < 0.002, "{mean} {square}");
        assert!(all.iter().all(|x| (0.5..1.5).contains(x)) && varied.max_factor() == 1.5);
        assert_eq!(of(3), of(3));
    }
}
