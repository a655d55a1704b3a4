//! The stages of one picture: geometry, lights, visibility, shading, legend.

use super::camera::{Camera, View};
use super::floor::{Floor, FloorPlane};
use super::image::Image;
use super::light::{Light, diffuse, fill, smoothstep};
use super::mesh::Mesh;
use super::scene::{Background, Bounds, Colouring, Ground, Object, Style, Vec3, is_drawable, unit};
use super::strain;
use super::visibility::{self, Fragment};

/// Draws objects as one picture of `style.size` pixels.
///
/// Points that are not finite are left out, and so are faces with such points or with points that do not exist. No input
/// makes it fail.
pub fn draw(objects: &[Object], camera: &Camera, style: &Style) -> Image {
    draw_with(&mut Vec::new(), objects, camera, style)
}

/// Draws a picture with the visibility buffer of the one before.
pub(super) fn draw_with(
    fragments: &mut Vec<Fragment>,
    objects: &[Object],
    camera: &Camera,
    style: &Style,
) -> Image {
    let size = style.size.map(|side| side.clamp(1, Image::LARGEST_SIDE));
    let samples = style.samples.clamp(1, 8);
    let view = View::new(camera, size.map(|side| side * samples));
    let mut mesh = Mesh::gather(objects, style, &view);
    let light = Light::of(&mesh, &view);
    light.find_sky_visibility(&mut mesh);
    visibility::draw(&mesh, &view, fragments);
    let is_transparent = style.background == Background::Transparent;
    // Seen from below, a floor would hide the scene.
    let is_seen = |plane: &FloorPlane| !is_transparent && plane.height_of(&view.eye) >= 0.0;
    let floor = floor_plane(objects, style.ground).filter(is_seen);
    let options = Options {
        floor,
        wireframe: style.wireframe,
        samples,
        background: style.background,
        keeps_linear: style.keeps_linear,
    };
    let mut image = shade(&mesh, fragments, &view, &light, options);
    if let Colouring::Strain { full_scale } = style.colouring {
        strain::draw_legend(&mut image, full_scale);
    }
    image
}

/// The plane of the floor, if there is one.
fn floor_plane(objects: &[Object], ground: Ground) -> Option<FloorPlane> {
    let plane = match ground {
        Ground::None => return None,
        Ground::At(height) => FloorPlane::level(height),
        Ground::Plane { origin, normal } => is_drawable(&normal)
            .then(|| FloorPlane { origin: origin.into(), normal: unit(&normal.into()) })?,
        Ground::Below => {
            let mut all = Bounds::default();
            objects.iter().for_each(|object| all.include_object(object));
            FloorPlane::level(all.floor_below(&Bounds::to_frame(objects), &Bounds::of_interest(objects)))
        }
    };
    is_drawable(&plane.origin.into()).then_some(plane)
}

const BACKGROUND_TOP: [f32; 3] = [0.80, 0.82, 0.84];
const BACKGROUND_BOTTOM: [f32; 3] = [0.66, 0.665, 0.67];

/// Factor on the colour of the back of a cloth, which distinguishes folds from creases.
const BACK: f32 = 0.72;

/// Options of the shading.
#[derive(Debug, Clone, Copy)]
struct Options {
    floor: Option<FloorPlane>,
    wireframe: bool,
    /// Samples along each side of a pixel.
    samples: u32,
    background: Background,
    /// Whether the picture keeps its linear colours.
    keeps_linear: bool,
}

/// Shades the surfaces of every pixel.
fn shade(mesh: &Mesh, fragments: &[Fragment], view: &View, light: &Light, options: Options) -> Image {
    let samples = options.samples;
    let shader = Shader {
        mesh,
        view,
        light,
        key: Light::key_direction(view),
        floor: options.floor.map(|plane| Floor::new(plane, view, light)),
        background: options.background,
        samples,
        // A line has the same width in pixels for any number of samples.
        line_width: if options.wireframe { 0.55 * samples as f32 } else { 0.0 },
    };
    let [width, height] = view.size.map(|side| side / samples);
    let mut image = Image::new(width, height);
    let has_alpha = options.background == Background::Transparent;
    let pixel = |column: u32, row: u32| shader.pixel(fragments, [column, row]);
    image.fill_rows(has_alpha, options.keeps_linear, pixel);
    image
}

/// What a pixel shows: each surface with the samples that it covers.
struct Surfaces {
    found: [Surface; 64],
    count: usize,
}

#[derive(Clone, Copy)]
struct Surface {
    /// The primitive; of the floor and the background, one beyond all.
    key: u32,
    covered: u32,
    /// Its sample nearest to the centre of the pixel, and twice the distance of that.
    sample: u32,
    distance: u32,
}

