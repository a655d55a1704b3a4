//! The cameras of a scene, frame by frame.

use nalgebra::Vector3;

use crate::attributes::camera;
use crate::graph::{EvalContext, Graph, NodeId};
use crate::scene::document::TimeSpan;

/// A camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// Name of its node.
    pub name: String,
    /// Fit of an image whose aspect ratio differs from the film's.
    pub fit: FilmFit,
    /// Its view in each frame from the first on; one entry if it is constant.
    pub views: Vec<View>,
}

/// A camera at a frame. Lengths in scene units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Position of the eye.
    pub eye: Vector3<f64>,
    /// View direction, of unit length.
    pub forward: Vector3<f64>,
    /// Up direction of the image, of unit length.
    pub up: Vector3<f64>,
    /// Focal length in millimetres.
    pub focal_length: f64,
    /// Width and height of the film in inches.
    pub film: [f64; 2],
    /// Distance from the eye to the centre of interest.
    pub interest: f64,
}

/// The fit of an image to the film, by Maya's names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilmFit {
    /// Fits width or height, so that the film contains the image.
    Fill,
    /// Fits the width.
    Horizontal,
    /// Fits the height.
    Vertical,
    /// Fits width or height, so that the image contains the film.
    Overscan,
}

/// All cameras of a scene, in the order of their names.
pub(super) fn cameras(graph: &Graph, time: TimeSpan) -> Vec<Camera> {
    let mut nodes: Vec<NodeId> = graph.of_type(&camera::CAMERA).map(|(id, _)| id).collect();
    nodes.sort_by_key(|&id| graph.node(id).name());
    nodes.into_iter().map(|node| camera(graph, time, node)).collect()
}

fn camera(graph: &Graph, time: TimeSpan, node: NodeId) -> Camera {
    let at = |frame: i64| view(&graph.at(frame as f64), node);
    let mut views: Vec<View> = (time.start..=time.end.max(time.start)).map(at).collect();
    if views.iter().all(|view| *view == views[0]) {
        views.truncate(1);
    }
    let fit = match graph.at(time.start as f64).get(node, &camera::FILM_FIT).0 {
        1 => FilmFit::Horizontal,
        2 => FilmFit::Vertical,
        3 => FilmFit::Overscan,
        _ => FilmFit::Fill,
    };
    Camera { name: graph.node(node).name().to_owned(), fit, views }
}

fn view(moment: &EvalContext, node: NodeId) -> View {
    let placement = moment.placement(node);
    let along = |axis: Vector3<f64>| (placement.linear * axis).try_normalize(0.0).unwrap_or(axis);
    View {
        eye: placement.offset,
        forward: along(-Vector3::z()),
        up: along(Vector3::y()),
        focal_length: moment.get(node, &camera::FOCAL_LENGTH),
        film: [&camera::HORIZONTAL_FILM_APERTURE, &camera::VERTICAL_FILM_APERTURE]
            .map(|key| moment.get(node, key)),
        interest: moment.get(node, &camera::CENTER_OF_INTEREST),
    }
}
