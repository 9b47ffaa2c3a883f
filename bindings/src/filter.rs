//! A filter from the numbers in which it crosses to another language.

use sweep_and_prune::Filter;

/// The filter of these numbers.
pub fn filter(category: u32, mask: u32, group: i32, is_static: bool) -> Filter {
    Filter::default().category(category).mask(mask).group(group).is_static(is_static)
}
