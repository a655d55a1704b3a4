//! Links to particles that are born and die.

use crate::scenes::links::{PHYSICAL, point, tied};
use crate::scenes::{Vec3, still};
use nucleus_core::{
    Birth, COUNT_PERIOD, Cloth, ClothFrame, ClothId, ClothLists, ConstraintFrame, FrameInput, Link,
    LinkMethod, LinkSide, Mass, ModelBuilder, Particles, Solver, StateView, Surface,
};
use proptest::prelude::*;

/// Room for particles, of which some are there at the start, each with a lifespan; and a single point beside them.
fn model(capacity: usize, first: &[Vec3], lifespans: &[f64], other: Vec3) -> ModelBuilder {
    let of = |positions: Vec<Vec3>| Surface { positions, ..Surface::default() };
    let mut builder = ModelBuilder::new();
    let particles = Some(Particles { capacity, lifespans: lifespans.to_vec(), ..Particles::default() });
    let cloth = Cloth::new(of(first.to_vec()), Mass::PerPoint(1.0), ClothLists::NONE);
    builder.cloth(Cloth { particles, ..cloth }).expect("valid particles");
    builder.cloth(Cloth::new(of(vec![other]), Mass::PerPoint(1.0), ClothLists::NONE)).expect("a point");
    builder
}

/// Frames without gravity, in which links are formed in the first.
fn linked(links: Vec<Link>, method: LinkMethod) -> FrameInput {
    let constraint = ConstraintFrame { formed: Some(links), method, ..ConstraintFrame::default() };
    let cloth = ClothFrame { collide: false, ..still() };
    FrameInput { gravity: Vec3::zeros(), cloths: vec![cloth; 2], ..tied(2, PHYSICAL, constraint) }
}

fn step(solver: &mut Solver<f32>, input: &mut FrameInput) {
    solver.step(input, &mut ());
    input.constraints[0].formed = None;
    input.births.clear();
}

fn particles(solver: &Solver<f32>) -> Vec<Vec3> {
    let mut out = Vec::new();
    solver.positions(ClothId(0), 1.0, &mut out);
    out.into_iter().map(|p| Vec3::from(p.map(f64::from))).collect()
}

#[test]
fn a_link_follows_its_particle_when_others_die_and_goes_with_it() {
    let first: Vec<Vec3> = (0..4).map(|k| Vec3::x() * f64::from(k)).collect();
    let lifespans = [0.1, f64::INFINITY, 0.3, f64::INFINITY];
    for method in [LinkMethod::Weld, LinkMethod::Spring] {
        for can_break in [false, true] {
            let mut solver = Solver::<f32>::new(model(4, &first, &lifespans, Vec3::new(2.0, 1.0, 0.0)), 1);
            // The third particle hangs on the other object, the last on a place in space.
            let to_other = Link::new([point(0, 2), point(1, 0)], 1.0);
            let to_space = Link::new([point(0, 3), LinkSide::Space(first[3])], 0.0);
            let mut input = linked(vec![to_other, to_space], method);
            input.constraints[0].can_break = can_break;
            input.gravity = -Vec3::y();
            let mut apart = Vec::new();
            for _ in 0..24 {
                step(&mut solver, &mut input);
                let living = particles(&solver);
                // The last particle stays, whatever its number is now.
                let last = living[living.len() - 1];
                assert!((last - first[3]).norm() < 1e-3, "{method:?}: {last:?} of {}", living.len());
                if living.len() == 3 {
                    apart.push((living[1] - solver.point(ClothId(1), 0)).norm());
                }
            }
            assert!(apart.len() > 3 && apart.iter().all(|apart| (apart - 1.0).abs() < 1e-3), "{apart:?}");
            // Nothing holds the other object any more, and nothing pulls it aside.
            let other = solver.point(ClothId(1), 0);
            assert!(
                other.y < 0.75 && (other.x - 2.0).abs() < 1e-3 && particles(&solver).len() == 2,
                "{other:?}"
            );
        }
    }
}

