//! What all kinds of boxes share: ids, pairs, filters, options of queries.

use std::ffi::{c_char, c_void};

use sweep_and_prune::{Filter, ProxyId};

use crate::failure::{Failure, sap_status};
use crate::memory::{array, optional};

/// The id of a body in a world. Ids of removed bodies are not given out again. A 64-bit number, which is never 0: its lower
/// half is a slot (a small number that is reused after its body was removed, so an index for tables of your own), its upper
/// half how many bodies have had this slot.
pub type sap_id = u64;

/// Not the id of any body.
pub const SAP_NO_ID: sap_id = 0;

/// Two boxes that overlap: the smaller index first, or an index of the first set and an index of the second.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sap_pair {
    /// The index of a box.
    pub a: u32,
    /// The index of the other box.
    pub b: u32,
}

/// Two bodies that overlap: the id with the smaller slot first.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sap_id_pair {
    /// The id of a body.
    pub a: sap_id,
    /// The id of the other body.
    pub b: sap_id,
}

/// Which bodies may pair. Two bodies pair if their boxes overlap, not both are static, and: they have the same group, which is
/// greater than 0; or they do not have the same group (or both have 0), and the category of each has a bit in the mask of
/// the other. So a negative group keeps its bodies apart, and a positive one joins them.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sap_filter {
    /// What the body is: bits. 1 by default.
    pub category: u32,
    /// What it pairs with: the categories of others. All bits by default.
    pub mask: u32,
    /// The group. 0, which is no group, by default.
    pub group: i32,
    /// Whether it is static: two static bodies never pair. False by default.
    pub is_static: bool,
}

/// What an update found: pairs that began and pairs that ended since the update before, each once, sorted by slot. The arrays
/// belong to the world, and are valid until the next update, the next restore, or the end of the world.
#[repr(C)]
pub struct sap_changes {
    /// The pairs that overlap now and did not before. NULL if there are none.
    pub begun: *const sap_id_pair,
    /// How many pairs began.
    pub begun_count: usize,
    /// The pairs that overlapped before and do not now, or of which a body was removed. NULL if there are none.
    pub ended: *const sap_id_pair,
    /// How many pairs ended.
    pub ended_count: usize,
}

/// Which bodies a query finds, and in which order. Functions take a pointer to one; NULL, as well as all zeros, means: every
/// body, sorted.
#[repr(C)]
pub struct sap_query {
    /// If not NULL, the query finds the bodies that may pair with a body that has this filter.
    pub filter: *const sap_filter,
    /// The ids of bodies that it does not find. May be NULL if there are none. Stale ids exclude nothing.
    pub excluded: *const sap_id,
    /// How many ids these are. Each body that is found is compared with all of them.
    pub excluded_count: usize,
    /// Whether bodies in a region may be listed in any order, which takes less time: three quarters for 100 bodies, half for
    /// 10,000.
    pub unsorted: bool,
}

/// A body near a point.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sap_neighbor {
    /// The id of the body.
    pub id: sap_id,
    /// The square of the distance from the point to its box: 0 if the point is in the box.
    pub distance_squared: f64,
}

/// Receives pairs, 1 to 4096 in a call, and returns whether it wants more. It must return: it may neither throw nor jump out of
/// the call. The pairs are valid during the call. `context` is what was passed to the function that calls it.
pub type sap_pairs_callback = Option<
    unsafe extern "C" fn(context: *mut c_void, pairs: *const sap_pair, count: usize) -> bool,
>;

/// Receives a body and returns whether it wants more. It must return: it may neither throw nor jump out of the call. `context`
/// is what was passed to the function that calls it.
pub type sap_body_callback = Option<unsafe extern "C" fn(context: *mut c_void, id: sap_id) -> bool>;

/// The filter of a body if nothing else is said: category 1, all bits in the mask, no group, not static.
#[unsafe(no_mangle)]
pub extern "C" fn sap_filter_default() -> sap_filter {
    from_filter(Filter::default())
}

