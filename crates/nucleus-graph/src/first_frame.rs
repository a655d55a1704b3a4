//! Warnings about the state at the first frame: units that were forgotten, objects that start in each other, thickness
//! beyond what the mesh can keep apart.
//!
//! They need the compiled scene and look at every element, so that only `nucleus check` and `nucleus run` ask for them.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use nucleus_audit::{Body, CollisionMesh, intersections};
use nucleus_core::{ClothFrame, ClothId, Faces, FrameInput, Surface};

use crate::attributes::{Choice, dynamic_constraint, nucleus};
use crate::audit::{AuditScope, collision_rules};
use crate::compile::{NucleusProgram, Object, ObjectKind, Program};
use crate::diagnostic::Findings;
use crate::mesh::{bounding_box, is_closed, sides};
use crate::scene::{Diagnostic, Scene};

/// `connectionMethod`.
const WITHIN_MAX_DISTANCE: Choice = Choice(1);
/// Acceleration of gravity, in m/s², above which it is taken for centimetres.
const MAX_GRAVITY: f64 = 100.0;
/// Width of a cloth in metres above which a scene without `spaceScale` is taken for centimetres.
const MAX_WIDTH: f64 = 30.0;
/// Width of a cloth in metres below which a `spaceScale` is taken for a mistake.
const MIN_WIDTH: f64 = 0.002;
/// Thickness of each side over the median edge length, above which neighbouring points are in contact at rest.
const MAX_THICKNESS_PER_EDGE: f64 = 0.5;

/// The warnings about the first frame of a compiled scene, in the order of their places in the file.
pub fn first_frame_warnings(scene: &Scene, program: &Program) -> Vec<Diagnostic> {
    let mut findings = Findings::new(scene.source.file().to_owned());
    let inputs: Vec<FrameInput> = program.first_inputs().collect();
    for (nucleus, input) in program.nuclei().iter().zip(&inputs) {
        warn_of_gravity(scene, nucleus, input, &mut findings);
        warn_of_scale(scene, program, nucleus, &mut findings);
        warn_of_missing_links(scene, nucleus, input, &mut findings);
    }
    for object in program.objects() {
        if let ObjectKind::Cloth(cloth) = object.kind {
            let (owner, own) = program.locate_cloth(cloth);
            warn_of_thickness(scene, program, (object, owner, own), &inputs[owner], &mut findings);
        }
    }
    warn_of_intersections(scene, program, &mut findings);
    findings.in_order()
}

fn warn_of_gravity(scene: &Scene, nucleus: &NucleusProgram, input: &FrameInput, findings: &mut Findings) {
    let gravity = input.gravity.norm();
    if gravity <= MAX_GRAVITY {
        return;
    }
    let name = scene.graph.node(nucleus.node()).name();
    let message = format!("`gravity` of `{name}` has a strength of {gravity} m/s²; that of the Earth is 9.8");
    let warning = findings.warning(&scene.source.place(&format!("{name}.gravity")), message);
    warning
        .help("gravity is in m/s² whatever the unit of length: leave it at 9.8 and set `spaceScale: 0.01` for centimetres");
}

/// A constraint whose components are too far apart, or too few, joins nothing.
fn warn_of_missing_links(
    scene: &Scene,
    nucleus: &NucleusProgram,
    input: &FrameInput,
    findings: &mut Findings,
) {
    for (id, constraint) in nucleus.linking_constraints().zip(&input.constraints) {
        if constraint.formed.as_ref().is_some_and(Vec::is_empty) {
            let name = scene.graph.node(id).name();
            let method = scene.graph.node(id).get(&dynamic_constraint::CONNECTION_METHOD);
            let message = format!("`{name}` joins nothing at the first frame");
            let warning = findings.warning(&scene.source.place(name), message);
            warning.help(match method == WITHIN_MAX_DISTANCE {
                true => {
                    "no elements are within `maxDistance` of each other, or `connectionDensity` leaves none"
                }
                false => "it needs two elements at least; particles must be there when it is enabled",
            });
        }
    }
}

