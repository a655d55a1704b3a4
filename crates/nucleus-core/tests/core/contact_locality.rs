//! Contact is local: no cloth or collider far away changes a bit of a cloth in contact, and neither does the number of
//! threads. The order of vertices changes rounding and the order of sweeps, and nothing else.

use crate::scenes::{Vec3, frame, grid, physical, sphere, still};
use nucleus_core::{
    Birth, Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, Elements, FrameInput, Mass,
    ModelBuilder, Particles, Pin, PointId, PushOut, SelfCollision, Solver, StateView, Surface,
};
use proptest::prelude::*;

const THICKNESS: f64 = 0.004;
const FRAMES: usize = 6;

/// A sheet that lies on a ball from the first frame on, and a second sheet that lies on it.
#[derive(Debug, Clone)]
struct Heap {
    points: u32,
    sheets: usize,
    place: Vec3,
    slope: f64,
    friction: f64,
    /// Velocity of the ball in m/s.
    ball: Vec3,
    /// Whether its sheets are in free flight high above the ball, drawn out by 2 %.
    flies: bool,
    /// Whether its second sheet starts through the first.
    is_tangled: bool,
    /// Whether pins carry its second sheet through the first, which they hold.
    is_forced: bool,
}

fn heaps() -> impl Strategy<Value = Heap> {
    let place = proptest::array::uniform3(-0.02..0.02f64);
    (6u32..14, 1usize..3, place, -0.1..0.1f64, 0.0..0.5f64).prop_map(
        |(points, sheets, place, slope, friction)| Heap {
            points,
            sheets,
            place: place.into(),
            slope,
            friction,
            ball: Vec3::zeros(),
            flies: false,
            is_tangled: false,
            is_forced: false,
        },
    )
}

/// A solver of some heaps, with the settings of all frames but for the motion of balls.
struct Scene {
    heaps: Vec<Heap>,
    builder: ModelBuilder,
    input: FrameInput,
    /// Points that are pinned, their places at the start and their motion in a frame.
    pinned: Vec<(ClothId, PointId, Vec3, Vec3)>,
}

impl Scene {
    fn new(heaps: &[Heap]) -> Self {
        let mut scene = Self {
            heaps: heaps.to_vec(),
            builder: ModelBuilder::new(),
            input: FrameInput { cloths: Vec::new(), ..frame(3, physical(48.0)) },
            pinned: Vec::new(),
        };
        heaps.iter().for_each(|heap| scene.add(heap));
        scene
    }

    fn add(&mut self, heap: &Heap) {
        let lists = ClothLists { stretch: true, bend: true, self_collision: true, ..ClothLists::NONE };
        for sheet in 0..heap.sheets {
            let height =
                0.3 + THICKNESS + 2.0 * THICKNESS * sheet as f64 + if heap.flies { 2.0 } else { 0.0 };
            let slope = if heap.is_tangled && sheet > 0 { heap.slope + 0.3 } else { heap.slope };
            let across = Vec3::new(0.6, 0.6 * slope, 0.0);
            let mut surface = grid(heap.points, heap.points, across, Vec3::z() * 0.6);
            surface.positions.iter_mut().for_each(|p| *p += heap.place + Vec3::new(-0.3, height, -0.3));
            if heap.is_forced {
                let (cloth, motion) =
                    (ClothId(self.input.cloths.len() as u32), Vec3::y() * (-THICKNESS * sheet as f64));
                let points = surface.positions.iter().zip(0..);
                self.pinned.extend(points.map(|(&place, point)| (cloth, PointId(point), place, motion)));
            }
            self.builder.cloth(Cloth::new(surface, Mass::PerArea(0.2), lists)).expect("a good mesh");
            let own =
                SelfCollision { on: true, thickness: THICKNESS, elements: Elements::Faces, edges: true };
            self.input.cloths.push(ClothFrame {
                thickness: THICKNESS,
                friction: heap.friction,
                bend_resistance: 0.1,
                rest_length_scale: if heap.flies { 0.98 } else { 1.0 },
                self_collision: own,
                ..still()
            });
        }
        self.builder.collider(Collider { surface: ball(heap) }).expect("a good mesh");
        let at_rest = ColliderFrame { collide: true, friction: 0.3, ..ColliderFrame::default() };
        self.input.colliders.push(at_rest);
    }

    /// Positions of all points of each cloth after each frame, and the contacts of the run.
    fn run(self, threads: usize) -> (Vec<Vec<Vec<Vec3>>>, u64) {
        let (run, contacts, _) = self.run_and_count(threads, |_, _| ());
        (run, contacts)
    }

