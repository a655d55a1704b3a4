//! How contact stands at each point of a cloth: the contact_states of the ladder that `settle.rs` climbs, as far as they can be
//! seen once a step is over. It is looked at only where somebody asks.

use crate::contact::cloth::near::Near;
use crate::contact::collider_contact::Pair;
use crate::contact::narrow::shortest;
use crate::contact::pairs::PairList;
use crate::contact::terms::Terms;
use crate::math::Real;
use crate::output::ContactState;
use crate::solver::Solver;

/// Share of the thickness up to which two elements touch. Passes keep them apart by all of it along a plane, to which
/// the sweeps after them and curved meshes add a little.
const TOUCHING: f64 = 1.02;
/// Share of the thickness below which contact has less room than it wants.
const PINCHED: f64 = 0.9;
/// Least share of a contact by which the corner of an edge or a face has part in it.
const LEAST_SHARE: f64 = 0.25;

/// The highest rung of each place of the solver.
struct Ladder(Vec<ContactState>);

impl Ladder {
    fn climb(&mut self, point: u32, to: ContactState) {
        let rung = &mut self.0[point as usize];
        *rung = (*rung).max(to);
    }

    /// A gap, over the thickness that is to be kept.
    fn near(&mut self, point: u32, closeness: f64) {
        if closeness < PINCHED {
            self.climb(point, ContactState::Compressed);
        } else if closeness < TOUCHING {
            self.climb(point, ContactState::Touching);
        }
    }

    fn near_all<const N: usize>(&mut self, points: [u32; N], shares: [f64; N], closeness: f64) {
        let parts = points.into_iter().zip(shares).filter(|&(_, share)| share >= LEAST_SHARE);
        parts.for_each(|(point, _)| self.near(point, closeness));
    }
}

impl<R: Real> Solver<R> {
    /// Replaces `out` by how contact stands at each point of every cloth, in the user's order.
    pub(crate) fn list_contact_states(&self, out: &mut Vec<Vec<ContactState>>) {
        out.resize_with(self.model.cloths.len(), Vec::new);
        out.iter_mut().for_each(Vec::clear);
        if !self.can_meet() {
            return;
        }
        let contact_states = self.contact_states();
        for (model, out) in self.model.cloths.iter().zip(out) {
            let first = model.points().start;
            out.extend(model.order.places().iter().map(|&place| contact_states[(first + place) as usize]));
        }
    }

    /// Whether anything of this scene can touch anything.
    fn can_meet(&self) -> bool {
        self.contact.ground.is_there() || !self.contact.pairs.is_empty() || self.contact.mutual.is_some()
    }

    /// How contact stands at each place of the solver.
    fn contact_states(&self) -> Vec<ContactState> {
        let mut ladder = Ladder(vec![ContactState::Free; self.state.anchor.len()]);
        self.on_the_ground(&mut ladder);
        self.contact.pairs.iter().for_each(|list| self.at_collider(list, &mut ladder));
        self.among_cloths(&mut ladder);
        ladder.0
    }

    fn on_the_ground(&self, ladder: &mut Ladder) {
        let grounded = self.model.cloths.iter().zip(&self.contact.ground_terms);
        for (cloth, terms) in grounded.filter_map(|(cloth, terms)| Some((cloth, terms.as_ref()?))) {
            for row in cloth.points() {
                let thickness = self.kept(terms, [row], [R::ONE]);
                if let Some(height) = self.contact.ground.height_at_end(self.state.position(row)) {
                    ladder.near(row, height / thickness);
                }
            }
        }
    }

    fn at_collider(&self, list: &PairList<R>, ladder: &mut Ladder) {
        let PairList { point_face, edge_edge, face_point, active, trapped, .. } = list;
        trapped.points.iter().for_each(|&(point, _)| ladder.climb(point, ContactState::Depenetrating));
        // One of them may not collide.
        let Some(Some(terms)) = self.terms_of(list.cloth).get(list.collider) else { return };
        let collider = list.collider;
        active.point_face.iter().for_each(|&k| self.touch(&point_face[k as usize], collider, terms, ladder));
        active.edge_edge.iter().for_each(|&k| self.touch(&edge_edge[k as usize], collider, terms, ladder));
        active.face_point.iter().for_each(|&k| self.touch(&face_point[k as usize], collider, terms, ladder));
    }

    fn touch<const N: usize, const M: usize>(
        &self,
        pair: &Pair<R, N, M>,
        collider: usize,
        terms: &Terms<R>,
        ladder: &mut Ladder,
    ) {
        let state = &self.contact.collider_states[collider];
        let ours = pair.points.map(|point| self.state.position(point));
        let theirs = pair.collider_points.map(|point| state.point(point, state.now).into());
        let (_, (shares, _), distance) = shortest::<f64, N, M>((ours, theirs));
        let thickness = self.kept(terms, pair.points, shares.map(R::from_f64));
        ladder.near_all(pair.points, shares, distance / thickness);
    }

    /// The thickness that is kept where a cloth's element touches something that is no cloth, in metres.
    fn kept<const N: usize>(&self, terms: &Terms<R>, points: [u32; N], shares: [R; N]) -> f64 {
        let most = R::from_f64(terms.thickness);
        terms.thickness_at(&self.contact.maps, (points, [], &(shares, [])), most).to_f64()
    }

    fn among_cloths(&self, ladder: &mut Ladder) {
        let Some(mutual) = self.contact.mutual.as_ref().filter(|mutual| mutual.is_on()) else { return };
        let active = &mutual.active;
        let terms = &mutual.terms[..];
        active.point_face.iter().for_each(|near| self.meets(near, terms, ladder));
        active.edge_edge.iter().for_each(|near| self.meets(near, terms, ladder));
        active.point_edge.iter().for_each(|near| self.meets(near, terms, ladder));
        active.point_point.iter().for_each(|near| self.meets(near, terms, ladder));
        for crossing in &mutual.tangle.crossings {
            let corners = crossing.edge.iter().chain(&crossing.face);
            corners.for_each(|&point| ladder.climb(point, ContactState::Intersecting));
        }
    }

    fn meets<const N: usize, const M: usize>(
        &self,
        near: &Near<R, N, M>,
        terms: &[Option<Terms<R>>],
        ladder: &mut Ladder,
    ) {
        let place = |point: u32| self.state.position(point);
        let (_, (ours, theirs), distance) = shortest((near.ours.map(place), near.theirs.map(place)));
        let weights = (ours.map(R::from_f64), theirs.map(R::from_f64));
        let closeness = distance / near.thickness_at(terms, &self.contact.maps, &weights).to_f64();
        ladder.near_all(near.ours, ours, closeness);
        ladder.near_all(near.theirs, theirs, closeness);
    }
}
