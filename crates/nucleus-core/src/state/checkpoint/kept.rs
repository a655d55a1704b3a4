//! What of a struct that the model makes is kept, and what is made anew.

use super::item::{Item, Reader};

/// A part of a solver: made from the model, then filled in place.
pub trait Kept {
    /// Appends what is kept.
    fn save(&self, out: &mut Vec<u8>);
    /// Fills in what was kept; nothing where the bytes do not fit.
    fn load(&mut self, from: &mut Reader<'_>) -> Option<()>;
}

/// Parts one by one: as many as the model has.
impl<T: Kept> Kept for Vec<T> {
    fn save(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|part| part.save(out));
    }
    fn load(&mut self, from: &mut Reader<'_>) -> Option<()> {
        self.iter_mut().try_for_each(|part| part.load(from))
    }
}

/// A part that the model has or has not.
impl<T: Kept> Kept for Option<T> {
    fn save(&self, out: &mut Vec<u8>) {
        self.iter().for_each(|part| part.save(out));
    }
    fn load(&mut self, from: &mut Reader<'_>) -> Option<()> {
        self.iter_mut().try_for_each(|part| part.load(from))
    }
}

/// Reads a column, whose length the model has fixed.
pub fn load_column<T: Item>(column: &mut Vec<T>, from: &mut Reader<'_>) -> Option<()> {
    let read = Vec::take(from)?;
    (read.len() == column.len()).then(|| *column = read)
}

/// Says of every field of a struct what becomes of it; one that is not named does not compile.
///
/// `columns` are as long as the model says; `values` may be of any length; `parts` say for themselves what they keep;
/// what is `anew` follows from the model and the rest, or is written before it is read in every frame.
macro_rules! kept {
    (
        [$($generics:tt)*] $type:ty {
            columns: [$($column:ident),*], values: [$($value:ident),*], parts: [$($part:ident),*],
            anew: [$($anew:ident),*] $(,)?
        }
    ) => {
        impl<$($generics)*> $crate::state::checkpoint::Kept for $type {
            fn save(&self, out: &mut Vec<u8>) {
                let Self { $($column,)* $($value,)* $($part,)* $($anew: _,)* } = self;
                $($crate::state::checkpoint::Item::put($column, out);)*
                $($crate::state::checkpoint::Item::put($value, out);)*
                $($crate::state::checkpoint::Kept::save($part, out);)*
            }
            fn load(&mut self, from: &mut $crate::state::checkpoint::Reader<'_>) -> Option<()> {
                $($crate::state::checkpoint::load_column(&mut self.$column, from)?;)*
                $(self.$value = $crate::state::checkpoint::Item::take(from)?;)*
                $($crate::state::checkpoint::Kept::load(&mut self.$part, from)?;)*
                Some(())
            }
        }
    };
}

pub(crate) use kept;
