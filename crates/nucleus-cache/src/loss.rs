//! What of a run is missing from its file, in words.

use std::fmt;

/// What of a run is missing from its file. A run that was ended early but closed has lost nothing.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Loss {
    /// The file ends before its index: the run was killed, the disk was full, or a copy was cut off.
    pub cut_off: bool,
    /// The index is there but damaged; everything was found without it.
    pub index: bool,
    /// The start of the file is damaged, and was read from a copy of it.
    pub start: bool,
    /// What is known of the run is lost, and its frames are found by what is in them.
    pub run: bool,
    /// Objects whose meshes are lost, and which are shown as points.
    pub meshes: Vec<String>,
    /// Objects of which nothing is left.
    pub objects: Vec<String>,
    /// The text of the scene is damaged and left out.
    pub scene: bool,
    /// Bytes at the end that belong to no whole frame.
    pub bytes: u64,
    /// Frames that should be in the file and are not, or cannot be read.
    pub frames: Vec<i32>,
    /// Frames whose checkpoints cannot be read. Nothing that is shown is missing; the run goes on from an earlier one.
    pub checkpoints: Vec<i32>,
}

impl Loss {
    /// Each once, in order.
    pub(crate) fn in_order(&mut self) {
        for frames in [&mut self.frames, &mut self.checkpoints] {
            frames.sort_unstable();
            frames.dedup();
        }
    }

    /// Whether the run can be gone on with: what it is and all its meshes are known.
    pub fn knows_run(&self) -> bool {
        !self.run && self.meshes.is_empty() && self.objects.is_empty()
    }

    /// What no copy brings back, in words: frames, checkpoints, meshes; nothing where there is no such loss.
    pub fn for_good(&self) -> Option<String> {
        let left = Self { cut_off: false, index: false, bytes: 0, start: false, ..self.clone() };
        (!left.is_none()).then(|| left.to_string())
    }

    /// Whether nothing is missing.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

impl fmt::Display for Loss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = Vec::new();
        if self.cut_off {
            parts.push(match self.bytes {
                0 => "the file was cut off before its index".to_owned(),
                bytes => format!("the file was cut off, {bytes} bytes of an unfinished frame at its end"),
            });
        }
        if self.index {
            parts.push("the index is damaged; the frames were found without it".to_owned());
        }
        if self.start {
            parts.push("the start of the file is damaged; it was read from a copy".to_owned());
        }
        if self.run {
            parts.push(
                "the record of the run is lost; its frames were found by what is in them, its units are unknown"
                    .to_owned(),
            );
        }
        if !self.meshes.is_empty() {
            parts.push(format!("shown as points, without a mesh: {}", names(&self.meshes)));
        }
        if !self.objects.is_empty() {
            parts.push(format!("lost: {}", names(&self.objects)));
        }
        if self.scene {
            parts.push("the text of the scene is damaged".to_owned());
        }
        if !self.frames.is_empty() {
            parts.push(format!("missing or damaged: {}", ranges(&self.frames)));
        }
        if !self.checkpoints.is_empty() {
            parts.push(format!("damaged: the checkpoint of {}", ranges(&self.checkpoints)));
        }
        match parts.is_empty() {
            true => f.write_str("nothing is lost"),
            false => f.write_str(&parts.join("; ")),
        }
    }
}

/// `` `a`, `b` ``.
fn names(objects: &[String]) -> String {
    objects.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// `frame 3`, `frames 3 to 5, 9`.
fn ranges(frames: &[i32]) -> String {
    let runs = frames.chunk_by(|a, b| a.checked_add(1) == Some(*b));
    let runs: Vec<String> = runs
        .map(|run| match run {
            [only] => only.to_string(),
            run => format!("{} to {}", run[0], run[run.len() - 1]),
        })
        .collect();
    format!("frame{} {}", if frames.len() == 1 { "" } else { "s" }, runs.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loss_names_its_frames() {
        let loss = Loss { cut_off: true, frames: vec![3, 7, 8, 9], ..Loss::default() };
        let text = "the file was cut off before its index; missing or damaged: frames 3, 7 to 9";
        assert_eq!(loss.to_string(), text);
    }

    #[test]
    fn one_frame_is_not_plural() {
        let loss = Loss { frames: vec![-4], ..Loss::default() };
        assert_eq!(loss.to_string(), "missing or damaged: frame -4");
    }
}