impl Surfaces {
    fn new() -> Self {
        Self { found: [Surface { key: 0, covered: 0, sample: 0, distance: 0 }; 64], count: 0 }
    }

    fn add(&mut self, key: u32, sample: u32, distance: u32) {
        match self.found[..self.count].iter_mut().find(|surface| surface.key == key) {
            Some(surface) => {
                surface.covered += 1;
                if distance < surface.distance {
                    (surface.sample, surface.distance) = (sample, distance);
                }
            }
            None => {
                self.found[self.count] = Surface { key, covered: 1, sample, distance };
                self.count += 1;
            }
        }
    }
}

struct Shader<'a> {
    mesh: &'a Mesh,
    view: &'a View,
    light: &'a Light,
    /// Direction to the key light.
    key: Vec3,
    floor: Option<Floor>,
    background: Background,
    /// Samples along each side of a pixel.
    samples: u32,
    /// Width of a wireframe line on each side of an edge, in samples.
    line_width: f32,
}

/// A point of a surface, on the side that faces the eye.
struct SurfacePoint {
    position: Vec3,
    normal: Vec3,
    colour: Vec3,
    /// Visible fraction of the sky.
    sky: f32,
    /// Light that it gives off.
    glow: Vec3,
}

impl Shader<'_> {
    /// The linear colour of a pixel, and its opacity. Visibility is found per sample; each primitive is shaded once, and
    /// weighs as many samples as it covers (multisampling, Akeley 1993). With lines every sample is shaded.
    fn pixel(&self, fragments: &[Fragment], [column, row]: [u32; 2]) -> (Vec3, f32) {
        let n = self.samples;
        let at = |sample: u32| [column * n + sample % n, row * n + sample / n];
        let fragment = |[x, y]: [u32; 2]| &fragments[(y * self.view.size[0] + x) as usize];
        if (0..n * n).all(|sample| fragment(at(sample)).inverse_depth == 0.0) {
            let centre = (n - 1) / 2;
            return self.floor_or_background([column * n + centre, row * n + centre]);
        }
        let mut surfaces = Surfaces::new();
        for sample in 0..n * n {
            let place = at(sample);
            let fragment = fragment(place);
            let is_surface = fragment.inverse_depth > 0.0 && !self.is_under_floor(fragment, place);
            let key = match is_surface {
                true if self.line_width > 0.0 => sample,
                true => fragment.primitive,
                false => u32::MAX,
            };
            let from_centre = |place: u32| (2 * place + 1).abs_diff(n);
            surfaces.add(key, sample, from_centre(sample % n).pow(2) + from_centre(sample / n).pow(2));
        }
        let (mut sum, mut covered) = (Vec3::zeros(), 0.0);
        for surface in &surfaces.found[..surfaces.count] {
            let place = at(surface.sample);
            let (colour, opacity) = match surface.key {
                u32::MAX => self.floor_or_background(place),
                _ => (self.surface_colour(fragment(place), place), 1.0),
            };
            let weight = opacity * surface.covered as f32;
            sum += colour * weight;
            covered += weight;
        }
        // Colours are not multiplied by opacity, as PNG demands.
        let colour = if covered > 0.0 { sum / covered } else { sum };
        (colour, covered / (n * n) as f32)
    }

    fn ray(&self, [x, y]: [u32; 2]) -> Vec3 {
        self.view.ray([x as f32 + 0.5, y as f32 + 0.5])
    }

    fn surface_colour(&self, fragment: &Fragment, place: [u32; 2]) -> Vec3 {
        let ray = self.ray(place);
        let position = self.view.eye + ray / fragment.inverse_depth;
        self.shade_surface(&self.surface_point(fragment, &position, &ray), &ray)
    }

    fn floor_or_background(&self, place: [u32; 2]) -> (Vec3, f32) {
        let Some(background) = self.background(place[1]) else { return (Vec3::zeros(), 0.0) };
        let ray = self.ray(place);
        let shaded = |floor: &Floor| floor.shade(self.view, &ray, self.samples as f32, self.light);
        let floor = self.floor.as_ref().and_then(shaded);
        (floor.map_or(background, |(colour, opacity)| background.lerp(&colour, opacity)), 1.0)
    }

    /// Whether the floor hides what a sample shows from the eye.
    fn is_under_floor(&self, fragment: &Fragment, place: [u32; 2]) -> bool {
        let slack = self.view.distance * 1e-3;
        self.floor.as_ref().is_some_and(|floor| {
            let point = self.view.eye + self.ray(place) / fragment.inverse_depth;
            floor.hides(&point, slack)
        })
    }

    fn background(&self, row: u32) -> Option<Vec3> {
        let down = row as f32 / self.view.size[1] as f32;
        match self.background {
            Background::Studio => {
                let [top, bottom] = [BACKGROUND_TOP, BACKGROUND_BOTTOM].map(Vec3::from);
                Some(top.lerp(&bottom, smoothstep(0.0, 1.0, down)))
            }
            Background::Colour(colour) => Some(Vec3::from(colour)),
            Background::Transparent => None,
        }
    }

    fn shade_surface(&self, point: &SurfacePoint, ray: &Vec3) -> Vec3 {
        let key = self.light.key_visibility(&point.position, &point.normal);
        let cosine = unit(ray).dot(&point.normal).abs().min(1.0);
        let colour = diffuse(&point.colour, &point.normal, key, point.sky, &self.key)
            + fill(&point.colour, cosine, point.sky);
        // Fibres scatter light at grazing angles: the sheen of woven cloth.
        let grazing = 1.0 - cosine;
        let sheen = grazing * grazing * grazing * (0.25 + 0.75 * key) * point.sky;
        colour + (point.colour * 0.5 + Vec3::repeat(0.05)) * sheen * 0.5 + point.glow
    }

    fn surface_point(&self, fragment: &Fragment, position: &Vec3, ray: &Vec3) -> SurfacePoint {
        match self.mesh.triangles.get(fragment.primitive as usize) {
            Some(_) => self.triangle_point(fragment, position, ray),
            None => self.sphere_point(fragment, position),
        }
    }

    fn triangle_point(&self, fragment: &Fragment, position: &Vec3, ray: &Vec3) -> SurfacePoint {
        let triangle = &self.mesh.triangles[fragment.primitive as usize];
        let [a, b, c] = triangle.corners.map(|corner| &self.mesh.vertices[corner as usize]);
        let [wb, wc] = fragment.local;
        let wa = 1.0 - wb - wc;
        let normal = unit(&(a.normal * wa + b.normal * wb + c.normal * wc));
        // The flat triangle decides the side: near a silhouette the smooth normal may face away.
        let flat = (b.position - a.position).cross(&(c.position - a.position));
        let side = if flat.dot(ray) > 0.0 { 1 } else { 0 };
        let colour = a.colour * wa + b.colour * wb + c.colour * wc;
        let tone =
            [1.0, BACK][side] * self.line_tone(fragment, triangle.edges, [a, b, c].map(|v| &v.position));
        SurfacePoint {
            position: *position,
            normal: normal * [1.0, -1.0][side],
            colour: colour * tone,
            sky: a.sky[side] * wa + b.sky[side] * wb + c.sky[side] * wc,
            glow: Vec3::zeros(),
        }
    }

    /// The factor on the colour near an edge of a face: below 1 if edges are drawn.
    fn line_tone(&self, fragment: &Fragment, edges: [bool; 3], corners: [&Vec3; 3]) -> f32 {
        if self.line_width == 0.0 {
            return 1.0;
        }
        let [wb, wc] = fragment.local;
        let weights = [wc, 1.0 - wb - wc, wb]; // of the corner opposite to each side
        let samples_per_length = self.view.scale * fragment.inverse_depth;
        let double_area = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm();
        let nearest = (0..3).filter(|side| edges[*side]).fold(f32::INFINITY, |nearest, side| {
            let length = (corners[(side + 1) % 3] - corners[side]).norm();
            nearest.min(weights[side] * double_area / length * samples_per_length)
        });
        0.45 + 0.55 * smoothstep(0.5, 1.5, nearest / self.line_width)
    }

    fn sphere_point(&self, fragment: &Fragment, position: &Vec3) -> SurfacePoint {
        let [across, upward] = fragment.local;
        let toward = (1.0 - across * across - upward * upward).max(0.0).sqrt();
        let view = self.view;
        let normal = view.right * across + view.up * upward - view.forward * toward;
        let first_sphere = self.mesh.triangles.len();
        let sphere = &self.mesh.spheres[fragment.primitive as usize - first_sphere];
        let sky = 0.5 + 0.5 * normal.y;
        SurfacePoint { position: *position, normal, colour: sphere.colour, sky, glow: sphere.glow }
    }
}

#[cfg(test)]
mod tests {
    use nucleus_core::Faces;

    use super::*;
    use crate::picture::scene::Kind;

    #[test]
    fn balls_lie_on_the_floor_below_them() {
        let (faces, positions) = (Faces::default(), [[0.0, 5.0, 0.0], [1.0, 6.0, 0.0]]);
        let balls = Object {
            name: "balls",
            kind: Kind::Particles,
            faces: &faces,
            positions: &positions,
            rest: None,
            radius: Some(0.25),
            looks: None,
        };
        let height = |ball| floor_plane(&[ball], Ground::Below).map(|plane| plane.origin.y);
        assert_eq!(height(balls), Some(4.75));
        assert_eq!(height(Object { radius: None, ..balls }), Some(5.0));
    }
}
