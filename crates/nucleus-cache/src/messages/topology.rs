//! Bytes of a mesh: the message on `/<object>/topology`, little-endian.

use nucleus_core::Faces;

use crate::run::{ObjectInfo, ObjectKind};

pub(crate) const ENCODING: &str = "nucleus.topology.v1";

/// Description of a topology message for other readers; stored in the file.
pub(crate) const SCHEMA: &str = "\
Little-endian. u32 kind (0 cloth, 1 collider, 2 particles), u32 points, u32 faces, u32 corners,
u32 starts[faces + 1] (first corner of each face, then the number of corners), u32 corners[corners]
(the point at each corner), f32 rest[3 * points] (x y z of each point at rest, in scene units). Then, if the object had
other meshes before, u32 number: how many. It has this mesh from the time of the message on.
";

/// Replaces `out` by the topology message of an object that had `number` meshes before. Takes the object by value to
/// free its memory part-way.
pub(crate) fn write(object: ObjectInfo, number: u32, out: &mut Vec<u8>) {
    let ObjectInfo { kind, faces, rest, .. } = object;
    let kind = match kind {
        ObjectKind::Cloth => 0_u32,
        ObjectKind::Collider => 1,
        ObjectKind::Particles => 2,
    };
    let counts = [kind, rest.len() as u32, faces.len() as u32, faces.corners().len() as u32];
    out.clear();
    out.reserve_exact(4 * (counts.len() + faces.len() + 1 + faces.corners().len() + 3 * rest.len() + 1));
    let mut put = |x: u32| out.extend_from_slice(&x.to_le_bytes());
    counts.into_iter().for_each(&mut put);
    let mut end = 0;
    put(end);
    for face in faces.iter() {
        end += face.len() as u32;
        put(end);
    }
    faces.corners().iter().copied().for_each(&mut put);
    drop(faces);
    rest.as_flattened().iter().for_each(|x| put(x.to_bits()));
    if number > 0 {
        put(number);
    }
}

/// Reads a topology message and its mesh number; `None` when it contradicts itself.
pub(crate) fn read(name: &str, data: &[u8]) -> Option<(ObjectInfo, u32)> {
    let mut words = data.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().expect("four bytes")));
    let kind = match words.next()? {
        0 => ObjectKind::Cloth,
        1 => ObjectKind::Collider,
        2 => ObjectKind::Particles,
        _ => return None,
    };
    let [points, faces, corners] = [words.next()? as usize, words.next()? as usize, words.next()? as usize];
    let number = number(data)?;
    let starts: Vec<u32> = words.by_ref().take(faces + 1).collect();
    let corner_points: Vec<u32> = words.by_ref().take(corners).collect();
    let rest: Vec<f32> = words.take(3 * points).map(f32::from_bits).collect();
    let rest: Vec<[f32; 3]> = rest.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    if starts.first() != Some(&0) || corner_points.iter().any(|&point| point as usize >= points) {
        return None;
    }
    let mut table = Faces::with_capacity(faces, corners);
    for pair in starts.windows(2) {
        table.push(corner_points.get(pair[0] as usize..pair[1] as usize)?);
    }
    if table.corners().len() != corners {
        return None;
    }
    Some((ObjectInfo { name: name.to_owned(), kind, faces: table, rest }, number))
}

/// The mesh number of a topology message; `None` when its length differs from the length it states.
pub(crate) fn number(data: &[u8]) -> Option<u32> {
    let word = |k: usize| Some(u32::from_le_bytes(data.get(4 * k..4 * k + 4)?.try_into().ok()?));
    let [points, faces, corners] = [word(1)? as usize, word(2)? as usize, word(3)? as usize];
    let words = 4 + faces + 1 + corners + 3 * points;
    match data.len() {
        length if length == 4 * words => Some(0),
        length if length == 4 * (words + 1) => word(words).filter(|&number| number > 0),
        _ => None,
    }
}

/// The object that a topology topic belongs to.
pub(crate) fn object_name(topic: &str) -> Option<&str> {
    topic.strip_prefix('/')?.strip_suffix("/topology")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn object() -> impl Strategy<Value = ObjectInfo> {
        let rest = prop::collection::vec(any::<[i16; 3]>(), 1..30);
        let faces = prop::collection::vec(prop::collection::vec(any::<prop::sample::Index>(), 3..6), 0..20);
        let kind =
            prop_oneof![Just(ObjectKind::Cloth), Just(ObjectKind::Collider), Just(ObjectKind::Particles)];
        (".*", kind, rest, faces).prop_map(|(name, kind, rest, corners)| {
            let rest: Vec<[f32; 3]> = rest.iter().map(|p| p.map(f32::from)).collect();
            let mut faces = Faces::default();
            for face in corners {
                let face: Vec<u32> = face.iter().map(|corner| corner.index(rest.len()) as u32).collect();
                faces.push(&face);
            }
            ObjectInfo { name, kind, faces, rest }
        })
    }

    proptest! {
        #[test]
        fn a_topology_message_gives_the_object_back(object in object(), number in prop_oneof![Just(0), any::<u32>()]) {
            let mut bytes = Vec::new();
            write(object.clone(), number, &mut bytes);
            prop_assert_eq!(read(&object.name, &bytes), Some((object, number)));
        }

        #[test]
        fn no_bytes_make_the_reader_panic(words in prop::collection::vec(0_u32..9, 0..60)) {
            // Small counts, so that some messages have a valid length.
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            let object = read("any", &bytes);
            let corners = object.iter().flat_map(|(object, _)| object.faces.corners().iter().map(move |&c| (c, object)));
            for (corner, object) in corners {
                prop_assert!((corner as usize) < object.rest.len());
            }
        }
    }

    #[test]
    fn a_face_with_a_missing_point_is_refused() {
        let mut faces = Faces::default();
        faces.push(&[0, 1, 3]);
        let object = ObjectInfo { name: "a".into(), kind: ObjectKind::Cloth, faces, rest: vec![[0.0; 3]; 3] };
        let mut bytes = Vec::new();
        write(object, 0, &mut bytes);
        assert_eq!(read("a", &bytes), None);
    }
}
