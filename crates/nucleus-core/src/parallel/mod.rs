//! Parallel loops with the same bits on any number of threads: a loop has fixed tasks, and no two tasks of a loop write
//! the same row.
//!
//! | You want to know… | Read |
//! |---|---|
//! | how idle threads claim tasks | [`thread_pool`] |
//! | how tasks share a column | [`disjoint`] |

pub mod disjoint;
pub mod thread_pool;
