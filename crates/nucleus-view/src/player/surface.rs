//! The surface of particles at a recorded time, made when the page requests it.

use std::path::Path;

use nucleus_cache::{LiquidSurface, Playback};

/// The surface that `object/frame/k` names, of a cache; `None` if there is none. The object is percent-encoded, and `k` counts
/// the recorded times of the frame from 0.
///
/// The bytes are the number of points and of quads, then three floats per point and four numbers per quad, all little
/// endian and four bytes each.
pub(super) fn surface(cache: &Path, wanted: &str) -> Option<Vec<u8>> {
    let mut parts = wanted.rsplitn(3, '/');
    let (k, frame): (usize, i32) = (parts.next()?.parse().ok()?, parts.next()?.parse().ok()?);
    let name = decoded(parts.next()?)?;
    let mut cache = Playback::open(cache).ok()?;
    let object = cache.objects().iter().position(|object| object.name == name)?;
    let samples = cache.time_samples();
    let sample = (0..samples.len()).filter(|&at| samples[at].frame == frame).nth(k)?;
    let spacing = cache.particle_spacing(object).ok()??;
    let (positions, shape) = (cache.positions(object, sample).ok()?, cache.surface_shape(object).ok()?);
    Some(encoded(&LiquidSurface::of(&positions, spacing, shape)))
}

fn encoded(LiquidSurface { positions, quads }: &LiquidSurface) -> Vec<u8> {
    let counts = [positions.len() as u32, quads.len() as u32];
    let floats = positions.iter().flatten().map(|x| x.to_bits());
    counts
        .into_iter()
        .chain(floats)
        .chain(quads.iter().flatten().copied())
        .flat_map(u32::to_le_bytes)
        .collect()
}

/// A percent-encoded name; `None` if it is malformed.
fn decoded(text: &str) -> Option<String> {
    let (mut bytes, mut rest) = (Vec::new(), text.as_bytes());
    while let [first, after @ ..] = rest {
        rest = after;
        bytes.push(match first {
            b'%' => {
                let digits = std::str::from_utf8(after.get(..2)?).ok()?;
                rest = &after[2..];
                u8::from_str_radix(digits, 16).ok()?
            }
            plain => *plain,
        });
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use nucleus_cache::SurfaceShape;

    use super::*;

    #[test]
    fn a_name_is_decoded_and_malformed_ones_are_refused() {
        assert_eq!(decoded("a%2Fb%C3%A4").as_deref(), Some("a/bä"));
        for text in ["%", "%4", "%zz", "%ff"] {
            assert_eq!(decoded(text), None, "{text}");
        }
    }

    #[test]
    fn a_surface_is_two_counts_and_their_numbers() {
        let particles: Vec<[f32; 3]> = (0..27u8).map(|k| [k % 3, k / 3 % 3, k / 9].map(f32::from)).collect();
        let surface = LiquidSurface::of(&particles, 1.0, SurfaceShape::DEFAULT);
        let bytes = encoded(&surface);
        assert_eq!(bytes.len(), 8 + 12 * surface.positions.len() + 16 * surface.quads.len());
        assert_eq!(bytes[..4], (surface.positions.len() as u32).to_le_bytes());
        assert!(surface.quads.len() > 10);
    }
}
