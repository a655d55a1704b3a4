use std::path::Path;

use nalgebra::Vector3;
use nucleus_core::{
    BendSolver, Bending, ClothFrame, ClothId, ColliderFrame, Elements, FieldSide, ForceField, FrameInput,
    InputAttract, PointField, PointId, Pressure, PushOut, ResistanceModel, SelfCollision, Stiffness,
    WindField,
};
use proptest::prelude::*;

use super::*;
use crate::attributes::{NodeType, Value, n_base, n_cloth, n_rigid, nucleus, particle};
use crate::graph::Setting;
use crate::scene::{Record, read_scene_text};

mod attachments;
mod budget;
mod no_effect;

/// A scene of these nodes, over frames 1 to 24.
fn scene(nodes: &str) -> Scene {
    let text = format!("Scene(time: (start: 1, end: 24, fps: 24), nodes: {{{nodes}}})");
    match read_scene_text(&text, Path::new("test.ron")) {
        Ok((scene, _)) => scene,
        Err(diagnostics) => panic!("{diagnostics:#?}"),
    }
}

fn program(nodes: &str) -> Program {
    compile(&scene(nodes)).unwrap_or_else(|diagnostics| panic!("{diagnostics:#?}"))
}

fn refused(nodes: &str) -> String {
    compile(&scene(nodes)).map(|_| ()).expect_err(nodes)[0].message.clone()
}

/// A sheet of four points, 2 m wide.
fn sheet(nucleus: &str, cloth: &str) -> String {
    format!(
        r#""nucleus1": nucleus({nucleus}), "sheet": polyPlane(width: 2, height: 2, subdivisions: (1, 1)),
           "cloth1": nCloth(inputMesh: "sheet", {cloth}),"#
    )
}

/// The model as text, which has every bit of every number in it.
fn model(program: &Program) -> String {
    format!("{:?}", program.model())
}

/// The input of a frame when nothing has moved since the start.
fn input(program: &Program, frame: i64) -> FrameInput {
    let start = |cloth: ClothId, point: PointId| program.model().positions(cloth)[point.index()];
    solved(program, frame, &mut AttachmentState::default(), &start)
}

/// The input of the frame that ends at `frame`.
fn solved(
    program: &Program,
    frame: i64,
    attachments: &mut AttachmentState,
    position: &dyn Fn(ClothId, PointId) -> Vector3<f64>,
) -> FrameInput {
    program.interval(0, [frame - 1, frame].map(|frame| frame as f64), 1.0, false).input(attachments, position)
}

fn lists(cloth: &str) -> String {
    let text = model(&program(&sheet("", cloth)));
    let lists = text.split("ClothLists { ").nth(1).and_then(|rest| rest.split(" }").next());
    lists.expect("a cloth has lists").to_owned()
}

// EVIDENCE: N1.3-1  scene units are read as metres through spaceScale
#[test]
fn lengths_are_scaled_and_accelerations_are_not() {
    let centimetres = program(
        r#""n": nucleus(spaceScale: 0.01, usePlane: true, planeOrigin: (0, -50, 0), windSpeed: 3),
           "p": polyPlane(width: 200, height: 200, translate: (0, 100, 0)),
           "c": nCloth(inputMesh: "p", thickness: 2)"#,
    );
    let input = centimetres.first_input();
    assert_eq!(input.gravity, Vector3::new(0.0, -9.8, 0.0));
    assert_eq!(input.wind, Vector3::new(3.0, 0.0, 0.0));
    assert_eq!(input.plane.map(|plane| plane.origin), Some(Vector3::new(0.0, -0.5, 0.0)));
    assert_eq!(input.cloths[0].thickness, 0.02);
    assert_eq!(centimetres.model().positions(ClothId(0))[0], Vector3::new(-1.0, 1.0, 1.0));
    assert_eq!(centimetres.units_per_metre(), 100.0);
}

