//! From what is seen to a colour: matt surfaces in a key light, the sky and what the floor throws back.

use super::Vec3;
use super::camera::Lens;
use super::ground::Ground;
use super::image::Image;
use super::light::Light;
use super::mesh::Mesh;
use super::normals::unit;
use super::visible::Sample;

const KEY: [f32; 3] = [0.98, 0.94, 0.88];
const SKY: [f32; 3] = [0.36, 0.39, 0.43];
const BOUNCE: [f32; 3] = [0.13, 0.125, 0.115];
const BACKGROUND_TOP: [f32; 3] = [0.80, 0.82, 0.84];
const BACKGROUND_BOTTOM: [f32; 3] = [0.66, 0.665, 0.67];

/// The back of a cloth is a little darker, so that a fold is told from a crease.
const BACK: f32 = 0.72;

/// What a style asks of the shading.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    /// Height of the floor.
    pub floor: Option<f32>,
    pub wireframe: bool,
    /// Samples along each side of a pixel.
    pub samples: u32,
}

/// Shades every sample and blends the samples of each pixel.
pub(super) fn picture(mesh: &Mesh, visible: &[Sample], lens: &Lens, light: &Light, look: Look) -> Image {
    let samples = look.samples;
    let scene = Scene {
        mesh,
        lens,
        light,
        key: Light::key_direction(lens),
        ground: look.floor.map(|height| Ground::new(height, lens, light)),
        // A line is as wide in every picture, however many samples a pixel has.
        line_width: if look.wireframe { 0.55 * samples as f32 } else { 0.0 },
    };
    let [width, height] = lens.size.map(|side| side / samples);
    let mut image = Image::new(width, height);
    image.fill_rows(|column, row| {
        let mut sum = Vec3::zeros();
        for sample in 0..samples * samples {
            let x = column * samples + sample % samples;
            let y = row * samples + sample / samples;
            sum += scene.colour(&visible[(y * lens.size[0] + x) as usize], [x, y]);
        }
        sum / (samples * samples) as f32
    });
    image
}

/// Light that a matt surface throws back: `key` and `open` are the shares of the key light and
/// of the sky that reach it.
pub(super) fn matt(colour: &Vec3, normal: &Vec3, key: f32, open: f32, key_direction: &Vec3) -> Vec3 {
    let facing = normal.dot(key_direction).max(0.0) * key;
    let from_below = (0.5 - 0.5 * normal.y) * (0.35 + 0.65 * open);
    let light = Vec3::from(KEY) * facing
        + Vec3::from(SKY) * (open * (0.35 + 0.65 * open))
        + Vec3::from(BOUNCE) * from_below;
    colour.component_mul(&light)
}

