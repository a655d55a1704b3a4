//! Links of dynamic constraints: what is joined to what, and how strongly in a frame.
//!
//! A link joins two places. Each is a point, a point of an edge or a point of a face of a cloth, given by barycentric
//! weights; or it is prescribed: a place on a collider, or a place in the constraint's own space. A prescribed place
//! moves along a straight line inside the frame and cannot be pushed.

use nalgebra::{Matrix3, Vector3};

use crate::bytes::{Encode, Reader};
use crate::input::samples::{FALLOFF_SAMPLES, sample_at};
use crate::input::{ClothId, ColliderId, PointId};

/// One end of a link.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LinkSide {
    /// A place on a cloth: up to three points with weights that add up to 1. Unused points have weight 0.
    Cloth {
        /// The cloth.
        cloth: ClothId,
        /// Its points.
        points: [PointId; 3],
        /// Their barycentric weights.
        weights: [f64; 3],
    },
    /// A place on a collider.
    Collider {
        /// The collider.
        collider: ColliderId,
        /// Its points.
        points: [PointId; 3],
        /// Their barycentric weights.
        weights: [f64; 3],
    },
    /// A place in the space of the constraint (see [`ConstraintFrame::space`]), in metres.
    Space(Vector3<f64>),
}

impl LinkSide {
    /// A point of a cloth.
    pub fn point(cloth: ClothId, point: PointId) -> Self {
        Self::Cloth { cloth, points: [point; 3], weights: [1.0, 0.0, 0.0] }
    }

    /// The cloth, by its index, where it is on one.
    pub(crate) fn cloth(&self) -> Option<usize> {
        match self {
            Self::Cloth { cloth, .. } => Some(cloth.index()),
            _ => None,
        }
    }

    /// Whether the solver moves it.
    pub fn is_free(&self) -> bool {
        matches!(self, Self::Cloth { .. })
    }
}

/// A link. Formed by the caller, kept by the solver until its constraint is formed anew.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// What is joined. On a surface the second side is a face.
    pub sides: [LinkSide; 2],
    /// What it holds.
    pub kind: LinkKind,
    /// Distance to hold in metres, before [`ConstraintFrame::rest_scale`]; on a surface along its normal, or its direction where
    /// it is oblique, with sign.
    pub rest: f64,
    /// Factor on the strength, 0 to 1 (product of both components').
    pub strength: f64,
    /// Factor on the tangent strength.
    pub tangent_strength: f64,
    /// Factor on the glue strength (product of both components').
    pub glue: f64,
    /// How much each side pushes the other: 0 never does.
    pub weight: [f64; 2],
    /// Length of the edge that it stands for in metres, or 1 for single points: the load that breaks it is per length.
    pub length: f64,
}

/// What a link holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LinkKind {
    /// The distance between its sides.
    Distance,
    /// A place on a surface. Strength is split: one along the normal of the face on the second side, another along the face.
    Surface,
    /// A place on a surface for a link that starts beside its face and does not slide: its unit direction turns with the face and
    /// takes the place of the normal. These are its components in the plane of the face, along the first edge and across it; the
    /// third is not negative.
    Oblique([f64; 2]),
    /// The angle between two faces.
    Fold(Fold),
}

/// A link that resists folding: its sides are the two faces at joined edges, their weights those of a hinge, and its rest
/// length is that of the hinge's bending vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fold {
    /// Length of the bending vector when the hinge is folded shut.
    pub max_length: f64,
    /// The links of the constraint that join the edges, by their index: it breaks with any of them. An index without a
    /// link is none.
    pub holds: [u32; 2],
}

impl Fold {
    /// Sine of half the angle between the faces, at a length of the bending vector.
    pub fn half_sine(&self, length: f64) -> f64 {
        if self.max_length > 0.0 { (length / self.max_length).clamp(0.0, 1.0) } else { 0.0 }
    }
}

impl Link {
    /// A link of full strength between two places at this distance.
    pub fn new(sides: [LinkSide; 2], rest: f64) -> Self {
        Self {
            sides,
            kind: LinkKind::Distance,
            rest,
            strength: 1.0,
            tangent_strength: 1.0,
            glue: 1.0,
            weight: [1.0; 2],
            length: 1.0,
        }
    }

    /// Whether its second side is a face with a normal that it keeps to.
    pub fn is_on_surface(&self) -> bool {
        matches!(self.kind, LinkKind::Surface | LinkKind::Oblique(_))
    }

    /// The direction of an oblique link.
    pub fn oblique(&self) -> Option<[f64; 2]> {
        if let LinkKind::Oblique(direction) = self.kind { Some(direction) } else { None }
    }

    /// The fold that it resists, if it does.
    pub fn fold(&self) -> Option<Fold> {
        if let LinkKind::Fold(fold) = self.kind { Some(fold) } else { None }
    }