// EVIDENCE: N2.2-7  cloth is divided into simple constraint lists, and only into those that it uses
#[test]
fn a_constraint_list_exists_only_if_its_attribute_is_ever_nonzero() {
    let nothing =
        "stretchResistance: 0, compressionResistance: 0, bendResistance: 0, stretchDamp: 0, drag: 0, lift: 0";
    let off = "stretch: false, cross_links: false, shear: false, bend: false, air: false, damp: false, self_collision: true";
    let soft = "bend_angles: false, pressure: false, shape: false, shells: false, plastic: false, tethers: false, \
        long_links: false, buckling: false";
    assert_eq!(lists(nothing), format!("{off}, signed_bend: false, {soft}"));
    let on = "stretch: true, cross_links: true, shear: false, bend: true, air: true, damp: true, self_collision: true";
    assert_eq!(lists(""), format!("{on}, signed_bend: true, {soft}"));
    for (cloth, list) in [
        ("bendResistance: keys([(1, 0), (20, 1)])", "bend: true"),
        ("bendResistance: keys([(1, 0), (20, 0)])", "bend: false"),
        ("shearResistance: 2", "shear: true"),
        ("shearStiffness: 2", "shear: true"),
        ("bendStiffness: 0", "bend: false"),
        ("bendStiffness: keys([(1, 0), (20, 1e-4)])", "bend: true"),
        ("bendResistance: 0, bendStiffness: 1e-5", "bend: true"),
        ("bendResistance: 0, bendStiffness: -1", "bend: false"),
        ("addCrossLinks: false", "cross_links: false"),
        ("weave: true", "cross_links: false"),
        ("buckling: true", "buckling: true"),
        ("stretchResistance: 0", "stretch: true"),
        ("drag: 0", "air: true"),
        ("stretchDamp: 0, damp: 1", "damp: true"),
        ("bendSolver: simple", "signed_bend: false"),
        ("bendAngleDropoff: 0.5", "bend_angles: true"),
        ("bendAngleScale: 0.5", "bend_angles: true"),
        ("restitutionAngle: 90", "bend_angles: true"),
        ("bendSolver: flipTracking", "bend_angles: true"),
        ("pressure: keys([(1, 0), (20, 1)])", "pressure: true"),
        ("pressureMethod: volumeTrackingModel", "pressure: true"),
        ("rigidity: 1", "shape: true, shells: false"),
        ("deformResistance: 1, usePolygonShells: true", "shape: true, shells: true"),
        ("restitutionTension: 999", "plastic: true"),
    ] {
        assert!(lists(cloth).contains(list), "{cloth}: {}", lists(cloth));
    }
}

#[test]
fn a_map_of_the_weave_angle_turns_the_warp_of_the_points_that_it_covers() {
    let woven =
        |angles: &str| model(&program(&sheet("", &format!("weave: true, shearStiffness: 50, {angles}"))));
    assert_eq!(woven("weaveAngle: 90, weaveAnglePerVertex: [0.5, 0.5, 0.5, 0.5]"), woven("weaveAngle: 45"));
    // The mean over the corners of the only face.
    assert_eq!(woven("weaveAngle: 60, weaveAnglePerVertex: [1, 0, 1, 0]"), woven("weaveAngle: 30"));
    assert_ne!(woven("weaveAngle: 30"), woven("weaveAngle: 45"));
}

#[test]
fn there_is_no_air_list_in_a_vacuum() {
    assert!(model(&program(&sheet("airDensity: 0", ""))).contains("air: false"));
}

// EVIDENCE: N2.2-8  a resistance is a count in 1/24 s: it does not depend on the length of a frame
#[test]
fn counts_do_not_depend_on_frame_rate_or_time_scale() {
    let mut scene = scene(&sheet("timeScale: 0.5", "stretchResistance: 30"));
    let at_24 = compile(&scene).expect("valid").first_input();
    scene.time.fps = 48.0;
    let at_48 = compile(&scene).expect("valid").first_input();
    assert_eq!((at_24.duration, at_48.duration), (0.5 / 24.0, 0.5 / 48.0));
    assert_eq!((at_24.cloths[0].stretch_resistance, at_24.collision_iterations), (30.0, 4.0));
    assert_eq!(FrameInput { duration: at_24.duration, ..at_48 }, at_24);
}

