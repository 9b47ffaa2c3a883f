//! The finder: from boxes on the device to pairs on the device.

use crate::buffers::{Buffers, Slot, check_limits, most_bytes};
use crate::device::{checked, is_lost, read};
use crate::error::Error;
use crate::input::{Boxes, check_buffer};
use crate::kernels::{Kernel, Kernels};
use crate::sort::{SortSpace, Swapped, scan, scan_levels, sort, table_len};
use crate::steps::{Bound, Steps};
use crate::summary::Summary;
use crate::tree::{level_params, levels, most_leaves};

/// Bounds of a box or node, in numbers.
const BOUNDS: u64 = 8;

/// The world is the last lane of the bounds.
const WORLD_LANE: u32 = 3;

/// Finds overlapping pairs of boxes on a GPU, in two or three dimensions, and keeps its buffers between calls.
///
/// Boxes are closed: touching boxes overlap. A pair is reported once, smaller index first. Every pair is found, however
/// crowded the boxes are. The pairs and their order are the same in every run and on every device; with
/// [`sorted`](Self::sorted) they are sorted.
///
/// ```no_run
/// use sweep_and_prune::Aabb;
/// use sweep_and_prune_gpu::{Boxes, PairFinder, open_device};
///
/// let (device, queue) = open_device()?;
/// let mut finder = PairFinder::<2>::new(&device, &queue)?;
/// let boxes = [
///     Aabb::new([0.0, 0.0], [1.0, 1.0]),
///     Aabb::new([1.0, 1.0], [2.0, 2.0]),
///     Aabb::new([5.0, 5.0], [6.0, 6.0]),
/// ];
/// let found = finder.find(&Boxes::upload(&device, &queue, &boxes)?)?;
/// assert_eq!(found.read()?, [[0, 1]]);
/// # Ok::<(), sweep_and_prune_gpu::Error>(())
/// ```
#[derive(Debug)]
pub struct PairFinder<const D: usize> {
    device: wgpu::Device,
    queue: wgpu::Queue,
    kernels: Kernels,
    buffers: Buffers,
    is_sorted: bool,
    group_size: u32,
    vertices: u32,
}

/// One search: the sizes and what all its kernels share.
#[derive(Debug)]
struct Search {
    count: u64,
    params: SearchParams,
    nodes: Bound,
    order: Bound,
    filters: Bound,
    tally: Bound,
    sums: [Bound; 4],
}

/// What the kernels of the search share.
#[derive(Clone, Copy, Debug)]
struct SearchParams {
    count: u32,
    two_sets: bool,
    first_set: u32,
    has_filters: bool,
    top: u32,
    levels: [u32; 16],
}

impl SearchParams {
    fn with_capacity(&self, capacity: u32) -> Vec<u32> {
        let mut numbers = vec![
            self.count,
            self.two_sets.into(),
            self.first_set,
            self.has_filters.into(),
            capacity,
            self.top,
            0,
            0,
        ];
        numbers.extend(self.levels);
        numbers
    }
}

impl<const D: usize> PairFinder<D> {
    /// The dimensions for which there are shaders.
    const IS_2D_OR_3D: () = assert!(D == 2 || D == 3, "boxes have 2 or 3 dimensions");

