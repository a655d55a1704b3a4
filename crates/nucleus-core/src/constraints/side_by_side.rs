//! What sweeps over rows side by side have in common: the order of their groups, and the columns of their points.

#![allow(unsafe_code)]

use crate::math::{Lanes, Real, Row4};
use crate::parallel::disjoint::DisjointSlice;

/// Where the groups that are swept together begin.
#[inline(always)]
pub fn group_starts<R: Real, L: Lanes<R>>(groups: usize, backward: bool) -> impl Iterator<Item = usize> {
    debug_assert!(groups.is_multiple_of(L::GROUPS), "{groups} groups of rows");
    let count = groups / L::GROUPS;
    (0..count).map(move |k| L::GROUPS * if backward { count - 1 - k } else { k })
}

/// The columns x, y, z and inverse mass of the points that `group` gives for every group.
///
/// # Safety
/// The points are inside the column, and no other task of the loop writes them.
#[inline(always)]
pub unsafe fn load<R: Real, L: Lanes<R>>(
    points: DisjointSlice<'_, Row4<R>>,
    group: impl Fn(usize) -> [u32; 4],
) -> [L; 4] {
    // SAFETY: the caller's promise.
    let rows = |lane: usize| L::of_groups(|k| unsafe { points.get(group(k)[lane]) }.0);
    L::transpose([rows(0), rows(1), rows(2), rows(3)])
}

/// The columns x, y, z and inverse mass of `N` points of each row; `group` gives the points by their place in the row and by
/// group.
///
/// # Safety
/// The points are inside the column, and no other task of the loop writes them.
#[inline(always)]
pub unsafe fn load_each<R: Real, L: Lanes<R>, const N: usize>(
    points: DisjointSlice<'_, Row4<R>>,
    group: impl Fn(usize, usize) -> [u32; 4],
) -> [[L; 4]; N] {
    let mut columns = [[L::splat(R::ZERO); 4]; N];
    for (k, columns) in columns.iter_mut().enumerate() {
        // SAFETY: the caller's promise.
        *columns = unsafe { load(points, |at| group(k, at)) };
    }
    columns
}

/// Writes the columns x, y, z and inverse mass of the points that `group` gives for every group.
///
/// # Safety
/// The points are inside the column, and no other task of the loop reads or writes them.
#[inline(always)]
pub unsafe fn store<R: Real, L: Lanes<R>>(
    points: DisjointSlice<'_, Row4<R>>,
    group: impl Fn(usize) -> [u32; 4],
    columns: [L; 4],
) {
    for (lane, rows) in L::transpose(columns).into_iter().enumerate() {
        // SAFETY: the caller's promise.
        rows.for_groups(|k, row| unsafe { points.set(group(k)[lane], Row4(row)) });
    }
}

#[cfg(test)]
pub(super) mod tests {
    use crate::math::Row4;

    /// The bits of points.
    pub fn bits(points: &[Row4<f32>]) -> Vec<[u32; 4]> {
        points.iter().map(|point| point.0.map(f32::to_bits)).collect()
    }

    /// Whether a kernel moves points, and to the same bits in every width of lanes: four scalars, four lanes, two times
    /// four, and those of the machine.
    macro_rules! agrees_in_every_width {
        ($start:expr, $points:ident => $kernel:expr) => {{
            use crate::math::kernel::{self, Kernel};
            use crate::math::{Quad, Real, Two};
            let start: &[crate::math::Row4<f32>] = $start;
            let all = [0, 1, 2, 3].map(|width| {
                let mut moved = start.to_vec();
                let $points = crate::parallel::disjoint::DisjointSlice::new(&mut moved);
                let kernel = $kernel;
                // SAFETY: there is one task, and every machine has four lanes.
                #[allow(unsafe_code)]
                unsafe {
                    match width {
                        0 => kernel.run::<Quad<f32>>(),
                        1 => kernel.run::<<f32 as Real>::Lanes>(),
                        2 => kernel.run::<Two<<f32 as Real>::Lanes>>(),
                        _ => kernel::run(kernel),
                    }
                }
                crate::constraints::side_by_side::tests::bits(&moved)
            });
            all[0] != crate::constraints::side_by_side::tests::bits(start)
                && all.iter().all(|own| *own == all[0])
        }};
    }
    pub(crate) use agrees_in_every_width;
}
