//! Texture coordinates of primitives that have seams, by the corners of their faces: Maya's defaults.

use crate::animation::sin_cos_degrees;
use crate::mesh::CornerUvs;

use super::{Primitive, steps};

impl Primitive {
    /// The texture coordinates of its corners with Maya's default settings; `None` for a plane, whose points have one value each
    /// (see [`poly_plane_uvs`](super::poly_plane_uvs)). Meaningless for invalid parameters.
    pub fn corner_uvs(&self) -> Option<CornerUvs> {
        match *self {
            Self::Plane(..) => None,
            Self::Sphere(_, steps) => Some(sphere(steps)),
            Self::Cube(lengths, steps) => Some(cube(lengths, steps)),
            Self::Cylinder(_, steps) => Some(cylinder(steps)),
        }
    }
}

/// u once round the axis, v from pole to pole, both from 0 to 1. Each triangle at a pole has a value of its own there, in the
/// middle of its other two (`createUVs` 2, "sawtooth at poles").
fn sphere([sx, sy]: [u32; 2]) -> CornerUvs {
    let share = |k: u32, of: u32| f64::from(k) / f64::from(of);
    let rings = sy - 1;
    let ring = |k: u32| (0..=sx).map(move |i| [share(i, sx), share(k, sy)]);
    let pole = |v: f64| (0..sx).map(move |i| [(f64::from(i) + 0.5) / f64::from(sx), v]);
    let values = (1..sy).flat_map(ring).chain(pole(0.0)).chain(pole(1.0)).collect();
    let at = |k: u32, i: u32| k * (sx + 1) + i;
    let quads = (0..rings - 1)
        .flat_map(|k| (0..sx).flat_map(move |i| [at(k, i), at(k, i + 1), at(k + 1, i + 1), at(k + 1, i)]));
    let first_pole = rings * (sx + 1);
    let bottom = (0..sx).flat_map(|i| [at(0, i + 1), at(0, i), first_pole + i]);
    let top = (0..sx).flat_map(|i| [at(rings - 1, i), at(rings - 1, i + 1), first_pole + sx + i]);
    (values, quads.chain(bottom).chain(top).collect())
}

/// A cross in the middle of the square: front, top, back and bottom above each other, the sides beside the front, in one scale
/// in which the longer side of the cross is 1 (`createUVs` 4, normalized together with the aspect ratio preserved).
fn cube([width, height, depth]: [f64; 3], [sx, sy, sz]: [u32; 3]) -> CornerUvs {
    let [wide, tall] = [width + 2.0 * depth, 2.0 * (height + depth)];
    let longest = wide.max(tall);
    let low = [0.5 * (longest - wide), 0.5 * (longest - tall)];
    // From the lower left corner of the cross.
    let place = |x: f64, y: f64| [(low[0] + x) / longest, (low[1] + y) / longest];
    let mut found = CornerUvs::default();
    let mut y = 0.0;
    for (length, rows) in [(height, sy), (depth, sz), (height, sy), (depth, sz)] {
        let belt = |i: f64, j: f64| place(depth + width * i, y + length * j);
        add_quads(&mut found, [sx, rows], belt);
        y += length;
    }
    // The faces of both sides are counted from the back: that of the right one is its outer edge.
    add_quads(&mut found, [sz, sy], |k, j| place(depth + width + depth * (1.0 - k), height * j));
    add_quads(&mut found, [sz, sy], |k, j| place(depth * k, height * j));
    // Seen from outside, the right side begins each face in front.
    let right = 4 * (2 * (sx * sy + sx * sz)) as usize;
    let face_of_right = found.1[right..right + 4 * (sy * sz) as usize].chunks_exact_mut(4);
    face_of_right.for_each(|face| {
        face.swap(0, 1);
        face.swap(2, 3);
    });
    found
}

/// The strip of a cylinder's side: its lower left and upper right corner.
const STRIP: [[f64; 2]; 2] = [[0.375, 0.3125], [0.625, 0.68843985]];
/// Radius of a cylinder's caps.
const CAP_RADIUS: f64 = 0.15625;
/// The v of the centre of a cap's rim, and of its middle point, which Maya places off it.
const BOTTOM: [f64; 2] = [0.15625, 0.15];
const TOP: [f64; 2] = [0.84375, 0.8375];

