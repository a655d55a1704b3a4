//! Cloth and colliders: from nodes to the model.

use nalgebra::Vector3;
use nucleus_core::{Cloth, ClothId, ClothLists, Collider, ColliderId, Mass, Start, Surface};

use crate::attributes::{Key, n_base, n_cloth, n_particle, n_rigid, nucleus, particle, surface_shape};
use crate::graph::{Graph, NodeId};
use crate::memory;
use crate::mesh::area;

use super::animated_mesh::AnimatedMesh;
use super::compiler::{CompiledNucleus, Compiler};
use super::constraints::split_mesh::Tearing;
use super::initial_state::PlacedObject;
use super::program::ObjectKind;
use super::soft_body;
use super::sources::{ClothSource, ColliderSource, MapScales, RecordedPoints};
use super::thickness::{CLOTH_SHARE, COLLIDER_SHARE, default_thickness, is_dense};
use super::units::{self, CLASSIC};
use super::vertex_maps::CompiledMaps;

/// Corners of a face above which its cross links are worth a warning: 1952 of 64 corners.
const MANY_CORNERS: usize = 64;

impl Compiler<'_> {
    /// Compiles all objects and constraints, except broken ones and those made from a broken mesh. The result is
    /// complete only if no errors were found.
    pub(super) fn compile(mut self) -> CompiledNucleus {
        let scene = self.scene;
        let active = self.members(&nucleus::INPUT_ACTIVE, &[&n_cloth::N_CLOTH, &n_particle::N_PARTICLE]);
        let is_cloth = |id: &NodeId| scene.graph.node(*id).node_type().is_a(&n_cloth::N_CLOTH);
        let (cloths, particles): (Vec<NodeId>, Vec<NodeId>) = active.into_iter().partition(is_cloth);
        for placed in self.placed_meshes(cloths) {
            self.cloth(placed);
        }
        let placed = self.placed_particles(particles);
        let first = self.program.model.cloths().len() as u32;
        self.particle_ids = placed.iter().zip(first..).map(|(placed, at)| (placed.id, ClothId(at))).collect();
        for placed in placed {
            self.particles(placed);
        }
        let passive = self.members(&nucleus::INPUT_PASSIVE, &[&n_rigid::N_RIGID]);
        for placed in self.placed_meshes(passive) {
            self.collider(placed);
        }
        self.program.attachments = self.attachments();
        self.order_links();
        self.program.constraints = self.constraint_sources();
        self.program.fields = self.fields();
        let cloths = self.program.cloths.iter().map(|cloth| cloth.node);
        let objects: Vec<NodeId> =
            cloths.chain(self.program.colliders.iter().map(|collider| collider.node)).collect();
        self.check_widths(&objects);
        if !self.objects.is_empty() {
            units::check_time_input(self.scene, self.program.node, self.findings);
            self.warn_of_bounce(self.program.node, &nucleus::PLANE_BOUNCE);
            self.warn_of_zero_directions();
            self.warn_of_frame_jumps();
            let emitters = self.program.emitters.iter().map(|emitter| emitter.node);
            let fields = self.program.fields.iter().map(|field| field.node);
            let nodes: Vec<NodeId> =
                std::iter::once(self.program.node).chain(emitters).chain(fields).collect();
            nodes.into_iter().for_each(|node| self.warn_of_contradictions(node));
        }
        CompiledNucleus { program: self.program, objects: self.objects, mass: self.mass }
    }

    fn cloth(&mut self, PlacedObject { id, mesh, surface }: PlacedObject) -> Option<()> {
        self.check_inputs(id, &[particle::CURRENT_TIME.row.name, n_base::NEXT_STATE.row.name]);
        let default_thickness = default_thickness(&surface, CLOTH_SHARE);
        let is_dense = is_dense(&surface, CLOTH_SHARE);
        let rest = self.rest_surface(id, mesh, &surface)?;
        let warp = self.warp(id, mesh, rest.as_ref().unwrap_or(&surface))?;
        self.check_pressure(id, &surface);
        self.warn_of_contradictions(id);
        let given = surface.positions.len();
        let tearing = self.tearing(id, mesh, &surface);
        let (surface, moved) = self.rest_and_start(surface, rest, tearing.as_ref());
        self.warn_of_stiffness(id);
        let (CompiledMaps { scales, vertex_maps }, mut start, recorded) =
            self.maps_and_start(id, mesh, given, tearing.as_ref())?;
        if start.positions.is_empty() {
            start.positions = moved.unwrap_or_default();
        }
        self.perturb(id, &surface, &mut start.positions);
        let mass = self.mass_of(id, &scales);
        self.warn_of_free_points(self.scene.graph.node(id).name(), mesh, &surface);
        let lists = constraint_lists(&self.scene.graph, id, self.program.node, &scales);
        self.check_polygons([id, mesh], &surface, lists)?;
        let followed = self.followed_mesh(id, mesh, &vertex_maps.input_attract);
        let (faces, area) = (surface.faces.len(), area(&surface.faces, &surface.positions));
        let split_off = tearing.as_ref().map_or_else(Vec::new, |tearing| tearing.twins.clone());
        let cloth = Cloth { surface, mass, lists, warp, vertex_maps, start, particles: None, split_off };
        self.add_cloth(id, mesh, cloth, given, area)?;
        self.program.cloths.push(ClothSource {
            node: id,
            is_particles: false,
            default_thickness,
            is_dense,
            scales,
            faces,
            area,
            followed,
            tearing,
            recorded,
        });
        Some(())
    }

    /// The mesh of the solver, in metres and with its twins, and the positions that it starts at where they are others: the rest
    /// shape is the mesh to the solver, and the input mesh then is the start.
    fn rest_and_start(
        &self,
        input: Surface,
        rest: Option<Surface>,
        tearing: Option<&Tearing>,
    ) -> (Surface, Option<Vec<Vector3<f64>>>) {
        let in_metres = |surface| {
            let surface = self.program.units.surface(surface);
            match tearing {
                Some(tearing) => tearing.split(surface),
                None => surface,
            }
        };
        let input = in_metres(input);
        match rest.map(in_metres) {
            Some(rest) => (rest, Some(input.positions)),
            None => (input, None),
        }
    }

    /// Vertex maps, start and recorded points of a cloth of so many points, with the twins of those that can tear apart.
    fn maps_and_start(
        &mut self,
        id: NodeId,
        mesh: NodeId,
        points: usize,
        tearing: Option<&Tearing>,
    ) -> Option<(CompiledMaps, Start, Option<RecordedPoints>)> {
        let maps = self.vertex_maps(id, mesh, points);
        let start = self.start_state(id, mesh, points, tearing);
        let (mut maps, mut start) = (maps?, start?);
        let mut recorded = self.recorded(id, Some((mesh, points)))?;
        if let Some(positions) = recorded.as_ref().and_then(|recorded| recorded.at(self.start.frame())) {
            start.positions = positions.to_vec();
        }
        if let Some(tearing) = tearing {
            maps.vertex_maps = tearing.maps(maps.vertex_maps, self.is_classic());
            for column in [&mut start.positions, &mut start.velocities] {
                // A state of the split mesh has the twins already.
                if column.len() == points {
                    tearing.extend(column);
                }
            }
            recorded.iter_mut().for_each(|recorded| recorded.extend(tearing));
        }
        Some((maps, start, recorded))
    }

    /// The mass of the points of a cloth.
    fn mass_of(&self, id: NodeId, scales: &MapScales) -> Mass {
        let point_mass = self.start.get(id, &n_base::POINT_MASS) * scales.mass;
        if self.is_classic() { Mass::PerPoint(point_mass) } else { Mass::PerArea(point_mass) }
    }

    fn is_classic(&self) -> bool {
        self.start.get(self.program.node, &nucleus::RESISTANCE_MODEL) == CLASSIC
    }

    /// Adds a cloth to the model. Its mesh was given with so many points, and has an area in m².
    fn add_cloth(&mut self, id: NodeId, mesh: NodeId, cloth: Cloth, given: usize, area: f64) -> Option<()> {
        let (points, faces) = (cloth.surface.positions.len(), cloth.surface.faces.clone());
        let kilograms = match cloth.mass {
            _ if !cloth.vertex_maps.mass.is_empty() => cloth.point_masses().iter().sum(),
            Mass::PerPoint(mass) => mass * points as f64,
            Mass::PerArea(mass) => mass * area,
        };
        match self.program.model.cloth(cloth) {
            Ok(cloth) => {
                let kind = ObjectKind::Cloth(ClothId(self.program.first_cloth + cloth.0));
                self.add_object(id, kind, points, faces, kilograms);
                if let Some(object) = self.objects.last_mut() {
                    object.mesh_points = given;
                }
                Some(())
            }
            Err(error) => self.report_refused(id, mesh, &error),
        }
    }

    /// The Classic resistance model has no use for a stiffness.
    fn warn_of_stiffness(&mut self, cloth: NodeId) {
        use n_cloth::{
            BEND_STIFFNESS, COMPRESSION_STIFFNESS, SHEAR_STIFFNESS, STRETCH_STIFFNESS, WARP_STIFFNESS,
            WEFT_STIFFNESS,
        };
        let keys = [
            &STRETCH_STIFFNESS,
            &COMPRESSION_STIFFNESS,
            &SHEAR_STIFFNESS,
            &BEND_STIFFNESS,
            &WARP_STIFFNESS,
            &WEFT_STIFFNESS,
        ];
        let node = self.scene.graph.node(cloth);
        if !self.is_classic() {
            return;
        }
        for key in keys {
            if node.setting(key).is_some() && (node.changes(key) || node.get(key) >= 0.0) {
                let message = format!(
                    "`{}` of `{}` has no effect: with `resistanceModel: classic` stiffness follows from counts",
                    key.row.name,
                    node.name()
                );
                self.findings
                    .warning(&self.scene.source.place(&format!("{}.{}", node.name(), key.row.name)), message);
            }
        }
    }

    /// Claims the memory of the cross links of polygons, whose number grows with the square of the corners, and warns of
    /// large ones.
    fn check_polygons(
        &mut self,
        [cloth, mesh]: [NodeId; 2],
        surface: &Surface,
        lists: ClothLists,
    ) -> Option<()> {
        let sets = u64::from(lists.cross_links) + u64::from(lists.shear);
        if sets == 0 {
            return Some(());
        }
        let links = |face: &[u32]| sets * face.len() as u64 * (face.len() as u64).saturating_sub(3) / 2;
        let polygons = surface.faces.iter().filter(|face| face.len() > 4);
        let all: u64 = polygons.map(links).sum();
        let what = format!("with {all} cross links");
        self.claim_bytes([cloth, mesh], &what, all.saturating_mul(memory::CROSS_LINK))?;
        let largest =
            surface.faces.iter().max_by_key(|face| face.len()).filter(|face| face.len() > MANY_CORNERS);
        if let Some(face) = largest {
            let [cloth, place] = [cloth, mesh].map(|id| self.scene.graph.node(id).name());
            let message = format!(
                "`{cloth}` has a face of {} corners, which takes {} cross links",
                face.len(),
                links(face)
            );
            let warning = self.findings.warning(&self.scene.source.place(place), message);
            warning.help("split it into triangles or quads, or write `addCrossLinks: false`");
        }
        Some(())
    }

    /// Points without a face have no constraints: they fall freely, which is rarely intended.
    fn warn_of_free_points(&mut self, cloth: &str, mesh: NodeId, surface: &Surface) {
        let mut in_face = vec![false; surface.positions.len()];
        surface.faces.corners().iter().for_each(|&point| in_face[point as usize] = true);
        let free = in_face.iter().filter(|in_face| !**in_face).count();
        let Some(first) = in_face.iter().position(|in_face| !in_face) else { return };
        let message = match free {
            all if all == in_face.len() => format!("`{cloth}` has no face, only free points"),
            1 => format!("`{cloth}` has 1 point of no face, point {first}: it is free"),
            free => {
                format!("`{cloth}` has {free} points of no face, the first is point {first}: they are free")
            }
        };
        let place = self.scene.source.place(self.scene.graph.node(mesh).name());
        let warning = self.findings.warning(&place, message);
        warning
            .help("take them out of the mesh, or hold them by a constraint, if they are not meant to fall");
    }

    fn collider(&mut self, PlacedObject { id, mesh, surface }: PlacedObject) -> Option<()> {
        self.check_inputs(id, &[particle::CURRENT_TIME.row.name]);
        let default_thickness = default_thickness(&surface, COLLIDER_SHARE);
        let motion = self.collider_motion(mesh)?;
        self.warn_of_contradictions(id);
        self.warn_of_recorded_collider(id, mesh);
        let surface = self.program.units.surface(surface);
        let (points, faces) = (surface.positions.len(), surface.faces.clone());
        let maps = self.collider_maps(id, mesh, points)?;
        let added = self.program.model.collider(Collider { surface }).and_then(|collider| {
            self.program.model.set_collider_maps(collider, maps)?;
            Ok(collider)
        });
        match added {
            Ok(collider) => {
                let kind = ObjectKind::Collider(ColliderId(self.program.first_collider + collider.0));
                self.add_object(id, kind, points, faces, 0.0);
            }
            Err(error) => return self.report_refused(id, mesh, &error),
        }
        self.program.colliders.push(ColliderSource { node: id, mesh, default_thickness, motion });
        Some(())
    }

    /// The animated mesh of a collider, or `Some(None)` if it never moves; `None` after an error, which is reported.
    fn collider_motion(&mut self, mesh: NodeId) -> Option<Option<AnimatedMesh>> {
        let graph = &self.scene.graph;
        if !graph.moves(mesh) && self.geometry.is_fixed(self.scene, mesh, self.findings) {
            return Some(None);
        }
        let animated = self.geometry.animated(self.scene, mesh, self.findings)?;
        let blends = |node| graph.changes(node, &surface_shape::BLEND);
        Some((graph.moves(mesh) || animated.changes(&blends)).then_some(animated))
    }
}

