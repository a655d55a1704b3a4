//! Welds of borders under load, the share of them that is made, and points that local collision keeps off a surface.

use nucleus_core::ClothId;
use nucleus_graph::Simulation;

use super::scenes::{after, of_nodes, program};

/// Two hung sheets of 1 m², the second beside the first at a gap in metres: only the welds hold it.
fn hung(gap: f64, components: &str) -> f32 {
    let nodes = format!(
        r#""n": nucleus(), "pa": polyPlane(subdivisions: (4, 4), rotate: (90, 0, 0)),
        "pb": polyPlane(subdivisions: (4, 4), translate: ({}, 0, 0), rotate: (90, 0, 0)),
        "a": nCloth(inputMesh: "pa", damp: 0.3, selfCollide: false),
        "b": nCloth(inputMesh: "pb", damp: 0.3, selfCollide: false), "pin": dynamicConstraint(components: ["a"]),
        "s": dynamicConstraint(type: weldBorders, components: {components}, glueStrength: 0.8)"#,
        1.0 + gap
    );
    let places = after(&program(&of_nodes(&nodes, "")), 24, "b");
    places.into_iter().map(|[_, y, _]| f32::from_bits(y)).fold(f32::INFINITY, f32::min)
}

// Components without edges stood for borders of no length, so that any load broke them.
#[test]
fn welds_of_any_components_hold_the_weight_that_their_border_can_carry() {
    for components in [
        r#"["a", "b"]"#,
        r#"["a.border", "b.border"]"#,
        r#"["a.e[border]", "b.e[border]"]"#,
        r#"["a.where(x > 0.49)", "b.where(x < 0.55)"]"#,
        r#"["a.f[*]", "b.f[*]"]"#,
        r#"["a.e[border]", "b"]"#,
    ] {
        for gap in [0.0, 0.02] {
            // It swings about the seam within the diagonal of the sheet; without welds it falls by 4.9 m.
            let lowest = hung(gap, components);
            assert!(lowest > -2.0, "{components} at a gap of {gap} m: {lowest} m");
        }
    }
}

/// Where a corner of a sheet is that is cut along its middle and swings about its upper corners, seven frames later, and the
/// number of pairs that were left unresolved.
fn cut(self_collide: bool) -> ([f32; 3], u64) {
    let nodes = format!(
        r#""n": nucleus(evaluations: 96), "m": polyPlane(subdivisions: (10, 10), rotate: (-90, 180, 0)),
        "c": nCloth(inputMesh: "m", thickness: 0.005, drag: 0, lift: 0, selfCollide: {self_collide}),
        "pins": dynamicConstraint(constraintType: transform, components: ["c.vtx[0]", "c.vtx[10]"]),
        "cut": dynamicConstraint(constraintType: tearableSurface, components: ["c.where(abs(x) < 0.02)"],
            glueStrength: keys([(1, 1), (19, 1), (20, 0)]))"#
    );
    let program = program(&of_nodes(&nodes, ""));
    let mut run = Simulation::<f32>::new(&program, 1);
    let unresolved = (1..27).map(|_| run.advance(&mut ()).report.pairs_unresolved).sum();
    let mut points = Vec::new();
    run.state().positions(ClothId(0), run.units_per_metre(), &mut points);
    (*points.last().expect("points"), unresolved)
}

// In one plane the borders of a cut have no normal: contact at a rounding error held the halves until the safeguard froze them.
#[test]
fn the_halves_of_a_sheet_that_is_cut_swing_as_they_do_without_contact() {
    let ((free, _), (touching, unresolved)) = (cut(false), cut(true));
    let apart: f32 = free.iter().zip(&touching).map(|(a, b)| (a - b).powi(2)).sum::<f32>().sqrt();
    assert!(apart < 0.01, "{apart} m apart after a way of 0.3 m");
    assert!(unresolved < 10, "{unresolved} pairs");
}

