//! Contact of cloth with colliders, with the ground plane, with itself and with other cloth (§2.3).
//!
//! **One contact** is a pair of elements (point and face, edge and edge, and for particles point and edge, point and
//! point), a unit normal and a thickness. The thickness is the sum of both sides' (a vertex map may scale it); elements
//! that are neighbours at rest keep half of their distance at rest if that is less. The gap is the distance of the two
//! elements along the normal.
//!
//! **One push.** A contact whose gap is below its thickness moves its points apart along the normal, each by inverse
//! mass times barycentric weight, in a Gauss-Seidel sweep. The part that undoes motion of this step changes velocity;
//! a depth from before the step is resolved at 1 m/s, without velocity. Where cloths overlap from the start, what another
//! contact reverses of that has no velocity either, or they would throw each other off; between other cloths it has, because
//! layers bear loads by it. Coulomb friction is a correction along the surface, at most friction times push ([`response`]).
//! Contacts among cloths carry a persistent friction anchor, so that stacks do not creep. Adhesion (stickiness) removes a share
//! of the separation speed; restitution is applied to velocities after the step ([`restitution`]).
//!
//! **One guarantee.** All motion within a time step is linear. For a fixed direction n, the gap between two elements is
//! the minimum over our points minus the maximum over theirs, and so a concave function of time. If it is positive at
//! both ends of the step, it was positive throughout, and the pair did not pass through each other. This certificate
//! needs no root of a cubic, and no conservative bound on time. Where no single direction serves, the step is
//! subdivided ([`ccd`]). The [`safeguard`] certifies every contact at the end of every step; where that fails it pushes,
//! scales thickness down, truncates motion at a division plane, and at last freezes the pair at the certified start of
//! the step. Each step thus starts and ends without intersections, as in Bridson, Fedkiw and Anderson (2002, *Robust
//! treatment of collisions, contact and friction for cloth animation*), Li et al. (2020, *Incremental potential contact*)
//! and Wu et al. (2020, *A safe and fast repulsion method for GPU-based cloth self collisions*). Pinned points and colliders
//! are not free to stop; pairs that they force through each other are counted as unresolved, and later untangled.
//!
//! **Completeness.** Each point has a motion bound over a candidate interval of several steps. The broad phase finds all
//! pairs that can touch while every point keeps its bound. Each step checks the bounds, and searches again only for points
//! that violate them. A pair whose bounds keep it above 2 % of its thickness needs no certificate.
//!
//! **Locality.** A cloth in contact depends on the colliders near it and on the cloths in its island alone. Splits of a
//! time step are the exception: they are chosen for the whole nucleus.
//!
//! | You want to know... | Read |
//! |---|---|
//! | boxes, and the bounding volume hierarchy | [`bvh`] |
//! | swept boxes, eight at a time | [`box_row`] |
//! | points, edges and triangles of a mesh, in groups; pseudonormals | [`boundary`] |
//! | force fields of surfaces, and of points | [`force_field`], [`point_field`] |
//! | the nearest point of a surface, and what a ray hits | [`placed_surface`] |
//! | elements that do not collide with each other | [`pair_filter`], updated by [`exclusion`] |
//! | the closest points of two elements; of a pair in each lane | [`narrow_phase`], [`closest_lanes`] |
//! | certificates for linear motion | [`ccd`] |
//! | contacts as tasks that threads share | [`colouring`] |
//! | thickness, friction and further attributes of a pair; vertex maps | [`material`], [`collider_maps`] |
//! | a value for each pair of objects | [`pair_table`] |
//! | the split of a push, friction, adhesion, the law of restitution | [`response`] |
//! | restitution at the end of a step; of rigid bodies | [`restitution`], [`rigid_impact`] |
//! | the positions that contacts read and write; counters | [`time_step`] |
//! | contact with colliders | [`collider`] |
//! | contact among cloths, friction anchors, untangling | [`cloth`] |
//! | the ground plane | [`ground`] |
//! | gaps that points keep from the start (Classic) | [`kept_gaps`] |
//! | clearance between surfaces that face each other | [`clearance`] |
//! | points inside a collider | [`depenetration`] |
//! | push-out of points near a surface | [`push_out`] |
//! | the state of contact, and the inputs and outputs of its passes | [`system`] |
//! | certificates and fallbacks at the end of a step | [`safeguard`], [`fallbacks`] |
//! | the contact state of each point, for observers | [`contact_state`] |
//! | what particles touch, for their rotation | [`touches`] |
//!
//! # Tuned constants
//!
//! Lengths in thicknesses (t) or mean edge lengths (e); times in time steps unless a unit is given.
//!
//! | Constant | Value | Reason |
//! |---|--:|---|
//! | `material::MIN_THICKNESS` | 10 µm | certificates need a gap above rounding error |
//! | `material::LIQUID_DISTANCE` | 0.8 rest distances | balls of two liquids; at larger ones they could not mix |
//! | `collider::start_gaps::START_GAP` | 20 µm | a point that starts in a surface begins on its outer side (Classic) |
//! | `response::DEPENETRATION_SPEED` | 1 m/s | a depth from before the step resolves without a jump |
//! | `response::ADHESION_RANGE` | 1.5 t | adhesion acts on contacts that have just separated |
//! | `response::TOUCHING_GAP` | 1e-3 t | gap that still counts as touching; distance at which a released seam does |
//! | `collider::broad_phase::WINDOW_MARGIN`, `INTERVAL_MARGIN` | 0.05 t, 0.5 t | smaller: more searches; larger: more contacts |
//! | `collider::motion_bounds::MAX_TRAVEL` | 2 e | longer boxes overlap too much |
//! | `collider::broad_phase::WINDOW_STEPS` | 8 | life of an active set |
//! | `collider::motion_bounds::TRAVEL_MARGIN` | 0.25 | of the predicted motion, for points that change course |
//! | `collider::query::GROUP_SIZE` | 2 triangles | fastest on a drape: 55 ms a frame, 67 with eight |
//! | `closest_lanes::NEEDLE` | 64 roundings | squared sine of a corner below which rounding is a percent of the area |
//! | `cloth::found_contacts::MANY_OVERLAPS` | 512 pairs | wait for the narrow phase, so that lanes are full |
//! | `collider::contact::PLANE_VALIDITY` | 1/256 of the rest gap | error of a plane around an edge below 1e-5 of it |
//! | `ccd::CERTIFIED_GAP` | 0.02 t | far above rounding error |
//! | `collider::sweep::MAX_ROUNDS` | 4 | over the contacts of one point while they push |
//! | `rigid_impact::IMPACT_DURATION` | 1/24 s | a body that springs back within a film frame looks rigid |
//! | `rigid_impact::ROUNDS` | 20 | impulses of a crate that lands on a face |
//! | `response::MIN_MOBILITY` | 0.25 | beside a pin no point moves farther than 4 depths |
//! | `clearance::FACING` | 0.5 | cosine: at a larger angle a point finds clearance beside the two surfaces |
//! | `response::TOUCH_TOLERANCE` | 1e-6 t | a contact at rest does not push at its last bit |
//! | `cloth::broad_phase::CANDIDATE_INTERVAL`, `MIN_INTERVAL_STEPS` | 10 ms, 4 | a drape takes a seventh longer with twice the length |
//! | `cloth::broad_phase::BOUND_RADIUS` | 0.4 t or 0.08 e | smaller: more searches; larger: more contacts |
//! | `cloth::motion_bounds::KEEP_SHARE` | 0.8 | of the radius, within which a bound is kept without search |
//! | `cloth::contact::OVERLAP` | 0.95 t | layers at rest keep more under their load |
//! | `cloth::local_anchors::ROUNDINGS` | 96 | rounding errors of the extent, in a gap and its certificate |
//! | `cloth::elements::GROUP_SIZE` | 8 triangles | within 10 % of the best on W3 |
//! | `cloth::element_bounds::REST_GAP_SHARE` | 0.5 | a cloth thicker than its faces must still bend |
//! | `cloth::certify::MAX_PLANE_APPROACH`, `MIN_PLANE_SHARE` | 0.9, 0.05 | the next step starts with a gap on both sides |
//! | `cloth::untangling::UNTANGLING_SPEED` | 12 e/s | half an edge length in a film frame |
//! | `cloth::untangling::OVERSHOOT`, `MIN_SLANT` | 1.25, 0.1 | an end returns past the face; an edge parallel to it gives no direction |
//! | `fallbacks::SEQUENCE` | 4 + 6, 8, 32 | attempts to push by all and by a share of the thickness, to truncate, to freeze |
//! | `schedule::adaptive` | 1 e, e / 64, 25 % | advance and strain at which steps are split |

pub mod boundary;
pub mod box_row;
pub mod bvh;
pub mod ccd;
pub mod clearance;
pub mod closest_lanes;
pub mod cloth;
pub mod collider;
pub mod collider_maps;
pub mod colouring;
pub mod contact_state;
pub mod depenetration;
pub mod exclusion;
pub mod fallbacks;
pub mod force_field;
pub mod ground;
pub mod kept_gaps;
pub mod material;
pub mod narrow_phase;
pub mod pair_filter;
pub mod pair_table;
pub mod placed_surface;
pub mod point_field;
pub mod push_out;
pub mod response;
pub mod restitution;
pub mod rigid_impact;
pub mod safeguard;
pub mod system;
pub mod time_step;
pub mod touches;
