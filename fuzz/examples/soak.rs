//! A world in which bodies come, move, rest and go for a given time: it stays right, and its memory stays flat.
//!
//! ```text
//! cargo run --profile checked --package sweep-and-prune-fuzz --example soak -- [MINUTES] [BODIES] [SEED]
//! ```
//! One minute, 3,000 bodies and seed 1 if not said otherwise. Every 200 updates the pairs are compared with brute force, and
//! with the events so far. A second world is edited and queried but never updated. At the beginning and once a minute a line
//! says how many bytes are in use, and on Linux how much memory the process has.

use std::alloc::{GlobalAlloc, Layout, System};
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use sweep_and_prune::{Aabb, BroadPhase, Cast, Filter, ProxyId};
use sweep_and_prune_scenes::{Random, brute_force};

/// The system's allocator, which counts the bytes in use.
struct Counting;

static IN_USE: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call is passed on to the system's allocator as it came; counting neither allocates nor unwinds.
#[allow(unsafe_code, reason = "an allocator can be replaced in no other way")]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        IN_USE.fetch_add(layout.size(), Ordering::Relaxed);
        // SAFETY: the arguments are our caller's, who has to keep the contract of the same method.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        IN_USE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: the arguments are our caller's, who has to keep the contract of the same method.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// How many updates there are between two checks.
const CHECK: u64 = 200;
/// For how many updates the world moves in one way: all bodies, a few of them, or all in leaps.
const PHASE: u64 = 300;
/// How much memory may grow after the first quarter of the time: the sizes of buffers vary by chance.
const MOST_GROWTH: f64 = 1.1;

struct Soak {
    random: Random,
    world: BroadPhase<3>,
    /// All bodies, and their velocities.
    bodies: Vec<(ProxyId, [f32; 3])>,
    /// The pairs that follow from the events so far.
    live: BTreeSet<[ProxyId; 2]>,
    /// A world that is never updated.
    edited: BroadPhase<3>,
    edited_ids: Vec<ProxyId>,
}

impl Soak {
    fn new(bodies: usize, seed: u64) -> Self {
        let mut soak = Self {
            random: Random::new(seed),
            world: BroadPhase::new(),
            bodies: vec![],
            live: BTreeSet::new(),
            edited: BroadPhase::new(),
            edited_ids: vec![],
        };
        (0..bodies).for_each(|_| soak.insert());
        for _ in 0..bodies / 10 {
            let aabb = soak.aabb();
            let id = soak.edited.insert(aabb).unwrap();
            soak.edited_ids.push(id);
        }
        soak
    }

    fn below(&mut self, bound: usize) -> usize {
        self.random.below(bound)
    }

    /// A box in the unit cube, seldom a large one.
    fn aabb(&mut self) -> Aabb<3> {
        let side = if self.below(100) == 0 { 0.3 } else { 0.03 * self.random.unit() };
        let at: [f64; 3] = self.random.point();
        Aabb::new(at.map(|at| at as f32), at.map(|at| (at + side) as f32))
    }

    fn insert(&mut self) {
        let aabb = self.aabb();
        let filter = match self.below(10) {
            0 => Filter::STATIC,
            1 => Filter::default().group(-1),
            _ => Filter::default(),
        };
        let id = self.world.insert_with(aabb, filter).unwrap();
        let velocity = std::array::from_fn(|_| (self.random.unit() as f32 - 0.5) * 0.004);
        self.bodies.push((id, velocity));
    }

    /// One update, and everything that a game does between two updates.
    fn step(&mut self, number: u64) {
        let moving = match number / PHASE % 4 {
            0 => 1, // all
            1 => 50,
            2 => 7,
            _ => usize::MAX, // none, but some leap
        };
        for index in (0..self.bodies.len()).step_by(moving.min(self.bodies.len())) {
            let (id, velocity) = self.bodies[index];
            let mut aabb = self.world.aabb(id).unwrap();
            for (axis, velocity) in velocity.into_iter().enumerate() {
                // It turns around where it leaves the unit cube.
                let is_inside = (0.0..1.0).contains(&(aabb.min[axis] + velocity));
                let way = if is_inside { velocity } else { -velocity };
                self.bodies[index].1[axis] = way;
                aabb.min[axis] += way;
                aabb.max[axis] = (aabb.max[axis] + way).max(aabb.min[axis]);
            }
            self.world.set(id, aabb).unwrap();
        }
        for _ in 0..self.bodies.len() / 200 {
            let which = self.below(self.bodies.len());
            let (id, _) = self.bodies[which];
            let (from, to) = (self.world.aabb(id).unwrap(), self.aabb());
            match self.below(4) {
                0 => self.world.set_swept(id, from, to).unwrap(),
                1 => self.world.set_filter(id, Filter::default()).unwrap(),
                2 => self.world.set(id, to).unwrap(),
                _ => {
                    self.world.remove(id).unwrap();
                    self.bodies.swap_remove(which);
                    self.insert();
                }
            }
        }
        let area = self.aabb();
        let queries = self.world.queries();
        queries.overlapping(&area).unwrap();
        queries.nearest(area.min, 5, f64::INFINITY).unwrap();
        queries.cast(&Cast::ray(area.min, [0.3, 0.2, 0.1], 1.0)).unwrap();
        let changes = self.world.update();
        changes.ended().for_each(|pair| assert!(self.live.remove(&pair)));
        changes.begun().for_each(|pair| assert!(self.live.insert(pair)));
        self.edit();
    }

