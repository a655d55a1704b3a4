//! Forming links: which elements of the members are joined, and where, from positions at a time.

use nalgebra::Vector3;
use nucleus_core::{Link, LinkKind, LinkSide, PointId};

use crate::attributes::{ElementKind, Ramp, dynamic_constraint as con};

use super::bvh::{Bounds, Bvh};
use super::kinds::{self, Values};
use super::member::{ConstraintSource, Member, MemberObject, Places};
use super::near::{Foot, barycentric, distance, foot};
use super::sheet::Sheet;

pub(super) type Point = Vector3<f64>;

/// `componentRelation`.
const ALL_TO_FIRST: i32 = 0;
const ALL_TO_ALL: i32 = 1;
/// `connectionMethod`.
const IN_ORDER: i32 = 0;

/// Sine of the angle to the normal of a face within which a place is above it.
const ABOVE: f64 = 1e-3;

/// What forming links needs of a constraint.
pub(super) struct Forming<'a> {
    pub(super) values: Values<'a>,
    pub(super) source: &'a ConstraintSource,
    pub(super) places: &'a Places,
    /// Metres per scene unit.
    pub(super) metres: f64,
    /// Whether joined edges resist folding.
    pub(super) bends: bool,
}

/// A place on an element of a member.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) side: LinkSide,
    pub(super) at: Point,
    /// The element, for its strength.
    pub(super) element: u32,
}

impl Member {
    pub(super) fn side(&self, points: [u32; 3], weights: [f64; 3]) -> LinkSide {
        let points = points.map(PointId);
        match self.object {
            MemberObject::Cloth(cloth) => LinkSide::Cloth { cloth, points, weights },
            MemberObject::Collider(collider) => LinkSide::Collider { collider, points, weights },
        }
    }
}

