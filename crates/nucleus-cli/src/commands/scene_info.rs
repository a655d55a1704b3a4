//! `nucleus info` of a scene: its nodes, its objects, and the cost of each solver pass in the first frame.

use std::collections::HashSet;
use std::fmt::Write;

use nucleus_core::{ClothId, FrameInput, PassCost, PhysicalStiffness, ResistanceModel, classic_stiffness};
use nucleus_graph::Simulation;
use nucleus_graph::compile::{NamedSelection, Object, ObjectKind, Program};
use nucleus_graph::scene::{Scene, TimeSpan};
use serde_json::{Value, json};

use crate::figures;

/// A scene and the program that it compiles to.
pub struct SceneInfo {
    time: TimeSpan,
    /// Name and type of each node.
    nodes: Vec<(String, &'static str)>,
    nuclei: Vec<NucleusFacts>,
    objects: Vec<ObjectFacts>,
    selections: Vec<NamedSelection>,
}

/// A nucleus with its objects and the cost of its passes.
struct NucleusFacts {
    name: String,
    input: FrameInput,
    passes: Vec<PassCost>,
}

struct ObjectFacts {
    name: String,
    kind: &'static str,
    points: usize,
    edges: usize,
    faces: usize,
    /// Extent of the bounding box at the start, in metres.
    size: [f64; 3],
    /// Stiffness in the first frame; `None` for colliders and particles.
    stiffness: Option<ClothStiffness>,
}

impl SceneInfo {
    /// Evaluates the first frame of a scene.
    pub fn of(scene: &Scene, program: &Program) -> Self {
        let simulation: Simulation = Simulation::new(program, 1);
        let nodes =
            scene.graph.iter().map(|(_, node)| (node.name().to_owned(), node.node_type().name)).collect();
        let nuclei: Vec<_> = program
            .nuclei()
            .iter()
            .zip(program.first_inputs())
            .zip(simulation.solvers())
            .map(|((nucleus, input), solver)| {
                let passes = solver.passes(&input).into_iter().filter(|pass| pass.evaluations() > 0.0);
                let name = scene.graph.node(nucleus.node()).name().to_owned();
                NucleusFacts { name, passes: passes.collect(), input }
            })
            .collect();
        let objects = program.objects().iter().map(|object| facts(object, program, &simulation, &nuclei));
        let objects = objects.collect();
        let selections = program.nuclei().iter().flat_map(|nucleus| nucleus.selections().to_vec()).collect();
        Self { time: program.time(), nodes, objects, nuclei, selections }
    }

    /// The information as text; `lists_elements`: with what constraints select.
    pub fn as_text(&self, name: &str, lists_elements: bool) -> Result<String, std::fmt::Error> {
        let TimeSpan { start, end, fps } = self.time;
        let mut text = format!("{name}: frames {start} to {end} at {} per second\n", figures::number(fps));
        for nucleus in &self.nuclei {
            writeln!(text, "{}{}", self.heading(nucleus), nucleus.line())?;
        }
        for (name, node_type) in &self.nodes {
            writeln!(text, "node {name}: {node_type}")?;
        }
        for object in &self.objects {
            writeln!(text, "object {}", object.line())?;
        }
        for selection in self.selections.iter().filter(|_| lists_elements) {
            writeln!(text, "{}", selection_line(selection))?;
        }
        let passes = || self.nuclei.iter().flat_map(|nucleus| &nucleus.passes);
        let total: f64 = passes().map(PassCost::evaluations).sum();
        for nucleus in &self.nuclei {
            for pass in &nucleus.passes {
                let (sweeps, evaluations) =
                    (figures::number(pass.sweeps), figures::number(pass.evaluations()));
                let share = figures::percent((100.0 * pass.evaluations() / total).round() / 100.0);
                writeln!(
                    text,
                    "{}pass {:<9} {:>8} rows x {sweeps:>5} sweeps = {evaluations:>9} per frame, {share}",
                    self.heading(nucleus),
                    pass.name,
                    pass.rows
                )?;
            }
        }
        Ok(text)
    }

    /// The name of a nucleus as a prefix, if there are several.
    fn heading(&self, nucleus: &NucleusFacts) -> String {
        if self.nuclei.len() > 1 { format!("{}: ", nucleus.name) } else { String::new() }
    }

