//! A Nucleus scene, written as Maya ASCII and imported again, is the same scene.

use std::path::Path;

use nucleus_graph::animation::{Curve, Infinity, Key, Tangent};
use nucleus_graph::attributes::{
    Attribute, Choice, Component, Kind, NodeType, RampPoint, Selection, Value, air_field, camera,
    dynamic_constraint, gravity_field, n_cloth, n_particle, n_rigid, nucleus, poly_cube, poly_cylinder,
    poly_plane, poly_sphere, transform, turbulence_field,
};
use nucleus_graph::graph::{Channel, Creation, Graph, NodeId, Setting};
use nucleus_graph::scene::{Record, Scene, Source, TimeSpan, read_scene_text, write_scene};
use nucleus_maya::ascii::SourceText;
use nucleus_maya::{ImportOptions, import_text, maya_ascii};
use proptest::prelude::*;

/// What a random setting is made of.
type Seed = (usize, usize, f64, f64, u8);

fn curve(row: &Attribute, a: f64, b: f64, shape: u8) -> Option<Curve> {
    let tangents = [Tangent::Stepped, Tangent::Linear, Tangent::Spline, Tangent::Flat, Tangent::Auto];
    let infinities =
        [Infinity::Constant, Infinity::Linear, Infinity::Cycle, Infinity::CycleOffset, Infinity::Oscillate];
    let whole = |x: f64| match row.kind {
        Kind::Bool => f64::from(u8::from(x > 0.0)),
        Kind::Int => x.round(),
        Kind::Choice(words) => f64::from(words[(x.abs() as usize) % words.len()].0),
        _ => x,
    };
    let count = 1 + usize::from(shape) % 4;
    let key = |k: usize| Key {
        frame: k as f64 * 7.5 + a.fract(),
        value: whole(row.range.clamp([a, b, a - b, b * 0.5][k])),
        tangent: tangents[(usize::from(shape) + k) % 5],
    };
    let curve = Curve::new((0..count).map(key).collect()).ok()?;
    let infinity = |k: u8| infinities[usize::from(shape / 8 + k) % 5];
    Some(curve.with_infinity(infinity(0), infinity(3)))
}

/// A setting that fits a row; `None` for rows without values.
fn setting(row: &'static Attribute, (_, _, a, b, shape): Seed) -> Option<Setting> {
    let x = row.range.clamp(a);
    let fixed = |value: Value| Some(Setting::Fixed(value));
    if row.can_be_keyed() && shape % 3 == 0 {
        return match row.kind {
            Kind::Vector(_) => Some(Setting::Parts([
                Channel::Keyed(curve(row, a, b, shape)?),
                Channel::Fixed(x),
                Channel::Keyed(curve(row, b, a, shape / 2)?),
            ])),
            _ => curve(row, a, b, shape).map(Setting::Keyed),
        };
    }
    match row.kind {
        Kind::Bool => fixed(Value::Bool(shape % 2 == 0)),
        Kind::Int => fixed(Value::Int(x.round() as i64)),
        Kind::Float => fixed(Value::Float(x)),
        Kind::Choice(words) => fixed(Value::Choice(Choice(words[usize::from(shape) % words.len()].0))),
        Kind::Vector(_) => Some(Setting::Parts([a, b, a + b].map(|x| Channel::Fixed(row.range.clamp(x))))),
        Kind::Text if row.extension => None,
        Kind::Text => fixed(Value::Text(format!("a \"{a}\"\n\\ ü"))),
        Kind::Texts => fixed(Value::Texts(vec![format!("a \"{a}\"\n"), String::new(), "ü".to_owned()])),
        Kind::Floats => fixed(Value::Floats(vec![a, b, 0.1])),
        Kind::Vectors => fixed(Value::Vectors(vec![[a, b, 1.0], [0.0, -1e-300, b]])),
        Kind::Ramp => {
            let point = |position: f64, value: f64| RampPoint {
                position,
                value,
                interpolation: Choice(i32::from(shape) % 4),
            };
            fixed(Value::Ramp(vec![point(0.0, a), point(0.75, b)].into()))
        }
        _ => None,
    }
}