#[test]
fn point_mass_is_per_point_in_classic_and_per_area_in_physical() {
    let classic = program(&sheet("resistanceModel: classic", "pointMass: 0.5"));
    assert!(model(&classic).contains("PerPoint(0.5)"));
    assert_eq!((classic.mass(), classic.first_input().resistance), (2.0, ResistanceModel::Classic));
    let physical = program(&sheet("evaluations: 48", "pointMass: 0.5"));
    assert!(model(&physical).contains("PerArea(0.5)"));
    assert_eq!(physical.mass(), 2.0);
    assert_eq!(physical.first_input().resistance, ResistanceModel::Physical { evaluations: 48.0 });
}

#[test]
fn every_attribute_of_cloth_reaches_the_frame_input() {
    let set = "stretchResistance: 1, compressionResistance: 2, shearResistance: 3, bendResistance: 4, \
        restLengthScale: 5, stretchDamp: 6, damp: 7, drag: 8, tangentialDrag: 9, lift: 10, \
        stretchStiffness: 20, compressionStiffness: 21, shearStiffness: 0, bendStiffness: -1, \
        ignoreSolverGravity: true, ignoreSolverWind: true, localForce: (11, 12, 13), localWind: (14, 15, 16), \
        collide: false, thickness: 17, friction: 18, bounce: 19, collisionFlag: Edge, collisionLayer: 20, \
        stickiness: 22, collideStrength: 23, pushOut: 24, pushOutRadius: 25, crossoverPush: 26, \
        selfCrossoverPush: 27, bendAngleScale: 0.5, bendAngleDropoff: 0.25, bendSolver: flipTracking, \
        restitutionAngle: 0, restitutionTension: 2, pressureMethod: volumeTrackingModel, startPressure: 0.1, \
        incompressibility: 2, pumpRate: 0.3, airTightness: 0.4, pressureDamping: 0.5, sealHoles: false, \
        forceField: doubleSided, fieldMagnitude: 3, fieldDistance: 4, rigidity: 28, deformResistance: 29, inputMeshAttract: 30, inputAttractDamp: 31, inputMotionDrag: 32, \
        selfCollide: true, selfCollideWidthScale: 21, selfCollisionFlag: VertexFace, windShadowDistance: 33, \
        windShadowDiffusion: 0.34, windSelfShadow: true, airPushDistance: 35, airPushVorticity: 0.36, \
        pointForceField: worldspace, pointFieldMagnitude: 37, selfAttract: 38, pointFieldDistance: 39, tethers: true, tetherScale: 40, \
        warpStiffness: 41, weftStiffness: 42, buckling: true";
    let expected = ClothFrame {
        stretch_resistance: 1.0,
        compression_resistance: 2.0,
        shear_resistance: 3.0,
        bend_resistance: 4.0,
        stiffness: Stiffness {
            stretch: Some(20.0),
            compression: Some(21.0),
            shear: Some(0.0),
            bend: None,
            warp: Some(41.0),
            weft: Some(42.0),
        },
        buckles: true,
        rest_length_scale: 5.0,
        tethers: Some(40.0),
        stretch_damp: 6.0,
        damp: 7.0,
        drag: 8.0,
        tangential_drag: 9.0,
        lift: 10.0,
        feels_gravity: false,
        feels_wind: false,
        local_force: Vector3::new(11.0, 12.0, 13.0),
        local_wind: Vector3::new(14.0, 15.0, 16.0),
        collide: false,
        is_driven: false,
        thickness: 17.0,
        friction: 18.0,
        stickiness: 22.0,
        bounce: 19.0,
        collide_strength: 23.0,
        push_out: PushOut { share: 24.0, radius: 25.0 },
        crossover_push: 26.0,
        self_crossover_push: 27.0,
        elements: Elements::Edges,
        layer: 20.0,
        self_collision: SelfCollision {
            on: true,
            thickness: 17.0 * 21.0,
            elements: Elements::Faces,
            edges: false,
        },
        bending: Bending {
            angle_scale: 0.5,
            angle_dropoff: 0.25,
            solver: BendSolver::FlipTracking,
            yield_sine: 0.0,
            yield_half_angle: 0.0,
        },
        // Tension 2 of a resistance of 1.
        yield_strain: 2.0,
        pressure: Pressure::Gas {
            start: 0.1,
            bulk: 2000.0,
            pump: 0.3,
            tightness: 0.4,
            damping: 500.0 / 24.0,
            sealed: false,
        },
        rigidity: 28.0,
        deform_resistance: 29.0,
        input_attract: InputAttract { strength: 30.0, damp: 31.0, motion_drag: 32.0 },
        field: Some(ForceField {
            side: FieldSide::Double,
            magnitude: 30.0,
            distance: 4.0,
            falloff: std::array::from_fn(|k| 1.0 - k as f64 / 16.0),
        }),
        point_field: Some(PointField {
            magnitude: 370.0,
            self_attract: 380.0,
            radius: 17.0,
            distance: 39.0,
            falloff: std::array::from_fn(|k| 1.0 - k as f64 / 16.0),
        }),
        liquid: None,
        conserve: 1.0,
        rotation_friction: 0.9,
        rotation_damp: 0.001,
        overlap_pruning: 0.0,
        wind_field: WindField {
            shadow_distance: 33.0,
            shadow_diffusion: 0.34,
            self_shadow: true,
            push_distance: 35.0,
            push_vorticity: 0.36,
        },
    };
    assert_eq!(program(&sheet("", set)).first_input().cloths, [expected]);
}

