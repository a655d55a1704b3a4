//! The topology of the surface in one cell of the grid: which of its crossed edges belong to one sheet of it.
//!
//! A cell may hold several sheets. With one point for all of them, four quads would meet at an edge of the mesh; with a point
//! per sheet (Nielson 2004, "Dual marching cubes") two do, but in one configuration: two cells share a face that is crossed four
//! times, and in both a single sheet passes all four crossings. That face is then resolved the other way in both cells, which
//! divides each sheet into two (Wenger 2013, "Isosurfaces: geometry, topology and algorithms", §3.3; Schaefer, Ju & Warren 2007,
//! "Manifold dual contouring").

use std::sync::LazyLock;

/// Edges of a cell.
const EDGES: usize = 12;
/// An edge that the surface does not cross.
const NO_SHEET: u8 = u8::MAX;

/// Which corners of a cell are inside of the surface: bit `k` is that of [`corner`] `k`.
pub(super) type Inside = u8;

/// The sheets of the surface in a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sheets {
    /// How many there are.
    pub count: u8,
    of_edge: [u8; EDGES],
}

/// What follows from the corners inside.
struct Case {
    /// With the corners inside separated on faces that are crossed four times, and with those outside separated.
    sheets: [Sheets; 2],
    /// The axis and the side of a face whose four crossings belong to one sheet.
    repeated: Option<(usize, usize)>,
}

static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| (0..=Inside::MAX).map(Case::of).collect());

/// The offset of a corner of a cell from the lowest one.
pub(super) fn corner(k: usize) -> [i32; 3] {
    std::array::from_fn(|axis| (k >> axis & 1) as i32)
}

/// The edge from a corner along an axis, or to it.
fn edge(corner: usize, axis: usize) -> usize {
    let below = corner & ((1 << axis) - 1);
    4 * axis + (below | corner >> (axis + 1) << axis)
}

/// The crossed edges of a cell: their lower corner and axis.
pub(super) fn crossed(inside: Inside) -> impl Iterator<Item = (usize, usize)> {
    let all = (0..8usize).flat_map(|k| (0..3).map(move |axis| (k, axis)));
    all.filter(move |(k, axis)| k >> axis & 1 == 0 && (inside >> k ^ inside >> (k | 1 << axis)) & 1 == 1)
}

/// The axis and the side of a face whose four crossings belong to one sheet, if there is one.
pub(super) fn repeated_face(inside: Inside) -> Option<(usize, usize)> {
    CASES[usize::from(inside)].repeated
}

impl Sheets {
    /// The sheets of a cell; `joined` where corners inside are joined on a face that is crossed four times.
    pub(super) fn of(inside: Inside, joined: bool) -> Self {
        CASES[usize::from(inside)].sheets[usize::from(joined)]
    }

    /// The sheet that crosses the edge along an axis at a corner.
    pub(super) fn at(&self, corner: usize, axis: usize) -> u8 {
        self.of_edge[edge(corner, axis)]
    }

    fn resolved(inside: Inside, joined: bool) -> Self {
        let mut of_edge = [NO_SHEET; EDGES];
        for (number, (corner, axis)) in (0..).zip(crossed(inside)) {
            of_edge[edge(corner, axis)] = number;
        }
        for (face, corners) in faces() {
            let is_inside = |k: usize| inside >> corners[k % 4] & 1 == 1;
            let along = |k: usize| of_edge_of_face(face.0, corners, k);
            let crossings: Vec<usize> = (0..4).filter(|&k| is_inside(k) != is_inside(k + 1)).collect();
            match crossings[..] {
                [a, b] => join(&mut of_edge, along(a), along(b)),
                // Each corner that is cut off joins the edges before and after it.
                [_, _, _, _] => (0..4)
                    .filter(|&k| is_inside(k) != joined)
                    .for_each(|k| join(&mut of_edge, along((k + 3) % 4), along(k))),
                _ => {}
            }
        }
        let mut numbers: Vec<u8> = of_edge.iter().copied().filter(|sheet| *sheet != NO_SHEET).collect();
        numbers.sort_unstable();
        numbers.dedup();
        for sheet in of_edge.iter_mut().filter(|sheet| **sheet != NO_SHEET) {
            *sheet = numbers.iter().position(|number| number == sheet).unwrap_or_default() as u8;
        }
        Self { count: numbers.len() as u8, of_edge }
    }
}

