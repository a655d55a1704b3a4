//! The corruption report: which parts of a cache are missing or damaged.

use std::fmt;

use crate::messages::metadata;

/// Which parts of a cache are missing or damaged. A run that was interrupted but closed has lost nothing.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct CorruptionReport {
    /// The file ends before its index: the run was killed, the disk was full, or a copy is incomplete.
    pub truncated: bool,
    /// The index is damaged; it was rebuilt from the frames.
    pub index: bool,
    /// The start of the file is damaged; it was read from a redundant copy.
    pub start: bool,
    /// The metadata of the run is lost; it was reconstructed from the frames.
    pub run: bool,
    /// Objects whose meshes are lost. They are shown as points.
    pub meshes: Vec<String>,
    /// Objects that are lost entirely.
    pub objects: Vec<String>,
    /// Names of the records of the run that are damaged or missing, `nucleus.uvs` for instance. What they hold is left out.
    pub records: Vec<&'static str>,
    /// Number of damaged redundant copies: nothing is lost by them alone.
    pub copies: usize,
    /// Bytes at the end of the file that belong to no whole frame.
    pub bytes: u64,
    /// Frames that are missing or unreadable.
    pub frames: Vec<i32>,
    /// Frames whose checkpoints are unreadable. No recorded frame is missing; a run resumes from an earlier checkpoint.
    pub checkpoints: Vec<i32>,
}

impl CorruptionReport {
    /// Sorts the frames and removes duplicates.
    pub(crate) fn sort_and_dedup(&mut self) {
        for frames in [&mut self.frames, &mut self.checkpoints] {
            frames.sort_unstable();
            frames.dedup();
        }
    }

    /// Whether the run can be resumed: its metadata and all its meshes are known.
    pub fn can_resume(&self) -> bool {
        !self.run && self.meshes.is_empty() && self.objects.is_empty()
    }

    /// The damage that no redundant copy repairs, as text; `None` when there is none.
    pub fn unrecoverable(&self) -> Option<String> {
        let left = Self { truncated: false, index: false, bytes: 0, start: false, copies: 0, ..self.clone() };
        (!left.is_intact()).then(|| left.to_string())
    }

    /// Whether nothing is missing.
    pub fn is_intact(&self) -> bool {
        *self == Self::default()
    }
}

impl fmt::Display for CorruptionReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = Vec::new();
        if self.truncated {
            parts.push(match self.bytes {
                0 => "the file was cut off before its index".to_owned(),
                bytes => format!("the file was cut off, {bytes} bytes of an unfinished frame at its end"),
            });
        }
        if self.index {
            parts.push("the index is damaged; it was rebuilt from the frames".to_owned());
        }
        if self.start {
            parts.push("the start of the file is damaged; it was read from a redundant copy".to_owned());
        }
        if self.run {
            parts.push(
                "the metadata of the run is lost; it was reconstructed from the frames, and its units are unknown"
                    .to_owned(),
            );
        }
        if !self.meshes.is_empty() {
            parts.push(format!("shown as points, without a mesh: {}", names(&self.meshes)));
        }
        if !self.objects.is_empty() {
            parts.push(format!("lost: {}", names(&self.objects)));
        }
        if !self.records.is_empty() {
            let contents: Vec<_> = self.records.iter().map(|record| metadata::content_of(record)).collect();
            parts.push(format!("damaged and left out: {}", contents.join(", ")));
        }
        if !self.frames.is_empty() {
            parts.push(format!("missing or damaged: {}", frame_ranges(&self.frames)));
        }
        if !self.checkpoints.is_empty() {
            parts.push(format!("damaged: the checkpoint of {}", frame_ranges(&self.checkpoints)));
        }
        if self.copies > 0 {
            parts.push(format!("damaged, without loss: {} of the redundant copies", self.copies));
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
pub fn frame_ranges(frames: &[i32]) -> String {
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
    fn a_corruption_report_names_its_frames() {
        let corruption =
            CorruptionReport { truncated: true, frames: vec![3, 7, 8, 9], ..CorruptionReport::default() };
        let text = "the file was cut off before its index; missing or damaged: frames 3, 7 to 9";
        assert_eq!(corruption.to_string(), text);
    }

    #[test]
    fn one_frame_is_not_plural() {
        let corruption = CorruptionReport { frames: vec![-4], ..CorruptionReport::default() };
        assert_eq!(corruption.to_string(), "missing or damaged: frame -4");
    }
}
