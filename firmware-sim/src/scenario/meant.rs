//! What swarm a world is meant for, if it says so.

use super::Scenario;
use super::tables::SwarmTable;
use crate::config::SwarmConfig;
use crate::lab::MAX_ROBOTS;
use grn_input::{InputError, Range};

/// The swarm that a world is meant for: it goes before what the laboratory says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeantSwarm {
    /// How many robots, 1..=[`MAX_ROBOTS`].
    pub robots: usize,
    /// How many of them are mothers, 1..=`robots`.
    pub mothers: usize,
    /// Whether walls stop radio; `None` if that is the laboratory's affair.
    pub walls_block_radio: Option<bool>,
}

impl MeantSwarm {
    pub(super) fn checked(table: &SwarmTable) -> Result<MeantSwarm, InputError> {
        let count = |key: &str, count: i64, most: usize, unit| {
            // What is negative is out of range, too.
            Range::new(1, most, unit)
                .check(key, usize::try_from(count).unwrap_or(0))
                .map_err(|error| InputError::new(key, count, error.expected()))?;
            Ok::<usize, InputError>(usize::try_from(count).unwrap_or(0))
        };
        let robots = count("swarm.robots", table.robots, MAX_ROBOTS, "(a whole one)")?;
        let mothers = match table.mothers {
            Some(mothers) => count("swarm.mothers", mothers, robots, "(a whole one, at most swarm.robots)")?,
            None => robots.min(2),
        };
        Ok(MeantSwarm { robots, mothers, walls_block_radio: table.walls_block_radio })
    }

    /// The keys of a laboratory in whose place this is.
    fn keys(&self) -> impl Iterator<Item = &'static str> {
        let walls = self.walls_block_radio.map(|_| "radio.walls_block");
        ["robots.count", "robots.mothers"].into_iter().chain(walls)
    }
}

impl Scenario {
    /// The swarm that the world is meant for, if it says so.
    pub fn meant_swarm(&self) -> Option<&MeantSwarm> {
        self.meant_swarm.as_ref()
    }

    /// A run in this world: the configuration with the swarm that the world is meant for in place of the laboratory's.
    #[must_use]
    pub fn configured(&self, mut config: SwarmConfig) -> SwarmConfig {
        if let Some(meant) = &self.meant_swarm {
            config.lab.robots.count = meant.robots;
            config.lab.robots.mothers = meant.mothers;
            config.lab.radio.walls_block = meant.walls_block_radio.unwrap_or(config.lab.radio.walls_block);
        }
        config
    }

    /// The first of these settings of a laboratory, such as `robots.count=20`, that has no effect in this world, because the world says it
    /// itself.
    pub fn settled<'s>(&self, settings: &'s [String]) -> Option<&'s str> {
        let key = |setting: &str| setting.split('=').next().unwrap_or_default().trim().to_owned();
        let meant = self.meant_swarm?;
        settings.iter().map(String::as_str).find(|setting| meant.keys().any(|own| own == key(setting)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::{Laboratory, Shipped};

    const WORLD: &str = include_str!("../../../scenarios/open.toml");

    fn with(swarm: &str) -> Result<Scenario, InputError> {
        Scenario::parse(&format!("{WORLD}\n[swarm]\n{swarm}\n"))
    }

    #[test]
    fn what_a_world_says_goes_before_the_laboratory() {
        let hostile = SwarmConfig { lab: Shipped::Hostile.laboratory(), ..SwarmConfig::default() };
        let world = with("robots = 40\nmothers = 8\nwalls_block_radio = true").unwrap();
        let expected = MeantSwarm { robots: 40, mothers: 8, walls_block_radio: Some(true) };
        assert_eq!(world.meant_swarm(), Some(&expected));
        assert_eq!(Scenario::parse(&world.to_toml()).unwrap(), world);
        assert_eq!(world.scaled(0.5).meant_swarm(), Some(&expected));
        let Laboratory { robots, radio, ref sighting, .. } = world.configured(hostile.clone()).lab;
        assert_eq!((robots.count, robots.mothers, radio.walls_block), (40, 8, true));
        assert_eq!((radio.loss, sighting), (hostile.lab.radio.loss, &hostile.lab.sighting));
        let settings = ["radio.loss=0.3", "radio.walls_block = false", "robots.count=9"].map(String::from);
        assert_eq!(world.settled(&settings), Some("radio.walls_block = false"));
        assert_eq!(world.settled(&settings[..1]), None);

        let open = Scenario::parse(WORLD).unwrap();
        assert_eq!(open.configured(hostile.clone()), hostile);
        assert_eq!(open.settled(&settings), None);
    }

    #[test]
    fn mothers_and_radio_may_be_left_out() {
        let world = with("robots = 40").unwrap();
        let walls_block = || SwarmConfig { lab: Shipped::Hostile.laboratory(), ..SwarmConfig::default() };
        assert_eq!(world.meant_swarm().map(|meant| (meant.robots, meant.mothers)), Some((40, 2)));
        assert_eq!(world.configured(walls_block()).lab.radio, walls_block().lab.radio);
        assert_eq!(world.settled(&["radio.walls_block=true".into()]), None);
        assert_eq!(with("robots = 1").unwrap().meant_swarm().map(|meant| meant.mothers), Some(1));
    }

    #[test]
    fn impossible_swarms_are_refused_where_they_stand() {
        for (swarm, expected) in [
            ("robots = 0", "swarm.robots = 0: must be a number from 1 to 10000"),
            ("robots = -3", "swarm.robots = -3: must be a number from 1 to 10000"),
            ("robots = 10001", "swarm.robots = 10001: must be a number from 1 to 10000"),
            ("robots = 4\nmothers = 5", "swarm.mothers = 5: must be a number from 1 to 4"),
            ("robots = 4\nmothers = 0", "swarm.mothers = 0: must be a number from 1 to 4"),
            ("mothers = 2", "swarm.robots: is missing"),
            ("robots = 4\nwalls_block = true", "swarm.walls_block: unknown key"),
        ] {
            let error = with(swarm).unwrap_err().to_string();
            assert!(error.starts_with("line ") && error.contains(expected), "{swarm}\n{error}");
        }
    }
}
