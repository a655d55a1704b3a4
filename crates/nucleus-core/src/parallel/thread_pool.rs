//! A thread pool: a parallel loop has a fixed number of tasks, and idle threads claim them one by one.
//!
//! The result of a task depends on neither the thread that runs it nor the time, so any number of threads gives the
//! same bits. A loop takes a few microseconds, which is too short to wake a sleeping thread. Workers therefore spin for
//! a while between loops, then yield their core, then sleep.
//!
//! A task that panics does not end the loop: the caller waits for all other tasks, which borrow from it, and then
//! resumes the panic.

#![allow(unsafe_code)]

use std::any::Any;
use std::cell::UnsafeCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;

use crate::parallel::disjoint::DisjointSlice;

/// The closure of a loop without its lifetime: see the safety notes where it is called.
type Work = *const (dyn Fn(usize) + Sync);

/// How often a worker polls for the next loop before it yields its core, and before it sleeps.
const SPINS_BEFORE_YIELD: u32 = 2_000;
const SPINS_BEFORE_SLEEP: u32 = 4_000;

/// Threads of a pool, at most; more take memory and run nothing.
const MAX_THREADS: usize = 1024;

/// Items per task of [`ThreadPool::least`].
const ITEMS_PER_TASK: usize = 512;

/// One word holds the number of the loop, its number of tasks and the next task, so that one exchange claims a task.
const TASK_BITS: u32 = 20;
const TASK_MASK: u64 = (1 << TASK_BITS) - 1;

struct Shared {
    /// loop << 40 | tasks << 20 | next task.
    ticket: AtomicU64,
    /// Tasks of this loop that are finished.
    finished: AtomicUsize,
    work: UnsafeCell<Option<Work>>,
    /// A loop is running.
    is_busy: AtomicBool,
    /// The payload of the first panic of a task.
    panic: Mutex<Option<Box<dyn Any + Send>>>,
    closing: AtomicBool,
    sleepers: Mutex<usize>,
    wake: Condvar,
}

// SAFETY: `work` is written only by the caller that holds `is_busy`, while no task is open (see
// `ThreadPool::parallel_for`), and read only by holders of a claimed, unfinished task; the claim's acquire orders the
// read after the write.
unsafe impl Sync for Shared {}
// SAFETY: the pointer in `work` is to a `Sync` closure that outlives the loop.
unsafe impl Send for Shared {}

/// Threads that run parallel loops together.
pub struct ThreadPool {
    shared: Arc<Shared>,
    workers: Vec<JoinHandle<()>>,
}

impl ThreadPool {
    /// A pool of `threads` in all, the caller's own among them; zero counts as one, and more than [`MAX_THREADS`] as so
    /// many.
    pub fn new(threads: usize) -> Self {
        let shared = Arc::new(Shared {
            ticket: AtomicU64::new(0),
            finished: AtomicUsize::new(0),
            work: UnsafeCell::new(None),
            is_busy: AtomicBool::new(false),
            panic: Mutex::new(None),
            closing: AtomicBool::new(false),
            sleepers: Mutex::new(0),
            wake: Condvar::new(),
        });
        let spawn = |_| {
            let shared = Arc::clone(&shared);
            std::thread::Builder::new().name("nucleus".into()).spawn(move || shared.serve())
        };
        // A machine that refuses a thread only makes the pool smaller; the result is the same.
        let workers = (1..threads.min(MAX_THREADS)).map_while(|k| spawn(k).ok()).collect();
        Self { shared, workers }
    }

    /// Runs `work(0)` to `work(tasks - 1)`, in any order and in parallel, and returns when all are done.
    ///
    /// # Panics
    /// With the payload of a task's panic: at once on the calling thread alone, and with more threads after all other tasks
    /// are done.
    pub fn parallel_for(&self, tasks: usize, work: impl Fn(usize) + Sync) {
        assert!((tasks as u64) < TASK_MASK, "a loop has at most a million tasks");
        // A task may start a nested loop, which runs on the task's thread.
        if self.workers.is_empty() || tasks <= 1 || self.shared.is_busy.swap(true, Ordering::Acquire) {
            return (0..tasks).for_each(work);
        }
        self.shared.open(tasks, &work);
        while self.shared.do_one_task() {}
        let mut spins = 0;
        while self.shared.finished.load(Ordering::Acquire) < tasks {
            pause(&mut spins);
        }
        let panic = self.shared.panic.lock().unwrap_or_else(PoisonError::into_inner).take();
        self.shared.is_busy.store(false, Ordering::Release);
        if let Some(panic) = panic {
            resume_unwind(panic);
        }
    }

