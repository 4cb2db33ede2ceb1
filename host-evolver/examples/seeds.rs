//! scratch
#![allow(missing_docs, clippy::unwrap_used)]
use firmware_sim::scenario::Scenario;
use host_evolver::evolve::*;
use host_evolver::objective::World;
use host_evolver::variation::MotifSet;
use std::sync::atomic::AtomicBool;
fn main() {
    let t = std::time::Instant::now();
    let a: Vec<String> = std::env::args().collect();
    let world = World::new(Scenario::load(&a[1]).unwrap());
    println!("world {:?}", t.elapsed());
    let motifs = if a.len() > 2 && a[2] == "binary" { MotifSet::Binary } else { MotifSet::All };
    let mut best = vec![];
    let mut times = vec![];
    let n: u64 = std::env::var("N").map_or(30, |v| v.parse().unwrap());
    for seed in 1..=n {
        let t = std::time::Instant::now();
        let mut s = Search::new(&world, Settings { seed, motifs, ..Settings::default() }, None).unwrap();
        let go = AtomicBool::new(false);
        while s.advance(&go, &|_| {}) == Advance::Generation {}
        let f = s.front();
        times.push(t.elapsed().as_secs_f64());
        let b = s.state().history.last().unwrap().best_f2.unwrap_or(9.0);
        best.push(b);
        let k = f.iter().find(|m| m.knee.utility).unwrap();
        println!(
            "{seed} {b:.5} n={} smallest {} knee {} {:.5} {} viol {} | angle {}",
            f.len(),
            f[0].individual.tree.size(),
            k.individual.tree.size(),
            k.individual.f2,
            k.individual.tree,
            k.individual.violation,
            f.iter().find(|m| m.knee.angle).unwrap().individual.tree.size()
        );
    }
    best.sort_by(f64::total_cmp);
    times.sort_by(f64::total_cmp);
    println!(
        "median {:.5} min {:.5} max {:.5}; time median {:.3}",
        best[best.len() / 2],
        best[0],
        best[best.len() - 1],
        times[times.len() / 2]
    );
}