#[test]
fn a_cloth_without_settings_has_the_defaults_of_the_core() {
    let cloths = program(&sheet("", "")).first_input().cloths;
    let thickness = cloths[0].thickness;
    // The core's defaults leave out thickness and self-collision, which Maya derives from the mesh.
    let self_collision = SelfCollision { on: true, thickness, ..ClothFrame::default().self_collision };
    // Maya's default damp of the attraction, and its signed angles, matter only where there is attraction or a bent mesh.
    let defaults = ClothFrame::default();
    let input_attract = InputAttract { damp: 0.5, ..defaults.input_attract };
    let bending = Bending { solver: BendSolver::Signed, ..defaults.bending };
    assert_eq!(cloths, [ClothFrame { thickness, self_collision, input_attract, bending, ..defaults }]);
    // Two sides of 2 by 2; one face. 0.5 % of sqrt(8).
    assert!((cloths[0].thickness - 0.005 * 8f64.sqrt()).abs() < 1e-15);
}

#[test]
fn a_collider_without_settings_has_the_defaults_of_the_core() {
    let boxed = program(r#""n": nucleus(), "box": polyCube(), "c": nRigid(inputMesh: "box")"#);
    let collider = &boxed.first_input().colliders[0];
    // The core's default collider does not collide, and has neither thickness nor friction.
    let thickness = collider.thickness;
    let expected = ColliderFrame { collide: true, thickness, friction: 0.1, ..ColliderFrame::default() };
    assert_eq!(*collider, expected);
    assert_eq!(n_base::FRICTION.row.default, Some(Value::Float(expected.friction)));
    // Two sides of 1 by 1 in each of three directions; six faces. 0.3 % of sqrt(6).
    assert!((thickness - 0.003 * 6f64.sqrt()).abs() < 1e-15);
}

// EVIDENCE: N2.4-6  animation is evaluated once per frame: a key between two frames has no effect
// EVIDENCE: N2.4-7  inside a frame the solver interpolates between its two ends
#[test]
fn a_collider_moves_from_frame_to_frame() {
    let moving = program(
        r#""n": nucleus(), "arm": transform(tx: keys([(1, 0), (1.5, 9), (2, 2), (4, 2), (5, 4)])),
           "box": polyCube(parent: "arm", translateY: 1), "c": nRigid(inputMesh: "box")"#,
    );
    let end = |frame| input(&moving, frame).colliders[0].end.first().copied();
    assert_eq!(end(2), Some(Vector3::new(1.5, 0.5, 0.5)));
    assert_eq!(end(3), None);
    assert_eq!(end(5), Some(Vector3::new(3.5, 0.5, 0.5)));
}

#[test]
fn a_collider_that_never_moves_has_no_positions() {
    let still = program(
        r#""n": nucleus(), "box": polyCube(tx: 3), "c": nRigid(inputMesh: "box", friction: 0.7, thickness: 1e-3,
            stickiness: 0.2, collideStrength: 0.9, pushOut: -1, trappedCheck: false, collisionFlag: edge,
            collisionLayer: 2)"#,
    );
    let collider = &still.first_input().colliders[0];
    assert!(collider.start.is_empty() && collider.end.is_empty() && collider.collide);
    assert_eq!((collider.friction, collider.stickiness, collider.collide_strength), (0.7, 0.2, 0.9));
    assert_eq!((collider.push_out, collider.trapped_check), (PushOut { share: -1.0, radius: 4e-3 }, false));
    assert_eq!((collider.elements, collider.layer), (Elements::Edges, 2.0));
    assert!(model(&still).contains("3.5"));
}

