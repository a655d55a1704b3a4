//! Checkpoints: everything that a solver carries from one frame to the next, as bytes. A solver restored from them
//! continues with the same bits as one that never stopped.
//!
//! | You want to know… | Read |
//! |---|---|
//! | how values become bytes, and what each struct stores | `bytes.rs`, and `checkpoint_struct!` beside the struct |
//! | which model a checkpoint belongs to | `fingerprint` |
//! | how damaged bytes are refused | `references_are_valid` |
//!
//! **Invariant:** the checksum detects accidental damage, and every index that a checkpoint holds is checked against
//! the model before a contact uses it.

use nalgebra::Vector3;

use crate::bytes::{
    Checkpoint, Encode, HASH_SEED, Reader, RestoreError, add_checksum, checkpoint_struct, encode_struct,
    hash_word, load_column, verify_checksum,
};
use crate::constraints::angle::AngleGroup;
use crate::constraints::pressure::Chamber;
use crate::contact::cloth::Mutual;
use crate::contact::cloth::paths::Paths;
use crate::contact::cloth::tangle::{Crossing, Remedy};
use crate::contact::pairs::PairList;
use crate::contact::search::GROUP;
use crate::contact::terms::Terms;
use crate::input::frame::Elements;
use crate::input::validation::is_in_range;
use crate::math::Real;
use crate::model::builder::ModelBuilder;
use crate::model::{ClothModel, ColliderModel};
use crate::solver::{ContactSystem, Solver};
use crate::state::State;
use crate::state::kinematics::update_anchors;

/// Name and version of the layout; the version goes up with every change of the layout.
const KIND: [u8; 8] = *b"solver 5";

/// The state of a solver as bytes; see [`Solver::save`].
pub fn save<R: Real>(solver: &Solver<R>) -> Vec<u8> {
    let mut bytes = Vec::new();
    (R::SIZE as u8).encode(&mut bytes);
    fingerprint(solver).encode(&mut bytes);
    save_fields(solver, &mut bytes);
    save_pairs(solver, &mut bytes);
    save_rest(solver, &mut bytes);
    add_checksum(KIND, &bytes)
}

/// A solver that continues from where one of the same model was saved; see [`Solver::restored`].
pub fn restore<R: Real>(
    builder: ModelBuilder,
    threads: usize,
    bytes: &[u8],
) -> Result<Solver<R>, RestoreError> {
    let mut solver = Solver::build(builder, threads);
    let mut from = Reader::new(verify_checksum(KIND, bytes)?);
    let scalar = u8::decode(&mut from).ok_or(RestoreError::Damaged)?;
    if usize::from(scalar) != R::SIZE {
        return Err(RestoreError::Scalar { found: 8 * u32::from(scalar), wanted: 8 * R::SIZE as u32 });
    }
    if u64::decode(&mut from).ok_or(RestoreError::Damaged)? != fingerprint(&solver) {
        return Err(RestoreError::OtherModel);
    }
    let read = load_fields(&mut solver, &mut from)
        .and_then(|()| load_pairs(&mut solver, &mut from))
        .and_then(|()| load_rest(&mut solver, &mut from));
    read.filter(|()| from.is_at_end()).ok_or(RestoreError::Damaged)?;
    if !references_are_valid(&solver) {
        return Err(RestoreError::Damaged);
    }
    rebuild(&mut solver);
    Ok(solver)
}

/// Stores everything but the pairs. It names every field, so a new one does not compile until it is stored or named as
/// rebuilt.
fn save_fields<R: Real>(solver: &Solver<R>, out: &mut Vec<u8>) {
    let Solver { model: _, state, contact, pool: _ } = solver;
    // The ignored fields are rebuilt, or every frame writes them before it reads them.
    let ContactSystem {
        collider_states,
        pairs: _,
        spans: _,
        windows: _,
        drifts: _,
        near: _,
        far,
        strayed,
        terms,
        ground_terms,
        maps: _,
        mutual,
        touches,
        ground,
    } = contact;
    far.encode(out);
    strayed.encode(out);
    terms.encode(out);
    ground_terms.encode(out);
    touches.encode(out);
    state.save(out);
    collider_states.save(out);
    mutual.save(out);
    ground.save(out);
}

