//! Where all points of a run were, frame by frame.

use nalgebra::Vector3;

/// Positions of all cloth of a run in metres: cloth after cloth, in the order of the meshes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trajectory {
    /// What positions are kept relative to, so that single precision loses nothing that matters.
    origin: [f64; 3],
    /// The points of a frame.
    points: usize,
    /// Frame after frame.
    rows: Vec<[f32; 3]>,
}

/// First bytes of a trajectory in a file: what it is, and in which layout.
const MAGIC: &[u8; 8] = b"nucltrj1";

impl Trajectory {
    /// Nothing yet, round some place.
    pub fn new(start: &[Vector3<f64>]) -> Self {
        let middle = start.iter().sum::<Vector3<f64>>() / start.len().max(1) as f64;
        Self { origin: middle.into(), points: start.len(), rows: Vec::new() }
    }

    /// Adds a frame.
    pub fn push(&mut self, points: &[Vector3<f64>]) {
        let origin = Vector3::from(self.origin);
        self.rows.extend(points.iter().map(|point| <[f64; 3]>::from(point - origin).map(|x| x as f32)));
    }

    /// The number of frames.
    pub fn frames(&self) -> usize {
        self.rows.len().checked_div(self.points).unwrap_or(0)
    }

    /// The number of points.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Replaces `out` by the positions in a frame, counted from nought.
    pub fn frame(&self, frame: usize, out: &mut Vec<Vector3<f64>>) {
        let origin = Vector3::from(self.origin);
        let rows = &self.rows[frame * self.points..(frame + 1) * self.points];
        out.clear();
        out.extend(rows.iter().map(|row| origin + Vector3::from(row.map(f64::from))));
    }

    /// As bytes for a file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let head = MAGIC.iter().copied();
        let origin = self.origin.iter().flat_map(|x| x.to_le_bytes());
        let points = (self.points as u64).to_le_bytes();
        let rows = self.rows.iter().flatten().flat_map(|x| x.to_le_bytes());
        head.chain(origin).chain(points).chain(rows).collect()
    }

    /// From bytes of a file; nothing if they are not those of a whole trajectory.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let bytes = bytes.strip_prefix(MAGIC)?;
        let (origin, bytes) = bytes.split_at_checked(24)?;
        let (points, bytes) = bytes.split_at_checked(8)?;
        let mut origin = origin.chunks_exact(8).map(|x| f64::from_le_bytes(x.try_into().unwrap_or_default()));
        let origin = std::array::from_fn(|_| origin.next().unwrap_or_default());
        let points = usize::try_from(u64::from_le_bytes(points.try_into().ok()?)).ok()?;
        let number = |x: &[u8]| f32::from_le_bytes(x.try_into().unwrap_or_default());
        let row = |row: &[u8]| [number(&row[0..4]), number(&row[4..8]), number(&row[8..12])];
        let whole = points > 0 && bytes.len() % points.checked_mul(12)? == 0;
        whole.then(|| Self { origin, points, rows: bytes.chunks_exact(12).map(row).collect() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_frames() -> Trajectory {
        let start = [Vector3::new(1e7, 2.0, 3.0), Vector3::new(1e7 + 1.0, 2.0, 3.0)];
        let mut path = Trajectory::new(&start);
        path.push(&start);
        path.push(&start.map(|point| point + Vector3::y() * 1e-6));
        path
    }

    #[test]
    fn a_thousandth_of_a_millimetre_is_seen_ten_thousand_kilometres_away() {
        let mut points = Vec::new();
        two_frames().frame(1, &mut points);
        assert!((points[1].y - 2.0 - 1e-6).abs() < 1e-9 && (points[1].x - 1e7 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn bytes_bring_back_all_of_it() {
        let path = two_frames();
        assert_eq!(Trajectory::from_bytes(&path.to_bytes()), Some(path.clone()));
        assert_eq!((path.frames(), path.points()), (2, 2));
    }

    #[test]
    fn a_file_cut_short_is_no_trajectory() {
        let bytes = two_frames().to_bytes();
        for length in [0, 4, 8, 20, 39, bytes.len() - 1, bytes.len() - 12] {
            assert_eq!(Trajectory::from_bytes(&bytes[..length]), None, "{length}");
        }
        assert_eq!(Trajectory::from_bytes(b"something else altogether, and long enough for a head"), None);
    }
}
