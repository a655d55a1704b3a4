//! The coplanarity condition of four moving points, and the conditions that two elements meet where they are coplanar.
//! The algebra, for any arithmetic.
//!
//! Three vectors, each linear in time, describe both kinds of pair:
//!
//! | pair            | first   | second  | third   | `n`              |
//! |-----------------|---------|---------|---------|------------------|
//! | face abc, point p | b - a | c - a   | p - a   | first × second   |
//! | edge ab, edge cd  | b - a | d - c   | c - a   | first × second   |
//!
//! The volume n · third is a cubic in time. It is zero where the four points are coplanar. There the elements meet if
//! and only if the coordinates of the meeting point are not negative; they are multiplied by n · n to avoid a division.

use crate::pair::PairKind;

/// A polynomial in time, in some arithmetic.
pub trait Polynomial: Sized {
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
}

/// A moving vector.
pub type Moving<P> = [P; 3];

/// The three vectors of a pair and their normal.
pub struct Coplanarity<P> {
    kind: PairKind,
    vectors: [Moving<P>; 3],
    normal: Moving<P>,
}

impl<P: Polynomial> Coplanarity<P> {
    /// From the three vectors of the table above.
    pub fn new(kind: PairKind, vectors: [Moving<P>; 3]) -> Self {
        let normal = cross(&vectors[0], &vectors[1]);
        Self { kind, vectors, normal }
    }

    /// Six times the signed volume of the four points: a cubic.
    pub fn volume(&self) -> P {
        dot(&self.normal, &self.vectors[2])
    }

    /// The square of the normal: a quartic, zero where the face has no area or the edges are parallel.
    pub fn area(&self) -> P {
        dot(&self.normal, &self.normal)
    }

    /// Quartics that are all non-negative where the pair meets, if the four points are coplanar.
    pub fn inside(&self) -> [P; 4] {
        let [first, second, third] = &self.vectors;
        let area = self.area();
        match self.kind {
            PairKind::PointFace => {
                // Barycentric coordinates of p at c and b; the remainder of the area is the coordinate at a.
                let c = dot(&self.normal, &cross(first, third));
                let b = dot(&self.normal, &cross(third, second));
                let a = area.minus(&b).minus(&c);
                [a, b, c, area]
            }
            PairKind::EdgeEdge => {
                // a + s first = c + r second, crossed with one of the edges on both sides.
                let s = dot(&self.normal, &cross(third, second));
                let r = dot(&self.normal, &cross(third, first));
                let (s_left, r_left) = (area.minus(&s), area.minus(&r));
                [s, s_left, r, r_left]
            }
        }
    }

    /// Squared distance of c from the line of edge ab, scaled: zero where parallel edges lie on one line.
    pub fn offset_from_line(&self) -> P {
        let across = cross(&self.vectors[0], &self.vectors[2]);
        dot(&across, &across)
    }
}

fn cross<P: Polynomial>(a: &Moving<P>, b: &Moving<P>) -> Moving<P> {
    let component = |i: usize, j: usize| a[i].times(&b[j]).minus(&a[j].times(&b[i]));
    [component(1, 2), component(2, 0), component(0, 1)]
}

fn dot<P: Polynomial>(a: &Moving<P>, b: &Moving<P>) -> P {
    a[0].times(&b[0]).plus(&a[1].times(&b[1])).plus(&a[2].times(&b[2]))
}
