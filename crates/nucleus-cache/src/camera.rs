//! The cameras of a run, stored as metadata: their motion is known before the run begins.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::str::FromStr;

/// A camera of the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// Its name.
    pub name: String,
    /// How the film gate fits a picture of another aspect ratio.
    pub fit: FilmFit,
    /// One view per frame from the start frame on, at least one. The last view holds for all later frames.
    pub views: Vec<CameraView>,
}

/// A camera at one frame. Lengths are in scene units unless stated otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CameraView {
    /// Eye position.
    pub eye: [f32; 3],
    /// View direction, of unit length.
    pub forward: [f32; 3],
    /// Up direction of the picture, of unit length.
    pub up: [f32; 3],
    /// Focal length in millimetres.
    pub focal_length: f32,
    /// Width and height of the film in inches.
    pub film: [f32; 2],
    /// Distance from the eye to the centre of interest.
    pub interest: f32,
}

/// How the picture is fitted to the film gate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FilmFit {
    /// The picture lies inside the film gate and is as large as possible.
    #[default]
    Fill,
    /// The picture has the width of the film gate.
    Horizontal,
    /// The picture has the height of the film gate.
    Vertical,
    /// The picture contains the film gate and is as small as possible.
    Overscan,
}

const FITS: [(FilmFit, &str); 4] = [
    (FilmFit::Fill, "fill"),
    (FilmFit::Horizontal, "horizontal"),
    (FilmFit::Vertical, "vertical"),
    (FilmFit::Overscan, "overscan"),
];
/// Prefix of a metadata key; the name of the camera follows.
const KEY: &str = "camera ";
/// Numbers in a stored view.
const NUMBERS: usize = 13;

impl Camera {
    /// The view at `frame` of a run that starts at `start`.
    pub fn at(&self, frame: i32, start: i32) -> Option<&CameraView> {
        let place = usize::try_from(i64::from(frame) - i64::from(start)).unwrap_or_default();
        self.views.get(place).or(self.views.last())
    }
}

impl CameraView {
    /// Linear interpolation from one view to the other; `share` is 0 at `from` and 1 at `to`.
    pub fn between(from: &Self, to: &Self, share: f32) -> Self {
        let (a, b) = (from.numbers(), to.numbers());
        Self::of(std::array::from_fn(|k| a[k] + (b[k] - a[k]) * share))
    }

    fn numbers(&self) -> [f32; NUMBERS] {
        let Self { eye: [a, b, c], forward: [d, e, f], up: [g, h, i], focal_length, film: [w, v], interest } =
            *self;
        [a, b, c, d, e, f, g, h, i, focal_length, w, v, interest]
    }

    fn of([a, b, c, d, e, f, g, h, i, focal_length, w, v, interest]: [f32; NUMBERS]) -> Self {
        let (eye, forward, up) = ([a, b, c], [d, e, f], [g, h, i]);
        Self { eye, forward, up, focal_length, film: [w, v], interest }
    }

    /// The placement of the camera as a matrix whose rows are its x, y and z axis and its eye; it looks along -z.
    pub fn matrix(&self) -> [[f64; 4]; 4] {
        let [forward, up, eye] = [self.forward, self.up, self.eye].map(|v| v.map(f64::from));
        let back = forward.map(|x| -x);
        let cross = |a: [f64; 3], b: [f64; 3]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let row = |[x, y, z]: [f64; 3], w: f64| [x, y, z, w];
        [row(cross(up, back), 0.0), row(up, 0.0), row(back, 0.0), row(eye, 1.0)]
    }

    /// Tangents of half the horizontal and vertical angles of view. `aspect` is the width of the picture over its
    /// height.
    pub fn tangents(&self, fit: FilmFit, aspect: f32) -> [f32; 2] {
        let [across, upward] = self.film.map(|side| 0.5 * 25.4 * side / self.focal_length);
        let is_wider = aspect > across / upward;
        let by_width = match fit {
            FilmFit::Horizontal => true,
            FilmFit::Vertical => false,
            FilmFit::Fill => is_wider,
            FilmFit::Overscan => !is_wider,
        };
        if by_width { [across, across / aspect] } else { [upward * aspect, upward] }
    }
}

