//! Where particles come from, and how fast: a point, a volume, a curve, or the surface of a mesh. Lengths in scene units.

use nalgebra::{Matrix3, Vector3};

use crate::animation::{Affine, sin_cos_degrees};
use crate::attributes::{Choice, point_emitter};
use crate::graph::{EvalContext, NodeId};

use super::curve::CurveShape;
use super::random::Random;
use super::start::{Speed, Start, turned_to};
use super::surface::Patches;

type Vec3 = Vector3<f64>;

/// Where the particles of an emitter come from in an interval.
pub(super) enum Launch {
    /// A point, in a direction or in all.
    Point(PointShape),
    /// The inside of a volume.
    Volume(VolumeShape),
    /// The surface of a mesh.
    Surface(Patches),
    /// A curve.
    Curve(CurveShape),
    /// Nowhere.
    Nothing,
}

impl Launch {
    /// The start of a particle at a share of the interval; `seconds` is its length. `None` where nothing is emitted.
    pub(super) fn draw(
        &self,
        placements: &[Affine; 2],
        time: f64,
        seconds: f64,
        random: &mut Random,
    ) -> Option<Start> {
        // Where the emitter is at the birth: a direction turns within an interval as places move.
        let placed = placements[0].toward(&placements[1], time);
        let ends = |local: Vec3| placements.map(|placement| placement.point(local));
        let at = |[from, to]: [Vec3; 2], offset: Vec3, velocity: Vec3| Start {
            position: from + (to - from) * time + offset,
            velocity,
            carried: (to - from) / seconds,
        };
        match self {
            Self::Point(shape) => {
                let direction = shape.direction(random, &placed);
                let distance = random.between(shape.distance[0], shape.distance[1]);
                let velocity = direction * shape.speed.draw(random);
                Some(at(ends(Vec3::zeros()), direction * distance, velocity))
            }
            Self::Volume(shape) => {
                let place = shape.place(random);
                let velocity = shape.velocity(place, random, &placed);
                Some(at(ends(place + shape.offset), Vec3::zeros(), velocity))
            }
            Self::Surface(patches) => patches.draw(time, seconds, random),
            Self::Curve(curve) => curve.draw(time, seconds, random),
            Self::Nothing => None,
        }
    }
}

/// Least angle that particles fan out by, in degrees: balls and liquids that follow each other along one line could never leave
/// it, and would stack up without end.
const MIN_HALF_ANGLE: f64 = 5e-3;

/// An omni or directional emitter.
pub(super) struct PointShape {
    /// `None` for all directions.
    axis: Option<Vec3>,
    /// Half of the angle that particles fan out by, in degrees.
    half_angle: f64,
    /// The nearest and the farthest that they begin.
    distance: [f64; 2],
    speed: Speed,
}

impl PointShape {
    pub(super) fn new(emitter: NodeId, is_omni: bool, moment: &EvalContext) -> Self {
        let get = |key| moment.get(emitter, key);
        let axis = Vec3::from(moment.get(emitter, &point_emitter::DIRECTION));
        let least = get(&point_emitter::MIN_DISTANCE).max(0.0);
        Self {
            axis: (!is_omni).then_some(axis),
            half_angle: if is_omni {
                180.0
            } else {
                (90.0 * get(&point_emitter::SPREAD)).max(MIN_HALF_ANGLE)
            },
            distance: [least, get(&point_emitter::MAX_DISTANCE).max(least)],
            speed: Speed::new(emitter, moment),
        }
    }

    fn direction(&self, random: &mut Random, placement: &Affine) -> Vec3 {
        let drawn = random.direction(self.half_angle);
        match self.axis {
            None => drawn,
            Some(axis) => turned_to(placement.linear * axis, drawn),
        }
    }
}

/// `volumeShape` of an emitter.
const CUBE: Choice = Choice(0);
const SPHERE: Choice = Choice(1);
const CYLINDER: Choice = Choice(2);
const CONE: Choice = Choice(3);

