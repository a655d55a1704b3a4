//! The small values that solvers are full of.

use super::item::{Item, Reader, item};
use super::kept::kept;
use crate::contact::cloth::motion_bounds::Trajectories;
use crate::contact::cloth::untangling::{Correction, Intersection};
use crate::contact::material::ContactMaterial;
use crate::input::frame::Elements;
use crate::math::{Real, Row4};

impl<R: Real> Item for Row4<R> {
    const SIZE: usize = 4 * R::SIZE;
    fn put(&self, out: &mut Vec<u8>) {
        self.0.put(out);
    }
    fn take(from: &mut Reader<'_>) -> Option<Self> {
        Item::take(from).map(Self)
    }
}

kept!([R: Real] Trajectories<R> { columns: [origin, travel], values: [], parts: [], anew: [] });

item!([R: Real] ContactMaterial<R> {
    thickness: f64, adhesion_range: f64, thicknesses: [R; 2], friction: [R; 2], stickiness: [R; 2], bounce: [R; 2],
    strength: [R; 2], untangling_rate: f64, depenetrates: bool, mobility: [R; 2], elements: [Elements; 2], edges: bool,
});

item!([] Intersection { edge: [u32; 2], wings: [u32; 2], face: [u32; 3], correction: Correction });

/// Names as numbers. A name that is added comes last.
macro_rules! names {
    ($type:ty { $($name:path = $number:literal),* }) => {
        impl Item for $type {
            const SIZE: usize = 1;
            fn put(&self, out: &mut Vec<u8>) {
                let number: u8 = match self { $($name => $number),* };
                number.put(out);
            }
            fn take(from: &mut Reader<'_>) -> Option<Self> {
                match u8::take(from)? {
                    $($number => Some($name),)*
                    _ => None,
                }
            }
        }
    };
}

names!(Elements { Elements::Points = 0, Elements::Edges = 1, Elements::Faces = 2 });

impl Item for Correction {
    const SIZE: usize = 1;
    fn put(&self, out: &mut Vec<u8>) {
        let number: u8 = match self {
            Self::ReturnEnd(0) => 0,
            Self::ReturnEnd(_) => 1,
            Self::ShortenContour => 2,
            Self::None => 3,
        };
        number.put(out);
    }
    fn take(from: &mut Reader<'_>) -> Option<Self> {
        match u8::take(from)? {
            end @ (0 | 1) => Some(Self::ReturnEnd(end.into())),
            2 => Some(Self::ShortenContour),
            3 => Some(Self::None),
            _ => None,
        }
    }
}
