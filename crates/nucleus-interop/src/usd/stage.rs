//! A USD stage as it is written: prims, one inside the other, with their attributes in order.

/// The metadata of a stage.
pub(super) struct Head {
    pub title: String,
    pub metres_per_unit: f64,
    /// First and last time, in frames.
    pub times: [f64; 2],
    pub fps: f64,
}

/// A prim.
#[derive(Clone, Copy)]
pub(super) struct Prim<'a> {
    pub type_name: &'static str,
    pub name: &'a str,
    pub schemas: &'a [&'static str],
    pub kind: Option<&'static str>,
}

impl<'a> Prim<'a> {
    pub fn of(type_name: &'static str, name: &'a str) -> Self {
        Self { type_name, name, schemas: &[], kind: None }
    }
}

/// An attribute without its value.
#[derive(Clone, Copy)]
pub(super) struct Attribute<'a> {
    pub type_name: &'a str,
    pub name: &'a str,
    /// Whether it cannot change over time.
    pub is_uniform: bool,
    /// Whether no schema defines it.
    pub is_custom: bool,
    pub interpolation: Option<&'static str>,
}

impl<'a> Attribute<'a> {
    pub fn of(type_name: &'a str, name: &'a str) -> Self {
        Self { type_name, name, is_uniform: false, is_custom: false, interpolation: None }
    }

    pub fn uniform(type_name: &'a str, name: &'a str) -> Self {
        Self { is_uniform: true, ..Self::of(type_name, name) }
    }

    pub fn interpolated(self, interpolation: &'static str) -> Self {
        Self { interpolation: Some(interpolation), ..self }
    }
}

/// A value of an attribute.
pub(super) enum Value<'a> {
    Bool(bool),
    Token(&'a str),
    Tokens(&'a [&'a str]),
    Text(&'a str),
    Float(f32),
    Vec2([f32; 2]),
    Vec3([f32; 3]),
    Matrix([[f64; 4]; 4]),
    Ints(&'a [u32]),
    Int64s(&'a [u64]),
    Floats(&'a [f32]),
    Vec2s(&'a [[f32; 2]]),
    Vec3s(&'a [[f32; 3]]),
    /// Quaternions x, y, z, w.
    Quaternions(&'a [[f32; 4]]),
}

/// Takes up a stage part by part, so that no more than one sample is in memory.
pub(super) trait Stage {
    /// The metadata, before everything else.
    fn head(&mut self, head: &Head);
    /// Begins a prim in the current one.
    fn begin(&mut self, prim: &Prim);
    /// Ends the current prim.
    fn end(&mut self);
    /// An attribute that does not change.
    fn attribute(&mut self, attribute: &Attribute, value: &Value);
    /// An attribute without a value.
    fn declare(&mut self, attribute: &Attribute);
    /// An attribute that is connected to another one.
    fn connect(&mut self, attribute: &Attribute, target: &str);
    /// A relationship to a prim.
    fn relate(&mut self, name: &str, target: &str);
    /// Begins an attribute that changes.
    fn begin_samples(&mut self, attribute: &Attribute);
    /// Its value at a time, in frames; times ascend.
    fn sample(&mut self, time: f64, value: &Value);
    /// Ends it.
    fn end_samples(&mut self);
    /// Whether a write has failed, after which further work is wasted.
    fn has_failed(&self) -> bool;
}
