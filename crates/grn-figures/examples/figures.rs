//! Draws every kind of figure from made-up data: `cargo run --example figures -- DIRECTORY`.

use grn_figures::*;
use grn_optimisers::knee::Knee;
use grn_optimisers::statistics::{quartiles, wilson};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let directory = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("figures"), PathBuf::from);
    std::fs::create_dir_all(&directory)?;
    let reference = Reference { f2: 0.01339, label: "perfect circle 0.01339".into() };
    save(&directory, "pareto", pareto(&population(), "", Some(&reference))?)?;
    let narrow: Vec<ParetoPoint> = population().into_iter().filter(|p| p.f2 < 0.06).collect();
    save(&directory, "pareto-linear", pareto(&narrow, "Compound channel", None)?)?;
    save(&directory, "tree", tree(&nand_xnor()))?;
    save(&directory, "tree-large", tree(&full(4)))?;
    save(&directory, "grn", grn(&two_genes())?)?;
    save(&directory, "grn-three", grn(&three_genes())?)?;
    save(&directory, "grn-eh", grn(&eh_grn())?)?;
    save(&directory, "pattern-one", pattern(&channel(9, 1, false))?)?;
    save(&directory, "pattern-leak", pattern(&channel(15, 2, false))?)?;
    save(&directory, "pattern-windows", pattern(&channel(25, 1, true))?)?;
    save(&directory, "trace", trace(&run(&[3.0], 4.0))?)?;
    let mut square = run(&[3.0], 3.0);
    square.window = Window { min: [0.0, 0.0], max: [20.0, 20.0] };
    save(&directory, "trace-square", trace(&square)?)?;
    save(&directory, "trace-two", trace(&run(&[2.5, 4.5], 5.0))?)?;
    save_pages(&directory, "boxes", boxes(&campaign(6, &METHODS))?)?;
    save_pages(&directory, "boxes-one", boxes(&campaign(1, &METHODS[..4]))?)?;
    save_pages(&directory, "boxes-many", boxes(&campaign(1, &[METHODS, METHODS].concat()))?)?;
    let long = ["Differential evolution", "Reimplementation", "CMA-ES"];
    save_pages(&directory, "boxes-upright", boxes(&campaign(1, &long.repeat(4)))?)?;
    save_pages(&directory, "convergence", convergence(&histories(3, &METHODS))?)?;
    save_pages(&directory, "convergence-one", convergence(&histories(1, &METHODS[..3]))?)?;
    save_pages(&directory, "rates", rates(&successes(3, &METHODS))?)?;
    save_pages(&directory, "rates-one", rates(&successes(1, &METHODS[..3]))?)?;
    Ok(())
}

fn save(directory: &Path, name: &str, svg: String) -> std::io::Result<()> {
    std::fs::write(directory.join(name).with_extension("svg"), svg)
}

fn save_pages(directory: &Path, name: &str, pages: Vec<String>) -> std::io::Result<()> {
    for (page, svg) in pages.into_iter().enumerate() {
        save(directory, &if page == 0 { name.to_owned() } else { format!("{name}-{}", page + 1) }, svg)?;
    }
    Ok(())
}

/// Numbers from 0 to 1 that look random and are the same every time.
fn noise(seed: u64) -> f64 {
    let mut z = seed.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    ((z ^ (z >> 27)) >> 11) as f64 / (1_u64 << 53) as f64
}

const NONE: Knee = Knee { angle: false, utility: false, parsimony: false };
const ANGLE: Knee = Knee { angle: true, utility: false, parsimony: false };
const BOTH: Knee = Knee { angle: true, utility: true, parsimony: false };

fn point(nodes: u32, f2: f64, feasible: bool, knee: Knee, label: &str) -> ParetoPoint {
    ParetoPoint { nodes, f2, feasible, knee, label: label.into() }
}

