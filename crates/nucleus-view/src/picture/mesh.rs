//! All objects as one mesh of triangles and spheres, with normals and colours.

use nucleus_cache::COS_HARD_EDGE;
use nucleus_core::ParticleLook;

use super::camera::View;
use super::scene::{Colouring, Kind, Object, Style, Vec3, is_drawable, unit};
use super::strain;

/// A vertex of triangles.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    pub position: Vec3,
    pub normal: Vec3,
    /// Linear colour.
    pub colour: Vec3,
    /// Visible fraction of the sky from the front and from the back, 0 to 1.
    pub sky: [f32; 2],
}

/// A triangle: its vertices, and which of its sides (a-b, b-c, c-a) are edges of a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Triangle {
    pub corners: [u32; 3],
    pub edges: [bool; 3],
}

/// A particle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sphere {
    pub centre: Vec3,
    /// In scene units.
    pub radius: f32,
    pub colour: Vec3,
    /// Linear colour of the light it gives off.
    pub glow: Vec3,
    /// 0 is invisible, 1 opaque.
    pub opacity: f32,
}

/// Radius of particles that have none, relative to the half extent of the view.
const DEFAULT_RADIUS: f32 = 0.008;

/// The drawable parts of all objects.
#[derive(Debug, Default)]
pub(super) struct Mesh {
    pub vertices: Vec<Vertex>,
    pub triangles: Vec<Triangle>,
    pub spheres: Vec<Sphere>,
}

impl Mesh {
    /// Collects the drawable faces and particles of the objects, in their order.
    pub fn gather(objects: &[Object], style: &Style, view: &View) -> Self {
        let mut mesh = Self::default();
        let default_radius = view.half_extent() * DEFAULT_RADIUS;
        let (mut cloths, mut colliders) = (0_usize, 0_usize);
        for object in objects {
            // Hidden objects count, so that the others keep their colours.
            let (count, colour_of): (_, fn(usize) -> Vec3) = match object.kind {
                Kind::Cloth | Kind::Particles => (&mut cloths, cloth_colour),
                Kind::Collider => (&mut colliders, collider_colour),
            };
            let own = colour_of(*count);
            *count += 1;
            if !style.shows(object.name) {
                continue;
            }
            let tint = style.tints.iter().find(|(name, _)| name == object.name);
            let colour = tint.map_or(own, |(_, tint)| Vec3::from(*tint));
            match object.kind {
                Kind::Cloth => mesh.add_cloth(object, colour, style.colouring),
                Kind::Collider => mesh.add_collider(object, colour),
                Kind::Particles => mesh.add_particles(object, colour, default_radius),
            }
        }
        mesh
    }

    /// Adds a cloth: one vertex per point, smooth everywhere.
    fn add_cloth(&mut self, object: &Object, colour: Vec3, colouring: Colouring) {
        let first = self.vertices.len() as u32;
        let normals = point_normals(object);
        let strain = match colouring {
            Colouring::Objects => None,
            Colouring::Strain { full_scale } => strain::of_points(object).map(|strain| (strain, full_scale)),
        };
        for (point, position) in object.positions.iter().enumerate() {
            let colour = match &strain {
                Some((strain, full_scale)) => strain::colour(strain[point] / full_scale),
                None => colour,
            };
            self.vertices.push(Vertex {
                position: Vec3::from(*position),
                normal: normals[point],
                colour,
                sky: [1.0; 2],
            });
        }
        for face in drawable_faces(object) {
            self.add_fan(face.len(), |corner| first + face[corner]);
        }
    }

    /// Adds a collider: one vertex per corner of a face, because a hard edge has two normals.
    fn add_collider(&mut self, object: &Object, colour: Vec3) {
        let normals = corner_normals(object);
        let mut corner_of_object = 0;
        for face in object.faces.iter() {
            let first = self.vertices.len() as u32;
            if is_drawable_face(object, face) {
                for (corner, point) in face.iter().enumerate() {
                    self.vertices.push(Vertex {
                        position: Vec3::from(object.positions[*point as usize]),
                        normal: normals[corner_of_object + corner],
                        colour,
                        sky: [1.0; 2],
                    });
                }
                self.add_fan(face.len(), |corner| first + corner as u32);
            }
            corner_of_object += face.len();
        }
    }

    fn add_particles(&mut self, object: &Object, colour: Vec3, default_radius: f32) {
        let radius = object.radius.filter(|radius| *radius > 0.0).unwrap_or(default_radius);
        let looks = object.looks.filter(|looks| looks.len() == object.positions.len());
        let plain = ParticleLook { radius: 1.0, opacity: 1.0, color: None, incandescence: [0.0; 3] };
        for (at, point) in object.positions.iter().enumerate().filter(|(_, point)| is_drawable(point)) {
            let look = looks.map_or(plain, |looks| looks[at]);
            self.spheres.push(Sphere {
                centre: Vec3::from(*point),
                radius: radius * look.radius,
                colour: look.color.map_or(colour, Vec3::from),
                glow: Vec3::from(look.incandescence),
                opacity: look.opacity,
            });
        }
    }

