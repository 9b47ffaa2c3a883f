//! The innermost loop on each instruction set, and the choice among them.
//!
//! [`scan`] holds the loop once, over the vectors of [`scalar`], `x86`, `neon` and `wasm`. This
//! module and those beneath it are the only ones of the crate with `unsafe`; what they offer is
//! safe.
#![allow(unsafe_code)]

mod column;
#[cfg(target_arch = "aarch64")]
mod neon;
mod output;
mod scalar;
mod scan;
mod scatter;
mod vector;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod wasm;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use column::{Column, PAD};
pub use scan::Cursor;
pub use scatter::{Copied, Counted, Share, place};
pub use vector::Arrange;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
pub use wasm::spans_by_four;

/// The instructions that the innermost loop is made of.
///
/// They differ in speed alone: the pairs and their order are the same. A value of this type is
/// proof that the processor has them: it comes from [`Kernel::best`] or [`Kernel::available`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Kernel(Instructions);

/// See [`Kernel`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Instructions {
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

/// Whether the processor has all of some instruction sets: asked at run time with `std`, known
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

    /// The widest that this processor has. On x86-64 it is asked at run time if the feature `std`
    /// is on; elsewhere the build decides.
    pub fn best() -> Self {
        // Said outright: what the compiler knows not to be used it leaves out.
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

    /// The pairs within a column, by the boxes' order and then by their partners', until all are
    /// written or `out` is full: see [`Cursor`]. `others` axes are tested beside the sweep axis.
    ///
    /// # Panics
    /// If `out` is shorter than [`PAD`], or the column not ready.
    pub(crate) fn within<T: Coordinate>(
        self,
        column: &Column<T>,
        others: usize,
        cursor: &mut Cursor,
        out: &mut [[u32; 2]],
    ) -> usize {
        assert!(out.len() >= PAD && column.is_ready(others));
        T::within(self.0, column, others, cursor, out)
    }

    /// The pairs of one box of each column, otherwise as [`within`](Self::within).
    ///
    /// # Panics
    /// If `out` is shorter than [`PAD`], or a column not ready.
    pub(crate) fn between<T: Coordinate>(
        self,
        columns: [&Column<T>; 2],
        others: usize,
        arrange: Arrange,
        cursor: &mut Cursor,
        out: &mut [[u32; 2]],
    ) -> usize {
        assert!(out.len() >= PAD && columns.iter().all(|column| column.is_ready(others)));
        T::between(self.0, columns, others, arrange, cursor, out)
    }
}

/// What the kernels offer for a coordinate type.
pub trait Coordinate: Copy + PartialOrd + core::fmt::Debug + 'static {
    /// Zero, and what is ordered with nothing.
    const ZERO: Self;
    /// Not a number.
    const NAN: Self;

    /// See [`Kernel::within`].
    fn within(
        instructions: Instructions,
        column: &Column<Self>,
        others: usize,
        cursor: &mut Cursor,
        out: &mut [[u32; 2]],
    ) -> usize;

    /// See [`Kernel::between`].
    fn between(
        instructions: Instructions,
        columns: [&Column<Self>; 2],
        others: usize,
        arrange: Arrange,
        cursor: &mut Cursor,
        out: &mut [[u32; 2]],
    ) -> usize;
}

/// A module with both sweeps over one vector type, compiled for its instructions.
macro_rules! shell {
    ($(#[$cfg:meta])* $name:ident, $scalar:ty, $vector:ty $(, $feature:literal)?) => {
        $(#[$cfg])*
        mod $name {
            use super::super::*;

            /// # Safety
            /// The instructions are present; the column is ready; `out.len() >= PAD`.
            $(#[target_feature(enable = $feature)])?
            pub(super) unsafe fn within(
                column: &Column<$scalar>,
                others: usize,
                cursor: &mut Cursor,
                out: &mut [[u32; 2]],
            ) -> usize {
                // SAFETY: the caller's promise.
                unsafe {
                    match others {
                        0 => scan::within::<$scalar, $vector, 0>(column, cursor, out),
                        1 => scan::within::<$scalar, $vector, 1>(column, cursor, out),
                        2 => scan::within::<$scalar, $vector, 2>(column, cursor, out),
                        _ => scan::within::<$scalar, $vector, 3>(column, cursor, out),
                    }
                }
            }

            /// # Safety
            /// The instructions are present; both columns are ready; `out.len() >= PAD`.
            $(#[target_feature(enable = $feature)])?
            pub(super) unsafe fn between(
                columns: [&Column<$scalar>; 2],
                others: usize,
                arrange: Arrange,
                cursor: &mut Cursor,
                out: &mut [[u32; 2]],
            ) -> usize {
                // SAFETY: the caller's promise.
                unsafe {
                    match others {
                        0 => scan::between::<$scalar, $vector, 0>(columns, arrange, cursor, out),
                        1 => scan::between::<$scalar, $vector, 1>(columns, arrange, cursor, out),
                        2 => scan::between::<$scalar, $vector, 2>(columns, arrange, cursor, out),
                        _ => scan::between::<$scalar, $vector, 3>(columns, arrange, cursor, out),
                    }
                }
            }
        }
    };
}

/// Calls the function of that name compiled for the instructions.
macro_rules! choose {
    ($instructions:ident, $function:ident, $arguments:tt) => {
        // SAFETY: a `Kernel` exists only where its instructions do, and its methods,
        // the only callers, have checked the columns and the output.
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

            use super::{Arrange, Column, Coordinate, Cursor, Instructions};

            impl Coordinate for $scalar {
                const ZERO: Self = 0.0;
                const NAN: Self = $scalar::NAN;

                fn within(
                    instructions: Instructions,
                    column: &Column<Self>,
                    others: usize,
                    cursor: &mut Cursor,
                    out: &mut [[u32; 2]],
                ) -> usize {
                    choose!(instructions, within, (column, others, cursor, out))
                }

                fn between(
                    instructions: Instructions,
                    columns: [&Column<Self>; 2],
                    others: usize,
                    arrange: Arrange,
                    cursor: &mut Cursor,
                    out: &mut [[u32; 2]],
                ) -> usize {
                    choose!(instructions, between, (columns, others, arrange, cursor, out))
                }
            }
        }
    };
}

coordinate!(f32, single, __m128, __m256, __m512, float32x4_t, F32x8);
coordinate!(f64, double, __m128d, __m256d, __m512d, float64x2_t, F64x4);
