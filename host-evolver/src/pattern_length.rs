//! How long the pattern is in the course of a run, for a base station.

use crate::evaluation::{Contours, LATTICE_STEP, Model, Moment, Tracer, World};
use firmware_sim::base_station::{Circumference, PatternSize};
use firmware_sim::config::SwarmConfig;
use firmware_sim::scenario::{Course, Scenario};
use firmware_sim::swarm::arrival_tick;
use grn_core::blob::Blob;
use grn_core::geometry::Point;
use grn_core::pattern::NoPattern;
use grn_core::robot::epuck2::TICKS_PER_SECOND;

/// Moments at which the pattern is traced; between two of them its length is taken as that of the first.
const MOMENTS: u64 = 48;
/// The most nodes of the lattice times moments, 8 bytes each; a larger world is traced at fewer moments. One whose walls move takes
/// 43 bytes each, so it may have a fifth.
const MOST_NODES: f64 = 2e7;
const MOST_NODES_OF_MOVING_WALLS: f64 = MOST_NODES / 5.0;

/// The circumference of a blob's pattern while the targets of a run move.
///
/// # Errors
/// [`NoPattern`] if the blob's network has none.
pub fn circumference(blob: &Blob, scenario: &Scenario, config: &SwarmConfig) -> Result<Circumference, NoPattern> {
    let model = Model::new(&blob.network, f64::from(blob.level_fraction))?;
    let course = Course::of(&scenario.scaled(config.scale), config);
    let [width, height] = scenario.region();
    let most = if scenario.walls_change() { MOST_NODES_OF_MOVING_WALLS } else { MOST_NODES };
    let most = most * LATTICE_STEP * LATTICE_STEP / (width * height);
    let moments = MOMENTS.min(most as u64).max(1);
    let every = arrival_tick(&course).div_ceil(moments).max(1);
    let moment = |place| {
        let time = course.time_at((place * every) as f64 / f64::from(TICKS_PER_SECOND));
        Moment { targets: scenario.targets_at(time), walls: scenario.walls_at(time) }
    };
    let traced = World::at(scenario.clone(), (0..=moments).map(moment).collect());
    let mut tracer = Tracer::new(&traced);
    let sizes = tracer.trace_all(&model).map(|(_, contours)| size(&contours, config.scale)).collect();
    Ok(Circumference::new(every, sizes))
}

/// `None` unless every target is enclosed.
fn size(contours: &Contours, scale: f64) -> Option<PatternSize> {
    let closed = !contours.rings.is_empty() && contours.enclosed.iter().all(|&enclosed| enclosed);
    closed.then(|| PatternSize {
        circumference_m: contours.rings.iter().map(|ring| length(ring)).sum::<f64>() * scale,
        rings: contours.rings.len(),
    })
}

fn length(ring: &[Point<f64>]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(&a, &b)| (b - a).length()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::published::PUBLISHED;
    use crate::simulation::{PatternRuler, usual_config};
    use core::f64::consts::TAU;
    use firmware_sim::lab::Laboratory;

    #[test]
    fn a_lone_target_has_its_ring_and_two_that_part_get_more() {
        let network = PUBLISHED.iter().find(|model| model.name == "nand-xnor").unwrap().network().unwrap();
        let open = "name = \"o\"\nregion = [20.0, 20.0]\nsnapshots = 2\n[morphogen]\nkernel = \"gaussian\"\ntarget_width = 1.5\n\
                    obstacle_width = 0.9\nlevel = 0.5\n[ring]\nd_min = 1.0\nd_max = 2.0\nd_obstacle = 2.0\nsteepness = 10.0\n";
        let lone = Scenario::parse(&format!("{open}[[target]]\npath = [[5.0, 10.0], [9.0, 10.0]]\n")).unwrap();
        let blob = crate::model::deploy::blob(network, &lone.morphogen(), 0.25);
        let config = usual_config(0.25, Laboratory::default());
        let ring = TAU * PatternRuler::new(&blob, &lone).unwrap().ring_radius();
        let timetable = circumference(&blob, &lone, &config).unwrap();
        for frame in [0, 100, 1000, 100_000] {
            let size = timetable.at(frame).unwrap();
            assert_eq!(size.rings, 1);
            assert!((size.circumference_m / ring - 1.0).abs() < 0.01, "{} {ring}", size.circumference_m);
        }
        let apart = "[[target]]\npath = [[8.0, 10.0], [16.0, 10.0]]\n[[target]]\npath = [[8.0, 10.0], [8.0, 4.0]]\n";
        let two = Scenario::parse(&format!("{open}{apart}")).unwrap();
        let timetable = circumference(&blob, &two, &config).unwrap();
        let (start, end) = (timetable.at(0).unwrap(), timetable.at(u64::MAX).unwrap());
        assert_eq!((start.rings, end.rings), (1, 2));
        assert!(start.circumference_m > ring && (end.circumference_m / ring - 2.0).abs() < 0.02, "{start:?} {end:?}");
    }
}
