//! Exports, read back by readers written for these tests. `cargo xtask interop` checks them with other tools.

mod sample;

use std::fs;
use std::path::{Path, PathBuf};

use nucleus_cache::Playback;
use nucleus_interop::{ExportError, Exported, Format, Request, Selection, export};
use sample::exports::{parts, try_export, word};
use sample::{END, START, UNITS, Variant};
use tempfile::TempDir;

const SHEET: &str = "ns:sheet|1";
const POINTS: usize = 11;

fn exported(format: Format, selection: Selection) -> (TempDir, PathBuf, Exported) {
    let (folder, out, exported) = try_export(sample::write, format, selection);
    (folder, out, exported.unwrap())
}

fn all(format: Format) -> (TempDir, PathBuf) {
    let (folder, out, _) = exported(format, Selection::default());
    (folder, out)
}

/// Positions of the sheet at the end of a frame.
fn sheet(frame: i32) -> Vec<[f32; 3]> {
    sample::positions(SHEET, (frame - START) as f32)
}

fn floats<const N: usize>(bytes: &[u8], number: impl Fn([u8; N]) -> f32) -> Vec<[f32; 3]> {
    let numbers: Vec<f32> = bytes.chunks_exact(N).map(|word| number(word.try_into().unwrap())).collect();
    numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()
}

#[test]
fn obj_keeps_every_bit_every_point_and_every_face() {
    let (_folder, out) = all(Format::Obj);
    for frame in START..=END {
        let text = fs::read_to_string(out.join(format!("ns_sheet_1.{frame:04}.obj"))).unwrap();
        let points: Vec<Vec<f32>> = text
            .lines()
            .filter_map(|line| line.strip_prefix("v "))
            .map(|line| line.split(' ').map(|x| x.parse().unwrap()).collect())
            .collect();
        assert_eq!(points, sheet(frame), "frame {frame}");
        let faces: Vec<&str> = text.lines().filter(|line| line.starts_with("f ")).collect();
        assert_eq!(faces, ["f 1 2 5 4", "f 2 3 6", "f 2 6 5", "f 4 5 6 9 8 7"]);
    }
}

#[test]
fn pc2_states_its_first_frame_and_its_sample_rate() {
    let substeps = Selection { substeps: true, frames: Some((5, 8)), ..Selection::default() };
    let (_folder, out, exported) = exported(Format::Pc2, substeps);
    let bytes = fs::read(out.join("ns_sheet_1.pc2")).unwrap();
    assert_eq!(&bytes[..12], b"POINTCACHE2\0");
    assert_eq!([word(&bytes, 12), word(&bytes, 16), word(&bytes, 28)], [1, POINTS as u32, 8]);
    assert_eq!([f32::from_bits(word(&bytes, 20)), f32::from_bits(word(&bytes, 24))], [4.5, 0.5]);
    assert_eq!(exported.samples, 8, "two for each of four frames");
    let second = &bytes[32 + 12 * POINTS..32 + 24 * POINTS];
    assert_eq!(floats(second, f32::from_le_bytes), sheet(5));
}

#[test]
fn mdd_is_big_endian_and_has_a_time_for_each_sample() {
    let (_folder, out) = all(Format::Mdd);
    let bytes = fs::read(out.join("dust.mdd")).unwrap();
    let samples = (END - START + 1) as usize;
    assert_eq!(bytes[..8], [0, 0, 0, samples as u8, 0, 0, 0, 5]);
    let times: Vec<f32> =
        bytes[8..8 + 4 * samples].chunks(4).map(|x| f32::from_be_bytes(x.try_into().unwrap())).collect();
    assert_eq!(times[0], START as f32 / 24.0);
    let last = &bytes[bytes.len() - 60..];
    assert_eq!(floats(last, f32::from_be_bytes), sample::positions("dust", (END - START) as f32));
}

#[test]
fn vtu_holds_the_floats_of_the_cache() {
    let raw: Vec<u8> = sheet(9).as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    let (_folder, out) = all(Format::Vtu);
    let bytes = fs::read(out.join("ns_sheet_1.0009.vtu")).unwrap();
    assert!(bytes.windows(raw.len()).any(|window| window == raw));
}