fn load_fields<R: Real>(solver: &mut Solver<R>, from: &mut Reader<'_>) -> Option<()> {
    let Solver { state, contact, .. } = solver;
    load_column(&mut contact.far, from)?;
    load_column(&mut contact.strayed, from)?;
    contact.terms = Encode::decode(from)?;
    contact.ground_terms = Encode::decode(from)?;
    contact.touches = Encode::decode(from)?;
    state.load(from)?;
    contact.collider_states.load(from)?;
    contact.mutual.load(from)?;
    contact.ground.load(from)
}

/// Pairs with a collider that moves are valid for one frame only, so the checkpoint omits them; it keeps their trapped
/// points.
fn save_pairs<R: Real>(solver: &Solver<R>, out: &mut Vec<u8>) {
    let are_valid = !solver.contact.collider_states.iter().any(|collider| collider.moves);
    are_valid.encode(out);
    for list in &solver.contact.pairs {
        if are_valid {
            list.save(out);
        } else {
            list.span.encode(out);
            list.trapped.encode(out);
        }
    }
}

fn load_pairs<R: Real>(solver: &mut Solver<R>, from: &mut Reader<'_>) -> Option<()> {
    let are_valid = bool::decode(from)?;
    for list in &mut solver.contact.pairs {
        if are_valid {
            list.load(from)?;
        } else {
            list.span = Encode::decode(from)?;
            list.trapped = Encode::decode(from)?;
        }
    }
    Some(())
}

/// Rest lengths and angles of cloth in which they can change.
fn save_rest<R: Real>(solver: &Solver<R>, out: &mut Vec<u8>) {
    for cloth in &solver.model.cloths {
        for list in [&cloth.stretch, &cloth.shear].into_iter().filter(|_| cloth.plastic) {
            list.groups().iter().map(|group| group.rest_length).collect::<Vec<_>>().encode(out);
        }
        for list in [&cloth.bend_angles, &cloth.bend_six_angles] {
            let memory = |angle: &AngleGroup<R>| [angle.rest, angle.flipped, angle.side];
            list.groups().iter().map(memory).collect::<Vec<_>>().encode(out);
        }
    }
}

fn load_rest<R: Real>(solver: &mut Solver<R>, from: &mut Reader<'_>) -> Option<()> {
    for cloth in &mut solver.model.cloths {
        let plastic = cloth.plastic;
        for list in [&mut cloth.stretch, &mut cloth.shear].into_iter().filter(|_| plastic) {
            let lengths: Vec<[R; 4]> = Encode::decode(from)?;
            let groups = list.groups_mut();
            (groups.len() == lengths.len()).then_some(())?;
            groups.iter_mut().zip(lengths).for_each(|(group, rest)| group.rest_length = rest);
        }
        for list in [&mut cloth.bend_angles, &mut cloth.bend_six_angles] {
            let memory: Vec<[[R; 4]; 3]> = Encode::decode(from)?;
            let groups = list.groups_mut();
            (groups.len() == memory.len()).then_some(())?;
            for (angle, [rest, flipped, side]) in groups.iter_mut().zip(memory) {
                (angle.rest, angle.flipped, angle.side) = (rest, flipped, side);
            }
        }
    }
    Some(())
}

/// Rebuilds everything that follows from the stored fields.
fn rebuild<R: Real>(solver: &mut Solver<R>) {
    for collider in &mut solver.contact.collider_states {
        let (start, end, now) = (collider.start.clone(), collider.end.clone(), collider.now);
        collider.begin_frame(&start, &end);
        collider.now = now;
    }
    solver.contact.pairs.iter_mut().for_each(sort_by_point);
    if let Some(Mutual { bodies, .. }) = &mut solver.contact.mutual {
        bodies.refit();
    }
    update_anchors(&mut solver.model.cloths, &solver.state.anchor, &solver.pool);
}

