//! The random numbers behind every scene.

/// A seeded stream of random numbers: SplitMix64 (Steele, Lea and Flood, "Fast splittable
/// pseudorandom number generators", OOPSLA 2014). Any seed is as good as another.
#[derive(Clone, Debug)]
pub struct Random {
    state: u64,
}

impl Random {
    /// The stream of a seed.
    pub const fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The next 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in `0.0 .. 1.0`, a multiple of 2^-53.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in `0 .. bound`; 0 if the bound is 0. The bias is below `bound` / 2^64.
    pub fn below(&mut self, bound: usize) -> usize {
        ((u128::from(self.bits()) * bound as u128) >> 64) as usize
    }

    /// A standard normal deviate, by Marsaglia's polar method (Marsaglia and Bray, 1964).
    pub fn normal(&mut self) -> f64 {
        loop {
            let (x, y) = (2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0);
            let square = x * x + y * y;
            if square > 0.0 && square < 1.0 {
                return x * (-2.0 * libm::log(square) / square).sqrt();
            }
        }
    }

    /// A Lomax (Pareto II) deviate, at least 0, with density `shape / (1 + x)^(shape + 1)`.
    pub fn pareto(&mut self, shape: f64) -> f64 {
        libm::pow(1.0 - self.unit(), -1.0 / shape) - 1.0
    }

    /// A point of the unit cube, each coordinate in `0.0 .. 1.0`.
    pub fn point<const D: usize>(&mut self) -> [f64; D] {
        core::array::from_fn(|_| self.unit())
    }

    /// Puts items in random order (Fisher and Yates).
    pub fn shuffle<I>(&mut self, items: &mut [I]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first outputs for seed 1234567 of the authors' reference implementation.
    #[test]
    fn the_generator_is_splitmix64() {
        let mut random = Random::new(1_234_567);
        let expected = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
            4_593_380_528_125_082_431,
            16_408_922_859_458_223_821,
        ];
        assert_eq!(expected, core::array::from_fn(|_| random.bits()));
    }

    #[test]
    fn deviates_have_the_moments_of_their_distributions() {
        let mut random = Random::new(1);
        let n = 20_000;
        let mut mean_of = |draw: fn(&mut Random) -> f64| {
            (0..n).map(|_| draw(&mut random)).sum::<f64>() / n as f64
        };
        let near = |value: f64, expected: f64| (value - expected).abs() < 0.03;
        assert!(near(mean_of(Random::unit), 0.5));
        assert!(near(mean_of(|r| r.below(7) as f64 / 6.0), 0.5));
        assert!(near(mean_of(Random::normal), 0.0));
        assert!(near(mean_of(|r| r.normal().powi(2)), 1.0));
        assert!(near(mean_of(|r| r.pareto(2.5).min(40.0)), 2.0 / 3.0));
    }

    #[test]
    fn below_gives_every_number_under_its_limit() {
        let mut random = Random::new(3);
        let mut seen = [false; 5];
        (0..200).for_each(|_| seen[random.below(5)] = true);
        assert_eq!(seen, [true; 5]);
        assert_eq!(random.below(0), 0);
    }
}