/// A volume emitter. Its volume reaches from -1 to 1 in the emitter's space; round ones turn about y.
pub(super) struct VolumeShape {
    shape: Choice,
    offset: Vec3,
    sweep: f64,
    section: f64,
    from_center: f64,
    from_axis: f64,
    along_axis: f64,
    around_axis: f64,
    random_direction: f64,
    directional: Vec3,
    scales_speed: bool,
    speed: Speed,
}

impl VolumeShape {
    pub(super) fn new(emitter: NodeId, moment: &EvalContext) -> Self {
        let get = |key| moment.get(emitter, key);
        let direction = Vec3::from(moment.get(emitter, &point_emitter::DIRECTION));
        let unit = direction.try_normalize(0.0).unwrap_or_default();
        Self {
            shape: moment.get(emitter, &point_emitter::VOLUME_SHAPE),
            offset: Vec3::from(moment.get(emitter, &point_emitter::VOLUME_OFFSET)),
            sweep: get(&point_emitter::VOLUME_SWEEP),
            section: get(&point_emitter::SECTION_RADIUS),
            from_center: get(&point_emitter::AWAY_FROM_CENTER),
            from_axis: get(&point_emitter::AWAY_FROM_AXIS),
            along_axis: get(&point_emitter::ALONG_AXIS),
            around_axis: get(&point_emitter::AROUND_AXIS),
            random_direction: get(&point_emitter::RANDOM_DIRECTION),
            directional: unit * get(&point_emitter::DIRECTIONAL_SPEED),
            scales_speed: moment.get(emitter, &point_emitter::SCALE_SPEED_BY_SIZE),
            speed: Speed::new(emitter, moment),
        }
    }

    /// A place inside, evenly spread.
    fn place(&self, random: &mut Random) -> Vec3 {
        if self.is_torus() {
            return self.place_in_torus(random);
        }
        // Rejection needs neither roots nor arcs; a bounding box is at worst a quarter full.
        for _ in 0..64 {
            let place: Vec3 = Vec3::from_fn(|_, _| random.between(-1.0, 1.0));
            if self.contains(place) {
                return self.swept(place, random);
            }
        }
        Vec3::zeros()
    }

    /// A place in a ring of radius 1: in its section by rejection, more often outside than inside of the ring, at any angle.
    fn place_in_torus(&self, random: &mut Random) -> Vec3 {
        let section = self.section.abs();
        let mut place = Vec3::x();
        for _ in 0..64 {
            let [out, up] = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
            let across = 1.0 + section * out;
            let is_inside = out * out + up * up <= 1.0 && across >= 0.0;
            if is_inside && random.between(0.0, 1.0 + section) <= across {
                place = Vec3::new(across, section * up, 0.0);
                break;
            }
        }
        let (sin, cos) = sin_cos_degrees(random.between(0.0, self.sweep.min(360.0)));
        Vec3::new(place.x * cos, place.y, place.x * sin)
    }

    fn contains(&self, place: Vec3) -> bool {
        let across = (place.x * place.x + place.z * place.z).sqrt();
        match self.shape {
            CUBE => true,
            SPHERE => place.norm_squared() <= 1.0,
            CYLINDER => across <= 1.0,
            // The tip is at the bottom, the base of radius 1 at the top.
            CONE => across <= (place.y + 1.0) / 2.0,
            _ => false,
        }
    }

    fn is_torus(&self) -> bool {
        ![CUBE, SPHERE, CYLINDER, CONE].contains(&self.shape)
    }

    /// A place in the part of a round volume that `volumeSweep` leaves.
    fn swept(&self, place: Vec3, random: &mut Random) -> Vec3 {
        if self.shape == CUBE || self.sweep >= 360.0 {
            return place;
        }
        let across = (place.x * place.x + place.z * place.z).sqrt();
        let (sin, cos) = sin_cos_degrees(random.between(0.0, self.sweep));
        Vec3::new(across * cos, place.y, across * sin)
    }