/// Rebuilds `by_point`.
fn sort_by_point<R: Real>(list: &mut PairList<R>) {
    let keys = (0..).zip(&list.point_face).map(|(index, pair)| u64::from(pair.points[0]) << 32 | index);
    list.by_point = keys.collect();
    list.by_point.sort_unstable();
}

/// A hash of all points, faces and masses, in the solver's order. Attributes may change from frame to frame and are no
/// part of it.
fn fingerprint<R: Real>(solver: &Solver<R>) -> u64 {
    let of_cloth = |cloth: &ClothModel<R>| {
        let order = cloth.order.places().iter().map(|&place| u64::from(place));
        let rows = [cloth.stretch.len(), cloth.shear.len(), cloth.bend.len(), cloth.bend_six.len()];
        let lists = rows.map(|length| length as u64);
        let flags =
            [u64::from(cloth.damps), u64::from(cloth.alternates_direction), cloth.triangles.len() as u64];
        let skin = corners(&cloth.skin.triangles);
        [cloth.blocks.len() as u64]
            .into_iter()
            .chain(order)
            .chain(lists)
            .chain(flags)
            .chain(skin)
            .fold(HASH_SEED, hash_word)
    };
    let cloths = solver.model.cloths.iter().map(of_cloth);
    let colliders = solver.model.colliders.iter().map(|collider| {
        corners(&collider.skin.triangles).chain([collider.positions.len() as u64]).fold(HASH_SEED, hash_word)
    });
    let masses = solver.state.inverse_mass.iter().map(|mass| mass.to_bits());
    let rows = [solver.contact.mutual.is_some() as u64, solver.contact.far.len() as u64];
    cloths.chain([0]).chain(colliders).chain(masses).chain(rows).fold(HASH_SEED, hash_word)
}

fn corners(triangles: &[[u32; 3]]) -> impl Iterator<Item = u64> + '_ {
    triangles.iter().flatten().map(|&point| u64::from(point))
}

/// Whether the model has every point, face and group that the restored contacts refer to. Contacts use them unchecked.
fn references_are_valid<R: Real>(solver: &Solver<R>) -> bool {
    let pairs = solver.contact.pairs.iter().all(|list| {
        pairs_are_valid(list, &solver.model.cloths[list.cloth], &solver.model.colliders[list.collider])
    });
    let mutual =
        solver.contact.mutual.as_ref().is_none_or(|mutual| mutual_is_valid(mutual, &solver.model.cloths));
    let in_range = |column: &[Vector3<f64>]| column.iter().all(is_in_range);
    let mut colliders = solver.contact.collider_states.iter();
    pairs && mutual && colliders.all(|collider| in_range(&collider.start) && in_range(&collider.end))
}

fn pairs_are_valid<R: Real>(list: &PairList<R>, cloth: &ClothModel<R>, collider: &ColliderModel) -> bool {
    let (groups, points) = (cloth.skin.groups(GROUP).count(), cloth.points());
    let is_ours = |ours: &[u32]| ours.iter().all(|point| points.contains(point));
    let is_theirs = |theirs: &[u32]| theirs.iter().all(|&point| (point as usize) < collider.positions.len());
    let is_valid = |group: u32, ours: &[u32], theirs: &[u32]| {
        (group as usize) < groups && is_ours(ours) && is_theirs(theirs)
    };
    let faces = collider.skin.triangles.len();
    list.point_face.iter().all(|pair| is_valid(pair.group, &pair.points, &pair.collider_points))
        && list.edge_edge.iter().all(|pair| is_valid(pair.group, &pair.points, &pair.collider_points))
        && list.face_point.iter().all(|pair| is_valid(pair.group, &pair.points, &pair.collider_points))
        && list.trapped.points.iter().all(|&(point, face)| is_ours(&[point]) && (face as usize) < faces)
        && is_ours(&list.trapped.suspects)
}

