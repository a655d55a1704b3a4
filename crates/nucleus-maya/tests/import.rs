//! Scenes of Maya, written by hand, become Nucleus scenes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use nalgebra::Vector3;
use nucleus_graph::attributes::{
    Attribute, Choice, Key, Value, camera, dynamic_constraint, mesh, n_base, n_cloth, n_component, nucleus,
    poly_plane, surface_shape, transform,
};
use nucleus_graph::graph::{Graph, NodeId};
use nucleus_graph::scene::{read_scene_text, write_scene};
use nucleus_maya::animation::{Evaluator, Matrix};
use nucleus_maya::scene::MayaScene;
use nucleus_maya::{ImportError, ImportOptions, Imported, import_scene};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/maya")
}

/// An imported scene, and the text of its mesh files.
struct Read {
    imported: Imported,
    files: BTreeMap<String, String>,
}

fn read(name: &str) -> Read {
    read_path(&folder().join(name), &[]).unwrap()
}

fn read_path(path: &Path, meshes: &[(&str, &Path)]) -> Result<Read, ImportError> {
    let mut files = BTreeMap::new();
    let mut options = ImportOptions::new("meshes", |name, text| {
        files.insert(name.to_owned(), text);
        Ok(())
    });
    options.meshes = meshes.iter().map(|(name, path)| ((*name).to_owned(), path.to_path_buf())).collect();
    let imported = import_scene(path, Path::new("out.ron"), &mut options)?;
    drop(options);
    Ok(Read { imported, files })
}

impl Read {
    fn graph(&self) -> &Graph {
        &self.imported.scene.graph
    }

    fn node(&self, name: &str) -> NodeId {
        let names = || self.graph().iter().map(|(_, node)| node.name().to_owned()).collect::<Vec<_>>();
        self.graph().find(name).unwrap_or_else(|| panic!("no `{name}` in {:?}", names()))
    }

    fn get<T: nucleus_graph::attributes::FromValue>(&self, name: &str, key: &Key<T>) -> T {
        self.graph().node(self.node(name)).at(key, 1.0)
    }

    fn at<T: nucleus_graph::attributes::FromValue>(&self, name: &str, key: &Key<T>, frame: f64) -> T {
        self.graph().at(frame).get(self.node(name), key)
    }

    fn is_set(&self, name: &str, row: &Attribute) -> bool {
        self.graph().node(self.node(name)).settings().contains_key(row.name)
    }

    /// Whether an omission names something and gives a reason with a word.
    fn omits(&self, what: &str, word: &str) -> bool {
        self.imported.omissions.iter().any(|(own, cause)| own.contains(what) && cause.reason().contains(word))
    }

    fn points(&self, file: &str) -> Vec<[f64; 3]> {
        let text = self.files.get(file).unwrap_or_else(|| panic!("no `{file}` in {:?}", self.files.keys()));
        let numbers = |line: &str| line.split(' ').map(|x| x.parse().unwrap()).collect::<Vec<f64>>();
        text.lines()
            .filter_map(|line| line.strip_prefix("v "))
            .map(|line| numbers(line).try_into().unwrap())
            .collect()
    }

    fn faces(&self, file: &str) -> Vec<String> {
        self.files[file].lines().filter_map(|line| line.strip_prefix("f ")).map(str::to_owned).collect()
    }
}

/// The written scene reads back to the same scene, without errors.
fn assert_round_trip(read: &Read) {
    let text = write_scene(&read.imported.scene);
    let (again, _) = read_scene_text(&text, Path::new("out.ron")).unwrap_or_else(|e| panic!("{e:?}\n{text}"));
    assert!(again == read.imported.scene, "{text}");
}

#[test]
fn a_cloth_over_a_sphere_is_carried_over() {
    let read = read("drape.ma");
    let graph = read.graph();
    assert_eq!(graph.node(read.node("pPlane1")).node_type().name, "polyPlane");
    assert_eq!(read.get("pPlane1", &poly_plane::SUBDIVISIONS_WIDTH), 20);
    assert_eq!(graph.source(read.node("nCloth1"), &n_base::INPUT_MESH), Some(read.node("pPlane1")));
    assert_eq!(read.get("nCloth1", &n_cloth::STRETCH_RESISTANCE), 60.0);
    assert_eq!(read.get("nCloth1", &n_base::THICKNESS), 0.058);
    assert_eq!(read.get("nRigid1", &n_base::FRICTION), 0.4);
    assert_eq!(read.get("nucleus1", &nucleus::RESISTANCE_MODEL), Choice(0), "Maya's resistances are counts");
    assert_eq!(read.at("nucleus1", &nucleus::WIND_SPEED, 24.0), 5.0);
    assert_eq!(read.get("persp", &camera::CENTER_OF_INTEREST), 24.0);
    assert!(graph.find("top").is_none(), "an orthographic camera is no view");
    assert!(!read.is_set("nCloth1", &n_base::FIELD_SCALE.row), "ramps at their defaults say nothing");
    let time = read.imported.scene.time;
    assert_eq!((time.start, time.end, time.fps), (1, 48, 24.0));
    assert!(read.files.is_empty(), "both meshes are primitives of ours");
    let text = write_scene(&read.imported.scene);
    assert!(text.contains("inputMesh: \"pPlane1\"") && !text.contains("connections:"), "{text}");
    assert_round_trip(&read);
}

