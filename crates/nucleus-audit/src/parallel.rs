//! Parallel map over the parts of a list.

use std::thread;

/// Items below which a thread costs more than it saves.
const FEW: usize = 512;

/// Concatenates the results of `work` on consecutive parts of a list, in the order of the list, for any number of
/// cores.
pub fn parallel_chunks<T: Send>(items: &[u32], work: impl Fn(&[u32]) -> Vec<T> + Sync) -> Vec<T> {
    let cores = thread::available_parallelism().map_or(1, usize::from).min(items.len() / FEW);
    if cores < 2 {
        return work(items);
    }
    let mut parts = items.chunks(items.len().div_ceil(cores));
    let first = parts.next().unwrap_or_default();
    let work = &work;
    thread::scope(|scope| {
        let others: Vec<_> = parts.map(|part| scope.spawn(move || work(part))).collect();
        let mut all = work(first);
        for other in others {
            match other.join() {
                Ok(made) => all.extend(made),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        all
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_keep_the_order_of_the_list() {
        let items: Vec<u32> = (0..5000).rev().collect();
        assert_eq!(parallel_chunks(&items, <[u32]>::to_vec), items);
        assert_eq!(parallel_chunks(&[], <[u32]>::to_vec), []);
    }
}
