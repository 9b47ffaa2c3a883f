//! The choice of a kernel, and the safe boundary of the loop.

use core::any::Any;

#[cfg(target_arch = "aarch64")]
use super::neon;
use super::scalar;
use super::scan::{self, Cursor};
use super::sorted_boxes::{PAD, SortedBoxes};
use super::vector::PairOrder;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
use super::wasm;
#[cfg(target_arch = "x86_64")]
use super::x86;
use crate::Scalar;

/// The instructions that the innermost loop is made of.
///
/// They differ in speed alone: the pairs and their order are the same. A value of this type is
/// proof that the processor has them: it comes from [`Kernel::best`] or [`Kernel::available`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Kernel(Instructions);

/// See [`Kernel`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Instructions {
    Scalar,
    #[cfg(target_arch = "x86_64")]
    Sse2,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
    #[cfg(target_arch = "aarch64")]
    Neon,
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    Simd128,
}

/// Whether the processor has all of some instruction sets: detected at run time with `std`, known
/// from the build without.
#[cfg(target_arch = "x86_64")]
macro_rules! has {
    ($($feature:tt),+) => {{
        #[cfg(feature = "std")]
        let has = $(std::arch::is_x86_feature_detected!($feature))&&+;
        #[cfg(not(feature = "std"))]
        let has = cfg!(all($(target_feature = $feature),+));
        has
    }};
}

impl Kernel {
    /// One box at a time, on any processor: the definition.
    pub const SCALAR: Kernel = Kernel(Instructions::Scalar);

    /// The widest that this processor has. On x86-64 that is detected at run time if the feature `std`
    /// is on; otherwise the target features of the build decide.
    pub fn best() -> Self {
        // Without a choice the compiler leaves out the other kernels.
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        return Kernel(Instructions::Simd128);
        #[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
        Self::available().last().unwrap_or(Self::SCALAR)
    }

    /// All that this processor has, narrowest first.
    pub fn available() -> impl Iterator<Item = Kernel> {
        [
            Some(Kernel::SCALAR),
            #[cfg(target_arch = "x86_64")]
            Some(Kernel(Instructions::Sse2)),
            #[cfg(target_arch = "x86_64")]
            has!("avx2", "bmi1", "popcnt").then_some(Kernel(Instructions::Avx2)),
            #[cfg(target_arch = "x86_64")]
            has!("avx512f", "avx2", "bmi1", "popcnt").then_some(Kernel(Instructions::Avx512)),
            #[cfg(target_arch = "aarch64")]
            Some(Kernel(Instructions::Neon)),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Some(Kernel(Instructions::Simd128)),
        ]
        .into_iter()
        .flatten()
    }

    /// The name that a person reads.
    pub const fn name(self) -> &'static str {
        match self.0 {
            Instructions::Scalar => "scalar",
            #[cfg(target_arch = "x86_64")]
            Instructions::Sse2 => "SSE2",
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx2 => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Instructions::Avx512 => "AVX-512",
            #[cfg(target_arch = "aarch64")]
            Instructions::Neon => "NEON",
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Instructions::Simd128 => "simd128",
        }
    }

    /// The kernel for sweeps in which few boxes are ahead of each: most of 16 lanes would have nothing to test.
    #[inline]
    pub(crate) fn with_fewer_lanes(self) -> Self {
        #[cfg(target_arch = "x86_64")]
        if self.0 == Instructions::Avx512 {
            return Kernel(Instructions::Avx2);
        }
        self
    }

    /// Without `std` there is no choice, and the compiler leaves out the other kernels.
    #[inline(always)]
    fn instructions(self) -> Instructions {
        if cfg!(feature = "std") { self.0 } else { Self::best().0 }
    }

    /// Writes the pairs within a set, or those of one box of each of two sets, by the probes' order and
    /// then by their partners', until all are written or `out` is full, and returns how many. Tested are the
    /// axes beside the sweep axis, or as many as boxes have, if `all_axes`. Within a set the smaller id comes first in any case.
    ///
    /// # Panics
    /// If `out` is shorter than [`PAD`], the boxes are not ready, or the cursor is from another sweep.
    /// These are the conditions under which the unchecked accesses of the loop are in bounds.
    pub(crate) fn sweep<const D: usize, T: Scalar>(
        self,
        sets: &[SortedBoxes<T>],
        all_axes: bool,
        pair_order: PairOrder,
        cursor: &mut Cursor,
        out: &mut [[u32; 2]],
    ) -> usize {
        let tested = if all_axes { D } else { D - 1 };
        assert!(out.len() >= PAD && sets.iter().all(|set| set.is_ready(tested)));
        assert!(cursor.fits(sets));
        let (first, second) = (&sets[0], sets.get(1));
        if T::BYTES == 4 {
            let sets = (typed(first), second.map(typed));
            single::<D>(self.instructions(), sets, all_axes, pair_order, cursor, out)
        } else {
            let sets = (typed(first), second.map(typed));
            double::<D>(self.instructions(), sets, all_axes, pair_order, cursor, out)
        }
    }
}

