//! Results that Maya recorded: played by an imported scene, and compared with a run.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use nalgebra::Vector3;
use nucleus_core::ClothId;
use nucleus_graph::Simulation;
use nucleus_graph::attributes::n_base;
use nucleus_graph::compile::compile;
use nucleus_maya::{ImportOptions, Imported, import_scene};

/// Imports a scene of a folder; its files are written beside it.
fn import(folder: &Path, name: &str, simulate: bool) -> Imported {
    let mut options = ImportOptions::new("files", |name, text| {
        let path = folder.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).map_err(|error| error.to_string())
    });
    options.simulate = simulate;
    import_scene(&folder.join(name), &folder.join("out.ron"), &mut options).unwrap()
}

fn run(imported: &Imported) -> Simulation<f32> {
    let program = compile(&imported.scene).unwrap_or_else(|errors| panic!("{errors:#?}"));
    Simulation::new(&program, 1)
}

fn point(run: &Simulation<f32>, at: usize) -> Vector3<f64> {
    run.state().point(ClothId(0), at)
}

/// A block of an nCache as Maya writes it, with sizes of 32 bits.
fn block(tag: &[u8], data: &[u8]) -> Vec<u8> {
    let mut all = [tag, &(data.len() as u32).to_be_bytes(), data].concat();
    if tag != b"FOR4" {
        all.resize(all.len().next_multiple_of(4), 0);
    }
    all
}

/// Writes an nCache of one file: the points of a channel for each frame.
fn write_cache(folder: &Path, name: &str, channel: &str, frames: &[(i32, Vec<[f32; 3]>)]) {
    let start = (250 * frames[0].0).to_be_bytes();
    let mut all = block(b"FOR4", &[&b"CACH"[..], &block(b"STIM", &start)].concat());
    for (frame, points) in frames {
        let numbers: Vec<u8> = points.iter().flatten().flat_map(|x| x.to_be_bytes()).collect();
        let name = [channel.as_bytes(), b"\0"].concat();
        let blocks = [
            block(b"TIME", &(250 * frame).to_be_bytes()),
            block(b"CHNM", &name),
            block(b"SIZE", &(points.len() as u32).to_be_bytes()),
            block(b"FVCA", &numbers),
        ];
        all.extend(block(b"FOR4", &[&b"MYCH"[..], &blocks.concat()].concat()));
    }
    fs::create_dir_all(folder).unwrap();
    fs::write(folder.join(format!("{name}.mc")), all).unwrap();
    let xml = "<Autodesk_Cache_File>\n  <cacheType Type=\"OneFile\" Format=\"mcc\"/>\n  \
               <cacheTimePerFrame TimePerFrame=\"250\"/>\n</Autodesk_Cache_File>\n";
    fs::write(folder.join(format!("{name}.xml")), xml).unwrap();
}

/// `tests/maya/drape.ma` with a cache that drives its cloth, at the path of another project.
fn cached_drape(folder: &Path) {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/maya/drape.ma");
    let text = fs::read_to_string(scene).unwrap()
        + "createNode cacheFile -n \"cache1\";\n\tsetAttr \".cn\" -type \"string\" \"show\";\n\
           \tsetAttr \".cp\" -type \"string\" \"D:/other/cache/nCache/drape\";\n\tsetAttr \".ch[0]\" -type \"string\" \"nClothShape1\";\n\
           \tsetAttr \".ss\" 101;\n\tsetAttr \".se\" 110;\n\tsetAttr \".sf\" 1;\n\
           connectAttr \"cache1.ocd[0]\" \"nClothShape1.poss\";\nconnectAttr \"cache1.ir\" \"nClothShape1.pfc\";\n";
    fs::write(folder.join("drape.ma"), text).unwrap();
}

/// The grid of the scene, in the space of its mesh, after a lift by a tenth for each frame.
fn lifted(frame: i32) -> Vec<[f32; 3]> {
    let y = 0.1 * (frame - 101) as f32;
    (0..441).map(|k| [(k % 21) as f32 * 0.3 - 3.0, y, 3.0 - (k / 21) as f32 * 0.3]).collect()
}