fn population() -> Vec<ParetoPoint> {
    let mut points = vec![
        point(3, 0.512, true, NONE, "(XNOR x1 x2)"),
        point(5, 0.0164, true, BOTH, "(XNOR (NAND x1 x1) x2)"),
        point(7, 0.0149, true, ANGLE, "(XNOR (ANDN x1 x2) (NAND x2 x1))"),
        point(11, 0.0143, true, NONE, "…"),
        point(13, 0.01412, true, NONE, "…"),
    ];
    for i in 0..30 {
        let nodes = 3 + 2 * (noise(i) * 6.5) as u32;
        let f2 = 0.02 * libm::exp(3.2 * noise(100 + i));
        points.push(point(nodes, f2, noise(200 + i) > 0.3, NONE, ""));
    }
    points
}

fn leaf(label: &str) -> SyntaxTree {
    SyntaxTree { label: label.into(), detail: None, children: vec![] }
}

fn motif(label: &str, theta: f64, children: Vec<SyntaxTree>) -> SyntaxTree {
    SyntaxTree { label: label.into(), detail: Some(format!("θ = {theta:.4}")), children }
}

fn nand_xnor() -> SyntaxTree {
    motif("XNOR", 0.9256, vec![motif("NAND", 0.8393, vec![leaf("x1"), leaf("x1")]), leaf("x2")])
}

fn full(depth: usize) -> SyntaxTree {
    match depth {
        0 => leaf("x1"),
        1 => motif("ANDN", 1.7312, vec![leaf("x1"), leaf("x2")]),
        3 => motif("NOR", 0.1, vec![full(2), motif("POS", 0.5, vec![leaf("x2")])]),
        _ => motif("XOR", 0.25 * depth as f64, vec![full(depth - 1), full(depth - 2)]),
    }
}

fn gene(name: &str, motif: &str, theta: f64, inputs: &[(Source, bool)]) -> Gene {
    let inputs = inputs.iter().map(|&(source, activates)| Input { source, activates }).collect();
    Gene { name: name.into(), motif: motif.into(), theta, inputs }
}

use Source::{Gene as G, X1, X2};

fn two_genes() -> Vec<Gene> {
    vec![
        gene("y1", "NAND", 0.8393, &[(X1, false), (X1, false)]),
        gene("M", "XNOR", 0.9256, &[(G(0), false), (X2, false)]),
    ]
}

fn three_genes() -> Vec<Gene> {
    vec![
        gene("G1", "ANDN", 1.2, &[(X1, true), (X2, false)]),
        gene("G2", "NAND", 0.3, &[(X1, false), (X2, false)]),
        gene("G3", "XNOR", 0.7, &[(G(0), true), (G(1), false)]),
        gene("G4", "AND", 0.7, &[(G(2), true), (X1, true)]),
    ]
}

fn eh_grn() -> Vec<Gene> {
    vec![
        gene("y1", "NEG", 0.91, &[(X1, false)]),
        gene("y2", "NEG", 0.44, &[(X2, false)]),
        gene("g1", "AND", 0.12, &[(G(0), true), (G(1), true)]),
        gene("y3", "POS", 1.2, &[(X1, true)]),
        gene("y4", "POS", 1.9, &[(X2, true)]),
        gene("g2", "OR", 0.3, &[(G(3), true), (G(4), true)]),
        gene("y5", "POS", 0.5, &[(X1, true)]),
        gene("y6", "POS", 0.05, &[(X2, true)]),
        gene("g3", "AND", 0.33, &[(G(6), true), (G(7), true)]),
        gene("y7", "NEG", 1.72, &[(G(2), false)]),
        gene("y8", "POS", 1.02, &[(G(5), true)]),
        gene("y9", "POS", 0.71, &[(G(8), true)]),
        gene("M", "OR", 1.44, &[(G(9), true), (G(10), true), (G(11), true)]),
    ]
}

fn walls() -> Vec<Vec<[f64; 2]>> {
    vec![
        vec![[6.0, 14.0], [14.0, 14.0], [14.0, 20.0], [6.0, 20.0]],
        vec![[6.0, 0.0], [14.0, 0.0], [14.0, 6.0], [6.0, 6.0]],
    ]
}

