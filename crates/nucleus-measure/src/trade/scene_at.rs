//! The scene at another setting: its graph, for a run, and edits of its text, for a user who keeps the setting.

use nucleus_core::ResistanceModel;
use nucleus_graph::animation::Curve;
use nucleus_graph::attributes::{Attribute, Choice, Key, Value, n_base, n_cloth, nucleus};
use nucleus_graph::graph::{Graph, NodeId, Setting as Held};
use nucleus_graph::scene::Scene;
use nucleus_graph::scene::edit::{Edit, NewValue};

use super::setting::{Reading, Setting};

/// In-plane resistances of cloth.
static PLANE_RESISTANCES: [&Key<f64>; 3] =
    [&n_cloth::STRETCH_RESISTANCE, &n_cloth::COMPRESSION_RESISTANCE, &n_cloth::SHEAR_RESISTANCE];

/// What a setting needs to know of a cloth.
pub(super) struct SettableCloth {
    pub node: NodeId,
    pub points: usize,
    /// Area in m².
    pub area: f64,
    /// Whether it hangs by pins, without tethers.
    pub hangs: bool,
}

/// A scene that is set.
pub(super) struct SettableScene<'a> {
    pub scene: &'a Scene,
    /// The setting that it states.
    pub own: Setting,
    pub cloths: &'a [SettableCloth],
}

impl SettableScene<'_> {
    /// The scene at another setting, before it is compiled.
    ///
    /// The total mass stays the same: Physical reads `pointMass` per area, Classic per point.
    pub fn set(&self, setting: &Setting) -> Scene {
        let mut scene = self.scene.clone();
        set_quality(&mut scene.graph, setting);
        for cloth in self.cloths {
            let node = self.scene.graph.node(cloth.node);
            let factor = self.mass_factor(cloth, setting);
            if factor != 1.0 {
                let mass = node.get(&n_base::POINT_MASS) * factor;
                put(&mut scene.graph, cloth.node, &n_base::POINT_MASS.row, Held::Fixed(Value::Float(mass)));
            }
        }
        if setting.tethers {
            for cloth in self.cloths.iter().filter(|cloth| cloth.hangs) {
                put(&mut scene.graph, cloth.node, &n_cloth::TETHERS.row, Held::Fixed(Value::Bool(true)));
            }
        }
        if setting.reading == Reading::Classic && setting.resistance != 1.0 {
            for cloth in self.cloths {
                scale_resistances(&mut scene.graph, cloth.node, setting.resistance);
            }
        }
        scene
    }

    /// Edits of the scene file that apply a setting; none for its own.
    pub fn edits(&self, setting: &Setting) -> Vec<Edit> {
        let Some(id) = nucleus_of(&self.scene.graph) else { return Vec::new() };
        let of = |node: NodeId, attribute: &'static str, to: NewValue| {
            let node = self.scene.graph.node(node).name().to_owned();
            Edit { node, attribute: attribute.to_owned(), to }
        };
        let text = |to: &dyn ToString| NewValue::Text(to.to_string());
        let own = &self.own;
        let mut edits = Vec::new();
        if setting.reading != own.reading {
            let word = if setting.reading == Reading::Classic { "classic" } else { "physical" };
            edits.push(of(id, "resistanceModel", text(&word)));
            let mass = |cloth: &SettableCloth| (cloth.node, self.mass_factor(cloth, setting));
            for (node, factor) in self.cloths.iter().map(mass) {
                edits.push(of(node, "pointMass", self.scaled_from(node, &n_base::POINT_MASS, factor)));
            }
        }
        if setting.substeps != own.substeps {
            edits.push(of(id, "subSteps", text(&setting.substeps)));
        }
        if setting.collision_iterations != own.collision_iterations {
            edits.push(of(id, "maxCollisionIterations", text(&setting.collision_iterations)));
        }
        if setting.reading == Reading::Physical && setting.evaluations != own.evaluations {
            let factor = setting.evaluations / own.evaluations;
            let to = NewValue::Scaled { factor, least: 1.0, default: own.evaluations };
            edits.push(of(id, "evaluations", to));
        }
        if setting.tethers {
            let hanging = self.cloths.iter().filter(|cloth| cloth.hangs);
            edits.extend(hanging.map(|cloth| of(cloth.node, n_cloth::TETHERS.row.name, text(&true))));
        }
        if setting.reading == Reading::Classic && setting.resistance != 1.0 {
            for cloth in self.cloths {
                edits.extend(PLANE_RESISTANCES.map(|key| {
                    of(cloth.node, key.row.name, self.scaled_from(cloth.node, key, setting.resistance))
                }));
            }
        }
        edits
    }

    fn scaled_from(&self, node: NodeId, key: &Key<f64>, factor: f64) -> NewValue {
        NewValue::Scaled { factor, least: 0.0, default: self.scene.graph.node(node).get(key) }
    }

    /// Factor on `pointMass` that keeps the total mass of a cloth at a setting.
    fn mass_factor(&self, cloth: &SettableCloth, setting: &Setting) -> f64 {
        let points = cloth.points as f64;
        match (self.own.reading, setting.reading) {
            (Reading::Physical, Reading::Classic) => cloth.area / points,
            (Reading::Classic, Reading::Physical) if cloth.area > 0.0 => points / cloth.area,
            _ => 1.0,
        }
    }
}

/// The solved nucleus.
fn nucleus_of(graph: &Graph) -> Option<NodeId> {
    graph.of_type(&nucleus::NUCLEUS).next().map(|(id, _)| id)
}

