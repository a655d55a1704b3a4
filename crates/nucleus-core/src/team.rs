//! The threads: a phase of work is a fixed number of tasks, done by whoever is free.
//!
//! What a task computes never depends on who does it or when, so any number of threads gives the same bits.
//! A phase is a few microseconds long, too short to wake a sleeping thread for; workers therefore watch for
//! the next one for a while before they sleep, and give the core away between looks.

#![allow(unsafe_code)]

use std::cell::UnsafeCell;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::thread::JoinHandle;

/// A phase's work, with the lifetime taken off: see the safety notes where it is called.
type Work = *const (dyn Fn(usize) + Sync);

/// How often a worker looks for the next phase before it offers its core to others, and before it sleeps.
const LOOKS_BEFORE_YIELD: u32 = 2_000;
const LOOKS_BEFORE_SLEEP: u32 = 4_000;

/// One word holds which phase it is, how many tasks it has and which is next, so that they are claimed together.
const TASK_BITS: u32 = 20;
const TASK_MASK: u64 = (1 << TASK_BITS) - 1;

struct Shared {
    /// phase << 40 | tasks << 20 | next task.
    ticket: AtomicU64,
    /// Tasks of this phase that are finished.
    finished: AtomicUsize,
    work: UnsafeCell<Option<Work>>,
    closing: AtomicBool,
    sleepers: Mutex<usize>,
    wake: Condvar,
}

// SAFETY: `work` is written only while no task of a phase is open (see `Team::phase`), and read only by
// holders of a claimed, unfinished task; the claim's acquire orders the read after the write.
unsafe impl Sync for Shared {}
// SAFETY: the pointer in `work` is to a `Sync` closure that outlives the phase.
unsafe impl Send for Shared {}

/// Threads that work through phases together.
pub struct Team {
    shared: Arc<Shared>,
    workers: Vec<JoinHandle<()>>,
}

impl Team {
    /// A team of `threads` in all, the caller's own among them; nought counts as one.
    pub fn new(threads: usize) -> Self {
        let shared = Arc::new(Shared {
            ticket: AtomicU64::new(0),
            finished: AtomicUsize::new(0),
            work: UnsafeCell::new(None),
            closing: AtomicBool::new(false),
            sleepers: Mutex::new(0),
            wake: Condvar::new(),
        });
        let spawn = |_| {
            let shared = Arc::clone(&shared);
            std::thread::Builder::new().name("nucleus".into()).spawn(move || shared.serve())
        };
        // A machine that refuses a thread only makes the team smaller; the result is the same.
        let workers = (1..threads).map_while(|k| spawn(k).ok()).collect();
        Self { shared, workers }
    }

    /// Does `work(0)` to `work(tasks - 1)`, in any order and side by side, and returns when all are done.
    pub fn phase(&self, tasks: usize, work: impl Fn(usize) + Sync) {
        if self.workers.is_empty() || tasks <= 1 {
            (0..tasks).for_each(work);
            return;
        }
        assert!((tasks as u64) < TASK_MASK, "a phase has at most a million tasks");
        let work: &(dyn Fn(usize) + Sync) = &work;
        // SAFETY: every task of the phase before is finished, so nobody reads `work` now; and this call does
        // not return before every task of this phase is finished, so the closure outlives all its readers.
        unsafe { *self.shared.work.get() = Some(std::mem::transmute::<&(dyn Fn(usize) + Sync), Work>(work)) };
        self.shared.finished.store(0, Ordering::Relaxed);
        let phase = (self.shared.ticket.load(Ordering::Relaxed) >> (2 * TASK_BITS)) + 1;
        let ticket = (phase << (2 * TASK_BITS)) | ((tasks as u64) << TASK_BITS);
        self.shared.ticket.store(ticket, Ordering::SeqCst);
        self.shared.wake_sleepers();
        while self.shared.do_one_task() {}
        let mut looks = 0;
        while self.shared.finished.load(Ordering::Acquire) < tasks {
            pause(&mut looks);
        }
    }
}

