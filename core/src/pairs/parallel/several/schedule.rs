//! Which columns a thread sweeps in one job.

use alloc::vec::Vec;
use core::ops::Range;

/// Groups of columns for each thread: some take longer than others.
const GROUPS_PER_THREAD: usize = 16;

/// A range of columns, and how many records they have.
struct Group {
    columns: Range<usize>,
    records: usize,
}

/// The columns in groups of about equally many records.
pub struct Schedule {
    groups: Vec<Group>,
    /// Groups of one column each that hold more than half of a thread's share and will be planned again. All threads
    /// share the search of each, before the rest.
    pub huge: Vec<usize>,
    /// The other groups, the large ones first, so that none is left for the end.
    pub rest: Vec<usize>,
}

impl Schedule {
    /// A schedule of columns with these numbers of records. A column with more than `crowd` is planned again.
    pub fn new(records: impl Iterator<Item = usize> + Clone, threads: usize, crowd: usize) -> Self {
        let groups = groups(records, threads * GROUPS_PER_THREAD);
        let records = groups.iter().map(|group| group.records).sum::<usize>();
        let huge = crowd.max(records / (2 * threads));
        let is_huge =
            |&group: &usize| groups[group].columns.len() == 1 && groups[group].records > huge;
        let (huge, mut rest): (Vec<_>, Vec<_>) = (0..groups.len()).partition(is_huge);
        rest.sort_by_key(|&group| groups[group].records < 2 * (records / groups.len()));
        Self { groups, huge, rest }
    }

    /// How many groups there are.
    pub fn len(&self) -> usize {
        self.groups.len()
    }

    /// The columns of a group.
    pub fn columns(&self, group: usize) -> Range<usize> {
        self.groups[group].columns.clone()
    }
}

/// Groups neighboring columns so that each group has about `1 / count` of the records; a column with more stands
/// alone.
fn groups(records: impl Iterator<Item = usize> + Clone, count: usize) -> Vec<Group> {
    let share = records.clone().sum::<usize>() / count + 1;
    let mut groups: Vec<Group> = Vec::with_capacity(count + 1);
    for (column, records) in records.enumerate() {
        match groups.last_mut() {
            Some(group) if group.records.max(records) < share => {
                group.columns.end = column + 1;
                group.records += records;
            }
            _ => groups.push(Group { columns: column..column + 1, records }),
        }
    }
    groups
}