    /// What happens to the world that is never updated.
    fn edit(&mut self) {
        for _ in 0..20 {
            let which = self.below(self.edited_ids.len());
            let aabb = self.aabb();
            let id = self.edited_ids[which];
            match self.below(4) {
                0 => {
                    self.edited.remove(id).unwrap();
                    self.edited_ids[which] = self.edited.insert(aabb).unwrap();
                }
                1 => self.edited.set_swept(id, aabb, aabb).unwrap(),
                2 => self.edited.set_filter(id, Filter::default().group(which as i32)).unwrap(),
                _ => self.edited.set(id, aabb).unwrap(),
            }
        }
        let area = self.aabb();
        let ids = self.edited.ids().filter(|&id| self.edited.aabb(id).unwrap().overlaps(&area));
        let expected: Vec<_> = ids.collect();
        assert_eq!(self.edited.queries().overlapping(&area).unwrap(), expected);
    }

    /// Compares the pairs with brute force, and a restored world with this one.
    fn check(&mut self) {
        // Swept bodies need a second update: only then is a body's box its last box alone.
        for _ in 0..2 {
            let changes = self.world.update();
            changes.ended().for_each(|pair| assert!(self.live.remove(&pair)));
            changes.begun().for_each(|pair| assert!(self.live.insert(pair)));
        }
        let ids: Vec<_> = self.world.ids().collect();
        let boxes: Vec<_> = ids.iter().map(|&id| self.world.aabb(id).unwrap()).collect();
        let filters: Vec<_> = ids.iter().map(|&id| self.world.filter(id).unwrap()).collect();
        let overlaps = brute_force(&boxes).unwrap();
        let allowed = overlaps.iter().map(|pair| pair.map(|index| index as usize));
        let allowed = allowed.filter(|&[a, b]| filters[a].allows(&filters[b]));
        let expected: BTreeSet<_> = allowed.map(|pair| pair.map(|index| ids[index])).collect();
        assert!(self.live == expected, "the events do not give the pairs of brute force");
        let pairs: BTreeSet<_> = self.world.pairs().collect();
        assert!(pairs == expected, "the pairs are not those of brute force");
        let restored = BroadPhase::<3>::from_snapshot(&self.world.snapshot()).unwrap();
        assert_eq!(restored.state_hash(), self.world.state_hash());
        assert!(restored.pairs().collect::<BTreeSet<_>>() == expected);
    }
}

/// The memory of the process in MiB, on Linux.
fn resident() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().strip_suffix(" kB")?.parse::<f64>().ok()? / 1024.0)
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let mut argument = |default: f64| {
        arguments.next().map_or(default, |text| text.parse().expect("arguments are numbers"))
    };
    let time = Duration::from_secs_f64(60.0 * argument(1.0));
    let mut soak = Soak::new(argument(3000.0) as usize, argument(1.0) as u64);
    let begun = Instant::now();
    let (mut number, mut minutes) = (0, 0);
    // The most bytes in use in the first quarter of the time, and in the rest.
    let mut most = [0; 2];
    while begun.elapsed() < time {
        soak.step(number);
        number += 1;
        if number % CHECK == 0 {
            soak.check();
            let half = usize::from(begun.elapsed() > time / 4);
            most[half] = most[half].max(IN_USE.load(Ordering::Relaxed));
        }
        if begun.elapsed().as_secs() / 60 >= minutes {
            let in_use = IN_USE.load(Ordering::Relaxed);
            let (pairs, resident) = (soak.live.len(), resident().unwrap_or_default());
            println!(
                "{minutes} min: {number} updates, {pairs} pairs, {in_use} bytes, {resident:.1} MiB"
            );
            minutes += 1;
        }
    }
    soak.check();
    println!(
        "{number} updates with {} bodies: right. At most {} bytes in use in the first quarter, then {}. {:.1} MiB.",
        soak.bodies.len(),
        most[0],
        most[1],
        resident().unwrap_or_default()
    );
    assert!(most[1] as f64 <= MOST_GROWTH * most[0] as f64, "memory grew");
}
