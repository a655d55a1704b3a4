//! The machine that things are measured on.

use std::{fs, thread};

/// What is known of it, a line a fact.
pub fn describe() -> Vec<String> {
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let processors = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = field(&processors, "model name").unwrap_or("a processor that has no name here");
    let mut lines = vec![format!("Machine: {cores} cores, {name}, {}.", std::env::consts::ARCH)];
    if let Some(cache) = field(&processors, "cache size") {
        lines.push(format!("Last cache: {cache}."));
    }
    let load = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    if let Some(load) = load.split_whitespace().next() {
        lines.push(format!("Load when it began: {load}; more than 0 means that others were at work."));
    }
    lines
}

/// A field of the first processor.
fn field<'a>(processors: &'a str, name: &str) -> Option<&'a str> {
    let (_, value) =
        processors.lines().filter_map(|line| line.split_once(':')).find(|(key, _)| key.trim() == name)?;
    Some(value.trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_of_the_first_processor() {
        let text =
            "processor\t: 0\nmodel name\t: A: one\nflags\t\t: x\n\nprocessor\t: 1\nmodel name\t: Another\n";
        assert_eq!(field(text, "model name"), Some("A: one"));
        assert_eq!(field(text, "cache size"), None);
    }
}