/// A binary PLY file: the names of its vertex properties, their values for each vertex as 32-bit words, of which a `double`
/// has two, and the bytes of the faces.
fn ply(path: &Path) -> (Vec<String>, Vec<Vec<u32>>, Vec<u8>) {
    let bytes = fs::read(path).unwrap();
    let end = bytes.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
    let head = String::from_utf8(bytes[..end].to_vec()).unwrap();
    let (vertices, _) = head.split_once("element face").unwrap();
    let count: usize =
        vertices.lines().find_map(|line| line.strip_prefix("element vertex ")).unwrap().parse().unwrap();
    let names: Vec<String> =
        vertices.lines().filter_map(|line| line.strip_prefix("property ")).map(str::to_owned).collect();
    let words: usize = names.iter().map(|name| if name.starts_with("double ") { 2 } else { 1 }).sum();
    let row = 4 * words;
    let values = bytes[end..end + count * row].chunks_exact(row);
    let values = values.map(|row| (0..words).map(|k| word(row, 4 * k)).collect()).collect();
    (names, values, bytes[end + count * row..].to_vec())
}

#[test]
fn ply_holds_positions_velocities_and_texture_coordinates_of_points() {
    let (_folder, out) = all(Format::Ply);
    let (names, values, _) = ply(&out.join("ns_sheet_1.0009.ply"));
    assert_eq!(names, ["float x", "float y", "float z", "float vx", "float vy", "float vz"]);
    let bits = |point: [f32; 3]| point.map(f32::to_bits).to_vec();
    assert_eq!(
        values.iter().map(|row| row[..3].to_vec()).collect::<Vec<_>>(),
        sheet(9).into_iter().map(bits).collect::<Vec<_>>()
    );
    let mut cache = Playback::open(out.with_file_name("sample.mcap")).unwrap();
    let moment = cache.end_of(9).unwrap();
    let velocities = cache.velocities(0, moment).unwrap().unwrap();
    assert!(values.iter().zip(velocities).all(|(row, velocity)| row[3..] == bits(velocity)));
    let (names, values, _) = ply(&out.join("wall.0009.ply"));
    assert_eq!(names, ["float x", "float y", "float z", "float s", "float t"]);
    let uvs: Vec<[f32; 2]> =
        values.iter().map(|row| [f32::from_bits(row[3]), f32::from_bits(row[4])]).collect();
    assert_eq!(uvs, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
}

#[test]
fn ply_holds_texture_coordinates_with_seams_as_lists_of_the_corners() {
    let (_folder, out) = all(Format::Ply);
    let (names, _, faces) = ply(&out.join("_1_cart.0009.ply"));
    assert!(!names.contains(&"float s".to_owned()), "{names:?}");
    // Five corners with their points, and then with two coordinates each.
    assert_eq!((faces[0], faces[21], faces.len()), (5, 10, 1 + 20 + 1 + 40));
    let uvs: Vec<f32> = (0..10).map(|k| f32::from_bits(word(&faces, 22 + 4 * k))).collect();
    assert_eq!(uvs, [0.75, 0.5, 0.25, 0.5, 0.75, 0.5, 0.25, 0.5, 0.75, 0.5]);
}

#[test]
fn ply_holds_the_numbers_of_particles() {
    let lives = |path: &Path| sample::record(path, Variant { lives: true, ..Variant::default() });
    let (_folder, out, exported) = try_export(lives, Format::Ply, Selection::default());
    exported.unwrap();
    let mut cache = Playback::open(out.with_file_name("sample.mcap")).unwrap();
    let (dust, moment) =
        (cache.objects().iter().position(|o| o.name == "dust").unwrap(), cache.end_of(9).unwrap());
    let particles = cache.particles(dust, moment).unwrap().unwrap();
    let (names, values, _) = ply(&out.join("dust.0009.ply"));
    assert_eq!(names[names.len() - 4..], ["double id", "float age", "float lifespan", "float mass"]);
    // Numbers beyond 32 bits are exact in 64-bit floating-point numbers.
    let id = |row: &Vec<u32>| {
        let at = row.len() - 5;
        f64::from_bits(u64::from(row[at]) | u64::from(row[at + 1]) << 32) as u64
    };
    let ids: Vec<u64> = values.iter().map(id).collect();
    assert_eq!(ids, particles.iter().map(|particle| particle.id).collect::<Vec<_>>());
}

#[test]
fn vtu_names_texture_coordinates_of_points_and_leaves_out_those_with_seams() {
    let (_folder, out) = all(Format::Vtu);
    let wall = fs::read(out.join("wall.0009.vtu")).unwrap();
    let text = String::from_utf8_lossy(&wall);
    assert!(text.contains("<PointData TCoords=\"uv\">"), "{text}");
    assert!(text.contains("Name=\"uv\" NumberOfComponents=\"2\""), "{text}");
    let uvs = [[0.0_f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let raw: Vec<u8> = uvs.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    assert!(wall.windows(raw.len()).any(|window| window == raw));
    let cart = fs::read(out.join("_1_cart.0009.vtu")).unwrap();
    assert!(!String::from_utf8_lossy(&cart).contains("TCoords"));
}

#[test]
fn a_scale_changes_the_stated_unit_and_keeps_the_real_size() {
    let metres = Selection { scale: 0.01, ..Selection::default() };
    let (_folder, out, _) = exported(Format::Usda, metres.clone());
    let text = fs::read_to_string(&out).unwrap();
    assert!(text.contains("metersPerUnit = 1\n"), "centimetres times 0.01 are metres");
    let [x, y, z] = sheet(START)[4].map(|x| (f64::from(x) * 0.01) as f32);
    assert!(text.contains(&format!("({x}, {y}, {z})")), "{text}");
    for format in [Format::Glb, Format::Foxglove] {
        let (_folder, _, refused) = try_export(sample::write, format, metres.clone());
        assert!(matches!(refused, Err(ExportError::FixedUnit { .. })), "{refused:?}");
    }
}

#[test]
fn glb_is_in_metres_and_has_a_morph_target_for_each_frame() {
    let (_folder, out) = all(Format::Glb);
    let (text, binary) = parts(&out);
    let positions = |accessor: &serde_json::Value| {
        let view = &text["bufferViews"]
            [text["accessors"][accessor.as_u64().unwrap() as usize]["bufferView"].as_u64().unwrap() as usize];
        let [begin, length] = ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
        floats(&binary[begin..begin + length], f32::from_le_bytes)
    };
    let primitive = &text["meshes"][0]["primitives"][0];
    assert_eq!(text["meshes"][0]["name"], SHEET, "objects are in the order of the cache");
    let base = positions(&primitive["attributes"]["POSITION"]);
    for frame in START + 1..=END {
        let target = positions(&primitive["targets"][(frame - START - 1) as usize]["POSITION"]);
        for ((base, moved), expected) in base.iter().zip(&target).zip(sheet(frame)) {
            for axis in 0..3 {
                let error = f64::from(base[axis] + moved[axis]) - f64::from(expected[axis]) / UNITS;
                assert!(error.abs() < 1e-6, "frame {frame}: {error}");
            }
        }
    }
    let wall = text["meshes"].as_array().unwrap().iter().find(|mesh| mesh["name"] == "wall").unwrap();
    assert!(wall["primitives"][0].get("targets").is_none(), "a static object needs no target");
}

#[test]
fn samples_at_uneven_times_are_refused_by_pc2_and_irregular_in_an_ncache() {
    // Every second frame, with its middle: a step of half a frame follows one of one and a half.
    let uneven = || Selection { substeps: true, every: 2, ..Selection::default() };
    let (_folder, out, refused) = try_export(sample::write, Format::Pc2, uneven());
    let refused = refused.unwrap_err().to_string();
    assert!(refused.contains("PC2 states one rate") && refused.contains("write mdd"), "{refused}");
    assert_eq!(fs::read_dir(&out).map_or(0, Iterator::count), 0);
    let (_folder, out, _) = exported(Format::Mc, uneven());
    let text = fs::read_to_string(out.join("ns_sheet_1.xml")).unwrap();
    assert!(text.contains("SamplingType=\"Irregular\" SamplingRate=\"125\""), "{text}");
    let (_folder, out) = all(Format::Mc);
    let text = fs::read_to_string(out.join("ns_sheet_1.xml")).unwrap();
    assert!(text.contains("SamplingType=\"Regular\" SamplingRate=\"250\""), "{text}");
}

#[test]
fn usda_states_its_units_and_times_and_keeps_substeps_between_frames() {
    let (_folder, out, _) = exported(Format::Usda, Selection { substeps: true, ..Selection::default() });
    let text = fs::read_to_string(out).unwrap();
    for line in [
        "metersPerUnit = 0.01",
        "upAxis = \"Y\"",
        "startTimeCode = 3",
        "endTimeCode = 12",
        "            3.5: [(",
    ] {
        assert!(text.contains(line), "{line}");
    }
    assert!(text.contains("def Mesh \"ns_sheet_1\"") && text.contains("def Points \"dust\""), "{text}");
    assert!(text.contains("vector3f[] velocities.timeSamples"));
    assert_eq!(
        text.matches("float[] widths = [0.5]").count(),
        1,
        "twice the radius of the dust, and of nothing else"
    );
}

#[test]
fn usd_has_the_orientations_of_particles_that_rotate() {
    let (_folder, out) = all(Format::Usda);
    let text = fs::read_to_string(out).unwrap();
    assert_eq!(text.matches("quatf[] primvars:orient.timeSamples").count(), 1, "of the dust alone");
    // The real part comes first.
    let [x, y, z, w] = sample::turns((END - START) as f32)[4];
    assert!(text.contains(&format!(", ({w}, {x}, {y}, {z})]")), "{text}");
    let (_folder, out) = all(Format::Usdc);
    let bytes = fs::read(out).unwrap();
    let last: Vec<u8> =
        sample::turns((END - START) as f32).iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    assert!(bytes.windows(last.len()).any(|part| part == last), "x, y, z and w of five particles");
}

#[test]
fn an_ncache_has_a_file_for_each_frame_and_names_its_channels() {
    let (_folder, out) = all(Format::Mc);
    let text = fs::read_to_string(out.join("dust.xml")).unwrap();
    for part in
        ["Format=\"mcc\"", "Range=\"750-3000\"", "dust_position", "ChannelInterpretation=\"velocity\""]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    let bytes = fs::read(out.join("ns_sheet_1Frame9.mc")).unwrap();
    assert_eq!(floats(&bytes[bytes.len() - 12 * POINTS..], f32::from_be_bytes), sheet(9));
}

#[test]
fn an_ncache_and_a_grid_have_the_numbers_and_ages_of_particles_that_are_born_or_die() {
    let write = |path: &Path| sample::record(path, Variant { lives: true, ..Variant::default() });
    let lives = sample::lives((END - START) as f32);
    let has = |bytes: &[u8], part: &[u8], what: &str| {
        assert!(bytes.windows(part.len()).any(|window| window == part), "{what}");
    };
    let (_folder, out, exported) = try_export(write, Format::Mc, Selection::default());
    exported.unwrap();
    let text = fs::read_to_string(out.join("dust.xml")).unwrap();
    let bytes = fs::read(out.join(format!("dustFrame{END}.mc"))).unwrap();
    // Maya writes the largest float for a particle that lives forever; its clock is the frame over the rate.
    let now = f64::from(END) / 24.0;
    let facts: [(&str, [f64; 5]); 5] = [
        ("id", std::array::from_fn(|k| lives[k].id as f64)),
        ("age", std::array::from_fn(|k| lives[k].age)),
        ("birthTime", std::array::from_fn(|k| now - lives[k].age)),
        ("lifespanPP", std::array::from_fn(|k| lives[k].lifespan.min(f64::from(f32::MAX)))),
        ("mass", std::array::from_fn(|k| lives[k].mass)),
    ];
    for (channel, values) in facts {
        assert!(
            text.contains(&format!("ChannelName=\"dust_{channel}\" ChannelType=\"DoubleArray\"")),
            "{text}"
        );
        let raw: Vec<u8> = values.iter().flat_map(|x| x.to_be_bytes()).collect();
        has(&bytes, &[&b"DBLA\0\0\0\x28"[..], &raw].concat(), channel);
    }
    let (_folder, out, exported) = try_export(write, Format::Vtu, Selection::default());
    exported.unwrap();
    let bytes = fs::read(out.join(format!("dust.{END:04}.vtu"))).unwrap();
    has(&bytes, b"<DataArray type=\"Int64\" Name=\"id\" NumberOfComponents=\"1\"", "its array");
    let ids: Vec<u8> = lives.iter().flat_map(|one| one.id.to_le_bytes()).collect();
    has(&bytes, &[&40_u64.to_le_bytes()[..], &ids].concat(), "numbers");
    let ages: Vec<u8> = lives.iter().flat_map(|one| (one.age as f32).to_le_bytes()).collect();
    has(&bytes, &[&20_u64.to_le_bytes()[..], &ages].concat(), "ages");
}

#[test]
fn an_ncache_has_whole_ticks_per_frame_whatever_the_rate() {
    for (fps, per_frame) in [(23.976, 250), (29.97, 200), (59.94, 100)] {
        let write = |path: &Path| sample::record(path, Variant { fps, ..Variant::default() });
        let (_folder, out, exported) = try_export(write, Format::Mc, Selection::default());
        exported.unwrap();
        let text = fs::read_to_string(out.join("dust.xml")).unwrap();
        assert!(text.contains(&format!("TimePerFrame=\"{per_frame}\"")), "{fps}: {text}");
        assert!(text.contains(&format!("SamplingType=\"Regular\" SamplingRate=\"{per_frame}\"")), "{text}");
        let tick = i32::from_be_bytes(
            fs::read(out.join(format!("dustFrame{END}.mc"))).unwrap()[32..36].try_into().unwrap(),
        );
        assert_eq!(tick, per_frame * END, "{fps}");
    }
}

#[test]
fn substeps_of_unequal_ticks_are_irregular_and_their_file_names_sort_in_order_of_time() {
    let write = |path: &Path| sample::record(path, Variant { substeps: 12, ..Variant::default() });
    let substeps = Selection { substeps: true, ..Selection::default() };
    let (_folder, out, exported) = try_export(write, Format::Mc, substeps.clone());
    exported.unwrap();
    let text = fs::read_to_string(out.join("dust.xml")).unwrap();
    assert!(text.contains("SamplingType=\"Irregular\" SamplingRate=\"20\""), "{text}");
    let (_folder, _, exported) = try_export(write, Format::Obj, substeps);
    let files = exported.unwrap().files;
    let names: Vec<&PathBuf> =
        files.iter().filter(|file| file.to_string_lossy().contains("/dust.")).collect();
    assert_eq!(names.len(), 1 + 12 * (END - START) as usize);
    assert!(names.is_sorted(), "{names:?}");
}

#[test]
fn every_format_writes_the_same_bytes_twice() {
    for format in Format::ALL {
        let [(_a, _, one), (_b, _, two)] = [(); 2].map(|()| exported(format, Selection::default()));
        assert_eq!(one.files.len(), two.files.len());
        for (one, two) in one.files.iter().zip(&two.files) {
            assert_eq!(fs::read(one).unwrap(), fs::read(two).unwrap(), "{}", one.display());
        }
    }
}

fn torn(format: Format, frames: Option<(i32, i32)>) -> (TempDir, PathBuf, Result<Exported, ExportError>) {
    try_export(sample::write_torn, format, Selection { frames, ..Selection::default() })
}

#[test]
fn each_file_of_one_sample_has_the_mesh_of_that_sample() {
    let (_folder, out, exported) = torn(Format::Obj, None);
    exported.unwrap();
    for frame in START..=END {
        let text = fs::read_to_string(out.join(format!("ns_sheet_1.{frame:04}.obj"))).unwrap();
        let is_torn = frame >= sample::TORN;
        let points = text.lines().filter(|line| line.starts_with("v ")).count();
        assert_eq!(points, POINTS + usize::from(is_torn), "frame {frame}");
        assert_eq!(text.contains("f 2 3 12"), is_torn, "frame {frame}");
    }
    for (format, end) in [(Format::Ply, "ply"), (Format::Vtu, "vtu")] {
        let (_folder, out, exported) = torn(format, None);
        exported.unwrap();
        let text = |frame| {
            String::from_utf8_lossy(&fs::read(out.join(format!("ns_sheet_1.{frame:04}.{end}"))).unwrap())
                .into_owned()
        };
        let counts =
            |count: usize| [format!("element vertex {count}\n"), format!("NumberOfPoints=\"{count}\"")];
        let states = |frame, count| counts(count).iter().any(|counted| text(frame).contains(counted));
        assert!(states(sample::TORN - 1, POINTS) && states(sample::TORN, POINTS + 1), "{end}");
    }
}

#[test]
fn usda_and_foxglove_record_when_the_topology_changes() {
    let (_folder, out, exported) = torn(Format::Usda, None);
    exported.unwrap();
    let text = fs::read_to_string(out).unwrap();
    let times = format!(
        "{START}: [0, 1, 4, 3, 1, 2, 5, 1, 5, 4, 3, 4, 5, 8, 7, 6],\n            {}: [0, 1, 4, 3, 1, 2, 11,",
        sample::TORN
    );
    assert!(
        text.contains(&format!("int[] faceVertexIndices.timeSamples = {{\n            {times}")),
        "{text}"
    );
    assert!(text.contains("int[] faceVertexCounts = [5]"), "the cart keeps its topology: {text}");
    let (_folder, out, exported) = torn(Format::Foxglove, None);
    exported.unwrap();
    let bytes = fs::read(out).unwrap();
    let mut clouds = Vec::new();
    for message in mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap) {
        if message.channel.topic == format!("/{SHEET}/points") {
            clouds.push(message.data.len());
        }
    }
    assert_eq!(clouds[5] - clouds[4], 12, "one point more: {clouds:?}");
}

#[test]
fn formats_of_constant_topology_refuse_a_change_and_export_the_frames_on_either_side() {
    for (format, name) in [
        (Format::Pc2, "PC2"),
        (Format::Mdd, "MDD"),
        (Format::Glb, "glTF"),
        (Format::Mc, "nCache"),
        (Format::Mcx, "nCache"),
    ] {
        let (_folder, out, refused) = torn(format, None);
        let refused = refused.unwrap_err().to_string();
        let expected = format!(
            "the topology of `{SHEET}` changes at frame {}, and {name} stores one topology",
            sample::TORN
        );
        assert!(refused.contains(&expected), "{refused}");
        let written = fs::read_dir(&out).map_or(0, Iterator::count);
        assert_eq!((written, out.is_file()), (0, false), "{name} leaves no file");
        for frames in [(START, sample::TORN - 1), (sample::TORN, END)] {
            torn(format, Some(frames)).2.unwrap();
        }
    }
    let (_folder, out, _) = torn(Format::Pc2, Some((sample::TORN, END)));
    let text = fs::read_to_string(out.join("ns_sheet_1.obj")).unwrap();
    assert!(text.contains("f 2 3 12"), "{text}");
}

#[test]
fn a_selection_exports_the_named_objects_and_refuses_missing_ones() {
    let some = Selection {
        objects: vec!["wall".into(), SHEET.into()],
        frames: Some((4, 10)),
        every: 3,
        ..Selection::default()
    };
    let (_folder, out, exported) = exported(Format::Obj, some);
    assert_eq!((exported.samples, exported.objects, exported.files.len()), (3, 2, 7));
    assert!(out.join("wall.0010.obj").exists() && !out.join("wall.0005.obj").exists());
    let (folder, _) = all(Format::Obj);
    let refusal = |selection: Selection| {
        let request = Request { format: Format::Obj, out: folder.path().join("b"), selection, force: false };
        export(&mut Playback::open(folder.path().join("sample.mcap")).unwrap(), &request, &mut |_| {})
            .unwrap_err()
    };
    let unknown = refusal(Selection { objects: vec!["sheet".into()], ..Selection::default() }).to_string();
    assert!(unknown.contains("no object `sheet`") && unknown.contains("`ns:sheet|1`"), "{unknown}");
    let late = refusal(Selection { frames: Some((40, 50)), ..Selection::default() }).to_string();
    assert!(late.contains("the cache has 3 to 12"), "{late}");
}

#[test]
fn a_file_is_replaced_only_on_request_and_no_partial_file_remains() {
    let (folder, out) = all(Format::Usda);
    let mut cache = Playback::open(folder.path().join("sample.mcap")).unwrap();
    let before = fs::read(&out).unwrap();
    let mut request =
        Request { format: Format::Glb, out: out.clone(), selection: Selection::default(), force: false };
    assert!(matches!(export(&mut cache, &request, &mut |_| {}), Err(ExportError::Exists { .. })));
    assert_eq!(fs::read(&out).unwrap(), before);
    request.force = true;
    export(&mut cache, &request, &mut |_| {}).unwrap();
    assert_eq!(&fs::read(&out).unwrap()[..4], b"glTF");
    let names: Vec<_> =
        fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names.len(), 2, "the cache and the export: {names:?}");
}

#[test]
fn an_export_that_fails_leaves_no_new_files() {
    let (folder, out) = all(Format::Obj);
    let files = || {
        let entries = fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().path());
        entries.collect::<std::collections::BTreeSet<_>>()
    };
    let mut written = files();
    let last = written.pop_last().unwrap();
    written.iter().for_each(|path| fs::remove_file(path).unwrap());
    let mut cache = Playback::open(folder.path().join("sample.mcap")).unwrap();
    let request =
        Request { format: Format::Obj, out: out.clone(), selection: Selection::default(), force: false };
    assert!(matches!(export(&mut cache, &request, &mut |_| {}), Err(ExportError::Exists { .. })));
    assert_eq!(files().into_iter().collect::<Vec<_>>(), [last]);
}

