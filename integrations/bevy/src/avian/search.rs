//! The search for pairs in each step.

use std::collections::HashSet;

use bevy::ecs::entity::Entity;
use bevy::ecs::resource::Resource;

use super::avian::collider_tree::{ColliderTrees, MovedProxies};
use super::avian::data_structures::pair_key::PairKey;
use super::avian::prelude::ContactGraph;
use super::joint_graph::JointGraph;
use super::rule::{Rule, Verdict, key};
use super::tracked::{Colliders, Tracked};

/// Two colliders that may become a contact pair, by the slots of their bodies: the first one of the contact first.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    pub first: u32,
    pub second: u32,
    /// Whether the user's hook has to be asked.
    pub asks_hook: bool,
}

/// The state of the broad phase: the boxes of all colliders, and the overlapping pairs that are not contact pairs.
///
/// It keeps itself up to date with Avian's [`ColliderTrees`] and [`ContactGraph`]. If you replace one of these two, as
/// a rollback may do, replace this resource by its clone of the same moment, or call
/// [`read_all_again`](Self::read_all_again).
#[derive(Resource, Clone, Debug, Default)]
pub struct PairSearch {
    colliders: Colliders,
    /// Pairs of slots whose boxes overlap and that are not in the graph of contacts, except colliders of one body:
    /// sorted.
    waiting: Vec<[u32; 2]>,
    /// The pairs that this step may add.
    candidates: Vec<Candidate>,
    /// Colliders whose filters may have changed, or that may be gone.
    touched: Vec<Entity>,
    /// Whether colliders may have changed that Avian does not list as moved.
    any_unlisted: bool,
    /// Whether the broad phase of this step has run and the step is not over: Avian forgets which colliders are
    /// added now.
    is_after_search: bool,
    /// How many contact pairs the graph had when the last step had added its own. `None` if that is not known.
    contacts_before: Option<usize>,
    /// The contact pairs that ended in the last step, when the graph still had them.
    leaving: Vec<PairKey>,
    step: u64,
    counts: Counts,
}

/// What the searches had to do since the start, for tests: work is counted, not timed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Counts {
    /// Steps that read all colliders of the trees.
    pub full_reads: u64,
    /// Steps that compared all overlapping pairs with the graph of contacts.
    pub comparisons: u64,
    /// Pairs that were examined.
    pub examined: u64,
}

impl PairSearch {
    /// A search that uses at most this many threads, or all.
    #[cfg(feature = "parallel")]
    pub(super) fn with_threads(threads: Option<usize>) -> Self {
        let mut search = Self::default();
        let world = std::mem::take(&mut search.colliders.world);
        search.colliders.world = match threads {
            Some(threads) => world.threads(threads),
            None => world.all_threads(),
        };
        search
    }

    /// How many colliders have a box.
    pub fn len(&self) -> usize {
        self.colliders.world.len()
    }

    /// Whether no collider has a box.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What the searches had to do since the start.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Has the next step read all colliders and all contact pairs again. Call it after [`ColliderTrees`] or
    /// [`ContactGraph`] were replaced by another value. That step takes the time of finding all pairs.
    pub fn read_all_again(&mut self) {
        self.any_unlisted = true;
        self.contacts_before = None;
    }

    /// Notes that the filter of a collider may have changed, or that it may be gone.
    pub(super) fn touch(&mut self, collider: Entity) {
        self.touched.push(collider);
    }

    /// Notes that a collider may have been added. Before the search of a step Avian lists it as moved.
    pub(super) fn may_add(&mut self) {
        self.any_unlisted |= self.is_after_search;
    }

    /// Notes that a step is over.
    pub(super) fn end_step(&mut self) {
        self.is_after_search = false;
    }

    /// The collider of a body, by the slot of the body.
    pub(super) fn tracked(&self, slot: u32) -> &Tracked {
        &self.colliders.tracked[slot as usize]
    }

    /// Finds the pairs that this step may add, in an order that does not depend on entities or threads.
    pub(super) fn find(
        &mut self,
        trees: &ColliderTrees,
        moved: &MovedProxies,
        contacts: &ContactGraph,
        joints: &JointGraph,
    ) -> Vec<Candidate> {
        self.step += 1;
        self.is_after_search = true;
        if moved.proxies().is_empty() {
            // Nothing can be added. What ended or was removed is for the next step in which something moves.
            return Vec::new();
        }
        self.read_changes(trees, moved);
        self.colliders.world.update();
        // Only this plugin adds contact pairs. If more are gone than have ended, some were taken out.
        let gone = self.leave_ended(contacts);
        let in_graph = contacts.edges.edge_count();
        if self.contacts_before != Some(in_graph + gone) {
            self.compare_all(contacts);
        }
        self.contacts_before = Some(in_graph);
        let rule = Rule { trees, contacts, joints, step: self.step };
        self.examine(&rule);
        std::mem::take(&mut self.candidates)
    }

