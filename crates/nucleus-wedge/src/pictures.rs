//! The contact sheet: the last frame of each run, seen by one camera.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use nucleus_cache::Playback;
use nucleus_cache::atomic_file;
use nucleus_view::{Bounds, Camera, Film, Style};

use crate::error::{WedgeError, at};
use crate::folder::WedgeFolder;

/// Width and height of a picture in pixels.
pub const SIZE: [u32; 2] = [320, 240];

/// Draws the last frame of each cache. All pictures have one camera, so that they can be compared: the first camera of the
/// scene, else one that frames all runs. Returns the names whose picture could not be drawn, with the reasons.
pub fn draw(
    folder: &WedgeFolder,
    names: &[&str],
    threads: usize,
) -> Result<Vec<(String, String)>, WedgeError> {
    let root = folder.root().join("pictures");
    std::fs::create_dir_all(&root).map_err(|source| at(&root, source))?;
    let bounds = parallel(names, threads, |name| bounds(&folder.cache(name)));
    let mut all = Bounds::default();
    bounds.iter().flatten().for_each(|one| all.merge(one));
    let camera = Camera::framing(&all, SIZE);
    let drawn = parallel(names, threads, |name| picture(&folder.cache(name), &folder.picture(name), camera));
    let failed = names.iter().zip(drawn).filter_map(|(name, drawn)| Some(((*name).to_owned(), drawn.err()?)));
    Ok(failed.collect())
}

/// The box around the last frame of a cache.
fn bounds(cache: &Path) -> Result<Bounds, String> {
    let mut cache = Playback::open(cache).map_err(|error| error.to_string())?;
    let last = cache.time_samples().len().saturating_sub(1);
    film(&mut cache)?.bounds(last).map_err(|error| error.to_string())
}

fn picture(cache: &Path, out: &Path, camera: Camera) -> Result<(), String> {
    let mut cache = Playback::open(cache).map_err(|error| error.to_string())?;
    let (last, own) = (cache.time_samples().len().saturating_sub(1), cache.run().cameras.first().cloned());
    let film = film(&mut cache)?.seen_by(camera);
    let mut film = match own {
        Some(own) => film.seen_through(own),
        None => film,
    };
    let png = film.moment(last).and_then(|image| image.to_png()).map_err(|error| error.to_string())?;
    atomic_file::write(out, &png).map_err(|error| error.to_string())
}

/// The film of the first and the last frame, whose floor lies below both.
fn film(cache: &mut Playback) -> Result<Film<'_, BufReader<File>>, String> {
    let every = cache.time_samples().len().saturating_sub(1);
    Film::of(cache, every, Style { size: SIZE, ..Style::default() }).map_err(|error| error.to_string())
}

/// Maps names in parallel, in their order.
fn parallel<T: Send>(names: &[&str], threads: usize, map: impl Fn(&str) -> T + Sync) -> Vec<T> {
    let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::with_capacity(names.len())));
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, names.len().max(1)) {
            scope.spawn(|| {
                while let Some((index, name)) = {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    names.get(index).map(|name| (index, name))
                } {
                    let result = map(name);
                    done.lock().unwrap_or_else(PoisonError::into_inner).push((index, result));
                }
            });
        }
    });
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}
