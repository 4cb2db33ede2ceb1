//! scratch
#![allow(missing_docs, clippy::unwrap_used)]
use firmware_sim::scenario::Scenario;
use host_evolver::objective::*;
use host_evolver::published::PUBLISHED;
fn main() {
    for sc in ["channel", "compound-channel"] {
        let world = World::new(Scenario::load(format!("scenarios/{sc}.toml")).unwrap());
        for p in &PUBLISHED {
            let m = Model::new(&p.network().unwrap(), 0.5).unwrap();
            let mut j = Judge::new(&world);
            let e = j.judge(&m);
            let t = std::time::Instant::now();
            let n = 200;
            for _ in 0..n {
                std::hint::black_box(j.judge(&m));
            }
            let dt = t.elapsed() / n;
            let mut tr = Tracer::new(&world);
            let t = std::time::Instant::now();
            for _ in 0..n {
                for x in tr.trace_all(&m) {
                    std::hint::black_box(x);
                }
            }
            let dt2 = t.elapsed() / n;
            println!("{sc} {} {:?} {:?} trace {:?}", p.name, e, dt, dt2);
        }
    }
}
