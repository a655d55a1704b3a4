//! Primitives are closed, face outward, and have Maya's order of points.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use nalgebra::Vector3;
use nucleus_core::Surface;
use proptest::prelude::*;

use super::*;

/// Points less edges plus faces: 2 for a closed surface without holes, 1 for a disc.
fn euler_characteristic(mesh: &Surface) -> i64 {
    let around = |face: &[u32]| {
        face.iter().zip(face.iter().cycle().skip(1)).map(|(&a, &b)| (a.min(b), a.max(b))).collect::<Vec<_>>()
    };
    let edges: BTreeSet<_> = mesh.faces.iter().flat_map(around).collect();
    mesh.positions.len() as i64 - edges.len() as i64 + mesh.faces.len() as i64
}

/// Every edge occurs once in each direction: there is no hole, and all faces have the same orientation.
fn is_closed(mesh: &Surface) -> bool {
    let around = |face: &[u32]| {
        face.iter().copied().zip(face.iter().copied().cycle().skip(1)).take(face.len()).collect::<Vec<_>>()
    };
    let ways: Vec<_> = mesh.faces.iter().flat_map(around).collect();
    let all: BTreeSet<_> = ways.iter().copied().collect();
    all.len() == ways.len() && ways.iter().all(|&(a, b)| all.contains(&(b, a)))
}

/// Volume inside; negative when faces look inward.
fn volume(mesh: &Surface) -> f64 {
    let point = |corner: u32| mesh.positions[corner as usize];
    mesh.faces.triangles().map(|[a, b, c]| point(a).dot(&point(b).cross(&point(c))) / 6.0).sum()
}

/// Equal up to single precision, in which Maya stores points.
fn close(a: Vector3<f64>, b: [f64; 3]) -> bool {
    (a - Vector3::from(b)).norm() < 1e-6
}

#[test]
fn a_plane_is_counted_from_the_near_left_corner_and_faces_up() {
    let plane = poly_plane(2.0, 4.0, (2, 1)).unwrap();
    let expected = [[-1.0, 2.0], [0.0, 2.0], [1.0, 2.0], [-1.0, -2.0], [0.0, -2.0], [1.0, -2.0]];
    assert_eq!(plane.positions, expected.map(|[x, z]| Vector3::new(x, 0.0, z)));
    assert_eq!(plane.faces.iter().collect::<Vec<_>>(), [[0, 1, 4, 3], [1, 2, 5, 4]]);
    for [a, b, c] in plane.faces.triangles() {
        let [a, b, c] = [a, b, c].map(|corner| plane.positions[corner as usize]);
        assert!((b - a).cross(&(c - a)).y > 0.0);
    }
}

/// The points of Maya's default objects, as its own files list them.
#[test]
fn points_are_counted_as_in_maya() {
    let plane = poly_plane(1.0, 1.0, (10, 10)).unwrap();
    assert!(plane.positions.len() == 121 && close(plane.positions[1], [-0.4, 0.0, 0.5]));

    let cube = poly_cube(1.0, 1.0, 1.0, (1, 1, 1)).unwrap();
    let corners =
        [[-1, -1, 1], [1, -1, 1], [-1, 1, 1], [1, 1, 1], [-1, 1, -1], [1, 1, -1], [-1, -1, -1], [1, -1, -1]];
    assert_eq!(cube.positions, corners.map(|corner| Vector3::from(corner).cast::<f64>() / 2.0));
    let sides = [[0, 1, 3, 2], [2, 3, 5, 4], [4, 5, 7, 6], [6, 7, 1, 0], [1, 7, 5, 3], [6, 0, 2, 4]];
    assert_eq!(cube.faces.iter().collect::<Vec<_>>(), sides);

    let finer = poly_cube(1.0, 1.0, 1.0, (3, 3, 3)).unwrap();
    let sixth = 1.0 / 6.0;
    assert_eq!(finer.positions.len(), 56);
    assert!(
        close(finer.positions[16], [-0.5, 0.5, sixth]) && close(finer.positions[40], [-0.5, -0.5, -sixth])
    );
    assert!(
        close(finer.positions[48], [0.5, -sixth, -sixth]) && close(finer.positions[49], [0.5, -sixth, sixth])
    );
    assert!(
        close(finer.positions[52], [-0.5, -sixth, -sixth])
            && close(finer.positions[54], [-0.5, sixth, -sixth])
    );

    let sphere = poly_sphere(1.0, (20, 20)).unwrap();
    assert_eq!((sphere.positions.len(), sphere.faces.len()), (382, 400));
    assert!(close(sphere.positions[0], [0.14877813, -0.98768836, -0.048340943]));
    assert!(close(sphere.positions[19], [0.15643448, -0.98768836, 0.0]));
    assert!(close(sphere.positions[380], [0.0, -1.0, 0.0]) && close(sphere.positions[381], [0.0, 1.0, 0.0]));

    let cylinder = poly_cylinder(1.0, 2.0, (20, 1, 1)).unwrap();
    assert_eq!((cylinder.positions.len(), cylinder.faces.len()), (42, 60));
    assert!(close(cylinder.positions[1], [0.809017, -1.0, -0.58778525]));
    assert!(close(cylinder.positions[20], [0.95105652, 1.0, -0.30901699]));
    let ringed = poly_cylinder(1.0, 2.0, (20, 1, 2)).unwrap();
    assert_eq!(ringed.positions.len(), 82);
    assert!(close(ringed.positions[0], [0.47552826, -1.0, -0.1545085]));
    assert!(close(ringed.positions[20], [0.95105652, -1.0, -0.30901699]));
    assert_eq!(poly_cylinder(1.0, 2.0, (20, 1, 0)).unwrap().positions.len(), 40);
}

