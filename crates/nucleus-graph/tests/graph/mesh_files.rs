//! Meshes with motion from glTF and USD files, compared with positions that follow from the file by hand.

use std::fs;
use std::path::Path;

use nalgebra::Vector3;
use nucleus_graph::mesh::{Frames, MeshFile};

const FRAMES: Frames = Frames { first: 1, fps: 24.0 };

/// A number of a JSON document as little-endian bytes.
#[derive(Default)]
struct Binary {
    bytes: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl Binary {
    /// Adds an accessor; returns its index.
    fn add(
        &mut self,
        bytes: impl IntoIterator<Item = u8>,
        component: u32,
        kind: &str,
        count: usize,
    ) -> usize {
        let begin = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - begin;
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(format!(r#"{{"buffer": 0, "byteOffset": {begin}, "byteLength": {length}}}"#));
        let bounds = r#", "min": [-9, -9, -9], "max": [9, 9, 9]"#;
        let bounds = if kind == "VEC3" { bounds } else { "" };
        let view = self.views.len() - 1;
        self.accessors.push(format!(
            r#"{{"bufferView": {view}, "componentType": {component}, "count": {count}, "type": "{kind}"{bounds}}}"#
        ));
        view
    }

    fn floats(&mut self, values: &[f32], kind: &str, width: usize) -> usize {
        self.add(values.iter().flat_map(|x| x.to_le_bytes()), 5126, kind, values.len() / width)
    }

    /// Writes `a.gltf` and `a b.bin`, with the accessors added to a document.
    fn write(&self, folder: &Path, document: &str) {
        fs::write(folder.join("a b.bin"), &self.bytes).unwrap();
        let text = format!(
            r#"{{"asset": {{"version": "2.0"}}, "scene": 0, {document},
                "buffers": [{{"uri": "a%20b.bin", "byteLength": {}}}],
                "bufferViews": [{}], "accessors": [{}]}}"#,
            self.bytes.len(),
            self.views.join(","),
            self.accessors.join(",")
        );
        fs::write(folder.join("a.gltf"), text).unwrap();
    }
}

fn assert_near(found: &[Vector3<f64>], expected: &[[f64; 3]]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (point, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!(
            (found - Vector3::from(*expected)).norm() < 1e-5,
            "point {point}: {found:?}, not {expected:?}"
        );
    }
}

/// A strip of two triangles, split along a seam: three points at the bottom of an arm and three at its top. The arm hangs
/// on two joints; the upper one, one metre up, turns by 90° about z within a second, while a morph target moves the
/// first point along z.
fn arm(folder: &Path) {
    let mut binary = Binary::default();
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 2.0, 0.0],
        [0.0, 2.0, 0.0],
    ];
    let positions = binary.floats(points.as_flattened(), "VEC3", 3);
    let indices = binary.add((0..6_u16).flat_map(u16::to_le_bytes), 5123, "SCALAR", 6);
    let joints = points.map(|[_, y, _]: [f32; 3]| [u8::from(y > 1.0), 0, 0, 0]);
    let joints = binary.add(joints.into_iter().flatten(), 5121, "VEC4", 6);
    // Normalized bytes: 255 is 1.
    let weights = binary.add([[255, 0, 0, 0]; 6].into_iter().flatten(), 5121, "VEC4", 6);
    binary.accessors[weights] =
        binary.accessors[weights].replace("\"count\"", "\"normalized\": true, \"count\"");
    let mut moved = [[0.0; 3]; 6];
    moved[0] = [0.0, 0.0, 1.0];
    let target = binary.floats(moved.as_flattened(), "VEC3", 3);
    let uvs = binary.floats(&[0.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.5, 1.0, 0.5, 0.0, 0.25, 0.0], "VEC2", 2);
    let mut rest = [0.0; 32];
    [0, 5, 10, 15, 16, 21, 26, 31].iter().for_each(|k| rest[*k] = 1.0);
    rest[16 + 13] = -1.0;
    let rest = binary.floats(&rest, "MAT4", 16);
    let times = binary.floats(&[0.0, 1.0], "SCALAR", 1);
    let half = 0.5_f32.sqrt();
    let turns = binary.floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half], "VEC4", 4);
    let shares = binary.floats(&[0.0, 1.0], "SCALAR", 1);
    let bounds = r#""type": "SCALAR", "min": [0], "max": [1]"#;
    binary.accessors[times] = binary.accessors[times].replace(r#""type": "SCALAR""#, bounds);
    binary.write(
        folder,
        &format!(
            r#""scenes": [{{"nodes": [0, 1, 3]}}],
            "nodes": [
                {{"name": "arm", "mesh": 0, "skin": 0, "translation": [100, 0, 0]}},
                {{"name": "root", "children": [2]}},
                {{"name": "elbow", "translation": [0, 1, 0]}},
                {{"name": "prop", "mesh": 1, "scale": [2, 2, 2]}}
            ],
            "meshes": [
                {{"primitives": [{{
                    "attributes": {{"POSITION": {positions}, "JOINTS_0": {joints}, "WEIGHTS_0": {weights}, "TEXCOORD_0": {uvs}}},
                    "indices": {indices}, "targets": [{{"POSITION": {target}}}]
                }}]}},
                {{"primitives": [{{"attributes": {{"POSITION": {positions}}}, "indices": {indices}}}]}}
            ],
            "skins": [{{"joints": [1, 2], "inverseBindMatrices": {rest}}}],
            "animations": [{{
                "samplers": [{{"input": {times}, "output": {turns}}}, {{"input": {times}, "output": {shares}}}],
                "channels": [
                    {{"sampler": 0, "target": {{"node": 2, "path": "rotation"}}}},
                    {{"sampler": 1, "target": {{"node": 0, "path": "weights"}}}}
                ]
            }}]"#
        ),
    );
}

