//! From the mesh of a cloth to its lists of rows: links, hinges, chambers, shapes, maps and elements of contact.

use std::ops::Range;

use crate::bytes::hash_word;
use crate::constraints::hinge::{self, HingeRow, RestGroup};
use crate::constraints::pressure::PressureModel;
use crate::constraints::shape::ShapeModel;
use crate::constraints::stretch::{LinkRow, shear_rows};
use crate::contact::boundary::{BoundaryElements, sort_spatially};
use crate::math::Real;
use crate::model::ClothModel;
use crate::model::blocks::{Blocks, triangles_by_block};
use crate::model::link_order;
use crate::model::objects::{Cloth, LinkOrder, Mass, point_masses};
use crate::model::order::Order;
use crate::model::rows::RowList;
use crate::model::strength_maps::{MapReader, StrengthMaps, weave_of};
use crate::model::topology::{Link, rows_of_parts, stretch_links};
use crate::model::vertex_maps::mean;
use crate::model::weave::woven_links;

/// Compiles a cloth whose first row in the columns is `first`. `collides`: contact is possible.
pub fn compile_cloth<R: Real>(
    cloth: &Cloth,
    link_order: &LinkOrder,
    first: u32,
    collides: bool,
) -> ClothModel<R> {
    let surface = &cloth.surface;
    let capacity = cloth.particles.as_ref().map_or(0, |particles| particles.capacity);
    let rows = surface.positions.len().max(capacity);
    let order = match cloth.particles {
        Some(_) => Order::identity(rows),
        None => Order::morton(&surface.positions),
    };
    let blocks = Blocks::new(first, rows);
    let (Mass::PerPoint(point_mass) | Mass::PerArea(point_mass)) = cloth.mass;
    let mut model = ClothModel {
        lists: cloth.lists,
        order,
        blocks,
        stretch: RowList::default(),
        shear: RowList::default(),
        bend: RowList::default(),
        bend_six: RowList::default(),
        bend_rest: RowList::default(),
        bend_six_rest: RowList::default(),
        bend_angles: RowList::default(),
        bend_six_angles: RowList::default(),
        pressure: PressureModel::default(),
        shape: ShapeModel::default(),
        has_faces: !surface.faces.is_empty(),
        attract: cloth.vertex_maps.input_attract.clone(),
        triangles: Vec::new(),
        parts: Vec::new(),
        boundary: BoundaryElements::default(),
        alternates_direction: cloth.lists.cross_links
            || !cloth.warp.is_empty()
            || surface.faces.iter().any(|face| face.len() % 2 == 1),
        point_mass,
        is_mass_per_area: matches!(cloth.mass, Mass::PerArea(_)),
        mass_map: Vec::new(),
        edge_length: 0.0,
        rest_shape: rest_shape(cloth),
        strength_maps: StrengthMaps::default(),
        air: Vec::new(),
        field_map: Vec::new(),
        valence: Vec::new(),
    };
    let (order, blocks) = (model.order.clone(), model.blocks.clone());
    let compiler = ListCompiler { cloth, link_order, first, order: &order, blocks: &blocks };
    compiler.fill(&mut model, collides);
    model
}

/// Makes the lists of one cloth.
struct ListCompiler<'a> {
    /// The cloth as given.
    cloth: &'a Cloth,
    /// The order of its links.
    link_order: &'a LinkOrder,
    /// Its first row in the columns.
    first: u32,
    /// Between points of the mesh and places.
    order: &'a Order,
    /// Its rows, in blocks.
    blocks: &'a Blocks,
}

