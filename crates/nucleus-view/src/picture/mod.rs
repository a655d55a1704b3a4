//! Still pictures: a small rasteriser with a depth buffer, a shadow and a dome of soft light.

mod animation;
mod bounds;
mod camera;
mod depth_map;
mod film;
mod gif;
mod glyphs;
mod ground;
mod image;
mod legend;
mod light;
mod mesh;
mod normals;
mod object;
mod raster;
mod shade;
mod strain;
mod visible;

pub use animation::AnimationWriter;
pub use bounds::Bounds;
pub use camera::Camera;
pub use film::Film;
pub use gif::GifWriter;
pub use image::Image;
pub use object::{Colouring, Ground, Kind, Object, Style};

use camera::Lens;
use light::Light;
use mesh::Mesh;
use shade::Look;

/// A plain 3-vector: a point or direction in scene units, or a linear colour.
type Vec3 = nalgebra::Vector3<f32>;

/// Draws objects as one picture of `style.size` pixels.
///
/// Points that are not finite, and faces that name them or points that do not exist, are left out;
/// nothing in the input makes it fail.
pub fn draw(objects: &[Object], camera: &Camera, style: &Style) -> Image {
    let size = style.size.map(|side| side.clamp(1, Image::LARGEST_SIDE));
    let samples = style.samples.clamp(1, 4);
    let lens = Lens::new(camera, size.map(|side| side * samples));
    let mut mesh = Mesh::gather(objects, style, &lens);
    let light = Light::around(&mesh, &lens);
    mesh.open_to(&light);
    let visible = visible::find(&mesh, &lens);
    let floor = floor(objects, style.ground);
    let mut image =
        shade::picture(&mesh, &visible, &lens, &light, Look { floor, wireframe: style.wireframe, samples });
    if let Colouring::Strain { full_scale } = style.colouring {
        legend::draw(&mut image, full_scale);
    }
    image
}

/// The height of the floor, if there is one.
fn floor(objects: &[Object], ground: Ground) -> Option<f32> {
    let height = match ground {
        Ground::None => return None,
        Ground::At(height) => height,
        Ground::Below => {
            let mut all = Bounds::default();
            objects.iter().for_each(|object| all.include(object.positions));
            floor_below(&all, &Bounds::of_interest(objects))
        }
    };
    is_drawable(&[height; 3]).then_some(height)
}

/// A floor below all, unless that lies far below what is of interest: a collider may be a landscape.
fn floor_below(all: &Bounds, interest: &Bounds) -> f32 {
    if all.is_empty() || interest.is_empty() {
        return 0.0;
    }
    let extent = (0..3).map(|axis| interest.high[axis] - interest.low[axis]).fold(0.0, f32::max);
    all.low[1].max(interest.low[1] - 1.5 * extent)
}

/// Whether a point can be drawn at all: finite, and near enough that squares of it stay finite.
fn is_drawable(point: &[f32; 3]) -> bool {
    const MAX_COORDINATE: f32 = 1e9;
    point.iter().all(|x| x.abs() <= MAX_COORDINATE) // a NaN is not <= anything
}