/// The links of a constraint between two sheets of 400 faces.
fn links(constraint: &str) -> Vec<f64> {
    let nodes = format!(
        r#""n": nucleus(), "pa": polyPlane(subdivisions: (20, 20)),
        "pb": polyPlane(subdivisions: (20, 20), translate: (1, 0, 0)),
        "a": nCloth(inputMesh: "pa", selfCollide: false), "b": nCloth(inputMesh: "pb", selfCollide: false),
        "s": dynamicConstraint({constraint})"#
    );
    let input = program(&of_nodes(&nodes, "")).first_input();
    input.constraints[0].formed.iter().flatten().map(|link| link.length).collect()
}

#[test]
fn whole_objects_and_borders_of_points_weld_their_border_edges_alone() {
    let edges = links(r#"type: weldBorders, maxDistance: 0.01, components: ["a.e[border]", "b.e[border]"]"#);
    assert_eq!(edges.len(), 21);
    assert!((edges.iter().sum::<f64>() - 1.05).abs() < 1e-6, "the seam, and half an edge beyond either end");
    for components in [r#"["a", "b"]"#, r#"["a.border", "b.border"]"#] {
        assert_eq!(
            links(&format!("type: weldBorders, maxDistance: 0.01, components: {components}")),
            edges,
            "{components}"
        );
    }
}

#[test]
fn a_point_stands_for_the_edges_at_it() {
    let points = links(
        r#"type: weldBorders, maxDistance: 0.01, components: ["a.where(x > 0.49)", "b.where(x < 0.51)"]"#,
    );
    assert_eq!(points.len(), 21);
    assert!(points.iter().all(|length| (length - 0.05).abs() < 1e-6), "{points:?}");
    let particles = r#""n": nucleus(), "q": nParticle(position: [(0, 0, 0)]), "w": nParticle(position: [(0.01, 0, 0)]),
        "s": dynamicConstraint(type: weldBorders, components: ["q", "w"])"#;
    let input = program(&of_nodes(particles, "")).first_input();
    let lengths: Vec<f64> = input.constraints[0].formed.iter().flatten().map(|link| link.length).collect();
    assert_eq!(lengths, [1.0], "a breaking load per point");
}

#[test]
fn connection_density_is_the_share_of_the_welds_of_borders_that_are_made() {
    let count = |density: f64| {
        let both = r#"components: ["a.e[border]", "b.e[border]"]"#;
        links(&format!("type: weldBorders, maxDistance: 0.01, {both}, connectionDensity: {density}")).len()
    };
    assert_eq!((count(0.0), count(1.0)), (0, 21));
    let half = count(0.5);
    assert!((5..=16).contains(&half), "{half} of 21");
}

// The distance that was kept shrank with the rest length, which is zero where springs pull to the surface.
#[test]
fn local_collide_stops_points_at_the_thickness_where_springs_pull_to_the_surface() {
    for kind in ["pointToSurface", "slideOnSurface"] {
        let lowest = |collide: bool| {
            let nodes = format!(
                r#""n": nucleus(), "pb": polyPlane(width: 0.6, height: 0.6, subdivisions: (2, 2), translate: (0, 0.1, 0)),
                "b": nCloth(inputMesh: "pb", thickness: 0.004, selfCollide: false, collide: false),
                "pk": polyPlane(width: 4, height: 4, subdivisions: (4, 4)), "k": nRigid(inputMesh: "pk", thickness: 0.004),
                "s": dynamicConstraint(type: {kind}, components: ["k", "b"], strength: 0.001, restLengthScale: 0,
                    localCollide: {collide}, collideWidthScale: 5)"#
            );
            let places = after(&program(&of_nodes(&nodes, "")), 24, "b");
            places.into_iter().map(|[_, y, _]| f32::from_bits(y)).fold(f32::INFINITY, f32::min)
        };
        let kept = lowest(true);
        assert!((kept - 0.04).abs() < 0.002, "{kind}: {kept} m, and five times 8 mm is 0.04 m");
        assert!(lowest(false) < 0.0, "{kind}: weak springs alone do not stop it");
    }
}