/// 0 below `low`, 1 above `high`, smooth between.
pub(super) fn ramp(low: f32, high: f32, x: f32) -> f32 {
    let share = ((x - low) / (high - low)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

struct Scene<'a> {
    mesh: &'a Mesh,
    lens: &'a Lens,
    light: &'a Light,
    /// Toward the key light.
    key: Vec3,
    ground: Option<Ground>,
    /// Width of a line of the wireframe on each side of an edge, in samples.
    line_width: f32,
}

/// A piece of surface, seen from the side that faces the eye.
struct Patch {
    position: Vec3,
    normal: Vec3,
    colour: Vec3,
    open: f32,
}

impl Scene<'_> {
    fn colour(&self, sample: &Sample, [x, y]: [u32; 2]) -> Vec3 {
        let ray = self.lens.ray([x as f32 + 0.5, y as f32 + 0.5]);
        let surface =
            if sample.nearness > 0.0 { self.lens.eye + ray / sample.nearness } else { self.lens.eye };
        if sample.nearness > 0.0 && !self.is_under_floor(&surface) {
            return self.lit(&self.patch(sample, &surface, &ray), &ray);
        }
        let background = self.background(y);
        let floor = self.ground.as_ref().and_then(|ground| ground.seen(self.lens, &ray, self.light));
        floor.map_or(background, |(colour, solid)| background.lerp(&colour, solid))
    }

    /// Whether the floor hides a point from the eye.
    fn is_under_floor(&self, point: &Vec3) -> bool {
        let slack = self.lens.distance * 1e-3;
        self.ground.as_ref().is_some_and(|ground| ground.hides(self.lens, point, slack))
    }

    fn background(&self, row: u32) -> Vec3 {
        let down = row as f32 / self.lens.size[1] as f32;
        Vec3::from(BACKGROUND_TOP).lerp(&Vec3::from(BACKGROUND_BOTTOM), ramp(0.0, 1.0, down))
    }

    fn lit(&self, patch: &Patch, ray: &Vec3) -> Vec3 {
        let key = self.light.key_reaches(&patch.position, &patch.normal);
        let colour = matt(&patch.colour, &patch.normal, key, patch.open, &self.key);
        // Fibres that stand off the surface catch light at grazing angles: the sheen of woven cloth.
        let grazing = 1.0 - unit(ray).dot(&patch.normal).abs().min(1.0);
        let sheen = grazing * grazing * grazing * (0.25 + 0.75 * key) * patch.open;
        colour + (patch.colour * 0.5 + Vec3::repeat(0.05)) * sheen * 0.5
    }

    fn patch(&self, sample: &Sample, position: &Vec3, ray: &Vec3) -> Patch {
        match self.mesh.triangles.get(sample.thing as usize) {
            Some(_) => self.triangle_patch(sample, position, ray),
            None => self.ball_patch(sample, position),
        }
    }

    fn triangle_patch(&self, sample: &Sample, position: &Vec3, ray: &Vec3) -> Patch {
        let triangle = &self.mesh.triangles[sample.thing as usize];
        let [a, b, c] = triangle.corners.map(|corner| &self.mesh.vertices[corner as usize]);
        let [wb, wc] = sample.at;
        let wa = 1.0 - wb - wc;
        let normal = unit(&(a.normal * wa + b.normal * wb + c.normal * wc));
        // The flat triangle tells the side: a smooth normal may already lean over a silhouette.
        let flat = (b.position - a.position).cross(&(c.position - a.position));
        let side = if flat.dot(ray) > 0.0 { 1 } else { 0 };
        let colour = a.colour * wa + b.colour * wb + c.colour * wc;
        let tone = [1.0, BACK][side] * self.line_tone(sample, triangle.edges, [a, b, c].map(|v| &v.position));
        Patch {
            position: *position,
            normal: normal * [1.0, -1.0][side],
            colour: colour * tone,
            open: a.open[side] * wa + b.open[side] * wb + c.open[side] * wc,
        }
    }

    /// Darker near an edge of a face, if edges are drawn.
    fn line_tone(&self, sample: &Sample, edges: [bool; 3], corners: [&Vec3; 3]) -> f32 {
        if self.line_width == 0.0 {
            return 1.0;
        }
        let [wb, wc] = sample.at;
        let weights = [wc, 1.0 - wb - wc, wb]; // of the corner opposite to each side
        let samples_per_length = self.lens.scale * sample.nearness;
        let double_area = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm();
        let nearest = (0..3).filter(|side| edges[*side]).fold(f32::INFINITY, |nearest, side| {
            let length = (corners[(side + 1) % 3] - corners[side]).norm();
            nearest.min(weights[side] * double_area / length * samples_per_length)
        });
        0.45 + 0.55 * ramp(0.5, 1.5, nearest / self.line_width)
    }

    fn ball_patch(&self, sample: &Sample, position: &Vec3) -> Patch {
        let [across, upward] = sample.at;
        let toward = (1.0 - across * across - upward * upward).max(0.0).sqrt();
        let lens = self.lens;
        let normal = lens.right * across + lens.up * upward - lens.forward * toward;
        let first_ball = self.mesh.triangles.len();
        let colour = self.mesh.balls[sample.thing as usize - first_ball].colour;
        Patch { position: *position, normal, colour, open: 0.5 + 0.5 * normal.y }
    }
}
