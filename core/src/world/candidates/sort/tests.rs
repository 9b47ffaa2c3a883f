//! The sorts of the candidates of the broad phase.

use super::*;
use alloc::vec;

fn random_pairs() -> impl FnMut(usize, u64) -> Vec<[u32; 2]> {
    let mut state = 1u64;
    let mut random = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as u32
    };
    move |count, bound| {
        (0..count).map(|_| [0; 2].map(|_| (u64::from(random()) % bound) as u32)).collect()
    }
}

#[test]
fn any_list_is_sorted_as_the_standard_library_sorts_it() {
    let mut random = random_pairs();
    for bound in [1u64, 2, 5, 2048, 2049, 1 << 22, 1 << 32] {
        for count in [0, 1, RADIX_FROM - 1, RADIX_FROM, 1000] {
            let mut pairs = random(count, bound);
            let mut expected = pairs.clone();
            expected.sort();
            PairSorter::default().sort(&mut pairs, bound as usize);
            assert_eq!(pairs, expected);
        }
    }
}

#[test]
fn many_pairs_of_one_body_among_few_of_others_are_sorted() {
    let mut random = random_pairs();
    for (bound, of_each) in [(10_000, [16, 17, 40]), (3000, [300, 2, 1000])] {
        for (hub, count) in [0, 17, bound as u32 - 1].into_iter().zip(of_each) {
            let mut pairs = random(bound, bound as u64);
            pairs.extend(random(count, bound as u64).iter().map(|&[_, other]| [hub, other]));
            pairs.sort_by_key(|pair| pair[1] ^ 77);
            let mut expected = pairs.clone();
            expected.sort();
            PairSorter::default().sort(&mut pairs, bound);
            assert_eq!(pairs, expected);
        }
    }
}

/// With low bits that take no pass, one, two and three, and with parts that have most pairs or none.
#[test]
fn long_lists_are_sorted_part_by_part() {
    let mut random = random_pairs();
    let mut sorter = PairSorter::default();
    for (bound, crowd) in [(2, 0), (300, 7), (100_000, 99_999), (1 << 22, 5), (1 << 32, 1)] {
        for len in [SPLIT_FROM - 1, SPLIT_FROM, 2 * SPLIT_FROM + 1] {
            let mut pairs = random(len, bound);
            // A quarter of them in one place.
            pairs.iter_mut().step_by(4).for_each(|pair| pair[0] = crowd);
            let mut expected = pairs.clone();
            expected.sort_unstable();
            sorter.sort(&mut pairs, bound as usize);
            assert!(pairs == expected, "{len} pairs of numbers below {bound}");
        }
    }
}

#[test]
fn differences_are_what_only_one_list_has() {
    let mut random = random_pairs();
    let mut sorter = PairSorter::default();
    for (count, bound) in [(0, 9), (1, 2), (30, 7), (300, 20), (300, 1 << 32)] {
        for other in [0, 1, count] {
            let [before, now] = [count, other].map(|count| {
                let mut pairs = random(count, bound);
                pairs.sort();
                pairs.dedup();
                pairs
            });
            let (mut ended, mut begun) = (vec![[7, 8]], vec![[9, 9]]);
            sorter.differences(&before, &now, &mut ended, &mut begun);
            let alone = |a: &[[u32; 2]], b: &[[u32; 2]]| {
                a.iter().copied().filter(|pair| !b.contains(pair)).collect::<Vec<_>>()
            };
            assert_eq!(ended[1..], alone(&before, &now));
            assert_eq!(begun[1..], alone(&now, &before));
        }
    }
}
