//! Accepted forms, and refused ones with their line.

use std::fmt::Write as _;

use nucleus_core::Faces;
use proptest::prelude::*;

use super::*;
use crate::files::LineSpan;

fn mesh(text: impl AsRef<[u8]>) -> Surface {
    read(text.as_ref()).unwrap()
}

/// The line of the error and its fault.
fn fault(text: &str) -> (u64, ObjFault) {
    match read(text.as_bytes()) {
        Err(Fault::Line(line, fault)) => (line, fault),
        other => panic!("{text}: {other:?}"),
    }
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

#[test]
fn all_forms_of_a_corner_refer_to_the_same_vertex() {
    for face in ["1 2 3", "1/9 2/9 3/9", "1//9 2//9 3//9", "1/9/9 2/9/9 3/9/9", "-3 -2 -1", "-3//1 2 3/4"] {
        assert_eq!(mesh(format!("{TRIANGLE}f {face}")).faces.face(0), [0, 1, 2], "{face}");
    }
}

#[test]
fn negative_numbers_count_back_from_the_line_and_positive_ones_may_refer_ahead() {
    let text = "f 3 4 5\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -3\nv 0 0 1\nv 0 0 2\n";
    let faces = mesh(text).faces;
    assert_eq!((faces.face(0), faces.face(1)), (&[2, 3, 4][..], &[2, 1, 0][..]));
}

#[test]
fn other_statements_and_comments_are_ignored() {
    let text = b"\xef\xbb\xbf# by caf\xe9 C:\\\r\nmtllib a.mtl\r\no caf\xe9\r\nv 0 0 0 1.0\r\nv 1 0 0 0.5 0.5 0.5\r\n\
        vn 0 0 1\r\nvt 0 0\r\n\tv  0\t1 0 1 0.5 0.5 0.5 # corner\r\nusemtl m\r\ns off\r\nf 1 \\\r\n 2 \\\r\n 3\r\n\r\nl 1 2\r\n";
    let surface = mesh(text);
    assert_eq!(surface.positions, [Vector3::zeros(), Vector3::x(), Vector3::y()]);
    assert_eq!(surface.faces.iter().collect::<Vec<_>>(), [[0, 1, 2]]);
}

#[test]
fn a_file_need_not_end_its_last_line() {
    assert_eq!(mesh(format!("{TRIANGLE}f 1 2 3")), mesh(format!("{TRIANGLE}f 1 2 \\\n3\\")));
}

#[test]
fn faults_are_named_with_their_line() {
    let span = |column, bytes| LineSpan { column, bytes };
    let cases = [
        ("v 0 0 0\nv 1 nan 0", 2, ObjFault::NotFinite { span: span(5, 3) }),
        ("v 0 0 -inf", 1, ObjFault::NotFinite { span: span(7, 4) }),
        ("v 0 0 1e999", 1, ObjFault::NotFinite { span: span(7, 5) }),
        ("# one\nv 0 0,5 1", 2, ObjFault::NotANumber { span: span(5, 3) }),
        ("v 0 0", 1, ObjFault::WrongNumberCount { found: 2 }),
        ("v 0 0 0 0 0", 1, ObjFault::WrongNumberCount { found: 5 }),
        ("v 0 0 0\nf 1 1", 2, ObjFault::TooFewCorners { found: 2 }),
        ("v 0 0 0\nf", 2, ObjFault::TooFewCorners { found: 0 }),
        ("v 0 0 0\nf 1 1 x", 2, ObjFault::NotACorner { span: span(7, 1) }),
        ("v 0 0 0\nf 1 1 /1", 2, ObjFault::NotACorner { span: span(7, 2) }),
        ("v 0 0 0\nf 1 1.5 1", 2, ObjFault::NotACorner { span: span(5, 3) }),
        ("v 0 0 0\nf 1 0 1", 2, ObjFault::VertexZero),
        ("v 0 0 0\nf 1 \\\n1 -2", 2, ObjFault::NoSuchVertex { vertex: -2, vertices: 1 }),
        ("f 1 2 1\nv 0 0 0", 1, ObjFault::NoSuchVertex { vertex: 2, vertices: 1 }),
        ("v 0 0 0\nf 1 1 9999999999", 2, ObjFault::NoSuchVertex { vertex: 9_999_999_999, vertices: 1 }),
        ("v 0 0 0\nf 1 1 -9223372036854775808", 2, ObjFault::NoSuchVertex { vertex: i64::MIN, vertices: 1 }),
    ];
    for (text, line, expected) in cases {
        assert_eq!(fault(text), (line, expected), "{text}");
    }
}

#[test]
fn a_face_of_too_many_corners_is_named_with_its_line() {
    let face = |corners: usize| format!("v 0 0 0\nf{}", " 1".repeat(corners));
    assert!(read(face(4096).as_bytes()).is_ok());
    assert_eq!(fault(&face(4097)), (2, ObjFault::TooManyCorners { found: 4097, max: 4096 }));
}

#[test]
fn files_without_vertices_and_missing_files_are_refused() {
    for text in [&b""[..], b"\n\n", b"vn 0 0 1\n", b"\xff\xfe\0v\0", b"Scene()"] {
        assert!(matches!(read(text), Err(Fault::NoVertices)), "{text:?}");
    }
    let folder = tempfile::tempdir().unwrap();
    for path in [folder.path().to_owned(), folder.path().join("no.obj")] {
        let error = read_obj(&path).unwrap_err();
        assert!(error.to_string().starts_with(&format!("cannot read `{}`: ", path.display())), "{error}");
    }
}

#[test]
fn an_object_without_vertices_has_no_points() {
    let empty = "mtllib m.mtl\no drops\nusemtl drops\n";
    assert!(points(empty.as_bytes()).unwrap().is_empty());
    assert_eq!(points("o drops\nv 1 2 3\n".as_bytes()).unwrap(), [Vector3::new(1.0, 2.0, 3.0)]);
    assert!(matches!(read(empty.as_bytes()), Err(Fault::NoVertices)), "no mesh");
    for text in ["", "Scene()", "vn 0 0 1\n"] {
        assert!(matches!(points(text.as_bytes()), Err(Fault::NoVertices)), "{text:?}");
    }
}

/// A mesh as this test would write it.
fn written(surface: &Surface) -> String {
    let mut text = String::new();
    for point in &surface.positions {
        writeln!(text, "v {:?} {:?} {:?}", point.x, point.y, point.z).unwrap();
    }
    for face in surface.faces.iter() {
        let corners: Vec<_> = face.iter().map(|corner| (corner + 1).to_string()).collect();
        writeln!(text, "f {}", corners.join(" ")).unwrap();
    }
    text
}

/// Meshes of up to 30 points, any numbers, with polygons of up to six corners.
fn meshes() -> impl Strategy<Value = Surface> {
    let number = || any::<f64>().prop_filter("finite", |x| x.is_finite());
    let points = prop::collection::vec([number(), number(), number()].prop_map(Vector3::from), 1..30);
    points.prop_flat_map(|positions| {
        let corner = 0..positions.len() as u32;
        let faces = prop::collection::vec(prop::collection::vec(corner, 3..7), 0..20);
        faces.prop_map(move |faces| Surface {
            positions: positions.clone(),
            faces: faces.iter().map(Vec::as_slice).collect::<Faces>(),
        })
    })
}

proptest! {
    #[test]
    fn a_written_mesh_is_read_back(surface in meshes()) {
        prop_assert_eq!(mesh(written(&surface)), surface);
    }

    #[test]
    fn no_text_panics(text in "(v|f|#|\\\\|\r|\n| |/|-|[0-9]|1e9|\\.|.){0,60}") {
        if let Ok(surface) = read(text.as_bytes()) {
            let points = surface.positions.len() as u32;
            prop_assert!(surface.faces.corners().iter().all(|&corner| corner < points));
        }
    }
}
