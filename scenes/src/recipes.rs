//! How each scene is made: one function a scene, from random numbers to boxes in `f64`.
//!
//! Unless they say otherwise, scenes fill the unit cube with 1.2 expected pairs a box: a box of
//! side `s` overlaps another of that side with probability `(2s)^D`, away from the walls.

use core::array;

use sweep_and_prune::{Aabb, Scalar};

use crate::random::Random;

/// What a recipe draws from.
#[derive(Debug)]
pub(crate) struct Draw {
    /// The number of boxes to make.
    pub n: usize,
    pub random: Random,
    /// The greatest finite value of the coordinate type.
    largest: f64,
    /// The least positive value of the coordinate type.
    smallest: f64,
}

impl Draw {
    pub fn new<T: Scalar>(n: usize, random: Random) -> Self {
        let is_f32 = T::from_f64(f64::MAX) == T::INFINITY;
        let (largest, smallest) = if is_f32 {
            (f64::from(f32::MAX), f64::from(f32::from_bits(1)))
        } else {
            (f64::MAX, f64::from_bits(1))
        };
        Self { n, random, largest, smallest }
    }

    /// Makes `n` boxes, one after another.
    fn each<const D: usize>(
        &mut self,
        mut make: impl FnMut(usize, &mut Random) -> Aabb<D, f64>,
    ) -> Vec<Aabb<D, f64>> {
        (0..self.n).map(|i| make(i, &mut self.random)).collect()
    }
}

/// The side at which `n` cubes in the unit cube have 1.2 pairs per box.
fn side<const D: usize>(n: usize) -> f64 {
    0.5 * root(D, 2.4 / n.max(1) as f64)
}

/// The root of this degree, 1 to 3.
fn root(degree: usize, x: f64) -> f64 {
    match degree {
        1 => x,
        2 => x.sqrt(),
        _ => libm::cbrt(x),
    }
}

/// The box of a center and half its size on each axis.
pub(crate) fn around<const D: usize>(center: [f64; D], half: [f64; D]) -> Aabb<D, f64> {
    Aabb::new(array::from_fn(|k| center[k] - half[k]), array::from_fn(|k| center[k] + half[k]))
}

/// The cube of a center and half its side.
fn cube<const D: usize>(center: [f64; D], half: f64) -> Aabb<D, f64> {
    around(center, [half; D])
}

/// The axis that points up: y where there is one.
fn up<const D: usize>() -> usize {
    usize::min(1, D - 1)
}

// The centers and the half side are also where motion starts.
pub(crate) fn uniform_cubes<const D: usize>(draw: &mut Draw) -> (Vec<[f64; D]>, f64) {
    let centers = (0..draw.n).map(|_| draw.random.point()).collect();
    (centers, side::<D>(draw.n) / 2.0)
}

pub(crate) fn uniform<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let (centers, half) = uniform_cubes(draw);
    centers.into_iter().map(|center| cube(center, half)).collect()
}

pub(crate) fn clustered<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let half = side::<D>(draw.n) / 4.0;
    let clusters = (draw.n / 500).max(1);
    let hubs: Vec<[f64; D]> = (0..clusters).map(|_| draw.random.point()).collect();
    let deviation = 0.15 / root(D, clusters as f64);
    draw.each(|_, random| {
        let hub = hubs[random.below(clusters)];
        cube(hub.map(|at| at + deviation * random.normal()), half)
    })
}

pub(crate) fn tower<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let mut half = [0.02; D];
    half[up::<D>()] = 0.6 / draw.n as f64;
    draw.each(|_, random| {
        let mut center = random.point().map(|at| at * 0.01);
        center[up::<D>()] = random.unit();
        around(center, half)
    })
}

pub(crate) fn slab<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let half = 0.25 * root(usize::max(1, D - 1), 2.4 / draw.n as f64);
    draw.each(|_, random| {
        let mut center = random.point();
        center[D - 1] *= 1e-3;
        cube(center, half)
    })
}

pub(crate) fn mixed<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let half = 0.35 * side::<D>(draw.n) / 2.0;
    draw.each(|i, random| {
        let (center, size) = (random.point(), f64::min(random.pareto(2.5) + 0.5, 40.0));
        if i > 0 {
            return cube(center, half * size);
        }
        let (mut center, mut half) = ([0.5; D], [0.5; D]);
        (center[up::<D>()], half[up::<D>()]) = (-0.001, 0.01);
        around(center, half)
    })
}

