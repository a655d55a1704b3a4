//! Bytes of per-point attributes: the messages on `/<object>/contacts`, `/<object>/strain` and others,
//! little-endian; and the computation of strain.

use nucleus_core::{ContactState, Particle, ParticleLook};

use crate::messages::byte_shuffle::{shuffle, unshuffle};
use crate::messages::points::{HEAD, Stamp};
use crate::run::{ObjectInfo, RunInfo};

/// A per-point attribute.
pub(crate) struct Attribute {
    /// Last part of its topics.
    pub topic: &'static str,
    pub encoding: &'static str,
    /// Description of a message for other readers; stored in the file.
    pub schema: &'static str,
    /// Bytes per value.
    pub width: usize,
}

pub(crate) const CONTACTS: Attribute = Attribute {
    topic: "contacts",
    encoding: "nucleus.contacts.v1",
    schema: "\
Little-endian. i32 frame, u32 substep, u32 substeps, u32 count, u64 zero, f64 time: as in nucleus.points.v1. Then a byte
for each point: 0 free, 1 touching, 2 compressed (nearer than nine tenths of its thickness), 3 depenetrating (inside
a closed collider), 4 intersecting (at an edge of cloth that intersects a face of cloth, being untangled).
",
    width: 1,
};

pub(crate) const STRAIN: Attribute = Attribute {
    topic: "strain",
    encoding: "nucleus.strain.v1",
    schema: "\
Little-endian. i32 frame, u32 substep, u32 substeps, u32 count, u64 zero, f64 time: as in nucleus.points.v1. Then a f32
for each point, as four planes of count bytes: plane k holds byte k of every f32 (0 is the lowest). It is the strain of
largest size among the edges of faces at the point, length over rest length less one.
",
    width: 4,
};

pub(crate) const LOOKS: Attribute = Attribute {
    topic: "looks",
    encoding: "nucleus.looks.v1",
    schema: "\
Little-endian. i32 frame, u32 substep, u32 substeps, u32 count, u64 zero, f64 time: as in nucleus.points.v1. Then eight f32
for each particle, as four planes of 8 count bytes: plane k holds byte k of every f32 (0 is the lowest). They are a factor on
the radius; opacity; red, green and blue from 0 to 1, of which red is below 0 where the object has no colours of its own; and
red, green and blue of the light it gives off.
",
    width: 32,
};

pub(crate) const ROTATION: Attribute = Attribute {
    topic: "rotation",
    encoding: "nucleus.rotation.v1",
    schema: "\
Little-endian. i32 frame, u32 substep, u32 substeps, u32 count, u64 zero, f64 time: as in nucleus.points.v1. Then four f32
for each particle, as four planes of 4 count bytes: plane k holds byte k of every f32 (0 is the lowest). They are x, y, z and w
of a unit quaternion, the turn of the particle since its birth.
",
    width: 16,
};

pub(crate) const PARTICLES: Attribute = Attribute {
    topic: "particles",
    encoding: "nucleus.particles.v1",
    schema: "\
Little-endian. i32 frame, u32 substep, u32 substeps, u32 count, u64 zero, f64 time: as in nucleus.points.v1. Then five words of
four bytes for each particle, as four planes of 5 count bytes: plane k holds byte k of every word (0 is the lowest). They are
the lower and the upper half of its number (u64), which no other particle of the object ever has, and as f32 its age in
seconds, the age at which it dies (infinite for never) and its mass in kilograms.
",
    width: 20,
};

/// All attributes.
pub(crate) const ALL: [&Attribute; 5] = [&CONTACTS, &STRAIN, &LOOKS, &ROTATION, &PARTICLES];

impl Attribute {
    /// Whether a run records it.
    pub fn is_recorded(&self, run: &RunInfo) -> bool {
        (self.encoding == CONTACTS.encoding && run.contacts)
            || (self.encoding == STRAIN.encoding && run.strain)
            || (self.encoding == LOOKS.encoding && run.looks)
            || (self.encoding == ROTATION.encoding && run.rotation)
            || (self.encoding == PARTICLES.encoding && run.particles)
    }

    /// The bytes of the values in a message; `None` when its time stamp or its number of points differs. Without a
    /// `count` any number of points is right.
    pub fn read<'a>(&self, data: &'a [u8], count: Option<usize>, stamp: (i32, u64)) -> Option<&'a [u8]> {
        let (head, values) = data.split_at_checked(HEAD)?;
        let (found, stated) = Stamp::read(head)?;
        let stated = stated as usize;
        let fits = count.is_none_or(|count| count == stated) && values.len() == self.width * stated;
        (fits && (found.frame, found.log_time()) == stamp).then_some(values)
    }

    /// The bytes of the values in the order of the points, from the planes of a message.
    pub fn by_point(&self, bytes: &[u8]) -> Vec<u8> {
        if self.width == 1 {
            return bytes.to_vec();
        }
        let mut numbers = vec![0.0_f32; bytes.len() / 4];
        unshuffle(bytes, &mut numbers);
        numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
    }
}

/// Appends contact states, one byte each.
pub(crate) fn write_contacts(contacts: &[ContactState], out: &mut Vec<u8>) {
    out.extend(contacts.iter().map(|&contact| contact as u8));
}

