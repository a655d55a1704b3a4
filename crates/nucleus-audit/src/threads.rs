//! Work on the parts of a list side by side.

use std::thread;

/// Items below which a thread costs more than it saves.
const FEW: usize = 512;

/// What `work` makes of each part of a list, one after the other. In the order of the list, on however many cores.
pub fn in_chunks<T: Send>(items: &[u32], work: impl Fn(&[u32]) -> Vec<T> + Sync) -> Vec<T> {
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
        assert_eq!(in_chunks(&items, <[u32]>::to_vec), items);
        assert_eq!(in_chunks(&[], <[u32]>::to_vec), []);
    }
}
