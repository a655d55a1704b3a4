//! `nucleus attrs` and `presets`.

use crate::sample::{assert_refused, folder, nucleus, stdout};

#[test]
fn a_type_lists_its_own_and_inherited_attributes() {
    let folder = folder();
    let said = stdout(&nucleus(folder.path(), &["attrs", "nCloth"]));
    assert!(said.contains("stretchResistance (stch)"), "{said}");
    assert!(said.contains("thickness ("), "it is inherited from nBase: {said}");
}

#[test]
fn hidden_attributes_are_shown_on_request() {
    let folder = folder();
    let said = |arguments: &[&str]| stdout(&nucleus(folder.path(), arguments));
    assert!(!said(&["attrs", "nCloth"]).contains("lifespanMode"));
    assert!(said(&["attrs", "nCloth", "--all"]).contains("lifespanMode"));
}

#[test]
fn an_attribute_without_effect_is_listed_with_the_reason() {
    let folder = folder();
    let said = stdout(&nucleus(folder.path(), &["attrs", "nParticle"]));
    let (_, row) = said.split_once("windSelfShadow (wssh)").expect("it is listed");
    assert!(row.lines().nth(1).is_some_and(|line| line.contains("No effect: balls keep no wind")), "{said}");
}

#[test]
fn the_defaults_of_a_type_of_constraint_stand_beside_those_of_the_node() {
    let folder = folder();
    let said = stdout(&nucleus(folder.path(), &["attrs", "dynamicConstraint"]));
    let row = said.lines().find(|line| line.contains("friction (frc)")).expect("it is listed");
    assert!(row.contains("= 0  (0.1 for slideOnSurface)"), "{row}");
    let row = said.lines().find(|line| line.contains("constraintMethod (")).expect("it is listed");
    assert!(row.contains("weld for weldBorders"), "{row}");
}

#[test]
fn without_a_type_all_types_are_listed() {
    let folder = folder();
    let said = stdout(&nucleus(folder.path(), &["attrs"]));
    assert!(
        ["nucleus", "nCloth", "nRigid", "nParticle", "pointEmitter", "newtonField"]
            .iter()
            .all(|name| said.contains(name)),
        "{said}"
    );
}

#[test]
fn an_unknown_type_is_refused_with_the_known_ones() {
    let folder = folder();
    let output = nucleus(folder.path(), &["attrs", "nHair"]);
    assert_refused(&output, "there is no node type `nHair`; there are `nucleus`");
}

#[test]
fn presets_are_listed_with_the_attributes_they_set() {
    let folder = folder();
    let all = stdout(&nucleus(folder.path(), &["presets"]));
    let eight =
        ["silk", "chiffon", "tShirt", "looseThickKnit", "heavyDenim", "burlap", "thickLeather", "chainmail"];
    assert!(eight.iter().all(|name| all.contains(name)), "{all}");
    let silk = stdout(&nucleus(folder.path(), &["presets", "silk"]));
    assert!(silk.contains("stretchResistance: 60"), "{silk}");
    assert_refused(&nucleus(folder.path(), &["presets", "silc"]), "there is no preset `silc`");
}

#[test]
fn a_misspelt_type_or_preset_is_refused_with_the_nearest() {
    let folder = folder();
    let refused = |arguments: &[&str], words| assert_refused(&nucleus(folder.path(), arguments), words);
    refused(&["attrs", "nCoth"], "there is no node type `nCoth`; did you mean `nCloth`?");
    refused(&["presets", "silkk"], "there is no preset `silkk`; did you mean `silk`?");
}

#[test]
fn a_default_that_the_mesh_decides_is_not_shown_as_a_number() {
    let folder = folder();
    let said = stdout(&nucleus(folder.path(), &["attrs", "nCloth"]));
    let row = said.lines().find(|line| line.contains(" thickness (thss)")).unwrap();
    assert!(!row.contains('='), "{row}");
}