#[test]
fn a_gltf_is_posed_by_its_skin_and_its_morph_targets() {
    let folder = tempfile::tempdir().unwrap();
    arm(folder.path());
    let file = MeshFile::open(folder.path().join("a.gltf"), "arm", FRAMES).unwrap();
    assert!(file.moves() && file.metres_per_unit() == Some(1.0));
    // A skin ignores the transform of its node. At rest nothing is moved.
    let rest = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 2.0, 0.0],
        [0.0, 2.0, 0.0],
    ];
    assert_near(&file.positions(1).unwrap(), &rest);
    // A point at (x, y) above the elbow at (0, 1) goes to (-(y - 1), x + 1).
    let turned = [
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [-1.0, 1.0, 0.0],
        [1.0, 0.0, 0.0],
        [-1.0, 2.0, 0.0],
        [-1.0, 1.0, 0.0],
    ];
    assert_near(&file.positions(25).unwrap(), &turned);
    assert_near(&file.positions(999).unwrap(), &turned);
    assert!((file.positions(13).unwrap()[0].z - 0.5).abs() < 1e-6, "half a second");
}

#[test]
fn points_that_a_gltf_splits_for_its_texture_are_one_point() {
    let folder = tempfile::tempdir().unwrap();
    arm(folder.path());
    let file = MeshFile::open(folder.path().join("a.gltf"), "arm", FRAMES).unwrap();
    let mut mesh = file.mesh(1).unwrap();
    let uvs = mesh.uvs.clone().expect("it has texture coordinates");
    let mut frames = vec![file.positions(1).unwrap(), file.positions(25).unwrap()];
    file.merge_split_points(&mut mesh.surface, &mut frames);
    assert_eq!(mesh.surface.positions.len(), 4);
    assert_eq!([mesh.surface.faces.face(0), mesh.surface.faces.face(1)], [[0, 1, 2], [1, 3, 2]]);
    assert_near(&frames[1], &[[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, 2.0, 0.0]]);
    // Each corner keeps its own pair; v counts from the top in a glTF, from the bottom here.
    assert_eq!((uvs.0[uvs.1[0] as usize], uvs.0[uvs.1[3] as usize]), ([0.0, 0.0], [0.5, 0.0]));
    assert_eq!(mesh.uvs_of_points().unwrap()[1], Some([1.0, 0.0]), "of the first face");
}

#[test]
fn an_object_of_a_gltf_is_selected_by_the_name_of_its_node() {
    let folder = tempfile::tempdir().unwrap();
    arm(folder.path());
    let open = |object| MeshFile::open(folder.path().join("a.gltf"), object, FRAMES);
    assert_eq!(open("").unwrap().positions(1).unwrap().len(), 12);
    let prop = open("prop").unwrap().positions(1).unwrap();
    assert_near(&prop[3..5], &[[2.0, 0.0, 0.0], [2.0, 4.0, 0.0]]);
    let error = open("hat").err().expect("there is none").to_string();
    assert!(error.ends_with("it has no node or mesh `hat` with triangles"), "{error}");
}

