//! USD exports: names, units, cameras, and the looks of particles.

mod sample;

use std::fs;
use std::path::Path;

use nucleus_cache::Playback;
use nucleus_interop::{Format, Request, Selection, export};
use sample::{END, START, Variant};

/// The text of the export of a variant of the sample.
fn usda(variant: Variant) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::read_to_string(exported(folder.path(), variant, Format::Usda)).unwrap()
}

fn exported(folder: &Path, variant: Variant, format: Format) -> std::path::PathBuf {
    let (cache, out) = (folder.join("sample.mcap"), folder.join("out"));
    sample::record(&cache, variant);
    let request = Request { format, out: out.clone(), selection: Selection::default(), force: false };
    export(&mut Playback::open(&cache).unwrap(), &request, &mut |_| {}).unwrap();
    out
}

/// The part of a text from a line on, up to the end of its prim.
fn prim<'a>(text: &'a str, first: &str) -> &'a str {
    let begin = text.find(first).unwrap_or_else(|| panic!("{first}: {text}"));
    &text[begin..begin + text[begin..].find("\n    }\n").unwrap()]
}

/// The value of an attribute at a frame.
fn sampled<'a>(prim: &'a str, attribute: &str, frame: i32) -> &'a str {
    let (_, samples) = prim.split_once(&format!("{attribute}.timeSamples = {{\n")).unwrap();
    let (samples, _) = samples.split_once("\n        }\n").unwrap();
    let line = samples.lines().find_map(|line| line.trim().strip_prefix(&format!("{frame}: ")));
    line.unwrap().trim_end_matches(',')
}

#[test]
fn an_object_with_the_name_of_the_scope_of_materials_gets_another_one() {
    for wall in ["materials", "Materials"] {
        let text = usda(Variant { wall, ..Variant::default() });
        assert!(text.contains(&format!("def Mesh \"{wall}_2\"")), "{text}");
        assert!(text.contains(&format!("rel material:binding = </run/materials/{wall}_2>")), "{text}");
        assert_eq!(text.matches("\n    def Scope \"materials\"").count(), 1);
        assert!(text.contains(&format!("nucleus:name = \"{wall}\"")), "its own name is kept");
    }
}

#[test]
fn groups_and_materials_of_faces_are_subsets_that_bind_their_material() {
    let text = usda(Variant { sets: true, ..Variant::default() });
    let sheet = prim(&text, "def Mesh \"ns_sheet_1\"");
    assert!(
        sheet.contains("uniform token subsetFamily:materialBind:familyType = \"nonOverlapping\""),
        "{sheet}"
    );
    for (name, title, faces, material) in [
        ("silk", "silk", "[0, 1]", Some("silk")),
        ("wall", "wall", "[3]", Some("wall_2")),
        ("hem", "hem", "[0, 2]", None),
        ("left_side", "left side", "[2, 3]", None),
    ] {
        let begin = sheet.find(&format!("def GeomSubset \"{name}\"")).expect(name);
        let subset = &sheet[begin..begin + sheet[begin..].find("\n        }").unwrap()];
        assert!(subset.contains("uniform token elementType = \"face\""), "{subset}");
        assert!(subset.contains(&format!("int[] indices = {faces}")), "{subset}");
        assert!(subset.contains(&format!("custom string nucleus:name = \"{title}\"")), "{subset}");
        assert_eq!(subset.contains("familyName = \"materialBind\""), material.is_some(), "{subset}");
        if let Some(material) = material {
            let path = format!("rel material:binding = </run/materials/{material}>");
            assert!(subset.contains(&path), "{subset}");
            assert!(text.contains(&format!("def Material \"{material}\"")), "{text}");
        }
    }
    assert!(!usda(Variant::default()).contains("GeomSubset"));
}

