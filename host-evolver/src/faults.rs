//! What went wrong in a run, for people and as data.

use crate::simulation::Simulation;
use firmware_sim::faults::Fault;
use firmware_sim::lab::FaultKind;
use grn_core::robot::epuck2::TICKS_PER_SECOND;
use serde::Serialize;

/// So many lines of faults are told in a table.
const MOST_LINES: usize = 12;
/// So many robots are named in a line.
const MOST_ROBOTS: usize = 8;

/// A fault that happened.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Happened {
    /// When it began, seconds from the start; 0 for a robot that joined late.
    pub at_s: f64,
    /// What.
    pub kind: FaultKind,
    /// To which robot.
    pub robot: usize,
    /// Which wheel (0 left, 1 right) or proximity sensor had it, if one of them had.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<usize>,
    /// How long it lasted, seconds; `None` to the end.
    pub lasted_s: Option<f64>,
}

fn seconds(ticks: u64) -> f64 {
    ticks as f64 / f64::from(TICKS_PER_SECOND)
}

/// The faults of a run, in the order in which they began.
pub fn happened(simulation: &Simulation) -> Vec<Happened> {
    let end = simulation.metrics.duration_s;
    let one = |fault: &Fault| {
        let lasted_s = fault.until.map(seconds).filter(|&until| until < end).map(|until| until - seconds(fault.from));
        let Fault { robot, kind, .. } = *fault;
        Happened { at_s: seconds(fault.from), kind, robot, part: fault.part(), lasted_s }
    };
    simulation.faults.faults().iter().map(one).filter(|fault| fault.at_s < end).collect()
}

/// One line for the robots to which the same happened at one time; nothing without faults.
pub fn list(happened: &[Happened]) -> String {
    let same = |a: &Happened, b: &Happened| (a.at_s, a.kind, a.lasted_s) == (b.at_s, b.kind, b.lasted_s);
    let mut lines: Vec<(&Happened, Vec<usize>)> = Vec::new();
    for fault in happened {
        match lines.iter_mut().rev().take_while(|(last, _)| last.at_s == fault.at_s).find(|(last, _)| same(last, fault))
        {
            Some((_, robots)) => robots.push(fault.robot),
            None => lines.push((fault, vec![fault.robot])),
        }
    }
    let line = |(fault, robots): &(&Happened, Vec<usize>)| {
        let named: Vec<String> = robots.iter().take(MOST_ROBOTS).map(usize::to_string).collect();
        let more = robots.len().saturating_sub(MOST_ROBOTS);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let word = if robots.len() == 1 { "robot" } else { "robots" };
        let length = match fault.lasted_s {
            _ if fault.kind == FaultKind::Carried => String::new(),
            Some(lasted_s) => format!(", {lasted_s:.1} s"),
            None => ", to the end".into(),
        };
        format!("{:>8.1} s  {:<15}{word} {}{more}{length}\n", fault.at_s, fault.kind.name(), named.join(", "))
    };
    let mut text: String = lines.iter().take(MOST_LINES).map(line).collect();
    if lines.len() > MOST_LINES {
        text += &format!("{:>8}    {} more; metrics.json of --out has all\n", "", lines.len() - MOST_LINES);
    }
    if text.is_empty() { text } else { format!("faults\n{text}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(at_s: f64, kind: FaultKind, robot: usize, lasted_s: Option<f64>) -> Happened {
        Happened { at_s, kind, robot, part: None, lasted_s }
    }

    #[test]
    fn what_happened_at_once_is_told_in_a_line() {
        assert_eq!(list(&[]), "");
        let stops = [0, 3, 7].map(|robot| fault(30.0, FaultKind::Stop, robot, None));
        let others = [fault(30.0, FaultKind::Radio, 4, Some(2.5)), fault(41.5, FaultKind::Carried, 2, Some(0.0))];
        let expected = "faults\n    30.0 s  stop           robots 0, 3, 7, to the end\n    30.0 s  radio          robot 4, 2.5 s\n    \
                        41.5 s  carried        robot 2\n";
        assert_eq!(list(&[&stops[..2], &others[..1], &stops[2..], &others[1..]].concat()), expected);
        let many: Vec<Happened> =
            (0..60).map(|k| fault((k / 3) as f64, FaultKind::Radio, k, Some(f64::from(k as u8)))).collect();
        let text = list(&many);
        assert_eq!(text.lines().count(), 1 + MOST_LINES + 1);
        assert!(text.ends_with("            48 more; metrics.json of --out has all\n"), "{text}");
        let crowd: Vec<Happened> = (0..30).map(|robot| fault(1.0, FaultKind::Late, robot, None)).collect();
        assert!(list(&crowd).ends_with("robots 0, 1, 2, 3, 4, 5, 6, 7 and 22 more, to the end\n"));
    }
}
