//! Random numbers and random models, from a generator of a few lines that is the same everywhere.

use grn_core::blob::{Blob, FieldParameters, Gains};
use grn_core::bounded::filled;
use grn_core::dynamics::Step;
use grn_core::field::Kernel;
use grn_core::motif::Motif;
use grn_core::network::{DEFAULT_GENES, Gene, Network, Source};

/// SplitMix64 (Steele, Lea and Flood 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The stream of this seed.
    pub fn new(seed: u32) -> Self {
        Random(u64::from(seed) << 32)
    }

    /// 32 random bits.
    pub fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 32) as u32
    }

    /// One of the numbers from 0 to `count` - 1, about evenly.
    pub fn below(&mut self, count: u32) -> u32 {
        ((u64::from(self.bits()) * u64::from(count)) >> 32) as u32
    }

    /// One of the numbers from `low` to `high`, both included.
    pub fn between(&mut self, low: i32, high: i32) -> i32 {
        low.wrapping_add(self.below(high.abs_diff(low).wrapping_add(1)).cast_signed())
    }

    /// True with probability 1 / `times`.
    pub fn once_in(&mut self, times: u32) -> bool {
        self.below(times) == 0
    }

    /// A number in [0, 1), a multiple of 2^-24.
    pub fn fraction(&mut self) -> f32 {
        (self.bits() >> 8) as f32 / 16_777_216.0
    }
}

/// A random model: one to 32 genes of all motifs, most of them with the paper's steepness, in worlds of a tenth to half
/// the paper's scale. `None` if it is not valid, which it always is.
pub fn blob(seed: u32) -> Option<Blob> {
    let mut random = Random::new(seed);
    let steepness = if random.once_in(3) { 0.25 + 4.0 * random.fraction() } else { 1.0 };
    let most = if random.once_in(4) { DEFAULT_GENES as u32 } else { 8 };
    let count = 1 + random.below(most);
    let network = Network::new(steepness, (0..count).map(|index| gene(index, &mut random))).ok()?;
    let exponent = 3 + random.below(5) as u8;
    // Now and then half a step a tick, which a controller refuses.
    let steps = if random.once_in(20) { 0.5 } else { f32::from(1_u8 << random.below(5)) };
    Some(Blob {
        network,
        field: FieldParameters {
            kernel: if random.once_in(3) { Kernel::Exponential } else { Kernel::Gaussian },
            target_width: 0.5 + 2.0 * random.fraction(),
            obstacle_width: 0.5 + random.fraction(),
        },
        level_fraction: if random.once_in(2) { 0.5 } else { 0.1 + 0.8 * random.fraction() },
        scale: 0.1 + 0.4 * random.fraction(),
        step: Step::from_exponent(exponent).ok()?,
        time_scale: steps * 32.0 / f32::from(1_u16 << exponent),
        gains: Gains { drive: 2.0 * random.fraction(), ..Gains::default() },
    })
}

fn gene(index: u32, random: &mut Random) -> Gene<f32> {
    let motif = Motif::from_code(1 + random.below(Motif::ALL.len() as u32) as u8).unwrap_or(Motif::Pos);
    let arity = motif.arity();
    let inputs = random.between(*arity.start() as i32, *arity.end() as i32);
    Gene {
        motif,
        inputs: filled((0..inputs).map(|_| Source::from_code(random.below(index + 2) as u8))),
        theta: 2.0 * random.fraction(),
    }
}
