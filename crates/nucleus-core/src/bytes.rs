//! Binary encoding of the solver's state: little-endian, bit for bit. Decoded bytes are never trusted: decoding gives a
//! valid value or `None`.
//!
//! | You want to know… | Read |
//! |---|---|
//! | how numbers, columns and lists become bytes | [`Encode`], [`encode_struct`] |
//! | which fields of a struct a checkpoint stores, and which are rebuilt | [`Checkpoint`], [`checkpoint_struct`] |
//! | version and checksum | [`add_checksum`], [`verify_checksum`] |
//!
//! **Invariant:** both macros name every field of a struct. A new field that neither names does not compile, so no
//! state can be missing from a checkpoint by mistake.

use nalgebra::Vector3;

/// A value with a binary encoding.
pub trait Encode: Sized {
    /// Bytes per value; zero where values differ in length.
    const SIZE: usize;
    /// Appends the value.
    fn encode(&self, out: &mut Vec<u8>);
    /// Decodes a value; `None` where the bytes are not a valid one.
    fn decode(from: &mut Reader<'_>) -> Option<Self>;
}

/// The bytes that are still to be decoded.
#[derive(Debug, Clone)]
pub struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    /// Reads these bytes.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    /// The next bytes; `None` where there are fewer.
    pub fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (bytes, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(bytes)
    }

    /// Whether every byte has been read.
    pub fn is_at_end(&self) -> bool {
        self.0.is_empty()
    }
}

macro_rules! number {
    ($($number:ty),*) => { $(
        impl Encode for $number {
            const SIZE: usize = size_of::<Self>();
            fn encode(&self, out: &mut Vec<u8>) {
                out.extend_from_slice(&self.to_le_bytes());
            }
            fn decode(from: &mut Reader<'_>) -> Option<Self> {
                Some(Self::from_le_bytes(from.bytes(size_of::<Self>())?.try_into().ok()?))
            }
        }
    )* };
}

number!(u8, u32, u64, i64, f32, f64);

impl Encode for bool {
    const SIZE: usize = 1;
    fn encode(&self, out: &mut Vec<u8>) {
        u8::from(*self).encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        match u8::decode(from)? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }
}

impl<T: Encode + Copy, const N: usize> Encode for [T; N] {
    const SIZE: usize = N * T::SIZE;
    fn encode(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|value| value.encode(out));
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        let mut all = [T::decode(from)?; N];
        for value in all.iter_mut().skip(1) {
            *value = T::decode(from)?;
        }
        Some(all)
    }
}

impl<A: Encode, B: Encode> Encode for (A, B) {
    const SIZE: usize = if A::SIZE == 0 || B::SIZE == 0 { 0 } else { A::SIZE + B::SIZE };
    fn encode(&self, out: &mut Vec<u8>) {
        self.0.encode(out);
        self.1.encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        Some((A::decode(from)?, B::decode(from)?))
    }
}

impl Encode for Vector3<f64> {
    const SIZE: usize = <[f64; 3]>::SIZE;
    fn encode(&self, out: &mut Vec<u8>) {
        <[f64; 3]>::from(*self).encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        <[f64; 3]>::decode(from).map(Self::from)
    }
}

impl<T: Encode> Encode for Option<T> {
    const SIZE: usize = 0;
    fn encode(&self, out: &mut Vec<u8>) {
        self.is_some().encode(out);
        self.iter().for_each(|value| value.encode(out));
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        if bool::decode(from)? { T::decode(from).map(Some) } else { Some(None) }
    }
}

/// Values per run of the byte shuffle: few enough for the nearest cache.
const RUN: usize = 256;

