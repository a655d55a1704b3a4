//! Particles that fill a box or the volume of a closed mesh, in a cubic grid.
//!
//! Each particle stands for a cube of the grid's spacing, so a box is filled by as many cubes as fit into it, in its
//! middle, and the volume of a liquid is that of these cubes. A mesh is filled line by line: a line along x crosses a closed
//! surface an even number of times, and every second stretch between crossings is inside. Where the mesh is that of a cloth or
//! a collider, the particles begin outside of its contact distance: contact would push them out of it at the start, and them
//! and the cloth away from each other.

use nalgebra::Vector3;
use nucleus_core::Surface;

use crate::attributes::{Key, n_base, n_cloth, n_particle, surface_shape};
use crate::diagnostic::nearest;
use crate::graph::NodeId;
use crate::memory::{Cost, Size};
use crate::mesh::bounding_box;

use super::compiler::Compiler;
use super::constraints::near::are_near;
use super::liquids::{contact_radius, rest_distance};
use super::thickness::{CLOTH_SHARE, COLLIDER_SHARE, default_thickness};

/// Share of the spacing by which lines are moved aside, so that they meet no vertex or edge of a regular mesh.
const ASIDE: [f64; 2] = [1.234_567e-5, 2.345_678e-5];
/// Share of a cube that may be missing at the end of a box, for rounding.
const ROUNDING: f64 = 1e-6;

