use super::*;

mod maya;

fn all_types() -> impl Iterator<Item = &'static NodeType> {
    let made = [&time::TIME, &n_component::N_COMPONENT];
    node_types().iter().copied().chain(made).flat_map(NodeType::lineage)
}

#[test]
fn every_row_has_a_description_and_a_default_within_its_range() {
    for node_type in all_types() {
        assert!(!node_type.doc().is_empty(), "{}", node_type.name);
        for row in node_type.rows {
            let name = row.name;
            assert!(row.doc().ends_with('.'), "{name}: {}", row.doc());
            assert!(!row.group.is_empty(), "{name}");
            match &row.default {
                Some(value) => assert!(row.kind.admits(value), "{name}"),
                None => {
                    assert!(matches!(row.kind, Kind::Node(_) | Kind::Plug(_) | Kind::Together(_)), "{name}")
                }
            }
            match row.default {
                Some(Value::Float(x)) => assert!(row.range.contains(x), "{name}"),
                Some(Value::Int(x)) => assert!(row.range.contains(x as f64), "{name}"),
                _ => {}
            }
        }
    }
}

#[test]
fn push_out_is_solved_in_the_module_of_its_name() {
    for key in [&n_base::PUSH_OUT, &n_base::PUSH_OUT_RADIUS] {
        assert_eq!(key.row.effect, Effect::Solved("nucleus_core::contact::push_out"), "{}", key.row.name);
    }
}

#[test]
fn long_names_and_short_names_are_unique_within_a_type() {
    for node_type in all_types() {
        let mut longs: Vec<_> = node_type.rows.iter().map(|row| row.name).collect();
        let mut shorts: Vec<_> = node_type.rows.iter().map(|row| row.short).collect();
        for names in [&mut longs, &mut shorts] {
            names.sort_unstable();
            let count = names.len();
            names.dedup();
            assert_eq!(names.len(), count, "{}", node_type.name);
        }
    }
}

#[test]
fn the_values_of_an_enum_have_unique_names_that_scenes_can_write() {
    for row in all_types().flat_map(|node_type| node_type.rows) {
        let mut words: Vec<String> = row.words().into_iter().map(|(_, word)| word).collect();
        let count = words.len();
        assert!(words.iter().all(|word| word.starts_with(|c: char| c.is_ascii_lowercase())), "{}", row.name);
        words.sort();
        words.dedup();
        assert_eq!(words.len(), count, "{}", row.name);
    }
}

#[test]
fn attributes_that_are_set_at_once_belong_to_the_same_type() {
    for node_type in node_types() {
        for row in node_type.attributes() {
            let Kind::Together(parts) = row.kind else { continue };
            assert!(parts.iter().all(|part| node_type.attribute(part).is_some()), "{}", row.name);
        }
    }
}

#[test]
fn a_derived_type_overrides_inherited_rows() {
    let default = |node_type: &'static NodeType| node_type.attribute("trappedCheck")?.default.clone();
    assert_eq!(default(&n_cloth::N_CLOTH), Some(Value::Bool(false)));
    assert_eq!(default(&n_rigid::N_RIGID), Some(Value::Bool(true)));
    let rows = n_rigid::N_RIGID.attributes();
    assert_eq!(rows.iter().filter(|row| row.name == "trappedCheck").count(), 1);
}

#[test]
fn cloth_inherits_from_n_base_and_from_classic_particles() {
    assert!(n_cloth::N_CLOTH.is_a(&n_base::N_BASE) && n_cloth::N_CLOTH.is_a(&particle::PARTICLE));
    assert!(!n_cloth::N_CLOTH.is_a(&transform::TRANSFORM));
}

#[test]
fn inherited_attributes_that_cloth_hides_still_exist() {
    let row = n_cloth::N_CLOTH.attribute("lifespanMode").expect("it is inherited");
    assert!(n_cloth::N_CLOTH.keeps_from_view(row));
    assert!(!particle::PARTICLE.keeps_from_view(row));
}

#[test]
fn attributes_are_found_by_short_names_and_by_vector_components() {
    let cloth = &n_cloth::N_CLOTH;
    assert_eq!(cloth.attribute("stch").map(|row| row.name), Some("stretchResistance"));
    let (row, part) = mesh::MESH.part("translateY").expect("a mesh has a transform");
    assert_eq!((row.name, part), ("translate", 1));
    assert_eq!(mesh::MESH.part("rz").map(|(row, part)| (row.name, part)), Some(("rotate", 2)));
    assert_eq!(cloth.part("displayColorG").map(|(_, part)| part), Some(1));
}

#[test]
fn every_row_of_cloth_colliders_and_their_solver_has_an_effect_or_says_why_not() {
    for node_type in [&n_cloth::N_CLOTH, &n_rigid::N_RIGID, &nucleus::NUCLEUS] {
        let rows = node_type.attributes().into_iter();
        let idle = rows.filter(|row| row.effect == Effect::NotYet && !node_type.has_no_use_for(row));
        assert_eq!(idle.map(|row| row.name).collect::<Vec<_>>(), Vec::<&str>::new(), "{}", node_type.name);
    }
}

#[test]
fn every_row_of_particles_and_emitters_has_an_effect_or_says_why_not() {
    for node_type in [&n_particle::N_PARTICLE, &point_emitter::POINT_EMITTER] {
        let idle = node_type.attributes().into_iter().filter(|row| row.effect == Effect::NotYet);
        let own = idle.filter(|row| !transform::TRANSFORM.attributes().contains(row));
        assert_eq!(own.map(|row| row.name).collect::<Vec<_>>(), Vec::<&str>::new(), "{}", node_type.name);
    }
}

/// Names, short names, defaults and ranges of a few attributes as Maya has them.
#[test]
fn rows_have_mayas_names_defaults_and_ranges() {
    let row = |node_type: &'static NodeType, name| node_type.attribute(name).expect(name);
    let stretch = row(&n_cloth::N_CLOTH, "stretchResistance");
    assert_eq!((&stretch.default, stretch.range.soft), (&Some(Value::Float(20.0)), Some((0.0, 200.0))));
    assert_eq!(row(&nucleus::NUCLEUS, "sstp").default, Some(Value::Int(3)));
    assert_eq!(row(&nucleus::NUCLEUS, "grdi").default, Some(Value::Vector([0.0, -1.0, 0.0])));
    let relation = row(&n_cloth::N_CLOTH, "scalingRelation");
    let words: Vec<String> = relation.words().into_iter().map(|(_, word)| word).collect();
    assert_eq!(words, ["link", "objectSpace", "worldSpace"]);
}