/// A scene in centimetres without `spaceScale` falls a hundred times too slowly.
fn warn_of_scale(scene: &Scene, program: &Program, nucleus: &NucleusProgram, findings: &mut Findings) {
    let own = nucleus.cloths();
    let cloths = program.objects().iter().filter_map(|object| match object.kind {
        ObjectKind::Cloth(id) if own.contains(&id.0) && !object.faces.is_empty() => {
            Some((object, width(nucleus.model().positions(ClothId(id.0 - own.start)))))
        }
        _ => None,
    });
    let Some((widest, width)) = cloths.max_by(|a, b| a.1.total_cmp(&b.1)) else { return };
    let node = scene.graph.node(nucleus.node());
    let (name, cloth, unit) = (node.name(), &widest.name, 1.0 / nucleus.units_per_metre());
    let place = scene.source.place(&format!("{name}.spaceScale"));
    let is_given = scene.graph.is_given(nucleus.node(), &nucleus::SPACE_SCALE);
    if width > MAX_WIDTH && !is_given {
        let message = format!("`{cloth}` is {width:.0} m wide: without `spaceScale` a scene unit is a metre");
        let help = format!(
            "add `spaceScale: 0.01` to `{name}` if lengths are in centimetres, or `spaceScale: 1` to confirm metres"
        );
        findings.warning(&place, message).help(help);
    } else if width < MIN_WIDTH && is_given {
        let message = format!("`{cloth}` is {:.2} mm wide: a scene unit is {unit} m", 1000.0 * width);
        findings
            .warning(&place, message)
            .help(format!("`spaceScale` of `{name}` is in metres per scene unit"));
    }
}

/// The longest side of the bounding box.
fn width(positions: &[Vector3<f64>]) -> f64 {
    let [low, high] = bounding_box(positions);
    (high - low).max()
}

fn warn_of_thickness(
    scene: &Scene,
    program: &Program,
    (object, owner, own): (&Object, usize, ClothId),
    input: &FrameInput,
    findings: &mut Findings,
) {
    let nucleus = &program.nuclei()[owner];
    let Some(edge) = median_edge(&nucleus.model().cloths()[own.index()].surface) else { return };
    let cloth = &input.cloths[own.index()];
    let Some(thickness) = cloth_contact_thickness(cloth, input.cloths.len() > 1) else { return };
    if thickness <= MAX_THICKNESS_PER_EDGE * edge {
        return;
    }
    let [thickness, edge] = [thickness, edge].map(|metres| metres * nucleus.units_per_metre());
    let name = &object.name;
    let message = format!(
        "`{name}` keeps {thickness:.3} from cloth on each side, but its edges are {edge:.3} long: its own points are too \
         close for that"
    );
    let warning = findings.warning(&scene.source.place(&format!("{name}.thickness")), message);
    warning.help(format!(
        "a thickness of at most half an edge, {:.3}, or a coarser mesh; `selfCollideWidthScale` changes self-collision alone",
        0.5 * edge
    ));
}

/// The thickness of a cloth in contact with cloth, in metres; `None` if it has none.
fn cloth_contact_thickness(cloth: &ClothFrame, has_others: bool) -> Option<f64> {
    let own = cloth.self_collision.on.then_some(cloth.self_collision.thickness);
    let others = (has_others && cloth.collide).then_some(cloth.thickness);
    own.into_iter().chain(others).reduce(f64::max)
}

