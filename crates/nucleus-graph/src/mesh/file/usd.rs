//! USD stages, text or binary, with their references: meshes moved by their transforms, point caches, blend shapes and
//! skeletons. Frame f of the scene is time code f, or f seconds of frames if the stage has another rate.

mod prim;

use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

use nalgebra::Vector3;
use nucleus_core::Faces;
use openusd::ar::{Asset, DefaultResolver, ResolvedPath, Resolver};
use openusd::sdf::Value;
use openusd::usd::{Prim, PrimPredicate, Stage, TimeCode};

use super::error::Fault;
use super::source::{Frames, Source};
use crate::files;
use crate::memory::Size;
use crate::mesh::obj::CornerUvs;

use prim::{AnyPrim, MeshPrim, chain};

/// An opened stage.
pub(super) struct UsdFile {
    stage: Stage,
    meshes: Vec<MeshPrim>,
    /// Time codes for each frame of the scene.
    codes_per_frame: f64,
    /// The first frame of the scene.
    first: i64,
    metres_per_unit: Option<f64>,
    is_z_up: bool,
    moves: bool,
    size: Size,
}

/// Finds files as USD does, but opens only regular ones: a device has no end.
struct RegularFiles(DefaultResolver);

impl Resolver for RegularFiles {
    fn create_identifier(&self, asset_path: &str, anchor: Option<&ResolvedPath>) -> String {
        self.0.create_identifier(asset_path, anchor)
    }

    fn resolve(&self, asset_path: &str) -> Option<ResolvedPath> {
        self.0.resolve(asset_path)
    }

    fn resolve_for_new_asset(&self, _asset_path: &str) -> Option<ResolvedPath> {
        None
    }

    fn open_asset(&self, path: &ResolvedPath) -> io::Result<Box<dyn Asset>> {
        if fs::metadata(&**path).is_ok_and(|about| !about.is_file()) {
            return Err(io::Error::new(ErrorKind::InvalidInput, "not a regular file"));
        }
        self.0.open_asset(path)
    }
}

impl UsdFile {
    pub(super) fn open(path: &Path, object: &str, frames: Frames) -> Result<Self, Fault> {
        // A missing file is reported by the system's own words.
        files::open(path).map_err(Fault::Io)?;
        Self::read(path, object, frames)
            .map_err(|_| Fault::from("it is no valid USD file"))?
            .map_err(Fault::Malformed)
    }

    /// The outer error is the parser's, which may hold parts of the file.
    fn read(path: &Path, object: &str, frames: Frames) -> anyhow::Result<Result<Self, String>> {
        let absolute = std::path::absolute(path)?;
        let resolver = RegularFiles(DefaultResolver::new());
        let stage = Stage::builder().resolver(resolver).open(&absolute.to_string_lossy())?;
        let mut paths = Vec::new();
        stage.traverse(PrimPredicate::DEFAULT_PROXIES, |path| paths.push(path.clone()))?;
        if !stage.composition_errors().is_empty() {
            return Ok(Err("it refers to a file or a prim that cannot be read".to_owned()));
        }
        let mut meshes = Vec::new();
        for path in paths.into_iter().filter(|path| is_in(path.as_str(), object)) {
            let prim = stage.prim(path);
            if prim.type_name()?.as_deref() == Some("PointInstancer") && is_drawn(&prim)? {
                return Ok(Err("it has a PointInstancer, whose instances are not read: make them meshes, or name the prims \
                               to read with `object`"
                    .to_owned()));
            }
            if prim.type_name()?.as_deref() == Some("Mesh") && is_drawn(&prim)? {
                meshes.push(match MeshPrim::read(&stage, prim)? {
                    Ok(mesh) => mesh,
                    Err(fault) => return Ok(Err(fault)),
                });
            }
        }
        if meshes.is_empty() {
            return Ok(Err(match object {
                "" => "it has no mesh".to_owned(),
                _ => format!("it has no mesh at or below a prim `{object}`"),
            }));
        }
        let number =
            |name: &str| Ok::<_, anyhow::Error>(stage.stage_metadata(name)?.as_ref().and_then(number));
        let metres_per_unit = number("metersPerUnit")?.filter(|metres| *metres > 0.0 && metres.is_finite());
        let is_z_up =
            matches!(stage.stage_metadata("upAxis")?, Some(Value::Token(axis)) if axis.as_str() == "Z");
        let rate = Some(stage.time_codes_per_second()).filter(|rate| *rate > 0.0 && rate.is_finite());
        let mut file = Self {
            codes_per_frame: rate.unwrap_or(24.0) / frames.fps,
            first: frames.first,
            meshes,
            metres_per_unit,
            is_z_up,
            moves: false,
            size: Size::default(),
            stage,
        };
        file.moves = file.may_move()?;
        let start = file.time(frames.first);
        for mesh in &file.meshes {
            file.size.points += mesh.points(start)?.len() as u64;
            file.size.corners += mesh.ints("faceVertexIndices", start)?.len() as u64;
        }
        Ok(Ok(file))
    }

