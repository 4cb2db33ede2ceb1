//! How long a run is.

use firmware_sim::config::SwarmConfig;
use firmware_sim::scenario::Scenario;
use grn_input::InputError;

/// The longest run, simulated hours; who asks for more has mistyped a speed.
const MOST_HOURS: f64 = 1000.0;

/// Whether a run ends in reasonable time: a slow target makes a long run.
///
/// # Errors
/// [`InputError`] that says which speed or duration is possible.
pub fn check_length(scenario: &Scenario, config: &SwarmConfig) -> Result<(), InputError> {
    let most_seconds = MOST_HOURS * 3600.0;
    if scenario.travel_s(config.target_speed_m_per_s / config.scale) + config.settle_s <= most_seconds {
        return Ok(());
    }
    if let Some(duration_s) = scenario.duration_s() {
        let most = most_seconds - config.settle_s;
        let way_out =
            format!("the run would take longer than {MOST_HOURS:.0} simulated hours; at most {most} s are possible");
        return Err(InputError::new("duration_s", format!("{duration_s:?}"), way_out));
    }
    let path = scenario.longest_path() * config.scale;
    // Rounded up, so that the speed that is named is possible.
    let least = (path / (most_seconds - config.settle_s) * 1e9).ceil() / 1e9;
    let way_out = format!(
        "the run would take longer than {MOST_HOURS:.0} simulated hours; at least {least} metres per second are needed"
    );
    Err(InputError::new("target_speed_m_per_s", format!("{:?}", config.target_speed_m_per_s), way_out))
}
