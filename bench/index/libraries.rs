//! The alternatives, each called as its documentation recommends for many searches.

use packed_spatial_index::{Box2D, Box3D, Index2DBuilder, Index3DBuilder, SearchWorkspace};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use sweep_and_prune::Aabb;

/// A library, or a variant of it.
pub struct Library<const D: usize> {
    pub name: &'static str,
    pub build: fn(&[Aabb<D>]) -> Box<dyn Tree<D>>,
}

/// A tree that was built.
pub trait Tree<const D: usize> {
    /// Stores the indices of the boxes that overlap an area, and returns how many there are.
    fn search(&mut self, area: &Aabb<D>) -> usize;

    /// The indices in ascending order.
    fn sorted(&mut self, area: &Aabb<D>) -> Vec<u32>;
}

/// In the plane.
pub fn two() -> Vec<Library<2>> {
    vec![
        Library {
            name: "packed_spatial_index",
            build: |boxes| Box::new(packed::Plain2::of(boxes)),
        },
        Library { name: "its SIMD variant", build: |boxes| Box::new(packed::Simd2::of(boxes)) },
        Library { name: "that in f32", build: |boxes| Box::new(packed::SimdSingle2::of(boxes)) },
        Library { name: "rstar", build: |boxes| Box::new(Rstar::of(boxes)) },
        Library { name: "parry", build: |boxes| Box::new(parry_2d::Parry::of(boxes)) },
    ]
}

/// In space.
pub fn three() -> Vec<Library<3>> {
    vec![
        Library {
            name: "packed_spatial_index",
            build: |boxes| Box::new(packed::Plain3::of(boxes)),
        },
        Library { name: "its SIMD variant", build: |boxes| Box::new(packed::Simd3::of(boxes)) },
        Library { name: "that in f32", build: |boxes| Box::new(packed::SimdSingle3::of(boxes)) },
        Library { name: "rstar", build: |boxes| Box::new(Rstar::of(boxes)) },
        Library { name: "parry", build: |boxes| Box::new(parry_3d::Parry::of(boxes)) },
    ]
}

fn to_sorted(indices: &[usize]) -> Vec<u32> {
    let mut sorted: Vec<_> = indices.iter().map(|&index| index as u32).collect();
    sorted.sort_unstable();
    sorted
}

mod packed {
    use super::*;

    fn two(aabb: &Aabb<2>) -> Box2D {
        let ([x0, y0], [x1, y1]) = (aabb.min.map(f64::from), aabb.max.map(f64::from));
        Box2D::new(x0, y0, x1, y1)
    }

    fn three(aabb: &Aabb<3>) -> Box3D {
        let ([x0, y0, z0], [x1, y1, z1]) = (aabb.min.map(f64::from), aabb.max.map(f64::from));
        Box3D::new(x0, y0, z0, x1, y1, z1)
    }

    macro_rules! variant {
        ($($name:ident, $dimensions:literal, $index:ident, $builder:ident, $finish:ident, $convert:ident;)*) => {$(
            pub struct $name {
                index: packed_spatial_index::$index,
                workspace: SearchWorkspace,
            }

            impl $name {
                pub fn of(boxes: &[Aabb<$dimensions>]) -> Self {
                    let mut builder = $builder::new(boxes.len());
                    for aabb in boxes {
                        builder.add($convert(aabb));
                    }
                    let index = builder.$finish().expect("the boxes are valid");
                    Self { index, workspace: SearchWorkspace::new() }
                }
            }

            impl Tree<$dimensions> for $name {
                fn search(&mut self, area: &Aabb<$dimensions>) -> usize {
                    self.index.search_with($convert(area), &mut self.workspace).len()
                }

                fn sorted(&mut self, area: &Aabb<$dimensions>) -> Vec<u32> {
                    to_sorted(self.index.search_with($convert(area), &mut self.workspace))
                }
            }
        )*};
    }

    variant! {
        Plain2, 2, Index2D, Index2DBuilder, finish, two;
        Simd2, 2, SimdIndex2D, Index2DBuilder, finish_simd, two;
        SimdSingle2, 2, SimdIndex2DF32, Index2DBuilder, finish_simd_f32, two;
        Plain3, 3, Index3D, Index3DBuilder, finish, three;
        Simd3, 3, SimdIndex3D, Index3DBuilder, finish_simd, three;
        SimdSingle3, 3, SimdIndex3DF32, Index3DBuilder, finish_simd_f32, three;
    }
}

struct Rstar<const D: usize> {
    tree: RTree<GeomWithData<Rectangle<[f32; D]>, u32>>,
    found: Vec<u32>,
}

impl<const D: usize> Rstar<D> {
    fn of(boxes: &[Aabb<D>]) -> Self {
        let leaf = |(aabb, id): (&Aabb<D>, u32)| {
            let envelope = AABB::from_corners(aabb.min, aabb.max);
            GeomWithData::new(Rectangle::from_aabb(envelope), id)
        };
        let tree = RTree::bulk_load(boxes.iter().zip(0..).map(leaf).collect());
        Self { tree, found: Vec::new() }
    }
}

impl<const D: usize> Tree<D> for Rstar<D> {
    fn search(&mut self, area: &Aabb<D>) -> usize {
        let envelope = AABB::from_corners(area.min, area.max);
        self.found.clear();
        self.found.extend(self.tree.locate_in_envelope_intersecting(envelope).map(|it| it.data));
        self.found.len()
    }

    fn sorted(&mut self, area: &Aabb<D>) -> Vec<u32> {
        self.search(area);
        self.found.sort_unstable();
        self.found.clone()
    }
}

/// parry is two crates with one interface.
macro_rules! parry {
    ($module:ident, $parry:ident, $dimensions:literal) => {
        mod $module {
            use $parry::bounding_volume::Aabb as Bounds;
            use $parry::partitioning::{Bvh, BvhBuildStrategy};

            use super::{Aabb, Tree};

            pub struct Parry {
                tree: Bvh,
                found: Vec<u32>,
            }

            fn bounds(aabb: &Aabb<$dimensions>) -> Bounds {
                Bounds::new(aabb.min.into(), aabb.max.into())
            }

            impl Parry {
                pub fn of(boxes: &[Aabb<$dimensions>]) -> Self {
                    let leaves = boxes.iter().map(bounds).enumerate();
                    let tree = Bvh::from_iter(BvhBuildStrategy::default(), leaves);
                    Self { tree, found: Vec::new() }
                }
            }

            impl Tree<$dimensions> for Parry {
                fn search(&mut self, area: &Aabb<$dimensions>) -> usize {
                    let area = bounds(area);
                    self.found.clear();
                    self.found.extend(self.tree.intersect_aabb(&area));
                    self.found.len()
                }

                fn sorted(&mut self, area: &Aabb<$dimensions>) -> Vec<u32> {
                    self.search(area);
                    self.found.sort_unstable();
                    self.found.clone()
                }
            }
        }
    };
}

parry!(parry_2d, parry2d, 2);
parry!(parry_3d, parry3d, 3);
