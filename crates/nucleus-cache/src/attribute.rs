//! What is recorded of each point besides its place: the bytes of the messages on `/<object>/contacts` and
//! `/<object>/strain`. Everything is little-endian.

use nucleus_core::ContactState;

use crate::points::{HEAD, Stamp};
use crate::run::RunInfo;

/// An attribute that points have.
pub(crate) struct Attribute {
    /// The end of its topics.
    pub topic: &'static str,
    pub encoding: &'static str,
    /// What a stranger needs to read a message; stored in the file.
    pub schema: &'static str,
    /// Bytes of a value.
    width: usize,
}

pub(crate) const CONTACTS: Attribute = Attribute {
    topic: "contacts",
    encoding: "nucleus.contacts.v1",
    schema: "\
Little-endian. i32 frame, u32 substep, u32 substeps, u32 count, u64 zero, f64 time: as in nucleus.points.v1. Then a byte
for each point: 0 free, 1 touching, 2 pinched (nearer than nine tenths of its thickness), 3 trapped (inside a closed
collider, being led out), 4 tangled (at an edge of cloth that goes through a face of cloth, being worked apart).
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

/// All there are.
pub(crate) const ALL: [&Attribute; 2] = [&CONTACTS, &STRAIN];

impl Attribute {
    /// Whether a run is recorded with it.
    pub fn is_recorded(&self, run: &RunInfo) -> bool {
        (self.encoding == CONTACTS.encoding && run.contacts)
            || (self.encoding == STRAIN.encoding && run.strain)
    }

    /// The bytes of the values in a message; `None` when it is of another moment or of another number of points.
    pub fn read<'a>(&self, data: &'a [u8], count: usize, stamp: (i32, u64)) -> Option<&'a [u8]> {
        let (head, values) = data.split_at_checked(HEAD)?;
        let (found, stated) = Stamp::read(head)?;
        let fits = stated as usize == count && values.len() == self.width * count;
        (fits && (found.frame, found.log_time()) == stamp).then_some(values)
    }
}

/// Appends contacts, a byte each.
pub(crate) fn write_contacts(contacts: &[ContactState], out: &mut Vec<u8>) {
    out.extend(contacts.iter().map(|&contact| contact as u8));
}

/// Contacts from their bytes; `None` if one is none that is known.
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