    /// Compiles the shaders for a device. Takes a fraction of a second: keep the finder.
    ///
    /// # Errors
    /// [`Error::Limit`] if the device was requested with less than WebGPU's default limits, [`Error::Device`] if it
    /// cannot compile the shaders.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, Error> {
        const { Self::IS_2D_OR_3D };
        check_limits(device)?;
        let kernels = checked(device, || Ok(Kernels::new(device)))?;
        if is_lost(device) {
            return Err(Error::DeviceLost);
        }
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            kernels,
            buffers: Buffers::default(),
            is_sorted: false,
            group_size: 64,
            vertices: 2,
        })
    }

    /// Whether pairs are sorted by their first index, then by their second. Off by default: it takes up to 16 more passes
    /// over the pairs, or over all for which a buffer of yours has space.
    #[must_use]
    pub fn sorted(mut self, is_sorted: bool) -> Self {
        self.is_sorted = is_sorted;
        self
    }

    /// The size of a workgroup of the indirect dispatch in the [`Summary`]: one thread for each pair. 64 by default; 0 counts
    /// as 1.
    #[must_use]
    pub fn dispatch_group_size(mut self, group_size: u32) -> Self {
        self.group_size = group_size.max(1);
        self
    }

    /// The number of vertices of the indirect draw in the [`Summary`], which draws one instance for each pair. 2 by default,
    /// for a line.
    #[must_use]
    pub fn draw_vertices(mut self, vertices: u32) -> Self {
        self.vertices = vertices;
        self
    }

    /// The most boxes that this device can search, of both sets together. About 3.6 million with WebGPU's default limits.
    pub fn most_boxes(&self) -> u64 {
        most_leaves(most_bytes(&self.device) / (4 * BOUNDS)).min(u64::from(u32::MAX) - 1)
    }

    /// The most pairs that a buffer of this device holds. About 16.7 million with WebGPU's default limits.
    pub fn most_pairs(&self) -> u64 {
        (most_bytes(&self.device) / 8).min(u64::from(u32::MAX) - 1)
    }

    /// Finds all pairs of one set and keeps them on the device, in a buffer of the finder that is as large as needed.
    ///
    /// Waits once for the device, to learn the number of pairs. Pairs are `[a, b]` with `a < b`.
    ///
    /// # Errors
    /// [`Error::TooManyPairs`] names the exact number if no buffer of this device holds the pairs. Invalid boxes are no
    /// error: see [`Summary::invalid`].
    pub fn find(&mut self, boxes: &Boxes<D>) -> Result<Found<'_, D>, Error> {
        self.find_all(&[boxes])
    }

    /// Finds all pairs of a box of one set and a box of another, as [`find`](Self::find) does. Pairs are
    /// `[index in first, index in second]`.
    ///
    /// # Errors
    /// Those of [`find`](Self::find).
    pub fn find_between(
        &mut self,
        first: &Boxes<D>,
        second: &Boxes<D>,
    ) -> Result<Found<'_, D>, Error> {
        self.find_all(&[first, second])
    }

    /// Finds all pairs of one set and writes them to a buffer of the caller, without waiting for the device.
    ///
    /// `pairs` needs the usage `STORAGE` and receives two `u32` for each pair, `a < b`. If it is too small, nothing is
    /// written past its end, and the summary still has the exact number of pairs. `summary` needs the usage `STORAGE` and
    /// [`Summary::BYTES`] bytes. [`read_summary`](Self::read_summary) reads it; or use it with an indirect dispatch or
    /// draw, and never wait.
    ///
    /// # Errors
    /// [`Error::TooManyBoxes`], [`Error::BufferTooSmall`] and [`Error::BufferUsage`]. That a device was lost shows when
    /// something is read.
    pub fn find_into(
        &mut self,
        boxes: &Boxes<D>,
        pairs: &wgpu::Buffer,
        summary: &wgpu::Buffer,
    ) -> Result<(), Error> {
        self.find_all_into(&[boxes], pairs, summary)
    }

    /// Finds all pairs between two sets and writes them to a buffer of the caller, as [`find_into`](Self::find_into) does.
    ///
    /// # Errors
    /// Those of [`find_into`](Self::find_into).
    pub fn find_between_into(
        &mut self,
        first: &Boxes<D>,
        second: &Boxes<D>,
        pairs: &wgpu::Buffer,
        summary: &wgpu::Buffer,
    ) -> Result<(), Error> {
        self.find_all_into(&[first, second], pairs, summary)
    }

    /// Reads a summary. Waits for the device. The buffer needs the usage `COPY_SRC`.
    ///
    /// # Errors
    /// [`Error::DeviceLost`], [`Error::BufferTooSmall`], [`Error::BufferUsage`].
    pub fn read_summary(&self, summary: &wgpu::Buffer) -> Result<Summary, Error> {
        check_buffer("summary", summary, Summary::BYTES, wgpu::BufferUsages::COPY_SRC)?;
        let numbers = self.read_numbers(summary, Summary::BYTES)?;
        Ok(Summary::from_numbers(&numbers))
    }

    /// Reads the pairs that a search wrote to a buffer. Waits for the device. The buffer needs the usage `COPY_SRC`.
    ///
    /// # Errors
    /// [`Error::DeviceLost`], [`Error::BufferTooSmall`], [`Error::BufferUsage`].
    pub fn read_pairs(
        &self,
        pairs: &wgpu::Buffer,
        summary: &Summary,
    ) -> Result<Vec<[u32; 2]>, Error> {
        let bytes = 8 * u64::from(summary.written);
        check_buffer("pairs", pairs, bytes, wgpu::BufferUsages::COPY_SRC)?;
        let numbers = self.read_numbers(pairs, bytes)?;
        Ok(bytemuck::cast_slice(&numbers).to_vec())
    }

    /// How many nodes and boxes each thread of a search tests. For tests of the work: it has no stable meaning.
    ///
    /// # Errors
    /// Those of [`find`](Self::find).
    #[doc(hidden)]
    pub fn count_tests(&mut self, sets: &[&Boxes<D>]) -> Result<Vec<u32>, Error> {
        self.count_each(sets, Kernel::CountTests)
    }

    fn find_all(&mut self, sets: &[&Boxes<D>]) -> Result<Found<'_, D>, Error> {
        let (search, summary) = self.submit(|finder, steps| {
            let search = finder.prepare(sets, steps)?;
            finder.count(&search, Kernel::CountPairs, steps);
            scan(steps, &search.tally, search.count + 1, &search.sums);
            let summary = finder.buffer(Slot::Summary, Summary::BYTES / 4);
            finder.summarize(&search, 0, &summary, steps);
            Ok((search, summary))
        })?;
        let counted = self.read_summary(summary.buffer())?;
        let found = counted.found;
        let most = self.most_pairs();
        if u64::from(found) > most {
            let counts = self.count_each(sets, Kernel::CountPairs)?;
            let count = counts.into_iter().map(u64::from).sum();
            return Err(Error::TooManyPairs { count, most });
        }
        let pairs = self.submit(|finder, steps| {
            let pairs = finder.buffer(Slot::Pairs, 2 * u64::from(found));
            finder.write(&search, found, &pairs, &summary, steps);
            Ok(pairs)
        })?;
        Ok(Found {
            summary: Summary { written: found, ..counted },
            pairs: pairs.buffer().clone(),
            summary_buffer: summary.buffer().clone(),
            finder: self,
        })
    }

    fn find_all_into(
        &mut self,
        sets: &[&Boxes<D>],
        pairs: &wgpu::Buffer,
        summary: &wgpu::Buffer,
    ) -> Result<(), Error> {
        check_buffer("pairs", pairs, 0, wgpu::BufferUsages::STORAGE)?;
        check_buffer("summary", summary, Summary::BYTES, wgpu::BufferUsages::STORAGE)?;
        let capacity = (pairs.size() / 8).min(self.most_pairs());
        self.submit(|finder, steps| {
            let search = finder.prepare(sets, steps)?;
            finder.count(&search, Kernel::CountPairs, steps);
            scan(steps, &search.tally, search.count + 1, &search.sums);
            let pairs = match capacity {
                0 => finder.buffer(Slot::Unused, 0),
                _ => Bound::new(pairs, 8 * capacity),
            };
            let summary = Bound::new(summary, Summary::BYTES);
            finder.write(&search, capacity as u32, &pairs, &summary, steps);
            Ok(())
        })
    }

    /// What a kernel counts for each box, in the order of the leaves.
    fn count_each(&mut self, sets: &[&Boxes<D>], kernel: Kernel) -> Result<Vec<u32>, Error> {
        let search = self.submit(|finder, steps| {
            let search = finder.prepare(sets, steps)?;
            finder.count(&search, kernel, steps);
            Ok(search)
        })?;
        self.read_numbers(search.tally.buffer(), 4 * search.count)
    }

    /// Adds the steps from boxes to the tree.
    fn prepare(&mut self, sets: &[&Boxes<D>], steps: &mut Steps) -> Result<Search, Error> {
        sets.iter().try_for_each(|set| set.check())?;
        let count = sets.iter().map(|set| u64::from(set.count)).sum();
        let most = self.most_boxes();
        if count > most {
            return Err(Error::TooManyBoxes { count, most });
        }
        let levels = levels(count);
        let nodes = levels.last().copied().unwrap_or(0);
        let has_filters = sets.iter().any(|set| set.filters.is_some());
        let has_worlds = sets.iter().any(|set| set.worlds.is_some());
        let params = SearchParams {
            count: count as u32,
            two_sets: sets.len() == 2,
            first_set: if sets.len() == 2 { sets[0].count } else { 0 },
            has_filters,
            top: levels.len() as u32 - 2,
            levels: level_params(&levels),
        };
        let rows = self.buffer(Slot::Rows, BOUNDS * count);
        let filters = self.buffer(Slot::Filters, if has_filters { 2 * count } else { 0 });
        let sums = self.sums(count);
        self.load(sets, &rows, &filters, has_filters, steps);
        let order = self.order(&rows, count, has_worlds, &sums, steps);
        let nodes = self.buffer(Slot::Nodes, BOUNDS * nodes);
        steps.for_each(Kernel::Leaves, count, &[count as u32], &[&rows, &order, &nodes]);
        for level in levels.windows(3) {
            let [first_child, first, end] = [level[0], level[1], level[2]];
            let params = [(end - first) as u32, first as u32, first_child as u32];
            steps.for_each(Kernel::Parents, end - first, &params, &[&nodes]);
        }
        let tally = self.buffer(Slot::Tally, count + 1);
        Ok(Search { count, params, nodes, order, filters, tally, sums })
    }

    /// Adds the steps that read the boxes, the worlds and the filters.
    fn load(
        &mut self,
        sets: &[&Boxes<D>],
        rows: &Bound,
        filters: &Bound,
        has_filters: bool,
        steps: &mut Steps,
    ) {
        let invalid = self.buffer(Slot::Invalid, 2);
        self.queue.write_buffer(invalid.buffer(), 0, bytemuck::cast_slice(&[0, u32::MAX]));
        let unused = self.buffer(Slot::Unused, 0);
        let mut first_row = 0;
        for (number, set) in (0..).zip(sets) {
            let count = u64::from(set.count);
            if count == 0 {
                continue;
            }
            let worlds = set.worlds.as_ref().map(|worlds| Bound::new(worlds, 4 * count));
            let boxes = Bound::new(&set.boxes, 8 * D as u64 * count);
            let params = [set.count, first_row, D as u32, number, worlds.is_some().into()];
            let buffers = [&boxes, worlds.as_ref().unwrap_or(&unused), rows, &invalid];
            steps.for_each(Kernel::Load, count, &params, &buffers);
            if has_filters {
                let given = set.filters.as_ref().map(|filters| Bound::new(filters, 8 * count));
                let params = [set.count, first_row, given.is_some().into()];
                let buffers = [given.as_ref().unwrap_or(&unused), filters];
                steps.for_each(Kernel::CopyFilters, count, &params, &buffers);
            }
            first_row += set.count;
        }
    }

    /// Adds the steps that put the boxes in the order of the leaves.
    fn order(
        &mut self,
        rows: &Bound,
        count: u64,
        has_worlds: bool,
        sums: &[Bound; 4],
        steps: &mut Steps,
    ) -> Bound {
        let space =
            SortSpace { table: self.buffer(Slot::Table, table_len(count)), sums: sums.clone() };
        let other_keys = self.buffer(Slot::OtherKeys, count);
        let unused = self.buffer(Slot::Unused, 0);
        let mut axes = Vec::new();
        for (axis, slot) in (0..).zip([Slot::SortedX, Slot::SortedY, Slot::SortedZ]) {
            if axis as usize >= D {
                axes.push(unused.clone());
                continue;
            }
            let keys = self.buffer(slot, count);
            steps.for_each(
                Kernel::Extract,
                count,
                &[count as u32, axis, 0],
                &[rows, &unused, &keys],
            );
            let mut keys = Swapped { now: keys, other: other_keys.clone() };
            sort(steps, &space, &mut keys, None, count, 32);
            axes.push(keys.now);
        }
        let high_keys = self.buffer(Slot::HighKeys, count);
        let mut keys = Swapped { now: self.buffer(Slot::Keys, count), other: other_keys };
        let mut order = Swapped {
            now: self.buffer(Slot::Order, count),
            other: self.buffer(Slot::OtherOrder, count),
        };
        steps.for_each(
            Kernel::Order,
            count,
            &[count as u32, D as u32],
            &[rows, &axes[0], &axes[1], &axes[2], &high_keys, &keys.now, &order.now],
        );
        sort(steps, &space, &mut keys, Some(&mut order), count, 32);
        let buffers = [&high_keys, &order.now, &keys.now];
        steps.for_each(Kernel::Gather, count, &[count as u32], &buffers);
        sort(steps, &space, &mut keys, Some(&mut order), count, 32);
        if has_worlds {
            steps.for_each(
                Kernel::Extract,
                count,
                &[count as u32, WORLD_LANE, 1],
                &[rows, &order.now, &keys.now],
            );
            sort(steps, &space, &mut keys, Some(&mut order), count, 32);
        }
        order.now
    }

    /// Adds the step that counts something for each box.
    fn count(&self, search: &Search, kernel: Kernel, steps: &mut Steps) {
        let buffers = [&search.nodes, &search.order, &search.filters, &search.tally];
        steps.for_each(kernel, search.count + 1, &search.params.with_capacity(0), &buffers);
    }

    /// Adds the steps that write pairs and summary, once it is counted where they belong.
    fn write(
        &mut self,
        search: &Search,
        capacity: u32,
        pairs: &Bound,
        summary: &Bound,
        steps: &mut Steps,
    ) {
        let params = search.params.with_capacity(capacity);
        let buffers = [&search.nodes, &search.order, &search.filters, &search.tally, pairs];
        steps.for_each(Kernel::WritePairs, search.count, &params, &buffers);
        self.summarize(search, capacity, summary, steps);
        if self.is_sorted {
            self.sort_pairs(search, capacity, pairs, summary, steps);
        }
    }

    fn summarize(&mut self, search: &Search, capacity: u32, summary: &Bound, steps: &mut Steps) {
        let invalid = self.buffer(Slot::Invalid, 2);
        let params = [search.count as u32, capacity, self.group_size, self.vertices];
        steps.add(Kernel::Summarize, &params, &[&search.tally, &invalid, summary], 1);
    }

    /// Adds the steps that sort the pairs: by the second index, then by the first.
    fn sort_pairs(
        &mut self,
        search: &Search,
        capacity: u32,
        pairs: &Bound,
        summary: &Bound,
        steps: &mut Steps,
    ) {
        let most = u64::from(capacity);
        let mut firsts = Swapped {
            now: self.buffer(Slot::Firsts, most),
            other: self.buffer(Slot::OtherFirsts, most),
        };
        let mut seconds = Swapped {
            now: self.buffer(Slot::Seconds, most),
            other: self.buffer(Slot::OtherSeconds, most),
        };
        let space =
            SortSpace { table: self.buffer(Slot::Table, table_len(most)), sums: self.sums(most) };
        let split = [summary, pairs, &firsts.now, &seconds.now];
        steps.for_each(Kernel::SplitPairs, most, &[capacity], &split);
        // Enough bits for each index and for one number above all, which stands where there is no pair.
        let bits = u64::BITS - search.count.leading_zeros();
        sort(steps, &space, &mut seconds, Some(&mut firsts), most, bits);
        sort(steps, &space, &mut firsts, Some(&mut seconds), most, bits);
        let merge = [summary, &firsts.now, &seconds.now, pairs];
        steps.for_each(Kernel::MergePairs, most, &[capacity], &merge);
    }

    /// Builds steps and hands them to the device. After an error the buffers are made again by the next call.
    fn submit<R>(
        &mut self,
        build: impl FnOnce(&mut Self, &mut Steps) -> Result<R, Error>,
    ) -> Result<R, Error> {
        let device = self.device.clone();
        let result = checked(&device, || {
            let mut steps = Steps::default();
            let result = build(self, &mut steps)?;
            let mut encoder =
                device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            steps.record(
                &device,
                &self.queue,
                &self.kernels,
                &mut self.buffers.params,
                &mut encoder,
            );
            self.queue.submit([encoder.finish()]);
            Ok(result)
        });
        if result.is_err() {
            self.buffers.clear();
        }
        result
    }

    fn buffer(&mut self, slot: Slot, numbers: u64) -> Bound {
        self.buffers.get(&self.device, slot, numbers)
    }

    /// The sums of a scan of up to `count + 1` numbers.
    fn sums(&mut self, count: u64) -> [Bound; 4] {
        let [a, b, c, d] = scan_levels(count + 1);
        [
            self.buffer(Slot::Sums0, a),
            self.buffer(Slot::Sums1, b),
            self.buffer(Slot::Sums2, c),
            self.buffer(Slot::Sums3, d),
        ]
    }

    fn read_numbers(&self, buffer: &wgpu::Buffer, bytes: u64) -> Result<Vec<u32>, Error> {
        checked(&self.device, || read(&self.device, &self.queue, buffer, bytes))
    }
}