#[test]
fn texture_coordinates_reach_the_formats_that_have_them() {
    let (_folder, out) = all(Format::Obj);
    let text = fs::read_to_string(out.join("wall.0003.obj")).unwrap();
    assert_eq!(text.lines().filter(|line| line.starts_with("vt ")).count(), 4);
    assert!(text.contains("f 1/1 2/2 3/3 4/4") && text.contains("mtllib materials.mtl"), "{text}");
    let text =
        fs::read_to_string(out.join("1_cart.0003.obj")).or(fs::read_to_string(out.join("_1_cart.0003.obj")));
    assert!(text.unwrap().contains("f 1/2 2/1 3/2 4/1 5/2"), "a mesh with seams has a value per corner");
    let (_folder, out) = all(Format::Usda);
    let text = fs::read_to_string(out).unwrap();
    assert!(text.contains("texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)]"), "{text}");
    assert!(text.contains("int[] primvars:st:indices = [1, 0, 1, 0, 1]") && text.contains("\"faceVarying\""));
    let (_folder, out) = all(Format::Glb);
    let (text, _) = parts(&out);
    let wall = text["meshes"].as_array().unwrap().iter().find(|mesh| mesh["name"] == "wall").unwrap();
    assert!(wall["primitives"][0]["attributes"]["TEXCOORD_0"].is_number());
    assert_eq!(text["materials"][0]["doubleSided"], true);
}