    /// The frame in which the direction of an oblique link is given: along the first edge of a face, across it and along the
    /// normal. `None` for a face without area.
    pub fn face_frame([a, b, c]: [Vector3<f64>; 3]) -> Option<[Vector3<f64>; 3]> {
        let along = (b - a).try_normalize(0.0)?;
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        Some([along, normal.cross(&along), normal])
    }

    /// The cloths on its sides, by index.
    pub(crate) fn cloths(&self) -> impl Iterator<Item = usize> {
        self.sides.into_iter().filter_map(|side| side.cloth())
    }

    /// The two points that it joins, where both sides are single points of cloth.
    pub fn points(&self) -> Option<[(ClothId, PointId); 2]> {
        let point = |side: &LinkSide| match *side {
            LinkSide::Cloth { cloth, points, weights: [1.0, 0.0, 0.0] } => Some((cloth, points[0])),
            _ => None,
        };
        Some([point(&self.sides[0])?, point(&self.sides[1])?])
    }
}

/// How links hold (`constraintMethod`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LinkMethod {
    /// Rigid at any strength.
    Weld,
    /// Springs in both directions.
    Spring,
    /// Springs that only pull.
    RubberBand,
}

/// A force along links (`force`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkForce {
    /// Relative acceleration in m/s² of the two ends towards each other.
    pub acceleration: f64,
    /// Factor over the length of the link.
    pub falloff: Falloff,
}

/// A sampled ramp over a distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Falloff {
    /// In metres.
    pub distance: f64,
    /// From zero (first) to the distance (last), evenly spaced; the last one beyond.
    pub samples: [f64; Self::SAMPLES],
}

impl Falloff {
    /// The number of samples.
    pub const SAMPLES: usize = FALLOFF_SAMPLES;

    /// The value at a length in metres, between samples in straight lines.
    pub fn at(&self, length: f64) -> f64 {
        sample_at(&self.samples, if self.distance > 0.0 { length / self.distance } else { 1.0 })
    }
}

/// The attributes of one constraint in one frame. The constraints of all frames have the same order.
#[derive(Debug, Clone, PartialEq)]
pub struct ConstraintFrame {
    /// Links formed at the start of this frame, which replace those before; `None` keeps them. A link between the same
    /// points as a broken one stays broken while `glue_strength` is below 1.
    pub formed: Option<Vec<Link>>,
    /// How they hold.
    pub method: LinkMethod,
    /// `strength`: evaluations in 1/24 s (Classic) or a stiffness (Physical).
    pub strength: f64,
    /// The same along surfaces.
    pub tangent_strength: f64,
    /// Factor on rest lengths at the start and at the end of the frame.
    pub rest_scale: [f64; 2],
    /// `bendStrength` of folds: evaluations in 1/24 s (Classic) or a bending stiffness like that of `bendResistance`
    /// (Physical).
    pub bend_strength: f64,
    /// Sine of half the angle, from rest, beyond which a fold breaks; 1 for never.
    pub break_half_sine: f64,
    /// Evaluations in 1/24 s, at least and at most.
    pub iterations: [f64; 2],
    /// `glueStrength`: 0 breaks at once, 1 never. Its [`breaking_load`](crate::breaking_load) is in newtons per metre of
    /// edge, or newtons per point. When it becomes 1, broken links heal. Read only if `can_break`.
    pub glue_strength: f64,
    /// Factor on the breaking load.
    pub glue_scale: f64,
    /// Whether links ever break. Fixed from frame to frame.
    pub can_break: bool,
    /// Whether links on surfaces slide: their second side moves to the nearest place of the surface in every time step.
    pub slides: bool,
    /// Resistance against sliding: 0 none, 1 does not slide.
    pub friction: f64,
    /// Distance in metres that sliding points keep from the surface on their side (`localCollide`).
    pub keep_off: Option<f64>,
    /// Whether that side is the one where they began.
    pub single_sided: bool,
    /// Damping of the relative velocity along links.
    pub damp: f64,
    /// Share of the relative velocity that is taken: 0 none, 1 locks.
    pub motion_drag: f64,
    /// A force along links.
    pub force: Option<LinkForce>,
    /// Factor on the strength over the present length; `None` is 1 everywhere.
    pub dropoff: Option<Falloff>,
    /// The space of the constraint at the start and at the end of the frame: `linear * place + offset`, in metres.
    pub space: [(Matrix3<f64>, Vector3<f64>); 2],
}

impl Default for ConstraintFrame {
    /// Springs with Maya's defaults, without links.
    fn default() -> Self {
        Self {
            formed: None,
            method: LinkMethod::Spring,
            strength: 20.0,
            tangent_strength: 10.0,
            rest_scale: [1.0; 2],
            bend_strength: 0.0,
            break_half_sine: 1.0,
            iterations: [0.0, 5000.0],
            glue_strength: 1.0,
            glue_scale: 1.0,
            can_break: false,
            slides: false,
            friction: 0.0,
            keep_off: None,
            single_sided: true,
            damp: 0.0,
            motion_drag: 0.0,
            force: None,
            dropoff: None,
            space: [(Matrix3::identity(), Vector3::zeros()); 2],
        }
    }
}