/// The pairs of a search, in a buffer of the finder on the device.
#[derive(Debug)]
pub struct Found<'f, const D: usize> {
    finder: &'f PairFinder<D>,
    summary: Summary,
    pairs: wgpu::Buffer,
    summary_buffer: wgpu::Buffer,
}

impl<const D: usize> Found<'_, D> {
    /// The number of pairs.
    pub fn len(&self) -> usize {
        self.summary.found as usize
    }

    /// Whether there is no pair.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of pairs, and how many boxes are invalid.
    pub fn summary(&self) -> Summary {
        self.summary
    }

    /// The buffer that begins with the pairs, two `u32` each. The next search overwrites it. Its usages are `STORAGE`,
    /// `VERTEX` and `COPY_SRC`.
    pub fn pairs(&self) -> &wgpu::Buffer {
        &self.pairs
    }

    /// The buffer with the [`Summary`] and the arguments of an indirect dispatch and draw. The next search overwrites it.
    /// Its usages are `STORAGE`, `INDIRECT` and `COPY_SRC`.
    pub fn summary_buffer(&self) -> &wgpu::Buffer {
        &self.summary_buffer
    }

    /// Copies the pairs from the device. Waits for it.
    ///
    /// # Errors
    /// [`Error::DeviceLost`], [`Error::OutOfMemory`].
    pub fn read(&self) -> Result<Vec<[u32; 2]>, Error> {
        self.finder.read_pairs(&self.pairs, &self.summary)
    }
}