pub(crate) fn coincident<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    vec![cube(draw.random.point(), 0.25); draw.n]
}

pub(crate) fn nested<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let center = draw.random.point();
    let step = 0.5 / draw.n as f64;
    draw.each(|i, _| cube(center, step * (i + 1) as f64))
}

/// The scene of Pierre Terdiman's BoxPruning (its Shared/Main.cpp), drawn from the generator of
/// Microsoft's C library, seeded with 42: integer centers within 2048 of the origin, half sizes
/// below 128.
pub(crate) fn box_pruning<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let mut state = 42u32;
    let mut rand = |mask: u32| {
        state = state.wrapping_mul(214_013).wrapping_add(2_531_011);
        f64::from((state >> 16) & 0x7fff & mask)
    };
    draw.each(|_, _| {
        let center = array::from_fn(|_| rand(4095) - 2048.0);
        around(center, array::from_fn(|_| rand(127)))
    })
}

pub(crate) fn grid<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let width = (1..).find(|width: &usize| width.pow(D as u32) >= draw.n).unwrap_or(1);
    let mut boxes = draw.each(|mut i, _| {
        let corner = array::from_fn(|_| {
            let digit = i % width;
            i /= width;
            digit as f64
        });
        Aabb::new(corner, corner.map(|at| at + 1.0))
    });
    draw.random.shuffle(&mut boxes);
    boxes
}

pub(crate) fn points<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let places = root(D, draw.n as f64 / 2.4) as usize + 1;
    draw.each(|_, random| {
        let point: [f64; D] = array::from_fn(|_| random.below(places) as f64);
        let mut signed =
            || point.map(|at| if at == 0.0 && random.below(2) == 0 { -at } else { at });
        Aabb::new(signed(), signed())
    })
}

pub(crate) fn flat<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let mut half = [0.25 * root(usize::max(1, D - 1), 2.4 / draw.n as f64); D];
    half[D - 1] = 0.0;
    draw.each(|_, random| {
        let mut center = random.point();
        center[D - 1] = 0.5;
        around(center, half)
    })
}

pub(crate) fn diagonal<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let half = side::<1>(draw.n) / 2.0;
    draw.each(|_, random| cube([random.unit(); D], half))
}

pub(crate) fn needles_x<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    needles_along(draw, |_| 0)
}

pub(crate) fn needles_y<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    needles_along(draw, |_| 1)
}

pub(crate) fn needles_z<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    needles_along(draw, |_| 2)
}

pub(crate) fn needles<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    needles_along(draw, |random| random.below(D))
}

/// Boxes that are half as long as the scene on a chosen axis and thin on the others. There would be 1.2 pairs per box if
/// all were parallel and space had one axis less.
fn needles_along<const D: usize>(
    draw: &mut Draw,
    choose: impl Fn(&mut Random) -> usize,
) -> Vec<Aabb<D, f64>> {
    let thin = 0.25 * root(usize::max(1, D - 1), 2.4 / draw.n as f64);
    draw.each(|_, random| {
        let mut half = [thin; D];
        half[choose(random)] = 0.25;
        around(random.point(), half)
    })
}

/// Uniform boxes, except for some, which span the unit cube on the axes that `spanned` gives for their index.
fn uniform_with<const D: usize>(
    draw: &mut Draw,
    chosen: impl Fn(usize) -> bool,
    spanned: impl Fn(&mut Random) -> [bool; D],
) -> Vec<Aabb<D, f64>> {
    let mut boxes = uniform(draw);
    for aabb in boxes.iter_mut().enumerate().filter(|(i, _)| chosen(*i)).map(|(_, aabb)| aabb) {
        let spanned = spanned(&mut draw.random);
        for axis in (0..D).filter(|&axis| spanned[axis]) {
            (aabb.min[axis], aabb.max[axis]) = (0.0, 1.0);
        }
    }
    boxes
}

fn one_axis<const D: usize>(random: &mut Random) -> [bool; D] {
    let chosen = random.below(D);
    array::from_fn(|axis| axis == chosen)
}

pub(crate) fn beam<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let middle = draw.n / 2;
    uniform_with(draw, |i| i == middle, one_axis)
}

pub(crate) fn beams<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    uniform_with(draw, |i| i % 10 == 5, one_axis)
}

pub(crate) fn giant<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let middle = draw.n / 2;
    uniform_with(draw, |i| i == middle, |_| [true; D])
}