#[test]
fn long_names_other_units_and_gaps_are_read_as_well() {
    let read = read("long_names.ma");
    let cloth = "clothTransform";
    let plane = "Tuch__groß___neu_";
    assert_eq!(read.get(cloth, &n_cloth::STRETCH_RESISTANCE), 35.0);
    assert_eq!(read.get(cloth, &n_base::LOCAL_FORCE), [0.0, 0.5, 0.0]);
    assert!(!read.get(cloth, &n_base::SELF_COLLIDE));
    assert_eq!(read.get("solver", &nucleus::GRAVITY_DIRECTION), [0.0, 0.0, -1.0]);
    // Metres and radians become centimetres and degrees.
    assert_eq!(read.get(plane, &transform::TRANSLATE), [0.0, 200.0, 0.0]);
    assert!((read.get(plane, &transform::ROTATE)[1] - 90.0).abs() < 1e-12);
    assert_eq!(read.imported.scene.time.fps, 25.0);
    let file = "meshes/Tuch__gro____neu_.obj";
    assert_eq!(read.points(file), [[-1.0, 0.0, 1.0], [2.0, 0.0, 1.0], [-1.0, 0.0, -1.0], [1.0, 0.0, -1.0]]);
    assert_eq!(read.faces(file), ["1 2 4", "1 4 3"]);
    // An attribute that the file leaves out has the default of Maya's node.
    assert_eq!(read.get(cloth, &n_base::THICKNESS), 0.1);
    assert!(read.is_set(cloth, &n_base::THICKNESS.row));
    assert_round_trip(&read);
}

/// Maya's own placement of a node against that of the Nucleus node, at several frames.
fn assert_placed(file: &str, maya: &str, ours: &str) {
    let read = read(file);
    let scene = MayaScene::read(&folder().join(file)).unwrap();
    let evaluator = Evaluator::new(&scene);
    let id = scene.find(maya).unwrap();
    for frame in [1, 7, 11, 16, 31, 38] {
        let world: Matrix = evaluator.world(id, f64::from(frame));
        let own = read.graph().placement(read.node(ours), f64::from(frame));
        for p in [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.3, -2.0, 5.0]] {
            let (a, b) = (Vector3::from(world.point(p)), own.point(Vector3::from(p)));
            assert!((a - b).norm() < 1e-6, "frame {frame}, {p:?}: {a} is not {b}");
        }
    }
}

#[test]
fn pivots_axes_orders_parents_and_keys_place_a_collider_as_in_maya() {
    assert_placed("pivots.ma", "doorShape", "door");
}

#[test]
fn shear_with_pivots_and_weighted_tangents_place_a_collider_as_in_maya() {
    assert_placed("pivots.ma", "wedgeShape", "wedge");
}

#[test]
fn a_rotation_about_a_pivot_leaves_the_pivot_where_it_is() {
    // By hand: without scale and axes, the pivot only moves with the translations.
    let scene = MayaScene::read(&folder().join("pivots.ma")).unwrap();
    let evaluator = Evaluator::new(&scene);
    let door = scene.find("door").unwrap();
    let pivot = [-1.0, 0.0, 0.5];
    let undone = [-1.0, -0.125, 0.5];
    // A point that the scale about (-1, 0, 0) and its translation take to the pivot.
    let placed = |frame: f64| evaluator.local(door, frame).point(undone);
    for frame in [1.0, 16.0, 31.0] {
        let p = placed(frame);
        assert!((0..3).all(|k| (p[k] - pivot[k] - [0.25, 0.0, 0.0][k]).abs() < 1e-12), "{frame}: {p:?}");
    }
}