    fn add_fan(&mut self, corners: usize, vertex: impl Fn(usize) -> u32) {
        for k in 2..corners {
            let edges = [k == 2, true, k + 1 == corners];
            self.triangles.push(Triangle { corners: [vertex(0), vertex(k - 1), vertex(k)], edges });
        }
    }
}

/// The faces of which all points exist and can be drawn.
fn drawable_faces<'a>(object: &Object<'a>) -> impl Iterator<Item = &'a [u32]> {
    let object = *object;
    object.faces.iter().filter(move |face| is_drawable_face(&object, face))
}

fn is_drawable_face(object: &Object, face: &[u32]) -> bool {
    face.iter().all(|point| object.positions.get(*point as usize).is_some_and(is_drawable))
}

/// Colours of cloths and particles, distinguishable with most forms of colour blindness.
fn cloth_colour(index: usize) -> Vec3 {
    const COLOURS: [[f32; 3]; 6] = [
        [0.50, 0.085, 0.07], // madder
        [0.065, 0.21, 0.38], // indigo
        [0.66, 0.37, 0.07],  // ochre
        [0.07, 0.30, 0.22],  // verdigris
        [0.40, 0.18, 0.42],  // plum
        [0.30, 0.42, 0.12],  // moss
    ];
    Vec3::from(COLOURS[index % COLOURS.len()])
}

fn collider_colour(index: usize) -> Vec3 {
    const COLOURS: [[f32; 3]; 3] = [[0.46, 0.46, 0.45], [0.38, 0.41, 0.44], [0.50, 0.46, 0.40]];
    Vec3::from(COLOURS[index % COLOURS.len()])
}

/// A unit normal per point, weighted by the areas of its faces; +Y for a point without faces.
fn point_normals(object: &Object) -> Vec<Vec3> {
    let mut sums = vec![Vec3::zeros(); object.positions.len()];
    for face in drawable_faces(object) {
        let normal = area_vector(object, face);
        for point in face {
            sums[*point as usize] += normal;
        }
    }
    for seam in seams(object) {
        let sum = seam.iter().fold(Vec3::zeros(), |sum, &point| sum + sums[point as usize]);
        seam.iter().for_each(|&point| sums[point as usize] = sum);
    }
    sums.iter().map(unit).collect()
}

/// Distance in scene units up to which points that coincide at rest count as one, as Maya merges them.
const MERGE_DISTANCE: f32 = 1e-3;

/// Points of a tearable cloth that coincide at rest and still do, in groups: the seam between them is smooth.
fn seams(object: &Object) -> Vec<Vec<u32>> {
    let Some(rest) = object.rest else { return Vec::new() };
    let mut order: Vec<u32> = (0..rest.len() as u32).collect();
    let bits = |point: &u32| rest[*point as usize].map(f32::to_bits);
    order.sort_by_key(|point| (bits(point), *point));
    let mut seams = Vec::new();
    for twins in order.chunk_by(|a, b| bits(a) == bits(b)).filter(|twins| twins.len() > 1) {
        let mut left = twins.to_vec();
        while let Some(&first) = left.first() {
            let place = |point: u32| Vec3::from(object.positions[point as usize]);
            let is_near =
                |point: &u32| *point == first || (place(*point) - place(first)).norm() <= MERGE_DISTANCE;
            let (near, far): (Vec<u32>, Vec<u32>) = left.iter().partition(|point| is_near(point));
            left = far;
            if near.len() > 1 {
                seams.push(near);
            }
        }
    }
    seams
}

/// A unit normal per corner of a face, in order; the faces of a point share one unless they meet in a hard edge.
fn corner_normals(object: &Object) -> Vec<Vec3> {
    let areas: Vec<Vec3> = object
        .faces
        .iter()
        .map(|face| if is_drawable_face(object, face) { area_vector(object, face) } else { Vec3::zeros() })
        .collect();
    let around = faces_of_points(object);
    let mut normals = Vec::with_capacity(object.faces.corners().len());
    for (face, points) in object.faces.iter().enumerate() {
        let own = unit(&areas[face]);
        for point in points {
            let neighbours = around.get(*point as usize).map_or(&[][..], Vec::as_slice);
            let smooth = neighbours.iter().map(|other| areas[*other as usize]);
            let smooth = smooth.filter(|area| area.dot(&own) >= COS_HARD_EDGE * area.norm());
            normals.push(unit(&smooth.fold(Vec3::zeros(), |sum, area| sum + area)));
        }
    }
    normals
}

fn faces_of_points(object: &Object) -> Vec<Vec<u32>> {
    let mut around = vec![Vec::new(); object.positions.len()];
    for (face, points) in object.faces.iter().enumerate() {
        for point in points {
            if let Some(faces) = around.get_mut(*point as usize) {
                faces.push(face as u32);
            }
        }
    }
    around
}

/// The normal of a polygon with twice its area as length: Newell's sum, relative to the first point.
fn area_vector(object: &Object, face: &[u32]) -> Vec3 {
    let at = |corner: usize| Vec3::from(object.positions[face[corner] as usize]);
    (2..face.len()).fold(Vec3::zeros(), |sum, k| sum + (at(k - 1) - at(0)).cross(&(at(k) - at(0))))
}
