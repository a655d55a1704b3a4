//! A run that is saved at any frame and resumed has the same bits as a run that never stopped.

use nucleus_core::{ColliderId, ContactState, Real, RestoreError, StepReport};
use nucleus_graph::Simulation;
use nucleus_graph::compile::Program;
use nucleus_tests::gallery::program_of;

/// The results of a run, frame by frame.
struct Run {
    hashes: Vec<Vec<u64>>,
    reports: Vec<StepReport>,
    saved: Vec<Vec<u8>>,
    /// What observers see of contact, from the start on.
    contacts: Vec<Vec<Vec<ContactState>>>,
}

fn contacts<R: Real>(simulation: &Simulation<R>) -> Vec<Vec<ContactState>> {
    let mut states = Vec::new();
    simulation.state().contacts(&mut states);
    states
}

/// Advances by `frames` frames.
fn run<R: Real>(simulation: &mut Simulation<R>, frames: usize) -> Run {
    let (saved, contacts_at_start) = (vec![simulation.save()], vec![contacts(simulation)]);
    let mut run = Run { hashes: Vec::new(), reports: Vec::new(), saved, contacts: contacts_at_start };
    for _ in 0..frames {
        run.reports.push(simulation.advance(&mut ()).report);
        run.hashes.push(simulation.solvers().map(|solver| solver.state_hash()).collect());
        run.saved.push(simulation.save());
        run.contacts.push(contacts(simulation));
    }
    run
}

/// Stops at every `every`th frame and resumes on another number of threads. Returns the whole run.
fn assert_resumes<R: Real>(name: &str, program: &Program, frames: usize, every: usize) -> Run {
    let whole = run::<R>(&mut Simulation::new(program, 1), frames);
    for stop in (0..frames).step_by(every) {
        let threads = 1 + stop % 2;
        let mut simulation = Simulation::<R>::restored(program, threads, &whole.saved[stop])
            .unwrap_or_else(|error| panic!("{name}, frame {stop}: {error}"));
        assert!(
            simulation.save() == whole.saved[stop],
            "{name}: a restored checkpoint of frame {stop} saves to the same bytes"
        );
        // Three frames suffice to show a missing field.
        let further = (frames - stop).min(3);
        let rest = run(&mut simulation, further);
        assert_eq!(rest.hashes, whole.hashes[stop..stop + further], "{name}, stopped after {stop} frames");
        assert!(rest.reports == whole.reports[stop..stop + further], "{name}: reports after {stop} frames");
        assert!(
            rest.contacts == whole.contacts[stop..=stop + further],
            "{name}: contacts after {stop} frames"
        );
        assert!(rest.saved[further] == whole.saved[stop + further], "{name}: saved after {stop} frames");
    }
    whole
}

/// With both precisions and both resistance models.
fn assert_resumes_always(name: &str, nodes: &str, frames: usize) -> Run {
    let classic = nodes.replacen("nucleus(", "nucleus(resistanceModel: classic, ", 1);
    let classic = classic.replacen(", evaluations: 48", "", 1);
    assert_resumes::<f32>(&format!("{name}, classic"), &program_of(&classic), frames, 3);
    assert_resumes::<f64>(&format!("{name}, f64"), &program_of(nodes), frames, 3);
    assert_resumes::<f32>(name, &program_of(nodes), frames, 1)
}

/// Whether a figure is above zero in some frame.
fn ever(run: &Run, figure: impl Fn(&StepReport) -> u64) -> bool {
    run.reports.iter().any(|report| figure(report) > 0)
}

#[test]
fn a_cloth_in_the_wind_resumes_with_the_same_bits() {
    let nodes = r#""n": nucleus(subSteps: 2, windSpeed: 3),
        "p": polyPlane(width: 2, height: 1, subdivisions: (9, 5), ty: 5, rx: 30),
        "c": nCloth(inputMesh: "p", thickness: 0.01, drag: 0.1, lift: 0.1, damp: 0.2),
        "k": dynamicConstraint(constraintType: transform, components: ["c.vtx[0:3]"],
            ty: keys([(1, 0), (9, 1)]), enable: keys([(1, true), (9, false), (12, true)]))"#;
    assert_resumes_always("wind", nodes, 14);
}

#[test]
fn cloth_in_contact_with_a_moving_collider_resumes_with_the_same_bits() {
    // The ball moves, rests while the cloth lies on it and on the ground, and moves on. Candidate pairs are searched,
    // reused, and searched again.
    let nodes = r#""n": nucleus(spaceScale: 0.01, usePlane: true, evaluations: 48),
        "p": polyPlane(width: 60, height: 60, subdivisions: (9, 9), ty: 26),
        "c": nCloth(inputMesh: "p", thickness: 1, friction: 0.3, bounce: 0.3, bendResistance: 0.1),
        "b": polySphere(radius: 20, subdivisions: (12, 8), ty: 2,
            tx: keys([(1, -30), (6, 0), (16, 0), (20, 25)])),
        "r": nRigid(inputMesh: "b", friction: 0.2, collide: keys([(1, true), (21, false)]))"#;
    let run = assert_resumes_always("moving ball", nodes, 24);
    assert!(ever(&run, |report| report.contacts));
}

