//! A loose reef knot: two bights, each around both strands of the other.
//!
//! The left ribbon comes from the left, narrow, passes over the right ribbon's bight, widens and passes under
//! its strands, and turns back over them. The right ribbon is the same, turned by half a turn and upside down.
//! Ribbons are on edge, so that they bend where the knot turns.

use std::f64::consts::{PI, TAU};

use super::mesh::Mesh;

/// Half the distance of the strands of a ribbon, outside the knot and inside it.
const NARROW: f64 = 3.0;
const WIDE: f64 = 8.0;

/// Range of x in which strands widen; its end is also the centre of the bight's half circle.
const WIDENS: [f64; 2] = [-4.0, 4.0];

/// The x of the ribbon's ends.
const END: f64 = -60.0;

/// Height of a ribbon above or below the middle at a crossing, and half its width.
const RISE: f64 = 2.4;
const HALF_WIDTH: f64 = 1.5;

/// Points along a ribbon and across it.
const ALONG: usize = 301;
const ACROSS: usize = 6;

/// The ribbon whose ends are on the left.
pub fn left() -> Mesh {
    ribbon(|[x, y, z]| [x, y, z])
}

/// The ribbon whose ends are on the right.
pub fn right() -> Mesh {
    ribbon(|[x, y, z]| [-x, -y, -z])
}

fn ribbon(place: impl Fn([f64; 3]) -> [f64; 3]) -> Mesh {
    let length = path_length();
    let row = |k: usize| {
        let [x, z, height] = centre_line(length * k as f64 / (ALONG - 1) as f64);
        let across = |j: usize| HALF_WIDTH * (2.0 * j as f64 / (ACROSS - 1) as f64 - 1.0);
        (0..ACROSS).map(|j| place([x, height + across(j), z])).collect()
    };
    Mesh::rows((0..ALONG).map(row).collect(), false)
}

/// Length from end to end, neglecting the widening.
fn path_length() -> f64 {
    2.0 * (WIDENS[1] - END) + PI * WIDE
}

/// Centre line at an arc length: x, z, and height.
fn centre_line(way: f64) -> [f64; 3] {
    let straight = WIDENS[1] - END;
    let bight = PI * WIDE;
    if way > straight + bight / 2.0 {
        let [x, z, height] = centre_line(path_length() - way);
        return [x, -z, height];
    }
    if way > straight {
        let (sin, cos) = ((way - straight) / WIDE).sin_cos();
        return [WIDENS[1] + WIDE * sin, WIDE * cos, RISE];
    }
    let x = END + way;
    let widening = smooth((x - WIDENS[0]) / (WIDENS[1] - WIDENS[0]));
    [x, NARROW + (WIDE - NARROW) * widening, RISE * weave(x)]
}

/// 1 where a strand passes over, -1 where it passes under, as a function of x.
fn weave(x: f64) -> f64 {
    // It crosses the bight of the other ribbon where that is as narrow as this one.
    let bight = -(WIDENS[1] + (WIDE * WIDE - NARROW * NARROW).sqrt());
    if x < bight {
        smooth((x - bight + 12.0) / 12.0)
    } else if x < 0.0 {
        1.0 - 2.0 * smooth((x - bight - 3.0) / (-bight - 3.0))
    } else {
        2.0 * smooth(x / WIDENS[1]) - 1.0
    }
}

/// Smooth step from 0 to 1.
fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x - (TAU * x).sin() / TAU
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ribbons_are_separated_at_their_crossings() {
        let line = |turned: bool| {
            let place = |k: usize| {
                let [x, z, height] = centre_line(path_length() * k as f64 / 2000.0);
                if turned { [-x, -z, -height] } else { [x, z, height] }
            };
            (0..=2000).map(place).collect::<Vec<_>>()
        };
        for [x, z, height] in line(false) {
            for [other_x, other_z, other] in line(true) {
                // At a crossing, the edges of one are clear of those of the other.
                let near = (x - other_x).hypot(z - other_z) < 0.3;
                assert!(
                    !near || (height - other).abs() > 2.0 * HALF_WIDTH + 0.5,
                    "{x} {z}: {height} {other}"
                );
            }
        }
    }
}
