//! The files of a wedge.
//!
//! ```text
//! plan.json            the runs
//! runs/0017.mcap       the cache of run 17; `.mcap.part` until it is complete
//! results/0017.json    how it ended; written when it has ended
//! logs/0017.txt        its messages
//! locks/0017           locked while it runs
//! pictures/0017.png    its last frame
//! wedge.html, wedge.csv
//! ```

use std::collections::HashSet;
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use nucleus_cache::atomic_file;

use crate::error::{WedgeError, at};
use crate::plan::{Plan, PlannedRun};
use crate::result::RunResult;

/// The folder of a wedge.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WedgeFolder {
    root: PathBuf,
}

/// The lock of a run; held until it is dropped or its process ends.
#[derive(Debug)]
pub struct RunLock {
    // A system without locks gives none.
    _file: File,
}

impl WedgeFolder {
    /// The wedge in this folder. A relative path is completed, so that it holds in any working folder.
    ///
    /// # Errors
    /// When the working folder cannot be determined.
    pub fn new(root: &Path) -> Result<Self, WedgeError> {
        let root = std::path::absolute(root).map_err(|source| at(root, source))?;
        Ok(Self { root })
    }

    /// Path of the folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Path of the plan.
    pub fn plan(&self) -> PathBuf {
        self.root.join("plan.json")
    }

    /// The plan.
    ///
    /// # Errors
    /// When there is none, or it cannot be read.
    pub fn read_plan(&self) -> Result<Plan, WedgeError> {
        self.check_plan()?;
        Plan::read(&self.plan())
    }

    /// Refuses a folder without a plan.
    ///
    /// # Errors
    /// When there is no plan.
    pub fn check_plan(&self) -> Result<(), WedgeError> {
        if self.plan().is_file() { Ok(()) } else { Err(WedgeError::NoPlan { path: self.root.clone() }) }
    }

    /// Creates the folder and writes its plan.
    ///
    /// # Errors
    /// When the folder holds a plan already, or cannot be written.
    pub fn create(&self, plan: &Plan) -> Result<(), WedgeError> {
        if self.plan().exists() {
            return Err(WedgeError::PlanExists { path: self.root.clone() });
        }
        for name in ["runs", "results", "logs", "locks"] {
            let path = self.root.join(name);
            fs::create_dir_all(&path).map_err(|source| at(&path, source))?;
        }
        plan.write(&self.plan()).map_err(|source| at(&self.plan(), source))
    }

    /// Path of the cache of a run.
    pub fn cache(&self, name: &str) -> PathBuf {
        self.root.join("runs").join(format!("{name}.mcap"))
    }

    /// Path of the log of a run.
    pub fn log(&self, name: &str) -> PathBuf {
        self.root.join("logs").join(format!("{name}.txt"))
    }

    /// Path of the picture of a run, and of its folder.
    pub fn picture(&self, name: &str) -> PathBuf {
        self.root.join("pictures").join(format!("{name}.png"))
    }

    /// Path of the page.
    pub fn page(&self) -> PathBuf {
        self.root.join("wedge.html")
    }

    /// Path of the table.
    pub fn table(&self) -> PathBuf {
        self.root.join("wedge.csv")
    }

    fn result_path(&self, name: &str) -> PathBuf {
        self.root.join("results").join(format!("{name}.json"))
    }

    /// The result of a run; `None` if it has not ended. A damaged file counts as none.
    ///
    /// # Errors
    /// When the file exists and cannot be read.
    pub fn result(&self, name: &str) -> Result<Option<RunResult>, WedgeError> {
        let path = self.result_path(name);
        match fs::read(&path) {
            Ok(bytes) => Ok(serde_json::from_slice(&bytes).ok()),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(source) => Err(at(&path, source)),
        }
    }

