//! The intervals that are measured on, and what is asked about them.

use anyhow::{Result, bail};
use sweep_and_prune_scenes::Random;

/// Intervals of integers, closed: first and last number.
pub type Set = Vec<[i32; 2]>;

/// One set or two, and what a library may be told of them.
pub struct Sets {
    pub first: Set,
    /// Smaller than the first; `None` if pairs within the first are wanted.
    pub second: Option<Set>,
    /// Whether each set is sorted by its starts.
    #[allow(dead_code, reason = "without the features no library makes use of it")]
    pub is_sorted: bool,
}

/// What is asked.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Question {
    Pairs,
    Count,
}

/// The draw that is as large as the pair 8-7 of the AIList data, at [`AILIST_READS`] intervals in the first set.
pub const AILIST: &str = "ailist-8-7";
/// The larger set of that pair. The smaller one has 1.2 million intervals, and there are 300 million pairs.
pub const AILIST_READS: usize = 9_900_000;

/// Every draw except the large one.
const DRAWS: [&str; 5] =
    ["two-sets-few", "two-sets-many", "two-sets-long", "one-set-few", "one-set-many"];

/// The draws, in random and in sorted order, with both questions.
pub fn names() -> Vec<String> {
    DRAWS.iter().flat_map(|draw| questions(draw)).collect()
}

/// A draw in random and in sorted order, with both questions.
fn questions(draw: &str) -> impl Iterator<Item = String> + use<'_> {
    let orders = ["random", "sorted"].into_iter();
    let both = orders.flat_map(|order| ["pairs", "counts"].map(|question| (order, question)));
    both.map(move |(order, question)| format!("{draw} {order} {question}"))
}

/// What a case's name says: a draw, an order and a question.
pub struct Named<'a> {
    draw: &'a str,
    is_sorted: bool,
    pub question: Question,
}

impl<'a> Named<'a> {
    /// The parts of a name.
    pub fn new(name: &'a str) -> Result<Self> {
        let parts: Vec<_> = name.split(' ').collect();
        let [draw, order @ ("random" | "sorted"), question @ ("pairs" | "counts")] = parts[..]
        else {
            bail!("'{name}' is not a draw, then 'random' or 'sorted', then 'pairs' or 'counts'");
        };
        if !DRAWS.contains(&draw) && draw != AILIST {
            bail!("there is no draw '{draw}' of intervals");
        }
        let question = if question == "pairs" { Question::Pairs } else { Question::Count };
        Ok(Self { draw, is_sorted: order == "sorted", question })
    }

    /// The sets with `n` intervals in the first one.
    pub fn sets(&self, n: usize, seed: u64) -> Sets {
        let mut random = Random::new(seed);
        let line = 100 * n;
        let reads = [50, 150];
        let mut set = |count, lengths, line| draw(&mut random, count, lengths, line);
        // The comments say how many pairs there are for each interval of the first set.
        let (mut first, mut second) = match self.draw {
            // 0.3
            "two-sets-few" => (set(n, reads, line), Some(set(n / 10, [100, 300], line))),
            // 30
            "two-sets-many" => (set(n, reads, line), Some(set(n / 10, [20_000, 40_000], line))),
            // 0.3, and 1 with one of the few long ones.
            "two-sets-long" => {
                let mut second = set(n / 10, [100, 300], line);
                let long = i32::try_from(20 * n).unwrap_or(i32::MAX).min(200_000);
                second.iter_mut().step_by(200).for_each(|[from, to]| *to = *from + long);
                (set(n, reads, line), Some(second))
            }
            // 0.5
            "one-set-few" => (set(n, [0, 100], line), None),
            // 20
            "one-set-many" => (set(n, [0, 4000], line), None),
            // 30. The lengths of the smaller set reach from 1,000 to 286,000, as many below as above their geometric mean.
            _ => {
                let line = 202 * n;
                let mut second = set(n * 12 / 99, [0, 0], line);
                for interval in &mut second {
                    interval[1] = interval[0] + (1000.0 * 286f64.powf(random.unit())) as i32;
                }
                (draw(&mut random, n, reads, line), Some(second))
            }
        };
        if self.is_sorted {
            first.sort_unstable();
            second.iter_mut().for_each(|set| set.sort_unstable());
        }
        Sets { first, second, is_sorted: self.is_sorted }
    }
}

/// Intervals that begin anywhere below `line`, with lengths within these limits.
fn draw(random: &mut Random, count: usize, [least, most]: [usize; 2], line: usize) -> Set {
    let interval = |_| {
        let from = random.below(line) as i32;
        [from, from + (least + random.below(most - least + 1)) as i32]
    };
    (0..count).map(interval).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_draws_have_as_many_pairs_as_their_comments_say() {
        let expected = [0.3, 30.0, 1.3, 0.5, 20.0, 30.0];
        for (draw, expected) in DRAWS.into_iter().chain([AILIST]).zip(expected) {
            let each = ["random", "sorted"].map(|order| {
                let name = format!("{draw} {order} counts");
                let Sets { first, second, .. } = Named::new(&name).unwrap().sets(10_000, 1);
                // Those that begin before an interval ends, without those that end before it begins.
                let others = second.as_ref().unwrap_or(&first);
                let [mut begins, mut ends] =
                    [0, 1].map(|end| others.iter().map(|other| other[end]).collect::<Vec<_>>());
                begins.sort_unstable();
                ends.sort_unstable();
                let meets = |&[from, to]: &[i32; 2]| {
                    begins.partition_point(|&it| it <= to) - ends.partition_point(|&it| it < from)
                };
                let found: usize = first.iter().map(meets).sum();
                let pairs = if second.is_some() { found } else { (found - first.len()) / 2 };
                pairs as f64 / first.len() as f64
            });
            assert_eq!(each[0], each[1], "{draw}: sorting changes the pairs");
            assert!((each[0] / expected - 1.0).abs() < 0.15, "{draw}: {each:?} for {expected}");
        }
    }

    #[test]
    fn a_name_that_means_nothing_is_refused() {
        for name in ["", "two-sets-few", "two-sets-few sorted", "two-sets random pairs"] {
            assert!(Named::new(name).is_err(), "{name}");
        }
    }
}
