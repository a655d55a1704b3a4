//! Parallel loops with the same bits on any number of threads: a loop is cut into fixed tasks, and no two tasks of one
//! loop write the same row.

pub mod disjoint;
pub mod thread_pool;
