//! Groups and materials of faces in OBJ and glTF.

mod sample;

use std::fs;
use std::path::Path;

use nucleus_interop::{Format, Selection};
use sample::Variant;
use sample::exports::{parts, try_export, word};

#[test]
fn obj_names_groups_and_materials_where_they_begin_and_keeps_the_order_of_the_faces() {
    let variant = Variant { sets: true, ..Variant::default() };
    for tears in [false, true] {
        let record = |path: &Path| sample::record(path, Variant { tears, ..variant });
        let (_folder, out, done) = try_export(record, Format::Obj, Selection::default());
        done.unwrap();
        let text = fs::read_to_string(out.join("ns_sheet_1.0012.obj")).unwrap();
        let lines: Vec<&str> =
            text.lines().filter(|line| !line.starts_with("v ") && !line.starts_with('o')).collect();
        let second = if tears { "f 2 3 12" } else { "f 2 3 6" };
        assert_eq!(
            lines,
            [
                "mtllib materials.mtl",
                "g hem",
                "usemtl silk",
                "f 1 2 5 4",
                "g default",
                second,
                "g hem left_side",
                "usemtl ns:sheet|1",
                "f 2 6 5",
                "g left_side",
                "usemtl wall",
                "f 4 5 6 9 8 7"
            ]
        );
        // The wall is an object and the name of a material.
        let materials = fs::read_to_string(out.join("materials.mtl")).unwrap();
        let names: Vec<&str> = materials.lines().filter_map(|line| line.strip_prefix("newmtl ")).collect();
        assert_eq!(names, ["ns:sheet|1", "dust", "1_cart", "wall", "silk"]);
    }
}

#[test]
fn gltf_has_a_primitive_for_each_material_with_the_vertices_of_the_mesh() {
    let variant = Variant { sets: true, ..Variant::default() };
    let record = |path: &Path| sample::record(path, variant);
    let (_folder, out, done) = try_export(record, Format::Glb, Selection::default());
    done.unwrap();
    let (text, binary) = parts(&out);
    let sheet = text["meshes"].as_array().unwrap().iter().find(|mesh| mesh["name"] == "ns:sheet|1").unwrap();
    let triangles = |primitive: &serde_json::Value| -> (String, Vec<u32>) {
        let accessor = &text["accessors"][primitive["indices"].as_u64().unwrap() as usize];
        let view = &text["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let start = view["byteOffset"].as_u64().unwrap() as usize;
        let count = accessor["count"].as_u64().unwrap() as usize;
        let material = &text["materials"][primitive["material"].as_u64().unwrap() as usize];
        let indices = (0..count).map(|k| word(&binary, start + 4 * k)).collect();
        (material["name"].as_str().unwrap().to_owned(), indices)
    };
    let primitives = sheet["primitives"].as_array().unwrap();
    let found: Vec<(String, Vec<u32>)> = primitives.iter().map(triangles).collect();
    let expected: [(&str, &[u32]); 3] = [
        ("ns:sheet|1", &[1, 5, 4]),
        ("silk", &[0, 1, 4, 0, 4, 3, 1, 2, 5]),
        ("wall", &[3, 4, 5, 3, 5, 8, 3, 8, 7, 3, 7, 6]),
    ];
    assert_eq!(found, expected.map(|(name, indices)| (name.to_owned(), indices.to_vec())));
    for primitive in primitives {
        assert_eq!(primitive["attributes"], primitives[0]["attributes"]);
        assert_eq!(primitive["targets"], primitives[0]["targets"]);
    }
}
