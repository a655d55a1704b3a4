//! Mistakes: place, message and help.

use super::*;

/// The text at the place, message and help of all errors.
fn reported(text: &str) -> Vec<(String, String, Option<String>)> {
    reported_in(text, Path::new("test.ron"))
}

pub(super) fn reported_in(text: &str, file: &Path) -> Vec<(String, String, Option<String>)> {
    let diagnostics = read_scene_text(text, file).map(|_| ()).expect_err(text);
    let all = diagnostics.into_iter().filter(|diagnostic| diagnostic.severity == Severity::Error);
    all.map(|error| (text[error.span].to_owned(), error.message, error.help)).collect()
}

#[track_caller]
fn expect(text: &str, expected: &[(&str, &str, &str)]) {
    let found = reported(text);
    let found: Vec<_> = found
        .iter()
        .map(|(at, message, help)| (at.as_str(), message.as_str(), help.as_deref().unwrap_or("")))
        .collect();
    assert_eq!(found, expected);
}

#[test]
fn the_nearest_attribute_is_suggested() {
    expect(
        &with_nodes(r#""p": polyPlane(), "c": nCloth(inputMesh: "p", bendResistence: 0.4)"#),
        &[(
            "bendResistence",
            "`c` is of type nCloth, which has no attribute `bendResistence`",
            "did you mean `bendResistance`?",
        )],
    );
}

#[test]
fn the_parent_of_a_surface_emitter_is_suggested_for_its_mesh() {
    expect(
        &with_nodes(r#""p": polyPlane(), "e": pointEmitter(inputMesh: "p")"#),
        &[(
            "inputMesh",
            "`e` is of type pointEmitter, which has no attribute `inputMesh`",
            "a surface emitter names its mesh as its parent: `emitterType: surface, parent: \"plane\"`",
        )],
    );
}

#[test]
fn an_object_whose_nucleus_is_not_known_is_reported_once() {
    let text = with_nodes(
        r#""n2": nucleus(), "m": polyPlane(), "c": nCloth(inputMesh: "m", nucleus: "n2"),
           "r": nRigid(inputMesh: "m")"#,
    );
    let found = read_scene_text(&text, Path::new("test.ron")).map(|_| ()).expect_err("two nuclei");
    let messages: Vec<&str> = found.iter().map(|found| found.message.as_str()).collect();
    assert_eq!(messages, ["`r` could belong to `n2` or `nucleus1`"]);
}

#[test]
fn a_check_of_gaps_above_the_thickness_is_refused() {
    let scene = |checks: &str| with_nodes("").replacen("nodes:", &format!("checks: [{checks}], nodes:"), 1);
    assert!(read_scene_text(&scene("minGap(1)"), Path::new("test.ron")).is_ok());
    expect(
        &scene("minGap(10)"),
        &[(
            "10",
            "`minGap` takes at most 1: gaps above the thickness are not measured",
            "write `minGap(1)`, or raise `thickness`",
        )],
    );
}

#[test]
fn all_mistakes_are_reported_together_and_in_order() {
    let text = r#"Scene(
        time: (start: 10, end: 1, fps: 24),
        nodes: {
            "nucleus1": nucleus(subSteps: 0, gravity: "much"),
            "sheet": polyPlan(),
            "cloth1": nCloth(inputMesh: "shet", drag: true, scalingRelation: objectSpce),
        },
        checks: [noPenetrations],
    )"#;
    let found = reported(text);
    let found: Vec<(&str, &str)> =
        found.iter().map(|(at, message, _)| (at.as_str(), message.as_str())).collect();
    let expected = [
        ("1", "the run starts at frame 10 and ends before it, at 1"),
        ("0", "`subSteps` of `nucleus1` must be between 1 and 100000, found 0"),
        ("\"much\"", "`gravity` of `nucleus1` takes a number, found text"),
        ("polyPlan", "there is no type of node `polyPlan`"),
        ("\"shet\"", "there is no node `shet`"),
        ("true", "`drag` of `cloth1` takes a number, found true or false"),
        ("objectSpce", "`scalingRelation` of `cloth1` has no word `objectSpce`"),
        ("noPenetrations", "there is no check `noPenetrations`"),
    ];
    assert_eq!(found, expected);
}

#[test]
fn the_nearest_type_and_the_nearest_word_are_suggested() {
    let found = reported(&with_nodes(r#""a": ncloth(inputMesh: "p"), "p": polyPlane()"#));
    assert_eq!(found[0].2.as_deref(), Some("did you mean `nCloth`?"));
    let found = reported(&with_nodes(
        r#""p": polyPlane(), "c": nCloth(inputMesh: "p", scalingRelation: worldspase)"#,
    ));
    assert_eq!(found[0].2.as_deref(), Some("did you mean `worldSpace`?"));
}

#[test]
fn two_nodes_of_one_name_are_both_shown() {
    let text = with_nodes(r#""a": transform(), "a": polyCube()"#);
    let errors = read_scene_text(&text, Path::new("test.ron")).map(|_| ()).expect_err("two of one name");
    assert_eq!((errors.len(), errors[0].message.as_str()), (1, "there are two nodes `a`"));
    let first = errors[0].notes[0].span.clone().expect("it has a place");
    assert!(first.end < errors[0].span.start);
    assert_eq!(&text[first], "\"a\"");
}

#[test]
fn missing_fields_are_named_with_an_example() {
    expect(
        "Scene(nodes: {})",
        &[("Scene", "`time` is missing", "add `time: (start: 1, end: 120, fps: 24)`")],
    );
    expect(
        "Scene(time: (start: 1, end: 2))",
        &[
            ("Scene", "`nodes` is missing", "add `nodes: {\"nucleus1\": nucleus()}`"),
            ("(start: 1, end: 2)", "`fps` is missing", "add `fps: 24`, the frames per second"),
        ],
    );
    expect(
        "Scene(tiem: (start: 1, end: 2, fps: 24), nodes: {})",
        &[("tiem", "a scene has no `tiem`", "did you mean `time`?")],
    );
}

#[test]
fn errors_of_syntax_have_their_place() {
    assert_eq!(reported("")[0].1, "there is nothing in this file");
    assert_eq!(reported("Scene(time: 1.2.3)")[0].0, "1.2.3");
    assert_eq!(reported("[1, 2]")[0].1, "expected `Scene(...)`, found a list");
}

#[test]
fn a_cloth_needs_a_mesh_and_a_nucleus() {
    expect(
        &with_nodes(r#""c": nCloth()"#),
        &[("\"c\"", "`c` has no `inputMesh`", "add `inputMesh: \"...\"`, the name of a mesh node")],
    );
    expect(
        r#"Scene(time: (start: 1, end: 2, fps: 24), nodes: {"p": polyPlane(), "c": nCloth(inputMesh: "p")})"#,
        &[("\"c\"", "there is no nucleus that `c` could belong to", "add `\"nucleus1\": nucleus()`")],
    );
    expect(
        &with_nodes(r#""c": nCloth(inputMesh: "nucleus1")"#),
        &[("\"nucleus1\"", "`inputMesh` of `c` takes a mesh, but `nucleus1` is of type nucleus", "")],
    );
}

#[test]
fn of_two_nuclei_one_has_to_be_named() {
    let two = |cloth: &str| {
        with_nodes(&format!(r#""other": nucleus(), "p": polyPlane(), "c": nCloth(inputMesh: "p"{cloth})"#))
    };
    expect(
        &two(""),
        &[("\"c\"", "`c` could belong to `nucleus1` or `other`", "say which: `nucleus: \"nucleus1\"`")],
    );
    expect(
        &two(r#", nucleus: "p""#),
        &[("\"p\"", "`nucleus` of `c` takes a nucleus, but `p` is of type polyPlane", "")],
    );
    scene(&two(r#", nucleus: "other""#));
}

#[test]
fn a_constraint_and_its_objects_need_the_same_nucleus() {
    let text = with_nodes(
        r#""other": nucleus(), "p": polyPlane(), "c": nCloth(inputMesh: "p", nucleus: "other"),
           "pin": dynamicConstraint(nucleus: "nucleus1", components: ["c.vtx[0]"])"#,
    );
    expect(
        &text,
        &[(
            "[\"c.vtx[0]\"]",
            "`pin` on `nucleus1` constrains `c` on `other`",
            "a constraint and its objects need the same nucleus",
        )],
    );
}

#[test]
fn errors_of_explicit_connections_have_their_place() {
    let wired = |pair: &str| {
        with_nodes(r#""b": transform(), "p": polyPlane(), "c": nCloth(inputMesh: "p")"#)
            .replace("})", &format!("}}, connections: [{pair}])"))
    };
    for (pair, at, message, help) in [
        (
            r#"("b.tx", "c.frictoin")"#,
            "\"c.frictoin\"",
            "`c` is of type nCloth, which has no attribute `frictoin`",
            "did you mean `friction`?",
        ),
        (r#"("bb.tx", "c.friction")"#, "\"bb.tx\"", "there is no node `bb`", "did you mean `b`?"),
        (
            r#"("b", "c.friction")"#,
            "\"b\"",
            "`b` is not a plug",
            "a plug is `node.attribute` or `node.attribute[0]`, like `time1.outTime`",
        ),
        (r#"("b.t", "c.friction")"#, "", "`b.translate` gives a vector, but `c.friction` takes a number", ""),
        (
            r#"("c.outputMesh", "c.inputMesh")"#,
            "",
            "`c.inputMesh` is connected already, from `p.worldMesh[0]`",
            "",
        ),
        (
            r#"("c.currentState", "nucleus1.inputActive")"#,
            "",
            "`nucleus1.inputActive` holds many: it needs an index, like `nucleus1.inputActive[0]`",
            "",
        ),
        (
            r#"("c.friction", "c.outputMesh")"#,
            "",
            "`c.outputMesh` is an output: nothing can be connected to it",
            "",
        ),
        (
            r#"("c.nextState", "nucleus1.inputActive[3]")"#,
            "",
            "`c.nextState` is an input: nothing can be connected from it",
            "",
        ),
        (r#"("b.tx[0]", "c.friction")"#, "", "`b.translateX[0]` does not hold many: it takes no index", ""),
        (
            r#"("b.tx", "b.ty"), ("b.ty", "b.tx")"#,
            "(\"b.ty\", \"b.tx\")",
            "`b.translateY` depends on `b.translateX`: connecting them would make a cycle",
            "",
        ),
        (
            r#"("b.tx", "b.tx")"#,
            "",
            "`b.translateX` depends on `b.translateX`: connecting them would make a cycle",
            "",
        ),
        (
            r#"3"#,
            "3",
            "a connection is a pair of plugs, found a number",
            "write `connections: [(\"ball.translateY\", \"cloth1.friction\")]`, output first",
        ),
        (r#"("b.tx", 3)"#, "3", "a connection takes text in quotes, found a number", ""),
    ] {
        expect(&wired(pair), &[(if at.is_empty() { pair } else { at }, message, help)]);
    }
}

#[test]
fn several_targets_of_a_field_are_refused_and_the_help_makes_it_act_on_them() {
    let nodes = r#""q": nParticle(position: [(0, 0, 0)]), "s": nParticle(position: [(1, 0, 0)]), "#;
    let field = r#""wind": airField(target: ["q", "s"])"#;
    let help = "name the first here, and connect a field to each of the others: \
        `connections: [(\"wind.outputForce[1]\", \"cloth2.inputForce[0]\")]`";
    let message = "`target` of `wind` takes one name, found a list";
    expect(&with_nodes(&format!("{nodes}{field}")), &[(r#"["q", "s"]"#, message, help)]);
    let wire = r#"connections: [("wind.outputForce[1]", "s.inputForce[0]")]"#;
    let text = with_nodes(&format!(r#"{nodes}"wind": airField(target: "q")"#));
    let wired = scene(&text.replacen("Scene(", &format!("Scene({wire}, "), 1));
    let program = crate::compile::compile(&wired).expect("it compiles");
    assert_eq!(program.first_input().fields[0].targets.len(), 2);
}

#[test]
fn a_blend_needs_a_mesh_of_as_many_points() {
    let text = with_nodes(
        r#""a": polyPlane(blendTarget: "b"), "b": polyPlane(subdivisions: (2, 3)), "c": nCloth(inputMesh: "a")"#,
    );
    let (scene, _) = read_scene_text(&text, Path::new("test.ron")).expect("it reads");
    let errors = crate::compile::compile(&scene).map(|_| ()).expect_err("they differ");
    assert!(errors[0].message.starts_with("`a` cannot be blended into `b`: one has "), "{errors:?}");
    assert_eq!(&text[errors[0].span.clone()], "\"b\"");
    let cycle = with_nodes(r#""a": polyPlane(blendTarget: "b"), "b": polyPlane(blendTarget: "a")"#);
    assert_eq!(reported(&cycle)[0].1, "`b` cannot be blended into `a`, which is blended into it");
}

#[test]
fn the_evaluation_interval_is_a_number_of_frames_or_a_fraction_of_one() {
    let every = |every: &str| {
        format!("Scene(time: (start: 1, end: 9, fps: 24, every: {every}), nodes: {{\"n\": nucleus()}})")
    };
    for (written, read) in [("1", 1.0), ("2", 2.0), ("0.25", 0.25), ("0.3333333", 1.0 / 3.0)] {
        assert_eq!(scene(&every(written)).every, read);
    }
    for written in ["0", "-1", "1.5", "0.4", "1e9"] {
        let message = format!(
            "`every` must be a whole number of frames, or 1 divided by one, found {}",
            written.parse::<f64>().expect("a number")
        );
        assert_eq!(reported(&every(written))[0].1, message);
    }
}

#[test]
fn an_attribute_is_set_once() {
    for fields in ["drag: 1, drag: 2", "drag: 1, drg: 2"] {
        let found =
            reported(&with_nodes(&format!("\"p\": polyPlane(), \"c\": nCloth(inputMesh: \"p\", {fields})")));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].1, "`drag` of `c` is set twice");
    }
    for fields in ["translate: (0, 0, 0), ty: 1", "ty: 1, translate: (0, 0, 0)", "ty: 1, translateY: 1"] {
        let found = reported(&with_nodes(&format!("\"t\": transform({fields})")));
        assert_eq!(found[0].1, "`translate` of `t` is set twice", "{fields}");
    }
    let found = reported(&with_nodes("\"p\": polyPlane(subdivisions: (2, 2), sw: 3)"));
    assert_eq!(found[0].1, "`subdivisionsWidth` of `p` is set twice");
}

#[test]
fn keys_have_an_order_a_form_and_a_tangent() {
    let keyed = |keys: &str| with_nodes(&format!("\"t\": transform(tx: keys({keys}))"));
    expect(
        &keyed("[(5, 0), (1, 2)]"),
        &[("(1, 2)", "the keys of `tx` of `t` are not in order: frame 1 after frame 5", "")],
    );
    expect(
        &keyed("[(5, 0), (5, 2)]"),
        &[("(5, 2)", "the keys of `tx` of `t` are not in order: frame 5 after frame 5", "")],
    );
    expect(&keyed("[]"), &[("[]", "`tx` of `t` has no keys", "give at least one key, like (1, 0)")]);
    expect(&keyed("[3]"), &[("3", "`tx` of `t` takes keys of (frame, value), found a number", "")]);
    expect(
        &keyed("[(1, 2, linaer)]"),
        &[("linaer", "there is no tangent `linaer`", "did you mean `linear`?")],
    );
    expect(
        &with_nodes("\"p\": polyPlane(width: keys([(1, 2)]))"),
        &[("[(1, 2)]", "`width` of `p` cannot be keyed: it is read once, at the start", "")],
    );
    expect(
        &with_nodes("\"t\": transform(translate: keys([(1, (0, 0))]))"),
        &[("(0, 0)", "`translate` of `t` takes three numbers, found 2", "")],
    );
}

#[test]
fn values_have_a_type_and_a_range() {
    for (field, message) in [
        ("subSteps: 2.5", "`subSteps` of `n` takes a whole number, found 2.5"),
        ("usePlane: 1", "`usePlane` of `n` takes true or false, found a number"),
        (
            "gravityDirection: 1",
            "`gravityDirection` of `n` takes three numbers, like (0, 1, 0), found a number",
        ),
        ("gravityDirection: (0, 1)", "`gravityDirection` of `n` takes three numbers, found 2"),
        ("resistanceModel: true", "`resistanceModel` of `n` takes one of its words, found true or false"),
        ("resistanceModel: 7", "`resistanceModel` of `n` takes one of its words, found a number"),
        ("inputActive: 1", "`inputActive` of `n` can be connected, but not set"),
        ("airDensity: -1", "`airDensity` of `n` must be at least 0, found -1"),
        ("gravity: keys([(1, fast)])", "`gravity` of `n` takes a number, found the word `fast`"),
        ("airDensity: keys([(1, -1)])", "`airDensity` of `n` must be at least 0, found -1"),
    ] {
        let text = format!("Scene(time: (start: 1, end: 2, fps: 24), nodes: {{\"n\": nucleus({field})}})");
        assert_eq!(reported(&text)[0].1, message);
    }
}

#[test]
fn names_cannot_be_empty_or_contain_a_dot() {
    let found = reported(&with_nodes("\"a.b\": transform(), \"\": transform()"));
    assert_eq!(found[0].1, "`a.b` is not a name");
    assert_eq!(found[1].1, "`` is not a name");
}

#[test]
fn pins_hold_points_of_cloth_that_are_there() {
    let pinned = |component: &str| {
        with_nodes(&format!(
            r#""p": polyPlane(subdivisions: (2, 2)), "c1": nCloth(inputMesh: "p"),
               "pin": dynamicConstraint(components: ["{component}"])"#
        ))
    };
    expect(&pinned("c2.vtx[0]"), &[("\"c2.vtx[0]\"", "there is no node `c2`", "did you mean `c1`?")]);
    expect(
        &pinned("p.vtx[0]"),
        &[(
            "\"p.vtx[0]\"",
            "only parts of cloth, particles and colliders can be constrained, but `p` is of type polyPlane",
            "did you mean `c1.vtx[0]`?",
        )],
    );
    assert_eq!(
        reported(&pinned("c1.cv[0]"))[0].1,
        "`cv` is no kind of elements: points are `vtx`, edges `e`, faces `f`"
    );
    // A range is checked against its object before it is expanded.
    for last in [9, u32::MAX] {
        let (range, message) = (format!("c1.vtx[0:{last}]"), format!("`c1` has no point {last}"));
        let place = format!("\"{range}\"");
        expect(&pinned(&range), &[(place.as_str(), message.as_str(), "its points are numbered 0 to 8")]);
    }
    // It is reported together with other mistakes.
    let both = pinned("c1.vtx[9]").replace("end: 24", "end: 0");
    assert_eq!(reported(&both).len(), 2);
}

#[test]
fn parents_in_a_cycle_are_refused() {
    let found = reported(&with_nodes(r#""a": transform(parent: "b"), "b": transform(parent: "a")"#));
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].1, "`a` cannot be the parent of `b`: that would make a cycle");
}

#[test]
fn the_arguments_of_checks_are_checked() {
    let with_checks = |checks: &str| {
        format!("Scene(time: (start: 1, end: 2, fps: 24), nodes: {{\"n\": nucleus()}}, checks: {checks})")
    };
    assert_eq!(reported(&with_checks("[maxStretch]"))[0].1, "`maxStretch` takes `strain`");
    assert_eq!(reported(&with_checks("[noPenetration(1)]"))[0].1, "`noPenetration` takes nothing");
    assert_eq!(reported(&with_checks("[atRestBy(frame: 3, sped: 1)]"))[0].1, "`atRestBy` has no `sped`");
    assert_eq!(
        reported(&with_checks("noPenetration"))[0].1,
        "`checks` takes a list, found the word `noPenetration`"
    );
    assert_eq!(
        reported(&with_checks("[maxStretch(true)]"))[0].1,
        "`strain` of `maxStretch` takes a number, found true or false"
    );
}

#[test]
fn checks_that_count_take_whole_numbers_from_zero() {
    let found = |check: &str| {
        let text = format!(
            "Scene(time: (start: 1, end: 2, fps: 24), nodes: {{\"n\": nucleus()}}, checks: [{check}])"
        );
        reported(&text)[0].1.clone()
    };
    for (check, parameter) in
        [("maxUnresolved", "pairs"), ("maxDepenetrating", "points"), ("maxIntersections", "edges")]
    {
        let of = format!("`{parameter}` of `{check}` takes a whole number");
        assert_eq!(found(&format!("{check}(-1)")), format!("{of} from 0, found -1"));
        assert_eq!(found(&format!("{check}(0.5)")), format!("{of}, found 0.5"));
        assert_eq!(found(check), format!("`{check}` takes `{parameter}`"));
    }
}

#[test]
fn a_check_that_cannot_pass_is_reported() {
    let with_check = |check: &str| {
        format!("Scene(time: (start: 1, end: 9, fps: 24), nodes: {{\"n\": nucleus()}}, checks: [{check}])")
    };
    for check in ["maxStretch(-1)", "maxWeldGap(-0.1)", "atRestBy(frame: 3, speed: -1)"] {
        let below = format!("`{check}` cannot pass: what it limits is never below 0");
        assert_eq!(reported(&with_check(check))[0].1, below);
    }
    let warnings = |check: &str| {
        let read = read_scene_text(&with_check(check), Path::new("test.ron")).expect("the run may be longer");
        read.1.into_iter().map(|warning| warning.message).collect::<Vec<_>>()
    };
    for check in ["atRestBy(frame: 10, speed: 0.1)", "noIntersectionsAfter(10)"] {
        assert_eq!(warnings(check), [format!("`{check}` cannot pass: the scene ends at frame 9")]);
    }
    for check in ["atRestBy(frame: 9, speed: 0)", "maxStretch(0)", "minGap(-1)"] {
        assert_eq!(warnings(check), Vec::<String>::new());
    }
}

#[test]
fn a_frame_rate_out_of_range_is_told_its_bound() {
    let found = |fps: &str| {
        let text = format!("Scene(time: (start: 1, end: 2, fps: {fps}), nodes: {{\"n\": nucleus()}})");
        reported(&text)[0].1.clone()
    };
    assert_eq!(found("0"), "`fps` must be above 0, found 0");
    assert_eq!(found("0.0001"), "`fps` must be from 0.001 to 1000000, found 0.0001");
    assert_eq!(found("2000000"), "`fps` must be from 0.001 to 1000000, found 2000000");
}

#[test]
fn an_input_that_cannot_be_set_names_the_attribute_that_is_meant() {
    let found = &reported(&with_nodes(r#""p": nParticle(positions: [(0, 0, 0)])"#))[0];
    assert_eq!(found.1, "`positions` of `p` can be connected, but not set");
    assert_eq!(found.2.as_deref(), Some("did you mean `position`?"));
}

#[test]
fn a_former_name_of_a_check_is_read_with_a_warning_that_gives_the_new_one() {
    let with_check = |check: &str| {
        format!("Scene(time: (start: 1, end: 9, fps: 24), nodes: {{\"n\": nucleus()}}, checks: [{check}])")
    };
    for (former, current, arguments) in [
        ("maxTrapped", "maxDepenetrating", "(3)"),
        ("maxTangled", "maxIntersections", "(3)"),
        ("noCrossing", "noSelfIntersection", ""),
        ("restsBy", "atRestBy", "(frame: 3, speed: 0.5)"),
        ("separatedBy", "noIntersectionsAfter", "(3)"),
        ("untangledBy", "noIntersectionsAfter", "(3)"),
    ] {
        let text = with_check(&format!("{former}{arguments}"));
        let (read, warnings) = read_scene_text(&text, Path::new("test.ron")).expect("a former name is read");
        assert_eq!(read.checks, scene(&with_check(&format!("{current}{arguments}"))).checks);
        let [warning] = warnings.as_slice() else { panic!("{warnings:#?}") };
        assert_eq!(warning.severity, Severity::Warning);
        assert_eq!(warning.message, format!("`{former}` is now called `{current}`"));
        assert_eq!(&text[warning.span.clone()], former);
        assert_eq!(warning.help, Some(format!("write `{current}` in its place")));
        assert!(write_scene(&read).contains(&format!("checks: [{current}{arguments}]")));
    }
}
