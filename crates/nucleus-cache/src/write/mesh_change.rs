//! Records meshes that change during a run.

use std::io::{Seek, Write};

use nucleus_core::{Faces, SubstepIndex};

use crate::error::RecordError;
use crate::messages::attribute::RestEdges;
use crate::messages::topology;
use crate::run::ObjectInfo;
use crate::write::recorder::{FrameRecorder, Recorder, Track};

impl<W: Write + Seek> FrameRecorder<'_, W> {
    /// Replaces the mesh of an object from substep `index` of this frame on. `rest` has its points in scene units. Call
    /// it before [`substep`](nucleus_core::StepObserver::substep) for that state; [`Recorder::end_frame`] reports
    /// errors.
    pub fn change_mesh(&mut self, index: SubstepIndex, object: &str, faces: Faces, rest: Vec<[f32; 3]>) {
        if self.recorder.deferred_error.is_none() {
            self.recorder.deferred_error = self.recorder.change_mesh(index, object, faces, rest).err();
        }
    }
}

impl<W: Write + Seek> Recorder<W> {
    fn change_mesh(
        &mut self,
        index: SubstepIndex,
        name: &str,
        faces: Faces,
        rest: Vec<[f32; 3]>,
    ) -> Result<(), RecordError> {
        let stamp = self.stamp(index);
        let track = self.tracks.iter_mut().find(|track| track.name == name);
        let track = track.ok_or_else(|| RecordError::NoObject { name: name.to_owned() })?;
        let object = ObjectInfo { name: name.to_owned(), kind: track.kind, faces, rest };
        if !object.is_valid() {
            return Err(RecordError::BadMesh { object: object.name });
        }
        track.set_mesh(&object, track.mesh + 1);
        // A change of mesh requires new positions, even of a resting collider.
        track.has_moved = true;
        topology::write(object, track.mesh, &mut self.message);
        if let Some(replay_check) = &mut self.replay_check {
            replay_check.compare(&stamp, name, "topology", &self.message);
        }
        self.writer.send(&stamp, track.mesh_channel, &self.message)
    }

    /// Copies a mesh from another cache; `true` if it is not the first mesh of its object.
    pub(crate) fn copy_mesh(&mut self, topic: &str, data: &[u8]) -> bool {
        let Some(name) = topology::object_name(topic) else { return false };
        let track = self.tracks.iter_mut().find(|track| track.name == name);
        match (track, topology::read(name, data)) {
            (Some(track), Some((object, number))) if number > 0 => {
                track.set_mesh(&object, number);
                true
            }
            _ => false,
        }
    }
}

impl Track {
    fn set_mesh(&mut self, object: &ObjectInfo, number: u32) {
        self.mesh = number;
        self.points = object.rest.len();
        if let Some((_, edges)) = &mut self.strain {
            *edges = RestEdges::new(object);
        }
    }
}