/// The count, then the values. Values of one fixed size are byte-shuffled: first byte of all, second byte of all, and
/// so on, because the high bytes of numbers are alike and compress well side by side.
impl<T: Encode> Encode for Vec<T> {
    const SIZE: usize = 0;
    fn encode(&self, out: &mut Vec<u8>) {
        (self.len() as u64).encode(out);
        if T::SIZE <= 1 {
            return self.iter().for_each(|value| value.encode(out));
        }
        let begin = out.len();
        out.resize(begin + self.len() * T::SIZE, 0);
        let mut bytes = Vec::with_capacity(RUN * T::SIZE);
        for (run, values) in self.chunks(RUN).enumerate() {
            bytes.clear();
            values.iter().for_each(|value| value.encode(&mut bytes));
            for plane in 0..T::SIZE {
                let from = begin + plane * self.len() + run * RUN;
                let column = bytes[plane..].iter().step_by(T::SIZE);
                out[from..from + values.len()].iter_mut().zip(column).for_each(|(to, &byte)| *to = byte);
            }
        }
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        let count = usize::try_from(u64::decode(from)?).ok()?;
        if T::SIZE <= 1 {
            // A damaged count must not allocate more than the bytes can hold.
            let mut all = Self::with_capacity(count.min(from.0.len()));
            for _ in 0..count {
                all.push(T::decode(from)?);
            }
            return Some(all);
        }
        let planes = from.bytes(count.checked_mul(T::SIZE)?)?;
        let mut bytes = vec![0; T::SIZE];
        let value = |at: usize| {
            bytes.iter_mut().enumerate().for_each(|(plane, byte)| *byte = planes[plane * count + at]);
            T::decode(&mut Reader(&bytes))
        };
        (0..count).map(value).collect()
    }
}

/// Implements [`Encode`] for a struct, field by field; every field must be named.
macro_rules! encode_struct {
    ([$($generics:tt)*] $type:ty { $($field:ident: $of:ty),* $(,)? }) => {
        impl<$($generics)*> $crate::bytes::Encode for $type {
            const SIZE: usize = 0 $(+ <$of as $crate::bytes::Encode>::SIZE)*;
            fn encode(&self, out: &mut Vec<u8>) {
                let Self { $($field),* } = self;
                $($crate::bytes::Encode::encode($field, out);)*
            }
            fn decode(from: &mut $crate::bytes::Reader<'_>) -> Option<Self> {
                Some(Self { $($field: <$of as $crate::bytes::Encode>::decode(from)?),* })
            }
        }
    };
}

pub(crate) use encode_struct;

/// A part of a solver that is built from the model, then filled in place from a checkpoint.
pub trait Checkpoint {
    /// Appends the stored fields.
    fn save(&self, out: &mut Vec<u8>);
    /// Reads the stored fields; `None` where the bytes are invalid.
    fn load(&mut self, from: &mut Reader<'_>) -> Option<()>;
}

/// As many parts as the model has; their number is not stored.
impl<T: Checkpoint> Checkpoint for Vec<T> {
    fn save(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|part| part.save(out));
    }
    fn load(&mut self, from: &mut Reader<'_>) -> Option<()> {
        self.iter_mut().try_for_each(|part| part.load(from))
    }
}

/// The model determines whether there is a part.
impl<T: Checkpoint> Checkpoint for Option<T> {
    fn save(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|part| part.save(out));
    }
    fn load(&mut self, from: &mut Reader<'_>) -> Option<()> {
        self.iter_mut().try_for_each(|part| part.load(from))
    }
}

/// Reads a column whose length the model determines.
pub fn load_column<T: Encode>(column: &mut Vec<T>, from: &mut Reader<'_>) -> Option<()> {
    let read = Vec::decode(from)?;
    (read.len() == column.len()).then(|| *column = read)
}

/// Implements [`Checkpoint`] for a struct; every field must be named.
///
/// `columns` have the length that the model determines; `values` have any length; `parts` implement [`Checkpoint`];
/// fields that are `rebuilt` follow from the model and the stored fields, or every frame writes them before it reads
/// them.
macro_rules! checkpoint_struct {
    (
        [$($generics:tt)*] $type:ty {
            columns: [$($column:ident),*], values: [$($value:ident),*], parts: [$($part:ident),*],
            rebuilt: [$($rebuilt:ident),*] $(,)?
        }
    ) => {
        impl<$($generics)*> $crate::bytes::Checkpoint for $type {
            fn save(&self, out: &mut Vec<u8>) {
                let Self { $($column,)* $($value,)* $($part,)* $($rebuilt: _,)* } = self;
                $($crate::bytes::Encode::encode($column, out);)*
                $($crate::bytes::Encode::encode($value, out);)*
                $($crate::bytes::Checkpoint::save($part, out);)*
            }
            fn load(&mut self, from: &mut $crate::bytes::Reader<'_>) -> Option<()> {
                $($crate::bytes::load_column(&mut self.$column, from)?;)*
                $(self.$value = $crate::bytes::Encode::decode(from)?;)*
                $($crate::bytes::Checkpoint::load(&mut self.$part, from)?;)*
                Some(())
            }
        }
    };
}

pub(crate) use checkpoint_struct;

