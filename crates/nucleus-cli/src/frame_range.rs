//! Frames given on the command line: `48`, or `10..58`.

use std::str::FromStr;

/// Which frames to run, instead of those of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameRange {
    /// So many from the scene's first, which counts as one.
    Count(i32),
    /// From one to another, both included.
    Span(i32, i32),
}

impl FrameRange {
    /// First and last frame of a run of a scene that starts at `start`; `None` past the largest number.
    pub fn within(self, start: i32) -> Option<(i32, i32)> {
        match self {
            Self::Count(count) => Some((start, start.checked_add(count - 1)?)),
            Self::Span(first, last) => Some((first, last)),
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
                count => Err(format!("{count} frames cannot be run")),
            },
            Some((first, last)) => match (whole(first)?, whole(last)?) {
                (first, last) if first <= last => Ok(Self::Span(first, last)),
                (first, last) => Err(format!("frame {last} comes before frame {first}")),
            },
        }
    }
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
    fn a_span_is_taken_as_it_is() {
        assert_eq!("-3..9".parse::<FrameRange>().unwrap().within(1), Some((-3, 9)));
    }

    #[test]
    fn nonsense_is_refused_with_a_reason() {
        let refusal = |text: &str| text.parse::<FrameRange>().unwrap_err();
        assert_eq!(refusal("0"), "0 frames cannot be run");
        assert_eq!(refusal("9..3"), "frame 3 comes before frame 9");
        assert_eq!(refusal("1..x"), "`x` is not a whole number");
    }
}
