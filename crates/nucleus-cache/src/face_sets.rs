//! Groups and materials of the faces of meshes, stored as metadata: they belong to the first mesh of an object and never change.

use std::collections::BTreeMap;

use crate::selections::{from_runs, runs};

/// Named sets of faces of a mesh.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FaceSets {
    /// The groups: a face may be in several, or in none.
    pub groups: Vec<FaceSet>,
    /// The materials: a face has one at most.
    pub materials: Vec<FaceSet>,
}

/// A set of faces.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FaceSet {
    /// Its name.
    pub name: String,
    /// Its faces, ascending.
    pub faces: Vec<u32>,
}

/// Prefix of a metadata key; the name of the object follows.
const KEY: &str = "faces ";
const GROUP: &str = "group";
const MATERIAL: &str = "material";

impl FaceSets {
    /// Whether all their faces are among so many, and no face has two materials.
    pub fn fit(&self, faces: usize) -> bool {
        let are_there = |set: &FaceSet| set.faces.last().is_none_or(|&last| (last as usize) < faces);
        self.groups.iter().chain(&self.materials).all(|set| are_there(set) && set.faces.is_sorted())
            && self.have_one_material_each(faces)
    }

    fn have_one_material_each(&self, faces: usize) -> bool {
        let mut has_one = vec![false; faces];
        let mut all = self.materials.iter().flat_map(|set| &set.faces);
        all.all(|&face| !std::mem::replace(&mut has_one[face as usize], true))
    }

    /// For each of so many faces the place of its material in [`materials`](Self::materials), if it has one.
    ///
    /// # Panics
    /// When they do not [`fit`](Self::fit).
    pub fn material_of_faces(&self, faces: usize) -> Vec<Option<usize>> {
        let mut found = vec![None; faces];
        for (place, set) in self.materials.iter().enumerate() {
            set.faces.iter().for_each(|&face| found[face as usize] = Some(place));
        }
        found
    }

    /// For each of so many faces the places of its groups in [`groups`](Self::groups), ascending.
    ///
    /// # Panics
    /// When they do not [`fit`](Self::fit).
    pub fn groups_of_faces(&self, faces: usize) -> Vec<Vec<usize>> {
        let mut found = vec![Vec::new(); faces];
        for (place, set) in self.groups.iter().enumerate() {
            set.faces.iter().for_each(|&face| found[face as usize].push(place));
        }
        found
    }
}

/// The sets of each object as keys and values of a metadata record: two lines for each set, `group` or `material` with its
/// name, and its faces, with runs as their ends: `3 5:8`.
pub(crate) fn to_keys(all: &BTreeMap<String, FaceSets>) -> BTreeMap<String, String> {
    let lines = |kind: &str, sets: &[FaceSet]| -> String {
        let set = |set: &FaceSet| format!("{kind} {}\n{}\n", set.name.replace('\n', " "), runs(&set.faces));
        sets.iter().map(set).collect()
    };
    let text = |sets: &FaceSets| lines(GROUP, &sets.groups) + &lines(MATERIAL, &sets.materials);
    all.iter().map(|(name, sets)| (format!("{KEY}{name}"), text(sets))).collect()
}

/// Sets from such keys; malformed entries are left out, and sets of a kind that this version does not know.
pub(crate) fn from_keys(keys: &BTreeMap<String, String>) -> BTreeMap<String, FaceSets> {
    let entry = |(key, text): (&String, &String)| {
        let mut sets = FaceSets::default();
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            let (kind, name) = line.split_once(' ')?;
            let set = FaceSet { name: name.to_owned(), faces: from_runs(lines.next()?)? };
            match kind {
                GROUP => sets.groups.push(set),
                MATERIAL => sets.materials.push(set),
                _ => {}
            }
        }
        Some((key.strip_prefix(KEY)?.to_owned(), sets))
    };
    keys.iter().filter_map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(name: &str, faces: &[u32]) -> FaceSet {
        FaceSet { name: name.to_owned(), faces: faces.to_vec() }
    }

    #[test]
    fn groups_and_materials_come_back_as_they_were() {
        let sets = FaceSets {
            groups: vec![set("hem", &[0, 2, 3, 4]), set("left side", &[]), set("", &[1])],
            materials: vec![set("silk", &[0, 1, 2, 3, 4, 5])],
        };
        let all = BTreeMap::from([("cloth 1".to_owned(), sets)]);
        let keys = to_keys(&all);
        assert_eq!(
            keys["faces cloth 1"],
            "group hem\n0 2:4\ngroup left side\n\ngroup \n1\nmaterial silk\n0:5\n"
        );
        assert_eq!(from_keys(&keys), all);
    }

    #[test]
    fn malformed_sets_are_left_out_and_unknown_kinds_are_skipped() {
        let read = |text: &str| from_keys(&BTreeMap::from([("faces a".to_owned(), text.to_owned())]));
        for text in ["group", "group a", "group a\nx\n", "material a\n0:4294967295\n"] {
            assert!(read(text).is_empty(), "{text}");
        }
        let known = FaceSets { groups: vec![set("a", &[1])], materials: Vec::new() };
        assert_eq!(read("crease 3 sharp\n0:4\ngroup a\n1\n")["a"], known);
    }

    #[test]
    fn sets_fit_a_mesh_that_has_their_faces_and_give_each_face_one_material() {
        let sets = FaceSets {
            groups: vec![set("a", &[0, 2]), set("b", &[2])],
            materials: vec![set("silk", &[0, 1]), set("wool", &[3])],
        };
        assert!(sets.fit(4) && !sets.fit(3));
        assert_eq!(sets.material_of_faces(4), [Some(0), Some(0), None, Some(1)]);
        assert_eq!(sets.groups_of_faces(4), [vec![0], vec![], vec![0, 1], vec![]]);
        let twice = FaceSets { materials: vec![set("silk", &[0]), set("wool", &[0])], ..FaceSets::default() };
        assert!(!twice.fit(4));
    }
}
