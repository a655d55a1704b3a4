//! Values of command-line options: frame ranges, record selections, memory sizes, job counts; and options that were renamed.

use std::ffi::OsString;
use std::str::FromStr;

use anyhow::{Context, Result};
use clap::ColorChoice;
use nucleus_cache::Detail;
use nucleus_graph::compile::Program;
use nucleus_graph::memory::Memory;
use nucleus_graph::scene;

use crate::output::say;

/// The scalar that a run computes with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum Scalar {
    /// Single precision.
    #[default]
    F32,
    /// Double precision: slower, for references and for very many evaluations.
    F64,
}

impl std::fmt::Display for Scalar {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        })
    }
}

/// Frames of a run or an export: `48`, or `10..58`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameRange {
    /// This many frames from the first, which counts as one.
    Count(i32),
    /// From one frame to another, both included.
    Span(i32, i32),
    /// The same with all frames before it, from the first frame of the scene on.
    Reaching(i32, i32),
}

impl FrameRange {
    /// First and last frame, where the first frame of the scene or cache is `start`. `None` beyond `i32::MAX`.
    pub fn within(self, start: i32) -> Option<(i32, i32)> {
        match self {
            Self::Count(count) => Some((start, start.checked_add(count - 1)?)),
            Self::Span(first, last) => Some((first, last)),
            Self::Reaching(first, last) => Some((start.min(first), last)),
        }
    }

    /// The frames that lead to a range are included too.
    pub fn reached(self) -> Self {
        match self {
            Self::Span(first, last) => Self::Reaching(first, last),
            other => other,
        }
    }

    /// The first frame, where it is given.
    pub fn first(self) -> Option<i64> {
        match self {
            Self::Count(_) => None,
            Self::Span(first, _) | Self::Reaching(first, _) => Some(first.into()),
        }
    }
}

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let whole =
            |text: &str| text.trim().parse::<i32>().map_err(|_| format!("`{text}` is not a whole number"));
        match text.split_once("..") {
            None => match whole(text)? {
                count if count >= 1 => Ok(Self::Count(count)),
                count => Err(format!("{count} frames cannot be run; give at least 1")),
            },
            Some((first, last)) => match (whole(first)?, whole(last)?) {
                (first, last) if first <= last => Ok(Self::Span(first, last)),
                (first, last) => Err(format!("frame {last} comes before frame {first}")),
            },
        }
    }
}

/// The value of `--record`: the times that are recorded, and the channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Record {
    /// `None`: as the scene says.
    moments: Option<Moments>,
    /// `None`: the default channels.
    channels: Option<Channels>,
}

/// The times that are recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moments {
    Of(Detail),
    None,
}

/// Channels of cloth that are recorded in addition to positions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Channels {
    pub velocities: bool,
    pub contacts: bool,
    pub strain: bool,
}

impl Default for Channels {
    /// Contacts are small and cannot be derived from positions.
    fn default() -> Self {
        Self { velocities: false, contacts: true, strain: false }
    }
}

impl Record {
    /// The requested times, else those of the scene.
    pub fn moments(self, program: &Program) -> Moments {
        self.moments.unwrap_or(match program.record() {
            scene::Record::Frames => Moments::Of(Detail::Frames),
            scene::Record::Substeps => Moments::Of(Detail::Substeps),
            scene::Record::Every(n) => Moments::Of(Detail::Every(n)),
            scene::Record::None => Moments::None,
        })
    }

    /// The requested channels, else the default ones.
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
            _ if self.moments.is_some() => return Err(format!("`{word}` is one too many: {RECORD_HELP}")),
            _ => {
                self.moments = Some(moments(word).ok_or(RECORD_HELP)?);
                return Ok(());
            }
        }
        self.channels = Some(channels);
        Ok(())
    }
}

const RECORD_HELP: &str = "give one of frames, substeps, every:10 (every tenth frame and the last) or none, and any of the \
                           channels positions, velocities, contacts, strain, separated by commas";

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

/// A size of memory: `8G`, `500M`, `1.5TB`, or bytes. Units are powers of 1000.
pub fn memory_size(text: &str) -> Result<Memory> {
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = match text[digits.len()..].to_ascii_uppercase().trim_end_matches('B') {
        "" => 1.0,
        "K" => 1e3,
        "M" => 1e6,
        "G" => 1e9,
        "T" => 1e12,
        _ => 0.0,
    };
    let bytes = digits.trim().parse::<f64>().ok().map(|number| number * unit);
    let bytes = bytes.filter(|bytes| (1.0..1e18).contains(bytes));
    bytes.map(|bytes| Memory(bytes as u64)).context("write a size as `8G` or `500M`")
}

/// A finite number above zero.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() => Ok(x),
        _ => Err("give a number above zero".to_owned()),
    }
}

/// A finite number, zero or above.
pub fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x >= 0.0 && x.is_finite() => Ok(x),
        _ => Err("give a number, zero or above".to_owned()),
    }
}

