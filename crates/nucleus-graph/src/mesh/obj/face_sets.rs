//! Groups and materials of the faces of an OBJ file. They are read apart from the mesh, because the solver does not know them.

use std::collections::HashMap;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::error::ObjError;
use super::statement::{Fault, Statements, words};
use crate::files;

/// Named sets of faces, in the order in which the file names them first. No set is empty.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FaceSets {
    /// The groups: a face may be in several, or in none.
    pub groups: Vec<FaceSet>,
    /// The materials: a face has one at most.
    pub materials: Vec<FaceSet>,
}

/// A set of faces.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FaceSet {
    /// Its name.
    pub name: String,
    /// Its faces, ascending.
    pub faces: Vec<u32>,
}

impl FaceSets {
    /// The group of a name.
    pub fn group(&self, name: &str) -> Option<&FaceSet> {
        self.groups.iter().find(|set| set.name == name)
    }

    /// Whether there is no set.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty() && self.materials.is_empty()
    }

    /// The sets by the places of their faces among `kept`, which ascends; other faces are left out.
    pub(crate) fn only(mut self, kept: &[u32]) -> Self {
        for sets in [&mut self.groups, &mut self.materials] {
            for set in sets.iter_mut() {
                let place = |face: &u32| kept.binary_search(face).ok().map(|place| place as u32);
                set.faces = set.faces.iter().filter_map(place).collect();
            }
            sets.retain(|set| !set.faces.is_empty());
        }
        self
    }
}

/// Reads the groups and materials of a file, and its number of faces. A face below `g a b` is in both groups, and a face below
/// `o c` is in a group of that name, unless all faces are. A face has the material of the last `usemtl` line above it.
///
/// # Errors
/// When the file cannot be read; see [`ObjError`].
pub fn read_obj_face_sets(path: impl AsRef<Path>) -> Result<(FaceSets, usize), ObjError> {
    let path = path.as_ref();
    let sets = files::open(path)
        .map_err(Fault::from)
        .and_then(|(file, _)| read(BufReader::with_capacity(1 << 18, file)));
    sets.map_err(|fault| fault.in_file(path))
}

fn read(input: impl BufRead) -> Result<(FaceSets, usize), Fault> {
    let [mut objects, mut groups, mut materials] = [(); 3].map(|()| Sets::default());
    let mut faces = 0;
    let mut statements = Statements::new(input);
    while let Some((_, statement)) = statements.next()? {
        let name = |word: &[u8]| String::from_utf8_lossy(word).into_owned();
        let mut words = words(statement).map(|word| word.bytes);
        match words.next() {
            // The names of objects and materials may have spaces.
            Some(b"o") => objects.open([name(&words.collect::<Vec<_>>().join(&b' '))]),
            Some(b"usemtl") => materials.open([name(&words.collect::<Vec<_>>().join(&b' '))]),
            Some(b"g") => groups.open(words.map(name)),
            Some(b"f") => {
                [&mut objects, &mut groups, &mut materials].into_iter().for_each(|sets| sets.add(faces));
                faces += 1;
            }
            _ => {}
        }
    }
    objects.all.retain(|set| set.faces.len() < faces as usize);
    let groups = groups.joined(objects);
    Ok((FaceSets { groups, materials: materials.joined(Sets::default()) }, faces as usize))
}

/// Sets while a file is read.
#[derive(Default)]
struct Sets {
    all: Vec<FaceSet>,
    places: HashMap<String, usize>,
    /// The places of those that the next face belongs to.
    open: Vec<usize>,
}

impl Sets {
    fn open(&mut self, names: impl IntoIterator<Item = String>) {
        self.open.clear();
        for name in names.into_iter().filter(|name| !name.is_empty()) {
            let place = *self.places.entry(name).or_insert_with_key(|name| {
                self.all.push(FaceSet { name: name.clone(), faces: Vec::new() });
                self.all.len() - 1
            });
            if !self.open.contains(&place) {
                self.open.push(place);
            }
        }
    }

    fn add(&mut self, face: u32) {
        for &place in &self.open {
            self.all[place].faces.push(face);
        }
    }

    /// The sets that are not empty, with others behind them; sets of one name are one.
    fn joined(mut self, others: Self) -> Vec<FaceSet> {
        for other in others.all {
            match self.places.get(&other.name) {
                None => self.all.push(other),
                Some(&place) => {
                    let faces = &mut self.all[place].faces;
                    faces.extend(other.faces);
                    faces.sort_unstable();
                    faces.dedup();
                }
            }
        }
        self.all.retain(|set| !set.faces.is_empty());
        self.all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sets(text: &str) -> FaceSets {
        read(text.as_bytes()).expect("well formed").0
    }

    fn named(sets: &[FaceSet]) -> Vec<(&str, &[u32])> {
        sets.iter().map(|set| (set.name.as_str(), set.faces.as_slice())).collect()
    }

    #[test]
    fn faces_belong_to_the_groups_and_the_material_above_them() {
        let text = "mtllib a.mtl\nf 1 2 3\ng collar trim\nusemtl silk\nf 1/1 2/1 3/1\ng sleeve\nf -3 -2 -1\n\
                    usemtl wool blend # heavy\ng\nf 1 2 3\ng trim\nusemtl silk\nf 1 2 3\ng empty\nusemtl none\n";
        let sets = sets(text);
        assert_eq!(named(&sets.groups), [("collar", &[1][..]), ("trim", &[1, 4]), ("sleeve", &[2])]);
        assert_eq!(named(&sets.materials), [("silk", &[1, 2, 4][..]), ("wool blend", &[3])]);
    }

    #[test]
    fn objects_of_a_file_are_groups_unless_one_has_all_faces() {
        let two = sets("o shirt\ng hem\nf 1 2 3\no hem\nf 1 2 3\no shirt\nf 1 2 3\n");
        assert_eq!(named(&two.groups), [("hem", &[0, 1, 2][..]), ("shirt", &[0, 2])]);
        assert!(sets("o shirt\nf 1 2 3\nf 1 2 3\n").is_empty());
    }

    #[test]
    fn sets_follow_their_faces_when_others_are_left_out() {
        let sets = sets("g a\nf 1 2 3\nf 1 2 3\ng b\nf 1 2 3\nusemtl m\nf 1 2 3\n").only(&[0, 3]);
        assert_eq!(named(&sets.groups), [("a", &[0][..]), ("b", &[1])]);
        assert_eq!(named(&sets.materials), [("m", &[1][..])]);
    }
}
