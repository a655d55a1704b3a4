//! What `--record` asks for: which moments of a run, and what of them.

use std::str::FromStr;

use nucleus_cache::Detail;
use nucleus_graph::compile::Program;
use nucleus_graph::scene;

/// What is recorded of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Record {
    /// The moments; as the scene wants it if that is not said.
    moments: Option<Moments>,
    /// What is recorded of them; as is usual if that is not said.
    channels: Option<Channels>,
}

/// The moments that are recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moments {
    /// So many.
    Of(Detail),
    /// None.
    None,
}

/// What is recorded of cloth besides positions, which always are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Channels {
    pub velocities: bool,
    pub contacts: bool,
    pub strain: bool,
}

impl Default for Channels {
    /// What cannot be found again from positions, and is small.
    fn default() -> Self {
        Self { velocities: false, contacts: true, strain: false }
    }
}

impl Record {
    /// The moments asked for, or else those that the scene wants.
    pub fn moments(self, program: &Program) -> Moments {
        self.moments.unwrap_or(match program.record() {
            scene::Record::Frames => Moments::Of(Detail::Frames),
            scene::Record::Substeps => Moments::Of(Detail::Substeps),
            scene::Record::Every(n) => Moments::Of(Detail::Every(n)),
            scene::Record::None => Moments::None,
        })
    }

    /// What is recorded of them.
    pub fn channels(self) -> Channels {
        self.channels.unwrap_or_default()
    }

    fn add(&mut self, word: &str) -> Result<(), String> {
        let mut channels =
            self.channels.unwrap_or(Channels { velocities: false, contacts: false, strain: false });
        match word {
            "positions" => {}
            "velocities" => channels.velocities = true,
            "contacts" => channels.contacts = true,
            "strain" => channels.strain = true,
            _ if self.moments.is_some() => return Err(format!("`{word}` is one too many: {HELP}")),
            _ => {
                self.moments = Some(moments(word).ok_or(HELP)?);
                return Ok(());
            }
        }
        self.channels = Some(channels);
        Ok(())
    }
}

const HELP: &str = "write frames, substeps, every:10 (each tenth frame and the last) or none, and, with commas between \
                    them, what of it: positions, velocities, contacts, strain";

impl FromStr for Record {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut record = Self::default();
        text.split(',').map(str::trim).try_for_each(|word| record.add(word))?;
        Ok(record)
    }
}

fn moments(word: &str) -> Option<Moments> {
    match word {
        "frames" => Some(Moments::Of(Detail::Frames)),
        "substeps" => Some(Moments::Of(Detail::Substeps)),
        "none" => Some(Moments::None),
        _ => {
            let n = word.strip_prefix("every:")?.trim().parse().ok().filter(|&n| n > 0)?;
            Some(Moments::Of(Detail::Every(n)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_and_channels_are_chosen_in_one_list() {
        let record = |text: &str| text.parse::<Record>();
        assert_eq!(record("substeps").unwrap().channels(), Channels::default());
        let chosen = record("every:4, strain,positions").unwrap();
        assert_eq!(chosen.moments, Some(Moments::Of(Detail::Every(4))));
        assert_eq!(chosen.channels(), Channels { velocities: false, contacts: false, strain: true });
        let two = record("velocities,contacts").unwrap();
        assert_eq!((two.moments, two.channels().velocities, two.channels().contacts), (None, true, true));
        for wrong in ["", "all", "frames,substeps", "every:0", "frames,", "frames,colour"] {
            assert!(record(wrong).is_err(), "{wrong}");
        }
    }
}