#[test]
fn finer_meshes_come_closer_to_the_exact_volume() {
    let sphere = |n| volume(&poly_sphere(2.0, (n, n)).unwrap()) / (PI * 32.0 / 3.0);
    let cylinder = |n| volume(&poly_cylinder(0.5, 3.0, (n, 2, 1)).unwrap()) / (PI * 0.75);
    for shape in [&sphere as &dyn Fn(u32) -> f64, &cylinder] {
        let missing = [20, 40, 80].map(|n| 1.0 - shape(n));
        assert!(missing[0] > 0.0 && missing[0] < 0.05, "{missing:?}");
        // Halving the step leaves a quarter of the error.
        for k in 0..2 {
            assert!((missing[k] / missing[k + 1] - 4.0).abs() < 0.1, "{missing:?}");
        }
    }
}

#[test]
fn invalid_parameters_are_refused() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            poly_plane(1.0, bad, (1, 1)),
            Err(PrimitiveError::BadLength { name: "height", .. })
        ));
        assert!(matches!(poly_sphere(bad, (8, 8)), Err(PrimitiveError::BadLength { name: "radius", .. })));
    }
    let too_few = |name, value, min| Err(PrimitiveError::TooFewSubdivisions { name, value, min });
    assert_eq!(poly_plane(1.0, 1.0, (0, 1)), too_few("width", 0, 1));
    assert_eq!(poly_cube(1.0, 1.0, 1.0, (1, 1, 0)), too_few("depth", 0, 1));
    assert_eq!(poly_sphere(1.0, (2, 8)), too_few("axis", 2, 3));
    assert_eq!(poly_cylinder(1.0, 1.0, (3, 0, 0)), too_few("height", 0, 1));
    let max = u32::MAX;
    for mesh in [
        poly_plane(1.0, 1.0, (max, max)),
        poly_cube(1.0, 1.0, 1.0, (1, max, max)),
        poly_cube(1.0, 1.0, 1.0, (max, max, max)),
        poly_sphere(1.0, (max, max)),
        poly_cylinder(1.0, 1.0, (3, 1, max)),
    ] {
        assert!(matches!(mesh, Err(PrimitiveError::TooManyPoints { .. })));
    }
}

proptest! {
    #[test]
    fn the_size_of_a_primitive_is_known_before_it_is_made(x in 3..9_u32, y in 2..9_u32, z in 0..5_u32) {
        for primitive in [
            Primitive::Plane([1.0, 2.0], [x, y]),
            Primitive::Sphere(1.0, [x, y]),
            Primitive::Cube([1.0, 2.0, 3.0], [x, y, z + 1]),
            Primitive::Cylinder([1.0, 2.0], [x, y, z]),
        ] {
            let made = primitive.surface().unwrap();
            let counted = [made.positions.len(), made.faces.corners().len()].map(|count| count as u64);
            let size = primitive.size();
            prop_assert_eq!([size.points, size.corners], counted, "{:?}", primitive);
        }
    }

    #[test]
    fn a_plane_is_one_sheet(sx in 1..12_u32, sy in 1..12_u32) {
        let plane = poly_plane(3.0, 2.0, (sx, sy)).unwrap();
        prop_assert_eq!(euler_characteristic(&plane), 1);
        prop_assert_eq!(plane.faces.len() as u32, sx * sy);
    }

    #[test]
    fn a_cube_is_closed_and_holds_exactly_its_volume(sx in 1..6_u32, sy in 1..6_u32, sz in 1..6_u32) {
        let cube = poly_cube(2.0, 3.0, 5.0, (sx, sy, sz)).unwrap();
        prop_assert!(is_closed(&cube) && euler_characteristic(&cube) == 2);
        prop_assert!((volume(&cube) - 30.0).abs() < 1e-12);
        prop_assert_eq!(cube.faces.len() as u32, 2 * (sx * sy + sy * sz + sz * sx));
    }

    #[test]
    fn spheres_and_cylinders_are_closed_and_face_outward(sx in 3..12_u32, sy in 2..12_u32, sz in 0..4_u32) {
        let (sphere, cylinder) = (poly_sphere(1.0, (sx, sy)).unwrap(), poly_cylinder(1.0, 2.0, (sx, sy, sz)).unwrap());
        for mesh in [&sphere, &cylinder] {
            prop_assert!(is_closed(mesh) && euler_characteristic(mesh) == 2);
            // Convex round the origin, so every face must look away from it.
            let point = |corner: u32| mesh.positions[corner as usize];
            for [a, b, c] in mesh.faces.triangles() {
                prop_assert!(point(a).dot(&point(b).cross(&point(c))) > 0.0);
            }
        }
        prop_assert_eq!(sphere.positions.len() as u32, sx * (sy - 1) + 2);
    }
}

#[test]
fn the_rotation_to_an_axis_takes_y_there_and_turns_nothing_about_it() {
    for axis in [[1.0, 0.0, 0.0], [0.0, 0.0, -3.0], [1.0, 2.0, 3.0], [0.0, -2.0, 0.0], [1e-3, -5.0, 0.0]] {
        let rotation = rotation_to_axis(axis).expect("a rotation");
        let direction = Vector3::from(axis).normalize();
        assert!((rotation * Vector3::y() - direction).norm() < 1e-12, "{axis:?}");
        assert!((rotation.matrix().determinant() - 1.0).abs() < 1e-12, "{axis:?}");
        let across = Vector3::y().cross(&direction);
        assert!(
            (rotation * across - across).norm() < 1e-12,
            "the normal of the plane of both stays: {axis:?}"
        );
    }
    assert_eq!(rotation_to_axis([0.0, 7.0, 0.0]), None);
    assert_eq!(rotation_to_axis([0.0; 3]), None);
}
