//! The materials of an export: a two-sided diffuse surface for each object.

use nucleus_cache::ObjectKind;

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