fn ring(middle: [f64; 2], radius: f64, stretch: f64) -> Vec<[f64; 2]> {
    let at = |i: i32| {
        let angle = f64::from(i) * TAU / 72.0;
        [middle[0] + radius * stretch * libm::cos(angle), middle[1] + radius * libm::sin(angle)]
    };
    (0..72).map(at).collect()
}

fn channel(count: usize, targets: usize, windows: bool) -> PatternFigure {
    let panel = |i: usize| {
        let share = i as f64 / (count - 1) as f64;
        let positions: Vec<[f64; 2]> =
            (0..targets).map(|j| [2.5 + j as f64 + share * (15.0 - 6.0 * j as f64), 10.0]).collect();
        let leaks = targets > 1 && (4..9).contains(&i);
        let middle = [positions.iter().map(|p| p[0]).sum::<f64>() / targets as f64, 10.0];
        let spread = (positions[0][0] - middle[0]).abs();
        let contours = match (leaks, spread < 1.5) {
            (true, _) => vec![],
            (_, true) => vec![ring(middle, 1.7, 1.0 + spread * 0.6)],
            _ => positions.iter().map(|p| ring(*p, 1.7, 1.0)).collect(),
        };
        let outline = |side: f64| (0..40).map(move |k| [6.0 + 0.2 * f64::from(k), 10.0 + side]).collect();
        Panel {
            title: format!("t = {} s", 5 * i),
            window: windows.then(|| {
                let half = if i.is_multiple_of(2) { 4.0 } else { 5.0 };
                Window { min: [middle[0] - half, 10.0 - half], max: [middle[0] + half, 10.0 + half] }
            }),
            walls: walls(),
            targets: positions.iter().map(|&position| Target { position, enclosed: !leaks }).collect(),
            candidates: contours.iter().flat_map(|c| c.iter().copied().step_by(3)).collect(),
            contours,
            leak_outlines: if leaks { vec![outline(-3.6), outline(3.6)] } else { vec![] },
        }
    };
    PatternFigure {
        region: Window { min: [0.0, 0.0], max: [20.0, 20.0] },
        paths: vec![vec![[2.5, 10.0], [17.5, 10.0]]],
        panels: (0..count).map(panel).collect(),
        columns: None,
    }
}

fn run(starts: &[f64], instants: f64) -> TraceFigure {
    let seconds = 120.0;
    let target = |j: usize, t: f64| [starts[j] + t / seconds * (14.0 - 5.0 * j as f64), 10.0];
    let robots = 8 * starts.len() as u64;
    let place = |i: u64, t: f64| {
        let j = (i / 8) as usize;
        let settle = libm::exp(-t / 8.0);
        let angle = (i % 8) as f64 * TAU / 8.0 + t * 0.02 + settle * noise(i) * 2.0;
        let radius = 1.6 + settle * 1.2 * noise(50 + i) + 0.05 * libm::sin(t * 0.7 + i as f64);
        let middle = target(j, t);
        [middle[0] + radius * libm::cos(angle), middle[1] + radius * libm::sin(angle)]
    };
    let instant = |k: i32| {
        let t = f64::from(k) * seconds / instants;
        let pose = |i| {
            let (p, q) = (place(i, t), place(i, t + 0.1));
            Pose { position: p, heading: libm::atan2(q[1] - p[1], q[0] - p[0]), in_service: i != 3 || k < 2 }
        };
        Instant {
            time: t,
            robots: (0..robots).map(pose).collect(),
            targets: (0..starts.len()).map(|j| target(j, t)).collect(),
            contours: (0..starts.len()).map(|j| ring(target(j, t), 1.6, 1.0)).collect(),
            walls: Vec::new(),
        }
    };
    let times: Vec<f64> = (0..=240).map(|i| f64::from(i) * 0.5).collect();
    let gap = |j: usize| {
        let value = |(i, t): (usize, &f64)| {
            Some(62.0 + 210.0 * libm::exp(-t / (7.0 + j as f64 * 4.0)) + 9.0 * noise((i + 1000 * j) as u64))
        };
        times.iter().enumerate().map(value).collect::<Vec<_>>()
    };
    let error = |(i, t): (usize, &f64)| Some(0.9 * libm::exp(-t / 9.0) + 0.05 + 0.03 * noise(7000 + i as u64));
    TraceFigure {
        window: Window { min: [0.0, 4.5], max: [20.0, 15.5] },
        walls: walls(),
        target_paths: (0..starts.len()).map(|j| vec![target(j, 0.0), target(j, seconds)]).collect(),
        trajectories: (0..robots).map(|i| times.iter().map(|t| place(i, *t)).collect()).collect(),
        body_radius: 0.035,
        instants: (0..=instants as i32).map(instant).collect(),
        faults: vec![Fault { time: 50.0, position: place(3, 50.0) }],
        gaps: (0..starts.len()).map(gap).collect(),
        radial_error: times.iter().enumerate().map(error).collect(),
        radial_band: Some(0.16),
        times,
    }
}

