//! Where does a triangle mesh cross itself? The boxes of its triangles give the candidates; only those are tested exactly.
//!
//! The mesh is a tube along a figure of eight, which goes through itself in the middle.
//!
//! `cargo run --release --example mesh`

use std::f32::consts::TAU;

use sweep_and_prune::{Aabb, Error, find_pairs};

type Point = [f32; 3];
type Triangle = [usize; 3];

/// How many rings the tube has, and how many corners a ring has.
const RINGS: usize = 200;
const CORNERS: usize = 12;

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Point, b: Point) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A tube of radius 0.3 along x = 3 sin t, y = sin 2t.
fn tube() -> (Vec<Point>, Vec<Triangle>) {
    let mut points = Vec::new();
    for ring in 0..RINGS {
        let (sin, cos) = (TAU * (ring as f32 + 0.5) / RINGS as f32).sin_cos();
        let (center, way) =
            ([3.0 * sin, 2.0 * sin * cos], [3.0 * cos, 2.0 * (cos * cos - sin * sin)]);
        let length = way[0].hypot(way[1]);
        for corner in 0..CORNERS {
            let (up, out) = (TAU * corner as f32 / CORNERS as f32).sin_cos();
            let out = 0.3 * out / length;
            points.push([center[0] - out * way[1], center[1] + out * way[0], 0.3 * up]);
        }
    }
    let mut triangles = Vec::new();
    for ring in 0..RINGS {
        for corner in 0..CORNERS {
            let at = |ring: usize, corner: usize| ring % RINGS * CORNERS + corner % CORNERS;
            let (a, b) = (at(ring, corner), at(ring, corner + 1));
            let (c, d) = (at(ring + 1, corner), at(ring + 1, corner + 1));
            triangles.extend([[a, b, c], [b, d, c]]);
        }
    }
    (points, triangles)
}

/// Whether an edge from `a` to `b` goes through a triangle (Möller and Trumbore).
fn pierces(a: Point, b: Point, [p, q, r]: [Point; 3]) -> bool {
    let (way, e, f) = (sub(b, a), sub(q, p), sub(r, p));
    let normal = cross(way, f);
    let determinant = dot(e, normal);
    if determinant == 0.0 {
        return false;
    }
    let from = sub(a, p);
    let u = dot(from, normal) / determinant;
    let side = cross(from, e);
    let v = dot(way, side) / determinant;
    let t = dot(f, side) / determinant;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&t)
}

/// Whether two triangles cross: an edge of one goes through the other.
fn crosses(a: [Point; 3], b: [Point; 3]) -> bool {
    (0..3).any(|at| pierces(a[at], a[(at + 1) % 3], b) || pierces(b[at], b[(at + 1) % 3], a))
}

fn main() -> Result<(), Error> {
    let (points, triangles) = tube();
    let corners = |triangle: Triangle| triangle.map(|at| points[at]);
    let is_fault = |a: usize, b: usize| {
        let (a, b) = (triangles[a], triangles[b]);
        // Neighbors touch where they share a corner, as they should.
        !a.iter().any(|corner| b.contains(corner)) && crosses(corners(a), corners(b))
    };

    let boxes: Vec<Aabb<3>> =
        triangles.iter().filter_map(|&triangle| Aabb::from_points(corners(triangle))).collect();
    let candidates = find_pairs(&boxes)?;
    let mut faults: Vec<_> = candidates.iter().map(|pair| pair.map(|at| at as usize)).collect();
    faults.retain(|&[a, b]| is_fault(a, b));
    faults.sort_unstable();
    println!(
        "{} triangles, {} candidates, {} pairs cross",
        triangles.len(),
        candidates.len(),
        faults.len()
    );

    // Brute force finds the same, with a test of each of 11 million pairs.
    let all = (0..triangles.len()).flat_map(|a| (a + 1..triangles.len()).map(move |b| [a, b]));
    let expected: Vec<_> = all.filter(|&[a, b]| is_fault(a, b)).collect();
    assert_eq!(faults, expected);
    // They are where the tube goes through itself.
    let middle = Aabb::new([-1.5; 3], [1.5; 3]);
    assert!(!faults.is_empty());
    assert!(faults.iter().flatten().all(|&at| middle.contains(&boxes[at])));
    Ok(())
}
