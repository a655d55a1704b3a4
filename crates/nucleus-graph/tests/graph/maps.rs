//! Vertex maps: attributes that differ from point to point.

use std::fs;
use std::path::Path;

use nucleus_graph::Simulation;
use nucleus_graph::compile::compile;
use nucleus_graph::scene::{Diagnostic, format_scene, read_scene_text};
use proptest::prelude::*;

use super::scenes::{after, of_nodes, png, program};

/// A hanging sheet of 5 by 5 points, and a cloth with these fields.
fn hanging(cloth: &str) -> String {
    of_nodes(
        &format!(
            r#""n": nucleus(), "p": polyPlane(width: 2, height: 2, subdivisions: (4, 4)),
               "c": nCloth(inputMesh: "p", shearResistance: 5, {cloth}),
               "h": dynamicConstraint(components: ["c.vtx[20:24]"])"#
        ),
        "",
    )
}

/// All diagnostics of a text, those of compiling included.
fn diagnostics(text: &str, file: &Path) -> Vec<Diagnostic> {
    match read_scene_text(text, file) {
        Err(mistakes) => mistakes,
        Ok((scene, mut warnings)) => match compile(&scene) {
            Ok(program) => {
                warnings.extend(program.warnings().iter().cloned());
                warnings
            }
            Err(mistakes) => mistakes,
        },
    }
}

/// The message and the text at the place of each diagnostic.
fn messages<'t>(text: &'t str, file: &Path) -> Vec<(String, &'t str)> {
    diagnostics(text, file)
        .into_iter()
        .map(|diagnostic| (diagnostic.message, &text[diagnostic.span]))
        .collect()
}

fn model(text: &str) -> String {
    let program = program(text);
    format!("{:?} {:?}", program.model(), program.first_input())
}

/// An attribute, the name of its map, and its default.
const MAPS: [(&str, &str, f64); 10] = [
    ("pointMass", "mass", 1.0),
    ("damp", "damp", 0.1),
    ("stretchResistance", "stretch", 20.0),
    ("compressionResistance", "compression", 10.0),
    ("bendResistance", "bend", 0.1),
    ("restLengthScale", "restLengthScale", 1.0),
    ("drag", "drag", 0.05),
    ("tangentialDrag", "tangentialDrag", 0.5),
    ("lift", "lift", 0.05),
    ("friction", "friction", 0.1),
];

/// A cloth whose attribute is `value`. Without compression, because the stretch map holds for compression too.
fn plain(attribute: &str, value: f64) -> String {
    let others = [("damp", 0.1), ("compressionResistance", 0.0)];
    let others = others.iter().filter(|(other, _)| *other != attribute);
    let others: String = others.map(|(other, value)| format!(", {other}: {value}")).collect();
    hanging(&format!("{attribute}: {value}{others}"))
}

