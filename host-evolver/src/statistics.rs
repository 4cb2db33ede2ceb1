//! stub
pub struct Quartiles {
    pub lower: f64,
    pub median: f64,
    pub upper: f64,
}
pub fn quartiles(v: &[f64]) -> Option<Quartiles> {
    let mut v = v.to_vec();
    v.sort_by(f64::total_cmp);
    let n = v.len();
    (n > 0).then(|| Quartiles { lower: v[n / 4], median: v[n / 2], upper: v[3 * n / 4] })
}
pub fn mann_whitney(_: &[f64], _: &[f64]) -> Option<f64> {
    Some(0.5)
}
pub fn a12(a: &[f64], b: &[f64]) -> f64 {
    let mut s = 0.0;
    for x in a {
        for y in b {
            if x < y {
                s += 1.0
            } else if x == y {
                s += 0.5
            }
        }
    }
    s / (a.len() * b.len()) as f64
}
pub fn holm(p: &[f64]) -> Vec<f64> {
    p.to_vec()
}
pub fn wilson(s: usize, t: usize) -> (f64, f64) {
    (s as f64 / t as f64, s as f64 / t as f64)
}
pub fn bootstrap_rate(_: &[Vec<bool>]) -> (f64, f64) {
    (0.0, 1.0)
}