/// The side is one strip, with a cap below and above it, in a layout that no length and no subdivision changes
/// (`createUVs` 3).
fn cylinder([sx, sy, sz]: [u32; 3]) -> CornerUvs {
    let mut found = CornerUvs::default();
    // Seen from below, the way round the axis is clockwise.
    let bottom = Cap::add(&mut found.0, [sx, sz], BOTTOM, -1.0);
    let top = Cap::add(&mut found.0, [sx, sz], TOP, 1.0);
    for ring in 1..bottom.rings {
        found.1.extend(bottom.quads(ring, ring + 1));
    }
    let [low, high] = STRIP;
    let along = |axis: usize, share: f64| low[axis] + (high[axis] - low[axis]) * share;
    add_quads(&mut found, [sx, sy], |i, k| [along(0, i), along(1, k)]);
    for ring in (1..top.rings).rev() {
        found.1.extend(top.quads(ring + 1, ring));
    }
    match sz {
        0 => found.1.extend((0..sx).rev().map(|i| bottom.at(1, i)).chain((0..sx).map(|i| top.at(1, i)))),
        _ => {
            found.1.extend(steps(sx).flat_map(|(a, b)| [bottom.at(1, b), bottom.at(1, a), bottom.middle()]));
            found.1.extend(steps(sx).flat_map(|(a, b)| [top.at(1, a), top.at(1, b), top.middle()]));
        }
    }
    found
}

/// The values of a cap: its rings from the middle to the rim, then its middle.
#[derive(Clone, Copy)]
struct Cap {
    first: u32,
    sides: u32,
    rings: u32,
}

impl Cap {
    /// Appends the values of a cap. `turn` is 1 where v is along -z, and -1 where it is along +z.
    fn add(values: &mut Vec<[f64; 2]>, [sx, sz]: [u32; 2], [rim, middle]: [f64; 2], turn: f64) -> Self {
        let cap = Self { first: values.len() as u32, sides: sx, rings: sz.max(1) };
        for (ring, i) in (1..=cap.rings).flat_map(|ring| (1..=sx).map(move |i| (ring, i))) {
            let share = f64::from(ring) / f64::from(cap.rings);
            let (sin, cos) = sin_cos_degrees(360.0 * f64::from(i) / f64::from(sx));
            let centre = middle + (rim - middle) * share;
            let radius = CAP_RADIUS * share;
            values.push([0.5 + radius * cos, centre + turn * radius * sin]);
        }
        values.extend((sz > 0).then_some([0.5, middle]));
        cap
    }

    fn at(self, ring: u32, i: u32) -> u32 {
        self.first + (ring - 1) * self.sides + i
    }

    fn middle(self) -> u32 {
        self.first + self.rings * self.sides
    }

    fn quads(self, lower: u32, upper: u32) -> impl Iterator<Item = u32> {
        let quad = move |(a, b)| [self.at(lower, a), self.at(lower, b), self.at(upper, b), self.at(upper, a)];
        steps(self.sides).flat_map(quad)
    }
}