#[test]
fn cameras_and_materials_reach_usd_and_gltf() {
    let (_folder, out) = all(Format::Usda);
    let text = fs::read_to_string(out).unwrap();
    for part in [
        "def Camera \"shot\"",
        "matrix4d xformOp:transform.timeSamples",
        "float focalLength.timeSamples",
        "rel material:binding = </run/materials/wall>",
        "token info:id = \"UsdPreviewSurface\"",
        "normal3f[] normals.timeSamples",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let (_folder, out) = all(Format::Glb);
    let (text, _) = parts(&out);
    assert_eq!(text["cameras"][0]["type"], "perspective");
    let paths: Vec<&str> = text["animations"][0]["channels"]
        .as_array()
        .unwrap()
        .iter()
        .map(|channel| channel["target"]["path"].as_str().unwrap())
        .collect();
    assert_eq!(paths[..2], ["translation", "rotation"]);
}

#[test]
fn binary_usd_has_the_tokens_and_values_of_the_text() {
    let (_folder, out) = all(Format::Usdc);
    let bytes = fs::read(out).unwrap();
    assert_eq!(&bytes[..11], b"PXR-USDC\0\x08\0");
    let has = |part: &[u8]| bytes.windows(part.len()).any(|window| window == part);
    for token in ["faceVertexIndices", "points", "MaterialBindingAPI", "primvars:st", "timeSamples", "Camera"]
    {
        assert!(has(&[token.as_bytes(), &[0]].concat()), "{token}");
    }
    let raw: Vec<u8> = sheet(9).as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    assert!(has(&raw), "positions are as recorded");
    let contents = u64::from_le_bytes(bytes[16..24].try_into().unwrap()) as usize;
    assert_eq!(bytes[contents..contents + 8], 6_u64.to_le_bytes(), "six sections");
}