impl Compiler<'_> {
    /// Positions of the particles that fill a box and a mesh, in scene units; `listed` is the number of particles that
    /// are given one by one. `None` after an error, which is reported.
    pub(super) fn filled_positions(&mut self, node: NodeId, listed: usize) -> Option<Vec<Vector3<f64>>> {
        let mut filled = self.filled_box(node, listed)?;
        filled.extend(self.filled_mesh(node)?);
        Some(filled)
    }

    /// Distance of the particles in a grid, in scene units; `None` after an error.
    fn spacing(&mut self, node: NodeId) -> Option<f64> {
        let spacing = match self.start.get(node, &n_particle::PARTICLE_SPACING) {
            0.0 if self.start.get(node, &n_particle::ENABLE_SPH) => rest_distance(&self.start, node),
            0.0 => 2.0 * self.start.get(node, &n_particle::RADIUS),
            given => given,
        };
        if spacing > 0.0 {
            return Some(spacing);
        }
        let name = self.scene.graph.node(node).name();
        let message = format!("particles of `{name}` without radius cannot fill a volume");
        let error = self.findings.error(&self.scene.source.place(name), message);
        error.help("give them a `radius` or a `particleSpacing`");
        None
    }

    fn filled_box(&mut self, node: NodeId, listed: usize) -> Option<Vec<Vector3<f64>>> {
        let corners = [&n_particle::MINIMUM_CORNER, &n_particle::MAXIMUM_CORNER];
        if !corners.iter().any(|corner| self.scene.graph.is_given(node, *corner)) {
            return Some(Vec::new());
        }
        let [low, high] = corners.map(|corner| Vector3::from(self.start.get(node, corner)));
        let spacing = self.spacing(node)?;
        let name = self.scene.graph.node(node).name();
        if let Some(axis) = (0..3).find(|&axis| high[axis] <= low[axis]) {
            let axis = ["x", "y", "z"][axis];
            let message = format!("the box of `{name}` has no extent along {axis}");
            let error = self.findings.error(&self.place(node, &n_particle::MAXIMUM_CORNER.row), message);
            error.help("`maximumCorner` lies above `minimumCorner` along every axis");
            return None;
        }
        // A box that is thinner than a cube holds one layer. The grid is centred in the box.
        let cells = ((high - low) / spacing).map(|cells| (cells + ROUNDING).floor().max(1.0));
        self.claim_filling(node, cells.product() + listed as f64, &n_particle::MAXIMUM_CORNER)?;
        let first = first_centre(low, high, cells, spacing);
        let [x, y, z] = [0, 1, 2].map(|axis| 0..cells[axis] as u64);
        let places = y.flat_map(|y| {
            z.clone().flat_map({
                let x = x.clone();
                move |z| x.clone().map(move |x| [x, y, z])
            })
        });
        Some(places.map(|place| first + Vector3::from(place.map(|k| k as f64)) * spacing).collect())
    }

    fn filled_mesh(&mut self, node: NodeId) -> Option<Vec<Vector3<f64>>> {
        let mesh = self.start.get(node, &n_particle::FILL_MESH);
        if mesh.is_empty() {
            return Some(Vec::new());
        }
        let spacing = self.spacing(node)?;
        let graph = &self.scene.graph;
        let place = self.place(node, &n_particle::FILL_MESH.row);
        let is_mesh = |id: &NodeId| graph.node(*id).node_type().is_a(&surface_shape::SURFACE_SHAPE);
        let Some(id) = graph.find(&mesh).filter(is_mesh) else {
            let error = self.findings.error(&place, format!("there is no mesh `{mesh}` to fill"));
            let meshes = graph.of_type(&surface_shape::SURFACE_SHAPE).map(|(_, node)| node.name());
            error.did_you_mean(nearest(&mesh, meshes));
            return None;
        };
        if self.broken.contains(&id) {
            return None;
        }
        let placement = self.start.placement(id);
        let mut surface = self.geometry.surface(self.scene, id, self.findings)?.clone();
        if !self.geometry.is_fixed(self.scene, id, self.findings) {
            surface.positions =
                self.geometry.animated(self.scene, id, self.findings)?.at(&self.start).to_vec();
        }
        surface.positions.iter_mut().for_each(|position| *position = placement.point(*position));
        let [low, high] = bounding_box(&surface.positions);
        self.claim_filling(node, (high - low).map(|x| x / spacing + 1.0).product(), &n_particle::FILL_MESH)?;
        let mut filled = fill(&surface, spacing);
        let reach = self.contact_distance(node, id, &surface);
        if reach > 0.0 {
            // A particle at that distance, within rounding, stays.
            let corner = |&corner: &u32| surface.positions[corner as usize];
            let faces: Vec<Vec<_>> =
                surface.faces.iter().map(|face| face.iter().map(corner).collect()).collect();
            let are_near = are_near(&filled, &faces, reach * (1.0 - ROUNDING));
            let away = filled.into_iter().zip(are_near).filter(|(_, is_near)| !is_near);
            filled = away.map(|(place, _)| place).collect();
        }
        if filled.is_empty() {
            let error = self
                .findings
                .error(&place, format!("no particle of `{}` fits into `{mesh}`", graph.node(node).name()));
            error.help("fill a closed mesh that is larger than `particleSpacing`");
            return None;
        }
        Some(filled)
    }

    /// The distance in scene units that contact keeps between particles and the cloths and colliders with a mesh, which is
    /// `surface`; 0 where there are none.
    fn contact_distance(&self, particles: NodeId, mesh: NodeId, surface: &Surface) -> f64 {
        let (graph, start) = (&self.scene.graph, &self.start);
        let collides = |node: NodeId| start.get(node, &n_base::COLLIDE);
        let has_mesh = |node: &NodeId| graph.source(*node, &n_base::INPUT_MESH) == Some(mesh);
        let objects = graph.of_type(&n_base::N_BASE).map(|(node, _)| node).filter(has_mesh);
        let distance = |node: NodeId| {
            let is_cloth = graph.node(node).node_type().is_a(&n_cloth::N_CLOTH);
            let share = if is_cloth { CLOTH_SHARE } else { COLLIDER_SHARE };
            let given = graph.is_given(node, &n_base::THICKNESS).then(|| start.get(node, &n_base::THICKNESS));
            contact_radius(start, particles) + given.unwrap_or_else(|| default_thickness(surface, share))
        };
        objects.filter(|node| collides(*node) && collides(particles)).map(distance).fold(0.0, f64::max)
    }

    /// Claims the memory of particles before they are made.
    fn claim_filling<T>(&mut self, node: NodeId, count: f64, key: &Key<T>) -> Option<()> {
        let size = Size { points: count as u64, corners: 0 };
        let Err(refused) = self.geometry.budget.claim(Cost::CLOTH.of(size)) else { return Some(()) };
        if refused.is_first {
            let name = self.scene.graph.node(node).name();
            let message = format!("`{name}`, of about {count:.0} particles, takes {refused}");
            let error = self.findings.error(&self.place(node, &key.row), message);
            error.help(refused.help("give it a larger `particleSpacing`"));
        }
        None
    }
}

