//! Every figure is drawn from odd but legal data: names of any length and script, no data or many, equal and extreme
//! numbers. A figure that fails would lose the work of the run that asked for it.

use crate::chart::check::read;
use crate::*;
use grn_optimisers::knee::Knee;
use grn_optimisers::statistics::quartiles;
use proptest::collection::vec;
use proptest::prelude::*;

fn name() -> impl Strategy<Value = String> {
    prop_oneof![
        Just(String::new()),
        "[a-zA-Z0-9 ,_<>&\"'-]{1,30}",
        "\\PC{1,12}",
        Just("long name ".repeat(30)),
        Just("Donaudampfschifffahrt".repeat(12)),
        Just("障害物のある通路".repeat(9)),
        Just("tab\tline\nnull\0".to_owned()),
    ]
}

/// f2, counts and the like: nothing, equal, tiny and large.
fn value() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(1.0), Just(1e-12), 0.0..2.0, 0.0..1000.0]
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), -1e-6..1e-6, -100.0..100.0, Just(1e6), Just(-1e8)]
}

fn at() -> impl Strategy<Value = [f64; 2]> {
    [coordinate(), coordinate()]
}

fn lines() -> impl Strategy<Value = Vec<Vec<[f64; 2]>>> {
    vec(vec(at(), 0..5), 0..4)
}

fn window() -> impl Strategy<Value = Window> {
    let size = || prop_oneof![Just(0.001), 0.01..100.0, Just(1e6)];
    (at(), size(), size()).prop_map(|(min, w, h)| Window { min, max: [min[0] + w, min[1] + h] })
}

fn knee() -> impl Strategy<Value = Knee> {
    (any::<bool>(), any::<bool>(), any::<bool>()).prop_map(|(angle, utility, parsimony)| Knee {
        angle,
        utility,
        parsimony,
    })
}

fn pages(drawn: Result<Vec<String>, FigureError>) {
    let pages = drawn.unwrap();
    assert!(!pages.is_empty());
    for page in pages {
        read(&page);
    }
}

