//! Parallel loops over the rows of a list: interior rows block by block, then interface rows colour by colour.

use crate::model::blocks::Blocks;
use crate::model::rows::{RowBatch, RowList};
use crate::parallel::thread_pool::ThreadPool;

/// Does `work` on all batches of a list once: interior rows, then interface rows.
pub fn for_all_rows<G: Sync>(
    pool: &ThreadPool,
    blocks: &Blocks,
    list: &RowList<G>,
    work: impl Fn(RowBatch) + Sync,
) {
    pool.parallel_for(blocks.len(), |block| work(RowBatch::Interior(block)));
    for_interface_rows(pool, list, false, work);
}

/// Does `work` on the interface rows of a list, colour by colour.
pub fn for_interface_rows<G: Sync>(
    pool: &ThreadPool,
    list: &RowList<G>,
    backward: bool,
    work: impl Fn(RowBatch) + Sync,
) {
    let count = list.interface_colours();
    for k in 0..count {
        let colour = if backward { count - 1 - k } else { k };
        pool.parallel_for(list.interface_tasks(colour), |task| work(RowBatch::Interface(colour, task)));
    }
}