#[test]
fn a_collider_that_is_not_dynamic_moves_and_acts_on_nothing() {
    let off = program(
        r#""n": nucleus(), "box": polyCube(tx: keys([(1, 0), (3, 2)])), "c": nRigid(inputMesh: "box", isDynamic: false,
            forceField: doubleSided, fieldMagnitude: 3, pointForceField: worldspace, pushOut: 1, airPushDistance: 2)"#,
    );
    let mut collider = off.first_input().colliders[0].clone();
    assert_eq!(std::mem::take(&mut collider.end).len(), 8);
    assert_eq!(collider, ColliderFrame { collide: false, ..ColliderFrame::default() });
}

#[test]
fn gravity_wind_and_ground_plane_are_in_the_space_of_the_nucleus() {
    let turned =
        "rotate: (0, 0, 90), ty: 3, scale: (2, 1, 1), usePlane: true, windSpeed: 2, planeOrigin: (1, 0, 0)";
    let own = program(&sheet(turned, "")).first_input();
    assert!((own.gravity - Vector3::new(9.8, 0.0, 0.0)).norm() < 1e-15);
    assert!((own.wind - Vector3::new(0.0, 2.0, 0.0)).norm() < 1e-15);
    let plane = own.plane.expect("it is used");
    assert!((plane.origin - Vector3::new(0.0, 5.0, 0.0)).norm() < 1e-15);
    assert!((plane.normal - Vector3::new(-1.0, 0.0, 0.0)).norm() < 1e-15);
    let world = program(&sheet(&format!("useTransform: false, {turned}"), "")).first_input();
    assert_eq!(world.gravity, Vector3::new(0.0, -9.8, 0.0));
    assert_eq!(world.plane.map(|plane| plane.normal), Some(Vector3::y()));
}

#[test]
fn a_ground_plane_begins_the_first_interval_where_the_scene_begins() {
    let keyed = "usePlane: true, ty: 3, planeOrigin: keys([(1, (0, 0, 0)), (3, (0, 1, 0))])";
    let program = program(&sheet(keyed, ""));
    let plane = program.first_input().plane.expect("it is used");
    assert_eq!(plane.origin, Vector3::new(0.0, 3.5, 0.0));
    assert_eq!(plane.start, Some([Vector3::new(0.0, 3.0, 0.0), Vector3::y()]));
    let interval = |is_discontinuous| program.interval(0, [2.0, 3.0], 1.0, is_discontinuous);
    let start = |interval: program::EvaluationInterval<'_>| {
        let input = interval.input(&mut AttachmentState::default(), &|_, _| Vector3::zeros());
        input.plane.expect("it is used").start.map(|[origin, _]| origin.y)
    };
    assert_eq!([false, true].map(|skipped| start(interval(skipped))), [None, Some(3.5)]);
}

#[test]
fn a_direction_is_normalized_and_the_zero_direction_has_no_effect() {
    let gravity = |direction: &str| {
        program(&sheet(&format!("gravityDirection: {direction}"), "")).first_input().gravity
    };
    assert!((gravity("(0, -3, 4)") - Vector3::new(0.0, -9.8 * 0.6, 9.8 * 0.8)).norm() < 1e-14);
    assert_eq!(gravity("(0, 0, 0)"), Vector3::zeros());
}

