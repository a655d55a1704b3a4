//! A mesh as the text of an OBJ file.

use std::fmt::Write;

use super::poly::Poly;

/// The text of an OBJ file: points, texture coordinates where every corner has one, faces.
pub fn obj_text(mesh: &Poly) -> String {
    let mut text = String::with_capacity(40 * mesh.points.len() + 8 * mesh.corners.len());
    for [x, y, z] in &mesh.points {
        let _ = writeln!(text, "v {x} {y} {z}");
    }
    let has_uvs = !mesh.uv_corners.is_empty() && mesh.uv_corners.len() == mesh.corners.len();
    if has_uvs {
        for [u, v] in &mesh.uvs {
            let _ = writeln!(text, "vt {u} {v}");
        }
    }
    let mut at = 0;
    for face in mesh.faces() {
        text.push('f');
        for point in face {
            let _ = match has_uvs {
                true => write!(text, " {}/{}", point + 1, mesh.uv_corners[at] + 1),
                false => write!(text, " {}", point + 1),
            };
            at += 1;
        }
        text.push('\n');
    }
    text
}