/// The requested number of threads or jobs; one per core if none is requested.
pub fn thread_count(requested: Option<u16>) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    requested.map_or_else(cores, usize::from)
}

/// Options under their former names: subcommand, former name, present name.
const RENAMED: [[&str; 3]; 6] = [
    ["play", "--with", "--compare"],
    ["trade", "--fresh", "--rerun"],
    ["trade", "--mode", "--resistance-model"],
    ["trade", "--resistances", "--resistance-factors"],
    ["extremes", "--threads", "--jobs"],
    ["validate", "--threads", "--jobs"],
];

/// The arguments of the process with former option names replaced. Prints a note for each.
pub fn with_present_names(mut arguments: Vec<OsString>) -> Vec<OsString> {
    let Some(subcommand) = subcommand(&arguments) else { return arguments };
    let (before, after) = arguments.split_at_mut(subcommand + 1);
    for argument in after.iter_mut().take_while(|argument| *argument != "--") {
        let Some(text) = argument.to_str() else { continue };
        let (option, value) =
            text.split_once('=').map_or((text, None), |(option, value)| (option, Some(value)));
        let renamed = RENAMED.iter().find(|[of, former, _]| before[subcommand] == *of && option == *former);
        if let Some([of, former, present]) = renamed {
            say!("note: `{former}` of `nucleus {of}` is now `{present}`");
            *argument = value.map_or_else(|| present.into(), |value| format!("{present}={value}").into());
        }
    }
    arguments
}

/// The value of `--color`, before the other arguments are parsed: it also applies to their errors.
pub fn color(arguments: &[OsString]) -> ColorChoice {
    let value = |at: usize| match arguments[at].to_str()? {
        "--color" => arguments.get(at + 1)?.to_str(),
        text => text.strip_prefix("--color="),
    };
    let given = (1..arguments.len()).find_map(value);
    given.and_then(|text| text.parse().ok()).unwrap_or(ColorChoice::Auto)
}

/// The place of the subcommand: the first argument that is neither a global option nor the value of one.
fn subcommand(arguments: &[OsString]) -> Option<usize> {
    let takes_value = |at: usize| ["--memory", "--color"].iter().any(|option| arguments[at] == *option);
    let is_name = |at: &usize| !arguments[*at].to_string_lossy().starts_with('-') && !takes_value(at - 1);
    (1..arguments.len()).find(is_name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_begins_at_the_scene_and_counts_its_first_frame() {
        assert_eq!("48".parse::<FrameRange>().unwrap().within(1), Some((1, 48)));
        assert_eq!("1".parse::<FrameRange>().unwrap().within(-5), Some((-5, -5)));
        assert_eq!(FrameRange::Count(3).within(i32::MAX), None);
    }

    #[test]
    fn a_span_keeps_its_first_and_last_frame() {
        assert_eq!("-3..9".parse::<FrameRange>().unwrap().within(1), Some((-3, 9)));
        let reaching = |text: &str| text.parse::<FrameRange>().unwrap().reached().within(1);
        assert_eq!([reaching("30..40"), reaching("-3..9")], [Some((1, 40)), Some((-3, 9))]);
    }

    #[test]
    fn an_invalid_frame_range_is_refused_with_a_reason() {
        let refusal = |text: &str| text.parse::<FrameRange>().unwrap_err();
        assert_eq!(refusal("0"), "0 frames cannot be run; give at least 1");
        assert_eq!(refusal("9..3"), "frame 3 comes before frame 9");
        assert_eq!(refusal("1..x"), "`x` is not a whole number");
    }

    #[test]
    fn times_and_channels_are_selected_in_one_list() {
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

    #[test]
    fn memory_sizes_take_a_decimal_unit() {
        for (text, bytes) in
            [("8G", 8_000_000_000), ("1.5gb", 1_500_000_000), ("500M", 500_000_000), ("64", 64)]
        {
            assert_eq!(memory_size(text).unwrap(), Memory(bytes), "{text}");
        }
        for text in ["", "G", "-1G", "8X", "nan", "0", "1e30"] {
            assert!(memory_size(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_former_option_name_is_replaced_in_its_own_subcommand_only() {
        let replaced = |line: &str| {
            let arguments = with_present_names(line.split(' ').map(OsString::from).collect());
            arguments.join(" ".as_ref()).into_string().unwrap()
        };
        assert_eq!(replaced("nucleus play a.mcap --with b.mcap"), "nucleus play a.mcap --compare b.mcap");
        assert_eq!(
            replaced("nucleus --memory 8G trade a.ron --mode=both --fresh"),
            "nucleus --memory 8G trade a.ron --resistance-model=both --rerun"
        );
        assert_eq!(
            replaced("nucleus --color never play a --with b"),
            "nucleus --color never play a --compare b"
        );
        assert_eq!(replaced("nucleus run a.ron --threads 2"), "nucleus run a.ron --threads 2");
        assert_eq!(replaced("nucleus extremes --threads=2"), "nucleus extremes --jobs=2");
        assert_eq!(replaced("nucleus"), "nucleus");
    }
}
