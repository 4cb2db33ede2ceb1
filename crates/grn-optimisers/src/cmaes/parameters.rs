//! The tutorial's default strategy parameters (its Table 1, second version of the text): functions of the dimension
//! n and the population λ.
//!
//! One differs. The tutorial damps the step size by `d_σ = 1 + 2 max(0, √((µ_eff - 1) / (n + 1)) - 1) + c_σ`, which is
//! little for populations that are large for the dimension: the step shrinks on what a single generation says, and more
//! runs end in a local optimum. pycma 4.5.0 (`CMAAdaptSigmaCSA.compute_damps` in `cma/sigma_adaptation.py`, after its
//! issue 231) multiplies the root by `max(1, 3 (1 - 2^(-n / 9)))`, and so do we. Where the root is small, as for the
//! default population, the two are the same.

/// Recombination weights, learning rates and damping.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Parameters {
    /// One weight a rank, best first: the first half positive with sum 1, the others at most 0 (eq. 53).
    pub weights: Vec<f64>,
    /// The variance-effective selection mass µ_eff of the positive weights, at least 1 (eq. 8).
    pub mu_eff: f64,
    /// c_σ, the learning rate of the step size's path (eq. 55).
    pub c_sigma: f64,
    /// d_σ, the damping of the step size (eq. 55 with pycma's factor).
    pub d_sigma: f64,
    /// c_c, the learning rate of the covariance's path (eq. 56).
    pub c_c: f64,
    /// c_1, the learning rate of the rank-one update (eq. 57).
    pub c_1: f64,
    /// c_µ, the learning rate of the rank-µ update (eq. 58).
    pub c_mu: f64,
    /// E‖N(0, I)‖, the expected length of a standard normal vector.
    pub chi: f64,
    /// Generations from one eigen-decomposition to the next, at least 1 (appendix B.2).
    pub gap: usize,
}

impl Parameters {
    /// For `dimension` of at least 1 and `population` of at least 4; unless `active`, no weight is below 0.
    pub fn new(dimension: usize, population: usize, active: bool) -> Self {
        let (n, lambda) = (dimension as f64, population as f64);
        // Eq. 49.
        let raw: Vec<f64> = (1..=population).map(|i| libm::log((lambda + 1.0) / 2.0) - libm::log(i as f64)).collect();
        let (positive, negative) = raw.split_at(population / 2);
        let sum = |weights: &[f64]| weights.iter().sum::<f64>();
        let mass = |weights: &[f64]| sum(weights) * sum(weights) / weights.iter().map(|w| w * w).sum::<f64>();
        let (mu_eff, mu_eff_negative) = (mass(positive), mass(negative));

        let c_sigma = (mu_eff + 2.0) / (n + mu_eff + 5.0);
        let strictness = (3.0 * (1.0 - libm::exp2(-n / 9.0))).max(1.0);
        let d_sigma = 1.0 + 2.0 * (strictness * ((mu_eff - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_sigma;
        let c_c = (4.0 + mu_eff / n) / (n + 4.0 + 2.0 * mu_eff / n);
        let c_1 = 2.0 / ((n + 1.3) * (n + 1.3) + mu_eff);
        let c_mu = 2.0 * (0.25 + mu_eff + 1.0 / mu_eff - 2.0) / ((n + 2.0) * (n + 2.0) + mu_eff);
        let c_mu = c_mu.min(1.0 - c_1);

        // Eqs. 50 to 53: how much the negative weights may weigh, in units in which the positive ones weigh 1.
        let most =
            (1.0 + c_1 / c_mu).min(1.0 + 2.0 * mu_eff_negative / (mu_eff + 2.0)).min((1.0 - c_1 - c_mu) / (n * c_mu));
        let negative_scale = if active { most / -sum(negative) } else { 0.0 };
        let (better, worse) = (positive.iter().map(|w| w / sum(positive)), negative.iter().map(|w| w * negative_scale));
        let weights = better.chain(worse).collect();

        let chi = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        let gap = (1.0 / (10.0 * n * (c_1 + c_mu))).max(1.0) as usize;
        Self { weights, mu_eff, c_sigma, d_sigma, c_c, c_1, c_mu, chi, gap }
    }
}
