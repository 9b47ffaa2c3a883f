//! Which bodies may pair at all.

use crate::setters::setters;

/// Which bodies may pair: category and mask bits, a group, and static against dynamic.
///
/// Two bodies pair if their boxes overlap and
/// 1. at least one of them is not static;
/// 2. they are of the same group, other than 0, and it is positive; or they are not of the same
///    group (or of group 0), and each one's category has a bit in the other's mask.
///
/// So a shared negative group keeps bodies apart and a shared positive one joins them, whatever
/// their masks; these are box2d's rules. The default is category 1, all bits in the mask, no
/// group, dynamic.
///
/// Updates search neither among bodies whose filters forbid each other, such as bullets, nor for
/// bodies that can pair with no other.
///
/// ```
/// use sweep_and_prune::Filter;
///
/// let wall = Filter::default().is_static(true);
/// let ghost = Filter::default().category(2).mask(2);
/// assert!(wall.allows(&Filter::default()));
/// assert!(!wall.allows(&wall));
/// assert!(!wall.allows(&ghost));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Filter {
    /// What the body is: bits.
    pub category: u32,
    /// What it pairs with: the categories of others.
    pub mask: u32,
    /// 0, or a number that decides over category and mask between two of the same group.
    pub group: i32,
    /// Whether it is a static body: two of these never pair.
    pub is_static: bool,
    /// Whether the body may pair at all; see [`BroadPhase::set_enabled`](crate::BroadPhase::set_enabled). No filter that a
    /// user holds says that it may not.
    #[cfg_attr(feature = "serde", serde(skip, default = "enabled"))]
    pub(crate) is_enabled: bool,
}

impl Filter {
    /// Category 1, all bits in the mask, no group, static.
    pub const STATIC: Self = Self::of(1, true);

    /// All categories and all bits in the mask, no group, dynamic: it pairs with every body whose
    /// category and mask are not 0.
    pub const ALL: Self = Self::of(u32::MAX, false);

    setters! { category: u32, mask: u32, group: i32, is_static: bool }

    const fn of(category: u32, is_static: bool) -> Self {
        Self { category, mask: u32::MAX, group: 0, is_static, is_enabled: true }
    }

    /// Whether two bodies with these filters may pair. Symmetric.
    #[inline]
    pub const fn allows(&self, other: &Self) -> bool {
        if self.is_static && other.is_static || !self.is_enabled || !other.is_enabled {
            false
        } else if self.group == other.group && self.group != 0 {
            self.group > 0
        } else {
            self.category & other.mask != 0 && other.category & self.mask != 0
        }
    }

    /// Whether no filter at all allows a body with this one to pair.
    pub(crate) const fn allows_none(&self) -> bool {
        !self.is_enabled || self.group <= 0 && (self.category == 0 || self.mask == 0)
    }
}

impl Default for Filter {
    fn default() -> Self {
        Self::of(1, false)
    }
}

/// What a filter that was serialized says.
#[cfg(feature = "serde")]
const fn enabled() -> bool {
    true
}