impl Forming<'_> {
    /// All links of the constraint. Their order depends on positions only through the choice of near elements.
    pub(super) fn links(&self) -> Vec<Link> {
        let links = match self.values.kind {
            kinds::POINT_TO_SURFACE | kinds::SLIDE_ON_SURFACE => self.to_surface(),
            kinds::WELD_BORDERS => self.borders(),
            kinds::TEARABLE => self.seams(),
            _ => self.pairs(),
        };
        let constant = self.values.choice(&con::REST_LENGTH_METHOD) == con::CONSTANT_REST_LENGTH.0;
        let rest = |link: &Link| match constant && link.fold().is_none() {
            true if link.rest < 0.0 => -1.0,
            true => 1.0,
            false => link.rest,
        };
        links.into_iter().map(|link| Link { rest: rest(&link), ..link }).collect()
    }

    /// Links from every point to the constraint's own space, where `local` puts it.
    pub(super) fn to_space(&self, local: impl Fn(Point) -> Point) -> Vec<Link> {
        let mut links = Vec::new();
        for member in
            self.source.members.iter().filter(|member| matches!(member.object, MemberObject::Cloth(_)))
        {
            for (point, element) in member.points() {
                let at = self.places.point(member.object, point);
                let side = member.side([point; 3], [1.0, 0.0, 0.0]);
                let [strength, tangent, glue, weight] = member.factors(element);
                links.push(Link {
                    strength,
                    tangent_strength: tangent,
                    glue,
                    weight: [weight, 1.0],
                    ..Link::new([side, LinkSide::Space(local(at))], 0.0)
                });
            }
        }
        links
    }

    /// Links between pairs of elements.
    fn pairs(&self) -> Vec<Link> {
        let mut links = Vec::new();
        for [a, b] in self.joined_members() {
            for [x, y] in self.element_pairs(a, b) {
                self.join((&self.source.members[a], x), (&self.source.members[b], y), &mut links);
            }
        }
        links
    }

    /// The members that are joined, by their indices.
    fn joined_members(&self) -> Vec<[usize; 2]> {
        let count = self.source.members.len();
        let mut joined: Vec<[usize; 2]> = match self.values.choice(&con::COMPONENT_RELATION) {
            ALL_TO_FIRST => (1..count).map(|k| [k, 0]).collect(),
            ALL_TO_ALL => (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b])).collect(),
            _ => (1..count).map(|k| [k - 1, k]).collect(),
        };
        // Maya connects within a component by itself when there is no other.
        if self.values.toggle(&con::CONNECT_WITHIN_COMPONENT) || count == 1 {
            joined.extend((0..count).map(|k| [k, k]));
        }
        joined
    }

    /// The elements of two members that are joined, by `connectionMethod`, thinned out by `connectionDensity`.
    fn element_pairs(&self, a: usize, b: usize) -> Vec<[u32; 2]> {
        let [from, to] = [a, b].map(|k| &self.source.members[k]);
        let pairs = match self.values.choice(&con::CONNECTION_METHOD) {
            IN_ORDER if a == b => self.in_order_within(from),
            IN_ORDER => {
                let count = from.elements.len().min(to.elements.len()) as u32;
                (0..count).map(|k| [k, k]).collect()
            }
            kinds::WITHIN_MAX_DISTANCE => self.within_distance(from, to, a == b),
            _ => self.nearest_pairs(from, to, a == b),
        };
        self.thinned(pairs, [from, to])
    }

    /// One component in order: every element with the next.
    fn in_order_within(&self, member: &Member) -> Vec<[u32; 2]> {
        (1..member.elements.len() as u32).map(|k| [k - 1, k]).collect()
    }

    pub(super) fn corners(&self, member: &Member, element: u32) -> Vec<Point> {
        let points = member.elements.face(element as usize).iter();
        points.map(|&point| self.places.point(member.object, point)).collect()
    }

    pub(super) fn all_corners(&self, member: &Member) -> Vec<Vec<Point>> {
        (0..member.elements.len() as u32).map(|element| self.corners(member, element)).collect()
    }

    /// Whether two elements of one member are neighbours, which are not joined.
    fn touch(member: &Member, x: u32, y: u32) -> bool {
        let [x, y] = [x, y].map(|element| member.elements.face(element as usize));
        x.iter().any(|point| y.contains(point))
    }

    fn within_distance(&self, from: &Member, to: &Member, same: bool) -> Vec<[u32; 2]> {
        let reach = self.reach();
        let (ours, theirs) = (self.all_corners(from), self.all_corners(to));
        let tree = Bvh::new(theirs.iter().map(Vec::as_slice));
        let mut pairs = Vec::new();
        for (x, corners) in (0..).zip(&ours) {
            let mut found: Vec<u32> = tree
                .within(&Bounds::of(corners), reach)
                .into_iter()
                .filter(|&y| !same || x < y && !Self::touch(from, x, y))
                .filter(|&y| distance(corners, &theirs[y as usize]) <= reach)
                .collect();
            found.sort_unstable();
            pairs.extend(found.into_iter().map(|y| [x, y]));
        }
        pairs
    }

    /// Pairs that are nearest to each other, then again among those that are left: each element has one partner.
    fn nearest_pairs(&self, from: &Member, to: &Member, same: bool) -> Vec<[u32; 2]> {
        let (ours, theirs) = (self.all_corners(from), self.all_corners(to));
        let mut left: [Vec<u32>; 2] = [&ours, &theirs].map(|all| (0..all.len() as u32).collect());
        let mut pairs: Vec<[u32; 2]> = Vec::new();
        while !left[0].is_empty() && !left[1].is_empty() {
            let tree = Bvh::new(left[1].iter().map(|&y| theirs[y as usize].as_slice()));
            let mut found: Vec<(f64, u32, u32)> = Vec::new();
            for &x in &left[0] {
                let corners = &ours[x as usize];
                let of = |at: u32| match left[1][at as usize] {
                    y if same && (x == y || Self::touch(from, x, y)) => f64::INFINITY,
                    y => distance(corners, &theirs[y as usize]),
                };
                let nearest = tree.nearest(&Bounds::of(corners), f64::INFINITY, of);
                found.extend(nearest.map(|(d, at)| (d, x, left[1][at as usize])));
            }
            found.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
            let before = pairs.len();
            let mut taken = [vec![false; ours.len()], vec![false; theirs.len()]];
            for (_, x, y) in found {
                let is_free = !taken[0][x as usize]
                    && !taken[1][y as usize]
                    && !(same && (taken[0][y as usize] || taken[1][x as usize]));
                if is_free {
                    (taken[0][x as usize], taken[1][y as usize]) = (true, true);
                    if same {
                        (taken[0][y as usize], taken[1][x as usize]) = (true, true);
                    }
                    pairs.push([x, y]);
                }
            }
            if pairs.len() == before {
                break;
            }
            left[0].retain(|&x| !taken[0][x as usize]);
            left[1].retain(|&y| !taken[1][y as usize]);
        }
        pairs.sort_unstable();
        pairs
    }

    /// Keeps each pair with the probability of `connectionDensity`, over its length by `connectionDensityRange`.
    fn thinned(&self, mut pairs: Vec<[u32; 2]>, [from, to]: [&Member; 2]) -> Vec<[u32; 2]> {
        let density = self.density();
        if !density.keeps_all() {
            pairs.retain(|&[x, y]| {
                density.keeps([x, y], distance(&self.corners(from, x), &self.corners(to, y)))
            });
        }
        pairs
    }

    pub(super) fn density(&self) -> Density {
        Density {
            share: self.values.number(&con::CONNECTION_DENSITY),
            ramp: Ramp::new(&self.values.at.get(self.values.node, &con::CONNECTION_DENSITY_RANGE)),
            reach: self.reach().max(f64::MIN_POSITIVE),
        }
    }

    /// `maxDistance` in metres.
    fn reach(&self) -> f64 {
        self.values.number(&con::MAX_DISTANCE) * self.metres
    }

    /// Adds the links that join two elements: one for a point, two for an edge, three for a face. Two edges hinge, faces
    /// are attached rigidly.
    fn join(&self, (from, x): (&Member, u32), (to, y): (&Member, u32), links: &mut Vec<Link>) {
        let sizes = [from, to].map(|member| member.kind);
        let ((from, x), (to, y)) =
            if sizes[0] > sizes[1] { ((to, y), (from, x)) } else { ((from, x), (to, y)) };
        let (ours, theirs) = (self.corners(from, x), self.corners(to, y));
        let points = from.elements.face(x as usize);
        let on_face = to.kind == ElementKind::Face;
        let middle = ours.iter().sum::<Point>() / ours.len() as f64;
        let whole = foot(&theirs, middle);
        for (k, &corner) in ours.iter().enumerate().take(3) {
            let on = match on_face && ours.len() > 1 {
                true => rigid_foot(&theirs, whole, corner),
                false => foot(&theirs, corner),
            };
            let side = from.side([points[k]; 3], [1.0, 0.0, 0.0]);
            let a = Place { side, at: corner, element: x };
            let b = self.place(to, y, &on);
            links.push(
                self.link(
                    [(from, a), (to, b)],
                    on_face.then(|| triangle_of(&theirs, &on).map(|k| theirs[k])),
                ),
            );
        }
        if self.bends && from.kind == ElementKind::Edge && to.kind == ElementKind::Edge {
            let first = links.len() as u32 - 2;
            links.extend(self.folds([(from, x), (to, y)], [first, first + 1]));
        }
    }

    pub(super) fn place(&self, member: &Member, element: u32, on: &Foot) -> Place {
        let points = member.elements.face(element as usize);
        let side = member.side(on.corners.map(|corner| points[corner]), on.weights);
        Place { side, at: on.place, element }
    }

    /// The link of two places, the second on a face if its corners are given. A link that stays at a place beside the face is
    /// oblique, for the normal would pull it over the face at once.
    pub(super) fn link(&self, [(from, a), (to, b)]: [(&Member, Place); 2], face: Option<[Point; 3]>) -> Link {
        let line = a.at - b.at;
        let slides = self.values.slides();
        let frame = face.and_then(|face| Link::face_frame(face).or(slides.then(Default::default)));
        let is_beside = |normal: &Point| (line - normal * line.dot(normal)).norm() > ABOVE * line.norm();
        let beside = frame.filter(|[_, _, normal]| !slides && is_beside(normal));
        let rest = match (frame, beside) {
            (Some([_, _, normal]), None) => line.dot(&normal),
            (_, Some([_, _, normal])) if line.dot(&normal) < 0.0 => -line.norm(),
            _ => line.norm(),
        };
        let (ours, theirs) = (from.factors(a.element), to.factors(b.element));
        let [strength, tangent_strength, glue] = [0, 1, 2].map(|k| ours[k] * theirs[k]);
        let kind = match (frame, beside) {
            (None, _) => LinkKind::Distance,
            (Some(_), None) => LinkKind::Surface,
            (Some(_), Some([along, across, _])) => {
                LinkKind::Oblique([along, across].map(|axis| line.dot(&axis) / rest))
            }
        };
        Link {
            kind,
            strength,
            tangent_strength,
            glue,
            weight: [ours[3], theirs[3]],
            ..Link::new([a.side, b.side], rest)
        }
    }

    /// Links from all points to the closest places of the first member, a surface. Where links slide, they go on from there
    /// to the closest place of its sheet, as the solver does: the side of the surface is taken there.
    fn to_surface(&self) -> Vec<Link> {
        let Some((surface, others)) = self.source.members.split_first() else { return Vec::new() };
        let faces = self.all_corners(surface);
        let tree = Bvh::new(faces.iter().map(Vec::as_slice));
        let density = self.density();
        let walks = self.values.slides() && !surface.sheet.is_empty();
        let sheet = walks.then(|| Sheet::new(surface, self.places));
        let reach = match self.values.choice(&con::CONNECTION_METHOD) {
            kinds::WITHIN_MAX_DISTANCE => self.reach(),
            _ => f64::INFINITY,
        };
        let mut links = Vec::new();
        for member in others {
            for (point, element) in member.points() {
                let at = self.places.point(member.object, point);
                let of = |face: u32| (foot(&faces[face as usize], at).place - at).norm();
                let Some((distance, face)) = tree.nearest(&Bounds::of(&[at]), reach, of) else { continue };
                if !density.keeps([element, face], distance) {
                    continue;
                }
                let start = (surface.elements.face(face as usize), &faces[face as usize][..]);
                let (points, polygon) =
                    sheet.as_ref().and_then(|sheet| sheet.nearest(at, start)).unwrap_or(start);
                let on = foot(polygon, at);
                let from = Place { side: member.side([point; 3], [1.0, 0.0, 0.0]), at, element };
                let side = surface.side(on.corners.map(|corner| points[corner]), on.weights);
                let to = Place { side, at: on.place, element: face };
                let mut link = self.link(
                    [(member, from), (surface, to)],
                    Some(triangle_of(polygon, &on).map(|k| polygon[k])),
                );
                // Beside an edge the distance is not along the normal, but its side is.
                link.rest = (at - on.place).norm() * if link.rest < 0.0 { -1.0 } else { 1.0 };
                links.push(link);
            }
        }
        links
    }
}

