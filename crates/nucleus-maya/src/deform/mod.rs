//! Deformers: blend shapes, skin clusters, tweaks. Evaluated frame by frame, so that the mesh becomes a sequence of files.
//!
//! | You want to know...                                  | Read              |
//! |------------------------------------------------------|-------------------|
//! | which deformers are carried out                      | [`is_deformer`]   |
//! | targets and weights                                  | `blend_shape.rs`  |
//! | joints and weights                                   | `skin_cluster.rs` |

mod blend_shape;
mod skin_cluster;

use crate::animation::Evaluator;
use crate::mesh::History;
use crate::mesh::{InputMesh, Poly};
use crate::omissions::Cause;
use crate::scene::NodeId;

/// Whether a type of node deforms its input. Those that are not carried out pass it on.
pub(crate) fn is_deformer(kind: &str) -> bool {
    const ALL: [&str; 20] = [
        "blendShape",
        "skinCluster",
        "tweak",
        "cluster",
        "softMod",
        "ffd",
        "wire",
        "wrap",
        "nonLinear",
        "deltaMush",
        "sculpt",
        "jiggle",
        "historySwitch",
        "shrinkWrap",
        "proximityWrap",
        "tension",
        "morph",
        "solidify",
        "textureDeformer",
        "cMuscleSystem",
    ];
    ALL.contains(&kind)
}

/// The result of a deformer; `input` builds further meshes that it reads.
pub(crate) fn deformed(
    evaluator: &Evaluator,
    id: NodeId,
    frame: f64,
    mut mesh: Poly,
    input: &InputMesh,
    history: &mut History,
) -> Result<Poly, String> {
    let scene = evaluator.scene;
    let envelope = evaluator.number_or(id, &["en", "envelope"], frame, 1.0);
    match scene.kind(id) {
        "blendShape" => blend_shape::apply(evaluator, id, frame, envelope, &mut mesh, input, history),
        "skinCluster" => {
            let method = scene.stored_or(id, &["skm", "skinningMethod"], 0.0);
            if method != 0.0 {
                history.omitted.push((scene.name(id).to_owned(), Cause::Skinning));
            }
            skin_cluster::apply(evaluator, id, frame, envelope, &mut mesh);
        }
        "tweak" => tweak(evaluator, id, &mut mesh),
        kind => history.omitted.push((scene.name(id).to_owned(), Cause::Operator(kind.to_owned()))),
    }
    Ok(mesh)
}

/// Offsets of single points: `vl[0].vt[3]`.
fn tweak(evaluator: &Evaluator, id: NodeId, mesh: &mut Poly) {
    let scene = evaluator.scene;
    for set in scene.assigned(id, &["vl", "vlist", "pl", "plist"]) {
        let mut inner = set.rest.segments();
        let Some(step) = inner.next() else { continue };
        let (Some((first, _)), true) =
            (step.range, matches!(step.name, "vt" | "vertex" | "cp" | "controlPoints"))
        else {
            continue;
        };
        let part = inner.next().and_then(|part| match part.name.chars().next_back() {
            Some('x' | 'X') => Some(0),
            Some('y' | 'Y') => Some(1),
            Some('z' | 'Z') => Some(2),
            _ => None,
        });
        let factor = scene.units_of(id).centimetres;
        for (k, x) in set.values.numbers().filter(|x| x.is_finite()).enumerate() {
            let (point, axis) = part.map_or((first as usize + k / 3, k % 3), |part| (first as usize, part));
            if let Some(point) = mesh.points.get_mut(point) {
                point[axis] += x * factor;
            }
        }
    }
}
