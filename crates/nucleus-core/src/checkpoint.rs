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
use crate::constraints::link::glue::find_pieces;
use crate::contact::cloth::contacts::{ClothContacts, ContactEffects};
use crate::contact::cloth::motion_bounds::Trajectories;
use crate::contact::cloth::untangling::{Correction, Intersection};
use crate::contact::collider::contacts::ColliderContacts;
use crate::contact::contact_state::seen_contact_states;
use crate::contact::material::ContactMaterial;
use crate::contact::pair_table::PairTable;
use crate::contact::system::ContactSystem;
use crate::input::frame::Elements;
use crate::input::validation::is_in_range;
use crate::math::Real;
use crate::model::builder::ModelBuilder;
use crate::model::objects::Cloth;
use crate::model::{ClothModel, ColliderModel};
use crate::output::ContactState;
use crate::particles::population::Population;
use crate::solver::Solver;
use crate::state::kinematics::update_anchors;
use crate::state::{Chamber, State, inverse_mass_of};

/// Name and version of the layout; the version goes up with every change of the layout.
const KIND: [u8; 8] = *b"solver19";

/// The state of a solver as bytes; see [`Solver::save`].
pub fn save<R: Real>(solver: &Solver<R>) -> Vec<u8> {
    let mut bytes = Vec::new();
    (R::SIZE as u8).encode(&mut bytes);
    let capacity =
        |population: &Population| solver.model.cloths[population.cloth()].blocks.rows().len() as u64;
    solver.state.populations.iter().map(capacity).collect::<Vec<_>>().encode(&mut bytes);
    fingerprint(solver).encode(&mut bytes);
    save_fields(solver, &mut bytes);
    save_pairs(solver, &mut bytes);
    save_rest(solver, &mut bytes);
    add_checksum(KIND, &bytes)
}

