//! The passes of a time step over contacts among cloths, and the start of a frame.

use crate::constraints::link::lists::{ConstraintLinks, Links};
use crate::contact::cloth::broad_phase::update_cloth_candidates;
use crate::contact::cloth::cache::ContactCache;
use crate::contact::cloth::contact::{ClothStep, FrictionAnchors};
use crate::contact::cloth::contacts::{ClothContacts, ContactEffects};
use crate::contact::material::{ContactMaterial, MaterialMaps};
use crate::contact::pair_table::PairTable;
use crate::contact::system::{ContactPass, ContactSystem};
use crate::input::ClothId;
use crate::input::frame::FrameInput;
use crate::input::links::LinkSide;
use crate::math::{Real, Row4, sub};
use crate::output::{Stage, StepObserver};
use crate::schedule::TimeInterval;
use crate::state::State;

/// Sets the contact materials of this frame, and carries motion bounds over to it. Before anchors move.
pub fn begin_cloth_contact<R: Real>(state: &State<R>, contact: &mut ContactSystem<R>, frame: &FrameInput) {
    let ContactSystem { cloth_contacts: Some(cloth_contacts), material_maps, .. } = contact else { return };
    let cloths = frame.cloths.len();
    let materials = (0..cloths).flat_map(|cloth| materials_of(cloth, frame, material_maps)).collect();
    let materials = PairTable::new(cloths, materials);
    let is_full = |material: &Option<ContactMaterial<R>>| {
        material.as_ref().is_some_and(|material| !material.is_partial(material_maps))
    };
    // Pairs that could pass may intersect now. In the first frame all searches are due.
    let changed = |(now, before)| is_full(now) != is_full(before);
    for (at, pair) in materials.values().iter().zip(cloth_contacts.materials.values()).enumerate() {
        if changed(pair) {
            cloth_contacts.untangling.is_search_due[materials.pair(at)[0]] = true;
        }
    }
    cloth_contacts.effects = ContactEffects::of(&materials);
    let before = std::mem::replace(&mut cloth_contacts.materials, materials);
    cloth_contacts.search_changed(&before);
    cloth_contacts.local_anchors.clear();
    if !cloth_contacts.is_enabled() {
        cloth_contacts.bounds_violated.fill(true);
        cloth_contacts.cache = ContactCache::default(); // its bounds would not be checked
    }
    cloth_contacts.trajectories.shift_anchors(&state.displacement);
    for (interval_start, moved) in cloth_contacts.interval_start.iter_mut().zip(&state.displacement) {
        let [x, y, z] = sub(interval_start.xyz(), moved.xyz());
        *interval_start = Row4([x, y, z, R::ZERO]);
    }
    cloth_contacts.interval = TimeInterval { start: cloth_contacts.interval.start - 1.0, end: 0.0 };
}

/// Gives cloths that links join the same weight in their contact, whatever their layers: a contact that moves only one of
/// them, against a link that pulls both, would drive the two through space.
pub fn balance_joined_cloths<R: Real>(contact: &mut ContactSystem<R>, links: &Links<R>) {
    let ContactSystem { cloth_contacts: Some(ClothContacts { materials, .. }), .. } = contact else { return };
    let has_layers = |material: &ContactMaterial<R>| material.mobility != [R::ONE; 2];
    if !materials.present().any(has_layers) {
        return;
    }
    for link in links.constraints.iter().flat_map(ConstraintLinks::joining) {
        let [LinkSide::Cloth { cloth: a, .. }, LinkSide::Cloth { cloth: b, .. }] = link.sides else {
            continue;
        };
        for [ours, theirs] in [[a, b], [b, a]].map(|pair| pair.map(ClothId::index)) {
            materials[[ours, theirs]].iter_mut().for_each(|material| material.mobility = [R::ONE; 2]);
        }
    }
}

/// The contact materials of a cloth with itself and with every other cloth.
pub fn cloth_materials_of<R: Real>(
    contact: &ContactSystem<R>,
    frame: &FrameInput,
    cloth: usize,
) -> Vec<ContactMaterial<R>> {
    materials_of(cloth, frame, &contact.material_maps).flatten().collect()
}

/// One sweep over contacts among cloths. `thickness_scale` is a factor on every thickness.
pub fn resolve_cloth_contacts<R: Real>(
    pass: &mut ContactPass<'_, R>,
    thickness_scale: f64,
    watch: &mut dyn StepObserver,
) {
    if !pass.contact.cloth_contacts.as_ref().is_some_and(ClothContacts::is_enabled) {
        return;
    }
    watch.enter(Stage::BroadPhase);
    update_cloth_candidates(pass);
    watch.enter(Stage::Contact);
    let ContactPass { state, pool, contact, counters, schedule, .. } = pass;
    let ContactSystem {
        cloth_contacts: Some(cloth_contacts), material_maps, contact_mask, has_touched, ..
    } = &mut **contact
    else {
        return;
    };
    let mask = &contact_mask[..];
    let ClothContacts { elements, materials, cache, interval_start, local_anchors, untangling, .. } =
        cloth_contacts;
    if untangling.any() {
        let step = ClothStep { mask, ..ClothStep::new(state, materials, material_maps, schedule.h) };
        untangling.untangle(&step, elements, schedule.h);
    }
    let anchors = Some(FrictionAnchors { interval_start, intersecting: untangling.cloth_pairs() });
    let thickness_scale = R::from_f64(thickness_scale);
    let step = ClothStep {
        thickness_scale,
        local_anchors: Some(&*local_anchors),
        anchors,
        mask,
        ..ClothStep::new(state, materials, material_maps, schedule.h)
    };
    *counters.contacts.get_mut() += cache.sweep(&step, has_touched, pool);
}

/// Applies adhesion of cloth with itself and with other cloth.
pub fn apply_cloth_adhesion<R: Real>(pass: &mut ContactPass<'_, R>) {
    if pass.contact.cloth_contacts.as_ref().is_some_and(|contacts| contacts.effects.adhesion) {
        update_cloth_candidates(pass);
        pass.with_cloth_contacts(|cache, step, pool| cache.adhere(step, pool));
    }
}

/// The contact materials of a cloth with each cloth, itself among them.
fn materials_of<'a, R: Real>(
    cloth: usize,
    frame: &'a FrameInput,
    material_maps: &'a MaterialMaps<R>,
) -> impl Iterator<Item = Option<ContactMaterial<R>>> + 'a {
    let max_thickness_factor = &material_maps.max_thickness_factor;
    let own = &frame.cloths[cloth];
    frame.cloths.iter().enumerate().map(move |(at, other)| match at == cloth {
        true => ContactMaterial::for_self_collision(other, max_thickness_factor[cloth]),
        false => ContactMaterial::for_cloths(
            [own, other],
            [max_thickness_factor[cloth], max_thickness_factor[at]],
            frame.layer_range,
        ),
    })
}