    /// Writes the result of a run atomically.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write_result(&self, name: &str, result: &RunResult) -> Result<(), WedgeError> {
        let path = self.result_path(name);
        let written = serde_json::to_vec(result).map_err(io::Error::from);
        written.and_then(|bytes| atomic_file::write(&path, &bytes)).map_err(|source| at(&path, source))
    }

    /// The results of all runs, in the order of the plan.
    ///
    /// # Errors
    /// When a result exists and cannot be read.
    pub fn results(&self, plan: &Plan) -> Result<Vec<Option<RunResult>>, WedgeError> {
        // One listing is cheaper than a failed look-up per run, most of all on a shared folder.
        let folder = self.root.join("results");
        let present: HashSet<OsString> = match fs::read_dir(&folder) {
            Ok(entries) => entries.flatten().map(|entry| entry.file_name()).collect(),
            Err(error) if error.kind() == io::ErrorKind::NotFound => HashSet::new(),
            Err(source) => return Err(at(&folder, source)),
        };
        let is_present = |name: &str| present.contains(&OsString::from(format!("{name}.json")));
        let result = |run: &PlannedRun| if is_present(&run.name) { self.result(&run.name) } else { Ok(None) };
        plan.runs.iter().map(result).collect()
    }

    /// The runs that do not have all their frames, in the order of the plan.
    ///
    /// # Errors
    /// As [`results`](Self::results).
    pub fn open_runs(&self, plan: &Plan) -> Result<Vec<u32>, WedgeError> {
        let results = self.results(plan)?;
        let is_open =
            |result: &Option<RunResult>| !result.as_ref().is_some_and(|result| result.outcome.is_final());
        let open = plan.runs.iter().zip(&results).filter(|(_, result)| is_open(result));
        Ok(open.map(|(run, _)| run.run).collect())
    }

    /// What is wrong with the cache of a finished run: it is missing, or has another size than its result says. `None` for
    /// runs that record nothing.
    pub fn cache_fault(&self, name: &str, result: &RunResult) -> Option<String> {
        let recorded = result.figure("bytes").as_u64().filter(|_| result.outcome.is_final())?;
        match fs::metadata(self.cache(name)) {
            Ok(file) if file.len() == recorded => None,
            Ok(file) => Some(format!("its cache has {} of {recorded} bytes", file.len())),
            Err(_) => Some("its cache is missing".to_owned()),
        }
    }

    /// Whether a run has left a cache that can be resumed: an unfinished one, or one of an interrupted run. A later process
    /// that failed or was killed while it resumed that one has left it as it was.
    ///
    /// # Errors
    /// When a result exists and cannot be read.
    pub fn can_resume(&self, name: &str) -> Result<bool, WedgeError> {
        let cache = self.cache(name);
        let part = nucleus_cache::part_path(&cache);
        if fs::metadata(part).is_ok_and(|found| found.len() > 0) {
            return Ok(true);
        }
        let is_finished = self.result(name)?.is_some_and(|result| result.outcome.is_final());
        Ok(!is_finished && cache.is_file())
    }

    /// Locks a run; `None` if another process is at it.
    ///
    /// # Errors
    /// When the lock file cannot be created.
    pub fn lock(&self, name: &str) -> Result<Option<RunLock>, WedgeError> {
        let path = self.root.join("locks").join(name);
        let file =
            File::options().create(true).append(true).open(&path).map_err(|source| at(&path, source))?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => Ok(None),
            // A file system without locks must not prevent runs; the cache of a run has a lock of its own.
            Ok(()) | Err(TryLockError::Error(_)) => Ok(Some(RunLock { _file: file })),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::PlanHeader;
    use crate::result::{RunOutcome, SolvedFrames};

    fn wedge() -> (tempfile::TempDir, WedgeFolder, Plan) {
        let folder = tempfile::tempdir().unwrap();
        let wedge = WedgeFolder::new(&folder.path().join("out")).unwrap();
        let run = |run: u32| PlannedRun {
            run,
            name: format!("{run:04}"),
            values: Vec::new(),
            seed: None,
            arguments: vec!["run".to_owned()],
        };
        let header = PlanHeader::new("a.ron".to_owned(), folder.path().to_owned(), Vec::new());
        let plan = Plan { header, runs: (0..4).map(run).collect() };
        wedge.create(&plan).unwrap();
        (folder, wedge, plan)
    }

    fn result(outcome: RunOutcome) -> RunResult {
        RunResult {
            outcome,
            error: None,
            seconds: 1.0,
            earlier: SolvedFrames::default(),
            at_once: 1,
            machine: String::new(),
            attempt: 0,
            report: None,
        }
    }

    #[test]
    fn runs_without_a_final_result_are_open() {
        let (_folder, wedge, plan) = wedge();
        wedge.write_result("0000", &result(RunOutcome::Success)).unwrap();
        wedge.write_result("0001", &result(RunOutcome::Killed)).unwrap();
        wedge.write_result("0003", &result(RunOutcome::Problem)).unwrap();
        assert_eq!(wedge.open_runs(&plan).unwrap(), [1, 2]);
        fs::write(wedge.result_path("0000"), b"{\"outcome\":").unwrap();
        assert_eq!(wedge.open_runs(&plan).unwrap(), [0, 1, 2], "a damaged result counts as none");
    }

    #[test]
    fn a_finished_run_is_asked_for_the_cache_that_it_recorded() {
        let (_folder, wedge, _) = wedge();
        let recorded = |bytes: serde_json::Value| RunResult {
            report: Some(serde_json::json!({ "summary": { "bytes": bytes } })),
            ..result(RunOutcome::Success)
        };
        let fault = |bytes: serde_json::Value| wedge.cache_fault("0000", &recorded(bytes));
        assert_eq!(fault(9.into()).unwrap(), "its cache is missing");
        assert_eq!(fault(serde_json::Value::Null), None, "it recorded nothing");
        fs::write(wedge.cache("0000"), b"12345").unwrap();
        assert_eq!(fault(9.into()).unwrap(), "its cache has 5 of 9 bytes");
        assert_eq!(fault(5.into()), None);
        let stopped = RunResult { outcome: RunOutcome::Interrupted, ..recorded(9.into()) };
        assert_eq!(wedge.cache_fault("0000", &stopped), None, "it is resumed");
    }

    #[test]
    fn the_cache_of_an_interrupted_run_can_be_resumed_until_the_run_is_finished() {
        let (_folder, wedge, _) = wedge();
        assert!(!wedge.can_resume("0000").unwrap());
        fs::write(wedge.cache("0000"), b"frames").unwrap();
        for outcome in [RunOutcome::Interrupted, RunOutcome::Failed, RunOutcome::Killed] {
            wedge.write_result("0000", &result(outcome)).unwrap();
            assert!(wedge.can_resume("0000").unwrap(), "{outcome:?}");
        }
        wedge.write_result("0000", &result(RunOutcome::Problem)).unwrap();
        assert!(!wedge.can_resume("0000").unwrap());
    }

    #[test]
    fn a_run_is_locked_by_one_process_at_a_time() {
        let (_folder, wedge, _) = wedge();
        let lock = wedge.lock("0000").unwrap();
        assert!(lock.is_some() && wedge.lock("0000").unwrap().is_none());
        drop(lock);
        assert!(wedge.lock("0000").unwrap().is_some());
    }

    #[test]
    fn a_folder_takes_one_plan() {
        let (_folder, wedge, plan) = wedge();
        let said = wedge.create(&plan).unwrap_err().to_string();
        assert!(said.contains("--continue"), "{said}");
        let other = WedgeFolder::new(&wedge.root().join("other")).unwrap();
        assert!(matches!(other.read_plan(), Err(WedgeError::NoPlan { .. })));
    }
}