/// Appends a rectangle of quads, row by row, with a value at each of its points, by their shares of its sides.
fn add_quads(
    (values, corners): &mut CornerUvs,
    [columns, rows]: [u32; 2],
    value: impl Fn(f64, f64) -> [f64; 2],
) {
    let first = values.len() as u32;
    let share = |k: u32, of: u32| f64::from(k) / f64::from(of);
    for (j, i) in (0..=rows).flat_map(|j| (0..=columns).map(move |i| (j, i))) {
        values.push(value(share(i, columns), share(j, rows)));
    }
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let near = first + j * (columns + 1) + i;
        let far = near + columns + 1;
        corners.extend([near, near + 1, far + 1, far]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The texture coordinates of each face, corner by corner.
    fn of_faces(primitive: Primitive) -> Vec<Vec<[f64; 2]>> {
        let (values, corners) = primitive.corner_uvs().expect("it has some");
        let faces = primitive.surface().expect("valid parameters").faces;
        assert_eq!(corners.len(), faces.corners().len());
        let mut next = corners.iter().map(|corner| values[*corner as usize]);
        faces.iter().map(|face| next.by_ref().take(face.len()).collect()).collect()
    }

    #[test]
    fn a_cube_has_the_cross_that_maya_exports() {
        // The `vt` and `f` lines of Maya's default cube.
        let cross = [
            [[0.375, 0.0], [0.625, 0.0], [0.625, 0.25], [0.375, 0.25]],
            [[0.375, 0.25], [0.625, 0.25], [0.625, 0.5], [0.375, 0.5]],
            [[0.375, 0.5], [0.625, 0.5], [0.625, 0.75], [0.375, 0.75]],
            [[0.375, 0.75], [0.625, 0.75], [0.625, 1.0], [0.375, 1.0]],
            [[0.625, 0.0], [0.875, 0.0], [0.875, 0.25], [0.625, 0.25]],
            [[0.125, 0.0], [0.375, 0.0], [0.375, 0.25], [0.125, 0.25]],
        ];
        let found = of_faces(Primitive::Cube([1.0; 3], [1; 3]));
        assert_eq!(found, cross.map(Vec::from));
    }

    #[test]
    fn a_sphere_has_the_sawtooth_that_maya_exports() {
        let found = of_faces(Primitive::Sphere(1.0, [20, 20]));
        // `f 1/1 2/2 22/23 21/22`, the last quad of the first ring, and a triangle at each pole.
        assert_eq!(found[0], [[0.0, 0.05], [0.05, 0.05], [0.05, 0.1], [0.0, 0.1]]);
        assert_eq!(found[19], [[0.95, 0.05], [1.0, 0.05], [1.0, 0.1], [0.95, 0.1]]);
        assert_eq!(found[360], [[0.05, 0.05], [0.0, 0.05], [0.025, 0.0]]);
        assert_eq!(found[380], [[0.0, 0.95], [0.05, 0.95], [0.025, 1.0]]);
    }

    #[test]
    fn a_cylinder_has_the_strip_and_the_discs_that_maya_exports() {
        // A cylinder of radius 0.208 and height 4.72 with 6, 1 and 1 subdivisions, as Maya stores it.
        let expected: [(usize, &[[f64; 2]]); 6] = [
            (0, &[[0.375, 0.3125], [0.41666666, 0.3125], [0.41666666, 0.68843985], [0.375, 0.68843985]]),
            (5, &[[0.58333331, 0.3125], [0.625, 0.3125], [0.625, 0.68843985], [0.58333331, 0.68843985]]),
            (6, &[[0.42187503, 0.020933509], [0.57812506, 0.020933539], [0.5, 0.15000001]]),
            (11, &[[0.57812506, 0.020933539], [0.65625, 0.15625], [0.5, 0.15000001]]),
            (12, &[[0.578125, 0.97906649], [0.421875, 0.97906649], [0.5, 0.83749998]]),
            (17, &[[0.65625, 0.84375], [0.578125, 0.97906649], [0.5, 0.83749998]]),
        ];
        let found = of_faces(Primitive::Cylinder([0.208, 4.72], [6, 1, 1]));
        for (face, uvs) in expected {
            let is_near = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-7;
            assert!(found[face].len() == uvs.len() && found[face].iter().zip(uvs).all(is_near), "{face}");
        }
    }

    #[test]
    fn points_of_a_cylinder_have_one_place_on_each_of_its_charts_and_faces_are_seen_from_outside() {
        for caps in [0, 1, 3] {
            let primitive = Primitive::Cylinder([1.0, 2.0], [5, 2, caps]);
            let faces = primitive.surface().expect("valid parameters").faces;
            let of_faces = of_faces(primitive);
            let mut places = std::collections::BTreeMap::<u32, Vec<[u64; 2]>>::new();
            for (face, uvs) in faces.iter().zip(&of_faces) {
                for (point, uv) in face.iter().zip(uvs) {
                    places.entry(*point).or_default().push(uv.map(f64::to_bits));
                }
                let doubled: f64 = (0..uvs.len())
                    .map(|k| (uvs[k], uvs[(k + 1) % uvs.len()]))
                    .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
                    .sum();
                assert!(doubled > 0.0, "{uvs:?}");
            }
            let count = |places: &Vec<[u64; 2]>| {
                let mut places = places.clone();
                places.sort_unstable();
                places.dedup();
                places.len()
            };
            // Point 2 of the lower rim is on the side and on the cap, that above it on the side alone.
            let rim = 5 * caps.saturating_sub(1);
            assert_eq!(count(&places[&(rim + 2)]), 2, "{caps}");
            assert_eq!(count(&places[&(rim + 5 + 2)]), 1, "{caps}");
        }
    }

    #[test]
    fn faces_keep_their_shape_and_orientation_in_the_texture_of_a_cube() {
        let (lengths, steps) = ([3.0, 2.0, 1.5], [3, 4, 2]);
        let primitive = Primitive::Cube(lengths, steps);
        let surface = primitive.surface().expect("valid parameters");
        let scale = 1.0 / 7.0;
        for (face, uvs) in surface.faces.iter().zip(of_faces(primitive)) {
            for k in 0..4 {
                let [a, b] = [k, (k + 1) % 4];
                let edge = (surface.positions[face[b] as usize] - surface.positions[face[a] as usize]).norm();
                let length = (uvs[b][0] - uvs[a][0]).hypot(uvs[b][1] - uvs[a][1]);
                assert!((length - scale * edge).abs() < 1e-12, "{uvs:?}");
            }
            let [across, along] = [1, 3].map(|k| [uvs[k][0] - uvs[0][0], uvs[k][1] - uvs[0][1]]);
            assert!(across[0] * along[1] - across[1] * along[0] > 0.0, "seen from outside: {uvs:?}");
        }
    }
}