#[test]
fn contacts_of_a_resumed_run_stay_while_the_nucleus_is_off() {
    let nodes = r#""n": nucleus(enable: keys([(1, true), (8, false), (14, true)]), evaluations: 48),
        "m": polyPlane(width: 1, height: 1, subdivisions: (4, 4), translateY: 0.05), "c": nCloth(inputMesh: "m", thickness: 0.01),
        "bm": polyPlane(width: 5, height: 5, subdivisions: (4, 4)), "b": nRigid(inputMesh: "bm", thickness: 0.02)"#;
    let run = assert_resumes_always("switched off", nodes, 15);
    let touches =
        |states: &Vec<Vec<ContactState>>| states[0].iter().any(|state| *state != ContactState::Free);
    assert!(run.contacts[7..13].iter().all(touches), "the sheet lies on the plane");
}

#[test]
fn colliders_of_a_resumed_run_follow_their_keys_while_the_nucleus_is_off() {
    let place = |simulation: &Simulation<f32>| {
        let (mut points, mut moved) = (Vec::new(), Vec::new());
        for id in [0, 1].map(ColliderId) {
            simulation.state().collider_positions(id, 1.0, &mut points);
            moved.push((points.clone(), simulation.state().collider_moved(id)));
        }
        moved
    };
    let program = program_of(
        r#""n": nucleus(enable: keys([(1, true), (8, false), (14, true)])), "w": nucleus(startFrame: 12),
        "p": nParticle(position0: [(5, 5, 5)], nucleus: "n"), "q": nParticle(position0: [(5, 5, 5)], nucleus: "w"),
        "bm": polyPlane(translateY: keys([(1, 0), (20, 3)])),
        "b": nRigid(inputMesh: "bm", nucleus: "n"), "d": nRigid(inputMesh: "bm", nucleus: "w")"#,
    );
    let mut simulation = Simulation::<f32>::new(&program, 1);
    for frame in 1..20 {
        let mut resumed =
            Simulation::<f32>::restored(&program, 1, &simulation.save()).expect("the same program");
        let places =
            |places: Vec<(Vec<[f32; 3]>, bool)>| places.into_iter().map(|one| one.0).collect::<Vec<_>>();
        assert_eq!(places(place(&resumed)), places(place(&simulation)), "frame {frame}");
        simulation.advance(&mut ());
        resumed.advance(&mut ());
        assert_eq!(place(&resumed), place(&simulation), "after frame {frame}");
    }
}

/// A sheet that falls on its edge and folds on the floor.
fn folded(more: &str) -> String {
    format!(
        r#""n": nucleus(spaceScale: 0.01, usePlane: true, evaluations: 48),
        "p": polyPlane(width: 10, height: 60, subdivisions: (3, 20), ty: 32, rx: 88),
        "c": nCloth(inputMesh: "p", thickness: 0.8, friction: 0.2, bendResistance: 0.02,
            selfCollide: true, selfCollisionFlag: "Full Surface", {more})"#
    )
}

#[test]
fn cloth_in_self_contact_resumes_with_the_same_bits() {
    let run = assert_resumes_always("fold", &folded(""), 30);
    assert!(run.reports.iter().any(|report| report.min_cloth_gap.is_finite()), "there is self-contact");
}

#[test]
fn self_contact_that_is_keyed_off_and_on_resumes_with_the_same_bits() {
    let keyed =
        folded("").replace("selfCollide: true", "selfCollide: keys([(1, true), (18, false), (24, true)])");
    assert_resumes_always("keyed fold", &keyed, 28);
}

#[test]
fn cloth_that_is_compressed_and_released_resumes_with_the_same_bits() {
    let nodes = r#""n": nucleus(spaceScale: 0.01, evaluations: 48),
        "p": polyPlane(width: 30, height: 30, subdivisions: (6, 6), ty: 50, rx: 90),
        "c": nCloth(inputMesh: "p", thickness: 0.5, selfCollide: true, selfCollisionFlag: "Full Surface"),
        "k": dynamicConstraint(constraintType: transform, components: ["c.vtx[42:48]"]),
        "a": polyCube(width: 16, height: 12, depth: 8, subdivisions: (3, 3, 2), ty: 46, tz: keys([(1, 12), (6, 3), (9, 3), (12, 14)])),
        "ra": nRigid(inputMesh: "a", thickness: 0.3),
        "b": polyCube(width: 16, height: 12, depth: 8, subdivisions: (3, 3, 2), ty: 45, tx: 1, tz: keys([(1, -12), (6, -3), (9, -3), (12, -14)])),
        "rb": nRigid(inputMesh: "b", thickness: 0.3)"#;
    // The boxes leave no room for the cloth.
    let run = assert_resumes_always("pinch", nodes, 15);
    assert!(ever(&run, |report| report.depenetrating), "points are inside a collider");
    assert!(ever(&run, |report| report.pairs_unresolved), "pairs stay unresolved");
}

