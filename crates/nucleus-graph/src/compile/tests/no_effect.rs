//! Attributes that are set and have no effect.

use super::*;

/// The warnings of nodes that run, and of the nucleus by its settings.
fn warnings(nodes: &str) -> Vec<String> {
    let told = |nodes: &str| program(nodes).warnings().to_vec();
    told(nodes).into_iter().map(|warning| warning.message).collect()
}

/// The warnings of a constraint of two sheets, the second 1 m above the first.
fn of_constraint(attributes: &str) -> Vec<String> {
    let above = r#""higher": polyPlane(width: 2, height: 2, subdivisions: (1, 1), translate: (0, 1, 0)),
        "cloth2": nCloth(inputMesh: "higher"),"#;
    warnings(&(sheet("", "") + above + &format!(r#""k": dynamicConstraint({attributes})"#)))
}

#[test]
fn an_attribute_that_a_constraint_of_its_kind_does_not_use_is_a_warning() {
    let both = r#"components: ["cloth1", "cloth2"]"#;
    let hold = "points are held at their own places, not in pairs";
    let no_length = "its links have no length: points are held at their own places";
    let tears = "a tearable surface joins the points that it splits, whatever their distance";
    for (attributes, expected) in [
        (
            r#"components: ["cloth1"], strength: 1, restLengthMethod: constant, restLength: 0.3"#.to_owned(),
            vec![("restLengthMethod", no_length), ("restLength", no_length)],
        ),
        (
            r#"components: ["cloth1"], strength: 1, restLengthScale: 0"#.to_owned(),
            vec![("restLengthScale", no_length)],
        ),
        (r#"components: ["cloth1"], connectionDensity: 0.5"#.to_owned(), vec![("connectionDensity", hold)]),
        (
            r#"components: ["cloth1"], connectionMethod: withinMaxDistance, maxDistance: 0.01"#.to_owned(),
            vec![("connectionMethod", hold), ("maxDistance", hold)],
        ),
        (format!("type: pointToSurface, {both}, friction: 1"), vec![("friction", "its links do not slide")]),
        (
            format!(
                "type: pointToSurface, {both}, connectionUpdate: perFrame, friction: 1, tangentStrength: 0"
            ),
            vec![("friction", "`tangentStrength` is 0")],
        ),
        (
            format!("type: pointToPoint, {both}, localCollide: true"),
            vec![("localCollide", "no link joins a point with a surface")],
        ),
        (
            format!("type: pointToSurface, {both}, localCollide: true, restLengthMethod: constant"),
            vec![("localCollide", "`restLength` is 0")],
        ),
        (
            format!("type: pointToSurface, {both}, collideWidthScale: 2"),
            vec![("collideWidthScale", "`localCollide` is false")],
        ),
        (
            format!("type: pointToPoint, {both}, bendStrength: 5, bendBreakAngle: 30"),
            vec![("bendStrength", "`bend` is false"), ("bendBreakAngle", "`bend` is false")],
        ),
        (
            format!("type: pointToPoint, {both}, restLength: 1"),
            vec![("restLength", "`restLengthMethod` is fromStartDistance")],
        ),
        (
            format!("type: pointToPoint, {both}, tangentStrength: 5"),
            vec![("tangentStrength", "no link joins a point with a surface")],
        ),
        (
            format!("type: pointToPoint, {both}, maxDistance: 0.5"),
            vec![("maxDistance", "`connectionMethod` joins pairs at any distance")],
        ),
        (
            format!("type: pointToSurface, {both}, maxDistance: 0.5"),
            vec![("maxDistance", "`connectionMethod` joins pairs at any distance")],
        ),
        (
            r#"type: tearableSurface, components: ["cloth1"], connectionMethod: nearestPairs, maxDistance: 0.5"#
                .to_owned(),
            vec![("connectionMethod", tears), ("maxDistance", tears)],
        ),
        (
            format!("type: pointToPoint, {both}, dropoffDistance: 5, dropoff: 0.5"),
            vec![
                ("dropoff", "`strengthDropoff` is the same at all distances"),
                ("dropoffDistance", "`strengthDropoff` is the same at all distances"),
            ],
        ),
        (
            r#"type: force, components: ["cloth1"], strengthDropoff: [(0, 0.5), (1, 0.5)], dropoffDistance: 2"#
                .to_owned(),
            vec![("dropoffDistance", "`strengthDropoff` is the same at all distances")],
        ),
        (
            format!("type: pointToPoint, {both}, glueStrengthScale: 2"),
            vec![("glueStrengthScale", "`glueStrength` is 1, which never breaks")],
        ),
        (
            r#"type: weldBorders, components: ["cloth1"], strength: 5"#.to_owned(),
            vec![("strength", "a weld is rigid")],
        ),
        (
            format!("type: pointToSurface, {both}, constraintMethod: weld, tangentStrength: 5"),
            vec![("tangentStrength", "a weld is rigid")],
        ),
        (
            r#"type: force, components: ["cloth1"], scale: (2, 2, 2), rotate: (0, 90, 0)"#.to_owned(),
            vec![
                ("rotate", "its force is towards a point, the same from all sides"),
                ("scale", "its force is towards a point, the same from all sides"),
            ],
        ),
        (
            format!("type: pointToPoint, {both}, restLengthMethod: constant, restLengthScale: 0.5"),
            vec![("restLengthScale", "`restLengthMethod` is constant")],
        ),
    ] {
        let of = |(name, because): &(&str, &str)| format!("`{name}` of `k` has no effect: {because}");
        let expected: Vec<String> = expected.iter().map(of).collect();
        let mut found = of_constraint(&attributes);
        found.sort_unstable_by_key(|message| expected.iter().position(|other| other == message));
        assert_eq!(found, expected, "{attributes}");
    }
}

#[test]
fn attributes_that_a_constraint_uses_or_that_have_their_default_are_no_warnings() {
    let both = r#"components: ["cloth1", "cloth2"]"#;
    for attributes in [
        r#"components: ["cloth1"], connectionDensity: 1, connectionMethod: componentOrder"#.to_owned(),
        format!("type: slideOnSurface, {both}, friction: 1, collideWidthScale: 2"),
        format!(
            "type: pointToSurface, {both}, localCollide: true, collideWidthScale: keys([(1, 2), (5, 1)])"
        ),
        format!("type: pointToPoint, {both}, restLengthMethod: constant, restLength: 1"),
        format!("type: slideOnSurface, {both}, constraintMethod: weld, tangentStrength: 0, friction: 1"),
        format!("type: pointToPoint, {both}, connectionDensity: 0.5, restLengthScale: 0.5"),
        r#"type: tearableSurface, components: ["cloth1"], bendStrength: 5, bendBreakAngle: 30"#.to_owned(),
        format!("type: pointToPoint, {both}, connectionMethod: withinMaxDistance, maxDistance: 2"),
        format!(
            "type: pointToPoint, {both}, maxDistance: 2, connectionDensityRange: [(0, 1), (1, 0)], \
            tangentStrength: 0"
        ),
        format!("type: pointToPoint, {both}, strengthDropoff: [(0, 1), (1, 0)], dropoffDistance: 5"),
        format!("type: pointToPoint, {both}, glueStrength: 0.5, glueStrengthScale: 2"),
        r#"type: weldBorders, components: ["cloth1"], maxDistance: 0.2"#.to_owned(),
        r#"type: tearableSurface, components: ["cloth1"], maxDistance: 0.01, glueStrengthScale: 2"#
            .to_owned(),
        r#"type: force, components: ["cloth1"], dropoffDistance: 2, translate: (0, 1, 0)"#.to_owned(),
        r#"type: force, components: ["cloth1"], strength: 1, scale: (2, 2, 2)"#.to_owned(),
        // Alone it turns pins into springs.
        r#"components: ["cloth1"], dropoffDistance: 5"#.to_owned(),
    ] {
        assert_eq!(of_constraint(&attributes), Vec::<String>::new(), "{attributes}");
    }
}

#[test]
fn strength_of_a_weld_counts_passes_in_the_classic_model() {
    let welded = r#""k": dynamicConstraint(type: weldBorders, components: ["cloth1"], strength: 5)"#;
    assert_eq!(warnings(&(sheet("resistanceModel: classic", "") + welded)), Vec::<String>::new());
}

#[test]
fn a_whole_object_that_a_constraint_lets_collide_with_nothing_is_a_warning() {
    let told = |name: &str| format!("`k` lets all of `{name}` collide with nothing");
    for (attributes, expected) in [
        (r#"components: ["cloth1", "cloth2.vtx[0:1]"]"#, vec![told("cloth1")]),
        (r#"components: ["cloth1.vtx[0:3]", "cloth2"]"#, vec![told("cloth1"), told("cloth2")]),
        (r#"components: ["cloth1.vtx[0:1]", "cloth2.vtx[0:1]"]"#, vec![]),
        (r#"components: ["cloth1"], enable: keys([(1, true), (9, false)])"#, vec![]),
    ] {
        assert_eq!(of_constraint(&format!("type: disableCollision, {attributes}")), expected, "{attributes}");
    }
    let pairs = r#"type: collisionExclusion, components: ["cloth1", "cloth2"]"#;
    assert_eq!(of_constraint(pairs), Vec::<String>::new());
}

#[test]
fn a_time_that_advances_by_more_than_the_frame_jump_limit_is_a_warning() {
    let fast = "currentTime: keys([(1, 1), (11, 21), (24, 34)])";
    let expected = "`nucleus1` stands still in 10 of 23 evaluations: its `currentTime` advances by 2.000 to frame \
        2, and `frameJumpLimit` is 1";
    assert_eq!(warnings(&sheet(fast, "")), [expected]);
    for fine in [
        "currentTime: keys([(1, 1), (24, 12)])".to_owned(),
        "currentTime: keys([(1, 24), (24, 1)])".to_owned(),
        format!("{fast}, frameJumpLimit: 2"),
    ] {
        assert_eq!(warnings(&sheet(&fine, "")), Vec::<String>::new(), "{fine}");
    }
}

#[test]
fn a_direction_of_zero_that_switches_gravity_wind_or_the_floor_off_is_a_warning() {
    for (nucleus, expected) in [
        ("gravityDirection: (0, 0, 0)", "`nucleus1` has no gravity: its `gravityDirection` is zero"),
        ("windSpeed: 3, windDirection: (0, 0, 0)", "`nucleus1` has no wind: its `windDirection` is zero"),
        (
            "usePlane: true, planeNormal: (0, 0, 0)",
            "`nucleus1` has no ground plane: its `planeNormal` is zero",
        ),
    ] {
        assert_eq!(warnings(&sheet(nucleus, "")), [expected], "{nucleus}");
    }
    for nucleus in [
        "gravity: 0, gravityDirection: (0, 0, 0)",
        "gravityDirection: keys([(1, (0, 0, 0)), (9, (0, -1, 0))])",
    ] {
        assert_eq!(warnings(&sheet(nucleus, "")), Vec::<String>::new(), "{nucleus}");
    }
}

#[test]
fn a_switch_that_is_off_needs_nothing_else_to_be_off() {
    let of_field = |attributes: &str| {
        let field = format!(r#""drag": dragField(target: "cloth1", {attributes})"#);
        warnings(&(sheet("", "") + &field))
    };
    assert_eq!(of_field("useMaxDistance: false"), Vec::<String>::new());
    assert_eq!(of_field("useMaxDistance: true, maxDistance: 2"), Vec::<String>::new());
    assert!(of_field("useMaxDistance: true, maxDistance: 0")[0].contains("`maxDistance` is not above zero"));
}

#[test]
fn attributes_that_are_read_once_cannot_be_keyed() {
    let at_start = |nodes: &str| {
        let text = format!("Scene(time: (start: 1, end: 24, fps: 24), nodes: {{{nodes}}})");
        let found = read_scene_text(&text, Path::new("test.ron")).expect_err("it cannot be keyed");
        assert!(found[0].message.ends_with("cannot be keyed: it is read once, at the start"), "{found:?}");
    };
    for name in ["strength", "tangentStrength", "glueStrength", "weight"] {
        at_start(&format!(r#""c": nComponent({name}: keys([(1, 1), (12, 0)]))"#));
    }
    at_start(&sheet("", "pressureMethod: volumeTrackingModel, startPressure: keys([(1, 0), (12, 1)])"));
    at_start(&sheet("", "wrinklePerVertex: [1, 0, 0, 0], wrinkleMapScale: keys([(1, 0), (12, 1)])"));
}

#[test]
fn keys_of_the_pairing_of_a_constraint_that_pairs_once_are_a_warning() {
    for (name, keys) in [
        ("connectionMethod", "keys([(1, componentOrder), (12, nearestPairs)])"),
        ("componentRelation", "keys([(1, allToFirst), (12, chain)])"),
        ("connectWithinComponent", "keys([(1, false), (12, true)])"),
        ("connectionDensity", "keys([(1, 0.5), (12, 1)])"),
    ] {
        let of = |more: &str| {
            of_constraint(&format!(
                r#"type: pointToPoint, components: ["cloth1", "cloth2"], {name}: {keys}{more}"#
            ))
        };
        assert_eq!(of(""), [format!("`{name}` of `k` changes, and is read once: when its links form")]);
        assert_eq!(of(", connectionUpdate: perFrame"), Vec::<String>::new(), "{name}");
    }
}

#[test]
fn a_rest_shape_that_changes_is_a_warning() {
    let of = |attributes: &str| {
        let rest = format!(r#""rest": polyPlane(width: 2, height: 2, subdivisions: (1, 1), {attributes}),"#);
        warnings(&(sheet("", r#"restShapeMesh: "rest""#) + &rest))
    };
    let expected = "`cloth1` rests in the shape of `rest` at the start, and does not follow its changes";
    assert_eq!(of("scale: keys([(1, (1, 1, 1)), (20, (0.8, 0.8, 0.8))])"), [expected]);
    assert_eq!(
        of("translateY: keys([(1, 0), (20, 3)]), rotateY: keys([(1, 0), (20, 90)])"),
        Vec::<String>::new()
    );
    assert_eq!(of("scale: (2, 2, 2)"), Vec::<String>::new());
    let blends = r#"blendTarget: "high", blend: keys([(1, 0), (11, 1)])"#;
    let high = r#""high": polyPlane(width: 3, height: 2, subdivisions: (1, 1)),"#;
    let rest = format!(r#""rest": polyPlane(width: 2, height: 2, subdivisions: (1, 1), {blends}),"#);
    assert_eq!(warnings(&(sheet("", r#"restShapeMesh: "rest""#) + &rest + high)), [expected]);
}

#[test]
fn an_attribute_of_an_emitter_of_another_type_is_a_warning() {
    let of = |attributes: &str| {
        let nodes = r#""p": nParticle(), "plane": polyPlane(), "e": pointEmitter(target: "p", "#;
        let found = warnings(&(r#""nucleus1": nucleus(),"#.to_owned() + nodes + attributes + ")"));
        found.into_iter().map(|message| message.replace(" of `e` has no effect", "")).collect::<Vec<_>>()
    };
    let surface = r#"emitterType: surface, parent: "plane""#;
    for (attributes, expected) in [
        (format!(r#"{surface}, rateMap: texture("no.png")"#), "`rateMap`: `enableTextureRate` is false"),
        (format!("{surface}, enableTextureRate: true"), "`enableTextureRate`: it needs `rateMap`"),
        (format!("{surface}, emitFromDark: true"), "`emitFromDark`: `enableTextureRate` is false"),
        (format!("{surface}, spread: 0.5"), "`spread`: `emitterType` is surface"),
        ("spread: 0.5".to_owned(), "`spread`: `emitterType` is omni"),
        ("normalSpeed: 2".to_owned(), "`normalSpeed`: `emitterType` is omni"),
        ("tangentSpeed: 2".to_owned(), "`tangentSpeed`: `emitterType` is omni"),
        ("emitterType: volume, sectionRadius: 0.2".to_owned(), "`sectionRadius`: `volumeShape` is cube"),
        ("emitterType: volume, volumeSweep: 90".to_owned(), "`volumeSweep`: `volumeShape` is cube"),
        ("sectionRadius: 0.2".to_owned(), "`sectionRadius`: `emitterType` is omni"),
    ] {
        assert_eq!(of(&attributes), [expected], "{attributes}");
    }
    for attributes in [
        format!("{surface}, normalSpeed: 2, tangentSpeed: 1, emitFromDark: false"),
        "spread: 0, tangentSpeed: 0".to_owned(),
        "emitterType: directional, spread: 0.5".to_owned(),
        "emitterType: volume, volumeShape: torus, sectionRadius: 0.2, volumeSweep: 90".to_owned(),
    ] {
        assert_eq!(of(&attributes), Vec::<String>::new(), "{attributes}");
    }
}

#[test]
fn an_attribute_of_something_that_is_switched_off_is_a_warning() {
    for (attributes, expected) in [
        (
            "bendResistance: 0, bendAngleDropoff: 0.5",
            "`bendAngleDropoff` of `cloth1` has no effect: `bendResistance` is 0",
        ),
        (
            "bendResistance: 0, restitutionAngle: 20",
            "`restitutionAngle` of `cloth1` has no effect: `bendResistance` is 0",
        ),
        (
            "selfCollide: false, selfCollisionFlag: vertex",
            "`selfCollisionFlag` of `cloth1` has no effect: `selfCollide` is false",
        ),
        (
            "selfCollide: false, selfCollideWidthScale: 2",
            "`selfCollideWidthScale` of `cloth1` has no effect: `selfCollide` is false",
        ),
        (
            "collide: false, selfCollide: false, friction: 0.5",
            "`friction` of `cloth1` has no effect: `collide` is false",
        ),
    ] {
        assert_eq!(warnings(&sheet("", attributes)), [expected]);
    }
    for attributes in [
        "bendResistance: 0, bendStiffness: 1, bendAngleDropoff: 0.5",
        "bendResistance: keys([(1, 0), (9, 1)]), restitutionAngle: 20",
        "selfCollide: keys([(1, false), (9, true)]), selfCollisionFlag: vertex",
        "collide: false, friction: 0.5",
    ] {
        assert_eq!(warnings(&sheet("", attributes)), Vec::<String>::new(), "{attributes}");
    }
    let rigid = r#""ball": polySphere(), "r": nRigid(inputMesh: "ball", collide: false, friction: 1)"#;
    let found = warnings(&(sheet("", "") + rigid));
    assert_eq!(found, ["`friction` of `r` has no effect: `collide` is false"]);
    let particles = r#""nucleus1": nucleus(), "p": nParticle(position0: [(0, 0, 0)], radiusScaleInput: age)"#;
    let found = warnings(particles);
    assert_eq!(
        found,
        ["`radiusScaleInput` of `p` has no effect: it needs `radiusScale` or `radiusScaleRandomize`"]
    );
}

#[test]
fn an_object_that_is_connected_to_no_nucleus_is_a_warning() {
    let text = r#"Scene(time: (start: 1, end: 2, fps: 24), nodes: {
        "n": nucleus(), "p": polyPlane(), "c": nCloth(inputMesh: "p"), "r": nRigid(nucleus: "n"),
    }, connections: [("p.worldMesh[0]", "r.inputMesh")])"#;
    let (scene, _) = read_scene_text(text, Path::new("test.ron")).expect("it can be read");
    let warnings = compile(&scene).expect("it compiles").warnings().to_vec();
    let messages: Vec<&str> = warnings.iter().map(|warning| warning.message.as_str()).collect();
    assert_eq!(messages, ["`r` is not solved: it is connected to no nucleus"]);
}

#[test]
fn an_object_that_follows_simulated_cloth_is_an_error_with_a_way_out() {
    let refused = |mesh: &str| {
        let text = format!(
            r#"Scene(time: (start: 1, end: 2, fps: 24), nodes: {{
                "n": nucleus(), "n2": nucleus(), "p": polyPlane(), "r": nRigid(),
                "c": nCloth(inputMesh: "p", nucleus: "n"),
            }}, connections: [
                ("{mesh}", "r.inputMesh"), ("r.currentState", "n2.inputPassive[0]"), ("r.startState", "n2.inputPassiveStart[0]"),
            ])"#
        );
        let (scene, _) = read_scene_text(&text, Path::new("test.ron")).expect("it can be read");
        compile(&scene).expect_err("it is refused")[0].message.clone()
    };
    let message =
        |source: &str| format!("`r` cannot follow `{source}`: the result of cloth is no input mesh yet");
    assert_eq!(refused("c.outputMesh"), message("c"));
    assert_eq!(refused("outputCloth1.worldMesh[0]"), message("outputCloth1"));
}