impl ConstraintFrame {
    /// Whether its links pull at all.
    pub fn pulls(&self) -> bool {
        let strengths = [self.strength, self.tangent_strength, self.bend_strength];
        self.method == LinkMethod::Weld || strengths.iter().any(|strength| *strength > 0.0)
    }

    /// The factor on rest lengths at a time of the frame.
    pub fn rest_scale_at(&self, time: f64) -> f64 {
        let [start, end] = self.rest_scale;
        start + (end - start) * time
    }
}

/// Exclusions in a frame, at most: each has a bit. More have no effect.
pub const MAX_EXCLUSIONS: usize = 64;

/// Elements that do not collide with each other.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Exclusion {
    /// The points of both sides. An element belongs to a side if all of its points do.
    pub sides: [ExcludedSide; 2],
}

/// One side of an exclusion.
#[derive(Debug, Clone, PartialEq)]
pub enum ExcludedSide {
    /// Everything in the scene, with the ground plane.
    Everything,
    /// Points of cloths and of colliders.
    Points(Vec<(ClothId, PointId)>, Vec<(ColliderId, PointId)>),
}

impl Default for ExcludedSide {
    fn default() -> Self {
        Self::Points(Vec::new(), Vec::new())
    }
}

/// Kind, object, points and numbers.
type PackedSide = (u8, (u32, ([u32; 3], [f64; 3])));

impl Encode for LinkSide {
    const SIZE: usize = <PackedSide as Encode>::SIZE;
    fn encode(&self, out: &mut Vec<u8>) {
        let packed: PackedSide = match *self {
            Self::Cloth { cloth, points, weights } => (0, (cloth.0, (points.map(|point| point.0), weights))),
            Self::Collider { collider, points, weights } => {
                (1, (collider.0, (points.map(|point| point.0), weights)))
            }
            Self::Space(place) => (2, (0, ([0; 3], place.into()))),
        };
        packed.encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        let (kind, (id, (points, weights))) = PackedSide::decode(from)?;
        let points = points.map(PointId);
        match kind {
            0 => Some(Self::Cloth { cloth: ClothId(id), points, weights }),
            1 => Some(Self::Collider { collider: ColliderId(id), points, weights }),
            2 => Some(Self::Space(weights.into())),
            _ => None,
        }
    }
}

/// Sides, rest length and surface, and its direction; strengths; weights, length, and the fold. A direction of more than
/// length one and a fold of negative length are none.
type PackedLink = (([LinkSide; 2], (f64, PackedSurface)), ([f64; 3], ([f64; 3], PackedFold)));
type PackedSurface = (bool, [f64; 2]);
type PackedFold = (f64, [u32; 2]);

/// What is stored where a link is not oblique.
const NOT_OBLIQUE: [f64; 2] = [2.0; 2];
/// What is stored where a link is not a fold.
const NO_FOLD: PackedFold = (-1.0, [0; 2]);

impl LinkKind {
    fn packed(self) -> (PackedSurface, PackedFold) {
        match self {
            Self::Distance => ((false, NOT_OBLIQUE), NO_FOLD),
            Self::Surface => ((true, NOT_OBLIQUE), NO_FOLD),
            Self::Oblique(direction) => ((true, direction), NO_FOLD),
            Self::Fold(Fold { max_length, holds }) => ((false, NOT_OBLIQUE), (max_length, holds)),
        }
    }

    fn unpacked((on_surface, direction): PackedSurface, (max_length, holds): PackedFold) -> Option<Self> {
        match (on_surface, direction != NOT_OBLIQUE, max_length >= 0.0) {
            (false, false, false) => Some(Self::Distance),
            (true, false, false) => Some(Self::Surface),
            (true, true, false) => Some(Self::Oblique(direction)),
            (false, false, true) => Some(Self::Fold(Fold { max_length, holds })),
            _ => None,
        }
    }
}

impl Encode for Link {
    const SIZE: usize = <PackedLink as Encode>::SIZE;
    fn encode(&self, out: &mut Vec<u8>) {
        let Self { sides, kind, rest, strength, tangent_strength, glue, weight: [a, b], length } = *self;
        let (surface, fold) = kind.packed();
        let numbers = ([strength, tangent_strength, glue], ([a, b, length], fold));
        let packed: PackedLink = ((sides, (rest, surface)), numbers);
        packed.encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        let ((sides, (rest, surface)), numbers) = PackedLink::decode(from)?;
        let ([strength, tangent_strength, glue], ([a, b, length], fold)) = numbers;
        let kind = LinkKind::unpacked(surface, fold)?;
        Some(Self { sides, kind, rest, strength, tangent_strength, glue, weight: [a, b], length })
    }
}