pub(crate) fn giants<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    uniform_with(draw, |i| i % 10 == 5, |_| [true; D])
}

pub(crate) fn one_column<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let width: f64 = 1e-3;
    let volume = (1..D).fold(1.0, |volume, _| volume * width);
    let half = 0.25 * root(D, 2.4 * volume / draw.n as f64);
    let last = draw.n.saturating_sub(1);
    draw.each(|i, random| {
        let mut center = random.point().map(|at| 0.5 + width * at);
        center[D - 1] = random.unit();
        match i {
            0 => cube([0.0; D], half),
            i if i == last => cube([1.0; D], half),
            _ => cube(center, half),
        }
    })
}

pub(crate) fn two_far_clusters<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let half = side::<D>(draw.n.div_ceil(2)) / 2.0;
    draw.each(|i, random| cube(random.point().map(|at| at + [0.0, 1000.0][i % 2]), half))
}

pub(crate) fn multi_scale<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    const LEVELS: usize = 8;
    let corners: [[f64; D]; LEVELS] = array::from_fn(|_| draw.random.point());
    let half = side::<D>(draw.n.div_ceil(LEVELS)) / 2.0;
    draw.each(|i, random| {
        let level = i % LEVELS;
        let scale = 1.0 / (1u64 << (2 * level)) as f64;
        let place = random.point::<D>();
        cube(array::from_fn(|k| corners[level][k] + scale * place[k]), scale * half)
    })
}

pub(crate) fn outlier<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let (mut centers, half) = uniform_cubes(draw);
    let middle = draw.n / 2;
    if let Some(center) = centers.get_mut(middle) {
        *center = [1e6; D];
    }
    centers.into_iter().map(|center| cube(center, half)).collect()
}

pub(crate) fn far<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let half = side::<D>(draw.n) / 2.0;
    draw.each(|_, random| cube(random.point().map(|at| at + 16_384.0), half))
}

pub(crate) fn huge<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    centered(draw, 1e30)
}

pub(crate) fn tiny<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    centered(draw, 1e-30)
}

pub(crate) fn extreme<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    centered(draw, draw.largest)
}

/// Uniform over the cube from `-limit` to `limit`, and cut off there.
fn centered<const D: usize>(draw: &mut Draw, limit: f64) -> Vec<Aabb<D, f64>> {
    let half = side::<D>(draw.n) * limit;
    draw.each(|_, random| {
        let aabb = cube(random.point().map(|at| (2.0 * at - 1.0) * limit), half);
        let cut = |at: f64| at.clamp(-limit, limit);
        Aabb::new(aabb.min.map(cut), aabb.max.map(cut))
    })
}

pub(crate) fn subnormal<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let unit = draw.smallest;
    let places = 3.0 * root(D, draw.n as f64 / 2.4);
    draw.each(|_, random| {
        let corner: [f64; D] = array::from_fn(|_| random.below(places as usize + 1) as f64);
        Aabb::new(corner.map(|at| at * unit), corner.map(|at| (at + 1.0) * unit))
    })
}

pub(crate) fn infinite<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    const INFINITY: f64 = f64::INFINITY;
    let mut boxes = uniform::<D>(draw);
    for aabb in boxes.iter_mut().skip(5).step_by(16) {
        let axis = draw.random.below(D);
        let (min, max) = (aabb.min[axis], aabb.max[axis]);
        if draw.random.below(2) == 0 {
            *aabb = Aabb::new([-INFINITY; D], [INFINITY; D]);
        }
        (aabb.min[axis], aabb.max[axis]) = match draw.random.below(6) {
            0 => (-INFINITY, max),
            1 => (min, INFINITY),
            2 => (-INFINITY, INFINITY),
            3 => (INFINITY, INFINITY),
            4 => (-INFINITY, -INFINITY),
            _ => (min, max),
        };
    }
    boxes
}

pub(crate) fn sorted<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let mut boxes = uniform::<D>(draw);
    boxes.sort_by(|a, b| a.min[0].total_cmp(&b.min[0]));
    boxes
}

pub(crate) fn reversed<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let mut boxes = sorted(draw);
    boxes.reverse();
    boxes
}

pub(crate) fn nearly_sorted<const D: usize>(draw: &mut Draw) -> Vec<Aabb<D, f64>> {
    let mut boxes = sorted(draw);
    for _ in 0..draw.n / 10 {
        let i = draw.random.below(draw.n - 1);
        boxes.swap(i, i + 1);
    }
    boxes
}
