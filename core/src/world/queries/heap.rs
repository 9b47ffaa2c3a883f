//! A binary heap at the end of a list, the greatest item on top: a query needs no memory besides its result.

/// What a query finds and sorts.
pub trait Ranked {
    /// The bits of a number that is not negative, which order as the numbers do, and then the slot.
    fn rank(&self) -> (u64, u32);
}

/// Makes a heap of items of which all but the last are one.
pub fn rise<V: Ranked>(heap: &mut [V]) {
    let mut at = heap.len().saturating_sub(1);
    while at > 0 && heap[at].rank() > heap[(at - 1) / 2].rank() {
        heap.swap(at, (at - 1) / 2);
        at = (at - 1) / 2;
    }
}

/// Makes a heap of items of which all but the first are one.
pub fn sink<V: Ranked>(heap: &mut [V]) {
    let mut at = 0;
    loop {
        let mut below = 2 * at + 1;
        if below + 1 < heap.len() && heap[below + 1].rank() > heap[below].rank() {
            below += 1;
        }
        if below >= heap.len() || heap[below].rank() <= heap[at].rank() {
            return;
        }
        heap.swap(at, below);
        at = below;
    }
}

/// Sorts a heap, the smallest item first.
pub fn sort<V: Ranked>(heap: &mut [V]) {
    for end in (1..heap.len()).rev() {
        heap.swap(0, end);
        sink(&mut heap[..end]);
    }
}