/// A character of two joints as above, a point cache, and a blend shape, in centimetres with z up.
const STAGE: &str = r#"#usda 1.0
(
    metersPerUnit = 0.01
    timeCodesPerSecond = 48
    upAxis = "Z"
)
def SkelRoot "figure" {
    def Skeleton "bones" (prepend apiSchemas = ["SkelBindingAPI"]) {
        uniform token[] joints = ["root", "root/elbow"]
        uniform matrix4d[] bindTransforms = [
            ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)),
            ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 1, 0, 1))]
        uniform matrix4d[] restTransforms = [
            ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)),
            ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 1, 0, 1))]
        rel skel:animationSource = </figure/motion>
        double3 xformOp:translate = (0, 0, 10)
        uniform token[] xformOpOrder = ["xformOp:translate"]
    }
    def SkelAnimation "motion" {
        uniform token[] joints = ["root/elbow"]
        float3[] translations = [(0, 1, 0)]
        quatf[] rotations.timeSamples = { 2: [(1, 0, 0, 0)], 50: [(0.70710678, 0, 0, 0.70710678)] }
        half3[] scales = [(1, 1, 1)]
        uniform token[] blendShapes = ["swell"]
        float[] blendShapeWeights.timeSamples = { 2: [0], 50: [1] }
    }
    def Mesh "arm" (prepend apiSchemas = ["SkelBindingAPI"]) {
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        uniform token orientation = "leftHanded"
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 2, 0), (0, 2, 0)]
        int[] primvars:skel:jointIndices = [0, 0, 1, 1] (elementSize = 1, interpolation = "vertex")
        float[] primvars:skel:jointWeights = [1, 1, 1, 1] (elementSize = 1, interpolation = "vertex")
        uniform token[] skel:blendShapes = ["swell"]
        rel skel:blendShapeTargets = </figure/arm/swell>
        rel skel:skeleton = </figure/bones>
        texCoord2f[] primvars:st = [(0, 0), (1, 0), (1, 1), (0, 1)] (interpolation = "faceVarying")
        def BlendShape "swell" {
            uniform vector3f[] offsets = [(0, 0, 3)]
            uniform int[] pointIndices = [1]
        }
    }
}
def Xform "cart" {
    double3 xformOp:translate.timeSamples = { 2: (0, 0, 0), 4: (8, 0, 0) }
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Mesh "load" {
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        point3f[] points.timeSamples = {
            2: [(0, 0, 0), (1, 0, 0), (0, 1, 0)],
            4: [(0, 0, 0), (1, 0, 0), (0, 1, 6)],
        }
    }
    def Mesh "simple" {
        uniform token purpose = "proxy"
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    }
}
"#;

#[test]
fn a_usd_stage_is_posed_by_its_skeleton_its_blend_shapes_and_its_point_cache() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.usda");
    fs::write(&path, STAGE).unwrap();
    let file = MeshFile::open(&path, "figure", FRAMES).unwrap();
    assert!(file.moves() && file.metres_per_unit() == Some(0.01));
    // Frame 1 is time code 2, and frame 25 time code 50. A point (x, y, z) with z up is (x, z, -y) with y up; the skeleton
    // stands 10 up.
    let rest = [[0.0, 10.0, 0.0], [1.0, 10.0, 0.0], [1.0, 10.0, -2.0], [0.0, 10.0, -2.0]];
    assert_near(&file.positions(1).unwrap(), &rest);
    let turned = [[0.0, 10.0, 0.0], [1.0, 13.0, 0.0], [-1.0, 10.0, -2.0], [-1.0, 10.0, -1.0]];
    assert_near(&file.positions(25).unwrap(), &turned);
    let mesh = file.mesh(1).unwrap();
    assert_eq!(mesh.surface.faces.face(0), [3, 2, 1, 0], "left-handed faces are reversed");
    assert_eq!(mesh.uvs_of_points().unwrap()[2], Some([1.0, 1.0]));

    let cart = MeshFile::open(&path, "/cart", FRAMES).unwrap();
    assert_near(&cart.positions(2).unwrap(), &[[8.0, 0.0, 0.0], [9.0, 0.0, 0.0], [8.0, 6.0, -1.0]]);
    assert_eq!(
        MeshFile::open(&path, "", FRAMES).unwrap().positions(1).unwrap().len(),
        7,
        "proxies are left out"
    );
}