/// Gives two edges the same sheet.
fn join(of_edge: &mut [u8; EDGES], a: usize, b: usize) {
    let (kept, replaced) = (of_edge[a], of_edge[b]);
    of_edge.iter_mut().filter(|sheet| **sheet == replaced).for_each(|sheet| *sheet = kept);
}

/// The faces of a cell, as axis and side, with their corners in order round the face.
fn faces() -> impl Iterator<Item = ((usize, usize), [usize; 4])> {
    (0..3).flat_map(|axis| (0..2).map(move |side| (axis, side))).map(|(axis, side)| {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        ((axis, side), [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| side << axis | a << u | b << v))
    })
}

/// The edge of a face from its `k`-th corner to the next.
fn of_edge_of_face(axis: usize, corners: [usize; 4], k: usize) -> usize {
    let along = if k.is_multiple_of(2) { (axis + 1) % 3 } else { (axis + 2) % 3 };
    edge(corners[k], along)
}

impl Case {
    fn of(inside: Inside) -> Self {
        let sheets = [false, true].map(|joined| Sheets::resolved(inside, joined));
        let is_repeated = |&((axis, _), corners): &((usize, usize), [usize; 4])| {
            let found = [0, 1, 2, 3].map(|k| sheets[0].of_edge[of_edge_of_face(axis, corners, k)]);
            found[0] != NO_SHEET && found.iter().all(|sheet| *sheet == found[0]) && {
                let bits = corners.map(|k| inside >> k & 1);
                bits[0] == bits[2] && bits[1] == bits[3] && bits[0] != bits[1]
            }
        };
        Self { repeated: faces().find(is_repeated).map(|(face, _)| face), sheets }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_sheets_of_neighbouring_cells_share_more_than_two_crossings_of_their_face() {
        // All cases of twelve corners: those of two cells that share a face, along each axis.
        for axis in 0..3 {
            for corners in 0..1u16 << 12 {
                let [below, above] = [0, 1].map(|cell| inside(corners, axis, cell));
                let is_joined =
                    repeated_face(below) == Some((axis, 1)) && repeated_face(above) == Some((axis, 0));
                let [lower, upper] = [below, above].map(|inside| Sheets::of(inside, is_joined));
                let mut pairs: Vec<_> = (0..4)
                    .map(|k| of_edge_of_face(axis, face(axis, 1), k))
                    .zip((0..4).map(|k| of_edge_of_face(axis, face(axis, 0), k)))
                    .map(|(low, high)| (lower.of_edge[low], upper.of_edge[high]))
                    .filter(|pair| *pair != (NO_SHEET, NO_SHEET))
                    .collect();
                pairs.sort_unstable();
                for pair in pairs.chunk_by(|a, b| a == b) {
                    assert_eq!(pair.len(), 2, "axis {axis}, corners {corners:b}");
                }
            }
        }
    }

    fn face(axis: usize, side: usize) -> [usize; 4] {
        faces().find(|(face, _)| *face == (axis, side)).map(|(_, corners)| corners).unwrap_or_default()
    }

    /// The corners inside of one of two cells along an axis, out of three layers of four.
    fn inside(corners: u16, axis: usize, cell: usize) -> Inside {
        let bit = |k: usize| {
            let layer = (k >> axis & 1) + cell;
            let below = k & ((1 << axis) - 1);
            corners >> (4 * layer + (below | k >> (axis + 1) << axis)) & 1
        };
        (0..8).map(|k| (bit(k) as Inside) << k).sum()
    }

    #[test]
    fn a_face_that_repeats_a_sheet_is_the_only_one_that_is_crossed_four_times() {
        let is_ambiguous = |inside: Inside, corners: [usize; 4]| {
            let [a, b, c, d] = corners.map(|k| inside >> k & 1);
            a == c && b == d && a != b
        };
        for inside in (0..=Inside::MAX).filter(|inside| repeated_face(*inside).is_some()) {
            assert_eq!(
                faces().filter(|(_, corners)| is_ambiguous(inside, *corners)).count(),
                1,
                "{inside:b}"
            );
        }
    }
}
