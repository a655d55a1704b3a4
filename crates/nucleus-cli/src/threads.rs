//! How many cores a command takes.

/// So many as are asked for; all if none are.
pub fn count(asked: Option<u16>) -> usize {
    let all = || std::thread::available_parallelism().map_or(1, usize::from);
    asked.map_or_else(all, usize::from)
}
