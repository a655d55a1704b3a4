//! A camera of USD with its motion.

use std::io::{Read, Seek};

use nucleus_cache::CameraView;

use crate::clip::{Clip, Extent};

use super::stage::{Attribute, Prim, Stage, Value};

const MILLIMETRES: f32 = 25.4;

/// Writes a camera. USD's focal length and apertures have one unit; only their ratios matter. `extent` is that of all
/// objects over the run.
pub(super) fn write_camera<R: Read + Seek>(
    clip: &Clip<R>,
    camera: usize,
    name: &str,
    extent: &Extent,
    stage: &mut impl Stage,
) {
    stage.begin(&Prim::of("Camera", name));
    let views: Vec<_> = (0..clip.samples().len()).map(|sample| clip.camera_view(camera, sample)).collect();
    let [across, upward] = views[0].film.map(|side| Value::Float(side * MILLIMETRES));
    stage.attribute(&Attribute::of("float", "horizontalAperture"), &across);
    stage.attribute(&Attribute::of("float", "verticalAperture"), &upward);
    let range = Value::Vec2(clipping_range(&views, extent));
    stage.attribute(&Attribute::of("float2", "clippingRange"), &range);
    let samples = clip.samples();
    stage.begin_samples(&Attribute::of("float", "focalLength"));
    for (sample, view) in samples.iter().zip(&views) {
        stage.sample(sample.frame_time, &Value::Float(view.focal_length));
    }
    stage.end_samples();
    stage.attribute(&Attribute::uniform("token[]", "xformOpOrder"), &Value::Tokens(&["xformOp:transform"]));
    stage.begin_samples(&Attribute::of("matrix4d", "xformOp:transform"));
    for (sample, view) in samples.iter().zip(&views) {
        stage.sample(sample.frame_time, &Value::Matrix(view.matrix()));
    }
    stage.end_samples();
    stage.end();
}

/// Distances of the near and the far plane, in exported units. USD's default, 1 to a million units, hides near objects
/// where a unit is a metre, so it is widened to suit the size of the run.
fn clipping_range(views: &[CameraView], extent: &Extent) -> [f32; 2] {
    let farthest = |view: &CameraView| {
        let offset = |axis: usize| extent.map(|corner| (corner[axis] - view.eye[axis]).abs());
        let [x, y, z] = [0, 1, 2].map(|axis| offset(axis)[0].max(offset(axis)[1]));
        x.hypot(y).hypot(z)
    };
    let (least, most) = views
        .iter()
        .map(farthest)
        .fold((f32::MAX, 0.0f32), |(least, most), distance| (least.min(distance), most.max(distance)));
    [(1e-3 * least).clamp(1e-6, 1.0), (10.0 * most).max(1e6)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clipping_range_suits_the_size_of_the_run() {
        let view = CameraView { eye: [0.0, 0.0, 5.0], ..CameraView::default() };
        let range = |size: f32| {
            let view = CameraView { eye: view.eye.map(|x| x * size), ..view };
            clipping_range(&[view], &[[-size, 0.0, -size], [size, size, size]])
        };
        let [near, far] = range(1.0);
        assert!(near > 0.005 && near < 0.01 && far == 1e6, "{near} to {far}, where a unit is a metre");
        assert_eq!(range(1000.0), [1.0, 1e6], "USD's default");
        assert!(range(1e6)[1] > 6e7);
    }
}
