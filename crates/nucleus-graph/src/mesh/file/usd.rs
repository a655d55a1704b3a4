//! USD stages, text or binary, with their references: meshes moved by their transforms, point caches, blend shapes and
//! skeletons. Frame f of the scene is time code f, or f seconds of frames if the stage has another rate.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::Path;

use nalgebra::{Matrix4, Vector3};
use nucleus_core::Faces;
use openusd::ar::{Asset, DefaultResolver, ResolvedPath, Resolver};
use openusd::gf::{Matrix4d, Vec3f};
use openusd::schemas::geom::{Imageable, Xformable};
use openusd::schemas::skel::skinning::resolve_blend_shape_offsets;
use openusd::schemas::skel::{
    AnimMapper, BlendShape, SkelAnimQuery, SkelBindingAPI, Skeleton, SkeletonResolver, SkinningResolver,
};
use openusd::sdf::{self, Value};
use openusd::usd::{Prim, PrimPredicate, SchemaBase, SchemaKind, Stage, TimeCode};

use super::deform::{Influences, transform};
use super::error::Fault;
use super::source::{Frames, Source};
use crate::files;
use crate::memory::Size;
use crate::mesh::obj::CornerUvs;

/// An opened stage.
pub(super) struct UsdFile {
    stage: Stage,
    meshes: Vec<MeshPrim>,
    /// Time codes for each frame of the scene.
    codes_per_frame: f64,
    metres_per_unit: Option<f64>,
    is_z_up: bool,
    moves: bool,
    size: Size,
}

struct MeshPrim {
    prim: Prim,
    /// From the root to the mesh.
    chain: Vec<AnyPrim>,
    is_left_handed: bool,
    shapes: Vec<Shape>,
    animation: Option<SkelAnimQuery>,
    skin: Option<Skin>,
}

/// A blend shape of a mesh.
struct Shape {
    /// Its index among the weights of the animation.
    weight: usize,
    offsets: Vec<Vec3f>,
    /// The points that move; empty for all.
    points: Vec<i32>,
    between: Vec<(f32, Vec<Vec3f>)>,
}

struct Skin {
    skeleton: SkeletonResolver,
    /// From the root to the skeleton.
    chain: Vec<AnyPrim>,
    resolver: SkinningResolver,
    influences: Influences,
    /// From joints of the animation to those of the skeleton.
    joints: Option<AnimMapper>,
}

/// Any prim, as one that may have a transform.
struct AnyPrim(Prim);

impl SchemaBase for AnyPrim {
    const KIND: SchemaKind = SchemaKind::AbstractBase;