/// The same with a map.
fn mapped(map: &str, attribute: &str, value: f64, values: &str) -> String {
    plain(attribute, value).replace(
        &format!("{attribute}: "),
        &format!("{map}MapType: perVertex, {map}PerVertex: {values}, {attribute}: "),
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_constant_map_scales_its_attribute(
        which in 0..MAPS.len(), factor in prop_oneof![0.01..100.0f64, Just(0.0), Just(1.0)]
    ) {
        let (attribute, map, default) = MAPS[which];
        prop_assume!(factor > 0.0 || map != "mass");
        let given = mapped(map, attribute, default, &format!("{:?}", vec![factor; 25]));
        let scaled = plain(attribute, default * factor);
        prop_assert_eq!(model(&given), model(&scaled), "{}", map);
    }

    #[test]
    fn a_list_a_file_and_an_expression_give_the_same_map(values in prop::collection::vec(0.1..3.0f64, 25)) {
        let folder = tempfile::tempdir().expect("a folder");
        let lines: Vec<String> = values.iter().enumerate().map(|(k, x)| format!("{x}, # point {k}")).collect();
        fs::write(folder.path().join("w.txt"), lines.join("\n")).expect("written");
        let choice = values.iter().enumerate().map(|(k, x)| format!("(i == {k}) * {x}"));
        let expression = choice.collect::<Vec<_>>().join(" + ");
        let at = |values: &str| {
            let text = mapped("bend", "bendResistance", 0.1, values);
            let (scene, _) = read_scene_text(&text, &folder.path().join("scene.ron")).expect("it reads");
            format!("{:?}", compile(&scene).unwrap_or_else(|diagnostic| panic!("{diagnostic:?}")).model())
        };
        let list = at(&format!("{values:?}"));
        prop_assert_eq!(&at(r#"file("w.txt")"#), &list);
        prop_assert_eq!(&at(&format!("expression({expression:?})")), &list);
    }
}

#[test]
fn a_selection_gives_the_map_of_the_expression_that_says_the_same() {
    let at = |values: &str| model(&mapped("bend", "bendResistance", 0.1, values));
    for (selection, expression) in [
        ("border ? 5 : 1", "abs(x) > 0.99 || abs(z) > 0.99 ? 5 : 1"),
        ("corners", "abs(x) > 0.99 && abs(z) > 0.99 ? 1 : 0"),
        (
            "where(x > (z > 0 ? 0.4 : 0.3)); 3; 7:9 ? 2 : 0.5",
            "x > 0.4 || i == 3 || i > 6 && i < 10 ? 2 : 0.5",
        ),
    ] {
        let [selected, computed] =
            [format!("selection({selection:?})"), format!("expression({expression:?})")];
        assert_eq!(at(&selected), at(&computed), "{selection}");
    }
}

#[test]
fn a_selection_of_a_group_and_of_a_mask_weigh_their_points() {
    let folder = tempfile::tempdir().expect("a folder");
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).expect("written");
    let corners = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n";
    let uvs = "vt 0.1 0.1\nvt 0.4 0.1\nvt 0.9 0.1\nvt 0.1 0.9\nvt 0.4 0.9\nvt 0.9 0.9\n";
    let faces = "g left\nf 1/1 2/2 5/5 4/4\ng right\nf 2/2 3/3 6/6 5/5\n";
    put("a.obj", format!("{corners}{uvs}{faces}").as_bytes());
    put("half.png", &png(2, &[0, 255, 0, 255]));
    let at = |values: &str| {
        let nodes = format!(
            r#""n": nucleus(), "m": mesh(file: "a.obj"), "c": nCloth(inputMesh: "m", bendPerVertex: {values})"#
        );
        let text = of_nodes(&nodes, "");
        let (scene, _) = read_scene_text(&text, &folder.path().join("scene.ron")).expect("it reads");
        format!("{:?}", compile(&scene).unwrap_or_else(|diagnostic| panic!("{diagnostic:?}")).model())
    };
    assert_eq!(at(r#"selection("group(left) ? 3 : 1")"#), at("[3, 3, 1, 3, 3, 1]"));
    assert_eq!(at(r#"selection("mask(half.png) ? 3 : 1")"#), at("[1, 1, 3, 1, 1, 3]"));
}

#[test]
fn every_map_changes_the_motion() {
    // Friction needs a contact; the core tests it with cloth that slides down slopes.
    for (attribute, map, default) in MAPS.into_iter().filter(|(_, map, _)| *map != "friction") {
        let default = if map == "damp" { 3.0 } else { default };
        let varied = program(&mapped(map, attribute, default, r#"expression("0.25 + u")"#));
        let even = program(&plain(attribute, default));
        assert_ne!(after(&varied, 6, "c"), after(&even, 6, "c"), "{map}");
    }
}

/// A sheet between two held edges, three times as heavy on one half, sags more there than at the mirrored place.
#[test]
fn a_sheet_that_is_heavy_on_one_half_sags_there() {
    let text = of_nodes(
        r#""n": nucleus(), "p": polyPlane(width: 2, height: 1, subdivisions: (16, 8)),
           "c": nCloth(inputMesh: "p", stretchDamp: 5, compressionResistance: 0, massMapType: perVertex,
                       massPerVertex: expression("x > 0 ? 3 : 1")),
           "h": dynamicConstraint(components: ["c.vtx[0]", "c.vtx[17]", "c.vtx[34]", "c.vtx[51]", "c.vtx[68]",
                                               "c.vtx[85]", "c.vtx[102]", "c.vtx[119]", "c.vtx[136]",
                                               "c.vtx[16]", "c.vtx[33]", "c.vtx[50]", "c.vtx[67]", "c.vtx[84]",
                                               "c.vtx[101]", "c.vtx[118]", "c.vtx[135]", "c.vtx[152]"])"#,
        "",
    );
    let heavy = after(&program(&text), 48, "c");
    let even = after(&program(&text.replace("x > 0 ? 3 : 1", "2")), 48, "c");
    let height = |run: &[[u32; 3]], column: usize| f32::from_bits(run[4 * 17 + column][1]);
    for column in 1..8 {
        let (light, mirrored) = (height(&heavy, 8 - column), height(&heavy, 8 + column));
        assert!(mirrored < light, "{column}: {mirrored} {light}");
        // Statics of a string: the load on the heavy half pulls the lowest point there.
        let even = [8 - column, 8 + column].map(|column| height(&even, column));
        assert!((even[0] - even[1]).abs() < 1e-3, "{column}: {even:?}");
    }
}

#[test]
fn the_map_type_decides_whether_a_map_is_used() {
    let plain = model(&hanging("bendResistance: 1"));
    let values = format!("{:?}", (0..25).collect::<Vec<_>>());
    for (fields, counts) in [
        (format!("bendMapType: perVertex, bendPerVertex: {values}"), true),
        (format!("bendMapType: none, bendPerVertex: {values}"), false),
        (format!("bendMapType: texture, bendPerVertex: {values}"), false),
        (format!("bendPerVertex: {values}"), true),
        ("bendMapType: perVertex".to_owned(), false),
        ("bendMapType: texture".to_owned(), false),
        ("bendMap: 0.5".to_owned(), false),
        ("bendMapType: perVertex, bendPerVertex: []".to_owned(), false),
    ] {
        assert_eq!(model(&hanging(&format!("bendResistance: 1, {fields}"))) != plain, counts, "{fields}");
    }
}

#[test]
fn a_map_without_a_type_implies_its_type() {
    let of = |fields: &str| program(&hanging(fields)).model().cloths()[0].vertex_maps.clone();
    let maps =
        ["mass", "damp", "stretch", "compression", "bend", "restLengthScale", "drag", "tangentialDrag"];
    let more = ["lift", "thickness", "friction", "stickiness", "bounce", "collideStrength"];
    for map in maps.into_iter().chain(more) {
        let values = format!("{map}PerVertex: expression(\"1 + u\")");
        assert_eq!(of(&values), of(&format!("{map}MapType: perVertex, {values}")), "{map}");
        assert_ne!(of(&values), of(&format!("{map}MapType: none, {values}")), "{map}");
    }
}

#[test]
fn unused_settings_of_a_map_give_a_warning() {
    let file = Path::new("test.ron");
    for (fields, message, place) in [
        (
            "bendMapType: texture, bendPerVertex: [1]",
            "`bendPerVertex` of `c` has no effect: `bendMapType` is texture",
            "[1]",
        ),
        (
            "bendMapType: none, bendPerVertex: [1]",
            "`bendPerVertex` of `c` has no effect: `bendMapType` is none",
            "[1]",
        ),
        (
            "bendMapType: perVertex",
            "`bendMapType` of `c` has no effect: there is no `bendPerVertex`",
            "perVertex",
        ),
        ("bendMap: 0.5", "`bendMap` of `c` has no effect: it is no texture", "0.5"),
        (
            r#"bendMapType: none, bendMap: texture("a.png")"#,
            "`bendMap` of `c` has no effect: `bendMapType` is none",
            r#"texture("a.png")"#,
        ),
        (
            "restitutionAngleMapType: perVertex",
            "`restitutionAngleMapType` of `c` has no effect: there is no `restitutionAnglePerVertex`",
            "perVertex",
        ),
    ] {
        let text = hanging(fields);
        let warnings = messages(&text, file);
        assert_eq!(warnings, [(message.to_owned(), place)], "{fields}");
    }
}

#[test]
fn the_stretch_map_holds_for_compression_unless_it_has_its_own() {
    let half = "stretchMapType: perVertex, stretchPerVertex: expression(\"u\")";
    let factors = |fields: &str| program(&hanging(fields)).model().cloths()[0].vertex_maps.clone();
    let shared = factors(half);
    assert_eq!(shared.stretch, shared.compression);
    assert!(shared.bend.is_empty());
    let own = factors(&format!(
        "{half}, compressionMapType: perVertex, compressionPerVertex: expression(\"1 - u\")"
    ));
    assert_eq!(own.stretch, shared.stretch);
    assert_ne!(own.compression, own.stretch);
}

#[test]
fn expressions_have_the_position_and_coordinates_of_a_point() {
    let masses = |expression: &str| {
        let fields =
            format!("translateMe, massMapType: perVertex, massPerVertex: expression({expression:?})");
        let text = hanging(&fields.replace("translateMe, ", ""))
            .replace("polyPlane(", "polyPlane(translate: (10, 20, 30), ");
        program(&text).model().cloths()[0].vertex_maps.mass.clone()
    };
    // From -1 to 1 along x and from 1 to -1 along z, in the space of the mesh.
    assert_eq!(masses("x + 2")[..6], [1.0, 1.5, 2.0, 2.5, 3.0, 1.0]);
    assert_eq!(masses("z + y + 2")[..6], [3.0, 3.0, 3.0, 3.0, 3.0, 2.5]);
    assert_eq!(masses("1 + u + 10 * v")[..6], [1.0, 1.25, 1.5, 1.75, 2.0, 3.5]);
    assert_eq!(masses("1 + i / n")[24], 1.0 + 24.0 / 25.0);
}

#[test]
fn a_texture_is_sampled_at_the_texture_coordinates_of_each_point() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.ron");
    fs::write(folder.path().join("half.png"), png(2, &[51, 255, 51, 255])).expect("written");
    // A square with its corners at pixel centres and its texture rotated by 90°, and points at a seam.
    let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.25 0.25\nvt 0.75 0.25\nvt 0.75 0.75\nvt 0.25 0.75\n\
               f 1/2 2/3 3/4 4/1\nf 2/1 1/1 3/1\n";
    fs::write(folder.path().join("square.obj"), obj).expect("written");
    let text = of_nodes(
        r#""n": nucleus(), "m": mesh(file: "square.obj"),
           "c": nCloth(inputMesh: "m", massMap: texture("half.png"))"#,
        "",
    );
    let (scene, warnings) = read_scene_text(&text, &file).expect("it reads");
    assert!(warnings.is_empty(), "{warnings:?}");
    let masses = &compile(&scene).expect("it compiles").model().cloths()[0].vertex_maps.mass.clone();
    let expected = [1.0, 1.0, 0.2, 0.2];
    let near = masses.iter().zip(expected).all(|(mass, expected)| (mass - expected).abs() < 1e-6);
    assert!(near && masses.len() == 4, "{masses:?}");
}

#[test]
fn a_texture_is_sampled_at_the_default_texture_coordinates_of_a_sphere() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.ron");
    // Four pixels in a row round the sphere: the second is bright, from a fourth to half of the way round.
    fs::write(folder.path().join("row.png"), png(4, &[51, 255, 51, 51])).expect("written");
    let text = of_nodes(
        r#""n": nucleus(), "m": polySphere(subdivisions: (8, 4)),
           "c": nCloth(inputMesh: "m", massMap: texture("row.png"))"#,
        "",
    );
    let (scene, _) = read_scene_text(&text, &file).expect("it reads");
    let masses = &compile(&scene).expect("it compiles").model().cloths()[0].vertex_maps.mass.clone();
    // A pixel has its value in its middle, at 3/8 of the way: point 3 of a ring of 8.
    let brightest = (0..8).max_by(|a, b| masses[*a].total_cmp(&masses[*b]));
    assert_eq!(brightest, Some(3), "{masses:?}");
}

#[test]
fn a_mistake_in_a_map_is_reported_with_node_attribute_place_and_counts() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.ron");
    let put = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).expect("written");
    put("few.txt", b"1 2 3");
    put("bad.txt", b"1\n2\n3 nan\n");
    put("good.png", &png(2, &[0, 255]));
    put("half.png", &png(200, &[7; 4000])[..60]);
    put("text.png", b"this is no picture");
    put("bare.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    put("torn.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/4\n");
    let at = |name: &str| folder.path().join(name).display().to_string();
    let per_vertex = |values: &str| format!("massMapType: perVertex, massPerVertex: {values}");
    let texture = |name: &str| format!("massMap: texture(\"{name}\")");
    for (fields, message, place) in [
        (per_vertex("[1, 2]"), "`massPerVertex` of `c` has 2 values, but `p` has 25 points".to_owned(), "[1, 2]"),
        (
            per_vertex("file(\"few.txt\")"),
            "`massPerVertex` of `c` has 3 values, but `p` has 25 points".to_owned(),
            "file(\"few.txt\")",
        ),
        (per_vertex("[1, nan]"), "`massPerVertex` of `c` takes a number, found the word `nan`".to_owned(), "nan"),
        (
            per_vertex("file(\"bad.txt\")"),
            format!("`{}`, line 3, column 3, 3 bytes: not a finite number", at("bad.txt")),
            "file(\"bad.txt\")",
        ),
        (
            per_vertex("file(\"none.txt\")"),
            format!("cannot read `{}`: No such file or directory (os error 2)", at("none.txt")),
            "file(\"none.txt\")",
        ),
        (
            per_vertex("expression(\"1 + w\")"),
            "`massPerVertex` of `c`: there is no `w` in an expression".to_owned(),
            "w",
        ),
        (
            per_vertex(r#"expression("1 +\u{20}w")"#),
            "`massPerVertex` of `c`: there is no `w` in an expression".to_owned(),
            r#""1 +\u{20}w""#,
        ),
        (
            per_vertex("expression(\"1 / (i - 3)\")"),
            "`massPerVertex` of `c` must be between 0 and 1000000, but is -0.3333333333333333 at point 0".to_owned(),
            "expression(\"1 / (i - 3)\")",
        ),
        (
            per_vertex("expression(\"1 / i\")"),
            "`massPerVertex` of `c` is not a finite number at point 0".to_owned(),
            "expression(\"1 / i\")",
        ),
        (
            per_vertex("expression(\"i\")"),
            "the mass map of `c` makes point 0 weigh nothing".to_owned(),
            "expression(\"i\")",
        ),
        (
            per_vertex("selection(\"borde ? 2 : 1\")"),
            "`massPerVertex` of `c`: `borde` is not the number of a point; did you mean `border`?".to_owned(),
            "\"borde ? 2 : 1\"",
        ),
        (
            per_vertex("selection(\"border ? 2\")"),
            "`massPerVertex` of `c`: `2` must be two numbers, like `5 : 1`".to_owned(),
            "\"border ? 2\"",
        ),
        (
            per_vertex("selection(\"where(x > 9) ? 2 : 1\")"),
            "`where(x > 9)` selects no points".to_owned(),
            "selection(\"where(x > 9) ? 2 : 1\")",
        ),
        (per_vertex("expression(1)"), "`massPerVertex` of `c` takes text in quotes, found a number".to_owned(), "1"),
        (
            per_vertex("expression(\"1\", \"2\")"),
            "`expression` takes one text, found 2 values".to_owned(),
            "expression(\"1\", \"2\")",
        ),
        (
            per_vertex("texture(\"a.png\")"),
            "`massPerVertex` of `c` takes a list of numbers, file(\"...\") or expression(\"...\"), found `texture(...)`"
                .to_owned(),
            "texture(\"a.png\")",
        ),
        (
            "massMap: \"a.png\"".to_owned(),
            "`massMap` of `c` takes texture(\"...\") or a number, found text".to_owned(),
            "\"a.png\"",
        ),
        (
            texture("none.png"),
            format!("cannot read `{}`: No such file or directory (os error 2)", at("none.png")),
            "texture(\"none.png\")",
        ),
        (
            texture("text.png"),
            format!("`{}` is not a valid PNG: Invalid PNG signature.", at("text.png")),
            "texture(\"text.png\")",
        ),
    ] {
        let text = hanging(&fields);
        let found = messages(&text, &file);
        assert!(found.contains(&(message.clone(), place)), "{fields}: {found:?}");
    }
    let mut promise = Vec::new();
    let mut writer = png::Encoder::new(&mut promise, 1_000_000, 2_000_000).write_header().expect("a header");
    writer.write_chunk(png::chunk::IDAT, &[0x78, 0x9c]).expect("a chunk");
    drop(writer);
    put("huge.png", &promise);
    let text = hanging(&texture("huge.png"));
    let found = messages(&text, &file);
    let message =
        format!("`{}` has 1000000 x 2000000 pixels, more than the limit of 67108864", at("huge.png"));
    assert_eq!(found, [(message, "texture(\"huge.png\")")]);
    let text = hanging(&texture("half.png"));
    let found = messages(&text, &file);
    assert!(found[0].0.starts_with(&format!("`{}` is not a valid PNG: ", at("half.png"))), "{found:?}");
    for (mesh, message) in [
        (
            r#"mesh(file: "bare.obj")"#,
            "`massMap` of `c` asks for texture coordinates: `p` has none".to_owned(),
        ),
        (
            r#"mesh(file: "torn.obj")"#,
            format!(
                "`massMap` of `c` asks for texture coordinates: `{}`, line 5: there are no texture coordinates 4; \
                 there are 1",
                at("torn.obj")
            ),
        ),
    ] {
        let nodes = r#""n": nucleus(), "p": MESH, "c": nCloth(inputMesh: "p", massMap: texture("good.png"))"#;
        let text = of_nodes(&nodes.replace("MESH", mesh), "");
        assert_eq!(messages(&text, &file), [(message, "texture(\"good.png\")")], "{mesh}");
    }
}

#[test]
fn a_scene_with_maps_is_written_and_read_back() {
    let text = hanging(
        r#"massMapType: perVertex, massPerVertex: expression("1 + \"x\\" == 2 ? 1 : u"), bendMap: texture("a.png")"#,
    )
    .replace("1 + \\\"x\\\\\" == 2", "x == 2");
    let (scene, _) = read_scene_text(&text, Path::new("test.ron")).expect("it reads");
    let written = format_scene(&scene, &text);
    assert!(written.contains(r#"massPerVertex: expression("x == 2 ? 1 : u")"#), "{written}");
    assert!(written.contains(r#"bendMap: texture("a.png")"#), "{written}");
    let (again, _) = read_scene_text(&written, Path::new("test.ron")).expect("it reads again");
    assert_eq!(again, scene);
}

#[test]
fn a_scene_without_maps_has_no_pass_for_them() {
    let passes = |fields: &str| -> Vec<&str> {
        let program = program(&hanging(fields));
        let run: Simulation = Simulation::new(&program, 1);
        run.solver().passes(&program.first_input()).iter().map(|pass| pass.name).collect()
    };
    assert!(!passes("").contains(&"maps"));
    assert!(
        !passes(&format!("bendMapType: perVertex, bendPerVertex: {:?}", vec![2.0; 25])).contains(&"maps")
    );
    assert!(passes("bendMapType: perVertex, bendPerVertex: expression(\"u\")").contains(&"maps"));
}

#[test]
fn a_map_can_come_along_a_connection() {
    let nodes = r#""n": nucleus(), "p": polyPlane(subdivisions: (1, 1)), "q": polyPlane(subdivisions: (1, 1)),
        "a": nCloth(inputMesh: "p", massMapType: perVertex, massPerVertex: expression("1 + u")),
        "b": nCloth(inputMesh: "q", massMapType: perVertex)"#;
    let program = program(&of_nodes(nodes, r#"("a.massPerVertex", "b.massPerVertex")"#));
    let cloths = program.model().cloths();
    assert_eq!(cloths[0].vertex_maps.mass, [1.0, 2.0, 1.0, 2.0]);
    assert_eq!(cloths[1].vertex_maps, cloths[0].vertex_maps);
}
