//! The rate map of a surface emitter: a texture that is read at the place of each birth, so faces may be larger than what is
//! painted on them.

use nucleus_core::Faces;

use crate::animation::Affine;
use crate::attributes::{Painting, Value, point_emitter};
use crate::compile::compiler::Compiler;
use crate::compile::geometry::placed_faces;
use crate::compile::sources::RateMap;
use crate::compile::texture_coordinates::of_mesh;
use crate::graph::NodeId;
use crate::paint::Texture;

impl Compiler<'_> {
    /// The rate map of an emitter on a mesh of these faces, in the order of their triangles; `Some(None)` without one. `None`
    /// after an error, which is reported.
    pub(super) fn rate_map(
        &mut self,
        emitter: NodeId,
        mesh: NodeId,
        faces: &Faces,
    ) -> Option<Option<RateMap>> {
        let enabled = self.start.get(emitter, &point_emitter::ENABLE_TEXTURE_RATE);
        let held = self.start.held(emitter, &point_emitter::RATE_MAP);
        let (true, Some(Value::Painting(Painting::Texture(file)))) = (enabled, held) else {
            return Some(None);
        };
        let emits_from_dark = self.start.get(emitter, &point_emitter::EMIT_FROM_DARK);
        let texture = Texture::read(&self.scene.source.path(&file)).map_err(|error| error.to_string());
        let [name, mesh_name] = [emitter, mesh].map(|node| self.scene.graph.node(node).name());
        let found = texture.and_then(|texture| match self.triangle_uvs(mesh, faces)? {
            Some(uvs) => Ok(RateMap { texture, uvs, emits_from_dark }),
            None => {
                Err(format!("`rateMap` of `{name}` asks for texture coordinates, and `{mesh_name}` has none"))
            }
        });
        match found {
            Ok(map) => Some(Some(map)),
            Err(message) => {
                let place = self.scene.source.place(&format!("{name}.rateMap"));
                self.findings.error(&place, message);
                None
            }
        }
    }

    /// The texture coordinates of the triangles of a mesh of these faces; `None` if it has none.
    fn triangle_uvs(&self, mesh: NodeId, faces: &Faces) -> Result<Option<Vec<[[f64; 2]; 3]>>, String> {
        let placement = self.start.placement(mesh);
        if let Some((values, corners)) = of_mesh(self.scene, self.scene.graph.node(mesh), faces) {
            let own = if corners.is_empty() { Some(faces.clone()) } else { with_corners(faces, &corners) };
            if let Some(uvs) = own.and_then(|own| triangles(&own, &placement, &values)) {
                return Ok(Some(uvs));
            }
        }
        // Faces were left out of the mesh, and their corners with them: each point has the coordinates of its first face.
        let uvs = self.geometry.uvs(self.scene, mesh).map_err(|error| error.to_string())?;
        let uvs: Option<Vec<[f64; 2]>> = uvs.unwrap_or_default().into_iter().collect();
        Ok(uvs.and_then(|uvs| triangles(faces, &placement, &uvs)))
    }
}

/// Faces with other corners; `None` if these are not as many.
fn with_corners(faces: &Faces, corners: &[u32]) -> Option<Faces> {
    let mut rest = corners;
    let mut all = Faces::default();
    for face in faces.iter() {
        let (own, after) = rest.split_at_checked(face.len())?;
        all.push(own);
        rest = after;
    }
    rest.is_empty().then_some(all)
}

/// The values at the corners of the triangles of a placed mesh; `None` where one is missing.
fn triangles(faces: &Faces, placement: &Affine, values: &[[f64; 2]]) -> Option<Vec<[[f64; 2]; 3]>> {
    let value = |corner: u32| values.get(corner as usize).copied();
    let of_triangle = |[a, b, c]: [u32; 3]| Some([value(a)?, value(b)?, value(c)?]);
    placed_faces(faces, placement).triangles().map(of_triangle).collect()
}