// EVIDENCE: N2.4-1  the model is built from the start frame
#[test]
fn a_run_begins_at_the_start_frame_with_the_positions_of_that_frame() {
    let moving = r#""p": polyPlane(tx: keys([(1, 0), (11, 10)])), "c": nCloth(inputMesh: "p")"#;
    let late = program(&format!(r#""n": nucleus(startFrame: 5), {moving}"#));
    assert_eq!((late.time().start, late.model().positions(ClothId(0))[0].x), (5, 3.5));
    assert_eq!(program(&format!(r#""n": nucleus(), {moving}"#)).time().start, 1);
    let message = &late.warnings()[0].message;
    assert_eq!(message, "the run begins at frame 5, where `n` starts, and not at frame 1");
    let never = refused(&format!(r#""n": nucleus(startFrame: 25), {moving}"#));
    assert_eq!(never, "`startFrame` of `n` comes after the last frame, 24");
}

#[test]
fn frames_that_cannot_be_evaluated_are_refused() {
    let usual = scene("");
    assert!(usual.time_faults().is_empty());
    let refused = |change: &dyn Fn(&mut Scene)| {
        let mut scene = usual.clone();
        change(&mut scene);
        compile(&scene).expect_err("no run").len()
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300, 1e300] {
        assert_eq!(refused(&|scene| scene.time.fps = bad), 1, "fps: {bad}");
        assert_eq!(refused(&|scene| scene.every = bad), 1, "every: {bad}");
    }
    assert_eq!(refused(&|scene| scene.every = 0.3), 1);
    assert_eq!(refused(&|scene| scene.time.end = scene.time.start - 1), 1);
    assert_eq!(refused(&|scene| scene.time.end = i64::MAX), 1);
    assert_eq!(refused(&|scene| scene.time.start = i64::MIN), 1);
    assert_eq!(refused(&|scene| scene.record = Record::Every(0)), 1);
}

#[test]
fn scenes_that_cannot_run_are_refused() {
    assert_eq!(refused(r#""t": transform()"#), "there is nothing to solve: the scene has no nucleus");
    assert_eq!(
        refused(r#""n": nucleus(), "p": polyPlane(scale: (0, 1, 1)), "c": nCloth(inputMesh: "p")"#),
        "`c` cannot be made from `p`: the mesh has no area"
    );
    assert_eq!(refused(&sheet("", "pointMass: 0")), "`pointMass` of `cloth1` must be above 0, found 0");
    let pin =
        r#""pin": dynamicConstraint(components: ["cloth1"], scale: (0, 1, 1), tx: keys([(1, 0), (9, 1)]))"#;
    assert_eq!(refused(&(sheet("", "") + pin)), "`pin` is scaled to nothing at the start");
}

#[test]
fn an_attribute_at_its_default_equals_the_attribute_left_out() {
    let scene = scene(&(sheet("", "") + r#""box": polyCube(ty: -3), "rigid1": nRigid(inputMesh: "box")"#));
    let plain = compile(&scene).expect("valid");
    let types: [&'static NodeType; 3] = [&nucleus::NUCLEUS, &n_cloth::N_CLOTH, &n_rigid::N_RIGID];
    let mut compared = 0;
    for node_type in types {
        let (id, _) = scene.graph.of_type(node_type).next().expect("one of each");
        for row in node_type.attributes() {
            // The defaults of these depend on the mesh or the scene.
            if ["thickness", "startFrame", "selfCollisionFlag", "selfCollideWidthScale"].contains(&row.name) {
                continue;
            }
            let Some(default) = row.default.clone() else { continue };
            let mut set = scene.clone();
            set.graph.set(id, row, Setting::from(default)).expect("a default fits");
            let set = compile(&set).expect("valid");
            assert_eq!(model(&set), model(&plain), "{}", row.name);
            assert_eq!(set.first_input(), plain.first_input(), "{}", row.name);
            compared += 1;
        }
    }
    assert!(compared > 250, "{compared}");
    assert!(n_cloth::N_CLOTH.is_a(&particle::PARTICLE));
}

proptest! {
    #[test]
    fn the_order_of_nodes_in_a_file_does_not_matter(order in Just((0..7).collect::<Vec<usize>>()).prop_shuffle()) {
        let nodes = [
            r#""n": nucleus(windSpeed: 2)"#,
            r#""p1": polyPlane(subdivisions: (2, 3), ty: 2)"#,
            r#""p2": polyPlane(subdivisions: (3, 1))"#,
            r#""z": nCloth(inputMesh: "p2", damp: 1)"#,
            r#""a": nCloth(inputMesh: "p1")"#,
            r#""r": nRigid(inputMesh: "p2")"#,
            r#""pin": dynamicConstraint(components: ["z.vtx[1]", "a.vtx[2:4]"])"#,
        ];
        let text = |order: &[usize]| order.iter().map(|&k| nodes[k]).collect::<Vec<_>>().join(", ");
        let (given, sorted) = (program(&text(&order)), program(&text(&[0, 1, 2, 3, 4, 5, 6])));
        prop_assert_eq!(given.graph(), sorted.graph());
        prop_assert_eq!(model(&given), model(&sorted));
        prop_assert_eq!(given.objects(), sorted.objects());
        prop_assert_eq!(given.first_input(), sorted.first_input());
    }
}

#[test]
fn a_camera_moves_with_its_keys_and_with_its_parent() {
    let rig = r#""rig": transform(rotateY: 90), "shot": camera(parent: "rig", translateZ: keys([(1, 5), (24, 7)]), focalLength: 50),"#;
    let cameras = program(&format!("{}{rig}", sheet("", ""))).cameras();
    let [shot] = &cameras[..] else { panic!("{cameras:?}") };
    assert_eq!((shot.name.as_str(), shot.fit, shot.views.len()), ("shot", FilmFit::Fill, 24));
    let last = shot.views[23];
    assert!((last.eye - Vector3::new(7.0, 0.0, 0.0)).norm() < 1e-12, "{}", last.eye);
    assert!((last.forward + Vector3::x()).norm() < 1e-12 && (last.up - Vector3::y()).norm() < 1e-12);
    assert_eq!((last.focal_length, last.film), (50.0, [1.41732, 0.94488]), "Maya's 36 mm by 24 mm");
    let still = program(&format!(r#"{}"shot": camera(translate: (0, 1, 5)),"#, sheet("", ""))).cameras();
    assert_eq!(still[0].views.len(), 1);
}

// EVIDENCE: N2.2-9  Object Space raises counts with the number of faces, Link is the default
#[test]
fn a_scaling_relation_other_than_link_raises_classic_counts_with_the_faces() {
    let resistance = |set: &str, side: u32| {
        let scene = format!(
            r#""nucleus1": nucleus(resistanceModel: classic),
               "p": polyPlane(width: 2, height: 2, subdivisions: ({side}, {side})),
               "c": nCloth(inputMesh: "p", stretchResistance: 3{set}),"#
        );
        program(&scene).first_input().cloths[0].stretch_resistance
    };
    for (set, few, many) in [
        ("", 3.0, 3.0),
        (", scalingRelation: link", 3.0, 3.0),
        (", scalingRelation: objectSpace", 3.0, 12.0),
        // A sheet of four square metres.
        (", scalingRelation: worldSpace", 0.75, 3.0),
        (", scalingRelation: objectSpace, maxIterations: 5", 3.0, 5.0),
    ] {
        let found = [10, 20].map(|side| resistance(set, side));
        assert!((found[0] - few).abs() + (found[1] - many).abs() < 1e-9, "{set}: {found:?}");
    }
}

/// A sheet 2 m wide whose rest shape is 4 m wide and has so many cells along it.
fn with_rest_shape(cells: u32) -> Result<Program, Vec<Diagnostic>> {
    let text = format!(
        r#"Scene(time: (start: 1, end: 24, fps: 24), nodes: {{
            "nucleus1": nucleus(),
            "p": polyPlane(width: 2, height: 2, subdivisions: (1, 1)),
            "r": polyPlane(width: 4, height: 2, subdivisions: ({cells}, 1)),
            "c": nCloth(inputMesh: "p"),
        }}, connections: [("r.worldMesh[0]", "c.restShapeMesh")])"#
    );
    compile(&read_scene_text(&text, Path::new("test.ron")).expect("a valid scene").0)
}

#[test]
fn a_rest_shape_mesh_is_the_model_and_the_input_mesh_the_start() {
    let program = with_rest_shape(1).expect("meshes of the same faces");
    let cloth = &program.nuclei()[0].model.cloths()[0];
    let width = |points: &[Vector3<f64>]| (points[1] - points[0]).norm();
    assert_eq!((width(&cloth.surface.positions), width(cloth.positions())), (4.0, 2.0));
}

#[test]
fn a_rest_shape_mesh_of_other_faces_is_refused() {
    let error = with_rest_shape(2).expect_err("one face more");
    let expected = "`r` cannot be the rest shape of `c`: it has 6 points and 2 faces, the input mesh 4 and 1";
    assert_eq!(error[0].message, expected);
}