/// Whether two bodies with these filters may pair. NULL means the default filter.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sap_filter_allows(a: *const sap_filter, b: *const sap_filter) -> bool {
    // SAFETY: both are null or point to a filter.
    let (a, b) = unsafe { (filter_at(a), filter_at(b)) };
    a.ok().zip(b.ok()).is_some_and(|(a, b)| a.allows(&b))
}

/// The version of the library, as "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn sap_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// The name of a status, as "SAP_ERROR_STALE_ID"; "unknown status" for a number that is none.
#[unsafe(no_mangle)]
pub extern "C" fn sap_status_name(status: i32) -> *const c_char {
    macro_rules! name {
        ($($status:ident)*) => {
            match status {
                $(_ if status == sap_status::$status as i32 => {
                    concat!(stringify!($status), "\0")
                })*
                _ => "unknown status\0",
            }
        };
    }
    let name = name! {
        SAP_OK SAP_ERROR_INVALID_ARGUMENT SAP_ERROR_WRONG_HANDLE SAP_ERROR_BUSY SAP_ERROR_INVALID_BOX
        SAP_ERROR_STALE_ID SAP_ERROR_INVALID_OPTION SAP_ERROR_INVALID_OFFSET SAP_ERROR_INVALID_QUERY
        SAP_ERROR_INVALID_SNAPSHOT SAP_ERROR_TOO_MANY_BOXES SAP_ERROR_OUT_OF_MEMORY SAP_ERROR_THREADS
        SAP_ERROR_PANIC SAP_ERROR_POISONED SAP_ERROR_OTHER
    };
    name.as_ptr().cast()
}

/// The body that an id names, if it is one.
pub fn proxy(id: sap_id) -> ProxyId {
    ProxyId::from_bits(id)
}

/// An id is as large as a [`ProxyId`], but its halves may lie the other way round, so arrays of ids are copied.
pub fn proxies(ids: &[sap_id]) -> Vec<ProxyId> {
    ids.iter().map(|&id| proxy(id)).collect()
}

pub fn id_pair([a, b]: [ProxyId; 2]) -> sap_id_pair {
    sap_id_pair { a: a.to_bits(), b: b.to_bits() }
}

pub fn from_filter(filter: Filter) -> sap_filter {
    let Filter { category, mask, group, is_static, .. } = filter;
    sap_filter { category, mask, group, is_static }
}

/// A filter; null is the default.
///
/// # Safety `filter` is null or points to a filter.
pub unsafe fn filter_at(filter: *const sap_filter) -> Result<Filter, Failure> {
    // SAFETY: as promised above.
    let filter = unsafe { optional(filter, "filter")? };
    Ok(filter.map_or_else(Filter::default, |filter| {
        let sap_filter { category, mask, group, is_static } = *filter;
        Filter::default().category(category).mask(mask).group(group).is_static(is_static)
    }))
}

/// Which bodies a query finds.
#[derive(Default)]
pub struct Wanted {
    pub filter: Option<Filter>,
    pub excluded: Vec<ProxyId>,
    pub unsorted: bool,
}

/// What a query asks for; null is everything.
///
/// # Safety `query` is null or points to a query, whose pointers are null or point to what their types say.
pub unsafe fn wanted(query: *const sap_query) -> Result<Wanted, Failure> {
    // SAFETY: as promised above.
    let Some(query) = (unsafe { optional(query, "query")? }) else {
        return Ok(Wanted::default());
    };
    let has_filter = !query.filter.is_null();
    // SAFETY: as promised above.
    let filter = unsafe { filter_at(query.filter)? };
    // SAFETY: as promised above.
    let excluded = unsafe { array(query.excluded, query.excluded_count, "excluded")? };
    Ok(Wanted {
        filter: has_filter.then_some(filter),
        excluded: proxies(excluded),
        unsorted: query.unsorted,
    })
}
