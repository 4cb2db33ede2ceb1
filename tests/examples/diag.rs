//! x
#![allow(warnings)]
use firmware_sim::radio::RadioConfig;
use firmware_sim::{Scenario, Stop, SwarmConfig};
use grn_core::blob::Blob;
use grn_core::geometry::{Point, Vector};
use host_evolver::model::{deploy, tree::Tree};
use host_evolver::simulation::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let get = |k: &str| a.iter().position(|x| x == k).map(|i| a[i + 1].clone());
    let sc = Scenario::load(&format!("scenarios/{}.toml", get("--world").unwrap_or("channel".into()))).unwrap();
    let models = get("--models").unwrap_or("nand-xnor;(NOR[1.9995] x1 x1)".into());
    let seeds: u64 = get("--seeds").unwrap_or("5".into()).parse().unwrap();
    let robots: usize = get("--robots").unwrap_or("12".into()).parse().unwrap();
    let dead: usize = get("--dead").unwrap_or("0".into()).parse().unwrap();
    let pairs = get("--pairs").is_some();
    let loss: f64 = get("--loss").unwrap_or("0.1".into()).parse().unwrap();
    let at: u64 = get("--at").unwrap_or("40".into()).parse().unwrap();
    let mut jobs = vec![];
    for model in models.split(';') {
        for number in [Number::F32, Number::Q824] {
            for seed in 1..=seeds {
                jobs.push((model.to_string(), number, seed));
            }
        }
    }
    let (mut tl, mut ts, mut tw, mut tp, mut nw) = (0, 0, 0, 0, 0);
    let next = std::sync::atomic::AtomicUsize::new(0);
    let out = std::sync::Mutex::new(std::collections::BTreeMap::new());
    std::thread::scope(|s| {
        for _ in 0..2 {
            s.spawn(||loop{
  let i=next.fetch_add(1,std::sync::atomic::Ordering::SeqCst); if i>=jobs.len(){break}
  let (model,number,seed)=jobs[i].clone();
  let blob:Blob=if model.starts_with('(') { deploy::blob(model.parse::<Tree>().unwrap().network(1.0).unwrap(), &sc.morphogen(), 0.25) } else {Blob::decode(&std::fs::read(format!("models/{model}.grn")).unwrap()).unwrap()};
  let mut stops=vec![];
  for k in 0..dead { let robot= if pairs { 2+((seed as usize*5+ (k/2)*3)%(robots-3)) + k%2 } else { 1+((seed as usize*5+k*4)%(robots-1)) }; stops.push(Stop{robot, tick:32*at+ if pairs {0} else {k as u64*32*7}}); }
  let cfg=SwarmConfig{robots,seed,scale:f64::from(blob.scale),target_speed_m_per_s:0.03,stops:stops.clone(),radio:RadioConfig{loss,..Default::default()},..SwarmConfig::default()};
  let run=simulate(&blob,&sc,cfg,number,|_|std::ops::ControlFlow::Continue(())).unwrap().unwrap();
  let ruler=PatternRuler::new(&blob,&sc).unwrap();
  let m=&run.metrics;
  let line=format!("{:20} {:?} seed {seed}: enc {:.3} err {:.3} unk {:.3} lost {} strayed {} walls {} peers {} ({:.1}s) works {}",model,number,m.encircled_share.unwrap_or(0.0),run.radial_error_share().unwrap_or(9.0),m.radial_error_unknown_share.unwrap_or(9.0),m.lost_robots,m.strayed_robots,m.wall_contacts,m.peer_contacts,m.peer_contact_s,run.verdict().works());
  // standing: live robot slower than 1 cm in 10 s while target moves
  let frames:Vec<_>=run.trace.frames().collect();
  let p=|q:[i32;2]|Vector::new(f64::from(q[0])*1e-6,f64::from(q[1])*1e-6);
  let mut stand=String::new();
  for r in 0..robots { if stops.iter().any(|s|s.robot==r){continue}
    let mut t=32*15; let mut worst=0; let mut cur=0;
    while t+320<frames.len()-32*2 { let d=(p(frames[t].robots[r].position_um)-p(frames[t+320].robots[r].position_um)).length(); let td=(p(frames[t].targets_um[0])-p(frames[t+320].targets_um[0])).length(); if d<0.03 && td>0.2 {cur+=1; worst=worst.max(cur)} else {cur=0}; t+=32; }
    if worst>0 { stand+=&format!(" r{r}:{}s",worst+9); }
  }
  if let Some(rr)=get("--follow") { let r:usize=rr.parse().unwrap(); let t0:usize=get("--from").unwrap().parse().unwrap(); for t in (t0*32..(t0+30)*32).step_by(8) { let f=&frames[t]; let q=p(f.robots[r].position_um); let tg=p(f.targets_um[0]); let near=(0..robots).filter(|&o|o!=r).map(|o|(((p(f.robots[o].position_um)-q).length()-0.07)*1000.0,o)).min_by(|a,b|a.0.total_cmp(&b.0)).unwrap(); println!("{:.2} pos {:.3} {:.3} head {:?} wheels {:?} to target {:.3} {:.3} near {:.1}mm r{} at {:?}",t as f64/32.0,q.x,q.y,f.robots[r].heading_q14,f.robots[r].wheels,tg.x-q.x,tg.y-q.y,near.0,near.1, f.robots[near.1].position_um); } }
  out.lock().unwrap().insert(i,(line+ if stand.is_empty(){""}else{" STANDS"}+&stand,m.lost_robots,m.strayed_robots,m.wall_contacts,m.peer_contacts,run.verdict().works()));
 });
        }
    });
    for (_, (l, lo, st, w, pc, wk)) in out.into_inner().unwrap() {
        if get("--quiet").is_none() {
            println!("{l}");
        }
        tl += lo;
        ts += st;
        tw += w;
        tp += pc;
        nw += usize::from(!wk);
    }
    println!("TOTAL lost {tl} strayed {ts} walls {tw} peers {tp} not working {nw} of {}", jobs.len());
}