/// Lines, each of points.
type Lines = Vec<Vec<[f64; 2]>>;
/// What a gene reads, and whether it activates.
type Reads = Vec<(usize, bool)>;

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn any_front_is_drawn(
        points in vec((1_u32..=300, value(), any::<bool>(), knee(), name()), 0..40),
        title in name(),
        reference in proptest::option::of((value(), name())),
    ) {
        let points: Vec<ParetoPoint> = points
            .into_iter()
            .map(|(nodes, f2, feasible, knee, label)| ParetoPoint { nodes, f2, feasible, knee, label })
            .collect();
        let reference = reference.map(|(f2, label)| Reference { f2, label });
        read(&pareto(&points, &title, reference.as_ref()).unwrap());
    }

    #[test]
    fn any_campaign_is_drawn(
        panels in vec((name(), vec((name(), vec(proptest::option::of(value()), 0..12)), 0..30)), 0..30),
        y_label in name(),
    ) {
        let group = |(label, values)| BoxGroup { label, values };
        let panel = |(title, groups): (String, Vec<_>)| BoxPanel { title, groups: groups.into_iter().map(group).collect() };
        pages(boxes(&BoxFigure { panels: panels.into_iter().map(panel).collect(), y_label }));
    }

    #[test]
    fn any_history_is_drawn(
        panels in vec((name(), vec((name(), vec((0_u64..4000, vec(value(), 1..5)), 0..6)), 0..12)), 0..15),
        y_label in name(),
    ) {
        let series = |(label, mut points): (String, Vec<(u64, Vec<f64>)>)| {
            points.sort_by_key(|point| point.0);
            let points = points.into_iter().filter_map(|(n, values)| Some((n, quartiles(&values)?))).collect();
            ConvergenceSeries { label, points }
        };
        let panel = |(title, all): (String, Vec<_>)| ConvergencePanel { title, series: all.into_iter().map(series).collect() };
        pages(convergence(&ConvergenceFigure { panels: panels.into_iter().map(panel).collect(), y_label }));
    }

    #[test]
    fn any_success_is_drawn(
        groups in vec((name(), vec((name(), 0_u64..40, 0_u64..40, any::<bool>()), 0..60)), 0..10),
        x_label in name(),
    ) {
        let row = |(label, a, b, spread): (String, u64, u64, bool)| {
            let (successes, trials) = (a.min(b), a.max(b));
            let rate = successes as f64 / trials.max(1) as f64;
            RateRow { label, successes, trials, interval: spread.then_some((rate * 0.5, rate.max(0.9))) }
        };
        let group = |(title, rows): (String, Vec<_>)| RateGroup { title, rows: rows.into_iter().map(row).collect() };
        pages(rates(&RatesFigure { groups: groups.into_iter().map(group).collect(), x_label }));
    }

    #[test]
    fn any_pattern_is_drawn(
        region in window(),
        paths in lines(),
        panels in vec((name(), proptest::option::of(window()), lines(), lines(), vec((at(), any::<bool>()), 0..4)), 0..40),
        columns in proptest::option::of(0_usize..9),
    ) {
        let panel = |(title, window, walls, contours, targets): (_, _, _, Lines, Vec<([f64; 2], bool)>)| Panel {
            title,
            window,
            walls,
            targets: targets.into_iter().map(|(position, enclosed)| Target { position, enclosed }).collect(),
            leak_outlines: contours.clone(),
            candidates: contours.iter().flatten().copied().collect(),
            contours,
        };
        let panels = panels.into_iter().map(panel).collect();
        read(&pattern(&PatternFigure { region, paths, panels, columns }).unwrap());
    }

    #[test]
    fn any_run_is_drawn(
        window in window(),
        walls in lines(),
        trajectories in lines(),
        steps in vec((1e-3..1e3, vec(0.0..=360.0, 9), proptest::option::of(value())), 0..30),
        instants in vec((0.0..1e4, vec((at(), -10.0..10.0), 0..5), vec(at(), 0..3), lines()), 0..9),
        targets in 0_usize..9,
        band in proptest::option::of(value()),
        body_radius in value(),
        faults in vec((0.0..1e4, at()), 0..9),
    ) {
        let times = steps.iter().scan(0.0, |time, step| { *time += step.0; Some(*time) }).collect();
        let instant = |(time, robots, targets, contours): (f64, Vec<([f64; 2], f64)>, _, _)| Instant {
            time,
            robots: robots.into_iter().map(|(position, heading)| Pose { position, heading, in_service: heading < 5.0 }).collect(),
            targets,
            contours,
            walls: Vec::new(),
        };
        let figure = TraceFigure {
            window,
            walls,
            target_paths: trajectories.clone(),
            trajectories,
            body_radius,
            instants: instants.into_iter().map(instant).collect(),
            faults: faults.into_iter().map(|(time, position)| Fault { time, position }).collect(),
            times,
            gaps: (0..targets).map(|target| steps.iter().map(|step| Some(step.1[target])).collect()).collect(),
            radial_error: steps.iter().map(|step| step.2).collect(),
            radial_band: band,
        };
        read(&trace(&figure).unwrap());
    }

    #[test]
    fn any_network_is_drawn(genes in vec((name(), name(), 0.0..2.0, vec((0_usize..99, any::<bool>()), 1..5)), 0..40)) {
        let gene = |(index, (name, motif, theta, reads)): (usize, (String, String, f64, Reads))| {
            let source = |from: usize| match from % (index + 2) {
                0 => Source::X1,
                1 => Source::X2,
                other => Source::Gene(other - 2),
            };
            let inputs = reads.into_iter().map(|(from, activates)| Input { source: source(from), activates }).collect();
            Gene { name, motif, theta, inputs }
        };
        read(&grn(&genes.into_iter().enumerate().map(gene).collect::<Vec<_>>()).unwrap());
    }

    #[test]
    fn any_tree_is_drawn(shape in vec((name(), proptest::option::of(name()), 0_usize..5), 1..60)) {
        // Nodes in prefix order; where the list ends, the missing operands are inputs.
        fn build(shape: &mut std::vec::IntoIter<(String, Option<String>, usize)>) -> SyntaxTree {
            match shape.next() {
                Some((label, detail, count)) => {
                    SyntaxTree { label, detail, children: (0..count).map(|_| build(shape)).collect() }
                }
                None => SyntaxTree { label: "x1".into(), detail: None, children: Vec::new() },
            }
        }
        read(&tree(&build(&mut shape.into_iter())));
    }
}