#[test]
fn constraints_of_transforms_place_what_they_drive() {
    let read = read("constrained.ma");
    // By hand: the hand turns x to y, has twice the size, and moves from x = 5 to 15 in ten frames.
    for (frame, x) in [(1.0, 5.0), (6.0, 10.0), (11.0, 15.0)] {
        let assert_at = |name: &str, point: [f64; 3], expected: [f64; 3]| {
            let at = read.graph().placement(read.node(name), frame).point(Vector3::from(point));
            assert!((at - Vector3::from(expected)).norm() < 1e-9, "{name} at frame {frame}: {at}");
        };
        assert_at("held", [0.0; 3], [x, 1.0, 0.0]);
        assert_at("held", [1.0, 0.0, 0.0], [x, 2.0, 0.0]);
        assert_at("between", [0.0; 3], [x / 4.0, 3.0, 7.0]);
        assert_at("turned", [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    }
    assert_round_trip(&read);
    // A constraint that depends on itself ends.
    let scene = MayaScene::read(&folder().join("constrained.ma")).unwrap();
    let evaluator = Evaluator::new(&scene);
    assert!(evaluator.world(scene.find("loop").unwrap(), 1.0).is_identity());
}

#[test]
fn a_surface_emitter_brings_its_mesh_along() {
    let read = read("surface_emitter.ma");
    let graph = read.graph();
    let parent = graph.node(read.node("emitter1")).parent().expect("a parent");
    assert_eq!(parent, read.node("lawn"));
    assert_eq!(graph.node(parent).node_type(), &poly_plane::POLY_PLANE);
    assert_round_trip(&read);
}

#[test]
fn lift_is_read_in_scene_units_where_a_unit_is_no_metre() {
    assert!(read("drape.ma").get("nucleus1", &nucleus::LIFT_IN_SCENE_UNITS));
    let constrained = read("constraint.ma");
    let nucleus = constrained.graph().iter().find(|(_, node)| node.node_type() == &nucleus::NUCLEUS);
    let settings = nucleus.expect("a nucleus").1.settings();
    let is_scaled = settings.contains_key(nucleus::SPACE_SCALE.row.name);
    assert_eq!(settings.contains_key(nucleus::LIFT_IN_SCENE_UNITS.row.name), is_scaled);
}

#[test]
fn a_curve_that_ours_can_follow_keeps_its_keys() {
    let read = read("pivots.ma");
    let text = write_scene(&read.imported.scene);
    assert!(text.contains("post: oscillate"), "{text}");
    assert_eq!(read.imported.scene.time.fps, 30.0);
    assert_round_trip(&read);
}

#[test]
fn constraints_keep_their_points_and_members_of_other_kinds_do_no_harm() {
    let read = read("constraint.ma");
    let parts: Vec<String> = read
        .get("dynamicConstraint1", &dynamic_constraint::COMPONENTS)
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(parts, ["nCloth1.vtx[0:2]", "nCloth1.vtx[10]"]);
    assert_eq!(read.get("dynamicConstraint1", &transform::TRANSLATE), [0.0, 3.0, 0.0]);
    assert_eq!(read.get("dynamicConstraint1", &dynamic_constraint::CONSTRAINT_TYPE), Choice(0));
    assert_eq!(read.get("dynamicConstraint2", &dynamic_constraint::CONSTRAINT_TYPE), Choice(4));
    // A component with a strength of its own stays a node.
    assert_eq!(read.get("nComponent2", &n_component::STRENGTH), 0.5);
    assert_eq!(read.get("nComponent2", &n_component::COMPONENT_TYPE), Choice(3));
    let graph = read.graph();
    assert_eq!(
        graph.source(read.node("dynamicConstraint2"), &dynamic_constraint::COMPONENT_IDS),
        graph.find("nComponent2")
    );
    assert!(
        graph.find("hairSystem1").is_none() && read.omits("hairSystemShape1", "hairSystem is not solved")
    );
    assert!(graph.find("nucleus2").is_none() && read.omits("nucleus2", "nothing is connected"));
    assert_round_trip(&read);
}

#[test]
fn a_vertex_map_counts_only_where_its_type_says_so() {
    let read = read("constraint.ma");
    assert_eq!(read.get("nCloth1", &n_base::FRICTION_PER_VERTEX).len(), 121);
    assert!(!read.is_set("nCloth1", &n_base::BOUNCE_PER_VERTEX.row));
    let ramp = read.get("nCloth1", &n_base::FIELD_SCALE);
    assert_eq!(
        (ramp.len(), ramp[1].position, ramp[1].value, ramp[1].interpolation),
        (3, 0.5, 0.75, Choice(3))
    );
}

#[test]
fn a_reference_is_found_beside_the_scene_and_takes_its_edits() {
    let read = read("reference.ma");
    let ball = "prop:ball";
    assert_eq!(read.get(ball, &transform::TRANSLATE), [0.0, 4.0, 0.0]);
    assert_eq!(read.get(ball, &nucleus_graph::attributes::poly_sphere::RADIUS), 3.0);
    assert_eq!(read.graph().source(read.node("nRigid1"), &n_base::INPUT_MESH), Some(read.node(ball)));
    assert!(
        read.omits("../../../../etc/passwd", "not there"),
        "only scenes are read: {}",
        read.imported.omissions
    );
    assert!(read.omits("reference.ma", "refers to itself"));
    assert_round_trip(&read);
}

#[test]
fn particles_fields_emitters_and_expressions_are_carried_over() {
    let read = read("particles.ma");
    use nucleus_graph::attributes::{field, n_particle, turbulence_field};
    let graph = read.graph();
    assert_eq!(
        read.get("nParticle1", &n_particle::POSITION0),
        [[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.0]]
    );
    let _ = turbulence_field::TURBULENCE_FIELD.name;
    assert_eq!(read.at("turbulenceField1", &field::MAGNITUDE, 8.0), 0.0);
    assert_eq!(read.at("turbulenceField1", &field::MAGNITUDE, 15.0), 30.0);
    for effect in ["turbulenceField1", "gravityField1", "emitter1"] {
        let joined = graph.leaving(read.node(effect)).any(|wire| wire.to.node == read.node("nParticle1"));
        assert!(joined, "{effect}");
    }
    assert!(read.omits("nucleus1.windSpeed", "rand"), "{}", read.imported.omissions);
    assert!(read.omits("nParticle1", "recorded results"));
    assert!(read.omits("nParticleShape1", "pointSize"));
    let time = read.imported.scene.time;
    assert_eq!((time.start, time.end), (5, 20), "the run begins where the nucleus does");
    assert_round_trip(&read);
}

#[test]
fn deformed_meshes_become_a_file_for_each_frame() {
    let read = read("deformers.ma");
    assert_eq!(read.get("arm", &mesh::FILE), "meshes/arm.####.obj");
    // The second joint turns by 90° about the origin: (2, 0) to (0, 2), and (2, 1) to (-1, 2).
    let last = read.points("meshes/arm.0003.obj");
    for (point, expected) in
        last.iter().zip([[-2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [-2.0, 1.0, 0.0], [-1.0, 2.0, 0.0]])
    {
        assert!((0..3).all(|k| (point[k] - expected[k]).abs() < 1e-12), "{last:?}");
    }
    // Half the smile of a mesh, and all of the offsets that the file stores.
    let half = read.points("meshes/face.0002.obj");
    assert_eq!(half, [[-2.0, 5.0, 0.5], [2.0, 0.0, 0.5], [-2.0, 1.0, 0.5], [2.0, 8.0, 0.5]]);
    assert!(read.omits("bend1", "nonLinear is not carried out"));
    assert_round_trip(&read);
}

#[test]
fn history_is_carried_out_and_what_is_not_is_named() {
    let read = read("history.ma");
    let points = read.points("meshes/crown.obj");
    // The lowest of the plane's points is at 0, moved by 10; the top is 2 above.
    let heights: Vec<f64> = points.iter().map(|p| p[1]).collect();
    let highest = heights.iter().copied().fold(0.0, f64::max);
    assert!((highest - 12.5).abs() < 1e-9 || (highest - 12.0).abs() < 1e-9, "{heights:?}");
    // Four quads on top, one of them two triangles, less one face; eight sides.
    assert_eq!(read.faces("meshes/crown.obj").len(), 4 + 1 - 1 + 8);
    assert!(read.omits("polyBevel1", "polyBevel is not carried out"));
    assert!(read.omits("drapes", "nurbsTessellate"), "{}", read.imported.omissions);
    assert!(read.graph().find("nRigid2").is_none());
    assert!(read.omits("rigidShape2", "cannot be built"));
    assert_round_trip(&read);
}

#[test]
fn a_mesh_that_cannot_be_built_is_taken_from_the_artist() {
    let given = tempfile::tempdir().unwrap();
    let obj = given.path().join("drapes.obj");
    std::fs::write(&obj, "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n").unwrap();
    let read = read_path(&folder().join("history.ma"), &[("drapes", &obj)]).unwrap();
    assert_eq!(read.points("meshes/drapes.obj").len(), 3);
    assert!(read.graph().find("rigidShape2").is_some());
    assert_round_trip(&read);
}

#[test]
fn a_mesh_of_the_artist_that_nothing_takes_is_refused_with_the_names_that_there_are() {
    let given = tempfile::tempdir().unwrap();
    let obj = given.path().join("m.obj");
    std::fs::write(&obj, "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n").unwrap();
    let Err(error) = read_path(&folder().join("drape.ma"), &[("pPlane", &obj)]) else {
        panic!("it is taken")
    };
    let said = error.to_string();
    assert!(said.contains("`--mesh pPlane=...` names no mesh") && said.contains("`pPlane1`"), "{said}");
    assert!(
        read_path(&folder().join("drape.ma"), &[("pPlaneShape1", &obj)]).is_ok(),
        "the name of the shape"
    );
}

#[test]
fn a_hidden_input_mesh_is_told_from_the_output_of_its_cloth() {
    let read = read("drape.ma");
    let outputs: Vec<&str> = read
        .graph()
        .of_type(&mesh::MESH)
        .filter(|(id, _)| read.graph().source(*id, &surface_shape::IN_MESH).is_some())
        .map(|(_, node)| node.name())
        .collect();
    assert_eq!(outputs, ["outputCloth1"]);
}

#[test]
fn a_broken_file_is_an_error_or_an_omission_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let with = |name: &str, text: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        read_path(&path, &[])
    };
    let error = with("a.ma", b"hello world;\n").err().unwrap().to_string();
    assert!(error.contains("line 1, column 1"), "{error}");
    let error = with("b.mb", b"FOR8\0\0\0\0").err().unwrap().to_string();
    assert!(error.contains("Maya binary"), "{error}");
    let cut =
        with("c.ma", b"//Maya ASCII 2018 scene\ncreateNode transform -n \"a\";\nsetAttr \".t\" -type \"do")
            .unwrap();
    assert!(cut.omits(":3:1", "cut off"), "{}", cut.imported.omissions);
    assert!(read_path(&folder.path().join("none.ma"), &[]).is_err());
    assert!(read_path(folder.path(), &[]).is_err(), "a folder");
}

#[test]
fn long_lines_many_connections_and_broken_numbers_are_no_trouble() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.ma");
    let mut text = String::from(
        "//Maya ASCII 2018 scene\ncreateNode transform -n \"a\";\ncreateNode transform -n \"b\";\n",
    );
    text += "setAttr \".notes\" -type \"string\" \"";
    text += &"x".repeat(3_000_000);
    text +=
        "\";\nsetAttr \".vt[0:4000000000]\" 1 2 3;\nsetAttr \".t\" -type \"double3\" 1e999 -1.#IND nan ;\n";
    for k in 0..300_000 {
        text += &format!("connectAttr \"a.t\" \"b.dnb[{k}]\";\n");
    }
    std::fs::write(&path, text).unwrap();
    let scene = MayaScene::read(&path).unwrap();
    assert_eq!(scene.wires.len(), 300_000);
    let read = read_path(&path, &[]).unwrap();
    assert_round_trip(&read);
}

