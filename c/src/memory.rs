//! Memory of the C program: arrays that are read, places where results are written.

use crate::failure::Failure;

fn check<T>(pointer: *const T, name: &'static str) -> Result<(), Failure> {
    match pointer {
        _ if pointer.is_null() => Err(Failure::Argument { name, fault: "is NULL" }),
        _ if !pointer.is_aligned() => {
            Err(Failure::Argument { name, fault: "is not aligned for its type" })
        }
        _ => Ok(()),
    }
}

fn check_many<T>(pointer: *const T, count: usize, name: &'static str) -> Result<(), Failure> {
    check(pointer, name)?;
    if count > isize::MAX as usize / size_of::<T>() {
        return Err(Failure::Argument { name, fault: "has more items than memory can hold" });
    }
    Ok(())
}

/// The items of an array. It may be null if it has none.
///
/// # Safety `items` is null or points to `count` items, which nothing changes while the result is in use.
pub unsafe fn array<'a, T>(
    items: *const T,
    count: usize,
    name: &'static str,
) -> Result<&'a [T], Failure> {
    if count == 0 {
        return Ok(&[]);
    }
    check_many(items, count, name)?;
    // SAFETY: as promised above; it is not null, aligned, and not too long.
    Ok(unsafe { std::slice::from_raw_parts(items, count) })
}

/// One item.
///
/// # Safety `item` is null or points to an item, which nothing changes while the result is in use.
pub unsafe fn one<'a, T>(item: *const T, name: &'static str) -> Result<&'a T, Failure> {
    check(item, name)?;
    // SAFETY: as promised above; it is neither null nor misaligned.
    Ok(unsafe { &*item })
}

/// One item, or none if it is null.
///
/// # Safety As [`one`].
pub unsafe fn optional<'a, T>(
    item: *const T,
    name: &'static str,
) -> Result<Option<&'a T>, Failure> {
    // SAFETY: as promised above.
    if item.is_null() { Ok(None) } else { unsafe { one(item, name) }.map(Some) }
}

/// A place for one result, which need not be initialized.
pub struct Place<T>(*mut T);

/// A place for a result.
///
/// # Safety `place` is null or points to memory for an item until the result is used.
pub unsafe fn place<T>(place: *mut T, name: &'static str) -> Result<Place<T>, Failure> {
    check(place, name)?;
    Ok(Place(place))
}

/// A place for a result that may not be needed.
///
/// # Safety As [`place`].
pub unsafe fn optional_place<T>(
    item: *mut T,
    name: &'static str,
) -> Result<Option<Place<T>>, Failure> {
    // SAFETY: as promised above.
    if item.is_null() { Ok(None) } else { unsafe { place(item, name) }.map(Some) }
}

impl<T> Place<T> {
    /// Writes the result. Never fails: calls end with it.
    pub fn set(self, value: T) -> Result<(), Failure> {
        // SAFETY: `place` was promised memory for an item.
        unsafe { self.0.write(value) };
        Ok(())
    }
}

/// A place for a list: it takes as many items as it has capacity for, and counts the rest.
pub struct List<T> {
    items: *mut T,
    capacity: usize,
    count: Option<Place<usize>>,
    found: usize,
}

/// A place for a list. `items` may be null if it has no capacity.
///
/// # Safety `items` is null or points to memory for `capacity` items, and `count` is null or points to memory for a number,
/// until the result is used. They do not overlap.
pub unsafe fn list<T>(
    items: *mut T,
    capacity: usize,
    count: *mut usize,
) -> Result<List<T>, Failure> {
    if capacity > 0 {
        check_many(items, capacity, "items")?;
    }
    // SAFETY: as promised above.
    let count = unsafe { place(count, "count")? };
    Ok(List { items, capacity, count: Some(count), found: 0 })
}

/// Memory for a known number of results that may not be needed.
///
/// # Safety `items` is null or points to memory for `capacity` items, until the result is used.
pub unsafe fn optional_places<T>(
    items: *mut T,
    capacity: usize,
    name: &'static str,
) -> Result<List<T>, Failure> {
    let capacity = if items.is_null() { 0 } else { capacity };
    if capacity > 0 {
        check_many(items, capacity, name)?;
    }
    Ok(List { items, capacity, count: None, found: 0 })
}

impl<T: Copy> List<T> {
    /// Adds an item.
    #[inline]
    pub fn push(&mut self, item: T) {
        if self.found < self.capacity {
            // SAFETY: there is memory for `capacity` items.
            unsafe { self.items.add(self.found).write(item) };
        }
        self.found += 1;
    }

    /// Adds items.
    pub fn extend(&mut self, items: &[T]) {
        let fit = items.len().min(self.capacity.saturating_sub(self.found));
        if fit > 0 {
            // SAFETY: there is memory for `capacity` items, so for `fit` after those found; C's memory is not that of the
            // library.
            unsafe { self.items.add(self.found).copy_from_nonoverlapping(items.as_ptr(), fit) };
        }
        self.found += items.len();
    }

    /// Writes how many items were found. Never fails: calls end with it.
    pub fn end(self) -> Result<(), Failure> {
        self.count.map_or(Ok(()), |count| count.set(self.found))
    }
}
