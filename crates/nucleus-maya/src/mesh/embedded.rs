//! The mesh that a shape stores: `.vt` points, `.ed` edges, `.fc` faces of edges, `.pt` tweaks, `.uvst` coordinates.

use crate::ascii::Token;
use crate::scene::{MayaScene, NodeId};

use super::poly::Poly;

/// The mesh of a shape without its tweaks; `None` if it stores none.
///
/// # Errors
/// When its parts do not fit together.
pub(crate) fn stored(scene: &MayaScene, id: NodeId) -> Result<Option<Poly>, String> {
    let broken = || "an index leads far beyond what the file gives".to_owned();
    let numbers = scene.array(id, &["vt", "vrts"], 3, &[&["vx", "vrtx"], &["vy", "vrty"], &["vz", "vrtz"]]);
    let numbers = numbers.ok_or_else(broken)?;
    if numbers.is_empty() {
        return Ok(None);
    }
    if numbers.iter().any(|x| x.is_nan() || x.abs() >= 1e15) {
        return Err("a point is not a finite number".to_owned());
    }
    let mut mesh = Poly::reshaped(numbers.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect());
    let edges = scene.array(id, &["ed", "edge"], 3, &[]).ok_or_else(broken)?;
    mesh.stored_edges = edges.chunks_exact(3).map(|edge| [edge[0] as u32, edge[1] as u32]).collect();
    let points = mesh.points.len() as u32;
    if let Some(edge) = mesh.stored_edges.iter().position(|edge| edge.iter().any(|point| *point >= points)) {
        return Err(format!("edge {edge} leads to a point that does not exist"));
    }
    mesh.uvs = uvs(scene, id);
    faces(scene, id, &mut mesh)?;
    Ok(Some(mesh))
}

/// Adds the tweaks of a shape to its points, or to those that its history makes.
pub(crate) fn add_tweaks(scene: &MayaScene, id: NodeId, mesh: &mut Poly) {
    let tweaks = scene.array(id, &["pt", "pnts"], 3, &[&["px", "pntx"], &["py", "pnty"], &["pz", "pntz"]]);
    add(&mut mesh.points, &tweaks.unwrap_or_default(), scene.units_of(id).centimetres);
}

/// Adds offsets, times a factor, to points.
pub(super) fn add(points: &mut [[f64; 3]], offsets: &[f64], factor: f64) {
    for (point, offset) in points.iter_mut().zip(offsets.chunks_exact(3)) {
        for k in 0..3 {
            if offset[k].is_finite() {
                point[k] += offset[k] * factor;
            }
        }
    }
}

/// The texture coordinates of the first set.
fn uvs(scene: &MayaScene, id: NodeId) -> Vec<[f64; 2]> {
    let mut all: Vec<[f64; 2]> = Vec::new();
    for set in scene.assigned(id, &["uvst", "uvSet"]) {
        let inner = set.rest.last();
        if set.segment.range.is_none_or(|range| range.0 != 0) || !matches!(inner.name, "uvsp" | "uvSetPoints")
        {
            continue;
        }
        let first = inner.range.map_or(0, |range| range.0 as usize);
        let numbers: Vec<f64> = set.values.numbers().collect();
        if first <= all.len() {
            all.truncate(first);
            all.extend(numbers.chunks_exact(2).map(|uv| [uv[0], uv[1]]));
        }
    }
    all
}

/// Faces are lists of edges: `f 4 0 1 -3 2`, where -3 is edge 2 from its end to its start. After a face come its holes
/// (`h`), texture coordinates (`mu set count ...`) and colours (`mc`).
fn faces(scene: &MayaScene, id: NodeId, mesh: &mut Poly) -> Result<(), String> {
    let mut uv_corners = Vec::new();
    let mut has_uvs = true;
    for set in scene.assigned(id, &["fc", "face"]) {
        let mut tokens = set.values.tokens();
        while let Some(token) = tokens.next() {
            let Token::Word(word) = token else { continue };
            let mut number = || match tokens.next() {
                Some(Token::Word(word)) => word.parse::<i64>().ok(),
                _ => None,
            };
            match word {
                "f" => {
                    // A face without texture coordinates: the corners before it are fewer than needed.
                    has_uvs &= uv_corners.len() == mesh.corners.len();
                    let count = number().unwrap_or(0);
                    for _ in 0..count {
                        let edge = number().ok_or_else(|| cut(mesh))?;
                        let (index, end) = if edge >= 0 { (edge, 0) } else { (-(edge + 1), 1) };
                        let edge = usize::try_from(index).ok().and_then(|index| mesh.stored_edges.get(index));
                        let missing =
                            || format!("face {} has an edge that does not exist", mesh.face_count());
                        let point = edge.ok_or_else(missing)?[end];
                        mesh.corners.push(point);
                    }
                    mesh.ends.push(mesh.corners.len() as u32);
                }
                "mu" => {
                    let (set, count) = (number().unwrap_or(0), number().unwrap_or(0));
                    for _ in 0..count {
                        let uv = number().ok_or_else(|| cut(mesh))?;
                        if set == 0 {
                            uv_corners.push(u32::try_from(uv).unwrap_or(0));
                        }
                    }
                }
                "h" | "mf" | "mh" | "fc" => skip(number(), &mut number),
                "mc" => {
                    number();
                    let count = number();
                    skip(count, &mut number);
                }
                _ => {}
            }
        }
    }
    let fits = uv_corners.len() == mesh.corners.len();
    if has_uvs && fits && uv_corners.iter().all(|uv| (*uv as usize) < mesh.uvs.len()) {
        mesh.uv_corners = uv_corners;
    }
    Ok(())
}

fn skip(count: Option<i64>, number: &mut impl FnMut() -> Option<i64>) {
    for _ in 0..count.unwrap_or(0) {
        if number().is_none() {
            return;
        }
    }
}

fn cut(mesh: &Poly) -> String {
    format!("face {} is cut off", mesh.face_count())
}