/// Sets an attribute that a seed picks.
fn set_any(graph: &mut Graph, node: NodeId, node_type: &'static NodeType, seed: Seed) {
    let rows = node_type.attributes();
    let row = rows[seed.1 % rows.len()];
    // Creation connects these: a setting would not count, and Maya has none beside a connection.
    if row.name == "currentTime" || (row.name == "startFrame" && node_type != &nucleus::NUCLEUS) {
        return;
    }
    // Scenes refuse what has no mass and is to move.
    let is_massless = |setting: &Setting| {
        row.name == "pointMass"
            && *setting == Setting::Fixed(Value::Float(0.0))
            && node_type != &n_rigid::N_RIGID
    };
    if let Some(setting) = setting(row, seed).filter(|setting| setting.fits(row) && !is_massless(setting)) {
        graph.set(node, row, setting).unwrap();
    }
}

const NAMES: [&str; 12] = [
    "a",
    "ball",
    "ballShape",
    "cloth-1",
    "ns:wind",
    "größe",
    "nucleus2",
    "outputCloth",
    "plane",
    "time",
    "x1",
    "zz_9",
];

/// A scene: some transforms and primitives, one or two nuclei, objects of each kind, a constraint, a field.
fn scene(parts: &[u8], seeds: &[Seed], shift: usize) -> Scene {
    let mut graph = Graph::new();
    let name = |k: usize| format!("{}{}", NAMES[(k + shift) % NAMES.len()], k / NAMES.len());
    let mut planned: Vec<(String, &'static NodeType)> = vec![(format!("{}n", name(0)), &nucleus::NUCLEUS)];
    let kinds: [&'static NodeType; 10] = [
        &transform::TRANSFORM,
        &poly_plane::POLY_PLANE,
        &poly_sphere::POLY_SPHERE,
        &poly_cube::POLY_CUBE,
        &poly_cylinder::POLY_CYLINDER,
        &n_cloth::N_CLOTH,
        &n_rigid::N_RIGID,
        &n_particle::N_PARTICLE,
        &camera::CAMERA,
        &nucleus::NUCLEUS,
    ];
    for (k, part) in parts.iter().enumerate() {
        planned.push((name(k + 1), kinds[usize::from(*part) % kinds.len()]));
    }
    planned.push((format!("{}p", name(1)), &poly_plane::POLY_PLANE));
    planned.push((format!("{}d", name(1)), &dynamic_constraint::DYNAMIC_CONSTRAINT));
    let fields = [&gravity_field::GRAVITY_FIELD, &turbulence_field::TURBULENCE_FIELD, &air_field::AIR_FIELD];
    planned.push((format!("{}f", name(2)), fields[shift % 3]));
    planned.sort_by(|a, b| a.0.cmp(&b.0));
    planned.dedup_by(|a, b| a.0 == b.0);
    let nodes: Vec<(NodeId, &'static NodeType)> =
        planned.iter().map(|(name, node_type)| (graph.add(name, node_type).unwrap(), *node_type)).collect();
    let of = |wanted: &dyn Fn(&&'static NodeType) -> bool| -> Vec<NodeId> {
        nodes.iter().filter(|(_, node_type)| wanted(node_type)).map(|(id, _)| *id).collect()
    };
    let nuclei = of(&|t| **t == nucleus::NUCLEUS);
    let meshes = of(&|t| t.name.starts_with("poly"));
    let placed = of(&|t| **t == transform::TRANSFORM || t.name.starts_with("poly"));
    for &(seed_node, ..) in seeds {
        let (node, parent) = (placed[seed_node % placed.len()], placed[seed_node / 7 % placed.len()]);
        if node != parent {
            let _ = graph.set_parent(node, parent);
        }
    }
    for seed in seeds {
        let (node, node_type) = nodes[seed.0 % nodes.len()];
        set_any(&mut graph, node, node_type, *seed);
    }
    let objects = of(&|t| t.is_a(&nucleus_graph::attributes::n_base::N_BASE));
    for (k, object) in objects.iter().enumerate() {
        let nucleus = nuclei[(k + shift) % nuclei.len()];
        let is_particles = graph.node(*object).node_type() == &n_particle::N_PARTICLE;
        let mesh = (!is_particles).then(|| meshes[k % meshes.len()]);
        graph.create(*object, &Creation::Object { mesh, nucleus }).unwrap();
    }
    for constraint in of(&|t| **t == dynamic_constraint::DYNAMIC_CONSTRAINT) {
        let Some(object) = objects.first() else { continue };
        let nucleus = graph.creation(*object).map(|creation| match creation {
            Creation::Object { nucleus, .. } => nucleus,
            _ => nuclei[0],
        });
        let component = |selection| Component { object: graph.node(*object).name().to_owned(), selection };
        let components = vec![
            component(Selection::points(0, 3)),
            component(Selection::points(4, 4)),
            component(Selection::points(1, 2)),
        ];
        let row = &dynamic_constraint::COMPONENTS.row;
        graph.set(constraint, row, Setting::Fixed(Value::Components(components.clone()))).unwrap();
        let creation = Creation::Constraint { components, nucleus: nucleus.unwrap_or(nuclei[0]) };
        graph.create(constraint, &creation).unwrap();
    }
    for field in of(&|t| t.is_a(&nucleus_graph::attributes::field::FIELD)) {
        if let Some(&target) = objects.last() {
            graph.create(field, &Creation::Effect { target }).unwrap();
        }
    }
    Scene {
        time: TimeSpan { start: -3 + shift as i64, end: 40, fps: [24.0, 23.976, 60.0][shift % 3] },
        every: [1.0, 0.5][shift % 2],
        record: [Record::Frames, Record::Substeps, Record::Every(3)][shift % 3],
        graph,
        checks: Vec::new(),
        source: Source::new("out.ron"),
    }
}

fn imported(text: &str) -> nucleus_maya::Imported {
    let source = SourceText::from_bytes(Path::new("out.ma"), text.as_bytes().to_vec()).unwrap();
    let mut options = ImportOptions::new("meshes", |name, _| panic!("{name} is written of\n{text}"));
    import_text(source, Path::new("out.ron"), &mut options).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn a_scene_written_for_maya_and_imported_is_the_same_scene(
        parts in prop::collection::vec(any::<u8>(), 0..9),
        seeds in prop::collection::vec((any::<usize>(), any::<usize>(), -50.0..50.0f64, -3.0..3.0f64, any::<u8>()), 0..40),
        shift in 0usize..12,
    ) {
        let scene = scene(&parts, &seeds, shift);
        // The short form of a scene is canonical: connections are made in the order of names.
        let (scene, _) = read_scene_text(&write_scene(&scene), Path::new("out.ron")).map_err(|e| TestCaseError::reject(format!("{e:?}")))?;
        let (text, _) = maya_ascii(&scene, "out").unwrap();
        let again = imported(&text);
        if again.scene != scene {
            let (a, b) = (write_scene(&scene), write_scene(&again.scene));
            let differs = a.lines().zip(b.lines()).find(|(a, b)| a != b);
            prop_assert!(false, "{differs:?}\n{}\n--- written\n{a}\n--- imported\n{b}\n--- maya\n{text}", again.omissions);
        }
    }
}

/// What Maya's creation commands would have made: the plugs of `wiring.md`.
#[test]
fn a_written_scene_is_wired_as_mayas_commands_do() {
    let ron = "Scene(time: (start: 1, end: 10, fps: 24), nodes: {\"n\": nucleus(), \"p\": polyPlane(), \"s\": polySphere(),
        \"c\": nCloth(inputMesh: \"p\", preset: \"silk\"), \"r\": nRigid(inputMesh: \"s\"),
        \"k\": dynamicConstraint(components: [\"c.vtx[0:1]\"])})";
    let (scene, _) = read_scene_text(ron, Path::new("out.ron")).unwrap();
    let (text, omissions) = maya_ascii(&scene, "out").unwrap();
    assert!(omissions.is_empty(), "{omissions}");
    for line in [
        "connectAttr \":time1.o\" \"n.cti\";",
        "connectAttr \":time1.o\" \"cShape.cti\";",
        "connectAttr \"pShape.w[0]\" \"cShape.imsh\";",
        "connectAttr \"cShape.cust\" \"n.niao[0]\";",
        "connectAttr \"cShape.stst\" \"n.nias[0]\";",
        "connectAttr \"n.noao[0]\" \"cShape.nxst\";",
        "connectAttr \"n.stf\" \"cShape.stf\";",
        "connectAttr \"cShape.omsh\" \"outputCloth1Shape.i\";",
        "connectAttr \"sShape.w[0]\" \"rShape.imsh\";",
        "connectAttr \"rShape.cust\" \"n.nipo[0]\";",
        "connectAttr \"rShape.stst\" \"n.nips[0]\";",
        "connectAttr \"n.stf\" \"rShape.stf\";",
        "connectAttr \"cShape.nuid\" \"nComponent1.obid\";",
        "connectAttr \"nComponent1.ocp\" \"kShape.cid[0]\";",
        "connectAttr \"kShape.evs[0]\" \"n.is[0]\";",
        "connectAttr \"kShape.evc[0]\" \"n.ic[0]\";",
        "connectAttr \"polyPlane_p.out\" \"pShape.i\";",
        // Area of the bounding box 2, a hundred faces: .005 √2 is less than .13 √(2/100).
        "\tsetAttr \".thss\" 0.00707106781186547",
        "\tsetAttr \".io\" yes;",
        "\tsetAttr \".ci[0:1]\" 0 1;",
        "\tsetAttr \".actv\" no;",
        "setAttr \".stch\" 60;",
    ] {
        let line = line.replace("\tsetAttr \".ci", "\tsetAttr -s 2 \".ci");
        assert!(text.contains(&line), "{line} is missing in\n{text}");
    }
    assert!(imported(&text).scene == scene, "{}", write_scene(&imported(&text).scene));
}

/// `wm` is the world matrix in Maya; earlier exports connected it as the mesh.
#[test]
fn an_earlier_export_that_connects_the_world_matrix_is_read_as_before() {
    let ron = "Scene(time: (start: 1, end: 10, fps: 24), nodes: {\"n\": nucleus(), \"p\": polyPlane(), \"q\": polyPlane(width: 2),
        \"c\": nCloth(inputMesh: \"p\", restShapeMesh: \"q\")})";
    let (scene, _) = read_scene_text(ron, Path::new("out.ron")).unwrap();
    let (text, _) = maya_ascii(&scene, "out").unwrap();
    assert!(text.contains("connectAttr \"qShape.w[0]\" \"cShape.rsmh\";"), "{text}");
    for text in [text.replace(".w[0]", ".wm[0]"), text] {
        assert!(imported(&text).scene == scene, "{}", write_scene(&imported(&text).scene));
    }
}

#[test]
fn meshes_of_every_format_are_written_with_their_points_and_motion_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
               element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 0 2.5\n3 0 1 2\n";
    let usd = "#usda 1.0\n(\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\ndef Mesh \"a\" {\n\
               int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2]\n\
               point3f[] points.timeSamples = { 1: [(0, 0, 0), (1, 0, 0), (0, 0, 0.75)], 5: [(0, 4, 0), (1, 4, 0), (0, 4, 1)] }\n}\n";
    for (name, text) in [("still.ply", ply), ("moves.usda", usd)] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let ron = "Scene(time: (start: 1, end: 10, fps: 24), nodes: {\"n\": nucleus(spaceScale: 0.01),
        \"p\": mesh(file: \"still.ply\"), \"u\": mesh(file: \"moves.usda\"),
        \"c\": nCloth(inputMesh: \"p\"), \"r\": nRigid(inputMesh: \"u\")})";
    let (scene, _) = read_scene_text(ron, &folder.path().join("out.ron")).unwrap();
    let (text, omissions) = maya_ascii(&scene, "out").unwrap();
    // Units of a PLY are scene units; a USD states metres, and a scene unit is a centimetre.
    for points in ["\n\t\t0 0 0\n\t\t1 0 0\n\t\t0 0 2.5;", "\n\t\t0 0 0\n\t\t100 0 0\n\t\t0 0 75;"] {
        assert!(text.contains(points), "{points:?} is missing in\n{text}");
    }
    let found: Vec<(&str, String)> = omissions.iter().map(|(what, cause)| (what, cause.reason())).collect();
    let moves = "its file moves it; the scene for Maya has its shape at the first frame";
    assert_eq!(found, [("u", moves.to_owned())]);
    std::fs::remove_file(folder.path().join("still.ply")).unwrap();
    assert!(maya_ascii(&scene, "out").unwrap_err().contains("still.ply"));
}

#[test]
fn constraints_by_meaning_are_carried_over_beside_others() {
    let ron = "Scene(time: (start: 1, end: 10, fps: 24), nodes: {\"n\": nucleus(), \"p\": polyPlane(), \"c\": nCloth(inputMesh: \"p\"),
        \"a\": dynamicConstraint(components: [\"c.corners\", \"c.e[border]\"]), \"b\": dynamicConstraint(components: [\"c\"])})";
    let (scene, _) = read_scene_text(ron, Path::new("out.ron")).unwrap();
    let (text, _) = maya_ascii(&scene, "out").unwrap();
    let again = imported(&text).scene;
    assert!(again == scene, "{}", write_scene(&again));
}

#[test]
fn targets_of_events_are_carried_over() {
    for targets in [r#""r""#, r#"["r", "", "q"]"#] {
        let text = format!(
            r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {{"n": nucleus(), "r": nParticle(),
            "q": nParticle(eventEmit: [1, 2, 3], eventParticles: {targets})}})"#
        );
        let (scene, _) = read_scene_text(&text, Path::new("a.ron")).unwrap();
        let (ascii, _) = maya_ascii(&scene, "a").unwrap();
        let again = write_scene(&imported(&ascii).scene);
        assert!(again.contains(&format!("eventParticles: {targets}")), "{again}");
    }
}

