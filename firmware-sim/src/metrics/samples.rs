//! Sums over many samples, in bounded memory.

/// A mean.
#[derive(Clone, Debug, Default)]
pub(super) struct Mean {
    sum: f64,
    count: u64,
}

impl Mean {
    pub fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    pub fn get(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }
}

/// Distances as a histogram in tenths of millimetres: long runs have millions of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Errors {
    bins: Vec<u64>,
    unknown: u64,
    count: u64,
}

impl Errors {
    const BIN: f64 = 1e-4;
    /// Everything beyond 100 m is counted there.
    const MAX: usize = 1_000_000;

    pub fn add(&mut self, distance: Option<f64>) {
        self.count += 1;
        let Some(distance) = distance else {
            self.unknown += 1;
            return;
        };
        let bin = ((distance.abs() / Self::BIN) as usize).min(Self::MAX);
        if bin >= self.bins.len() {
            self.bins.resize(bin + 1, 0);
        }
        self.bins[bin] += 1;
    }

    pub fn unknown_share(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.unknown as f64 / self.count as f64 }
    }

    /// The middle of the bin that holds the nearest-rank percentile, metres; `None` if that is an unknown distance.
    pub fn percentile(&self, percent: u64) -> Option<f64> {
        let rank = (self.count * percent).div_ceil(100).max(1);
        let mut passed = 0;
        self.bins
            .iter()
            .position(|&count| {
                passed += count;
                passed >= rank
            })
            .map(|bin| (bin as f64 + 0.5) * Self::BIN)
    }

    /// Forgets everything but the space.
    pub fn clear(&mut self) {
        self.bins.clear();
        (self.unknown, self.count) = (0, 0);
    }
}