#[test]
fn glue_breaks_in_a_substep_in_which_other_particles_die() {
    // One of them dies in each of the substeps of the first four frames, or none.
    for dies in [false, true] {
        let first: Vec<Vec3> = (0..9).map(|k| Vec3::x() * f64::from(k)).collect();
        let lifespan = |k: u32| if dies { f64::from(k) * COUNT_PERIOD / 2.0 } else { f64::INFINITY };
        let mut lifespans: Vec<f64> = (1..9).map(lifespan).collect();
        lifespans.insert(0, f64::INFINITY);
        let mut solver = Solver::<f32>::new(model(9, &first, &lifespans, Vec3::y()), 1);
        let hold = Link::new([point(0, 0), LinkSide::Space(first[0])], 0.0);
        let mut input = linked(vec![Link { glue: 0.01, ..hold }], LinkMethod::Weld);
        input.constraints[0].can_break = true;
        input.gravity = -10.0 * Vec3::y();
        (0..4).for_each(|_| step(&mut solver, &mut input));
        // It weighs ten newtons, and the glue carries one per metre.
        assert!(particles(&solver)[0].y < -0.05, "{dies}: {:?}", particles(&solver));
    }
}

#[test]
fn a_particle_that_is_born_after_the_first_frame_can_be_linked() {
    for capacity in [3, 5000] {
        let mut solver = Solver::<f32>::new(model(capacity, &[], &[], Vec3::new(0.0, 2.0, 0.0)), 2);
        let mut input = linked(Vec::new(), LinkMethod::Weld);
        let count = capacity.min(3000);
        let birth = |k: usize| Birth {
            cloth: ClothId(0),
            time: 0.5,
            position: Vec3::x() * k as f64,
            velocity: Vec3::zeros(),
            lifespan: f64::INFINITY,
        };
        input.births = (0..count).map(birth).collect();
        step(&mut solver, &mut input);
        let last = count as u32 - 1;
        let link = Link::new([point(0, last), LinkSide::Space(Vec3::x() * f64::from(last))], 0.0);
        input.constraints[0].formed = Some(vec![link]);
        input.gravity = -Vec3::y();
        (0..4).for_each(|_| step(&mut solver, &mut input));
        let places = particles(&solver);
        assert!(places[count - 2].y < -0.005 && places[count - 1].y.abs() < 1e-5, "{capacity}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn a_linked_particle_has_the_same_path_whoever_dies_beside_it(
        lifespans in proptest::collection::vec(0.01..0.4f64, 1..20),
        at in 0..20usize,
    ) {
        let at = at % (lifespans.len() + 1);
        let places: Vec<Vec3> = (0..=lifespans.len()).map(|k| Vec3::new(k as f64, 0.0, 0.0)).collect();
        let mut dying = lifespans.clone();
        dying.insert(at, f64::INFINITY);
        let run = |lifespans: &[f64]| {
            let mut solver = Solver::<f32>::new(model(places.len(), &places, lifespans, Vec3::y()), 1);
            let anchor = LinkSide::Space(places[at] + Vec3::y() * 0.5);
            let mut input = linked(vec![Link::new([point(0, at as u32), anchor], 0.4)], LinkMethod::Spring);
            (0..12).map(|_| {
                step(&mut solver, &mut input);
                let living = particles(&solver);
                *living.iter().find(|place| (place.x - places[at].x).abs() < 0.1).expect("it lives")
            }).collect::<Vec<Vec3>>()
        };
        let alone = run(&vec![f64::INFINITY; places.len()]);
        let beside = run(&dying);
        prop_assert!(alone[11].y.abs() > 1e-4);
        for (a, b) in alone.iter().zip(&beside) {
            prop_assert!((a - b).norm() < 1e-6, "{a:?} and {b:?}");
        }
    }
}
