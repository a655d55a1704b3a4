//! The factors of one map, from wherever the scene takes them.

use crate::attributes::{Attribute, Choice, Painting, Value};
use crate::graph::NodeId;
use crate::memory;
use crate::paint::{Expression, Point, Texture, read_numbers};

use super::maps::Map;
use super::objects::Compiler;

/// Maya's indices of `none`, `perVertex` and `texture`.
const NONE: Choice = Choice(0);
const PER_VERTEX: Choice = Choice(1);
const TEXTURE: Choice = Choice(2);

/// Larger factors than this are a mistake.
const MOST: f64 = 1e6;

/// A map of a cloth.
pub(super) struct Column {
    pub(super) cloth: NodeId,
    pub(super) mesh: NodeId,
    pub(super) points: usize,
    pub(super) map: &'static Map,
}

impl Compiler<'_> {
    /// Its factors, point by point; nothing where the map does not count, or is wrong, which has been said then.
    pub(super) fn column(&mut self, column: &Column) -> Option<Vec<f64>> {
        let Column { cloth, map, .. } = *column;
        self.warn_of_idle(column);
        let row = self.source_row(cloth, map)?;
        let held = if row == &map.values.row {
            self.start.held(cloth, map.values)
        } else {
            self.start.held(cloth, map.texture)
        };
        let found = match held? {
            Value::Floats(values) if !values.is_empty() => Ok(values),
            Value::Painting(Painting::File(file)) => {
                let path = self.scene.source.path(&file);
                let checked = self.check_file(&path, memory::NUMBER_BYTE);
                checked.and_then(|()| read_numbers(&path).map_err(|error| error.to_string()))
            }
            Value::Painting(Painting::Expression(text)) => self.painted(column, &text)?,
            Value::Painting(Painting::Texture(file)) => self.textured(column, &file)?,
            _ => return None,
        };
        let found = found.and_then(|factors| self.fitting(column, row, factors));
        match found {
            Ok(factors) => Some(factors),
            Err(message) => {
                let place = self.place(cloth, row);
                self.findings.error(&place, message);
                None
            }
        }
    }

    /// The attribute that a map takes its factors from; for messages.
    pub(super) fn source_of(&self, cloth: NodeId, map: &'static Map) -> &'static str {
        self.source_row(cloth, map).map_or(map.kind.row.name, |row| row.name)
    }

    fn source_row(&self, cloth: NodeId, map: &'static Map) -> Option<&'static Attribute> {
        match self.kind(cloth, map) {
            NONE => None,
            PER_VERTEX => Some(&map.values.row),
            _ => Some(&map.texture.row),
        }
    }

    /// The type of a map: as given, else by what else is given of the map. Of values and a texture the texture counts, which
    /// is Maya's default.
    fn kind(&self, cloth: NodeId, map: &'static Map) -> Choice {
        let given = |row: &'static Attribute| self.scene.graph.is_given_by_name(cloth, row.name);
        match given(&map.kind.row) {
            true => self.start.get(cloth, map.kind),
            false if given(&map.values.row) && !given(&map.texture.row) => PER_VERTEX,
            false => TEXTURE,
        }
    }

    fn place(&self, cloth: NodeId, row: &Attribute) -> std::ops::Range<usize> {
        self.scene.source.place(&format!("{}.{}", self.scene.graph.node(cloth).name(), row.name))
    }

    /// One factor for each point, all of them numbers that can be reckoned with.
    fn fitting(&self, column: &Column, row: &Attribute, factors: Vec<f64>) -> Result<Vec<f64>, String> {
        let graph = &self.scene.graph;
        let [cloth, mesh] = [column.cloth, column.mesh].map(|node| graph.node(node).name());
        let label = format!("`{}` of `{cloth}`", row.name);
        if factors.len() != column.points {
            let (values, points) = (factors.len(), column.points);
            return Err(format!("{label} has {values} values, but `{mesh}` has {points} points"));
        }
        match factors.iter().position(|factor| !(0.0..=MOST).contains(factor)) {
            None => Ok(factors),
            Some(point) if !factors[point].is_finite() => {
                Err(format!("{label} is not a finite number at point {point}"))
            }
            Some(point) => Err(format!(
                "{label} must be between 0 and {MOST}, but is {} at point {point}",
                factors[point]
            )),
        }
    }

    /// An expression at each point. Outside is nothing if the mesh has no place for it.
    fn painted(&mut self, column: &Column, text: &str) -> Option<Result<Vec<f64>, String>> {
        let expression = match Expression::parse(text) {
            Ok(expression) => expression,
            Err(error) => return Some(Err(error.to_string())),
        };
        let uvs = if expression.needs_uv() { Some(self.uvs(column)?) } else { None };
        let shape = self.geometry.shape(self.scene, column.mesh, self.findings)?.at(&self.start);
        let point = |(index, position): (usize, &nalgebra::Vector3<f64>)| Point {
            position: (*position).into(),
            uv: uvs.as_ref().and_then(|uvs| uvs.get(index)).copied().unwrap_or_default(),
            index,
            count: shape.len(),
        };
        Some(Ok(shape.iter().enumerate().map(|each| expression.at(&point(each))).collect()))
    }

    /// A texture at the texture coordinates of each point.
    fn textured(&mut self, column: &Column, file: &str) -> Option<Result<Vec<f64>, String>> {
        let texture = match Texture::read(&self.scene.source.path(file)) {
            Ok(texture) => texture,
            Err(error) => return Some(Err(error.to_string())),
        };
        Some(Ok(self.uvs(column)?.into_iter().map(|uv| texture.at(uv)).collect()))
    }

    /// The texture coordinates of all points; why there are none has been said then.
    fn uvs(&mut self, column: &Column) -> Option<Vec<[f64; 2]>> {
        let found = self.geometry.uvs(self.scene, column.mesh);
        let missing = match found {
            Ok(Some(uvs)) => match uvs.iter().position(Option::is_none) {
                None => return Some(uvs.into_iter().flatten().collect()),
                Some(point) => {
                    format!("point {point} of `{}` has none", self.scene.graph.node(column.mesh).name())
                }
            },
            Ok(None) => format!("`{}` has none", self.scene.graph.node(column.mesh).name()),
            Err(error) => error.to_string(),
        };
        let (name, source) =
            (self.scene.graph.node(column.cloth).name(), self.source_of(column.cloth, column.map));
        let message = format!("`{source}` of `{name}` asks for texture coordinates: {missing}");
        let place = self.scene.source.place(&format!("{name}.{source}"));
        let error = self.findings.error(&place, message);
        error.help("a polyPlane has them, and an OBJ file with `vt` lines and faces like `7/2`");
        None
    }

    /// Says what is set of a map and does not count.
    fn warn_of_idle(&mut self, column: &Column) {
        let Column { cloth, map, .. } = *column;
        let graph = &self.scene.graph;
        let kind = self.kind(cloth, map);
        let given = |row: &'static Attribute| graph.is_given_by_name(cloth, row.name);
        let mut idle = |row: &'static Attribute, why: String, help: String| {
            let name = graph.node(cloth).name();
            let place = self.scene.source.place(&format!("{name}.{}", row.name));
            let message = format!("`{}` of `{name}` has no effect: {why}", row.name);
            self.findings.warning(&place, message).help(help);
        };
        let (values, texture, type_name) = (&map.values.row, &map.texture.row, map.kind.row.name);
        let is_texture =
            matches!(self.start.held(cloth, map.texture), Some(Value::Painting(Painting::Texture(_))));
        if given(values) && kind != PER_VERTEX {
            let word = if kind == NONE { "none" } else { "texture" };
            idle(values, format!("`{type_name}` is {word}"), format!("write `{type_name}: perVertex`"));
        }
        if given(texture) && (kind == PER_VERTEX || kind == NONE) {
            let word = if kind == NONE { "none" } else { "perVertex" };
            idle(texture, format!("`{type_name}` is {word}"), format!("write `{type_name}: texture`"));
        } else if given(texture) && !is_texture {
            idle(
                texture,
                "it is no texture".to_owned(),
                format!("write `{}: texture(\"...\")`", texture.name),
            );
        }
        if kind == PER_VERTEX && !given(values) {
            let help = format!("give `{}`", values.name);
            idle(&map.kind.row, format!("there is no `{}`", values.name), help);
        }
    }
}
