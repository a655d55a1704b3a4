//! The values of one vertex map: from a list, a file, an expression, a selection or a texture.

use crate::attributes::{Attribute, Choice, ElementKind, Key, Painting, SelectedValues, Value};
use crate::graph::NodeId;
use crate::memory;
use crate::paint::{Expression, Point, Texture, read_numbers};

use super::compiler::Compiler;
use super::select::{Elements, Selected};

/// `...MapType: none`.
const NONE: Choice = Choice(0);
/// `...MapType: perVertex`.
const PER_VERTEX: Choice = Choice(1);
/// `...MapType: texture`.
const TEXTURE: Choice = Choice(2);

/// The maximum factor.
const MAX_FACTOR: f64 = 1e6;

/// The three attributes of a vertex map.
pub(super) struct MapAttributes {
    /// A value for each point.
    pub(super) values: &'static Key<Vec<f64>>,
    /// A texture.
    pub(super) texture: &'static Key<f64>,
    /// Which of the two applies.
    pub(super) kind: &'static Key<Choice>,
}

/// A vertex map of a cloth.
pub(super) struct MapOfCloth {
    pub(super) cloth: NodeId,
    pub(super) mesh: NodeId,
    /// Count of the points of the mesh.
    pub(super) points: usize,
    pub(super) map: &'static MapAttributes,
}

