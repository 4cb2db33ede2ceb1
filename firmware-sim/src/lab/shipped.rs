//! The laboratories that come with the program.

use super::{Laboratory, parse};

/// A laboratory that is shipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shipped {
    /// Good sensors, one message in ten lost, no delay.
    Ideal,
    /// E-puck2 robots under a camera, talking over Wi-Fi.
    Tracked,
    /// E-puck2 robots that have only what they carry.
    Onboard,
    /// Everything goes wrong.
    Hostile,
}

impl Shipped {
    /// All of them.
    pub const ALL: [Shipped; 4] = [Shipped::Ideal, Shipped::Tracked, Shipped::Onboard, Shipped::Hostile];

    /// The one of this name.
    pub fn named(name: &str) -> Option<Shipped> {
        Shipped::ALL.into_iter().find(|shipped| shipped.name() == name)
    }

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Shipped::Ideal => "ideal",
            Shipped::Tracked => "e-puck2-tracked",
            Shipped::Onboard => "e-puck2-onboard",
            Shipped::Hostile => "hostile",
        }
    }

    /// What it is, in a line.
    pub const fn summary(self) -> &'static str {
        match self {
            Shipped::Ideal => "good sensors, one message in ten lost, no delay",
            Shipped::Tracked => "e-puck2 robots under an overhead camera, talking over Wi-Fi",
            Shipped::Onboard => "e-puck2 robots with only what they carry: odometry, range-and-bearing board",
            Shipped::Hostile => "everything goes wrong at once",
        }
    }

    /// Its file, with a comment for every number.
    pub const fn text(self) -> &'static str {
        match self {
            Shipped::Ideal => include_str!("../../laboratories/ideal.toml"),
            Shipped::Tracked => include_str!("../../laboratories/e-puck2-tracked.toml"),
            Shipped::Onboard => include_str!("../../laboratories/e-puck2-onboard.toml"),
            Shipped::Hostile => include_str!("../../laboratories/hostile.toml"),
        }
    }

    /// The laboratory.
    pub fn laboratory(self) -> Laboratory {
        match self {
            Shipped::Ideal => Laboratory::default(),
            Shipped::Tracked | Shipped::Onboard | Shipped::Hostile => match parse(self.text()) {
                Ok(laboratory) => laboratory,
                Err(error) => unreachable!("{}: {error}; a test reads every file that is shipped", self.name()),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toml::{Table, Value};

    #[test]
    fn every_file_is_a_laboratory_of_its_name() {
        for shipped in Shipped::ALL {
            let laboratory = parse(shipped.text()).unwrap();
            assert_eq!(laboratory.name, shipped.name());
            assert_eq!(laboratory, shipped.laboratory());
            assert_eq!(Shipped::named(shipped.name()), Some(shipped));
        }
    }

    #[test]
    fn the_file_of_the_ideal_one_names_every_key_with_a_comment() {
        let whole = Table::try_from(Laboratory::default()).unwrap();
        let written: Table = toml::from_str(Shipped::Ideal.text()).unwrap();
        assert_eq!(written, whole);
        for (_, table) in whole.iter().filter_map(|(name, value)| Some((name, value.as_table()?))) {
            for (key, value) in table {
                assert!(!matches!(value, Value::Table(_)));
                let line = Shipped::Ideal.text().lines().find(|line| line.starts_with(&format!("{key} = ")));
                assert!(line.is_some_and(|line| line.contains(" # ")), "{key} has no comment");
            }
        }
    }
}