    /// The same, and the number of pairs that stayed unresolved. `change` changes the input of a frame.
    fn run_and_count(
        self,
        threads: usize,
        mut change: impl FnMut(usize, &mut FrameInput),
    ) -> (Vec<Vec<Vec<Vec3>>>, u64, u64) {
        let Self { heaps, builder, mut input, pinned } = self;
        let counts: Vec<usize> =
            heaps.iter().flat_map(|heap| vec![(heap.points * heap.points) as usize; heap.sheets]).collect();
        let mut solver = Solver::<f32>::new(builder, threads);
        let (mut contacts, mut unresolved) = (0, 0);
        let mut one = |index: usize| {
            let pin = |&(cloth, point, place, motion): &(_, _, Vec3, Vec3)| {
                let [start, end] = [index, index + 1].map(|frame| place + motion * frame as f64);
                Pin { cloth, point, start, end }
            };
            input.pins = pinned.iter().map(pin).collect();
            for (heap, collider) in heaps.iter().zip(&mut input.colliders) {
                if heap.ball != Vec3::zeros() {
                    let at = |frame: usize| {
                        ball(heap).positions.iter().map(|p| p + heap.ball * (frame as f64 / 24.0)).collect()
                    };
                    (collider.start, collider.end) = (at(index), at(index + 1));
                }
            }
            change(index, &mut input);
            let report = solver.step(&input, &mut ());
            contacts += report.contacts;
            unresolved += report.pairs_unresolved;
            let cloth = |(cloth, &count): (usize, &usize)| {
                (0..count).map(|k| solver.point(ClothId(cloth as u32), k)).collect()
            };
            counts.iter().enumerate().map(cloth).collect()
        };
        ((0..FRAMES).map(&mut one).collect(), contacts, unresolved)
    }
}

fn ball(heap: &Heap) -> Surface {
    sphere(0.3, heap.place)
}

/// The trajectories of some cloths of a run.
fn cloths(run: &[Vec<Vec<Vec3>>], range: std::ops::Range<usize>) -> Vec<Vec<Vec<Vec3>>> {
    run.iter().map(|frame| frame[range.clone()].to_vec()).collect()
}

/// Each of two heaps has the same bits as alone.
fn assert_independent(near: &Heap, far: &Heap) {
    let [near_alone, far_alone] = [near, far].map(|heap| {
        let (run, contacts) = Scene::new(std::slice::from_ref(heap)).run(1);
        assert!(contacts > 0);
        run
    });
    let (both, _) = Scene::new(&[near.clone(), far.clone()]).run(1);
    assert!(cloths(&both, 0..near.sheets) == near_alone, "the far heap changes the near one");
    let all = near.sheets + far.sheets;
    assert!(cloths(&both, near.sheets..all) == far_alone, "the near heap changes the far one");
}

