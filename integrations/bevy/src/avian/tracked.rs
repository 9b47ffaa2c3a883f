//! The colliders of Avian's trees as bodies of a [`BroadPhase`].

use bevy::ecs::entity::{Entity, EntityHashMap};
use sweep_and_prune::{Aabb, BroadPhase, Filter, ProxyId};

use super::DIMENSIONS;
use super::avian::collider_tree::{
    ColliderTreeProxy, ColliderTreeProxyKey, ColliderTreeType, ColliderTrees,
};

/// A collider that is a body of the broad phase.
#[derive(Clone, Copy, Debug)]
pub struct Tracked {
    /// Where Avian's trees have it.
    pub key: ColliderTreeProxyKey,
    /// The collider and its rigid body when it was inserted.
    pub collider: Entity,
    pub body: Option<Entity>,
    /// The filter of its body.
    pub filter: Filter,
    /// The last step in which Avian listed it as moved.
    pub moved_at: u64,
    /// Whether it was removed since the last update of the broad phase.
    pub is_removed: bool,
}

/// All colliders of the trees whose boxes are valid.
#[derive(Clone, Debug, Default)]
pub struct Colliders {
    pub world: BroadPhase<DIMENSIONS>,
    /// By [slot](ProxyId::slot).
    pub tracked: Vec<Tracked>,
    /// By tree and by the position in it.
    ids: [Vec<Option<ProxyId>>; 4],
    of_entity: EntityHashMap<ProxyId>,
    /// Buffers: bodies that move, and their boxes.
    moving: Vec<ProxyId>,
    boxes: Vec<Aabb<DIMENSIONS>>,
    /// A buffer: the boxes that the trees have of those that Avian listed as moved.
    read_boxes: Vec<Option<Aabb<DIMENSIONS>>>,
    /// Whether a body was removed since moves were applied: it may be among those that move.
    any_removed: bool,
    /// How many colliders the trees have and the broad phase does not, because their boxes are not valid.
    without_box: usize,
}

impl Colliders {
    /// Gives the colliders that Avian listed as moved their new boxes, and inserts those that are new.
    pub fn move_to(&mut self, keys: &[ColliderTreeProxyKey], trees: &ColliderTrees, step: u64) {
        // All boxes first: the tree has them in another order, and processors wait for several of them at once.
        let mut read = std::mem::take(&mut self.read_boxes);
        read.extend(keys.iter().map(|&key| stored_box(key, trees)));
        for (&key, aabb) in keys.iter().zip(read.drain(..)) {
            if let Some(id) = self.read(key, aabb, trees) {
                self.tracked[id.slot() as usize].moved_at = step;
            }
        }
        self.read_boxes = read;
        self.apply_moves();
    }

    /// Reads colliders again whose filters may have changed, or that may be gone.
    pub fn refresh(&mut self, colliders: &[Entity], trees: &ColliderTrees) {
        for collider in colliders {
            if let Some(&id) = self.of_entity.get(collider) {
                let key = self.tracked[id.slot() as usize].key;
                self.read(key, stored_box(key, trees), trees);
            }
        }
        self.apply_moves();
    }

    /// Whether the trees have colliders that were added or removed unnoticed. Constant time.
    pub fn is_out_of_step(&self, trees: &ColliderTrees) -> bool {
        count(trees) != self.world.len() + self.without_box
    }

    /// Reads all colliders of the trees.
    pub fn read_all(&mut self, trees: &ColliderTrees) {
        for kind in ColliderTreeType::ALL {
            let known = self.ids[kind as usize].len();
            let proxies = &trees.tree_for_type(kind).proxies;
            let last = proxies.iter().map(|(index, _)| index + 1).max().unwrap_or(0);
            for index in 0..known.max(last) {
                let key = ColliderTreeProxyKey::new((index as u32).into(), kind);
                self.read(key, stored_box(key, trees), trees);
            }
        }
        self.apply_moves();
        self.without_box = count(trees).saturating_sub(self.world.len());
    }