    /// The information as JSON.
    pub fn as_json(&self) -> Value {
        let node = |(name, node_type): &(String, &str)| json!({ "name": name, "type": node_type });
        json!({
            "frames": { "start": self.time.start, "end": self.time.end, "per_second": self.time.fps },
            "selections": self.selections.iter().map(selection_json).collect::<Vec<_>>(),
            "nodes": self.nodes.iter().map(node).collect::<Vec<_>>(),
            "objects": self.objects.iter().map(ObjectFacts::as_json).collect::<Vec<_>>(),
            "nuclei": self.nuclei.iter().map(NucleusFacts::as_json).collect::<Vec<_>>(),
        })
    }
}

/// `select hand: sheet.vtx[3] sheet.vtx[5:8], 5 points`.
fn selection_line(selection: &NamedSelection) -> String {
    let NamedSelection { owner, object, kind, elements, .. } = selection;
    let count = figures::count(elements.len(), kind.noun());
    format!("select {owner}: {}, {count}", components(&format!("{object}.{}", kind.word()), elements))
}

fn selection_json(selection: &NamedSelection) -> Value {
    let NamedSelection { owner, object, kind, elements, .. } = selection;
    json!({ "owner": owner, "object": object, "kind": kind.noun(), "count": elements.len(), "elements": elements })
}

/// `sheet.vtx[3] sheet.vtx[5:8]`: numbers in order, runs as their ends; the first twelve.
fn components(of: &str, elements: &[u32]) -> String {
    let mut sorted = elements.to_vec();
    sorted.sort_unstable();
    let mut runs: Vec<[u32; 2]> = Vec::new();
    for at in sorted {
        match runs.last_mut() {
            Some(run) if run[1] + 1 == at => run[1] = at,
            _ => runs.push([at; 2]),
        }
    }
    let more = if runs.len() > 12 { " ..." } else { "" };
    let run = |[first, last]: &[u32; 2]| match first == last {
        true => format!("{of}[{first}]"),
        false => format!("{of}[{first}:{last}]"),
    };
    runs.iter().take(12).map(run).collect::<Vec<_>>().join(" ") + more
}

impl NucleusFacts {
    /// `3 substeps per frame; physical: 96 evaluations in 1/24 s`.
    fn line(&self) -> String {
        let reading = match self.input.resistance {
            ResistanceModel::Classic => "classic: resistances are iteration counts".to_owned(),
            ResistanceModel::Physical { evaluations } => {
                format!("physical: {} evaluations in 1/24 s", figures::number(evaluations))
            }
        };
        format!("{} per frame; {reading}", figures::count(self.input.substeps as usize, "substep"))
    }

    fn as_json(&self) -> Value {
        let pass = |pass: &PassCost| {
            json!({
                "name": pass.name, "rows": pass.rows, "sweeps": pass.sweeps, "evaluations": pass.evaluations(),
            })
        };
        let evaluations = match self.input.resistance {
            ResistanceModel::Classic => None,
            ResistanceModel::Physical { evaluations } => Some(evaluations),
        };
        json!({
            "name": self.name,
            "substeps": self.input.substeps,
            "evaluations": evaluations,
            "passes": self.passes.iter().map(pass).collect::<Vec<_>>(),
        })
    }
}

impl ObjectFacts {
    fn line(&self) -> String {
        let [x, y, z] = self.size.map(figures::number);
        let counts = [(self.points, "point"), (self.edges, "edge"), (self.faces, "face")];
        let counts = counts.map(|(number, noun)| figures::count(number, noun)).join(", ");
        let line = format!("{}: {}, {counts}, {x} x {y} x {z} m", self.name, self.kind);
        match &self.stiffness {
            Some(stiffness) => format!("{line}, {}", stiffness.words()),
            None => line,
        }
    }

