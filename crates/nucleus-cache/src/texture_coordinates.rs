//! Texture coordinates of meshes, stored as metadata: they belong to the first mesh of an object and never change.

use std::collections::BTreeMap;

/// Texture coordinates of a mesh.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TextureCoordinates {
    /// The coordinates u and v, 0 to 1 within the picture.
    pub values: Vec<[f32; 2]>,
    /// For each corner of a face the index of its value, where a mesh has seams; empty where each point has one value, in
    /// the order of the points.
    pub corners: Vec<u32>,
}

/// Prefix of a metadata key; the name of the object follows.
const KEY: &str = "uv ";

impl TextureCoordinates {
    /// Whether they fit a mesh of this many points and corners.
    pub fn fit(&self, points: usize, corners: usize) -> bool {
        match self.corners.is_empty() {
            true => self.values.len() == points,
            false => self.corners.len() == corners && self.are_indices_valid(),
        }
    }

    fn are_indices_valid(&self) -> bool {
        self.corners.iter().all(|&corner| (corner as usize) < self.values.len())
    }
}

/// The coordinates of each object as keys and values of a metadata record: the values in the first line, the indices of
/// the corners in the second.
pub(crate) fn to_keys(all: &BTreeMap<String, TextureCoordinates>) -> BTreeMap<String, String> {
    let text = |uvs: &TextureCoordinates| {
        let values: Vec<String> = uvs.values.as_flattened().iter().map(f32::to_string).collect();
        let corners: Vec<String> = uvs.corners.iter().map(u32::to_string).collect();
        format!("{}\n{}", values.join(" "), corners.join(" "))
    };
    all.iter().map(|(name, uvs)| (format!("{KEY}{name}"), text(uvs))).collect()
}

/// Coordinates from such keys; malformed entries are left out.
pub(crate) fn from_keys(keys: &BTreeMap<String, String>) -> BTreeMap<String, TextureCoordinates> {
    let entry = |(key, text): (&String, &String)| {
        let (values, corners) = text.split_once('\n')?;
        let numbers: Vec<f32> = numbers(values)?;
        let values: Vec<[f32; 2]> = numbers.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        let is_sound = numbers.len() == 2 * values.len() && numbers.iter().all(|x| x.is_finite());
        let uvs = TextureCoordinates { values, corners: self::numbers(corners)? };
        let is_sound = is_sound && uvs.are_indices_valid();
        is_sound.then_some((key.strip_prefix(KEY)?.to_owned(), uvs))
    };
    keys.iter().filter_map(entry).collect()
}

fn numbers<T: std::str::FromStr>(line: &str) -> Option<Vec<T>> {
    line.split(' ').filter(|word| !word.is_empty()).map(|word| word.parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_come_back_as_they_were() {
        let seam = TextureCoordinates { values: vec![[0.1, 1e-7], [1.0, -0.25]], corners: vec![0, 1, 1, 0] };
        let plain = TextureCoordinates { values: vec![[0.0, 1.0 / 3.0]], corners: Vec::new() };
        let all = BTreeMap::from([("a b".to_owned(), seam), ("crc32".to_owned(), plain)]);
        assert_eq!(from_keys(&to_keys(&all)), all);
    }

    #[test]
    fn malformed_coordinates_are_left_out() {
        for text in ["", "1 2", "1 2 3\n", "1 2\n0 1", "1 NaN\n", "1 x\n"] {
            assert!(from_keys(&BTreeMap::from([("uv a".to_owned(), text.to_owned())])).is_empty(), "{text}");
        }
    }

    #[test]
    fn they_fit_a_mesh_by_points_or_by_corners() {
        let per_point = TextureCoordinates { values: vec![[0.0; 2]; 4], corners: Vec::new() };
        assert!(per_point.fit(4, 99) && !per_point.fit(5, 4));
        let per_corner = TextureCoordinates { values: vec![[0.0; 2]; 2], corners: vec![0, 1, 1] };
        assert!(per_corner.fit(99, 3) && !per_corner.fit(3, 4));
    }
}
