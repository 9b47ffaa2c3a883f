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
            has!("avx512f", "bmi1", "popcnt").then_some(Kernel(Instructions::Avx512)),
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

    /// Without `std` there is no choice, and the compiler leaves out the other kernels.
    #[inline(always)]
    fn instructions(self) -> Instructions {
        if cfg!(feature = "std") { self.0 } else { Self::best().0 }
    }

    /// Writes the pairs within a set, by the boxes' order and then by their partners', until all are
    /// written or `out` is full, and returns how many. `others` axes are tested beside the sweep axis.
    ///
    /// # Panics
    /// If `out` is shorter than [`PAD`], the boxes are not ready, or the cursor is from another sweep.
    /// These are the conditions under which the unchecked accesses of the loop are in bounds.
    pub(crate) fn within<T: Scalar>(
        self,
        boxes: &SortedBoxes<T>,
        others: usize,
        cursor: &mut Cursor,
        out: &mut [[u32; 2]],
    ) -> usize {
        assert!(out.len() >= PAD && boxes.is_ready(others) && cursor.fits(&[boxes]));
        let boxes: &dyn Any = boxes;
        if T::BYTES == 4 {
            single::within(self.instructions(), typed(boxes), others, cursor, out)
        } else {
            double::within(self.instructions(), typed(boxes), others, cursor, out)
        }
    }

    /// Writes the pairs of one box of each set, otherwise as [`within`](Self::within).
    ///
    /// # Panics
    /// As [`within`](Self::within).
    pub(crate) fn between<T: Scalar>(
        self,
        [a, b]: [&SortedBoxes<T>; 2],
        others: usize,
        pair_order: PairOrder,
        cursor: &mut Cursor,
        out: &mut [[u32; 2]],
    ) -> usize {
        assert!(out.len() >= PAD && a.is_ready(others) && b.is_ready(others));
        assert!(cursor.fits(&[a, b]));
        let (a, b): (&dyn Any, &dyn Any) = (a, b);
        if T::BYTES == 4 {
            single::between(
                self.instructions(),
                [typed(a), typed(b)],
                others,
                pair_order,
                cursor,
                out,
            )
        } else {
            double::between(
                self.instructions(),
                [typed(a), typed(b)],
                others,
                pair_order,
                cursor,
                out,
            )
        }
    }
}

/// The boxes as those of `f32`, or those of `f64`, which they are.
fn typed<T: Scalar>(boxes: &dyn Any) -> &SortedBoxes<T> {
    boxes.downcast_ref().unwrap_or_else(|| unreachable!("coordinates are f32 or f64"))
}

/// A module with both sweeps over one vector type, compiled for its instructions.
macro_rules! shell {
    ($(#[$cfg:meta])* $name:ident, $scalar:ty, $vector:ty $(, $feature:literal)?) => {
        $(#[$cfg])*
        mod $name {
            use super::super::*;

            /// # Safety
            /// The instructions are present; the rest is as [`Kernel::within`] asserts.
            $(#[target_feature(enable = $feature)])?
            pub(super) unsafe fn within(
                boxes: &SortedBoxes<$scalar>,
                others: usize,
                cursor: &mut Cursor,
                out: &mut [[u32; 2]],
            ) -> usize {
                // SAFETY: the caller's promise.
                unsafe {
                    match others {
                        0 => scan::within::<$scalar, $vector, 0>(boxes, cursor, out),
                        1 => scan::within::<$scalar, $vector, 1>(boxes, cursor, out),
                        2 => scan::within::<$scalar, $vector, 2>(boxes, cursor, out),
                        _ => scan::within::<$scalar, $vector, 3>(boxes, cursor, out),
                    }
                }
            }

            /// # Safety
            /// The instructions are present; the rest is as [`Kernel::between`] asserts.
            $(#[target_feature(enable = $feature)])?
            pub(super) unsafe fn between(
                sets: [&SortedBoxes<$scalar>; 2],
                others: usize,
                pair_order: PairOrder,
                cursor: &mut Cursor,
                out: &mut [[u32; 2]],
            ) -> usize {
                // SAFETY: the caller's promise.
                unsafe {
                    match others {
                        0 => scan::between::<$scalar, $vector, 0>(sets, pair_order, cursor, out),
                        1 => scan::between::<$scalar, $vector, 1>(sets, pair_order, cursor, out),
                        2 => scan::between::<$scalar, $vector, 2>(sets, pair_order, cursor, out),
                        _ => scan::between::<$scalar, $vector, 3>(sets, pair_order, cursor, out),
                    }
                }
            }
        }
    };
}

/// Calls the function of that name compiled for the instructions.
macro_rules! choose {
    ($instructions:ident, $function:ident, $arguments:tt) => {
        // SAFETY: a `Kernel` exists only where its instructions do, and its methods, the only
        // callers, have checked the boxes, the cursor and the output.
        unsafe {
            match $instructions {
                Instructions::Scalar => scalar::$function $arguments,
                #[cfg(target_arch = "x86_64")]
                Instructions::Sse2 => sse2::$function $arguments,
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx2 => avx2::$function $arguments,
                #[cfg(target_arch = "x86_64")]
                Instructions::Avx512 => avx512::$function $arguments,
                #[cfg(target_arch = "aarch64")]
                Instructions::Neon => neon::$function $arguments,
                #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
                Instructions::Simd128 => simd128::$function $arguments,
            }
        }
    };
}

/// The shells of one coordinate type, and the choice among them.
macro_rules! coordinate {
    ($scalar:ident, $shells:ident, $x128:ident, $x256:ident, $x512:ident, $neon:ident, $simd128:ident) => {
        mod $shells {
            shell!(scalar, $scalar, scalar::One<$scalar>);
            shell!(
                #[cfg(target_arch = "x86_64")]
                sse2,
                $scalar,
                x86::Sse2<core::arch::x86_64::$x128>
            );
            shell!(
                #[cfg(target_arch = "x86_64")]
                avx2,
                $scalar,
                x86::Avx2<core::arch::x86_64::$x256>,
                "avx2,bmi1,popcnt"
            );
            shell!(
                #[cfg(target_arch = "x86_64")]
                avx512,
                $scalar,
                x86::Avx512<core::arch::x86_64::$x512>,
                "avx512f,bmi1,popcnt"
            );
            shell!(
                #[cfg(target_arch = "aarch64")]
                neon,
                $scalar,
                neon::Neon<core::arch::aarch64::$neon>
            );
            shell!(
                #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
                simd128,
                $scalar,
                wasm::$simd128
            );

            use super::*;

            pub(super) fn within(
                instructions: Instructions,
                boxes: &SortedBoxes<$scalar>,
                others: usize,
                cursor: &mut Cursor,
                out: &mut [[u32; 2]],
            ) -> usize {
                choose!(instructions, within, (boxes, others, cursor, out))
            }

            pub(super) fn between(
                instructions: Instructions,
                sets: [&SortedBoxes<$scalar>; 2],
                others: usize,
                pair_order: PairOrder,
                cursor: &mut Cursor,
                out: &mut [[u32; 2]],
            ) -> usize {
                choose!(instructions, between, (sets, others, pair_order, cursor, out))
            }
        }
    };
}

coordinate!(f32, single, __m128, __m256, __m512, float32x4_t, F32x8);
coordinate!(f64, double, __m128d, __m256d, __m512d, float64x2_t, F64x4);
