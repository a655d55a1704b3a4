//! All objects as one list of triangles that can be drawn without asking any more questions.

use super::camera::Lens;
use super::light::Light;
use super::object::{Colouring, Kind, Object, Style};
use super::{Vec3, is_drawable, normals, strain};

/// A corner of triangles: where it is and how it looks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    pub position: Vec3,
    pub normal: Vec3,
    /// Linear colour.
    pub colour: Vec3,
    /// How much of the sky is seen from the front and from the back, 0 to 1.
    pub open: [f32; 2],
}

/// Three vertices, and which of the sides (a-b, b-c, c-a) are edges of a face.
#[derive(Debug, Clone, Copy)]
pub(super) struct Triangle {
    pub corners: [u32; 3],
    pub edges: [bool; 3],
}

/// A particle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ball {
    pub centre: Vec3,
    /// In scene units.
    pub radius: f32,
    pub colour: Vec3,
}

/// Radius of particles that have none, as a share of the reach of the picture.
const SMALLEST: f32 = 0.008;

/// Everything that can be drawn.
#[derive(Debug, Default)]
pub(super) struct Mesh {
    pub vertices: Vec<Vertex>,
    pub triangles: Vec<Triangle>,
    pub balls: Vec<Ball>,
}

impl Mesh {
    /// Collects what can be drawn of the objects, in their order.
    pub fn gather(objects: &[Object], style: &Style, lens: &Lens) -> Self {
        let mut mesh = Self::default();
        let smallest = lens.reach() * SMALLEST;
        let (mut cloths, mut colliders) = (0, 0);
        for object in objects {
            match object.kind {
                Kind::Cloth => {
                    mesh.add_cloth(object, cloth_colour(cloths), style.colouring);
                    cloths += 1;
                }
                Kind::Collider => {
                    mesh.add_collider(object, collider_colour(colliders));
                    colliders += 1;
                }
                Kind::Particles => {
                    mesh.add_particles(object, cloth_colour(cloths), smallest);
                    cloths += 1;
                }
            }
        }
        mesh
    }

    /// Finds how much of the sky each vertex sees, on both sides.
    pub fn open_to(&mut self, light: &Light) {
        for vertex in &mut self.vertices {
            let (position, normal) = (vertex.position, vertex.normal);
            vertex.open = [normal, -normal].map(|side| light.openness(&position, &side));
        }
    }

    /// A cloth: one vertex per point, smooth everywhere.
    fn add_cloth(&mut self, object: &Object, colour: Vec3, colouring: Colouring) {
        let first = self.vertices.len() as u32;
        let normals = normals::of_points(object);
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
                open: [1.0; 2],
            });
        }
        for face in drawable_faces(object) {
            self.add_fan(face.len(), |corner| first + face[corner]);
        }
    }

    /// A collider: one vertex per corner of a face, so that a sharp edge can have two normals.
    fn add_collider(&mut self, object: &Object, colour: Vec3) {
        let normals = normals::of_corners(object);
        let mut corner_of_object = 0;
        for face in object.faces.iter() {
            let first = self.vertices.len() as u32;
            if is_drawable_face(object, face) {
                for (corner, point) in face.iter().enumerate() {
                    self.vertices.push(Vertex {
                        position: Vec3::from(object.positions[*point as usize]),
                        normal: normals[corner_of_object + corner],
                        colour,
                        open: [1.0; 2],
                    });
                }
                self.add_fan(face.len(), |corner| first + corner as u32);
            }
            corner_of_object += face.len();
        }
    }

    fn add_particles(&mut self, object: &Object, colour: Vec3, smallest: f32) {
        let radius = object.radius.filter(|radius| *radius > 0.0).unwrap_or(smallest);
        let drawable = object.positions.iter().filter(|point| is_drawable(point));
        self.balls.extend(drawable.map(|point| Ball { centre: Vec3::from(*point), radius, colour }));
    }

    fn add_fan(&mut self, corners: usize, vertex: impl Fn(usize) -> u32) {
        for k in 2..corners {
            let edges = [k == 2, true, k + 1 == corners];
            self.triangles.push(Triangle { corners: [vertex(0), vertex(k - 1), vertex(k)], edges });
        }
    }
}

/// The faces whose points all exist and can be drawn.
pub(super) fn drawable_faces<'a>(object: &Object<'a>) -> impl Iterator<Item = &'a [u32]> {
    let object = *object;
    object.faces.iter().filter(move |face| is_drawable_face(&object, face))
}

pub(super) fn is_drawable_face(object: &Object, face: &[u32]) -> bool {
    face.iter().all(|point| object.positions.get(*point as usize).is_some_and(is_drawable))
}

/// Matt colours that are told apart at a glance, also by most of the colour-blind.
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