const METHODS: [&str; 5] =
    ["MOGP, all motifs", "MOGP, no XNOR", "EH-GRN, structure 1", "EH-GRN, structure 2", "Random search"];
const SCENARIOS: [&str; 6] =
    ["Narrow channel", "Compound channel", "Two targets", "Obstacle field", "Moving target", "Open field"];

fn campaign(panels: usize, methods: &[&str]) -> BoxFigure {
    let group = |i: usize, j: usize| {
        let run = |k: usize| {
            let at = (1000 * i + 40 * j + k) as u64;
            let tail = if noise(at + 7000) > 0.93 { 3.0 } else { 1.0 };
            let value = 0.0135 + 0.002 * (1.0 + j as f64) * tail * noise(at) * libm::pow(4.0, (i % 3) as f64);
            (noise(at + 9000) > 0.08 * (i * j % 5) as f64).then_some(value)
        };
        BoxGroup { label: methods[j].into(), values: (0..30).map(run).collect() }
    };
    let panel = |i: usize| BoxPanel {
        title: SCENARIOS[i].into(),
        groups: (0..methods.len()).map(|j| group(i + usize::from(panels == 1), j)).collect(),
    };
    BoxFigure { panels: (0..panels).map(panel).collect(), y_label: "f2 of the best model".into() }
}

fn histories(panels: usize, methods: &[&str]) -> ConvergenceFigure {
    let series = |i: usize, j: usize| {
        let point = |k: u64| {
            let runs = |run: u64| {
                let pace = 8.0 + 6.0 * j as f64 + 12.0 * noise(run + 100 * j as u64);
                let start = 0.6 + 0.4 * noise(run + 50);
                0.0135 + 0.004 * j as f64 * noise(run) + start * libm::exp(-(k as f64) / pace) / (1.0 + i as f64 * 20.0)
            };
            Some((2500 * k, quartiles(&(0..30).map(runs).collect::<Vec<f64>>())?))
        };
        ConvergenceSeries { label: methods[j].into(), points: (1..=80).filter_map(point).collect() }
    };
    let panel = |i: usize| ConvergencePanel {
        title: SCENARIOS[i].into(),
        series: (0..methods.len()).map(|j| series(i, j)).collect(),
    };
    ConvergenceFigure { panels: (0..panels).map(panel).collect(), y_label: "f2 of the best model".into() }
}

fn successes(groups: usize, methods: &[&str]) -> RatesFigure {
    let row = |i: usize, j: usize| {
        let count = (30.0 * noise((10 * i + j) as u64).max(0.2 * (4 - j) as f64)) as usize;
        RateRow { label: methods[j].into(), successes: count as u64, trials: 30, interval: Some(wilson(count, 30)) }
    };
    let group = |i: usize| RateGroup {
        title: if groups > 1 { SCENARIOS[i].into() } else { String::new() },
        rows: (0..methods.len()).map(|j| row(i, j)).collect(),
    };
    RatesFigure { groups: (0..groups).map(group).collect(), x_label: "Closed-loop runs without a gap (%)".into() }
}