/// Contact states from their bytes; `None` when one is unknown.
pub(crate) fn read_contacts(bytes: &[u8]) -> Option<Vec<ContactState>> {
    let contact = |&byte: &u8| {
        let known = [
            ContactState::Free,
            ContactState::Touching,
            ContactState::Compressed,
            ContactState::Depenetrating,
            ContactState::Intersecting,
        ];
        known.into_iter().find(|&contact| contact as u8 == byte)
    };
    bytes.iter().map(contact).collect()
}

/// Appends the looks of particles.
pub(crate) fn write_looks(looks: &[ParticleLook], out: &mut Vec<u8>) {
    let numbers = |look: &ParticleLook| {
        let ([red, green, blue], [a, b, c]) = (look.color.unwrap_or([-1.0; 3]), look.incandescence);
        [look.radius, look.opacity, red, green, blue, a, b, c]
    };
    let numbers: Vec<f32> = looks.iter().flat_map(numbers).collect();
    shuffle(&numbers, out);
}

/// The looks of particles from their bytes.
pub(crate) fn read_looks(bytes: &[u8]) -> Vec<ParticleLook> {
    let mut numbers = vec![0.0f32; bytes.len() / 4];
    unshuffle(bytes, &mut numbers);
    let look = |&[radius, opacity, red, green, blue, a, b, c]: &[f32; 8]| ParticleLook {
        radius,
        opacity,
        color: (red >= 0.0).then_some([red, green, blue]),
        incandescence: [a, b, c],
    };
    numbers.as_chunks::<8>().0.iter().map(look).collect()
}

/// Appends numbers, ages, lifespans and masses of particles.
pub(crate) fn write_particles(particles: &[Particle], out: &mut Vec<u8>) {
    let words = |particle: &Particle| {
        let id = [particle.id as u32, (particle.id >> 32) as u32].map(f32::from_bits);
        [id[0], id[1], particle.age as f32, particle.lifespan as f32, particle.mass as f32]
    };
    let words: Vec<f32> = particles.iter().flat_map(words).collect();
    shuffle(&words, out);
}

/// Numbers, ages, lifespans and masses of particles from their bytes.
pub(crate) fn read_particles(bytes: &[u8]) -> Vec<Particle> {
    let mut words = vec![0.0f32; bytes.len() / 4];
    unshuffle(bytes, &mut words);
    let particle = |&[low, high, age, lifespan, mass]: &[f32; 5]| Particle {
        id: u64::from(low.to_bits()) | u64::from(high.to_bits()) << 32,
        age: age.into(),
        lifespan: lifespan.into(),
        mass: mass.into(),
    };
    words.as_chunks::<5>().0.iter().map(particle).collect()
}

/// The edges of a mesh, each once, with their rest lengths.
pub(crate) struct RestEdges(Vec<([u32; 2], f32)>);

impl RestEdges {
    /// The edges of an object's faces; edges of zero rest length are left out.
    pub fn new(object: &ObjectInfo) -> Self {
        let around = |face: &[u32]| {
            let next = face.iter().copied().cycle().skip(1);
            face.iter().copied().zip(next).map(|(a, b)| [a.min(b), a.max(b)]).collect::<Vec<_>>()
        };
        let mut edges: Vec<[u32; 2]> = object.faces.iter().flat_map(around).collect();
        edges.sort_unstable();
        edges.dedup();
        let with_length = edges.into_iter().map(|edge| (edge, length(&object.rest, edge)));
        Self(with_length.filter(|&(_, length)| length > 0.0).collect())
    }

    /// Replaces `out` by the signed strain of largest magnitude among the edges at each point; 0 where there is none.
    pub fn strain(&self, positions: &[[f32; 3]], out: &mut Vec<f32>) {
        out.clear();
        out.resize(positions.len(), 0.0);
        for &(edge, rest) in &self.0 {
            let strain = length(positions, edge) / rest - 1.0;
            for point in edge {
                let largest = &mut out[point as usize];
                if strain.abs() > largest.abs() {
                    *largest = strain;
                }
            }
        }
    }
}

fn length(positions: &[[f32; 3]], [a, b]: [u32; 2]) -> f32 {
    let [a, b] = [a, b].map(|point| positions[point as usize]);
    let square = |axis: usize| (a[axis] - b[axis]) * (a[axis] - b[axis]);
    (square(0) + square(1) + square(2)).sqrt()
}

#[cfg(test)]
mod tests {
    use nucleus_core::Faces;

    use super::*;
    use crate::run::ObjectKind;

    #[test]
    fn a_point_has_the_strain_of_its_worst_edge() {
        let faces = Faces::from_iter([&[0_u32, 1, 2][..]]);
        let rest = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let object = ObjectInfo { name: "a".into(), kind: ObjectKind::Cloth, faces, rest };
        let mut strain = Vec::new();
        RestEdges::new(&object).strain(&[[0.0; 3], [0.25, 0.0, 0.0], [0.0, 1.5, 0.0]], &mut strain);
        assert_eq!(strain[..2], [-0.75, -0.75]);
        assert_eq!(strain[2], 0.5);
    }
}