impl ListCompiler<'_> {
    /// Fills all lists that the cloth may need. `collides`: contact is possible.
    fn fill<R: Real>(&self, model: &mut ClothModel<R>, collides: bool) {
        let lists = &self.cloth.lists;
        let distances = link_order::distances(&self.cloth.surface, self.link_order);
        if lists.stretch {
            self.stretch(model, &distances);
        }
        if lists.shear {
            self.shear(model, &distances);
        }
        if lists.bend {
            self.bend(model);
        }
        if lists.pressure {
            let Cloth { surface, split_off, .. } = self.cloth;
            model.pressure = PressureModel::new(surface, split_off, |point| self.row(point), self.blocks);
        }
        if lists.shape {
            self.shape(model);
        }
        if lists.air {
            model.air = self.maps().air(self.rows());
            model.triangles = triangles_by_block(&self.cloth.surface, |point| self.row(point), self.blocks);
        }
        let maps = &self.cloth.vertex_maps;
        [model.field_map, model.mass_map] = [&maps.field_magnitude, &maps.mass].map(|map| self.by_row(map));
        if *self.link_order == LinkOrder::Parallel {
            let groups = model.stretch.groups().iter().chain(model.shear.groups());
            model.valence = link_order::valence(groups, self.first, self.blocks.row_count());
        }
        if collides {
            self.contact(model);
        }
    }

    /// Links along edges and, with `addCrossLinks`, cross links.
    fn stretch<R: Real>(&self, model: &mut ClothModel<R>, distances: &[u32]) {
        model.parts = rows_of_parts(&self.cloth.surface, |point| self.row(point));
        let mut rows = self.stretch_rows();
        if *self.link_order != LinkOrder::Mesh {
            rows.sort_unstable_by_key(|row| (row.ends[0].min(row.ends[1]), row.ends[0].max(row.ends[1])));
        }
        let levels = self.levels(&rows, distances);
        model.strength_maps.stretch = self.maps().links(&rows, &levels);
        model.strength_maps.damp = self.maps().damping(&rows, &levels);
        if self.cloth.lists.buckling || !self.cloth.warp.is_empty() {
            model.strength_maps.stretch_weave = weave_of(&rows, &levels, self.blocks);
        }
        model.stretch = RowList::in_levels(&rows, &levels, self.blocks);
    }

    fn stretch_rows<R: Real>(&self) -> Vec<LinkRow<R>> {
        let Cloth { surface, warp, lists, vertex_maps, .. } = self.cloth;
        let links = match warp.is_empty() {
            true => stretch_links(surface, lists.cross_links),
            false => woven_links(surface, warp).edges,
        };
        let rest =
            |link: &Link| mean(&vertex_maps.rest_length, link.ends.map(|end| end as usize).into_iter());
        links.iter().map(|link| LinkRow::new(link, rest(link), |point| self.row(point))).collect()
    }

    /// Cross links with the shear resistance.
    fn shear<R: Real>(&self, model: &mut ClothModel<R>, distances: &[u32]) {
        let Cloth { surface, warp, vertex_maps, .. } = self.cloth;
        let rows = shear_rows(surface, warp, &vertex_maps.rest_length, |point| self.row(point));
        let levels = self.levels(&rows, distances);
        if !warp.is_empty() {
            model.strength_maps.shear_weave = weave_of(&rows, &levels, self.blocks);
        }
        model.shear = RowList::in_levels(&rows, &levels, self.blocks);
    }

    /// Hinges between faces and twists of quads, with their shape at rest.
    fn bend<R: Real>(&self, model: &mut ClothModel<R>) {
        let (surface, lists, blocks) = (&self.cloth.surface, &self.cloth.lists, self.blocks);
        let rows = hinge::rows(surface, |point| self.row(point));
        let maps = self.maps();
        model.strength_maps.bend = maps.hinges(&rows.of_four);
        model.strength_maps.bend_six = maps.hinges(&rows.of_six);
        model.bend = RowList::new(&rows.of_four, blocks);
        model.bend_six = RowList::new(&rows.of_six, blocks);
        model.bend_rest = rests(&rows.of_four, blocks);
        model.bend_six_rest = rests(&rows.of_six, blocks);
        let is_bent = model.bend_rest.len() + model.bend_six_rest.len() > 0;
        if lists.bend_angles || lists.signed_bend && is_bent {
            let point = |row: u32| maps.point(row);
            let four: Vec<_> = rows.of_four.iter().map(|row| row.angle(surface, point)).collect();
            let six: Vec<_> = rows.of_six.iter().map(|row| row.angle(surface, point)).collect();
            model.bend_angles = RowList::new(&four, blocks);
            model.bend_six_angles = RowList::new(&six, blocks);
            model.strength_maps.angles = maps.angles(&rows.of_four);
            model.strength_maps.angles_six = maps.angles(&rows.of_six);
        }
    }

    /// The shapes that it is pulled back to.
    fn shape<R: Real>(&self, model: &mut ClothModel<R>) {
        let Cloth { surface, vertex_maps, lists, .. } = self.cloth;
        let masses = point_masses(self.cloth);
        let maps: [&[f64]; 2] = [&vertex_maps.rigidity, &vertex_maps.deform];
        model.shape = ShapeModel::new(surface, |point| self.row(point), &masses, maps, lists.shells);
    }

    /// The elements of contact.
    fn contact<R: Real>(&self, model: &mut ClothModel<R>) {
        let surface = &self.cloth.surface;
        let triangles: Vec<_> = surface.faces.triangles().collect();
        let triangles = sort_spatially(&triangles, |point| surface.positions[point as usize]);
        let triangles = triangles.into_iter().map(|triangle| triangle.map(|point| self.row(point))).collect();
        model.boundary = BoundaryElements::new(triangles, self.rows());
        let links = stretch_links(surface, false);
        model.edge_length =
            links.iter().map(|link| link.rest_length).sum::<f64>() / links.len().max(1) as f64;
    }

    /// The order in which links are swept.
    fn levels<R: Real>(&self, rows: &[LinkRow<R>], distances: &[u32]) -> Vec<u32> {
        match self.link_order {
            LinkOrder::Mesh => link_order::levels_of_list(rows, self.first, self.blocks.row_count()),
            _ => link_order::levels(rows, distances, |row| self.maps().point(row)),
        }
    }

    /// A vertex map by row; empty where there is none. Rows for particles yet to be born have a factor of 1.
    fn by_row(&self, map: &[f64]) -> Vec<f64> {
        let factor = |row: u32| map.get(self.maps().point(row)).copied().unwrap_or(1.0);
        self.rows().filter(|_| !map.is_empty()).map(factor).collect()
    }

    fn maps(&self) -> MapReader<'_> {
        let Self { first, order, blocks, .. } = *self;
        MapReader { maps: &self.cloth.vertex_maps, order, first, blocks }
    }

    /// The row of a point of the mesh.
    fn row(&self, point: u32) -> u32 {
        self.first + self.order.place(point as usize)
    }

    fn rows(&self) -> Range<u32> {
        self.blocks.rows()
    }
}

/// The lengths of the bending vectors at rest; empty where all hinges are flat.
fn rests<R: Real, const N: usize>(rows: &[HingeRow<R, N>], blocks: &Blocks) -> RowList<RestGroup<R>> {
    if !rows.iter().any(HingeRow::is_bent) {
        return RowList::default();
    }
    RowList::new(&rows.iter().map(HingeRow::at_rest).collect::<Vec<_>>(), blocks)
}

/// A hash of the positions of a cloth at rest; zero for particles.
fn rest_shape(cloth: &Cloth) -> u64 {
    let positions = cloth.surface.positions.iter().filter(|_| cloth.particles.is_none());
    positions.flat_map(|p| [p.x, p.y, p.z]).map(f64::to_bits).fold(0, hash_word)
}