#[test]
fn a_cloth_plays_the_cache_that_lies_with_its_scene() {
    let folder = tempfile::tempdir().unwrap();
    cached_drape(folder.path());
    let frames: Vec<_> = (101..=110).map(|frame| (frame, lifted(frame))).collect();
    write_cache(&folder.path().join("cache/nCache/drape"), "show", "nClothShape1", &frames);
    let imported = import(folder.path(), "drape.ma", false);
    let graph = &imported.scene.graph;
    let cloth = graph.find("nCloth1").unwrap();
    let plays = |frame: f64| graph.at(frame).get(cloth, &n_base::PLAY_FROM_CACHE);
    assert_eq!([1.0, 10.0, 11.0].map(plays), [true, true, false], "frames 101 to 110 begin at frame 1");
    let said = imported.omissions.to_string();
    assert!(said.contains("`nCloth1`: the scene plays recorded results") && said.contains("frames 1 to 10"));
    let mut run = run(&imported);
    for frame in 1..=10 {
        // The cache is in the space of the mesh, which is 5 above the ground; spaceScale is 0.01.
        let expected = (5.0 + 0.1 * f64::from(frame - 1)) / 100.0;
        for at in [0, 220, 440] {
            let y = point(&run, at).y;
            assert!((y - expected).abs() < 1e-7, "frame {frame}, point {at}: {y}, {expected}");
        }
        run.advance(&mut ());
    }
    let solved = import(folder.path(), "drape.ma", true);
    let cloth = solved.scene.graph.find("nCloth1").unwrap();
    assert!(!solved.scene.graph.at(1.0).get(cloth, &n_base::PLAY_FROM_CACHE));
    assert!(solved.omissions.to_string().contains("`--simulate` says so"));
}

/// Which frames of the scene a cloth plays of a cache of frames 0 to 11, where its node sets these values.
fn played(values: &str) -> Vec<i32> {
    let folder = tempfile::tempdir().unwrap();
    cached_drape(folder.path());
    let text = fs::read_to_string(folder.path().join("drape.ma")).unwrap();
    let text = text.replace("\tsetAttr \".ss\" 101;\n\tsetAttr \".se\" 110;\n\tsetAttr \".sf\" 1;\n", values);
    fs::write(folder.path().join("drape.ma"), text).unwrap();
    let frames: Vec<_> = (0..=11).map(|frame| (frame, lifted(frame))).collect();
    write_cache(folder.path(), "show", "nClothShape1", &frames);
    let imported = import(folder.path(), "drape.ma", false);
    let graph = &imported.scene.graph;
    let cloth = graph.find("nCloth1").unwrap();
    (1..=48).filter(|frame| graph.at(f64::from(*frame)).get(cloth, &n_base::PLAY_FROM_CACHE)).collect()
}

#[test]
fn values_of_a_cache_that_a_file_leaves_out_are_zero() {
    let end = "setAttr \".se\" 11;\n";
    assert_eq!(played(&format!("{end}setAttr \".sf\" 5;\n")), Vec::from_iter(5..=16));
    assert_eq!(played(end), Vec::from_iter(1..=11), "the source and the scene begin at frame 0");
    assert_eq!(played(&format!("{end}setAttr \".ss\" 3;\n")), Vec::from_iter(1..=8), "frame 3 is at 0");
    assert_eq!(played(""), Vec::from_iter(1..=11));
}

