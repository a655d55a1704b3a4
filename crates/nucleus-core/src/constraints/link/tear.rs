//! Where a surface tears: welds round a point of a mesh, judged together.
//!
//! A tearable mesh has a corner for every face round a point, and welds between neighbouring corners: a ring inside of the
//! mesh, a chain at its border. The loads of a ring's welds are not determined one by one, because a ring can be tensed in
//! itself. The force across a cut is: with the loads g_u and g_v of the two welds that it parts, in one sense round the
//! point, it is g_u - g_v. A point tears along the pair of edges with the largest force per length of cut, which is the
//! pair that lies most nearly across the pull, whatever other edges the mesh has there. A chain tears at its most loaded
//! weld.
//!
//! A tear relieves what is around it. In a substep a point therefore does not tear beside one with a larger load.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use super::ends::Ends;

/// The welds round each point where several meet.
#[derive(Debug, Clone, Default)]
pub(super) struct Nodes {
    /// Of all nodes: the link, and its sense round the point.
    welds: Vec<(u32, f64)>,
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    first: u32,
    end: u32,
    is_ring: bool,
    /// One of its points.
    row: u32,
}

/// The cut of a node with the largest load.
#[derive(Debug, Clone, Copy)]
struct Cut {
    /// The welds that part: two of a ring, or one twice.
    welds: [u32; 2],
    /// Load over breaking load.
    ratio: f64,
    /// Where it is, in metres, and how far from there it relieves others.
    place: Vector3<f64>,
    reach: f64,
}

impl Nodes {
    /// The nodes of links between single points. A weld between points that have three welds or more is alone, and so are
    /// links that are not welds.
    pub(super) fn new(pairs: &[(u32, Ends)], are_welds: bool) -> Self {
        let mut at_row: BTreeMap<u32, Vec<(usize, u32, f64)>> = BTreeMap::new();
        for (k, (_, ends)) in pairs.iter().enumerate() {
            let [a, b] = [ends.rows[0], ends.rows[1]];
            at_row.entry(a).or_default().push((k, b, 1.0));
            at_row.entry(b).or_default().push((k, a, -1.0));
        }
        let mut own = Self::default();
        if !are_welds {
            own.welds = pairs.iter().map(|(link, _)| (*link, 1.0)).collect();
            let node = |(k, (_, ends)): (u32, &(u32, Ends))| Node {
                first: k,
                end: k + 1,
                is_ring: false,
                row: ends.rows[0],
            };
            own.nodes = (0..).zip(pairs).map(node).collect();
            return own;
        }
        let mut seen = vec![false; pairs.len()];
        let ends_first = at_row.iter().filter(|(_, welds)| welds.len() == 1);
        for (&start, _) in ends_first.chain(&at_row) {
            own.walk(start, &at_row, &mut seen, pairs);
        }
        own
    }

    /// Adds the node of the welds that a walk from a point reaches.
    fn walk(
        &mut self,
        start: u32,
        at_row: &BTreeMap<u32, Vec<(usize, u32, f64)>>,
        seen: &mut [bool],
        pairs: &[(u32, Ends)],
    ) {
        let first = self.welds.len() as u32;
        let (mut row, mut is_simple) = (start, at_row[&start].len() < 3);
        while let Some(&(k, next, sense)) = at_row[&row].iter().find(|(k, ..)| !seen[*k]) {
            seen[k] = true;
            self.welds.push((pairs[k].0, sense));
            is_simple &= at_row[&next].len() < 3;
            row = next;
        }
        let end = self.welds.len() as u32;
        let is_ring = is_simple && row == start && end > first + 1;
        match is_simple {
            true if end > first => self.nodes.push(Node { first, end, is_ring, row: start }),
            _ => self.nodes.extend((first..end).map(|k| Node {
                first: k,
                end: k + 1,
                is_ring: false,
                row: start,
            })),
        }
    }

    /// The welds that part. `load` gives the impulse of a link in N·s, `edge` its length in metres and the impulse that
    /// breaks it, `None` where it is broken, and `place` the position of a row in metres.
    pub(super) fn tears(
        &self,
        load: impl Fn(u32) -> Vector3<f64>,
        edge: impl Fn(u32) -> Option<[f64; 2]>,
        place: impl Fn(u32) -> Vector3<f64>,
    ) -> Vec<u32> {
        let mut cuts: Vec<Cut> = Vec::new();
        for node in &self.nodes {
            let welds = &self.welds[node.first as usize..node.end as usize];
            let (welds, ratio, reach) =
                match node.is_ring && welds.iter().all(|(weld, _)| edge(*weld).is_some()) {
                    true => ring_cut(welds, &load, &edge),
                    false => chain_cut(welds, &load, &edge),
                };
            if ratio > 1.0 {
                let reach = if node.end > node.first + 1 { reach } else { 0.0 };
                cuts.push(Cut { welds, ratio, place: place(node.row), reach });
            }
        }
        cuts.sort_by(|a, b| b.ratio.total_cmp(&a.ratio));
        let mut accepted: Vec<Cut> = Vec::new();
        for cut in cuts {
            let is_beside = |other: &Cut| (other.place - cut.place).norm() < other.reach.min(cut.reach);
            if !accepted.iter().any(is_beside) {
                accepted.push(cut);
            }
        }
        accepted.iter().flat_map(|cut| cut.welds).collect()
    }
}

type Best = ([u32; 2], f64, f64);

/// The pair of a ring's welds with the largest ratio of the force between them to the one that breaks them, that ratio, and
/// the length of their edges.
fn ring_cut(
    welds: &[(u32, f64)],
    load: impl Fn(u32) -> Vector3<f64>,
    edge: impl Fn(u32) -> Option<[f64; 2]>,
) -> Best {
    let mut best = ([0; 2], 0.0, 0.0);
    for (k, &(u, sense_u)) in welds.iter().enumerate() {
        for &(v, sense_v) in &welds[k + 1..] {
            let ([a, limit_u], [b, limit_v]) = (edge(u).unwrap_or_default(), edge(v).unwrap_or_default());
            let ratio = (load(u) * sense_u - load(v) * sense_v).norm() / (limit_u + limit_v);
            if ratio > best.1 {
                best = ([u, v], ratio, 2.0 * (a + b));
            }
        }
    }
    best
}

/// The most loaded whole weld.
fn chain_cut(
    welds: &[(u32, f64)],
    load: impl Fn(u32) -> Vector3<f64>,
    edge: impl Fn(u32) -> Option<[f64; 2]>,
) -> Best {
    let mut best = ([0; 2], 0.0, 0.0);
    for &(weld, _) in welds {
        let Some([half, limit]) = edge(weld) else { continue };
        let ratio = load(weld).norm() / limit;
        if ratio > best.1 {
            best = ([weld; 2], ratio, 4.0 * half);
        }
    }
    best
}