/// The median edge length in metres; `None` without faces.
fn median_edge(surface: &Surface) -> Option<f64> {
    let mut lengths: Vec<f64> = sides(&surface.faces)
        .map(|[a, b]| (surface.positions[a as usize] - surface.positions[b as usize]).norm())
        .collect();
    if lengths.is_empty() {
        return None;
    }
    let middle = lengths.len() / 2;
    Some(*lengths.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Reports each pair of objects that intersects, and each cloth that lies in a closed collider.
fn warn_of_intersections(scene: &Scene, program: &Program, findings: &mut Findings) {
    let objects = program.objects();
    let body = |object: &Object| Body::mesh(object.name.clone(), object.points, object.faces.iter());
    let world = CollisionMesh::new(objects.iter().map(body).collect());
    let positions: Vec<Vector3<f64>> =
        objects.iter().flat_map(|object| start(program, object.kind)).copied().collect();
    let mut scope = AuditScope::default();
    // Whether each collider leads points out, in the order of the program.
    let mut leads_out = Vec::new();
    for (nucleus, input) in program.nuclei().iter().zip(program.first_inputs()) {
        leads_out.extend(input.colliders.iter().map(|collider| collider.trapped_check));
        scope.add(nucleus, input, |_| Vec::new());
    }
    let filter = collision_rules(program, program.time().start, &scope, &world);
    let mut pairs: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for found in intersections(&world, &filter, &positions) {
        let edge = world.body_of(world.edges()[found.edge.0 as usize][0]);
        let face = world.body_of(world.triangles()[found.face.0 as usize][0]);
        *pairs.entry((edge.min(face), edge.max(face))).or_default() += 1;
    }
    for (&(a, b), &count) in &pairs {
        let (a, b) = if objects[a].name <= objects[b].name { (a, b) } else { (b, a) };
        report_intersection(scene, &objects[a], &objects[b], count, findings);
    }
    for (a, cloth) in objects.iter().enumerate().filter(|(_, object)| is_cloth(object)) {
        for (b, collider) in objects.iter().enumerate().filter(|(_, object)| !is_cloth(object)) {
            // Particles that are yet to be emitted have no first point.
            let Some(point) = start(program, cloth.kind).first() else { continue };
            let is_led_out =
                matches!(collider.kind, ObjectKind::Collider(id) if leads_out.get(id.index()) == Some(&true));
            let own = [world.points_of(a).start as u32];
            let corners = |corner: u32| world.points_of(b).start as u32 + corner;
            let is_excluded =
                || collider.faces.triangles().all(|face| filter.excludes(&own, &face.map(corners)));
            let collides = filter.is_tested(a, b) && !pairs.contains_key(&(a, b)) && !is_excluded();
            if collides && is_led_out && is_inside(point, start(program, collider.kind), &collider.faces) {
                report_inside(scene, cloth, collider, findings);
            }
        }
    }
}

fn is_cloth(object: &Object) -> bool {
    matches!(object.kind, ObjectKind::Cloth(_))
}

/// The positions of an object at the start, in metres.
fn start(program: &Program, kind: ObjectKind) -> &[Vector3<f64>] {
    match kind {
        ObjectKind::Cloth(cloth) => {
            let (owner, own) = program.locate_cloth(cloth);
            program.nuclei()[owner].model().positions(own)
        }
        ObjectKind::Collider(collider) => {
            let (owner, own) = program.locate_collider(collider);
            &program.nuclei()[owner].model().colliders()[own.index()].surface.positions
        }
    }
}

fn report_intersection(scene: &Scene, a: &Object, b: &Object, count: usize, findings: &mut Findings) {
    let (message, help) = if a.name == b.name {
        (
            format!("`{}` starts with {count} intersections with itself", a.name),
            "untangling takes frames and may not succeed: separate its layers at the first frame",
        )
    } else {
        (
            format!("`{}` and `{}` start with {count} intersections of edges with faces", a.name, b.name),
            "move one of them until they are apart at the first frame, or set their `collisionLayer` apart",
        )
    };
    findings.warning(&scene.source.place(&a.name), message).help(help);
}

fn report_inside(scene: &Scene, cloth: &Object, collider: &Object, findings: &mut Findings) {
    let message = format!("`{}` starts inside `{}`", cloth.name, collider.name);
    let help = "it is pushed out through the nearest face: move it outside, or set `trappedCheck: false` on the collider to \
                keep it inside";
    findings.warning(&scene.source.place(&cloth.name), message).help(help);
}

/// Whether a point is inside a closed mesh: a ray to one side passes through an odd number of faces. The faces of an open
/// mesh have no inside.
fn is_inside(point: &Vector3<f64>, positions: &[Vector3<f64>], faces: &Faces) -> bool {
    let corner = |index: u32| positions[index as usize] - point;
    let crossed = faces.triangles().filter(|triangle| is_crossed(triangle.map(corner))).count();
    crossed % 2 == 1 && is_closed(faces)
}

/// Whether the ray along +x from the origin passes through a triangle.
fn is_crossed([a, b, c]: [Vector3<f64>; 3]) -> bool {
    let turn = |p: &Vector3<f64>, q: &Vector3<f64>| p.y * q.z - p.z * q.y;
    // Sides are turned upwards, so that a ray through an edge passes exactly one of its two faces.
    let winds = |p: &Vector3<f64>, q: &Vector3<f64>| (p.z > 0.0) != (q.z > 0.0);
    let mut crossings = 0;
    for (p, q) in [(&a, &b), (&b, &c), (&c, &a)] {
        let (low, high) = if p.z < q.z { (p, q) } else { (q, p) };
        if winds(p, q) && turn(low, high) > 0.0 {
            crossings += 1;
        }
    }
    let normal = (b - a).cross(&(c - a));
    crossings == 1 && normal.x != 0.0 && normal.dot(&a) / normal.x > 0.0
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::compile::compile;
    use crate::scene::read_scene_text;

    /// The messages and the help of the warnings about a scene of these nodes.
    fn warnings(nodes: &str) -> Vec<(String, String)> {
        let text = format!("Scene(time: (start: 1, end: 2, fps: 24), nodes: {{{nodes}}})");
        let (scene, _) = read_scene_text(&text, Path::new("test.ron")).expect(nodes);
        let program = compile(&scene).expect(nodes);
        let found = first_frame_warnings(&scene, &program).into_iter();
        found.map(|warning| (warning.message, warning.help.unwrap_or_default())).collect()
    }

    fn sheet(nucleus: &str, plane: &str, cloth: &str) -> String {
        format!(
            r#""nucleus1": nucleus({nucleus}), "sheet": polyPlane({plane}), "cloth": nCloth(inputMesh: "sheet", {cloth}),"#
        )
    }

    const METRE: &str = "width: 1, height: 1, subdivisions: (10, 10)";

    #[test]
    fn a_sound_scene_has_no_warning() {
        let ball =
            r#""ball": polySphere(radius: 0.3, translate: (0, -0.4, 0)), "rigid": nRigid(inputMesh: "ball")"#;
        assert_eq!(warnings(&(sheet("", METRE, "") + ball)), []);
    }

    #[test]
    fn a_forgotten_space_scale_is_named_with_the_width_that_results() {
        let wide = "width: 100, height: 100, subdivisions: (10, 10)";
        let found = warnings(&sheet("", wide, ""));
        assert_eq!(found[0].0, "`cloth` is 100 m wide: without `spaceScale` a scene unit is a metre");
        assert!(found[0].1.contains("add `spaceScale: 0.01` to `nucleus1`"), "{found:?}");
        assert_eq!(warnings(&sheet("spaceScale: 0.01", wide, "")), []);
        assert_eq!(warnings(&sheet("spaceScale: 1", wide, "")), [], "metres are confirmed");
        let found = warnings(&sheet("spaceScale: 0.001", METRE, ""));
        assert_eq!(found[0].0, "`cloth` is 1.00 mm wide: a scene unit is 0.001 m");
    }

    #[test]
    fn gravity_in_centimetres_is_named() {
        let found = warnings(&sheet("gravity: 980", METRE, ""));
        assert_eq!(
            found[0].0,
            "`gravity` of `nucleus1` has a strength of 980 m/s²; that of the Earth is 9.8"
        );
        assert!(found[0].1.contains("`spaceScale: 0.01`"));
    }

    #[test]
    fn a_thickness_above_half_an_edge_is_named_where_cloth_meets_cloth() {
        let thick = "thickness: 0.06, selfCollide: true";
        let found = warnings(&sheet("", METRE, thick));
        assert!(
            found[0].0.contains("keeps 0.060 from cloth on each side, but its edges are 0.100 long"),
            "{found:?}"
        );
        assert!(found[0].1.contains("at most half an edge, 0.050"), "{found:?}");
        assert_eq!(warnings(&sheet("", METRE, "thickness: 0.05, selfCollide: true")), []);
        assert_eq!(warnings(&sheet("", METRE, "thickness: 0.06, selfCollide: false")), []);
    }

    #[test]
    fn cloth_that_starts_in_a_collider_is_named_with_it() {
        let ball = |y: f64, more: &str| {
            let ball = format!(
                r#""ball": polySphere(radius: 1, translate: (0, {y}, 0)), "rigid": nRigid(inputMesh: "ball", {more})"#
            );
            warnings(&(sheet("", METRE, "") + &ball))
        };
        assert!(ball(0.9, "")[0].0.starts_with("`cloth` and `rigid` start with "), "{:?}", ball(0.9, ""));
        assert_eq!(ball(0.02, "")[0].0, "`cloth` starts inside `rigid`");
        assert_eq!(ball(0.02, "collide: false"), []);
        assert_eq!(ball(0.02, "trappedCheck: false"), [], "it is to stay inside");
        assert_eq!(ball(1.2, ""), []);
    }

    #[test]
    fn particles_that_are_yet_to_be_emitted_start_in_nothing() {
        let nodes = r#""nucleus1": nucleus(), "drops": nParticle(), "e": pointEmitter(target: "drops", rate: 10),
            "ball": polySphere(radius: 1), "rigid": nRigid(inputMesh: "ball")"#;
        assert_eq!(warnings(nodes), []);
    }

    #[test]
    fn cloths_that_start_in_each_other_are_named_unless_they_do_not_collide() {
        let second = |more: &str| {
            let second = format!(
                r#""wall": polyPlane({METRE}, rotate: (90, 0, 0)), "other": nCloth(inputMesh: "wall", {more}),"#
            );
            warnings(&(sheet("", METRE, "") + &second))
        };
        assert!(second("")[0].0.starts_with("`cloth` and `other` start with "), "{:?}", second(""));
        assert_eq!(second("collide: false"), []);
        assert_eq!(second("collisionLayer: 9"), []);
    }

    #[test]
    fn a_point_is_inside_a_closed_mesh_however_the_ray_meets_its_edges() {
        let ball = Surface::sphere(Vector3::zeros(), 1.0, 6);
        for (x, expected) in [(0.0, true), (0.9, true), (-0.9, true), (1.1, false), (-1.1, false)] {
            // Along the axes the ray meets points and edges of the cube's grid.
            for turn in 0..3 {
                let mut at = Vector3::zeros();
                at[turn] = x;
                assert_eq!(is_inside(&at, &ball.positions, &ball.faces), expected, "{at}");
            }
        }
    }
}
