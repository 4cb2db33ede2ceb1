//! scratch
#![allow(missing_docs, clippy::unwrap_used)]
use host_evolver::objective::*;
use host_evolver::published::PUBLISHED;
fn main() {
    let p = &PUBLISHED[0];
    let m = Model::new(&p.network().unwrap(), 0.5).unwrap();
    let t = std::time::Instant::now();
    let mut s = 0.0;
    let n = 2_000_000;
    for i in 0..n {
        s += m.error(i as f64 * 5e-7, 0.1);
    }
    let dt = t.elapsed();
    println!("M {:?} {s}", dt / n);
    let t = std::time::Instant::now();
    let mut s = 0.0;
    for i in 0..n {
        s += libm::exp(i as f64 * 5e-7);
    }
    println!("exp {:?} {s}", t.elapsed() / n);
    let t = std::time::Instant::now();
    let mut s = 0.0;
    for i in 0..n {
        s += libm::sqrt(i as f64 * 5e-7);
    }
    println!("sqrt {:?} {s}", t.elapsed() / n);
}