#[test]
fn swept_positions_of_a_heap_are_rounded_without_regard_to_another() {
    // With one origin for all cloths, the far heap has one more candidate.
    let near = Heap {
        points: 11,
        sheets: 1,
        place: Vec3::new(0.012971970725242527, -0.01629957750026366, 0.012218814784586793),
        slope: 0.0013581518377797919,
        friction: 0.2278387771500287,
        ball: Vec3::zeros(),
        flies: false,
        is_tangled: false,
        is_forced: false,
    };
    let place = Vec3::new(0.011588283052915144, 0.0031329756666643106, 0.004312956891376483);
    let far = Heap {
        points: 8,
        sheets: 2,
        place: place + Vec3::new(40.0, 0.0, 3.0),
        slope: -0.041913226335518645,
        friction: 0.3855118859119209,
        ..near.clone()
    };
    assert_independent(&near, &far);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, max_shrink_iters: 0, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn two_heaps_far_apart_do_not_change_a_bit_of_each_other(near in heaps(), far in heaps()) {
        let far = Heap { place: far.place + Vec3::new(40.0, 0.0, 3.0), ..far };
        assert_independent(&near, &far);
    }

    #[test]
    fn a_thicker_heap_does_not_change_a_bit_of_a_thin_one(near in heaps(), far in heaps(), factor in 1.5..20.0f64) {
        let far = Heap { place: far.place + Vec3::new(40.0, 0.0, 3.0), ..far };
        let (alone, contacts) = Scene::new(std::slice::from_ref(&near)).run(1);
        prop_assert!(contacts > 0);
        let mut scene = Scene::new(&[near.clone(), far]);
        for cloth in scene.input.cloths.iter_mut().skip(near.sheets) {
            (cloth.thickness, cloth.self_collision.thickness) = (THICKNESS * factor, THICKNESS * factor);
        }
        let (both, _) = scene.run(1);
        prop_assert!(cloths(&both, 0..near.sheets) == alone);
    }

    #[test]
    fn a_heap_in_contact_does_not_change_a_bit_of_a_sheet_in_flight(near in heaps(), far in heaps()) {
        // A sheet in flight alternates the direction of its sweeps, one in contact does not.
        let flying = Heap { sheets: 1, flies: true, ..near };
        let far = Heap { place: far.place + Vec3::new(40.0, 0.0, 3.0), ..far };
        let (alone, contacts) = Scene::new(std::slice::from_ref(&flying)).run(1);
        prop_assert_eq!(contacts, 0);
        let (both, contacts) = Scene::new(&[flying, far]).run(1);
        prop_assert!(contacts > 0);
        prop_assert!(cloths(&both, 0..1) == alone, "the far heap changes the sheet in flight");
    }

    #[test]
    fn sheets_that_intersect_far_away_do_not_change_a_bit(near in heaps(), far in heaps()) {
        let place = far.place + Vec3::new(40.0, 0.0, 3.0);
        let tangled = Heap { place, sheets: 2, is_tangled: true, ..far };
        let (alone, contacts) = Scene::new(std::slice::from_ref(&near)).run(1);
        prop_assert!(contacts > 0);
        let (both, _) = Scene::new(&[near.clone(), tangled]).run(1);
        prop_assert!(cloths(&both, 0..near.sheets) == alone, "the far tangle changes the near heap");
    }

    #[test]
    fn particles_that_are_born_and_die_far_away_do_not_change_a_bit(near in heaps(), rate in 1..9usize) {
        let (alone, contacts) = Scene::new(std::slice::from_ref(&near)).run(1);
        prop_assert!(contacts > 0);
        let mut scene = Scene::new(std::slice::from_ref(&near));
        let object = ClothId(scene.input.cloths.len() as u32);
        let place = |k: usize| near.place + Vec3::new(40.0, 0.1 * k as f64, 0.0);
        let particles = Particles { capacity: 200, lifespans: vec![0.03, f64::INFINITY, 0.1], ..Particles::default() };
        let surface = Surface { positions: (0..3).map(place).collect(), ..Surface::default() };
        let mut cloth = Cloth::new(surface, Mass::PerPoint(0.01), ClothLists { self_collision: true, ..ClothLists::NONE });
        cloth.particles = Some(particles);
        scene.builder.cloth(cloth).expect("valid particles");
        let own = SelfCollision { on: true, thickness: 0.02, elements: Elements::Points, edges: false };
        scene.input.cloths.push(ClothFrame { thickness: 0.02, self_collision: own, ..still() });
        let born = |k: usize| {
            let time = (k as f64 + 0.5) / rate as f64;
            Birth { cloth: object, time, position: place(k), velocity: Vec3::x(), lifespan: 0.02 * (1 + k % 4) as f64 }
        };
        let (both, _, _) = scene.run_and_count(1, |_, input| input.births = (0..rate).map(born).collect());
        prop_assert!(both == alone);
    }

    #[test]
    fn a_thickness_that_changes_far_away_does_not_change_a_bit(near in heaps(), far in heaps(), share in 0.3..0.9f64) {
        let far = Heap { place: far.place + Vec3::new(40.0, 0.0, 3.0), ..far };
        let (alone, contacts) = Scene::new(std::slice::from_ref(&near)).run(1);
        prop_assert!(contacts > 0);
        let scene = Scene::new(&[near.clone(), far]);
        let (both, _, _) = scene.run_and_count(1, |_, input| {
            let changed = input.cloths.iter_mut().skip(near.sheets);
            changed.for_each(|cloth| (cloth.thickness, cloth.self_collision.thickness) = (cloth.thickness * share, cloth.thickness * share));
        });
        prop_assert!(cloths(&both, 0..near.sheets) == alone);
    }

    #[test]
    fn a_fast_collider_far_away_does_not_change_a_bit(near in heaps(), speed in 1.0..100.0f64) {
        // No cloth lies on the far ball, so that no time step is split.
        let far = Heap { sheets: 0, place: Vec3::new(40.0, 0.0, 3.0), ball: Vec3::new(0.0, 0.6, 0.8) * speed, ..near.clone() };
        let (alone, _) = Scene::new(std::slice::from_ref(&near)).run(1);
        let (both, _) = Scene::new(&[near, far]).run(1);
        prop_assert!(both == alone);
    }

    #[test]
    fn the_order_of_vertices_changes_a_drape_by_less_than_a_hundredth_of_its_size(heap in heaps(), seed: u64) {
        let heap = Heap { sheets: 1, friction: 0.0, ..heap };
        let drape = |permutation: &[u32]| {
            let mut scene = Scene::new(std::slice::from_ref(&heap));
            let surface = grid(heap.points, heap.points, Vec3::new(0.6, 0.6 * heap.slope, 0.0), Vec3::z() * 0.6);
            let place = heap.place + Vec3::new(-0.3, 0.3 + THICKNESS, -0.3);
            let mut positions = surface.positions.clone();
            permutation.iter().zip(&surface.positions).for_each(|(&to, p)| positions[to as usize] = p + place);
            let mut permuted = Surface { positions, ..Surface::default() };
            for face in surface.faces.iter() {
                permuted.faces.push(&face.iter().map(|&k| permutation[k as usize]).collect::<Vec<_>>());
            }
            let lists = ClothLists { stretch: true, bend: true, self_collision: true, ..ClothLists::NONE };
            scene.builder = ModelBuilder::new();
            scene.builder.cloth(Cloth::new(permuted, Mass::PerArea(0.2), lists)).expect("a good mesh");
            scene.builder.collider(Collider { surface: ball(&heap) }).expect("a good mesh");
            let (run, contacts) = scene.run(1);
            assert!(contacts > 0);
            let last = run[FRAMES - 1][0].clone();
            permutation.iter().map(|&k| last[k as usize]).collect::<Vec<Vec3>>()
        };
        let count = heap.points * heap.points;
        let identity: Vec<u32> = (0..count).collect();
        let mut shuffled = identity.clone();
        // Fisher and Yates, by a linear congruential generator.
        let mut state = seed;
        for k in (1..count).rev() {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            shuffled.swap(k as usize, ((state >> 33) % u64::from(k + 1)) as usize);
        }
        let largest = drape(&identity).iter().zip(drape(&shuffled)).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        prop_assert!(largest < 0.006, "{largest} m");
    }
}