impl Drop for Team {
    fn drop(&mut self) {
        self.shared.closing.store(true, Ordering::SeqCst);
        self.shared.wake_sleepers();
        for worker in self.workers.drain(..) {
            // A worker can only have panicked inside a task, and then the phase has said so already.
            let _ = worker.join();
        }
    }
}

impl Shared {
    /// Claims the next open task, if there is one, and does it.
    fn do_one_task(&self) -> bool {
        let mut ticket = self.ticket.load(Ordering::Acquire);
        loop {
            let (tasks, next) = ((ticket >> TASK_BITS) & TASK_MASK, ticket & TASK_MASK);
            if next >= tasks {
                return false;
            }
            match self.ticket.compare_exchange_weak(ticket, ticket + 1, Ordering::AcqRel, Ordering::Acquire) {
                Ok(_) => break self.run(next as usize),
                Err(now) => ticket = now,
            }
        }
    }

    fn run(&self, task: usize) -> bool {
        // SAFETY: the claimed task is not finished, so its phase is still open and `work` points to its closure.
        unsafe {
            if let Some(work) = *self.work.get() {
                (*work)(task);
            }
        }
        self.finished.fetch_add(1, Ordering::Release);
        true
    }

    /// A worker's life: do what is open, watch, sleep.
    fn serve(&self) {
        let mut looks = 0;
        while !self.closing.load(Ordering::Relaxed) {
            if self.do_one_task() {
                looks = 0;
            } else if looks < LOOKS_BEFORE_SLEEP {
                pause(&mut looks);
            } else {
                self.sleep();
                looks = 0;
            }
        }
    }

    fn has_open_task(&self) -> bool {
        let ticket = self.ticket.load(Ordering::SeqCst);
        (ticket & TASK_MASK) < ((ticket >> TASK_BITS) & TASK_MASK)
    }

    fn sleep(&self) {
        let Ok(mut sleepers) = self.sleepers.lock() else { return };
        *sleepers += 1;
        // Looked at under the lock that the waker takes: no phase can slip by between look and sleep.
        while !self.has_open_task() && !self.closing.load(Ordering::SeqCst) {
            match self.wake.wait(sleepers) {
                Ok(guard) => sleepers = guard,
                Err(_) => return,
            }
        }
        *sleepers -= 1;
    }

    fn wake_sleepers(&self) {
        if let Ok(sleepers) = self.sleepers.lock()
            && *sleepers > 0
        {
            self.wake.notify_all();
        }
    }
}

/// Waits a moment: first on the spot, then by giving the core away.
fn pause(looks: &mut u32) {
    *looks += 1;
    if *looks < LOOKS_BEFORE_YIELD {
        std::hint::spin_loop();
    } else {
        std::thread::yield_now();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_task_of_every_phase_is_done_exactly_once() {
        for threads in [1, 2, 3, 8] {
            let team = Team::new(threads);
            for tasks in [0, 1, 2, 7, 100] {
                for _ in 0..50 {
                    let done: Vec<AtomicUsize> = (0..tasks).map(|_| AtomicUsize::new(0)).collect();
                    team.phase(tasks, |task| {
                        done[task].fetch_add(1, Ordering::Relaxed);
                    });
                    assert!(done.iter().all(|count| count.load(Ordering::Relaxed) == 1));
                }
            }
        }
    }

    #[test]
    fn a_team_that_slept_wakes_for_the_next_phase() {
        let team = Team::new(2);
        for _ in 0..3 {
            std::thread::sleep(std::time::Duration::from_millis(20));
            let count = AtomicUsize::new(0);
            team.phase(64, |_| {
                count.fetch_add(1, Ordering::Relaxed);
            });
            assert_eq!(count.load(Ordering::Relaxed), 64);
        }
    }
}