/// The constraint lists of a cloth: those whose attribute is ever other than zero (N2.2-7).
fn constraint_lists(graph: &Graph, cloth: NodeId, nucleus: NodeId, scales: &MapScales) -> ClothLists {
    use n_cloth::{
        ADD_CROSS_LINKS, BEND_RESISTANCE, BEND_STIFFNESS, BUCKLING, COMPRESSION_RESISTANCE,
        COMPRESSION_STIFFNESS, DRAG, LIFT, LONG_LINKS, SHEAR_RESISTANCE, SHEAR_STIFFNESS, STRETCH_DAMP,
        STRETCH_RESISTANCE, STRETCH_STIFFNESS, TETHERS, WARP_STIFFNESS, WEAVE, WEFT_STIFFNESS,
    };
    let used = |key, scale: f64| scale != 0.0 && graph.is_ever_nonzero(cloth, key);
    let node = graph.node(cloth);
    let classic = graph.node(nucleus).get(&nucleus::RESISTANCE_MODEL) == CLASSIC;
    let resists = |resistance: &Key<f64>, stiffness: &Key<f64>, scale: f64| match node.setting(stiffness) {
        _ if scale == 0.0 => false,
        _ if !classic && graph.changes(cloth, stiffness) => true,
        Some(_) if !classic && node.get(stiffness) >= 0.0 => node.get(stiffness) > 0.0,
        _ => graph.is_ever_nonzero(cloth, resistance),
    };
    let stretch = resists(&STRETCH_RESISTANCE, &STRETCH_STIFFNESS, scales.stretch)
        || resists(&COMPRESSION_RESISTANCE, &COMPRESSION_STIFFNESS, scales.compression);
    let woven = !classic && node.get(&WEAVE);
    let threads = [&WARP_STIFFNESS, &WEFT_STIFFNESS];
    let stretch =
        stretch || woven && threads.into_iter().any(|own| resists(&STRETCH_RESISTANCE, own, scales.stretch));
    let lists = ClothLists {
        stretch,
        cross_links: stretch && !woven && node.get(&ADD_CROSS_LINKS),
        shear: resists(&SHEAR_RESISTANCE, &SHEAR_STIFFNESS, 1.0),
        bend: resists(&BEND_RESISTANCE, &BEND_STIFFNESS, scales.bend),
        air: (used(&DRAG, scales.drag) || used(&LIFT, scales.lift))
            && graph.is_ever_nonzero(nucleus, &nucleus::AIR_DENSITY),
        damp: used(&STRETCH_DAMP, 1.0) || used(&n_base::DAMP, scales.damp),
        self_collision: graph.is_ever_nonzero(cloth, &n_base::SELF_COLLIDE),
        tethers: graph.is_ever_nonzero(cloth, &TETHERS),
        long_links: graph.is_ever_nonzero(cloth, &LONG_LINKS),
        buckling: stretch && !classic && graph.is_ever_nonzero(cloth, &BUCKLING),
        ..ClothLists::NONE
    };
    soft_body::lists(graph, cloth, lists)
}