#[test]
fn values_that_do_not_fit_become_the_nearest_that_do() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ma");
    let text = std::fs::read_to_string(self::folder().join("drape.ma")).unwrap();
    let text = text.replace("\".stch\" 60", "\".stch\" -5").replace("\".sstp\" 4", "\".sstp\" 4.6");
    std::fs::write(&path, text).unwrap();
    let read = read_path(&path, &[]).unwrap();
    assert_eq!(read.get("nCloth1", &n_cloth::STRETCH_RESISTANCE), 0.0);
    assert_eq!(read.get("nucleus1", &nucleus::SUB_STEPS), 5);
    assert_round_trip(&read);
}

#[test]
fn a_texture_path_only_leads_to_reading_a_picture_that_is_there() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ma");
    let mut text = std::fs::read_to_string(self::folder().join("drape.ma")).unwrap();
    text += "createNode file -n \"file1\";\n\tsetAttr \".ftn\" -type \"string\" \"/etc/passwd\";\n\
             connectAttr \"file1.oa\" \"nClothShape1.stmp\";\n";
    std::fs::write(&path, &text).unwrap();
    assert!(read_path(&path, &[]).unwrap().omits("nClothShape1.stretchMap", "/etc/passwd"));
    std::fs::write(folder.path().join("map.png"), "").unwrap();
    std::fs::write(&path, text.replace("/etc/passwd", "D:/show/map.png")).unwrap();
    let read = read_path(&path, &[]).unwrap();
    let Some(nucleus_graph::graph::Setting::Fixed(Value::Painting(painting))) =
        read.graph().node(read.node("nCloth1")).setting(&n_cloth::STRETCH_MAP)
    else {
        panic!("no texture")
    };
    assert!(painting.parts().1.ends_with("map.png"));
}