#[test]
fn a_cache_that_is_stretched_in_time_is_interpolated_between_its_samples() {
    let folder = tempfile::tempdir().unwrap();
    cached_drape(folder.path());
    let text = fs::read_to_string(folder.path().join("drape.ma")).unwrap();
    fs::write(folder.path().join("drape.ma"), text.replace("\".sf\" 1;", "\".sf\" 1; setAttr \".sc\" 2;"))
        .unwrap();
    let frames: Vec<_> = (101..=110).map(|frame| (frame, lifted(frame))).collect();
    write_cache(folder.path(), "show", "nClothShape1", &frames);
    let imported = import(folder.path(), "drape.ma", false);
    let said = imported.omissions.to_string();
    assert!(said.contains("it plays frames 1 to 19 of `show`;"), "{said}");
    let mut run = run(&imported);
    for frame in 1..=19 {
        // The motion is linear: half of a tenth for each frame of the scene, from 5 above the ground.
        let expected = (5.0 + 0.05 * f64::from(frame - 1)) / 100.0;
        let y = point(&run, 220).y;
        assert!((y - expected).abs() < 1e-7, "frame {frame}: {y}, {expected}");
        run.advance(&mut ());
    }
}

/// A cloth that plays a blend of a cache that rises by a tenth for each frame from frame 101, and of one that lies still.
fn blend(folder: &Path, values: &str, still: &[[f32; 3]]) -> Imported {
    cached_drape(folder);
    let text = fs::read_to_string(folder.join("drape.ma")).unwrap();
    let text = text.replace("\"cache1.ir\" \"nClothShape1.pfc\"", "\"blend.ir\" \"nClothShape1.pfc\"");
    let second = format!(
        "createNode cacheBlend -n \"blend\";\n{values}createNode cacheFile -n \"cache2\";\n\
         setAttr \".cn\" -type \"string\" \"still\"; setAttr \".ss\" 101; setAttr \".se\" 110; setAttr \".sf\" 1;\n\
         connectAttr \"cache2.ocd[0]\" \"blend.inc[0].vin[4]\"; connectAttr \"cache2.ir\" \"blend.cd[4].ra\";\n\
         connectAttr \"cache1.ocd[0]\" \"blend.inc[0].vin[0]\"; connectAttr \"cache1.ir\" \"blend.cd[0].ra\";\n"
    );
    fs::write(folder.join("drape.ma"), text + &second).unwrap();
    let rising: Vec<_> = (101..=110).map(|frame| (frame, lifted(frame))).collect();
    let resting: Vec<_> = (101..=110).map(|frame| (frame, still.to_vec())).collect();
    write_cache(folder, "show", "nClothShape1", &rising);
    write_cache(folder, "still", "nClothShape1", &resting);
    import(folder, "drape.ma", false)
}

/// The share of the rising cache in a blend at a frame, by the heights of the cloth.
fn share_of_rising(imported: &Imported, frame: i32) -> f64 {
    let mut run = run(imported);
    for _ in 1..frame {
        run.advance(&mut ());
    }
    (100.0 * point(&run, 220).y - 5.0) / (0.1 * f64::from(frame - 1))
}

#[test]
fn caches_are_blended_by_their_weights_which_count_in_proportion() {
    let weights = |a: f64, b: f64| format!("setAttr \".cd[0].w\" {a}; setAttr \".cd[4].w\" {b};\n");
    let keyed = "setAttr \".cd[4].w\" 1;\ncreateNode animCurveTU -n \"fade\"; setAttr \".tan\" 2;\n\
                 setAttr -s 2 \".ktv[0:1]\" 1 1 9 0; connectAttr \"fade.o\" \"blend.cd[0].w\";\n";
    let cases = [
        (weights(1.0, 0.0), 1.0),
        (weights(0.0, 1.0), 0.0),
        (weights(3.0, 1.0), 0.75),
        // Without values both weigh 1.
        (String::new(), 0.5),
        // 1/2 and 1 at frame 5.
        (keyed.to_owned(), 1.0 / 3.0),
    ];
    for (values, expected) in cases {
        let folder = tempfile::tempdir().unwrap();
        let imported = blend(folder.path(), &values, &lifted(101));
        let share = share_of_rising(&imported, 5);
        assert!((share - expected).abs() < 1e-4, "{values}: {share}, {expected}");
        let said = imported.omissions.to_string();
        assert!(said.contains("it plays frames 1 to 10 of `show` and `still`;"), "{said}");
    }
}

