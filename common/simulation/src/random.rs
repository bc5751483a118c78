use rand::RngExt;
use rand_distr::StandardNormal;
use rand_pcg::Pcg64Mcg;

/// What a generator is for. The numbers are part of what a seed means.
#[derive(Clone, Copy)]
pub(crate) enum Purpose {
    Unit = 1,
    Flexure = 2,
    Wire = 3,
    Ins = 4,
    Sea = 5,
    BiasWander = 6,
    Outlier = 7,
    Impulses = 8,
    Coupling = 9,
    SecondFlexure = 10,
}

/// A random source of its own for every purpose and area, so that drawing more in one never shifts another.
///
/// The algorithm is fixed: PCG XSL-RR 128/64 (MCG), its state made from seed, purpose and index by SplitMix64.
pub(crate) struct Source(Pcg64Mcg);

const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// The output function of SplitMix64: one to one, so no two indices of a seed share a state.
fn mix(z: u64) -> u64 {
    let z = z.wrapping_add(GOLDEN);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

impl Source {
    pub(crate) fn new(seed: u64, purpose: Purpose, index: u64) -> Self {
        let low = mix(mix(mix(seed) ^ purpose as u64) ^ index);
        Self(Pcg64Mcg::new(u128::from(mix(low)) << 64 | u128::from(low)))
    }

    pub(crate) fn normal(&mut self) -> f64 {
        self.0.sample(StandardNormal)
    }

    pub(crate) fn normals(&mut self) -> [f64; 3] {
        [self.normal(), self.normal(), self.normal()]
    }

    /// Uniform on 0 to 1, without 1.
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0.random::<f64>()
    }

    /// True with the probability `p`; draws the same amount whatever `p` is.
    pub(crate) fn happens(&mut self, p: f64) -> bool {
        self.uniform() < p
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;

    #[test]
    fn a_seed_means_the_same_for_ever() {
        let mut source = Source::new(1, Purpose::Flexure, 0);
        let first: [u64; 2] = std::array::from_fn(|_| source.0.next_u64());
        assert_eq!(first, [3_817_208_293_726_893_825, 17_851_819_051_779_218_741]);
    }

    #[test]
    fn no_two_purposes_share_a_stream() {
        use Purpose::*;
        let purposes = [Unit, Flexure, Wire, Ins, Sea, BiasWander, Outlier, Impulses, Coupling, SecondFlexure];
        let mut first: Vec<u64> = (0..20)
            .flat_map(|seed| purposes.iter().flat_map(move |p| (0..5).map(move |i| (seed, *p, i))))
            .map(|(seed, purpose, index)| Source::new(seed, purpose, index).0.next_u64())
            .collect();
        let drawn = first.len();
        first.sort_unstable();
        first.dedup();
        assert_eq!(first.len(), drawn);
    }
}