#[test]
fn a_mesh_whose_file_is_elsewhere_is_taken_from_the_maya_scene() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.obj"), "v 0 0 0\nv 1 0 0\nv 0 0 2\nf 1 2 3\n").unwrap();
    let ron =
        "Scene(time: (start: 1, end: 10, fps: 24), nodes: {\"n\": nucleus(), \"m\": mesh(file: \"m.obj\"),
        \"c\": nCloth(inputMesh: \"m\")})";
    let (scene, _) = read_scene_text(ron, &folder.path().join("s.ron")).unwrap();
    let (text, _) = maya_ascii(&scene, "s").unwrap();
    let import = |target: &Path| {
        let mut files = Vec::new();
        let mut options = ImportOptions::new("meshes", |name, text| {
            files.push((name.to_owned(), text));
            Ok(())
        });
        let source = SourceText::from_bytes(Path::new("s.ma"), text.clone().into_bytes()).unwrap();
        let read = import_text(source, target, &mut options).unwrap();
        drop(options);
        (write_scene(&read.scene), files, read.omissions.to_string())
    };
    let (beside, files, _) = import(&folder.path().join("s.ron"));
    assert!(beside.contains("file: \"m.obj\"") && files.is_empty(), "{beside}");
    let (elsewhere, files, omissions) = import(&folder.path().join("other/s.ron"));
    assert!(elsewhere.contains("file: \"meshes/m.obj\""), "{elsewhere}");
    assert!(files[0].1.contains("v 0 0 2\n"), "{files:?}");
    assert!(omissions.contains("`m.obj` is not there"), "{omissions}");
}
