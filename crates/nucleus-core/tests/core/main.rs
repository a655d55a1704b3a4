//! Tests of the solver as a library, without nodes and files.

mod air_and_fields;
mod analytic;
mod checkpoint;
mod classic;
mod collision;
mod contact_locality;
mod contact_response;
mod features;
mod fields;
mod invalid_input;
mod laws;
mod lifecycle;
mod link_order;
mod links;
mod liquids;
mod never_stuck;
mod particle_ramps;
mod particles;
mod rest;
mod scenes;
mod self_collision;
mod soft_bodies;
mod tears;
mod tethers;
mod vertex_maps;
mod weave;