    /// Takes note of the pairs that were added, and of the candidates that the user's hook refused.
    pub(super) fn finish(
        &mut self,
        mut candidates: Vec<Candidate>,
        added: usize,
        refused: &[[u32; 2]],
    ) {
        self.contacts_before = self.contacts_before.map(|count| count + added);
        let refused = refused.iter().map(|&[a, b]| [a.min(b), a.max(b)]);
        self.waiting.extend(refused);
        self.waiting.sort_unstable();
        candidates.clear();
        self.candidates = candidates;
    }

    /// Brings the boxes and filters up to date with the trees.
    fn read_changes(&mut self, trees: &ColliderTrees, moved: &MovedProxies) {
        let Self { colliders, touched, step, .. } = self;
        colliders.move_to(moved.proxies(), trees, *step);
        colliders.refresh(touched, trees);
        touched.clear();
        if self.any_unlisted || colliders.is_out_of_step(trees) {
            self.any_unlisted = false;
            self.counts.full_reads += 1;
            colliders.read_all(trees);
        }
    }

    /// Takes the pairs that ended out of those that wait. Returns how many ended contact pairs the graph has no more
    /// that it had after the last step: the narrow phase takes out those that ended then, and Avian takes out those of
    /// removed colliders at once.
    fn leave_ended(&mut self, contacts: &ContactGraph) -> usize {
        let Self { colliders, waiting, leaving, .. } = self;
        let had = leaving.len();
        leaving.retain(|key| contacts.contains_key(key));
        let mut gone = had - leaving.len();
        leaving.clear();
        let (mut at, mut kept) = (0, 0);
        for &pair in colliders.world.changes().ended().slots() {
            while at < waiting.len() && waiting[at] < pair {
                waiting[kept] = waiting[at];
                (at, kept) = (at + 1, kept + 1);
            }
            let [one, other] = pair.map(|slot| &colliders.tracked[slot as usize]);
            if at < waiting.len() && waiting[at] == pair {
                at += 1;
            } else if one.body != other.body {
                let key = key(one, other);
                if contacts.contains_key(&key) {
                    leaving.push(key);
                } else {
                    gone += 1;
                }
            }
        }
        waiting.drain(kept..at);
        gone
    }

    /// Lets every overlapping pair wait that something has taken out of the graph of contacts.
    fn compare_all(&mut self, contacts: &ContactGraph) {
        let Self { colliders, waiting, .. } = self;
        self.counts.comparisons += 1;
        let world = &colliders.world;
        let pairs = world.pairs_unsorted().map(|pair| pair.map(|id| id.slot()));
        waiting.clear();
        waiting.extend(pairs.filter(|pair| {
            let [one, other] = pair.map(|slot| &colliders.tracked[slot as usize]);
            one.body != other.body && !contacts.contains_key(&key(one, other))
        }));
        waiting.sort_unstable();
        // Those that begin now are examined anyway.
        let begun = world.changes().begun();
        let begun = begun.slots();
        waiting.retain(|pair| begun.binary_search(pair).is_err());
    }

    /// Examines the pairs that begin, and those that wait and have a collider that moved.
    fn examine(&mut self, rule: &Rule) {
        let Self { colliders, waiting, leaving, candidates, step, counts, .. } = self;
        let tracked = &colliders.tracked;
        let mut known = HashSet::new();
        let mut examine = |pair: [u32; 2]| {
            let [one, other] = pair.map(|slot| &tracked[slot as usize]);
            counts.examined += 1;
            let (verdict, is_reversed) = rule.examine(one, other);
            if matches!(verdict, Verdict::Pair | Verdict::AskHook) {
                let [first, second] = if is_reversed { [pair[1], pair[0]] } else { pair };
                let asks_hook = verdict == Verdict::AskHook;
                candidates.push(Candidate { first, second, asks_hook });
            }
            if verdict == Verdict::Known {
                known.insert(key(one, other));
            }
            verdict == Verdict::NotNow
        };
        let moves = |slot: u32| tracked[slot as usize].moved_at == *step;
        waiting.retain(|&pair| !(moves(pair[0]) || moves(pair[1])) || examine(pair));
        let begun = colliders.world.changes().begun();
        let before = waiting.len();
        waiting.extend(begun.slots().iter().copied().filter(|&pair| examine(pair)));
        if waiting.len() > before {
            waiting.sort_unstable();
        }
        // A collider that left its tree for another one: its old pair ended, and its new one has the same contact.
        if !known.is_empty() {
            leaving.retain(|key| !known.contains(key));
        }
    }
}
