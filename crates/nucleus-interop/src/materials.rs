//! The materials of an export: a two-sided diffuse surface for each object, and for each material that faces of a mesh name.

use std::io::{Read, Seek};

use nucleus_cache::{FaceSet, ObjectKind};

use crate::clip::Clip;

/// Roughness of all surfaces, 0 to 1.
pub(crate) const ROUGHNESS: f32 = 0.8;

/// Linear colours, those of the player and of still pictures.
const CLOTHS: [[f32; 3]; 6] = [
    [0.5, 0.085, 0.07],
    [0.065, 0.21, 0.38],
    [0.66, 0.37, 0.07],
    [0.07, 0.3, 0.22],
    [0.4, 0.18, 0.42],
    [0.3, 0.42, 0.12],
];
const COLLIDERS: [[f32; 3]; 3] = [[0.3, 0.3, 0.295], [0.25, 0.27, 0.29], [0.33, 0.3, 0.26]];

/// A material of an export.
pub(crate) struct Material {
    /// The name of an object, or one that faces of a mesh name.
    pub name: String,
    /// Linear colour.
    pub colour: [f32; 3],
}

/// The materials of an export.
pub(crate) struct Materials {
    /// Those of the objects, in their order, and behind them those that faces name, each once.
    pub all: Vec<Material>,
    objects: usize,
}

impl Materials {
    pub fn of<R: Read + Seek>(clip: &Clip<R>) -> Self {
        let colours = colours(clip.objects().map(|object| object.kind));
        let material = |(name, colour): (&String, [f32; 3])| Material { name: name.clone(), colour };
        let names = clip.objects().map(|object| &object.name);
        let mut found =
            Self { all: names.zip(colours).map(material).collect(), objects: clip.objects().len() };
        for set in
            (0..found.objects).filter_map(|object| clip.face_sets(object)).flat_map(|sets| &sets.materials)
        {
            if found.find(set).is_none() {
                let colour = CLOTHS[found.all.len() % CLOTHS.len()];
                found.all.push(Material { name: set.name.clone(), colour });
            }
        }
        found
    }

    /// Those that faces name.
    pub fn of_all_faces(&self) -> &[Material] {
        &self.all[self.objects..]
    }

    /// The place of the material that faces name.
    pub fn of_faces(&self, set: &FaceSet) -> usize {
        self.find(set).unwrap_or_default()
    }

    fn find(&self, set: &FaceSet) -> Option<usize> {
        let named = self.of_all_faces().iter().position(|material| material.name == set.name);
        named.map(|place| self.objects + place)
    }
}

/// The linear colour of each object, by its order among colliders or among the others.
pub(crate) fn colours(kinds: impl Iterator<Item = ObjectKind>) -> Vec<[f32; 3]> {
    let [mut cloths, mut colliders] = [0, 0];
    let colour = |kind| {
        let (count, all): (&mut usize, &[[f32; 3]]) = match kind {
            ObjectKind::Collider => (&mut colliders, &COLLIDERS),
            _ => (&mut cloths, &CLOTHS),
        };
        *count += 1;
        all[(*count - 1) % all.len()]
    };
    kinds.map(colour).collect()
}