#[test]
fn of_caches_with_other_points_the_heaviest_plays_alone_and_is_listed() {
    let folder = tempfile::tempdir().unwrap();
    let values = "setAttr \".cd[0].w\" 0.7; setAttr \".cd[4].w\" 0.3;\n";
    let imported = blend(folder.path(), values, &lifted(101)[..440]);
    assert!((share_of_rising(&imported, 5) - 1.0).abs() < 1e-4);
    let said = imported.omissions.to_string();
    assert!(said.contains("at 10 of these only the heaviest"), "{said}");
    fs::remove_file(folder.path().join("still.xml")).unwrap();
    let said = import(folder.path(), "drape.ma", false).omissions.to_string();
    assert!(said.contains("of `show`, not a further cache: there is no `still.xml`"), "{said}");
}

#[test]
fn frames_that_a_cache_does_not_have_are_simulated_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    cached_drape(folder.path());
    let frames: Vec<_> = [101, 102, 105, 110].map(|frame| (frame, lifted(frame))).into();
    write_cache(folder.path(), "show", "nClothShape1", &frames);
    let said = import(folder.path(), "drape.ma", false).omissions.to_string();
    assert!(said.contains("it plays frames 1 to 10 of `show`, but simulates 6 of these"), "{said}");
}

#[test]
fn a_cloth_whose_cache_is_missing_or_of_another_mesh_is_simulated_and_listed() {
    let folder = tempfile::tempdir().unwrap();
    cached_drape(folder.path());
    let said = || {
        let imported = import(folder.path(), "drape.ma", false);
        let cloth = imported.scene.graph.find("nCloth1").unwrap();
        assert!(!imported.scene.graph.node(cloth).settings().contains_key("playFromCache"));
        imported.omissions.to_string()
    };
    let missing = said();
    assert!(missing.contains("it is simulated instead: there is no `show.xml`"), "{missing}");
    write_cache(folder.path(), "show", "nClothShape1", &[(101, lifted(101)[..440].to_vec())]);
    let other = said();
    assert!(other.contains("`show` has 440 points, its mesh 441"), "{other}");
    fs::write(folder.path().join("show.mc"), "FOR4").unwrap();
    let broken = said();
    assert!(broken.contains("cut off"), "{broken}");
}

/// Five particles of `nParticles.mcx`, which Maya recorded from `InstancerDrawTest.ma`: positions and velocities at frame
/// 14, then positions at frames 15, 24, 50 and 100, in centimetres.
///
/// The figures are from Autodesk's maya-usd, `plugin/pxr/maya/lib/pxrUsdMayaGL/testenv/InstancerDrawTest`, commit
/// `139c895ecba3c8868000275a480531e7e25b8696`, under its Modified Apache 2.0 License.
const RECORDED: [[[f64; 3]; 6]; 5] = [
    [
        [-2.444546, 2.0264437, -2.3631794],
        [-5.533188, 4.586819, -5.3490186],
        [-2.6735659, 2.216293, -2.5845764],
        [-4.6349545, 3.842217, -4.480682],
        [-9.404009, 7.7956023, -9.0910015],
        [-15.725581, 13.035972, -15.202177],
    ],
    [
        [-2.8461187, 0.41747013, 1.7054571],
        [-7.7788596, 1.1410072, 4.6612654],
        [-3.1680872, 0.46469665, 1.8983878],
        [-5.925518, 0.8691578, 3.5507011],
        [-12.630127, 1.8525932, 7.568249],
        [-21.51735, 3.1561768, 12.89367],
    ],
    [
        [-1.4504653, 0.1697235, 1.7658093],
        [-5.961587, 0.69758415, 7.2576885],
        [-1.6972166, 0.19859666, 2.0662065],
        [-3.810464, 0.44587448, 4.6388936],
        [-8.948758, 1.047123, 10.894311],
        [-15.759782, 1.8441027, 19.186132],
    ],
    [
        [-0.8262276, 0.4388732, -1.0579435],
        [-5.621151, 2.985827, -7.197604],
        [-1.0588882, 0.5624572, -1.3558537],
        [-3.0514596, 1.6208656, -3.9072423],
        [-7.8963394, 4.1943545, -10.110867],
        [-14.318418, 7.605617, -18.33402],
    ],
    [
        [-0.05307197, 0.14421852, -0.030477187],
        [-3.3538923, 9.113916, -1.9260113],
        [-0.19189027, 0.5214454, -0.11019518],
        [-1.3807693, 3.7521226, -0.7929227],
        [-4.271493, 11.607415, -2.4529552],
        [-8.10326, 22.019922, -4.6533995],
    ],
];