/// A solver that continues from where one of the same model was saved; see [`Solver::restored`].
///
/// It has the capacity for particles of the saved one, because rows are numbered by it, and refuses a builder that asks for
/// more: births would be lost.
pub fn restore<R: Real>(
    mut builder: ModelBuilder,
    threads: usize,
    bytes: &[u8],
) -> Result<Solver<R>, RestoreError> {
    let mut from = Reader::new(verify_checksum(KIND, bytes)?);
    let scalar = u8::decode(&mut from).ok_or(RestoreError::Damaged)?;
    if usize::from(scalar) != R::SIZE {
        return Err(RestoreError::Scalar { found: 8 * u32::from(scalar), wanted: 8 * R::SIZE as u32 });
    }
    let capacities: Vec<u64> = Encode::decode(&mut from).ok_or(RestoreError::Damaged)?;
    set_capacities(&mut builder, &capacities, bytes.len())?;
    let mut solver = Solver::build(builder, threads);
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

/// Bytes of a row in the columns that every checkpoint stores, at least.
const ROW_BYTES: u64 = size_of::<[f64; 3]>() as u64;

/// Gives each object of particles the capacity that it had. A damaged number must not take more memory than a checkpoint of so
/// many bytes can fill.
fn set_capacities(builder: &mut ModelBuilder, capacities: &[u64], bytes: usize) -> Result<(), RestoreError> {
    let mut objects: Vec<_> = builder.cloths.iter_mut().filter(|cloth| cloth.particles.is_some()).collect();
    let is_valid = |cloth: &&mut Cloth, capacity: u64| {
        capacity >= cloth.surface.positions.len() as u64 && capacity <= bytes as u64 / ROW_BYTES
    };
    if objects.len() != capacities.len()
        || !objects.iter().zip(capacities).all(|(cloth, &capacity)| is_valid(cloth, capacity))
    {
        return Err(RestoreError::OtherModel);
    }
    for (particles, &found) in objects.iter_mut().filter_map(|cloth| cloth.particles.as_mut()).zip(capacities)
    {
        let wanted = std::mem::replace(&mut particles.capacity, found as usize) as u64;
        if wanted > found {
            return Err(RestoreError::SmallerCapacity { found, wanted });
        }
    }
    Ok(())
}

/// Stores everything but the pairs. It names every field, so a new one does not compile until it is stored or named as
/// rebuilt.
fn save_fields<R: Real>(solver: &Solver<R>, out: &mut Vec<u8>) {
    // A liquid begins every frame anew, tethers follow from the pins of a frame, and surfaces are scratch memory.
    let Solver { model: _, state, contact, links, liquids: _, tethers: _, surfaces: _, pool: _ } = solver;
    // The ignored fields are rebuilt, or every frame writes them before it reads them.
    let ContactSystem {
        collider_states,
        collider_contacts: _,
        candidate_intervals: _,
        active_windows: _,
        frame_travel: _,
        window_bounds: _,
        bound_growth: _,
        contact_mask: _,
        carriers: _,
        obstacles: _,
        drift: _,
        has_unproven: _,
        has_touched: _,
        is_free: _,
        free_gap: _,
        free_tasks: _,
        row_states: _,
        restored_states: _,
        interval_bounds,
        bounds_violated,
        collider_materials,
        ground_materials,
        material_maps,
        cloth_contacts,
        pair_filter,
        bouncing: _,
        touches,
        ground,
    } = contact;
    interval_bounds.encode(out);
    bounds_violated.encode(out);
    collider_materials.encode(out);
    ground_materials.encode(out);
    touches.encode(out);
    material_maps.kept_gaps.encode(out);
    state.save(out);
    motions_without_velocity(state).encode(out);
    collider_states.save(out);
    cloth_contacts.save(out);
    ground.save(out);
    pair_filter.save(out);
    links.save(out);
    let states = seen_contact_states(&solver.model, state, contact);
    states.into_iter().map(|state| state as u8).collect::<Vec<_>>().encode(out);
}

fn load_fields<R: Real>(solver: &mut Solver<R>, from: &mut Reader<'_>) -> Option<()> {
    let Solver { model, state, contact, links, .. } = solver;
    // Empty where all points are free.
    contact.interval_bounds = Encode::decode(from)?;
    let rows = contact.interval_bounds.len();
    (rows == 0 || rows == state.anchor.len() && !model.colliders.is_empty()).then_some(())?;
    contact.resize_bounds(rows);
    load_column(&mut contact.bounds_violated, from)?;
    contact.collider_materials = PairTable::new(model.colliders.len(), Encode::decode(from)?);
    contact.ground_materials = Encode::decode(from)?;
    load_column(&mut contact.touches, from)?;
    contact.material_maps.kept_gaps = Encode::decode(from)?;
    state.load(from)?;
    state.displaced = Encode::decode(from)?;
    let is_ascending = state.displaced.is_sorted_by(|(row, _), (next, _)| row < next);
    let is_last_valid = state.displaced.last().is_none_or(|&(row, _)| (row as usize) < state.anchor.len());
    (is_ascending && is_last_valid).then_some(())?;
    for population in &mut state.populations {
        population.restored()?;
        let cloth = &mut model.cloths[population.cloth()];
        cloth.resize(population.len());
        let rows = cloth.blocks.rows().start as usize..;
        state.inverse_mass[rows.start..cloth.blocks.rows().end as usize].fill(R::ZERO);
        for (row, &mass) in rows.zip(population.masses()) {
            state.inverse_mass[row] = inverse_mass_of(mass);
        }
    }
    contact.collider_states.load(from)?;
    contact.cloth_contacts.load(from)?;
    contact.ground.load(from)?;
    contact.pair_filter.load(from)?;
    links.load(from)?;
    let states: Vec<u8> = Encode::decode(from)?;
    (states.is_empty() || states.len() == state.anchor.len()).then_some(())?;
    contact.restored_states = Some(states.into_iter().map(ContactState::from_byte).collect::<Option<_>>()?);
    Some(())
}

/// The points that contact has displaced without velocity in the last time step, in order, and their motion in m/s: what
/// an observer sees of a restored state, and an expression reads of a particle.
fn motions_without_velocity<R: Real>(state: &State<R>) -> Vec<(u32, [R; 3])> {
    let moved = |row: u32| {
        let (seen, own) = (state.seen_velocity(row), state.velocity[row as usize].xyz());
        (seen != own.map(R::to_f64)).then(|| (row, seen.map(R::from_f64)))
    };
    (0..state.velocity.len() as u32).filter_map(moved).collect()
}

/// Contacts of a cloth near a collider that moves are valid for one frame only: the checkpoint keeps of them the points
/// inside colliders.
fn save_pairs<R: Real>(solver: &Solver<R>, out: &mut Vec<u8>) {
    let lists = &solver.contact.collider_contacts;
    for list in lists {
        let mut near = lists.iter().filter(|other| other.cloth == list.cloth && other.is_near);
        let is_valid = !near.any(|list| solver.contact.collider_states[list.collider].moves);
        is_valid.encode(out);
        list.is_near.encode(out);
        if is_valid {
            list.save(out);
        } else {
            list.interval.encode(out);
            list.depenetration.encode(out);
        }
    }
}

fn load_pairs<R: Real>(solver: &mut Solver<R>, from: &mut Reader<'_>) -> Option<()> {
    for list in &mut solver.contact.collider_contacts {
        let is_valid = bool::decode(from)?;
        list.is_near = Encode::decode(from)?;
        if is_valid {
            list.load(from)?;
        } else {
            list.interval = Encode::decode(from)?;
            list.depenetration = Encode::decode(from)?;
        }
    }
    Some(())
}

/// Rest lengths and angles of cloth in which they can change.
fn save_rest<R: Real>(solver: &Solver<R>, out: &mut Vec<u8>) {
    for cloth in &solver.model.cloths {
        for list in [&cloth.stretch, &cloth.shear].into_iter().filter(|_| cloth.lists.plastic) {
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
        let plastic = cloth.lists.plastic;
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
    if let Some(ClothContacts { elements, materials, effects, .. }) = &mut solver.contact.cloth_contacts {
        elements.refit(&solver.pool);
        *effects = ContactEffects::of(materials);
    }
    let models = (&solver.model.cloths[..], &solver.model.colliders[..]);
    solver.links.rebuild(models);
    find_pieces(&mut solver.model.cloths, &solver.links);
    update_anchors(&mut solver.model.cloths, &solver.state.anchor, &solver.pool);
}

/// A hash of all points, faces, masses, lists and the shapes at rest, in the solver's order. Attributes may change from
/// frame to frame and are no part of it.
fn fingerprint<R: Real>(solver: &Solver<R>) -> u64 {
    let of_cloth = |cloth: &ClothModel<R>| {
        let order = cloth.order.places().iter().map(|&place| u64::from(place));
        let rows = [cloth.stretch.len(), cloth.shear.len(), cloth.bend.len(), cloth.bend_six.len()];
        let lists = rows.map(|length| length as u64);
        let flags = [
            u64::from(cloth.lists.damp),
            u64::from(cloth.alternates_direction),
            cloth.triangles.len() as u64,
        ];
        let boundary = corners(&cloth.boundary.triangles);
        // A checkpoint stores these as far as a cloth has them.
        let stored = [
            usize::from(cloth.lists.plastic),
            cloth.bend_angles.len(),
            cloth.bend_six_angles.len(),
            cloth.pressure.chambers(),
            cloth.shape.shells(),
        ];
        [cloth.blocks.max_len() as u64]
            .into_iter()
            .chain(order)
            .chain(lists)
            .chain(flags)
            .chain(boundary)
            .chain(stored.map(|count| count as u64))
            .chain([cloth.rest_shape])
            .fold(HASH_SEED, hash_word)
    };
    let cloths = solver.model.cloths.iter().map(of_cloth);
    let colliders = solver.model.colliders.iter().map(|collider| {
        corners(&collider.boundary.triangles)
            .chain([collider.positions.len() as u64])
            .fold(HASH_SEED, hash_word)
    });
    // The masses of particles that are born and die are part of the state.
    let is_fixed = |&at: &usize| solver.state.population_of(at).is_none();
    let fixed = (0..solver.model.cloths.len()).filter(is_fixed).map(|at| &solver.model.cloths[at]);
    let masses =
        fixed.flat_map(ClothModel::points).map(|row| solver.state.inverse_mass[row as usize].to_bits());
    let bounded = if solver.model.colliders.is_empty() { 0 } else { solver.state.anchor.len() };
    let rows = [solver.contact.cloth_contacts.is_some() as u64, bounded as u64];
    cloths.chain([0]).chain(colliders).chain(masses).chain(rows).fold(HASH_SEED, hash_word)
}

fn corners(triangles: &[[u32; 3]]) -> impl Iterator<Item = u64> + '_ {
    triangles.iter().flatten().map(|&point| u64::from(point))
}

/// Whether the model has every point, face and group that the restored contacts refer to. Contacts use them unchecked.
fn references_are_valid<R: Real>(solver: &Solver<R>) -> bool {
    let pairs = solver.contact.collider_contacts.iter().all(|list| {
        pairs_are_valid(list, &solver.model.cloths[list.cloth], &solver.model.colliders[list.collider])
    });
    let cloth_contacts = solver
        .contact
        .cloth_contacts
        .as_ref()
        .is_none_or(|contacts| cloth_contacts_are_valid(contacts, &solver.model.cloths));
    let in_range = |column: &[Vector3<f64>]| column.iter().all(is_in_range);
    let mut colliders = solver.contact.collider_states.iter();
    let links = solver.links.are_valid(&solver.model.cloths, &solver.model.colliders);
    let rows = solver.state.anchor.len();
    let sizes = solver.model.colliders.iter().map(|collider| collider.positions.len());
    let filter = solver.contact.pair_filter.is_valid(rows, sizes);
    links
        && solver.contact.material_maps.kept_gaps.is_valid(rows)
        && filter
        && pairs
        && cloth_contacts
        && colliders.all(|collider| in_range(&collider.start) && in_range(&collider.end))
}

fn pairs_are_valid<R: Real>(
    list: &ColliderContacts<R>,
    cloth: &ClothModel<R>,
    collider: &ColliderModel,
) -> bool {
    let points = cloth.points();
    let is_ours = |ours: &[u32]| ours.iter().all(|point| points.contains(point));
    let is_theirs = |theirs: &[u32]| theirs.iter().all(|&point| (point as usize) < collider.positions.len());
    let is_valid = |ours: &[u32], theirs: &[u32]| is_ours(ours) && is_theirs(theirs);
    let faces = collider.boundary.triangles.len();
    list.point_face.iter().all(|contact| is_valid(&contact.points, &contact.collider_points))
        && list.edge_edge.iter().all(|contact| is_valid(&contact.points, &contact.collider_points))
        && list.face_point.iter().all(|contact| is_valid(&contact.points, &contact.collider_points))
        && list.depenetration.points.iter().all(|&(point, face)| is_ours(&[point]) && (face as usize) < faces)
        && is_ours(&list.depenetration.suspects)
}

fn cloth_contacts_are_valid<R: Real>(cloth_contacts: &ClothContacts<R>, cloths: &[ClothModel<R>]) -> bool {
    let ClothContacts { materials, untangling, elements, cache, .. } = cloth_contacts;
    let rows = cloth_contacts.bounds_violated.len();
    // Rows between the points of one cloth and those of the next are padding.
    let mut is_point = vec![false; rows];
    cloths.iter().flat_map(ClothModel::points).for_each(|row| is_point[row as usize] = true);
    let are_points = |points: &[u32]| {
        points.iter().all(|&point| is_point.get(point as usize).is_some_and(|&is_point| is_point))
    };
    (materials.len() == 0 || materials.columns() == cloths.len())
        && cloth_contacts.overlapping.len() == materials.len()
        && cache.point_face.iter().all(|contact| contact.is_valid(are_points, materials.len()))
        && cache.edge_edge.iter().all(|contact| contact.is_valid(are_points, materials.len()))
        && cache.point_edge.iter().all(|contact| contact.is_valid(are_points, materials.len()))
        && cache.point_point.iter().all(|contact| contact.is_valid(are_points, materials.len()))
        && cache.is_sorted((&elements.block, elements.blocks))
        && untangling.intersections.iter().all(|intersection| {
            are_points(&intersection.edge)
                && are_points(&intersection.wings)
                && are_points(&intersection.face)
        })
        && elements.are_covered()
}

checkpoint_struct!([R: Real] State<R> {
    columns: [anchor, displacement, velocity, chambers, rotations],
    values: [frames, wind_travel],
    parts: [populations],
    rebuilt: [
        start, depenetration, bearing_depenetration, pushed_out, displaced, step_length, predicted, normal, corrections, area, inflation, added_wind,
        field, spins, inverse_mass
    ],
});

encode_struct!([] Chamber { start_volume: f64, volume: f64, amount: f64, torn: f64 });

checkpoint_struct!([R: Real] ColliderContacts<R> {
    columns: [],
    values: [interval, point_face, edge_edge, face_point, depenetration],
    parts: [],
    rebuilt: [cloth, collider, is_near, active, tasks, unproven],
});

checkpoint_struct!([R: Real] ClothContacts<R> {
    columns: [bounds_violated, interval_start],
    values: [materials, overlapping, interval],
    parts: [elements, trajectories, cache, untangling],
    rebuilt: [effects, buffers, frozen, local_anchors],
});

checkpoint_struct!([R: Real] Trajectories<R> { columns: [origin, travel], values: [], parts: [], rebuilt: [] });

encode_struct!([R: Real] ContactMaterial<R> {
    thickness: f64, adhesion_range: f64, thicknesses: [R; 2], friction: [R; 2], stickiness: [R; 2], bounce: [R; 2],
    strength: [R; 2], untangling_rate: f64, depenetrates: bool, mobility: [R; 2], elements: [Elements; 2], edges: bool,
    grips: bool,
});

encode_struct!([] Intersection { edge: [u32; 2], wings: [u32; 2], face: [u32; 3], correction: Correction });

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

impl Encode for Correction {
    const SIZE: usize = 1;
    fn encode(&self, out: &mut Vec<u8>) {
        let number: u8 = match self {
            Self::ReturnEnd(0) => 0,
            Self::ReturnEnd(_) => 1,
            Self::ShortenContour => 2,
            Self::None => 3,
        };
        number.encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        match u8::decode(from)? {
            end @ (0 | 1) => Some(Self::ReturnEnd(end.into())),
            2 => Some(Self::ShortenContour),
            3 => Some(Self::None),
            _ => None,
        }
    }
}