#[test]
fn a_mirror_turns_the_faces_of_a_gltf() {
    let folder = tempfile::tempdir().unwrap();
    for (scale, face) in [("1, 1, 1", [0, 1, 2]), ("-1, 1, 1", [0, 2, 1]), ("-1, 1, -2", [0, 1, 2])] {
        let mut binary = Binary::default();
        let positions = binary.floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0], "VEC3", 3);
        let document = format!(
            r#""scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0, "scale": [{scale}]}}],
               "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {positions}}}}}]}}]"#
        );
        binary.write(folder.path(), &document);
        let mesh = MeshFile::open(folder.path().join("a.gltf"), "", FRAMES).unwrap().mesh(1).unwrap();
        assert_eq!(mesh.surface.faces.face(0), face, "{scale}");
    }
}

/// The faces and the number of points of a stage, or why it is refused.
fn faces_of(stage: &str, object: &str) -> Result<(Vec<Vec<u32>>, usize), String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.usda");
    fs::write(&path, format!("#usda 1.0\n{stage}")).unwrap();
    let mesh = MeshFile::open(&path, object, FRAMES)
        .and_then(|file| file.mesh(1))
        .map_err(|error| error.to_string())?;
    let faces = mesh.surface.faces.iter().map(<[u32]>::to_vec).collect();
    Ok((faces, mesh.surface.positions.len()))
}

/// A mesh of two triangles.
const PAIR: &str = "int[] faceVertexCounts = [3, 3]\nint[] faceVertexIndices = [0, 1, 2, 0, 2, 3]\n\
                    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]\n";

#[test]
fn mirrors_holes_and_invisible_meshes_of_a_usd_stage_are_read() {
    let mirror = "double3 xformOp:scale = (1, -1, 1)\nuniform token[] xformOpOrder = [\"xformOp:scale\"]\n";
    let faces = |own: &str| faces_of(&format!("def Mesh \"a\" {{\n{PAIR}{own}}}\n"), "").unwrap().0;
    let turned = [[2, 1, 0], [3, 2, 0]];
    assert_eq!(faces(""), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(faces(mirror), turned);
    let left = "uniform token orientation = \"leftHanded\"\n";
    assert_eq!(faces(left), turned);
    assert_eq!(faces(&format!("{mirror}{left}")), [[0, 1, 2], [0, 2, 3]], "both cancel");
    assert_eq!(faces("int[] holeIndices = [0]\n"), [[0, 2, 3]]);
    let hidden = "def Xform \"g\" {\ntoken visibility = \"invisible\"\n";
    let both = format!("def Mesh \"a\" {{\n{PAIR}}}\n{hidden}def Mesh \"b\" {{\n{PAIR}}}\n}}\n");
    assert_eq!(faces_of(&both, "").unwrap().1, 4);
}

#[test]
fn a_point_instancer_is_refused_unless_other_prims_are_named() {
    let stage = format!(
        "def Mesh \"ground\" {{\n{PAIR}}}\ndef PointInstancer \"trees\" {{\nrel prototypes = [</trees/tree>]\n\
         int[] protoIndices = [0, 0]\npoint3f[] positions = [(5, 0, 0), (9, 0, 0)]\ndef Mesh \"tree\" {{\n{PAIR}}}\n}}\n"
    );
    let refused = faces_of(&stage, "").unwrap_err();
    assert!(refused.contains("PointInstancer") && refused.contains("`object`"), "{refused}");
    assert_eq!(faces_of(&stage, "ground").unwrap().1, 4);
    assert_eq!(faces_of(&stage, "/trees/tree").unwrap().1, 4);
}

#[test]
fn malformed_files_are_refused_without_their_content() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        let error = MeshFile::open(&path, "", FRAMES)
            .and_then(|file| file.mesh(1))
            .map(|_| ())
            .expect_err("malformed")
            .to_string();
        assert!(!error.contains("secret"), "{error}");
        error.rsplit("`: ").next().unwrap().to_owned()
    };
    assert_eq!(refused("a.glb", "secret"), "it is no valid glTF file");
    assert_eq!(refused("a.usda", "#usda 1.0\nsecret"), "it is no valid USD file");
    assert_eq!(refused("a.usdc", "PXR-USDC secret"), "it is no valid USD file");
    assert_eq!(refused("b.usda", "#usda 1.0\ndef Xform \"secret\" {}\n"), "it has no mesh");
    let lost = "#usda 1.0\ndef \"a\" (references = @secret.usda@) {}\n";
    assert_eq!(refused("c.usda", lost), "it refers to a file or a prim that cannot be read");
    let beyond = "#usda 1.0\ndef Mesh \"a\" { int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 9]\n\
                  point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)] }\n";
    assert_eq!(refused("d.usda", beyond), "a face refers to a point that does not exist");
    let required = r#"{"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_draco_mesh_compression"]}"#;
    assert!(refused("e.gltf", required).starts_with("it needs an extension that is not read"));
}