    fn as_json(&self) -> Value {
        json!({
            "name": self.name, "kind": self.kind, "points": self.points, "edges": self.edges, "faces": self.faces,
            "size_metres": self.size,
            "stretch_stiffness": self.stiffness.as_ref().map(ClothStiffness::stretch),
            "stiffness": self.stiffness.as_ref().map(ClothStiffness::as_json),
        })
    }
}

fn facts(
    object: &Object,
    program: &Program,
    simulation: &Simulation,
    nuclei: &[NucleusFacts],
) -> ObjectFacts {
    let mut positions = Vec::new();
    let (kind, stiffness) = match object.kind {
        ObjectKind::Cloth(id) => {
            simulation.state().positions(id, 1.0, &mut positions);
            match object.radius {
                Some(_) => ("particles", None),
                None => ("cloth", ClothStiffness::of(id, program, nuclei)),
            }
        }
        ObjectKind::Collider(id) => {
            simulation.state().collider_positions(id, 1.0, &mut positions);
            ("collider", None)
        }
    };
    ObjectFacts {
        name: object.name.clone(),
        kind,
        points: object.points,
        edges: edges(object),
        faces: object.faces.len(),
        size: size(&positions),
        stiffness,
    }
}

/// The stiffness of a cloth in SI units.
enum ClothStiffness {
    /// Approximate stretch stiffness in N/m; it depends on the mesh and the substeps.
    Classic(f64),
    /// Stiffnesses that mesh and substeps do not change.
    Physical(PhysicalStiffness),
}

impl ClothStiffness {
    /// Stiffness in the first frame. The classic model uses the mean mass of all points of the scene.
    fn of(id: ClothId, program: &Program, nuclei: &[NucleusFacts]) -> Option<Self> {
        let mut own = program.nuclei().iter().map(|nucleus| nucleus.cloths()).zip(nuclei);
        let (cloths, NucleusFacts { input, .. }) = own.find(|(cloths, _)| cloths.contains(&id.0))?;
        let cloth = input.cloths.get((id.0 - cloths.start) as usize)?;
        let is_cloth = |object: &&Object| matches!(object.kind, ObjectKind::Cloth(_));
        let points: usize = program.objects().iter().filter(is_cloth).map(|object| object.points).sum();
        let substep = input.duration / f64::from(input.substeps);
        Some(match input.resistance {
            ResistanceModel::Classic => {
                let mass = program.mass() / points as f64;
                Self::Classic(classic_stiffness(cloth.stretch_resistance, substep, mass))
            }
            ResistanceModel::Physical { .. } => Self::Physical(PhysicalStiffness::of(cloth)),
        })
    }

    fn stretch(&self) -> f64 {
        match self {
            Self::Classic(stretch) => *stretch,
            Self::Physical(stiffness) => stiffness.stretch,
        }
    }

    fn words(&self) -> String {
        let Self::Physical(PhysicalStiffness { stretch, compression, shear, bend, warp, weft }) = self else {
            return format!("stretch about {} N/m", figures::number(self.stretch()));
        };
        let membrane = [(stretch, "stretch"), (compression, "compression"), (shear, "shear")];
        // Of cloth without threads of its own they are the stiffness in stretch.
        let threads = [(warp, "warp"), (weft, "weft")].into_iter().filter(|(own, _)| *own != stretch);
        let membrane = membrane.into_iter().chain(threads).map(|(stiffness, name)| (stiffness, name, "N/m"));
        let all = membrane.chain([(bend, "bend", "N·m")]).filter(|(stiffness, ..)| **stiffness > 0.0);
        let words: Vec<String> = all
            .map(|(stiffness, name, unit)| format!("{name} {} {unit}", figures::number(*stiffness)))
            .collect();
        if words.is_empty() { "no stiffness".to_owned() } else { words.join(", ") }
    }

    fn as_json(&self) -> Value {
        match self {
            Self::Classic(stretch) => json!({ "stretch": stretch }),
            Self::Physical(PhysicalStiffness { stretch, compression, shear, bend, warp, weft }) => {
                json!({
                    "stretch": stretch, "compression": compression, "shear": shear, "bend": bend, "warp": warp,
                    "weft": weft,
                })
            }
        }
    }
}

/// Number of distinct edges of the faces.
fn edges(object: &Object) -> usize {
    let around = |face: &[u32]| -> Vec<[u32; 2]> {
        let ends = face.iter().zip(face.iter().cycle().skip(1));
        ends.map(|(&a, &b)| [a.min(b), a.max(b)]).collect()
    };
    object.faces.iter().flat_map(around).collect::<HashSet<_>>().len()
}

/// Extent of the bounding box of some points along each axis.
fn size(positions: &[[f32; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|axis| {
        let along = positions.iter().map(|point| f64::from(point[axis]));
        let (low, high) = along.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
        (high - low).max(0.0)
    })
}