#[test]
fn particles_have_the_recorded_radius_colour_and_opacity_of_each_sample() {
    let text = usda(Variant { looks: true, ..Variant::default() });
    let dust = prim(&text, "def Points \"dust\"");
    for frame in [START, END] {
        let time = frame - START;
        assert_eq!(sampled(dust, "float[] widths", frame), "[0.25, 0.5, 0.75, 1, 1.25]", "frame {frame}");
        assert_eq!(sampled(dust, "primvars:displayOpacity", frame), "[0, 0.2, 0.4, 0.6, 0.8]");
        let blue = 0.0625 * time as f32;
        let colours = sampled(dust, "primvars:displayColor", frame);
        assert!(colours.starts_with(&format!("[(0, 0.5, {blue}), (0.125, 0.5, {blue}), ")), "{colours}");
    }
    assert!(!dust.contains("material:binding"), "a material would hide the colours: {dust}");
    assert_eq!(text.matches("displayColor.timeSamples").count(), 1, "nothing else has looks");
}

#[test]
fn particles_that_are_born_or_die_have_their_numbers_ages_lifespans_and_masses_at_each_sample() {
    let text = usda(Variant { lives: true, ..Variant::default() });
    let dust = prim(&text, "def Points \"dust\"");
    for frame in [START, END] {
        let first = (1_u64 << 33) + (frame - START) as u64;
        let ids: Vec<String> = (first..first + 5).map(|id| id.to_string()).collect();
        assert_eq!(sampled(dust, "int64[] ids", frame), format!("[{}]", ids.join(", ")));
        assert_eq!(sampled(dust, "float[] primvars:age", frame), "[4, 3, 2, 1, 0]");
        assert_eq!(sampled(dust, "float[] primvars:lifespan", frame), "[inf, 5, 5, 5, 5]");
        assert_eq!(sampled(dust, "float[] primvars:mass", frame), "[0.5, 1.5, 2.5, 3.5, 4.5]");
    }
    let without = usda(Variant::default());
    assert!(prim(&without, "def Points \"dust\"").contains("int64[] ids = [0, 1, 2, 3, 4]"), "their places");
    assert!(!without.contains("primvars:age"));
}

#[test]
fn binary_usd_has_the_looks_of_particles_too() {
    let folder = tempfile::tempdir().unwrap();
    let out = exported(folder.path(), Variant { looks: true, ..Variant::default() }, Format::Usdc);
    let bytes = fs::read(out).unwrap();
    let has = |floats: &[f32]| {
        let raw: Vec<u8> = floats.iter().flat_map(|x| x.to_le_bytes()).collect();
        bytes.windows(raw.len()).any(|window| window == raw)
    };
    assert!(has(&[0.25, 0.5, 0.75, 1.0, 1.25]), "widths");
    let opacities: Vec<f32> = sample::looks(0.0).iter().map(|look| look.opacity).collect();
    assert!(has(&opacities));
}

#[test]
fn the_extent_of_particles_contains_their_balls() {
    let corners = |variant: Variant| {
        let text = usda(variant);
        let numbers = sampled(prim(&text, "def Points \"dust\""), "float3[] extent", END)
            .replace(['[', ']', '(', ')'], "");
        numbers.split(", ").map(|x| x.parse().unwrap()).collect::<Vec<f32>>()
    };
    let points = sample::positions("dust", (END - START) as f32);
    let x = |at: usize| points[at][0];
    let (alike, own) = (corners(Variant::default()), corners(Variant { looks: true, ..Variant::default() }));
    assert_eq!([alike[0], alike[3]], [x(0) - 0.25, x(4) + 0.25], "the radius is 0.25");
    assert_eq!([own[0], own[3]], [x(0) - 0.125, x(4) + 0.625], "half of it, and two and a half times it");
}

#[test]
fn cameras_have_a_clipping_range_that_begins_near_the_eye() {
    let text = usda(Variant::default());
    let camera = prim(&text, "def Camera \"shot\"");
    let (_, range) = camera.split_once("float2 clippingRange = (").unwrap();
    let (near, rest) = range.split_once(", ").unwrap();
    let near: f32 = near.parse().unwrap();
    assert!(near > 0.0 && near <= 1.0, "{near}");
    assert!(rest.starts_with("1000000)"), "{rest}");
}

#[test]
fn a_unit_of_many_metres_is_stated_exactly() {
    for (units_per_metre, expected) in [(1e-5, "100000"), (1000.0, "0.001"), (1.0 / 0.3048, "0.3048")] {
        let text = usda(Variant { units_per_metre, ..Variant::default() });
        assert!(text.contains(&format!("metersPerUnit = {expected}\n")), "{expected}: {}", &text[..300]);
    }
}