fn mutual_is_valid<R: Real>(mutual: &Mutual<R>, cloths: &[ClothModel<R>]) -> bool {
    let Mutual { terms, tangle, bodies, active, .. } = mutual;
    let rows = mutual.strayed.len();
    // Rows between the points of one cloth and those of the next are padding.
    let mut is_point = vec![false; rows];
    cloths.iter().flat_map(ClothModel::points).for_each(|row| is_point[row as usize] = true);
    let are_points = |points: &[u32]| {
        points.iter().all(|&point| is_point.get(point as usize).is_some_and(|&is_point| is_point))
    };
    (terms.is_empty() || terms.len() == cloths.len() * cloths.len())
        && active.point_face.iter().all(|near| near.fits(are_points, terms.len()))
        && active.edge_edge.iter().all(|near| near.fits(are_points, terms.len()))
        && active.point_edge.iter().all(|near| near.fits(are_points, terms.len()))
        && active.point_point.iter().all(|near| near.fits(are_points, terms.len()))
        && tangle.crossings.iter().all(|crossing| {
            are_points(&crossing.edge) && are_points(&crossing.wings) && are_points(&crossing.face)
        })
        && bodies.tree.as_ref().is_none_or(|tree| tree.is_over(bodies.groups.len()))
}

checkpoint_struct!([R: Real] State<R> {
    columns: [anchor, displacement, velocity, chambers, rotations],
    values: [wind_travel],
    parts: [],
    rebuilt: [start, led, parted, step_length, predicted, normal, area, gust, inverse_mass],
});

encode_struct!([] Chamber { start_volume: f64, volume: f64, amount: f64 });

checkpoint_struct!([R: Real] PairList<R> {
    columns: [],
    values: [span, point_face, edge_edge, face_point, trapped],
    parts: [],
    rebuilt: [cloth, collider, by_point, active, searched, again, tasks],
});

checkpoint_struct!([R: Real] Mutual<R> {
    columns: [strayed, began_at],
    values: [terms, span],
    parts: [bodies, paths, active, tangle],
    rebuilt: [room, held],
});

checkpoint_struct!([R: Real] Paths<R> { columns: [from, travel], values: [], parts: [], rebuilt: [] });

encode_struct!([R: Real] Terms<R> {
    thickness: f64, reach: f64, sides: [R; 2], friction: [R; 2], stickiness: [R; 2], bounce: [R; 2],
    strength: [R; 2], untangling: f64, traps: bool, mobility: [R; 2], elements: [Elements; 2], edges: bool,
});

encode_struct!([] Crossing { edge: [u32; 2], wings: [u32; 2], face: [u32; 3], remedy: Remedy });

impl Encode for Elements {
    const SIZE: usize = 1;
    fn encode(&self, out: &mut Vec<u8>) {
        let number: u8 = match self {
            Self::Points => 0,
            Self::Edges => 1,
            Self::Faces => 2,
        };
        number.encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        match u8::decode(from)? {
            0 => Some(Self::Points),
            1 => Some(Self::Edges),
            2 => Some(Self::Faces),
            _ => None,
        }
    }
}

impl Encode for Remedy {
    const SIZE: usize = 1;
    fn encode(&self, out: &mut Vec<u8>) {
        let number: u8 = match self {
            Self::Back(0) => 0,
            Self::Back(_) => 1,
            Self::Shorten => 2,
            Self::Wait => 3,
        };
        number.encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        match u8::decode(from)? {
            end @ (0 | 1) => Some(Self::Back(end.into())),
            2 => Some(Self::Shorten),
            3 => Some(Self::Wait),
            _ => None,
        }
    }
}
