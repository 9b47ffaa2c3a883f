//! What a target draws from its input: numbers, coordinates and boxes.

use arbitrary::Unstructured;
use sweep_and_prune::{Aabb, Scalar};

/// The bytes that decide what a target does, and where each operation begins in them.
pub struct Input<'a> {
    bytes: Unstructured<'a>,
    len: usize,
    starts: Vec<usize>,
    /// Whether to print each operation.
    pub is_verbose: bool,
}

impl<'a> Input<'a> {
    /// An input that begins with the first byte.
    pub fn new(bytes: &'a [u8]) -> Self {
        let (len, starts) = (bytes.len(), Vec::new());
        Self { bytes: Unstructured::new(bytes), len, starts, is_verbose: false }
    }

    /// Whether no bytes are left: from now on every number is 0.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Begins an operation, unless no bytes are left.
    pub fn next_operation(&mut self) -> bool {
        let goes_on = !self.is_empty();
        if goes_on {
            self.starts.push(self.end());
        }
        goes_on
    }

    /// How many bytes were used.
    pub fn end(&self) -> usize {
        self.len - self.bytes.len()
    }

    /// Where the bytes of each operation begin.
    pub fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// A number below a bound, from one byte if the bound is 256 or less; 0 if it is 1 or less.
    pub fn below(&mut self, bound: usize) -> usize {
        match bound {
            0 | 1 => 0,
            2..=0x100 => self.bytes.int_in_range(0..=(bound - 1) as u8).unwrap_or(0).into(),
            0x101..=0x1_0000 => self.bytes.int_in_range(0..=(bound - 1) as u16).unwrap_or(0).into(),
            _ => self.bytes.int_in_range(0..=bound - 1).unwrap_or(0),
        }
    }

    /// True in one of this many cases, but not where no bytes are left.
    pub fn chance(&mut self, one_in: usize) -> bool {
        self.below(one_in) + 1 == one_in
    }

    /// One of some values, from one byte.
    pub fn pick<V: Copy>(&mut self, of: &[V]) -> V {
        of[self.below(of.len())]
    }

    /// Prints what an operation does, or the beginning of it if that is long, if the input is verbose.
    pub fn say(&self, text: impl FnOnce() -> String) {
        if self.is_verbose {
            println!("{}", text().chars().take(1000).collect::<String>());
        }
    }
}

/// Where coordinates lie: few values, so that ties are common, of any magnitude.
#[derive(Clone, Copy, Debug)]
pub struct Space {
    /// The distance of two neighboring values.
    pub unit: f64,
    origin: f64,
    /// How many values there are.
    values: usize,
    /// One in this many coordinates is special: infinite, huge or subnormal. With 1 none is.
    special: usize,
}

impl Space {
    /// A space for about this many boxes with coordinates of a type. Few boxes may be anywhere; many lie apart, so that
    /// each overlaps a few others and not all.
    pub fn draw<const D: usize, T: Scalar>(input: &mut Input, boxes: usize) -> Self {
        let (huge, tiny) = if T::BYTES == 4 { (1e37, 1e-44) } else { (1e307, 3e-323) };
        let (unit, origin) = input.pick(&[
            (1.0, 0.0),
            (1.0, -3.0),
            (0.1, 0.0),
            (0.25, 1e7),
            (1.0, -3e7),
            (1e30, 0.0),
            (1e-30, 0.0),
            (huge, 0.0),
            (huge, -8.0 * huge),
            (tiny, 0.0),
        ]);
        let values = if boxes <= 24 {
            input.pick(&[8, 2, 4, 16, 60, 250])
        } else {
            let density = input.pick(&[2.0, 1.0, 5.0]);
            (density * (boxes as f64).powf(1.0 / D as f64)).ceil() as usize
        };
        // With the huge unit, coordinates beyond a few times sixteen units are infinite. That is tested too, but seldom.
        let values = if unit == huge { values.min(16) } else { values };
        Self { unit, origin, values, special: input.pick(&[1, 1, 200, 24, 5]) }
    }

    /// A value of the space, not special.
    pub fn plain<T: Scalar>(&self, input: &mut Input) -> T {
        self.at(input.below(self.values) as f64)
    }

    /// The place of a multiple of the unit.
    pub fn at<T: Scalar>(&self, units: f64) -> T {
        T::from_f64(units * self.unit + self.origin)
    }

    /// A length of this many units.
    pub fn length<T: Scalar>(&self, units: f64) -> T {
        T::from_f64(units * self.unit)
    }

    fn coordinate<T: Scalar>(&self, input: &mut Input) -> T {
        if !input.chance(self.special) || self.special == 1 {
            return self.plain(input);
        }
        let most = if T::BYTES == 4 { f64::from(f32::MAX) } else { f64::MAX };
        let least = if T::BYTES == 4 { 1e-45 } else { 5e-324 };
        T::from_f64(input.pick(&[
            f64::INFINITY,
            f64::NEG_INFINITY,
            most,
            -most,
            0.5 * most,
            -0.5 * most,
            0.05 * most,
            least,
            -least,
            0.0,
            -0.0,
            1e6,
        ]))
    }

    /// A valid box: on each axis a point, an interval of one or two units, or any.
    pub fn aabb<const D: usize, T: Scalar>(&self, input: &mut Input) -> Aabb<D, T> {
        let mut aabb = Aabb::new([T::default(); D], [T::default(); D]);
        for axis in 0..D {
            let a: T = self.coordinate(input);
            let b = match input.below(5) {
                0 => a,
                1 | 2 => a + self.length(1.0),
                3 => a + self.length(2.0),
                _ => self.coordinate(input),
            };
            (aabb.min[axis], aabb.max[axis]) = if b < a { (b, a) } else { (a, b) };
        }
        aabb
    }
}