    /// The velocity of a particle that begins at a place, in world space.
    fn velocity(&self, place: Vec3, random: &mut Random, placement: &Affine) -> Vec3 {
        let unit = |v: Vec3| v.try_normalize(0.0).unwrap_or_default();
        let from_axis = unit(Vec3::new(place.x, 0.0, place.z));
        let outward = match self.shape {
            CUBE | SPHERE => unit(place) * self.from_center,
            _ => from_axis * self.from_axis,
        };
        let own = outward
            + Vec3::y() * self.along_axis
            + Vec3::y().cross(&from_axis) * self.around_axis
            + random.direction(180.0) * self.random_direction
            + self.directional;
        let turned = if self.scales_speed { placement.linear * own } else { rotation(placement) * own };
        turned * self.speed.draw(random)
    }
}

/// The rotation of a placement, without its scale.
fn rotation(placement: &Affine) -> Matrix3<f64> {
    let columns = [0, 1, 2].map(|k| placement.linear.column(k).try_normalize(0.0).unwrap_or_default());
    Matrix3::from_columns(&columns)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(shape: i32) -> VolumeShape {
        VolumeShape {
            shape: Choice(shape),
            offset: Vec3::zeros(),
            sweep: 360.0,
            section: 0.25,
            from_center: 1.0,
            from_axis: 1.0,
            along_axis: 0.0,
            around_axis: 0.0,
            random_direction: 0.0,
            directional: Vec3::zeros(),
            scales_speed: false,
            speed: Speed::constant(1.0),
        }
    }

    #[test]
    fn volumes_are_filled_evenly_up_to_their_edge() {
        // Share of the places in the upper half, and the mean square distance from the axis, of each solid.
        let solids =
            [(0, 0.5, 2.0 / 3.0), (1, 0.5, 0.4), (2, 0.5, 0.5), (3, 0.875, 0.3), (4, 0.5, 1.046_875)];
        for (shape, upper, square) in solids {
            let (volume, mut random) = (volume(shape), Random::new([7, 0, shape as u64]));
            let places: Vec<Vec3> = (0..40_000).map(|_| volume.place(&mut random)).collect();
            let share = places.iter().filter(|p| p.y > 0.0).count() as f64 / places.len() as f64;
            assert!((share - upper).abs() < 0.01, "{shape}: {share}");
            let mean = places.iter().map(|p| p.x * p.x + p.z * p.z).sum::<f64>() / places.len() as f64;
            assert!((mean / square - 1.0).abs() < 0.01, "{shape}: {mean}");
        }
    }

    #[test]
    fn a_thin_ring_is_filled_evenly_and_at_the_angles_of_its_sweep() {
        for (section, sweep) in [(0.01, 360.0), (0.0, 360.0), (1e-9, 90.0)] {
            let ring = VolumeShape { section, sweep, ..volume(4) };
            let mut random = Random::new([7, 1, 0]);
            let places: Vec<Vec3> = (0..4000).map(|_| ring.place(&mut random)).collect();
            for place in &places {
                let across = (place.x * place.x + place.z * place.z).sqrt();
                assert!(((across - 1.0).powi(2) + place.y * place.y).sqrt() <= section + 1e-12, "{place}");
                assert!(sweep == 360.0 || place.x >= 0.0 && place.z >= 0.0);
            }
            let mean = places.iter().sum::<Vec3>() / places.len() as f64;
            let expected = if sweep == 360.0 { 0.0 } else { std::f64::consts::FRAC_2_PI };
            assert!((mean.x - expected).abs() < 0.05 && (mean.z - expected).abs() < 0.05, "{mean}");
        }
    }

    #[test]
    fn a_direction_is_turned_with_its_length() {
        for axis in [Vec3::x(), -Vec3::z(), Vec3::new(1.0, 2.0, -3.0)] {
            assert!((turned_to(axis, Vec3::z()) - axis.normalize()).norm() < 1e-12);
            let any = Vec3::new(0.3, -0.4, 0.5);
            assert!((turned_to(axis, any).norm() - any.norm()).abs() < 1e-12);
        }
    }
}