    fn time(&self, frame: i64) -> TimeCode {
        TimeCode::new(frame as f64 * self.codes_per_frame)
    }

    fn may_move(&self) -> anyhow::Result<bool> {
        for mesh in &self.meshes {
            if mesh.may_move()? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn read_faces(&self, time: TimeCode) -> anyhow::Result<Option<(Faces, Option<CornerUvs>)>> {
        let (mut faces, mut first) = (Faces::default(), 0);
        let mut uvs = Some(CornerUvs::default());
        for mesh in &self.meshes {
            let points = mesh.points(time)?.len();
            let counts = mesh.ints("faceVertexCounts", time)?;
            let indices = mesh.ints("faceVertexIndices", time)?;
            let (mut own, mut begin, mut order) = (Vec::new(), 0, Vec::new());
            let holes = mesh.ints("holeIndices", time)?;
            let reversed = mesh.is_clockwise(self.time(self.first))?;
            for (face, count) in (0..).zip(counts) {
                let end = usize::try_from(count).ok().and_then(|count| count.checked_add(begin));
                let Some(corners) = end.and_then(|end| indices.get(begin..end)) else { return Ok(None) };
                let places = begin..begin + corners.len();
                begin = places.end;
                // A face of one or two corners has no area, and a hole is no surface.
                if corners.len() < 3 || holes.contains(&face) {
                    continue;
                }
                own.clear();
                for &corner in corners {
                    match usize::try_from(corner).ok().filter(|corner| *corner < points) {
                        Some(corner) => own.push(first + corner as u32),
                        None => return Ok(None),
                    }
                }
                if reversed {
                    own.reverse();
                    order.extend(places.rev());
                } else {
                    order.extend(places);
                }
                faces.push(&own);
            }
            uvs = match (uvs, mesh.texture_coordinates(time, &indices)?) {
                (Some((mut values, mut corners)), Some((own, at))) => {
                    let before = values.len() as u32;
                    values.extend(own);
                    corners.extend(order.iter().map(|place| before + at[*place]));
                    Some((values, corners))
                }
                _ => None,
            };
            let Ok(next) = u32::try_from(first as usize + points) else { return Ok(None) };
            first = next;
        }
        Ok(Some((faces, uvs)))
    }
}

impl Source for UsdFile {
    fn size(&self) -> Size {
        self.size
    }

    fn moves(&self) -> bool {
        self.moves
    }

    fn metres_per_unit(&self) -> Option<f64> {
        self.metres_per_unit
    }

    fn faces(&self, frame: i64) -> Result<(Faces, Option<CornerUvs>), Fault> {
        let read = self.read_faces(self.time(frame)).map_err(|_| Fault::from("its faces cannot be read"))?;
        read.ok_or_else(|| "a face refers to a point that does not exist".into())
    }

    fn positions(&self, frame: i64) -> Result<Vec<Vector3<f64>>, Fault> {
        let mut all = Vec::new();
        for mesh in &self.meshes {
            let points = mesh.positions(&self.stage, self.time(frame));
            all.extend(points.map_err(|_| Fault::from("its points cannot be read"))?);
        }
        if self.is_z_up {
            all.iter_mut().for_each(|point| *point = Vector3::new(point.x, point.z, -point.y));
        }
        if all.iter().any(|point| !point.iter().all(|x| x.is_finite())) {
            return Err("a position is not a finite number".into());
        }
        Ok(all)
    }
}

/// Whether a prim lies at or below a prim of a name, or of a path.
fn is_in(path: &str, object: &str) -> bool {
    object.is_empty() || format!("{path}/").contains(&format!("/{}/", object.trim_matches('/')))
}

/// Whether a prim is visible, and no proxy and no guide.
fn is_drawn(prim: &Prim) -> anyhow::Result<bool> {
    for AnyPrim(prim) in chain(prim) {
        let purpose = prim.attribute("purpose").get::<Value>()?;
        if matches!(purpose, Some(Value::Token(purpose)) if ["proxy", "guide"].contains(&purpose.as_str())) {
            return Ok(false);
        }
        let visibility = prim.attribute("visibility").get::<Value>()?;
        if matches!(visibility, Some(Value::Token(word)) if word.as_str() == "invisible") {
            return Ok(false);
        }
    }
    Ok(true)
}

fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Double(number) => Some(*number),
        Value::Float(number) => Some(f64::from(*number)),
        _ => None,
    }
}
