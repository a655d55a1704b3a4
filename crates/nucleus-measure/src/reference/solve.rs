//! References: made on demand, kept by scene and solver.

use serde::{Deserialize, Serialize};

use super::horizon::Horizon;
use crate::store::{Store, StoreError};
use crate::trade::run::{Kept, Run, key};
use crate::trade::{Setting, Subject};
use crate::trajectory::Trajectory;

/// The figures of all references of a scene.
const LIST: &str = "references.jsonl";

/// A reference.
#[derive(Debug, Clone)]
pub struct Solved {
    /// Its figures.
    pub run: Run,
    /// Every frame, in metres.
    pub path: Trajectory,
    /// All objects at the end, in scene units.
    pub end: Vec<Vec<[f32; 3]>>,
}

/// The two references of a scene: step h, and step h/2.
#[derive(Debug, Clone)]
pub struct References {
    /// The coarser.
    pub coarse: Solved,
    /// The finer: what runs are held against.
    pub fine: Solved,
    /// How far the two go together.
    pub horizon: Horizon,
}

/// Positions of objects, as they are kept.
#[derive(Serialize, Deserialize)]
struct End(Vec<Vec<[f32; 3]>>);

impl References {
    /// From both.
    pub fn new(coarse: Solved, fine: Solved, size: f64) -> Self {
        let frames = coarse.path.frames().min(fine.path.frames());
        let (mut a, mut b) = (Vec::new(), Vec::new());
        let mut apart = Vec::with_capacity(frames);
        for frame in 0..frames {
            coarse.path.frame(frame, &mut a);
            fine.path.frame(frame, &mut b);
            apart.push(crate::metrics::distance::distance(&a, &b, size).rms);
        }
        Self { coarse, fine, horizon: Horizon::of(apart) }
    }
}

impl Solved {
    /// Of a run that has just ended.
    pub fn of(run: Run, kept: Kept) -> Self {
        Self { run, path: kept.path.unwrap_or_default(), end: kept.end }
    }

    /// Keeps it for the next time.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn keep(&self, store: &Store) -> Result<(), StoreError> {
        let key = self.run.key();
        store.write(&format!("{key}.path"), &self.path.to_bytes())?;
        keep_end(store, &key, &self.end)?;
        store.append(LIST, &self.run)
    }
}

/// A reference that was kept before, whole.
///
/// # Errors
/// When something is there and cannot be read.
pub fn find(store: &Store, subject: &Subject, setting: &Setting) -> Result<Option<Solved>, StoreError> {
    let key = key(setting, 64, subject.frames());
    let run = store.list::<Run>(LIST)?.into_iter().find(|run| run.key() == key);
    let path = store.read(&format!("{key}.path"))?.and_then(|bytes| Trajectory::from_bytes(&bytes));
    let end = find_end(store, &key)?;
    Ok(run.zip(path).zip(end).map(|((run, path), end)| Solved { run, path, end }))
}

/// Keeps all objects as they were at the end of a run.
///
/// # Errors
/// When they cannot be written.
pub(crate) fn keep_end(store: &Store, key: &str, end: &[Vec<[f32; 3]>]) -> Result<(), StoreError> {
    let bytes = serde_json::to_vec(&End(end.to_vec())).unwrap_or_default();
    store.write(&format!("{key}.end.json"), &bytes)
}

/// All objects as they were at the end of a run, if they were kept.
///
/// # Errors
/// When they are there and cannot be read.
pub(crate) fn find_end(store: &Store, key: &str) -> Result<Option<Vec<Vec<[f32; 3]>>>, StoreError> {
    let bytes = store.read(&format!("{key}.end.json"))?;
    Ok(bytes.and_then(|bytes| serde_json::from_slice::<End>(&bytes).ok()).map(|End(end)| end))
}