/// The same boxes, under the name of their type: `f32` or `f64`.
fn typed<T: Scalar, U: Scalar>(boxes: &SortedBoxes<T>) -> &SortedBoxes<U> {
    let boxes: &dyn Any = boxes;
    boxes.downcast_ref().unwrap_or_else(|| unreachable!("coordinates are f32 or f64"))
}

/// The sweep over `f32` and that over `f64`: compiled for each of these instructions, with its vectors
/// of both and the target features that they take.
macro_rules! sweeps {
    ($($(#[$cfg:meta])* $instructions:ident => $single:ty, $double:ty $(, $feature:literal)?;)*) => {
        sweeps!(@single, f32, $($(#[$cfg])* $instructions => $single $(, $feature)?;)*);
        sweeps!(@double, f64, $($(#[$cfg])* $instructions => $double $(, $feature)?;)*);
    };
    (@$sweep:ident, $scalar:ty,
     $($(#[$cfg:meta])* $instructions:ident => $vector:ty $(, $feature:literal)?;)*) => {
        fn $sweep<const D: usize>(
            instructions: Instructions,
            (first, second): (&SortedBoxes<$scalar>, Option<&SortedBoxes<$scalar>>),
            all_axes: bool,
            pair_order: PairOrder,
            cursor: &mut Cursor,
            out: &mut [[u32; 2]],
        ) -> usize {
            match instructions {
                $($(#[$cfg])* Instructions::$instructions => {
                    compiled! {
                        $scalar, $vector, [$(#[target_feature(enable = $feature)])?],
                        within_0: false, 0; within_1: false, 1; within_2: false, 2; within_3: false, 3;
                        between_0: true, 0; between_1: true, 1; between_2: true, 2; between_3: true, 3;
                    }
                    // So a build for boxes of one number of dimensions has the loops of two numbers of axes.
                    let run = match (if all_axes { D } else { D - 1 }, second.is_some()) {
                        (0, false) => within_0,
                        (0, true) => between_0,
                        (1, false) => within_1,
                        (1, true) => between_1,
                        (2, false) => within_2,
                        (2, true) => between_2,
                        (_, false) => within_3,
                        (_, true) => between_3,
                    };
                    // SAFETY: a `Kernel` exists only where its instructions do, and its method, the
                    // only caller, has checked the boxes, the cursor and the output.
                    unsafe { run(first, second.unwrap_or(first), pair_order, cursor, out) }
                })*
            }
        }
    };
}

/// A function for each number of sets and of axes. None has parameters of its own: it would be compiled with the crate that uses it,
/// which may be optimized for size. (The file of the finder in WebAssembly is, and searches took up to twice as long.)
macro_rules! compiled {
    ($scalar:ty, $vector:ty, $features:tt, $($name:ident: $two:literal, $k:literal;)*) => {
        $(compiled!(@$name, $scalar, $vector, $features, $two, $k);)*
    };
    (@$name:ident, $scalar:ty, $vector:ty, [$($feature:tt)*], $two:literal, $k:literal) => {
        /// # Safety
        /// The instructions are present; the rest is as [`Kernel::sweep`] asserts.
        $($feature)*
        #[inline(never)] // One function for all sweeps takes a kilobyte more in WebAssembly.
        unsafe fn $name(
            first: &SortedBoxes<$scalar>,
            second: &SortedBoxes<$scalar>,
            pair_order: PairOrder,
            cursor: &mut Cursor,
            out: &mut [[u32; 2]],
        ) -> usize {
            // SAFETY: the caller has the instructions, and sets and a cursor that fit each other.
            unsafe { scan::sweep::<_, $vector, $two, $k>(first, second, pair_order, cursor, out) }
        }
    };
}

sweeps! {
    Scalar => scalar::One<f32>, scalar::One<f64>;
    #[cfg(target_arch = "x86_64")]
    Sse2 => x86::Sse2<x86::__m128>, x86::Sse2<x86::__m128d>;
    #[cfg(target_arch = "x86_64")]
    Avx2 => x86::Avx2<x86::__m256>, x86::Avx2<x86::__m256d>, "avx2,bmi1,popcnt";
    #[cfg(target_arch = "x86_64")]
    Avx512 => x86::Avx512<x86::__m512>, x86::Avx512<x86::__m512d>, "avx512f,bmi1,popcnt";
    #[cfg(target_arch = "aarch64")]
    Neon => neon::Neon<neon::float32x4_t>, neon::Neon<neon::float64x2_t>;
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    Simd128 => wasm::F32x8, wasm::F64x4;
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use std::vec::Vec;

    use super::*;

    #[test]
    fn fewer_lanes_are_those_of_a_kernel_that_the_processor_has() {
        let available: Vec<_> = Kernel::available().collect();
        for (at, kernel) in available.iter().enumerate() {
            let fewer = kernel.with_fewer_lanes();
            assert!(available[..=at].contains(&fewer), "{}: {}", kernel.name(), fewer.name());
        }
    }
}