impl Compiler<'_> {
    /// One factor per point; `None` where the map has no effect, or after an error, which is reported.
    pub(super) fn map_values(&mut self, map_of: &MapOfCloth) -> Option<Vec<f64>> {
        let MapOfCloth { cloth, map, .. } = *map_of;
        self.warn_of_unused(map_of);
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
            Value::Painting(Painting::Expression(text)) => self.evaluated(map_of, &text)?,
            Value::Painting(Painting::Selection(text)) => self.selected_values(map_of, &text)?,
            Value::Painting(Painting::Texture(file)) => self.sampled(map_of, &file)?,
            _ => return None,
        };
        let found = found.and_then(|factors| self.checked(map_of, row, factors));
        match found {
            Ok(factors) => Some(factors),
            Err(message) => {
                let place = self.place(cloth, row);
                self.findings.error(&place, message);
                None
            }
        }
    }

    /// The name of the attribute that holds the values of a map, for messages.
    pub(super) fn source_attribute(&self, cloth: NodeId, map: &'static MapAttributes) -> &'static str {
        self.source_row(cloth, map).map_or(map.kind.row.name, |row| row.name)
    }

    fn source_row(&self, cloth: NodeId, map: &'static MapAttributes) -> Option<&'static Attribute> {
        match self.map_kind(cloth, map) {
            NONE => None,
            PER_VERTEX => Some(&map.values.row),
            _ => Some(&map.texture.row),
        }
    }

    /// The type of a map: as given, else by the source that is given. Where both are, it is `texture`, Maya's default.
    fn map_kind(&self, cloth: NodeId, map: &'static MapAttributes) -> Choice {
        let given = |row: &'static Attribute| self.scene.graph.is_given_by_name(cloth, row.name);
        match given(&map.kind.row) {
            true => self.start.get(cloth, map.kind),
            false if given(&map.values.row) && !given(&map.texture.row) => PER_VERTEX,
            false => TEXTURE,
        }
    }

    /// The factors, if there is one per point and each is between 0 and the maximum; else a message.
    fn checked(&self, map_of: &MapOfCloth, row: &Attribute, factors: Vec<f64>) -> Result<Vec<f64>, String> {
        let graph = &self.scene.graph;
        let [cloth, mesh] = [map_of.cloth, map_of.mesh].map(|node| graph.node(node).name());
        let label = format!("`{}` of `{cloth}`", row.name);
        if factors.len() != map_of.points {
            let (values, points) = (factors.len(), map_of.points);
            return Err(format!("{label} has {values} values, but `{mesh}` has {points} points"));
        }
        match factors.iter().position(|factor| !(0.0..=MAX_FACTOR).contains(factor)) {
            None => Ok(factors),
            Some(point) if !factors[point].is_finite() => {
                Err(format!("{label} is not a finite number at point {point}"))
            }
            Some(point) => Err(format!(
                "{label} must be between 0 and {MAX_FACTOR}, but is {} at point {point}",
                factors[point]
            )),
        }
    }

    /// An expression evaluated at each point. The outer `None` means that the mesh, or its texture coordinates, are
    /// missing, which is reported.
    fn evaluated(&mut self, map_of: &MapOfCloth, text: &str) -> Option<Result<Vec<f64>, String>> {
        let expression = match Expression::parse(text) {
            Ok(expression) => expression,
            Err(error) => return Some(Err(error.to_string())),
        };
        let uvs = if expression.needs_uv() { Some(self.uvs(map_of)?) } else { None };
        let positions = self.geometry.animated(self.scene, map_of.mesh, self.findings)?.at(&self.start);
        let point = |(index, position): (usize, &nalgebra::Vector3<f64>)| Point {
            position: (*position).into(),
            uv: uvs.as_ref().and_then(|uvs| uvs.get(index)).copied().unwrap_or_default(),
            index,
            count: positions.len(),
        };
        Some(Ok(positions.iter().enumerate().map(|each| expression.at(&point(each))).collect()))
    }

    /// The values of a selection of points. The outer `None` means that the mesh is missing, which is reported.
    fn selected_values(&mut self, map_of: &MapOfCloth, text: &str) -> Option<Result<Vec<f64>, String>> {
        let SelectedValues { selections, values: [inside, outside] } = match SelectedValues::parse(text) {
            Ok(parsed) => parsed,
            Err(message) => return Some(Err(message)),
        };
        let surface = self.geometry.surface(self.scene, map_of.mesh, self.findings)?;
        let (faces, count) = (surface.faces.clone(), surface.positions.len());
        let elements = Elements::new(&faces, count);
        let of = Selected { owner: map_of.cloth, object: map_of.cloth, mesh: map_of.mesh };
        let mut values = vec![outside; count];
        for which in &selections {
            match self.chosen(&of, ElementKind::Point, which, &elements) {
                Ok(points) if points.is_empty() => return Some(Err(format!("`{which}` selects no points"))),
                Ok(points) => points.into_iter().for_each(|point| values[point as usize] = inside),
                Err(message) => return Some(Err(format!("cannot select `{which}`: {message}"))),
            }
        }
        Some(Ok(values))
    }

    /// A texture sampled at the texture coordinates of each point.
    fn sampled(&mut self, map_of: &MapOfCloth, file: &str) -> Option<Result<Vec<f64>, String>> {
        let texture = match Texture::read(&self.scene.source.path(file)) {
            Ok(texture) => texture,
            Err(error) => return Some(Err(error.to_string())),
        };
        Some(Ok(self.uvs(map_of)?.into_iter().map(|uv| texture.at(uv)).collect()))
    }

    /// The texture coordinates of all points; reports why if there are none.
    fn uvs(&mut self, map_of: &MapOfCloth) -> Option<Vec<[f64; 2]>> {
        let found = self.geometry.uvs(self.scene, map_of.mesh);
        let missing = match found {
            Ok(Some(uvs)) => match uvs.iter().position(Option::is_none) {
                None => return Some(uvs.into_iter().flatten().collect()),
                Some(point) => {
                    format!("point {point} of `{}` has none", self.scene.graph.node(map_of.mesh).name())
                }
            },
            Ok(None) => format!("`{}` has none", self.scene.graph.node(map_of.mesh).name()),
            Err(error) => error.to_string(),
        };
        let (name, source) =
            (self.scene.graph.node(map_of.cloth).name(), self.source_attribute(map_of.cloth, map_of.map));
        let message = format!("`{source}` of `{name}` asks for texture coordinates: {missing}");
        let place = self.scene.source.place(&format!("{name}.{source}"));
        let error = self.findings.error(&place, message);
        error.help("a primitive has them, and an OBJ file with `vt` lines and faces like `7/2`");
        None
    }

    /// Warns of attributes of a map that are given and have no effect.
    fn warn_of_unused(&mut self, map_of: &MapOfCloth) {
        let MapOfCloth { cloth, map, .. } = *map_of;
        let graph = &self.scene.graph;
        let kind = self.map_kind(cloth, map);
        let given = |row: &'static Attribute| graph.is_given_by_name(cloth, row.name);
        let mut unused = |row: &'static Attribute, why: String, help: String| {
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
            unused(values, format!("`{type_name}` is {word}"), format!("write `{type_name}: perVertex`"));
        }
        if given(texture) && (kind == PER_VERTEX || kind == NONE) {
            let word = if kind == NONE { "none" } else { "perVertex" };
            unused(texture, format!("`{type_name}` is {word}"), format!("write `{type_name}: texture`"));
        } else if given(texture) && !is_texture {
            unused(
                texture,
                "it is no texture".to_owned(),
                format!("write `{}: texture(\"...\")`", texture.name),
            );
        }
        if kind == PER_VERTEX && !given(values) {
            let help = format!("give `{}`", values.name);
            unused(&map.kind.row, format!("there is no `{}`", values.name), help);
        }
    }
}
