//! Where the ground plane of each nucleus is while a frame is solved.

use nucleus_audit::Plane;
use nucleus_core::{ClothFrame, ClothId, FrameInput};

/// The ground planes of all nuclei.
#[derive(Debug, Default)]
pub(crate) struct Grounds {
    nuclei: Vec<Nucleus>,
}

/// The plane of one nucleus, as its solver was told.
#[derive(Debug, Default)]
struct Nucleus {
    /// At the start and the end of a span of the frame.
    planes: Option<[Plane; 2]>,
    /// The shares of the frame that the span begins and ends with.
    span: [f64; 2],
    first_cloth: u32,
    /// Whether each cloth meets it.
    meets: Vec<bool>,
}

impl Grounds {
    /// Begins a frame: all planes are where the last frame left them.
    pub(crate) fn begin_frame(&mut self) {
        for planes in self.nuclei.iter_mut().filter_map(|nucleus| nucleus.planes.as_mut()) {
            planes[0] = planes[1];
        }
    }

    /// A nucleus goes back to its initial state: it has had no plane yet.
    pub(crate) fn begin_anew(&mut self, nucleus: usize) {
        self.nucleus(nucleus).planes = None;
    }

    /// A nucleus is solved over a span of the frame. A plane that it had no time to move from appears where it is.
    pub(crate) fn take(&mut self, nucleus: usize, first_cloth: u32, input: &FrameInput, span: [f64; 2]) {
        let nucleus = self.nucleus(nucleus);
        let end = input.plane.as_ref().and_then(|plane| Plane::new(plane.origin, plane.normal));
        let start = nucleus.planes.map(|[_, end]| end);
        let meets = |cloth: &ClothFrame| cloth.collide && cloth.collide_strength > 0.0;
        nucleus.planes = end.map(|end| [start.unwrap_or(end), end]);
        nucleus.meets = input.cloths.iter().map(meets).collect();
        (nucleus.first_cloth, nucleus.span) = (first_cloth, span);
    }

    /// The plane that a cloth meets, at the start of the span and once a share of the frame is over.
    pub(crate) fn of(&self, cloth: ClothId, share: f64) -> Option<[Plane; 2]> {
        let meets = |nucleus: &Nucleus| {
            let own = cloth.0.checked_sub(nucleus.first_cloth);
            own.and_then(|own| nucleus.meets.get(own as usize)).copied()
        };
        let nucleus = self.nuclei.iter().find(|nucleus| meets(nucleus).is_some())?;
        let [start, end] = nucleus.planes.filter(|_| meets(nucleus) == Some(true))?;
        let [from, to] = nucleus.span;
        let gone = if to > from { ((share - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 };
        Some([start, start.towards(&end, gone)])
    }

    fn nucleus(&mut self, index: usize) -> &mut Nucleus {
        if self.nuclei.len() <= index {
            self.nuclei.resize_with(index + 1, Nucleus::default);
        }
        &mut self.nuclei[index]
    }
}
