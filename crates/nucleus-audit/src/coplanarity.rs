//! When four moving points lie in one plane, and whether the two elements meet there. The algebra, for any
//! arithmetic.
//!
//! Both cases are told by three vectors, each linear in time:
//!
//! | pair            | first   | second  | third   | `n`              |
//! |-----------------|---------|---------|---------|------------------|
//! | face abc, point p | b - a | c - a   | p - a   | first × second   |
//! | edge ab, edge cd  | b - a | d - c   | c - a   | first × second   |
//!
//! The volume n · third is a cubic in time, and nought where the four lie in one plane. There the elements meet
//! where the coordinates of the meeting point, multiplied by n · n so that nothing is divided, are not negative.

use crate::passage::Kind;

/// A polynomial in time, in some arithmetic.
pub trait Polynomial: Sized {
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
}

/// A vector that moves.
pub type Moving<P> = [P; 3];

/// The three vectors of a pair and their normal.
pub struct Coplanarity<P> {
    kind: Kind,
    vectors: [Moving<P>; 3],
    normal: Moving<P>,
}

impl<P: Polynomial> Coplanarity<P> {
    /// From the three vectors of the table above.
    pub fn new(kind: Kind, vectors: [Moving<P>; 3]) -> Self {
        let normal = cross(&vectors[0], &vectors[1]);
        Self { kind, vectors, normal }
    }

    /// Six times the volume between the four points: a cubic.
    pub fn volume(&self) -> P {
        dot(&self.normal, &self.vectors[2])
    }

    /// The square of the normal: a quartic, nought where the face has no area or the edges are parallel.
    pub fn area(&self) -> P {
        dot(&self.normal, &self.normal)
    }

    /// What is nowhere negative where the pair meets, provided that the four points lie in one plane: quartics.
    pub fn inside(&self) -> [P; 4] {
        let [first, second, third] = &self.vectors;
        let area = self.area();
        match self.kind {
            Kind::PointFace => {
                // Barycentric coordinates of p at c and b; what is left of the area is that at a.
                let c = dot(&self.normal, &cross(first, third));
                let b = dot(&self.normal, &cross(third, second));
                let a = area.minus(&b).minus(&c);
                [a, b, c, area]
            }
            Kind::EdgeEdge => {
                // a + s first = c + r second, both sides crossed with one of the edges.
                let s = dot(&self.normal, &cross(third, second));
                let r = dot(&self.normal, &cross(third, first));
                let (s_left, r_left) = (area.minus(&s), area.minus(&r));
                [s, s_left, r, r_left]
            }
        }
    }

    /// Which of the three vectors from a's edge to c: nought wherever parallel edges lie on one line.
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
