//! What the `micromath` feature costs in accuracy: the sigmoid against the reference in double precision.
#![cfg(feature = "micromath")]

use grn_core::scalar::{Arithmetic, Scalar};

/// Largest errors measured over [-20, 20] in steps of 10^-4, rounded up; documented in docs/model.md.
const SIGMOID_BOUND: f64 = 6e-4;
const EXPONENTIAL_BOUND: f64 = 1.3e-3;

#[test]
fn errors_stay_within_what_is_documented() {
    let (mut sigmoid, mut exponential) = (0.0_f64, 0.0_f64);
    for i in -200_000..=200_000 {
        let z = f64::from(i) * 1e-4;
        sigmoid = sigmoid.max((f64::from((z as f32).logistic()) - z.logistic()).abs());
        if z >= 0.0 {
            exponential = exponential.max((f64::from((z as f32).exp_neg()) - z.exp_neg()).abs());
        }
    }
    println!("sigmoid off by at most {sigmoid:.2e}, exponential by {exponential:.2e}");
    assert!(sigmoid < SIGMOID_BOUND && exponential < EXPONENTIAL_BOUND, "{sigmoid} {exponential}");
}