/// The share of pairs that are kept: `connectionDensity`, over their distance by `connectionDensityRange`.
pub(super) struct Density {
    share: f64,
    ramp: Ramp,
    /// The distance at the end of the ramp, in metres.
    reach: f64,
}

impl Density {
    fn keeps_all(&self) -> bool {
        self.share >= 1.0 && self.ramp.is_at_least(1.0)
    }

    /// Whether a pair of elements at a distance in metres is kept.
    pub(super) fn keeps(&self, [x, y]: [u32; 2], distance: f64) -> bool {
        chance(x, y) < self.share * self.ramp.value_at((distance / self.reach).min(1.0))
    }
}

/// The place of a triangle's plane below a point, so that several links hold an element rigidly.
fn rigid_foot(polygon: &[Point], whole: Foot, corner: Point) -> Foot {
    let triangle = triangle_of(polygon, &whole);
    let places = triangle.map(|k| polygon[k]);
    let Some(weights) = barycentric(places, corner) else { return whole };
    let place = (0..3).map(|k| places[k] * weights[k]).sum();
    Foot { corners: triangle, weights, place }
}

/// The triangle of a polygon's fan that a foot is on.
fn triangle_of(polygon: &[Point], on: &Foot) -> [usize; 3] {
    let [a, b, c] = on.corners;
    if a != b && b != c && a != c { on.corners } else { [0, 1, polygon.len() - 1] }
}

/// A number from 0 to 1 that depends on two numbers alone (SplitMix64).
fn chance(x: u32, y: u32) -> f64 {
    let mut z = (u64::from(x) << 32 | u64::from(y)).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}
