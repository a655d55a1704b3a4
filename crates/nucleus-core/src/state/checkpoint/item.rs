//! Values as bytes, little-endian, bit for bit. What is read is never trusted: it is a value, or nothing.

use nalgebra::Vector3;

/// A value that can be written and read back.
pub trait Item: Sized {
    /// Bytes of each value; nought where they differ in length.
    const SIZE: usize;
    /// Appends it.
    fn put(&self, out: &mut Vec<u8>);
    /// Reads it back; nothing where the bytes are none of it.
    fn take(from: &mut Reader<'_>) -> Option<Self>;
}

/// Bytes that have not been read yet.
#[derive(Debug, Clone)]
pub struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    /// Reads these bytes.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    /// The next bytes; nothing where there are not so many.
    pub fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (bytes, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(bytes)
    }

    /// Whether all has been read.
    pub fn is_at_end(&self) -> bool {
        self.0.is_empty()
    }
}

macro_rules! number {
    ($($number:ty),*) => { $(
        impl Item for $number {
            const SIZE: usize = size_of::<Self>();
            fn put(&self, out: &mut Vec<u8>) {
                out.extend_from_slice(&self.to_le_bytes());
            }
            fn take(from: &mut Reader<'_>) -> Option<Self> {
                Some(Self::from_le_bytes(from.bytes(size_of::<Self>())?.try_into().ok()?))
            }
        }
    )* };
}

number!(u8, u32, u64, i64, f32, f64);

impl Item for bool {
    const SIZE: usize = 1;
    fn put(&self, out: &mut Vec<u8>) {
        u8::from(*self).put(out);
    }
    fn take(from: &mut Reader<'_>) -> Option<Self> {
        match u8::take(from)? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }
}

impl<T: Item + Copy, const N: usize> Item for [T; N] {
    const SIZE: usize = N * T::SIZE;
    fn put(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|value| value.put(out));
    }
    fn take(from: &mut Reader<'_>) -> Option<Self> {
        let mut all = [T::take(from)?; N];
        for value in all.iter_mut().skip(1) {
            *value = T::take(from)?;
        }
        Some(all)
    }
}

impl<A: Item, B: Item> Item for (A, B) {
    const SIZE: usize = if A::SIZE == 0 || B::SIZE == 0 { 0 } else { A::SIZE + B::SIZE };
    fn put(&self, out: &mut Vec<u8>) {
        self.0.put(out);
        self.1.put(out);
    }
    fn take(from: &mut Reader<'_>) -> Option<Self> {
        Some((A::take(from)?, B::take(from)?))
    }
}

impl Item for Vector3<f64> {
    const SIZE: usize = <[f64; 3]>::SIZE;
    fn put(&self, out: &mut Vec<u8>) {
        <[f64; 3]>::from(*self).put(out);
    }
    fn take(from: &mut Reader<'_>) -> Option<Self> {
        <[f64; 3]>::take(from).map(Self::from)
    }
}

impl<T: Item> Item for Option<T> {
    const SIZE: usize = 0;
    fn put(&self, out: &mut Vec<u8>) {
        self.is_some().put(out);
        self.iter().for_each(|value| value.put(out));
    }
    fn take(from: &mut Reader<'_>) -> Option<Self> {
        if bool::take(from)? { T::take(from).map(Some) } else { Some(None) }
    }
}

/// Values that are taken apart in one go, while they are near.
const RUN: usize = 256;

/// How many, then the values; where all are of one size, byte by byte of all of them: the high bytes of numbers are
/// much alike, and pack well side by side.
impl<T: Item> Item for Vec<T> {
    const SIZE: usize = 0;
    fn put(&self, out: &mut Vec<u8>) {
        (self.len() as u64).put(out);
        if T::SIZE <= 1 {
            return self.iter().for_each(|value| value.put(out));
        }
        let begin = out.len();
        out.resize(begin + self.len() * T::SIZE, 0);
        let mut bytes = Vec::with_capacity(RUN * T::SIZE);
        for (run, values) in self.chunks(RUN).enumerate() {
            bytes.clear();
            values.iter().for_each(|value| value.put(&mut bytes));
            for plane in 0..T::SIZE {
                let from = begin + plane * self.len() + run * RUN;
                let column = bytes[plane..].iter().step_by(T::SIZE);
                out[from..from + values.len()].iter_mut().zip(column).for_each(|(to, &byte)| *to = byte);
            }
        }
    }
    fn take(from: &mut Reader<'_>) -> Option<Self> {
        let count = usize::try_from(u64::take(from)?).ok()?;
        if T::SIZE <= 1 {
            // No room is made for more than the bytes can hold.
            let mut all = Self::with_capacity(count.min(from.0.len()));
            for _ in 0..count {
                all.push(T::take(from)?);
            }
            return Some(all);
        }
        let planes = from.bytes(count.checked_mul(T::SIZE)?)?;
        let mut bytes = vec![0; T::SIZE];
        let value = |at: usize| {
            bytes.iter_mut().enumerate().for_each(|(plane, byte)| *byte = planes[plane * count + at]);
            T::take(&mut Reader(&bytes))
        };
        (0..count).map(value).collect()
    }
}

/// Says how a struct is written: field by field, all of them. One that is left out does not compile.
macro_rules! item {
    ([$($generics:tt)*] $type:ty { $($field:ident: $of:ty),* $(,)? }) => {
        impl<$($generics)*> $crate::state::checkpoint::Item for $type {
            const SIZE: usize = 0 $(+ <$of as $crate::state::checkpoint::Item>::SIZE)*;
            fn put(&self, out: &mut Vec<u8>) {
                let Self { $($field),* } = self;
                $($crate::state::checkpoint::Item::put($field, out);)*
            }
            fn take(from: &mut $crate::state::checkpoint::Reader<'_>) -> Option<Self> {
                Some(Self { $($field: <$of as $crate::state::checkpoint::Item>::take(from)?),* })
            }
        }
    };
}

pub(crate) use item;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_is_written_is_what_is_read(
            numbers in proptest::collection::vec((any::<u32>(), proptest::array::uniform3(any::<f64>())), 0..20),
            flags in proptest::collection::vec(any::<bool>(), 0..20),
            maybe: Option<u64>,
        ) {
            let mut bytes = Vec::new();
            numbers.put(&mut bytes);
            (flags.clone(), maybe).put(&mut bytes);
            let mut reader = Reader::new(&bytes);
            prop_assert_eq!(Vec::<(u32, [f64; 3])>::take(&mut reader), Some(numbers));
            prop_assert_eq!(<(Vec<bool>, Option<u64>)>::take(&mut reader), Some((flags, maybe)));
            prop_assert!(reader.is_at_end());
        }

        #[test]
        fn any_bytes_are_a_value_or_nothing(bytes in proptest::collection::vec(any::<u8>(), 0..64)) {
            Vec::<[f64; 3]>::take(&mut Reader::new(&bytes));
            Vec::<Vec<bool>>::take(&mut Reader::new(&bytes));
            <Option<Vec<(u8, Option<u32>)>> as Item>::take(&mut Reader::new(&bytes));
        }
    }

    #[test]
    fn a_count_beyond_all_bytes_is_refused_at_once() {
        let mut bytes = Vec::new();
        u64::MAX.put(&mut bytes);
        assert_eq!(Vec::<f64>::take(&mut Reader::new(&bytes)), None);
        assert_eq!(Vec::<bool>::take(&mut Reader::new(&bytes)), None);
    }
}