/// The setting that a scene states.
pub(super) fn own_setting(scene: &Scene, model: ResistanceModel) -> Setting {
    let node = nucleus_of(&scene.graph).map(|id| scene.graph.node(id));
    let most = |held: Option<&Held>, default: f64| match held {
        Some(Held::Keyed(curve)) => curve.max_abs(),
        Some(Held::Fixed(Value::Int(x))) => *x as f64,
        Some(Held::Fixed(Value::Float(x))) => *x,
        _ => default,
    };
    let number = |key: &Key<i64>, default: f64| most(node.and_then(|node| node.setting(key)), default);
    // Those of the first frame are by `autoEvaluations` where none are given.
    let first = match model {
        ResistanceModel::Physical { evaluations } => evaluations,
        ResistanceModel::Classic => 96.0,
    };
    Setting {
        reading: match model {
            ResistanceModel::Classic => Reading::Classic,
            ResistanceModel::Physical { .. } => Reading::Physical,
        },
        substeps: number(&nucleus::SUB_STEPS, 3.0) as u32,
        collision_iterations: number(&nucleus::MAX_COLLISION_ITERATIONS, 4.0) as u32,
        evaluations: most(node.and_then(|node| node.setting(&nucleus::EVALUATIONS)), first),
        resistance: 1.0,
        tethers: false,
    }
}

/// Applies a setting to the nucleus.
pub(super) fn set_quality(graph: &mut Graph, setting: &Setting) {
    let Some(id) = nucleus_of(graph) else { return };
    let choice = Choice(match setting.reading {
        Reading::Classic => 0,
        Reading::Physical => 1,
    });
    let evaluations = match graph.node(id).setting(&nucleus::EVALUATIONS) {
        Some(Held::Keyed(curve)) => scaled(curve, setting.evaluations / curve.max_abs(), 1.0),
        _ => Held::Fixed(Value::Float(setting.evaluations)),
    };
    let int = |x: u32| Held::Fixed(Value::Int(x.into()));
    put(graph, id, &nucleus::RESISTANCE_MODEL.row, Held::Fixed(Value::Choice(choice)));
    put(graph, id, &nucleus::SUB_STEPS.row, int(setting.substeps));
    put(graph, id, &nucleus::MAX_COLLISION_ITERATIONS.row, int(setting.collision_iterations));
    put(graph, id, &nucleus::EVALUATIONS.row, evaluations);
}

fn scale_resistances(graph: &mut Graph, cloth: NodeId, factor: f64) {
    for key in PLANE_RESISTANCES {
        let held = match graph.node(cloth).setting(key) {
            Some(Held::Keyed(curve)) => scaled(curve, factor, 0.0),
            _ => Held::Fixed(Value::Float(graph.node(cloth).get(key) * factor)),
        };
        put(graph, cloth, &key.row, held);
    }
}

/// A curve with all values multiplied by a factor, none below `least`.
fn scaled(curve: &Curve, factor: f64, least: f64) -> Held {
    let keys = curve.keys().iter();
    let keys =
        keys.map(|key| nucleus_graph::animation::Key { value: (key.value * factor).max(least), ..*key });
    match Curve::new(keys.collect()) {
        Ok(curve) => Held::Keyed(curve),
        // Only absurd values are rejected; those keep the curve unchanged.
        Err(_) => Held::Keyed(curve.clone()),
    }
}

/// Sets an attribute. A rejected value leaves the attribute unchanged, so that the scene still compiles.
fn put(graph: &mut Graph, node: NodeId, attribute: &'static Attribute, held: Held) {
    let _ = graph.set(node, attribute, held);
}

#[cfg(test)]
mod tests {
    use nucleus_graph::scene::edit::edit;
    use nucleus_graph::scene::{read_scene_text, write_scene};

    use super::super::benchmark::Benchmark;
    use super::*;

    /// A sheet that hangs by a corner, and one that falls; `own` is what the nucleus states.
    fn scene_text(own: &str) -> String {
        format!(
            r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {{
            "nucleus1": nucleus({own}),
            "grid": polyPlane(width: 1, height: 1, subdivisions: (4, 4)),
            "curtain": nCloth(inputMesh: "grid", pointMass: 0.3, tethers: false, stretchResistance: 40),
            "other": polyPlane(width: 1, height: 1, subdivisions: (4, 4), translate: (3, 0, 0)),
            "scarf": nCloth(inputMesh: "other"),
            "nail": dynamicConstraint(constraintType: transform, components: ["curtain.vtx[0]"]),
        }})"#
        )
    }

    fn parsed(text: &str) -> Scene {
        read_scene_text(text, "scene.ron".as_ref()).unwrap_or_else(|found| panic!("{found:?}")).0
    }

    #[test]
    fn the_edited_text_of_a_scene_is_the_scene_at_the_setting() {
        let all = ["evaluations: 48, subSteps: 2", "evaluations: keys([(1, 48), (5, 96)])", ""];
        for text in all.map(scene_text) {
            let benchmark = Benchmark::new(&parsed(&text)).unwrap();
            let own = benchmark.own();
            let settings = [
                Setting { tethers: true, ..own },
                Setting { tethers: true, evaluations: 24.0, substeps: 5, ..own },
                Setting { collision_iterations: 9, ..own.with_evaluations(192.0) },
                Setting { reading: Reading::Classic, resistance: 0.5, ..own },
            ];
            for setting in settings {
                let edits = benchmark.edits(&setting);
                let edited = Benchmark::new(&parsed(&edit(&text, &edits).unwrap())).unwrap();
                // Both at the same setting, so that they state it in the same words.
                let neutral = Setting { tethers: false, resistance: 1.0, ..setting };
                let [edited, set] =
                    [edited.set(&neutral), benchmark.set(&setting)].map(|scene| write_scene(&scene));
                assert_eq!(edited, set, "{setting}: {edits:?}");
            }
            assert_eq!(benchmark.edits(&own), []);
        }
    }
}