    fn prim(&self) -> &Prim {
        &self.0
    }
}
impl Imageable for AnyPrim {}
impl Xformable for AnyPrim {}

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
            for count in counts {
                let end = usize::try_from(count).ok().and_then(|count| count.checked_add(begin));
                let Some(corners) = end.and_then(|end| indices.get(begin..end)) else { return Ok(None) };
                let places = begin..begin + corners.len();
                begin = places.end;
                // A face of one or two corners has no area.
                if corners.len() < 3 {
                    continue;
                }
                own.clear();
                for &corner in corners {
                    match usize::try_from(corner).ok().filter(|corner| *corner < points) {
                        Some(corner) => own.push(first + corner as u32),
                        None => return Ok(None),
                    }
                }
                let reversed = mesh.is_left_handed;
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

impl MeshPrim {
    fn read(stage: &Stage, prim: Prim) -> anyhow::Result<Result<Self, String>> {
        let orientation = prim.attribute("orientation").get::<Value>()?;
        let mut mesh = Self {
            chain: chain(&prim),
            is_left_handed: matches!(orientation, Some(Value::Token(hand)) if hand.as_str() == "leftHanded"),
            shapes: Vec::new(),
            animation: None,
            skin: None,
            prim,
        };
        let Some(binding) = SkelBindingAPI::get(stage, mesh.prim.path().clone())? else {
            return Ok(Ok(mesh));
        };
        let skeleton = match binding.inherited_skeleton()? {
            Some(path) => Skeleton::get(stage, path)?,
            None => None,
        };
        let of_skeleton = match &skeleton {
            Some(skeleton) => SkelBindingAPI::get(stage, skeleton.path().clone())?,
            None => None,
        };
        let source = match (binding.inherited_animation_source()?, of_skeleton) {
            (None, Some(own)) => own.inherited_animation_source()?,
            (source, _) => source,
        };
        mesh.animation = match source {
            Some(path) => SkelAnimQuery::new(stage, path)?,
            None => None,
        };
        mesh.shapes = mesh.read_shapes(stage, &binding)?;
        if let Some(skeleton) = skeleton.filter(|_| !matches!(binding.joint_indices().as_deref(), Ok([]))) {
            mesh.skin = mesh.read_skin(&binding, &skeleton)?;
            if mesh.skin.is_none() {
                return Ok(Err(
                    "the joints of a skinned mesh do not fit its points or its skeleton".to_owned()
                ));
            }
        }
        Ok(Ok(mesh))
    }

    fn read_shapes(&self, stage: &Stage, binding: &SkelBindingAPI) -> anyhow::Result<Vec<Shape>> {
        let names = binding.blend_shapes()?;
        let order = self.animation.as_ref().map_or(&[][..], SkelAnimQuery::blend_shape_order);
        let mut shapes = Vec::new();
        for (name, target) in names.iter().zip(binding.blend_shape_targets()?) {
            let Some(weight) = order.iter().position(|other| other == name) else { continue };
            let Some(shape) = BlendShape::get(stage, target)? else { continue };
            let between = shape.inbetweens()?.into_iter();
            shapes.push(Shape {
                weight,
                offsets: shape.offsets()?,
                points: shape.point_indices()?,
                between: between.filter_map(|between| Some((between.weight?, between.offsets))).collect(),
            });
        }
        Ok(shapes)
    }

    fn read_skin(&self, binding: &SkelBindingAPI, skeleton: &Skeleton) -> anyhow::Result<Option<Skin>> {
        let resolved = SkeletonResolver::from_skeleton(skeleton)?;
        let joints = resolved.joint_order();
        let fits = resolved.joint_world_bind_transforms().len() == joints.len()
            && resolved.rest_pose_local().len() == joints.len()
            && resolved.topology().validate().is_ok();
        if !fits {
            return Ok(None);
        }
        let resolver = SkinningResolver::from_binding(binding, joints)?;
        let points = self.points(TimeCode::EARLIEST)?.len();
        let mut indices: Vec<u32> =
            binding.joint_indices()?.iter().map(|joint| u32::try_from(*joint).unwrap_or(u32::MAX)).collect();
        let mut weights: Vec<f64> = binding.joint_weights()?.into_iter().map(f64::from).collect();
        if resolver.is_rigidly_deformed() {
            (indices, weights) = (indices.repeat(points), weights.repeat(points));
        }
        let Some(influences) = Influences::new(indices, weights, points, resolver.joint_order_len()) else {
            return Ok(None);
        };
        let mapper =
            self.animation.as_ref().map(|animation| AnimMapper::new(animation.joint_order(), joints));
        Ok(Some(Skin {
            chain: chain(skeleton.prim()),
            resolver,
            influences,
            joints: mapper,
            skeleton: resolved,
        }))
    }

    fn may_move(&self) -> anyhow::Result<bool> {
        let skeleton = self.skin.iter().flat_map(|skin| &skin.chain);
        for AnyPrim(prim) in self.chain.iter().chain(skeleton) {
            for attribute in prim.attributes()? {
                let path = attribute.path().as_str();
                let name = path.rsplit('.').next().unwrap_or_default();
                if (name == "points" || name.starts_with("xformOp:"))
                    && attribute.value_might_be_time_varying()?
                {
                    return Ok(true);
                }
            }
        }
        let animated = |animation: &SkelAnimQuery| {
            (self.skin.is_some() && animation.joint_transforms_might_be_time_varying())
                || (!self.shapes.is_empty() && animation.blend_shape_weights_might_be_time_varying())
        };
        Ok(self.animation.as_ref().is_some_and(animated))
    }

    fn points(&self, time: TimeCode) -> anyhow::Result<Vec<Vector3<f64>>> {
        let of_floats = |p: Vec3f| Vector3::new(p.x.into(), p.y.into(), p.z.into());
        Ok(match self.prim.attribute("points").get_at::<Value>(time)? {
            Some(Value::Vec3fVec(points)) => points.into_iter().map(of_floats).collect(),
            Some(Value::Vec3dVec(points)) => {
                points.into_iter().map(|p| Vector3::new(p.x, p.y, p.z)).collect()
            }
            _ => Vec::new(),
        })
    }

    fn ints(&self, name: &'static str, time: TimeCode) -> anyhow::Result<Vec<i32>> {
        Ok(match self.prim.attribute(name).get_at::<Value>(time)? {
            Some(Value::IntVec(values)) => values,
            _ => Vec::new(),
        })
    }

    /// Texture coordinates, and the index of those of each corner of the file.
    fn texture_coordinates(&self, time: TimeCode, corners: &[i32]) -> anyhow::Result<Option<CornerUvs>> {
        let attribute = self.prim.attribute("primvars:st");
        let values: Vec<[f64; 2]> = match attribute.get_at::<Value>(time)? {
            Some(Value::Vec2fVec(uvs)) => uvs.into_iter().map(|uv| [uv.x.into(), uv.y.into()]).collect(),
            Some(Value::Vec2dVec(uvs)) => uvs.into_iter().map(|uv| [uv.x, uv.y]).collect(),
            _ => return Ok(None),
        };
        let interpolation = attribute.get_metadata::<Value>("interpolation")?;
        let is_per_corner =
            matches!(interpolation, Some(Value::Token(kind)) if kind.as_str() == "faceVarying");
        let indices = self.ints("primvars:st:indices", time)?;
        let element =
            |corner: usize| if is_per_corner { Some(corner) } else { usize::try_from(corners[corner]).ok() };
        let at = |corner: usize| {
            let element = element(corner)?;
            let index =
                if indices.is_empty() { element } else { usize::try_from(*indices.get(element)?).ok()? };
            (index < values.len()).then_some(index as u32)
        };
        let found: Option<Vec<u32>> = (0..corners.len()).map(at).collect();
        Ok(found.map(|found| (values, found)))
    }

    /// Its points in the world: blend shapes, then the skin or its transform.
    fn positions(&self, stage: &Stage, time: TimeCode) -> anyhow::Result<Vec<Vector3<f64>>> {
        let mut points = self.points(time)?;
        if let Some(animation) = self.animation.as_ref().filter(|_| !self.shapes.is_empty()) {
            let weights = animation.compute_blend_shape_weights(stage, time)?;
            self.shapes
                .iter()
                .for_each(|shape| shape.add_to(&mut points, weights.get(shape.weight).copied()));
        }
        let world = match &self.skin {
            None => world(&self.chain, time)?,
            Some(skin) => {
                let bones = skin.bones(stage, self.animation.as_ref(), time)?;
                skin.influences.skin(&mut points, &bones);
                world(&skin.chain, time)?
            }
        };
        points.iter_mut().for_each(|point| *point = transform(&world, point));
        Ok(points)
    }
}

impl Shape {
    fn add_to(&self, points: &mut [Vector3<f64>], weight: Option<f32>) {
        let Some(weight) = weight.filter(|weight| *weight != 0.0) else { return };
        let between: Vec<(f32, &[Vec3f])> =
            self.between.iter().map(|(weight, offsets)| (*weight, offsets.as_slice())).collect();
        let resolved = match between.as_slice() {
            [] => self.offsets.iter().map(|offset| *offset * weight).collect(),
            between => resolve_blend_shape_offsets(weight, between, &self.offsets),
        };
        for (k, offset) in resolved.iter().enumerate() {
            let point = if self.points.is_empty() {
                Some(k)
            } else {
                self.points.get(k).map(|point| *point as usize)
            };
            if let Some(point) = point.and_then(|point| points.get_mut(point)) {
                *point += Vector3::new(offset.x, offset.y, offset.z).map(f64::from);
            }
        }
    }
}

impl Skin {
    /// The matrix of each joint of the mesh, from the mesh at rest to the space of the skeleton.
    fn bones(
        &self,
        stage: &Stage,
        animation: Option<&SkelAnimQuery>,
        time: TimeCode,
    ) -> anyhow::Result<Vec<Matrix4<f64>>> {
        let mut local = self.skeleton.rest_pose_local().to_vec();
        if let Some((animation, joints)) = animation.zip(self.joints.as_ref()) {
            let posed = animation.compute_joint_local_transforms(stage, time)?;
            for (joint, matrix) in local.iter_mut().enumerate() {
                if let Some(own) = joints.source_index(joint).and_then(|source| posed.get(source)) {
                    *matrix = *own;
                }
            }
        }
        let moved = self.skeleton.compute_skinning_transforms_from_local(&local, Matrix4d::IDENTITY);
        let bind = matrix(&self.resolver.geom_bind_transform());
        Ok(self.resolver.remap_skinning_xforms(&moved).iter().map(|joint| matrix(joint) * bind).collect())
    }
}

/// Whether a prim lies at or below a prim of a name, or of a path.
fn is_in(path: &str, object: &str) -> bool {
    object.is_empty() || format!("{path}/").contains(&format!("/{}/", object.trim_matches('/')))
}

/// Whether a prim is no proxy and no guide.
fn is_drawn(prim: &Prim) -> anyhow::Result<bool> {
    for AnyPrim(prim) in chain(prim) {
        let purpose = prim.attribute("purpose").get::<Value>()?;
        if matches!(purpose, Some(Value::Token(purpose)) if ["proxy", "guide"].contains(&purpose.as_str())) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The prims from the root to a prim.
fn chain(prim: &Prim) -> Vec<AnyPrim> {
    let mut chain = Vec::new();
    let mut path = Some(prim.path().clone());
    while let Some(own) = path.filter(|path| !path.is_abs_root()) {
        path = sdf::Path::parent(&own);
        chain.push(AnyPrim(prim.stage().prim(own)));
    }
    chain.reverse();
    chain
}

/// The matrix from a prim's space to the world.
fn world(chain: &[AnyPrim], time: TimeCode) -> anyhow::Result<Matrix4<f64>> {
    let mut world = Matrix4::identity();
    for prim in chain {
        let local = matrix(&prim.local_to_parent_transform(time)?);
        world = if prim.resets_xform_stack()? { local } else { world * local };
    }
    Ok(world)
}

/// USD multiplies rows from the left.
fn matrix(rows: &Matrix4d) -> Matrix4<f64> {
    Matrix4::from_column_slice(&rows.0)
}

fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Double(number) => Some(*number),
        Value::Float(number) => Some(f64::from(*number)),
        _ => None,
    }
}
