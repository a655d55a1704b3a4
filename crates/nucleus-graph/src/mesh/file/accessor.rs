//! Numbers of a glTF accessor, with every offset checked against its buffer.

use gltf::accessor::DataType;
use gltf::accessor::sparse::IndexType;
use gltf::{Accessor, buffer};

use super::error::Fault;

/// The bytes of the buffers of a file, by index.
pub(super) struct Buffers(pub(super) Vec<Vec<u8>>);

impl Buffers {
    /// The numbers of an accessor, component by component. Normalized integers become fractions.
    pub(super) fn numbers(&self, accessor: &Accessor) -> Result<Vec<f64>, Fault> {
        self.checked(accessor).ok_or_else(|| Fault::from("an accessor lies outside its buffer"))
    }

    fn checked(&self, accessor: &Accessor) -> Option<Vec<f64>> {
        let width = accessor.dimensions().multiplicity();
        let number = Number { kind: accessor.data_type(), is_normalized: accessor.normalized() };
        let count = accessor.count();
        let mut values = match accessor.view() {
            Some(view) => self.rows(&view, accessor.offset(), count, width, number)?,
            // Without a view all numbers are 0; the sum of all buffers bounds what such an accessor may ask for.
            None if count <= self.0.iter().map(Vec::len).sum() => vec![0.0; count.checked_mul(width)?],
            None => return None,
        };
        if let Some(sparse) = accessor.sparse() {
            let kind = match sparse.indices().index_type() {
                IndexType::U8 => DataType::U8,
                IndexType::U16 => DataType::U16,
                IndexType::U32 => DataType::U32,
            };
            let index = Number { kind, is_normalized: false };
            let (places, given) = (sparse.indices(), sparse.values());
            let places = self.rows(&places.view(), places.offset(), sparse.count(), 1, index)?;
            let given = self.rows(&given.view(), given.offset(), sparse.count(), width, number)?;
            for (place, row) in places.into_iter().zip(given.chunks_exact(width)) {
                let begin = (place as usize).checked_mul(width)?;
                values.get_mut(begin..begin + width)?.copy_from_slice(row);
            }
        }
        Some(values)
    }

    fn rows(
        &self,
        view: &buffer::View,
        offset: usize,
        count: usize,
        width: usize,
        number: Number,
    ) -> Option<Vec<f64>> {
        let end = view.offset().checked_add(view.length())?;
        let bytes = self.0.get(view.buffer().index())?.get(view.offset()..end)?.get(offset..)?;
        let size = number.kind.size();
        let row = size * width;
        let stride = view.stride().unwrap_or(row);
        let needed =
            count.checked_sub(1).map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(row))?;
        if bytes.len() < needed {
            return None;
        }
        let rows = (0..count).flat_map(|k| bytes[k * stride..k * stride + row].chunks_exact(size));
        Some(rows.map(|bytes| number.of(bytes)).collect())
    }
}

/// A type of numbers.
#[derive(Clone, Copy)]
struct Number {
    kind: DataType,
    is_normalized: bool,
}

impl Number {
    /// The number in little-endian bytes.
    fn of(self, bytes: &[u8]) -> f64 {
        let mut word = [0; 4];
        word[..bytes.len()].copy_from_slice(bytes);
        let bits = u32::from_le_bytes(word);
        let (value, largest) = match self.kind {
            DataType::I8 => (f64::from(bits as u8 as i8), 127.0),
            DataType::U8 => (f64::from(bits), 255.0),
            DataType::I16 => (f64::from(bits as u16 as i16), 32767.0),
            DataType::U16 => (f64::from(bits), 65535.0),
            DataType::U32 => (f64::from(bits), 1.0),
            DataType::F32 => (f64::from(f32::from_bits(bits)), 1.0),
        };
        if self.is_normalized { (value / largest).max(-1.0) } else { value }
    }
}
