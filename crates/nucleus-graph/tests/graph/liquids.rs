//! Settings that do not let a liquid flow.

use super::particles::warnings;
use super::scenes::of_nodes;

#[test]
fn a_liquid_that_contact_keeps_from_its_rest_distance_is_warned_of() {
    let of = |fields: &str| {
        let nodes =
            format!(r#""n": nucleus(), "q": nParticle(enableSPH: true, maximumCorner: (1, 1, 1){fields})"#);
        warnings(&of_nodes(&nodes, ""))
    };
    assert_eq!(of(""), [""; 0]);
    assert_eq!(of(", collideWidthScale: 0.6"), [""; 0]);
    let [apart] = &of(", selfCollide: true, collideWidthScale: 0.7, selfCollideWidthScale: 2")[..] else {
        panic!()
    };
    assert!(apart.contains(
        "`selfCollide` keeps the particles of the liquid `q` 0.560 apart, but at rest they are 0.256"
    ));
    let [high] = &of(", collideWidthScale: 1")[..] else { panic!() };
    assert!(high.contains("`collideWidthScale` keeps the liquid `q` 0.200 away from walls"), "{high}");
}

#[test]
fn a_liquid_that_the_air_stops_within_its_own_height_is_warned_of() {
    let of = |of_nucleus: &str, fields: &str| {
        let nodes =
            format!(r#""n": nucleus({of_nucleus}), "q": nParticle(maximumCorner: (1, 1, 1){fields})"#);
        warnings(&of_nodes(&nodes, ""))
    };
    for fields in ["", ", enableSPH: true, drag: 0", ", enableSPH: true, ignoreSolverGravity: true"] {
        let fields = format!("{fields}, pointMass: 0.001");
        assert_eq!(of("", &fields), [""; 0], "{fields}");
    }
    for nucleus in ["airDensity: 0", "gravity: 0"] {
        assert_eq!(of(nucleus, ", enableSPH: true, pointMass: 0.001"), [""; 0], "{nucleus}");
    }
    // Drag takes 0.01 / 0.001 of the speed in 1/24 s, 240 per second, and gravity adds 9.8 m/s.
    let [found] = &of("", ", enableSPH: true, pointMass: 0.001")[..] else { panic!("one warning") };
    assert!(found.contains("`drag` lets the liquid `q` fall at no more than 0.0408 m/s"), "{found}");
    // A fall over a metre, the liquid's height at most, gives 4.4 m/s: at a mass of 0.108 kg drag has its weight there.
    assert_eq!(of("", ", enableSPH: true, pointMass: 0.11"), [""; 0]);
}

#[test]
fn a_liquid_that_is_heavier_than_any_metal_is_warned_of() {
    let of = |mass: &str| {
        let nodes = format!(
            r#""n": nucleus(spaceScale: 0.01), "q": nParticle(enableSPH: true, drag: 0, radius: 0.5, maximumCorner: (1, 1, 1){mass})"#
        );
        warnings(&of_nodes(&nodes, ""))
    };
    // A ball of 0.5 cm has 0.52 cm³, and two overlap each point of the liquid: 0.26 g of water.
    assert_eq!(of(", pointMass: 0.00026"), [""; 0]);
    let [found] = &of("")[..] else { panic!("one warning") };
    assert!(found.contains("the liquid `q` weighs 38"), "{found}");
}