    /// Calls `work` with the index of each item and the item, each in a task of its own.
    pub fn for_each_mut<T: Send>(&self, items: &mut [T], work: impl Fn(usize, &mut T) + Sync) {
        let (count, items) = (items.len(), DisjointSlice::new(items));
        self.parallel_for(count, |at| {
            // SAFETY: every index is run once, so no two tasks have the same item.
            let [item] = (unsafe { items.run(at as u32..at as u32 + 1) }) else { return };
            work(at, item);
        });
    }

    /// The least value of items that are given by their index, infinity without any.
    pub fn least(&self, count: usize, value: impl Fn(usize) -> f64 + Sync) -> f64 {
        let least = Mutex::new(f64::INFINITY);
        self.parallel_for(count.div_ceil(ITEMS_PER_TASK), |task| {
            let own = task * ITEMS_PER_TASK..count.min((task + 1) * ITEMS_PER_TASK);
            let own = own.map(&value).fold(f64::INFINITY, f64::min);
            let mut least = least.lock().unwrap_or_else(PoisonError::into_inner);
            *least = least.min(own);
        });
        least.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for ThreadPool {
    fn drop(&mut self) {
        self.shared.closing.store(true, Ordering::SeqCst);
        self.shared.wake_sleepers();
        for worker in self.workers.drain(..) {
            // A worker catches the panics of its tasks, and cannot panic itself.
            let _ = worker.join();
        }
    }
}

impl Shared {
    /// Opens the tasks of a loop; the caller holds `is_busy`.
    fn open(&self, tasks: usize, work: &(dyn Fn(usize) + Sync)) {
        // SAFETY: every task of the loop before is finished, so no thread reads `work` now; and
        // `ThreadPool::parallel_for` neither returns nor unwinds before every task of this loop is finished, so the
        // closure outlives all its readers.
        unsafe { *self.work.get() = Some(std::mem::transmute::<&(dyn Fn(usize) + Sync), Work>(work)) };
        self.finished.store(0, Ordering::Relaxed);
        let number = (self.ticket.load(Ordering::Relaxed) >> (2 * TASK_BITS)) + 1;
        let ticket = (number << (2 * TASK_BITS)) | ((tasks as u64) << TASK_BITS);
        self.ticket.store(ticket, Ordering::SeqCst);
        self.wake_sleepers();
    }

    /// Claims and runs the next open task, if there is one.
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
        // SAFETY: the claimed task is not finished, so its loop is still open and `work` points to its closure.
        let work = unsafe { (*self.work.get()).map(|work| &*work) };
        // The caller resumes the panic, so half-done work of the task is never used as a result.
        if let Some(work) = work
            && let Err(panic) = catch_unwind(AssertUnwindSafe(|| work(task)))
        {
            self.panic.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(panic);
        }
        self.finished.fetch_add(1, Ordering::Release);
        true
    }

    /// The loop of a worker thread: run open tasks, else spin, else sleep.
    fn serve(&self) {
        let mut spins = 0;
        while !self.closing.load(Ordering::Relaxed) {
            if self.do_one_task() {
                spins = 0;
            } else if spins < SPINS_BEFORE_SLEEP {
                pause(&mut spins);
            } else {
                self.sleep();
                spins = 0;
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
        // Checked under the lock that the waker takes, so that no loop is missed between check and sleep.
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

/// Waits a moment: spins at first, then yields the core.
fn pause(spins: &mut u32) {
    *spins += 1;
    if *spins < SPINS_BEFORE_YIELD {
        std::hint::spin_loop();
    } else {
        std::thread::yield_now();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_task_of_every_loop_runs_exactly_once() {
        for threads in [1, 2, 3, 8] {
            let pool = ThreadPool::new(threads);
            for tasks in [0, 1, 2, 7, 100] {
                for _ in 0..50 {
                    let done: Vec<AtomicUsize> = (0..tasks).map(|_| AtomicUsize::new(0)).collect();
                    pool.parallel_for(tasks, |task| {
                        done[task].fetch_add(1, Ordering::Relaxed);
                    });
                    assert!(done.iter().all(|count| count.load(Ordering::Relaxed) == 1));
                }
            }
        }
    }

    #[test]
    fn a_pool_has_no_more_threads_than_the_limit() {
        assert!(ThreadPool::new(usize::MAX).workers.len() < MAX_THREADS);
    }

    #[test]
    fn the_least_value_is_found_in_whichever_task_it_is() {
        let pool = ThreadPool::new(3);
        for items in [0, 1, ITEMS_PER_TASK, 3 * ITEMS_PER_TASK + 7] {
            for least in [0, items / 2, items.saturating_sub(1)] {
                let values: Vec<f64> = (0..items).map(|at| at.abs_diff(least) as f64 - 1.0).collect();
                let expected = if items == 0 { f64::INFINITY } else { -1.0 };
                assert_eq!(pool.least(values.len(), |at| values[at]), expected, "{least} of {items}");
            }
        }
    }

    #[test]
    fn a_pool_that_slept_wakes_for_the_next_loop() {
        let pool = ThreadPool::new(2);
        for _ in 0..3 {
            std::thread::sleep(std::time::Duration::from_millis(20));
            let count = AtomicUsize::new(0);
            pool.parallel_for(64, |_| {
                count.fetch_add(1, Ordering::Relaxed);
            });
            assert_eq!(count.load(Ordering::Relaxed), 64);
        }
    }

    /// Runs a loop of 64 tasks of which some panic, each with its number. The number of others that ran, and the loop's
    /// panic.
    fn panicking(pool: &ThreadPool, panics: fn(usize) -> bool) -> (usize, Option<usize>) {
        let ran = AtomicUsize::new(0);
        let run = || {
            pool.parallel_for(64, |task| {
                // Not `panic!`, which would print.
                if panics(task) {
                    resume_unwind(Box::new(task));
                }
                ran.fetch_add(1, Ordering::Relaxed);
            });
        };
        let panic = catch_unwind(AssertUnwindSafe(run)).err();
        (ran.into_inner(), panic.map(|panic| *panic.downcast().expect("the number of the task")))
    }

    #[test]
    fn a_panic_in_a_task_reaches_the_caller_and_the_pool_goes_on() {
        for threads in [1, 2, 4] {
            let pool = ThreadPool::new(threads);
            for _ in 0..50 {
                assert_eq!(panicking(&pool, |task| task == 63), (63, Some(63)), "{threads} threads");
                let (_, panic) = panicking(&pool, |_| true);
                assert!(panic.is_some(), "{threads} threads");
                assert_eq!(panicking(&pool, |_| false), (64, None), "{threads} threads");
            }
        }
    }

    #[test]
    fn a_panic_on_the_calling_thread_alone_ends_its_loop_and_the_pool_goes_on() {
        let pool = ThreadPool::new(1);
        assert_eq!(panicking(&pool, |task| task == 3), (3, Some(3)));
        assert_eq!(panicking(&pool, |_| false), (64, None));
    }

    #[test]
    fn a_loop_of_several_threads_that_panics_ends_after_all_its_other_tasks() {
        let pool = ThreadPool::new(4);
        for panics in [|task| task == 0, |task| task % 2 == 0] {
            for _ in 0..50 {
                let of_others = (0..64).filter(|&task| !panics(task)).count();
                assert_eq!(panicking(&pool, panics).0, of_others);
            }
        }
    }

    #[test]
    fn a_task_may_run_a_loop_of_its_own() {
        for threads in [1, 2, 4] {
            let (pool, count) = (ThreadPool::new(threads), AtomicUsize::new(0));
            pool.parallel_for(8, |_| {
                pool.parallel_for(8, |_| {
                    count.fetch_add(1, Ordering::Relaxed);
                });
            });
            assert_eq!(count.into_inner(), 64);
        }
    }
}
