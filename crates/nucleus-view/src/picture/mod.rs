//! Still pictures and animations: a software rasteriser with a depth buffer, shadow maps and a sky light.

mod animation;
mod camera;
mod draw;
mod film;
mod floor;
mod image;
mod light;
mod mesh;
mod raster;
mod scene;
mod shadow_map;
mod strain;
mod text;
mod visibility;

pub use animation::{AnimationWriter, GifWriter};
pub use camera::Camera;
pub use draw::draw;
pub use film::Film;
pub use image::Image;
pub use scene::{Background, Bounds, Colouring, Ground, Kind, Object, Style};