// A run of these takes up to two seconds.
proptest! {
    #![proptest_config(ProptestConfig { cases: 3, max_shrink_iters: 0, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn sheets_that_pins_carry_through_each_other_far_away_do_not_change_a_bit(near in heaps(), far in heaps()) {
        let place = far.place + Vec3::new(40.0, 0.0, 3.0);
        let forced = Heap { place, points: 6, sheets: 2, is_forced: true, ..far };
        let (alone, contacts) = Scene::new(std::slice::from_ref(&near)).run(1);
        prop_assert!(contacts > 0);
        let (forced_alone, _, unresolved) = Scene::new(std::slice::from_ref(&forced)).run_and_count(1, |_, _| ());
        prop_assert!(unresolved > 0);
        let (both, _) = Scene::new(&[near.clone(), forced]).run(1);
        prop_assert!(cloths(&both, 0..near.sheets) == alone, "the far pair changes the near heap");
        prop_assert!(cloths(&both, near.sheets..near.sheets + 2) == forced_alone, "the near heap changes the far pair");
    }

    #[test]
    fn a_collider_that_pushes_out_far_away_does_not_change_a_bit(near in heaps(), far in heaps(), share in 0.1..1.0f64) {
        // It starts with cloth inside.
        let slope = -0.1 - far.slope.abs();
        let far = Heap { place: far.place + Vec3::new(40.0, 0.0, 3.0), slope, ..far };
        let [with, without] = [share, 0.0].map(|share| {
            let push_out = PushOut { share, radius: 0.1 };
            let scene = Scene::new(&[near.clone(), far.clone()]);
            scene.run_and_count(1, |_, input| input.colliders[1].push_out = push_out).0
        });
        prop_assert!(with != without);
        prop_assert!(cloths(&with, 0..near.sheets) == cloths(&without, 0..near.sheets));
    }

    #[test]
    fn a_collider_that_arrives_within_the_run_is_found(near in heaps(), speed in 5.0..50.0f64) {
        // It is far in the first frames, and then pushes through the place of the heap.
        let from = near.place + Vec3::x() * (speed * (FRAMES as f64 - 1.5) / 24.0);
        let fast = Heap { sheets: 0, place: from, ball: -Vec3::x() * speed, ..near.clone() };
        let (alone, _) = Scene::new(std::slice::from_ref(&near)).run(1);
        let scene = Scene::new(&[near, fast.clone()]);
        let (both, _) = scene.run(1);
        prop_assert!(both != alone, "it passes without effect");
        let centre = fast.place + fast.ball * (FRAMES as f64 / 24.0);
        let inside = both[FRAMES - 1].iter().flatten().filter(|p| (*p - centre).norm() < 0.3 * crate::scenes::INSCRIBED);
        prop_assert_eq!(inside.count(), 0);
    }

    #[test]
    fn heaps_in_contact_have_the_same_bits_on_any_number_of_threads(heap in heaps()) {
        // More than one block of points.
        let heap = Heap { points: heap.points + 30, ..heap };
        let (one, _) = Scene::new(std::slice::from_ref(&heap)).run(1);
        let (three, _) = Scene::new(std::slice::from_ref(&heap)).run(3);
        prop_assert!(one == three);
    }
}