    /// Makes the body at a key what the tree has there, with this [box](stored_box). Its new box counts from `apply_moves`
    /// on.
    fn read(
        &mut self,
        key: ColliderTreeProxyKey,
        aabb: Option<Aabb<DIMENSIONS>>,
        trees: &ColliderTrees,
    ) -> Option<ProxyId> {
        let had = self.ids[key.tree_type() as usize].get(key.id().index()).copied().flatten();
        // A box that is not valid, as that of a collider without a shape, overlaps nothing.
        let aabb = aabb.filter(|aabb| sweep_and_prune::validate(&[*aabb]).is_ok());
        let found = proxy(key, trees).zip(aabb);
        let Some((proxy, aabb)) = found else {
            if let Some(id) = had {
                self.remove(id);
            }
            return None;
        };
        let filter = filter(proxy, key.tree_type());
        if let Some(id) = had {
            let tracked = &mut self.tracked[id.slot() as usize];
            if (tracked.collider, tracked.body) == (proxy.collider, proxy.body) {
                self.moving.push(id);
                self.boxes.push(aabb);
                if tracked.filter != filter {
                    tracked.filter = filter;
                    let changed = self.world.set_filter(id, filter);
                    debug_assert!(changed.is_ok(), "the id of a body that is here");
                }
                return Some(id);
            }
            self.remove(id);
        }
        // It may have been under another key.
        if let Some(&old) = self.of_entity.get(&proxy.collider) {
            let key = self.tracked[old.slot() as usize].key;
            if self::proxy(key, trees).is_none_or(|it| it.collider != proxy.collider) {
                self.remove(old);
            }
        }
        self.insert(key, proxy, aabb, filter)
    }

    fn insert(
        &mut self,
        key: ColliderTreeProxyKey,
        proxy: &ColliderTreeProxy,
        aabb: Aabb<DIMENSIONS>,
        filter: Filter,
    ) -> Option<ProxyId> {
        // It fails only at 2^32 bodies, which Avian's keys cannot name.
        let id = self.world.insert_with(aabb, filter).ok()?;
        let (slot, index) = (id.slot() as usize, key.id().index());
        let &ColliderTreeProxy { collider, body, .. } = proxy;
        let tracked = Tracked { key, collider, body, filter, moved_at: 0, is_removed: false };
        if slot >= self.tracked.len() {
            self.tracked.resize(slot + 1, tracked);
        }
        self.tracked[slot] = tracked;
        let ids = &mut self.ids[key.tree_type() as usize];
        if index >= ids.len() {
            ids.resize(index + 1, None);
        }
        ids[index] = Some(id);
        self.of_entity.insert(collider, id);
        Some(id)
    }

    fn remove(&mut self, id: ProxyId) {
        let tracked = &mut self.tracked[id.slot() as usize];
        tracked.is_removed = true;
        self.ids[tracked.key.tree_type() as usize][tracked.key.id().index()] = None;
        if self.of_entity.get(&tracked.collider) == Some(&id) {
            self.of_entity.remove(&tracked.collider);
        }
        self.any_removed = true;
        let removed = self.world.remove(id);
        debug_assert!(removed.is_ok(), "the id of a body that is here");
    }

    fn apply_moves(&mut self) {
        let Self { world, moving, boxes, .. } = self;
        if std::mem::take(&mut self.any_removed) {
            let both = moving.iter().zip(boxes.iter()).filter(|(id, _)| world.contains(**id));
            (*moving, *boxes) = both.map(|(&id, &aabb)| (id, aabb)).unzip();
        }
        let set = world.set_many(moving, boxes);
        debug_assert!(set.is_ok(), "valid boxes of bodies that are here");
        moving.clear();
        boxes.clear();
    }
}

/// How many colliders the trees have.
fn count(trees: &ColliderTrees) -> usize {
    trees.iter_trees().map(|tree| tree.proxies.len()).sum()
}

/// What a tree has at a key.
pub fn proxy(key: ColliderTreeProxyKey, trees: &ColliderTrees) -> Option<&ColliderTreeProxy> {
    trees.tree_for_type(key.tree_type()).get_proxy(key.id())
}

/// The enlarged box that a tree has at a key. Trees have `f32` boxes in each precision of Avian.
fn stored_box(key: ColliderTreeProxyKey, trees: &ColliderTrees) -> Option<Aabb<DIMENSIONS>> {
    let aabb = trees.tree_for_type(key.tree_type()).get_proxy_aabb(key.id())?;
    let [min, max] = [aabb.min, aabb.max].map(|corner| corner.to_array());
    Some(Aabb::new(std::array::from_fn(|axis| min[axis]), std::array::from_fn(|axis| max[axis])))
}

/// What keeps pairs out of the search: layers, and static colliders that are not sensors among themselves.
fn filter(proxy: &ColliderTreeProxy, kind: ColliderTreeType) -> Filter {
    let layers = proxy.layers;
    Filter::default()
        .category(layers.memberships.0)
        .mask(layers.filters.0)
        .is_static(kind.is_static() && !proxy.is_sensor())
}
