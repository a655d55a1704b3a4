//! Groups and materials of the faces of a mesh as `GeomSubset` prims below it.

use nucleus_cache::{FaceSet, FaceSets};

use crate::output::node_names;

use super::stage::{Attribute, Prim, Stage, Value};

/// The family of the subsets that bind materials, which renderers look for.
const BINDING: &str = "materialBind";

/// Writes a subset for each set of a mesh of so many faces. `material` gives the path of a material. A face in no
/// material has that of the mesh.
pub(super) fn write_subsets(
    sets: &FaceSets,
    faces: usize,
    stage: &mut impl Stage,
    material: impl Fn(&FaceSet) -> String,
) {
    if !sets.materials.is_empty() {
        let bound: usize = sets.materials.iter().map(|set| set.faces.len()).sum();
        let kind = if bound == faces { "partition" } else { "nonOverlapping" };
        let family = format!("subsetFamily:{BINDING}:familyType");
        stage.attribute(&Attribute::uniform("token", &family), &Value::Token(kind));
    }
    let all = sets.materials.iter().chain(&sets.groups);
    let names = node_names(all.clone().map(|set| set.name.as_str()));
    for (index, (set, name)) in all.zip(&names).enumerate() {
        let binds = index < sets.materials.len();
        let schemas: &[&str] = if binds { &["MaterialBindingAPI"] } else { &[] };
        stage.begin(&Prim { schemas, ..Prim::of("GeomSubset", name) });
        stage.attribute(&Attribute::uniform("token", "elementType"), &Value::Token("face"));
        if binds {
            stage.attribute(&Attribute::uniform("token", "familyName"), &Value::Token(BINDING));
        }
        stage.attribute(&Attribute::of("int[]", "indices"), &Value::Ints(&set.faces));
        let title = Attribute { is_custom: true, ..Attribute::of("string", "nucleus:name") };
        stage.attribute(&title, &Value::Text(&set.name));
        if binds {
            stage.relate("material:binding", &material(set));
        }
        stage.end();
    }
}
