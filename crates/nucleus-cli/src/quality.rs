//! `--quality` and the store behind it: the setting that `nucleus trade` recommends for an error or a time.

use std::env;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use nucleus_cache::shell_word;
use nucleus_graph::scene::Scene;
use nucleus_measure::report;
use nucleus_measure::result_cache::ResultCache;
use nucleus_measure::trade::{Benchmark, Choice, Request, Setting, Trade, Wish};

/// An error as a share: `1%`, `0.5 %` or `0.01`.
pub fn error(text: &str) -> Result<f64, String> {
    let (number, scale) = match text.trim().strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    match number.trim().parse::<f64>() {
        // From 1 on the percent sign was most likely forgotten.
        Ok(x) if x >= 1.0 && x.is_finite() && scale == 1.0 => {
            Err(format!("{x} means {0} %: write `{x}%`, or `{0}%` if that is meant", 100.0 * x))
        }
        Ok(x) if x > 0.0 && x.is_finite() => Ok(x * scale),
        Ok(_) => Err("an error must be above 0".to_owned()),
        Err(_) => Err("write an error as `1%` or `0.01`".to_owned()),
    }
}

/// A time in milliseconds: `30ms`, `30` or `0.03s`.
pub fn time(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let (number, scale) = match (text.strip_suffix("ms"), text.strip_suffix('s')) {
        (Some(number), _) => (number, 1.0),
        (None, Some(number)) => (number, 1e3),
        (None, None) => (text, 1.0),
    };
    match number.trim().parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() => Ok(x * scale),
        Ok(_) => Err("a time must be above 0".to_owned()),
        Err(_) => Err("write a time as `30ms` or `0.03s`".to_owned()),
    }
}

/// The folder for results that are expensive to compute: `NUCLEUS_CACHE`, or the cache folder of the system.
/// It can be deleted at any time.
fn folder() -> PathBuf {
    let set = |name: &str| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    if let Some(folder) = set("NUCLEUS_CACHE") {
        return folder;
    }
    let system = if cfg!(windows) {
        set("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        set("HOME").map(|home| home.join("Library").join("Caches"))
    } else {
        set("XDG_CACHE_HOME").or_else(|| set("HOME").map(|home| home.join(".cache")))
    };
    system.map_or_else(|| PathBuf::from(".nucleus-cache"), |system| system.join("nucleus"))
}

/// The stored results of a scene.
pub fn store(subject: &Benchmark) -> ResultCache {
    ResultCache::new(&folder().join("trade"), &subject.name())
}

/// The scene at the cheapest stored setting with at most the error `wanted`, a description of it, and the setting.
pub fn scene_at(scene: &Scene, name: &str, wanted: f64) -> Result<(Scene, String, Setting)> {
    let subject = Benchmark::new(scene)?;
    let word = shell_word(Path::new(name));
    let trade = Trade::load(&store(&subject))?.with_context(|| {
        format!("there are no stored results for `{name}` and this solver: run `nucleus trade {word}` first")
    })?;
    let wish = Wish::Error(Request::every(wanted));
    let Choice::Found(point) = wish.choose(&trade) else {
        // Its sentences name the setting that is nearest and the quantities in which it misses the error.
        let reason = report::recommendation(&trade, &wish).trim_end().replace('\n', "; ");
        let error = report::percent(wanted).replace(' ', "");
        bail!("`{name}`: {reason}; `nucleus trade {word} --error {error} --thorough` looks for others")
    };
    let error = report::percent(point.error.unwrap_or_default());
    let description = format!(
        "{}: meets an error of {error}, about {} ms a frame on one core",
        point.setting,
        report::figure(point.ms)
    );
    Ok((subject.set(&point.setting), description, point.setting))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_percent_or_shares_and_times_milliseconds_or_seconds() {
        assert_eq!([error("1%"), error(" 0.5 % "), error("0.01")], [Ok(0.01), Ok(0.005), Ok(0.01)]);
        assert_eq!([time("30ms"), time("30"), time("0.5s")], [Ok(30.0), Ok(30.0), Ok(500.0)]);
        assert_eq!(error("2").unwrap_err(), "2 means 200 %: write `2%`, or `200%` if that is meant");
        assert!(error("1").unwrap_err().starts_with("1 means 100 %: write `1%`"));
        assert_eq!([error("0.99"), error("100%"), error("150%")], [Ok(0.99), Ok(1.0), Ok(1.5)]);
        for text in ["0%", "-1%", "nan", "inf", "much", ""] {
            assert!(error(text).is_err() && time(text).is_err(), "{text}");
        }
    }
}
