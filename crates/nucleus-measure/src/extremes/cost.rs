//! Processor time of this thread: what other programs do to the machine does not count.

#[cfg(target_os = "linux")]
use std::time::Duration;
#[cfg(not(target_os = "linux"))]
use std::time::Instant;

/// Processor time that this thread has used so far; on systems that do not tell, time on the wall.
pub struct Clock {
    #[cfg(not(target_os = "linux"))]
    begin: Instant,
    #[cfg(target_os = "linux")]
    begin: Duration,
}

impl Clock {
    /// Begins now.
    pub fn start() -> Self {
        Self { begin: now() }
    }

    /// Seconds since then.
    pub fn seconds(&self) -> f64 {
        #[cfg(target_os = "linux")]
        return now().saturating_sub(self.begin).as_secs_f64();
        #[cfg(not(target_os = "linux"))]
        return self.begin.elapsed().as_secs_f64();
    }
}

#[cfg(target_os = "linux")]
fn now() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec as u32)
}

#[cfg(not(target_os = "linux"))]
fn now() -> Instant {
    Instant::now()
}