/// Cameras as keys and values of a metadata record: the fit in the first line, one view in each line that follows.
pub(crate) fn to_keys(cameras: &[Camera]) -> BTreeMap<String, String> {
    let text = |camera: &Camera| {
        let fit = FITS.iter().find(|(fit, _)| *fit == camera.fit).map_or("fill", |(_, word)| word);
        let mut text = fit.to_owned();
        for view in &camera.views {
            text.push('\n');
            let words = view.numbers().map(|number| number.to_string());
            let _ = write!(text, "{}", words.join(" "));
        }
        text
    };
    cameras.iter().map(|camera| (format!("{KEY}{}", camera.name), text(camera))).collect()
}

/// Cameras from such keys; malformed entries are left out.
pub(crate) fn from_keys(keys: &BTreeMap<String, String>) -> Vec<Camera> {
    let camera = |(key, text): (&String, &String)| {
        let mut lines = text.lines();
        let word = lines.next()?;
        let fit = FITS.iter().find(|(_, known)| *known == word)?.0;
        let views: Vec<CameraView> = lines.map(view).collect::<Option<_>>()?;
        let name = key.strip_prefix(KEY)?.to_owned();
        (!views.is_empty()).then_some(Camera { name, fit, views })
    };
    keys.iter().filter_map(camera).collect()
}

fn view(line: &str) -> Option<CameraView> {
    let number = |word: &str| f32::from_str(word).ok().filter(|x| x.is_finite());
    let numbers: Vec<f32> = line.split(' ').map(number).collect::<Option<_>>()?;
    Some(CameraView::of(numbers.try_into().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view_at(x: f32) -> CameraView {
        let (eye, forward, up) = ([x, 0.1, 5.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
        CameraView { eye, forward, up, focal_length: 35.0, film: [1.41732, 0.94488], interest: 5.0 }
    }

    #[test]
    fn cameras_come_back_as_they_were() {
        let views = vec![view_at(1e-7), view_at(-3.5e9)];
        let camera = |name: &str, fit| Camera { name: name.to_owned(), fit, views: views.clone() };
        let cameras = [camera("crc32", FilmFit::Overscan), camera("shot 1", FilmFit::Fill)];
        assert_eq!(from_keys(&to_keys(&cameras)), cameras);
        assert_eq!(cameras[0].at(11, 10), Some(&views[1]));
        assert_eq!((cameras[0].at(9, 10), cameras[0].at(99, 10)), (Some(&views[0]), Some(&views[1])));
    }

    #[test]
    fn malformed_cameras_are_left_out() {
        for text in ["", "fill", "full\n1 2 3", "fill\n1 2 3", "fill\nNaN 0 0 0 0 0 0 0 0 0 0 0 0"] {
            assert_eq!(from_keys(&BTreeMap::from([("camera a".to_owned(), text.to_owned())])), [], "{text}");
        }
    }

    #[test]
    fn angles_of_view_follow_the_film_fit() {
        let tangents = |fit, aspect| view_at(0.0).tangents(fit, aspect).map(|x| (1e3 * x).round());
        let [across, upward] = [18.0 / 35.0, 12.0 / 35.0].map(|x: f32| (1e3 * x).round());
        // A wide picture uses the whole width of the film; with overscan it uses the whole height.
        assert_eq!(tangents(FilmFit::Fill, 2.0), [across, 257.0]);
        assert_eq!(tangents(FilmFit::Overscan, 2.0), [686.0, upward]);
        assert_eq!(tangents(FilmFit::Fill, 1.0), [upward, upward]);
        assert_eq!(tangents(FilmFit::Horizontal, 1.0), [across, across]);
        assert_eq!(tangents(FilmFit::Vertical, 2.0)[1], upward);
    }
}
