//! Rows of three numbers that numpy reads in place.
//!
//! An array of numpy refers to memory of Rust and keeps it alive. The memory never changes while an array refers to it: the
//! simulation writes the next frame into other memory, or into the same if nothing refers to it any more.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Rows of three 32-bit floats, read-only. `numpy.asarray` makes an array of it without a copy.
#[pyclass(frozen, module = "nucleus._nucleus")]
pub struct Rows(pub Arc<Vec<[f32; 3]>>);

#[pymethods]
impl Rows {
    fn __len__(&self) -> usize {
        self.0.len()
    }

    /// The array interface of numpy, version 3. It holds an address and needs no code of numpy.
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("shape", (self.0.len(), 3))?;
        interface.set_item("typestr", if cfg!(target_endian = "little") { "<f4" } else { ">f4" })?;
        let is_read_only = true;
        interface.set_item("data", (self.0.as_ptr() as usize, is_read_only))?;
        Ok(interface)
    }
}

/// Memory for one frame of an object, written anew for each frame.
#[derive(Debug, Default)]
pub struct Buffer(Arc<Vec<[f32; 3]>>);

impl Buffer {
    /// Fills the buffer, in other memory if an array still refers to the last frame.
    pub fn fill(&mut self, fill: impl FnOnce(&mut Vec<[f32; 3]>)) -> Rows {
        match Arc::get_mut(&mut self.0) {
            Some(free) => fill(free),
            None => {
                let mut fresh = Vec::with_capacity(self.0.len());
                fill(&mut fresh);
                self.0 = Arc::new(fresh);
            }
        }
        Rows(Arc::clone(&self.0))
    }
}
