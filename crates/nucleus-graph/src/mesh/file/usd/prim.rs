//! A mesh of a USD stage at a time: its points, blend shapes, skin, transform and texture coordinates.

use nalgebra::{Matrix4, Vector3};
use openusd::gf::{Matrix4d, Vec3f};
use openusd::schemas::geom::{Imageable, Xformable};
use openusd::schemas::skel::skinning::resolve_blend_shape_offsets;
use openusd::schemas::skel::{
    AnimMapper, BlendShape, SkelAnimQuery, SkelBindingAPI, Skeleton, SkeletonResolver, SkinningResolver,
};
use openusd::sdf::{self, Value};
use openusd::usd::{Prim, SchemaBase, SchemaKind, Stage, TimeCode};

use crate::mesh::file::deform::{Influences, transform};
use crate::mesh::obj::CornerUvs;

/// A mesh, and what moves it.
pub(super) struct MeshPrim {
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
pub(super) struct AnyPrim(pub(super) Prim);

impl SchemaBase for AnyPrim {
    const KIND: SchemaKind = SchemaKind::AbstractBase;

    fn prim(&self) -> &Prim {
        &self.0
    }
}
impl Imageable for AnyPrim {}
impl Xformable for AnyPrim {}

impl MeshPrim {
    pub(super) fn read(stage: &Stage, prim: Prim) -> anyhow::Result<Result<Self, String>> {
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

    pub(super) fn may_move(&self) -> anyhow::Result<bool> {
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

    pub(super) fn points(&self, time: TimeCode) -> anyhow::Result<Vec<Vector3<f64>>> {
        let of_floats = |p: Vec3f| Vector3::new(p.x.into(), p.y.into(), p.z.into());
        Ok(match self.prim.attribute("points").get_at::<Value>(time)? {
            Some(Value::Vec3fVec(points)) => points.into_iter().map(of_floats).collect(),
            Some(Value::Vec3dVec(points)) => {
                points.into_iter().map(|p| Vector3::new(p.x, p.y, p.z)).collect()
            }
            _ => Vec::new(),
        })
    }

    pub(super) fn ints(&self, name: &'static str, time: TimeCode) -> anyhow::Result<Vec<i32>> {
        Ok(match self.prim.attribute(name).get_at::<Value>(time)? {
            Some(Value::IntVec(values)) => values,
            _ => Vec::new(),
        })
    }

    /// Texture coordinates, and the index of those of each corner of the file.
    pub(super) fn texture_coordinates(
        &self,
        time: TimeCode,
        corners: &[i32],
    ) -> anyhow::Result<Option<CornerUvs>> {
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

    /// Whether its front is where its corners run clockwise: it is left-handed, or mirrored by its transform.
    pub(super) fn is_clockwise(&self, time: TimeCode) -> anyhow::Result<bool> {
        let chain = self.skin.as_ref().map_or(&self.chain, |skin| &skin.chain);
        Ok(self.is_left_handed != (world(chain, time)?.determinant() < 0.0))
    }

    /// Its points in the world: blend shapes, then the skin or its transform.
    pub(super) fn positions(&self, stage: &Stage, time: TimeCode) -> anyhow::Result<Vec<Vector3<f64>>> {
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

/// The prims from the root to a prim.
pub(super) fn chain(prim: &Prim) -> Vec<AnyPrim> {
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