/// The centre of the lowest cube of a grid that is centred between two corners.
fn first_centre(low: Vector3<f64>, high: Vector3<f64>, cells: Vector3<f64>, spacing: f64) -> Vector3<f64> {
    (low + high) / 2.0 - (cells - Vector3::repeat(1.0)) * (spacing / 2.0)
}

/// The centres of the cubes of a grid that are inside a closed surface. The grid is centred in the surface's bounds.
fn fill(surface: &Surface, spacing: f64) -> Vec<Vector3<f64>> {
    let [low, high] = bounding_box(&surface.positions);
    let cells = ((high - low) / spacing).map(|cells| (cells + ROUNDING).floor().max(1.0));
    let first = first_centre(low, high, cells, spacing);
    let [layers, rows] = [1, 2].map(|axis| cells[axis] as usize);
    // The crossings of each line: coordinates along x.
    let mut crossings = vec![Vec::new(); layers * rows];
    for triangle in surface.faces.triangles() {
        let corners = triangle.map(|corner| surface.positions[corner as usize]);
        let lines = |axis: usize, count: usize| {
            let line = |x: f64| (x - first[axis]) / spacing;
            let [from, to] = [f64::min, f64::max]
                .map(|of| corners[1..].iter().fold(corners[0][axis], |x, c| of(x, c[axis])));
            (line(from) - 1.0).max(0.0) as usize..((line(to) + 2.0).max(0.0) as usize).min(count)
        };
        for layer in lines(1, layers) {
            for row in lines(2, rows) {
                let at = [
                    first.y + (layer as f64 + ASIDE[0]) * spacing,
                    first.z + (row as f64 + ASIDE[1]) * spacing,
                ];
                crossings[layer * rows + row].extend(crossing(&corners, at));
            }
        }
    }
    let mut filled = Vec::new();
    for (line, crossings) in crossings.iter_mut().enumerate() {
        crossings.sort_unstable_by(f64::total_cmp);
        let [y, z] = [line / rows, line % rows];
        for pair in crossings.chunks_exact(2) {
            let from = ((pair[0] - first.x) / spacing).ceil().max(0.0) as u64;
            let inside = (from..cells.x as u64).take_while(|&x| first.x + x as f64 * spacing <= pair[1]);
            filled.extend(inside.map(|x| first + Vector3::new(x as f64, y as f64, z as f64) * spacing));
        }
    }
    filled
}

/// Where a line along x, at this y and z, crosses a triangle.
fn crossing(corners: &[Vector3<f64>; 3], [y, z]: [f64; 2]) -> Option<f64> {
    // Twice the areas of the triangles that the line makes with the edges, in the yz plane.
    let areas: [f64; 3] = std::array::from_fn(|k| {
        let [a, b] = [corners[(k + 1) % 3], corners[(k + 2) % 3]];
        (a.y - y) * (b.z - z) - (b.y - y) * (a.z - z)
    });
    let all = areas.iter().sum::<f64>();
    let is_inside = areas.iter().all(|&area| area > 0.0) || areas.iter().all(|&area| area < 0.0);
    is_inside.then(|| areas.iter().zip(corners).map(|(area, corner)| area / all * corner.x).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Primitive;

    #[test]
    fn the_particles_in_a_sphere_have_its_volume() {
        let sphere = Primitive::Sphere(1.0, [60, 40]).surface().expect("a sphere");
        let filled = fill(&sphere, 0.05);
        let volume = filled.len() as f64 * 0.05f64.powi(3);
        let expected = 4.0 / 3.0 * std::f64::consts::PI;
        assert!((volume / expected - 1.0).abs() < 0.01, "{volume}");
        assert!(filled.iter().all(|place| place.norm() < 1.0));
    }

    #[test]
    fn a_cube_that_the_grid_fits_is_filled_to_its_faces() {
        let cube = Primitive::Cube([1.0; 3], [3; 3]).surface().expect("a cube");
        let filled = fill(&cube, 0.25);
        assert_eq!(filled.len(), 64);
        let [low, high] = filled.iter().fold([filled[0]; 2], |[l, h], p| [l.inf(p), h.sup(p)]);
        assert!(
            (low + Vector3::repeat(0.375)).amax() < 1e-12 && (high - Vector3::repeat(0.375)).amax() < 1e-12
        );
    }
}