/// The nodes of `InstancerDrawTest.ma` that a simulation needs, with some particles at the start.
fn instancer_scene(particles: &str, start: i64) -> String {
    format!(
        "//Maya ASCII 2016 scene\ncurrentUnit -l centimeter -a degree -t film;\n\
         createNode pointEmitter -n \"emitter1\";\n\tsetAttr \".rat\" 10;\n\tsetAttr \".sro\" no;\n\tsetAttr \".spd\" 10;\n\
         createNode transform -n \"nParticle1\";\ncreateNode nParticle -n \"nParticleShape1\" -p \"nParticle1\";\n{particles}\
         \tsetAttr \".cofl\" 1;\n\tsetAttr \".scld\" no;\n\
         createNode nucleus -n \"nucleus1\";\n\tsetAttr \".grty\" 0;\n\tsetAttr \".stf\" {start};\n\
         createNode script -n \"sceneConfigurationScriptNode\";\n\
         \tsetAttr \".b\" -type \"string\" \"playbackOptions -min {start} -max 100 -ast 1 -aet 100 \";\n\
         connectAttr \":time1.o\" \"emitter1.ct\";\nconnectAttr \"nParticleShape1.ifl\" \"emitter1.full[0]\";\n\
         connectAttr \"nParticleShape1.tss\" \"emitter1.dt[0]\";\nconnectAttr \"nParticleShape1.inh\" \"emitter1.inh[0]\";\n\
         connectAttr \"nParticleShape1.stt\" \"emitter1.stt[0]\";\nconnectAttr \"nParticleShape1.sd[0]\" \"emitter1.sd[0]\";\n\
         connectAttr \":time1.o\" \"nParticleShape1.cti\";\nconnectAttr \"nucleus1.noao[0]\" \"nParticleShape1.nxst\";\n\
         connectAttr \"nucleus1.stf\" \"nParticleShape1.stf\";\nconnectAttr \"emitter1.ot[0]\" \"nParticleShape1.npt[0]\";\n\
         connectAttr \":time1.o\" \"nucleus1.cti\";\nconnectAttr \"nParticleShape1.cust\" \"nucleus1.niao[0]\";\n\
         connectAttr \"nParticleShape1.stst\" \"nucleus1.nias[0]\";\n"
    )
}

/// The particles of the record at frame 14 as an initial state.
fn initial_state() -> String {
    let list = |name: &str, part: usize| {
        let mut text = format!("\tsetAttr \".{name}\" -type \"vectorArray\" {}", RECORDED.len());
        RECORDED.iter().flat_map(|own| own[part]).for_each(|x| write!(text, " {x}").unwrap());
        text + " ;\n"
    };
    list("pos0", 0) + &list("vel0", 1)
}

fn run_text(text: &str) -> Simulation<f32> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.ma"), text).unwrap();
    run(&import(folder.path(), "a.ma", false))
}

#[test]
fn particles_fly_as_maya_recorded_them() {
    let mut run = run_text(&instancer_scene(&initial_state(), 14));
    let mut worst: f64 = 0.0;
    for (part, frame) in [(2, 15), (3, 24), (4, 50), (5, 100)] {
        while run.frame() < frame {
            run.advance(&mut ());
        }
        for (at, own) in RECORDED.iter().enumerate() {
            let [start, recorded] = [own[0], own[part]].map(Vector3::from);
            // A unit of the scene is a metre to the solver.
            let error = (point(&run, at) - recorded).norm() / (recorded - start).norm();
            worst = worst.max(error);
        }
    }
    println!("worst {worst:.2e} of the distance travelled");
    assert!(worst < 1e-4, "{worst}");
}
