//! A flat rectangle.

use nalgebra::Vector3;
use nucleus_core::{Faces, Surface};

use super::primitive::{PrimitiveError, check_length, check_size, check_subdivisions, even_step};

/// A rectangle of quads in the xz plane, facing up, round the origin: Maya's `polyPlane`.
///
/// `width` is along x, `height` along z, both in scene units; Maya's defaults are 1, 1 and `(10, 10)`.
/// As in Maya, point 0 is at -x, +z; rows run along +x, one after the other towards -z. Faces likewise.
///
/// # Errors
/// When a length is not above zero, a number of subdivisions is zero, or there would be too many points.
pub fn poly_plane(width: f64, height: f64, (sx, sy): (u32, u32)) -> Result<Surface, PrimitiveError> {
    check_length("width", width)?;
    check_length("height", height)?;
    check_subdivisions("width", sx, 1)?;
    check_subdivisions("height", sy, 1)?;
    check_size(u64::from(sx) + 1, u64::from(sy) + 1)?;
    let row =
        |j| (0..=sx).map(move |i| Vector3::new(width * even_step(i, sx), 0.0, -height * even_step(j, sy)));
    let mut faces = Faces::with_capacity((sx * sy) as usize, (4 * sx * sy) as usize);
    for (j, i) in (0..sy).flat_map(|j| (0..sx).map(move |i| (j, i))) {
        let near = j * (sx + 1) + i;
        let far = near + sx + 1;
        faces.push(&[near, near + 1, far + 1, far]);
    }
    Ok(Surface { positions: (0..=sy).flat_map(row).collect(), faces })
}

/// The texture coordinates of its points, as Maya makes them: u along +x, v along -z, both from 0 to 1.
pub fn poly_plane_uvs((sx, sy): (u32, u32)) -> Vec<[f64; 2]> {
    let share = |k: u32, of: u32| f64::from(k) / f64::from(of.max(1));
    (0..=sy).flat_map(|j| (0..=sx).map(move |i| [share(i, sx), share(j, sy)])).collect()
}