#[test]
fn sheets_that_are_being_untangled_resume_with_the_same_bits() {
    let nodes = r#""n": nucleus(spaceScale: 0.01, usePlane: true, evaluations: 48),
        "p": polyPlane(width: 40, height: 40, subdivisions: (9, 9), ty: 30),
        "c": nCloth(inputMesh: "p", thickness: 0.5, selfCollide: true, selfCollisionFlag: "Full Surface"),
        "q": polyPlane(width: 40, height: 40, subdivisions: (9, 9), ty: 31, rx: 8, ry: 20),
        "d": nCloth(inputMesh: "q", thickness: 0.5, collisionLayer: 0.5, selfCollide: true, selfCollisionFlag: "Full Surface")"#;
    let run = assert_resumes_always("tangle", nodes, 24);
    assert!(ever(&run, |report| report.intersections), "the sheets intersect");
}

#[test]
fn several_nuclei_resume_with_the_same_bits() {
    let nodes = r#""n": nucleus(spaceScale: 0.01, usePlane: true, evaluations: 48),
        "m": nucleus(subSteps: 2, startFrame: 4, enable: keys([(1, true), (8, false), (10, true)])),
        "p": polyPlane(width: 40, height: 40, subdivisions: (6, 6), ty: 10),
        "c": nCloth(inputMesh: "p", nucleus: "n", thickness: 0.5),
        "q": polyPlane(width: 4, height: 4, subdivisions: (6, 6), ty: 3),
        "d": nCloth(inputMesh: "q", nucleus: "m", thickness: 0.05),
        "k": dynamicConstraint(constraintType: transform, components: ["d.vtx[0:2]"], ty: keys([(1, 0), (9, 2)])),
        "b": polySphere(radius: 1, subdivisions: (8, 6)),
        "r": nRigid(inputMesh: "b", nucleus: "m")"#;
    assert_resumes_always("two nuclei", nodes, 16);
}

#[test]
fn vertex_and_edge_contact_resumes_with_the_same_bits() {
    let nodes = r#""n": nucleus(usePlane: true, evaluations: 48),
        "p": polyPlane(width: 2, height: 2, subdivisions: (5, 5), ty: 0.4),
        "c": nCloth(inputMesh: "p", thickness: 0.1, collisionFlag: "Vertex", selfCollide: true, selfCollisionFlag: "Vertex"),
        "q": polyPlane(width: 2, height: 2, subdivisions: (5, 5), ty: 0.9, ry: 30),
        "d": nCloth(inputMesh: "q", thickness: 0.1, collisionFlag: "Edge")"#;
    assert_resumes_always("points and edges", nodes, 16);
}

#[test]
fn damaged_checkpoints_are_refused_and_never_panic() {
    let program = program_of(&folded(""));
    let mut simulation = Simulation::<f32>::new(&program, 1);
    (0..16).for_each(|_| {
        simulation.advance(&mut ());
    });
    let sound = simulation.save();
    let restored = |bytes: &[u8]| Simulation::<f32>::restored(&program, 1, bytes).map(|_| ());
    assert_eq!(restored(&sound), Ok(()));
    for at in (0..sound.len()).step_by(sound.len() / 500) {
        let mut damaged = sound.clone();
        damaged[at] ^= 1 << (at % 8);
        assert_eq!(restored(&damaged), Err(RestoreError::Damaged), "byte {at}");
        assert_eq!(restored(&sound[..at]), Err(RestoreError::Damaged), "{at} bytes");
    }
}

#[test]
fn a_checkpoint_of_other_objects_or_another_precision_is_refused_by_name() {
    let program = program_of(&folded(""));
    let saved = Simulation::<f32>::new(&program, 1).save();
    let finer = program_of(&folded("").replace("(3, 20)", "(3, 21)"));
    let restored = Simulation::<f32>::restored(&finer, 1, &saved).map(|_| ());
    assert_eq!(restored, Err(RestoreError::OtherModel));
    let restored = Simulation::<f64>::restored(&program, 1, &saved).map(|_| ());
    assert_eq!(restored, Err(RestoreError::Scalar { found: 32, wanted: 64 }));
    assert_eq!(Simulation::<f32>::restored(&program, 1, &[]).map(|_| ()), Err(RestoreError::Damaged));
}