/// Reads a file whole, if it can be read.
fn read_all(path: &Path) {
    let _ = MeshFile::open(path, "", FRAMES).and_then(|file| {
        file.mesh(1)?;
        file.positions(7)
    });
}

/// Reads a file with one, two or four bytes replaced at random, and cut off at random.
fn read_mutations(path: &Path, cases: usize) {
    let whole = fs::read(path).unwrap();
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize
    };
    for case in 0..cases {
        let mut bytes = whole.clone();
        for _ in 0..[1, 2, 4][case % 3] {
            let place = random() % bytes.len();
            // A digit stays a digit most of the time, so that the numbers of a text change and not only its syntax.
            let is_digit = bytes[place].is_ascii_digit() && random() % 4 > 0;
            bytes[place] = if is_digit { b'0' + (random() % 10) as u8 } else { random() as u8 };
        }
        if case % 8 == 7 {
            bytes.truncate(random() % whole.len());
        }
        fs::write(path, bytes).unwrap();
        read_all(path);
    }
}

#[test]
fn no_truncation_and_no_flipped_byte_of_a_gltf_makes_reading_panic() {
    let folder = tempfile::tempdir().unwrap();
    arm(folder.path());
    read_mutations(&folder.path().join("a.gltf"), 300);
}

#[test]
fn no_truncation_and_no_flipped_byte_of_a_binary_gltf_makes_reading_panic() {
    let folder = tempfile::tempdir().unwrap();
    arm(folder.path());
    let mut text =
        fs::read_to_string(folder.path().join("a.gltf")).unwrap().replace(r#""uri": "a%20b.bin", "#, "");
    text.push_str(&" ".repeat(text.len().next_multiple_of(4) - text.len()));
    let binary = fs::read(folder.path().join("a b.bin")).unwrap();
    let mut bytes = b"glTF".to_vec();
    let number = |x: usize| (x as u32).to_le_bytes();
    bytes.extend([number(2), number(28 + text.len() + binary.len()), number(text.len())].concat());
    bytes.extend([&b"JSON"[..], text.as_bytes()].concat());
    bytes.extend([&number(binary.len())[..], b"BIN\0", &binary].concat());
    let path = folder.path().join("a.glb");
    fs::write(&path, bytes).unwrap();
    let moved = MeshFile::open(&path, "arm", FRAMES).unwrap().positions(25).unwrap();
    let text = MeshFile::open(folder.path().join("a.gltf"), "arm", FRAMES).unwrap();
    assert_eq!(moved, text.positions(25).unwrap());
    read_mutations(&path, 300);
}

/// Of a binary file only truncations: its reader allocates what a length says, and a flipped bit of one may ask for more memory
/// than there is.
#[test]
fn no_truncation_of_a_usd_and_no_flipped_byte_of_a_text_makes_reading_panic() {
    let folder = tempfile::tempdir().unwrap();
    let [text, binary] = ["a.usda", "a.usdc"].map(|name| folder.path().join(name));
    fs::write(&text, STAGE).unwrap();
    openusd::usdc::CrateWriter::write_to_file(&openusd::usda::parse(STAGE).unwrap(), &binary).unwrap();
    let positions = |path| MeshFile::open(path, "figure", FRAMES).unwrap().positions(25).unwrap();
    assert_eq!(positions(&text), positions(&binary));
    read_mutations(&text, 200);
    let whole = fs::read(&binary).unwrap();
    for cut in (0..whole.len()).step_by(whole.len() / 100) {
        fs::write(&binary, &whole[..cut]).unwrap();
        read_all(&binary);
    }
}
