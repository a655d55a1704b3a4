//! Cameras: where a run is seen from.

use super::Choice;
use super::key::{choice, float};
use super::table::node_table;
use super::transform::TRANSFORM;

node_table! {
    /// An eye with a lens: it looks along its own -z, with its y up. Such a node stands for its transform and its shape.
    CAMERA = "camera", inherits Some(&TRANSFORM), hides [];
    "Camera Attributes" {
        /// Focal length: the longer, the narrower the view.
        FOCAL_LENGTH: f64 = float("focalLength", "fl", 35.0).min(2.5).max(100000.0).unit("mm").solved("nucleus_graph::compile");
        /// How far before the eye is what one looks at. The player turns about it.
        CENTER_OF_INTEREST: f64 = float("centerOfInterest", "coi", 5.0).min(1e-6).max(1e12).unit("scene units").solved("nucleus_graph::compile");
    }
    "Film Back" {
        /// Width of the film.
        HORIZONTAL_FILM_APERTURE: f64 = float("horizontalFilmAperture", "hfa", 1.41732).min(0.001).max(1e6).unit("inches").solved("nucleus_graph::compile");
        /// Height of the film.
        VERTICAL_FILM_APERTURE: f64 = float("verticalFilmAperture", "vfa", 0.94488).min(0.001).max(1e6).unit("inches").solved("nucleus_graph::compile");
        /// How a picture of another shape than the film is laid on it: inside it, by its width, by its height, or round it.
        FILM_FIT: Choice = choice("filmFit", "ff", 0, &[(0, "Fill"), (1, "Horizontal"), (2, "Vertical"), (3, "Overscan")]).solved("nucleus_graph::compile").fixed();
    }
}