/// Why a run cannot go on from a checkpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RestoreError {
    /// The checksum does not match, or the bytes are not a valid state.
    #[error("the checkpoint is damaged")]
    Damaged,
    /// The bytes are no checkpoint, or of another version of Nucleus.
    #[error("the checkpoint was written by another version of nucleus")]
    OtherVersion,
    /// It belongs to another model: points, faces, masses or the order of objects differ.
    #[error("the checkpoint is of other objects: a mesh or its mass has changed")]
    OtherModel,
    /// It was written in another precision.
    #[error("the checkpoint is of a run in f{found}, not in f{wanted}")]
    Scalar {
        /// Bits per number in the checkpoint.
        found: u32,
        /// Bits per number in this solver.
        wanted: u32,
    },
    /// It has a smaller capacity for particles than the model asks for. Rows are numbered by the capacity, and cannot be added.
    #[error("the checkpoint has a capacity of {found} particles of an object that can have {wanted}")]
    SmallerCapacity {
        /// Particles that the saved object can have.
        found: u64,
        /// Particles that the object of this model can have.
        wanted: u64,
    },
}

/// The bytes with their kind (a name and a version) in front and a checksum behind.
pub fn add_checksum(kind: [u8; 8], bytes: &[u8]) -> Vec<u8> {
    let mut whole = Vec::with_capacity(bytes.len() + 16);
    whole.extend_from_slice(&kind);
    whole.extend_from_slice(bytes);
    whole.extend_from_slice(&checksum(&whole).to_le_bytes());
    whole
}

/// The bytes between kind and checksum.
///
/// # Errors
/// When the kind differs or the checksum does not match.
pub fn verify_checksum(kind: [u8; 8], whole: &[u8]) -> Result<&[u8], RestoreError> {
    let (rest, found) = whole.split_last_chunk::<8>().ok_or(RestoreError::Damaged)?;
    if checksum(rest) != u64::from_le_bytes(*found) {
        return Err(RestoreError::Damaged);
    }
    match rest.split_first_chunk::<8>() {
        Some((found, inner)) if *found == kind => Ok(inner),
        _ => Err(RestoreError::OtherVersion),
    }
}

/// FNV-1a over words, and over the length at the end.
fn checksum(bytes: &[u8]) -> u64 {
    let words = bytes.chunks(8).map(|chunk| {
        let mut word = [0; 8];
        word[..chunk.len()].copy_from_slice(chunk);
        u64::from_le_bytes(word)
    });
    words.chain([bytes.len() as u64]).fold(HASH_SEED, hash_word)
}

/// The hash of no words.
pub const HASH_SEED: u64 = 0xcbf2_9ce4_8422_2325;

/// Adds a word to a hash (FNV-1a over words). Each step is invertible, so two different words never give the same hash.
pub fn hash_word(hash: u64, word: u64) -> u64 {
    (hash ^ word).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(23)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn decoding_gives_the_value_that_was_encoded(
            numbers in proptest::collection::vec((any::<u32>(), proptest::array::uniform3(any::<f64>())), 0..20),
            flags in proptest::collection::vec(any::<bool>(), 0..20),
            maybe: Option<u64>,
        ) {
            let mut bytes = Vec::new();
            numbers.encode(&mut bytes);
            (flags.clone(), maybe).encode(&mut bytes);
            let mut reader = Reader::new(&bytes);
            prop_assert_eq!(Vec::<(u32, [f64; 3])>::decode(&mut reader), Some(numbers));
            prop_assert_eq!(<(Vec<bool>, Option<u64>)>::decode(&mut reader), Some((flags, maybe)));
            prop_assert!(reader.is_at_end());
        }

        #[test]
        fn decoding_any_bytes_does_not_panic(bytes in proptest::collection::vec(any::<u8>(), 0..64)) {
            Vec::<[f64; 3]>::decode(&mut Reader::new(&bytes));
            Vec::<Vec<bool>>::decode(&mut Reader::new(&bytes));
            <Option<Vec<(u8, Option<u32>)>> as Encode>::decode(&mut Reader::new(&bytes));
        }
    }

    #[test]
    fn a_count_larger_than_the_bytes_is_refused_before_allocation() {
        let mut bytes = Vec::new();
        u64::MAX.encode(&mut bytes);
        assert_eq!(Vec::<f64>::decode(&mut Reader::new(&bytes)), None);
        assert_eq!(Vec::<bool>::decode(&mut Reader::new(&bytes)), None);
    }
}
