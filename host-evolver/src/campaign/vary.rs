//! The same world with one number changed: for asking what a result hangs on.

use firmware_sim::scenario::{Morphogen, Ring, Scenario};
use grn_core::field::Kernel;
use grn_input::{InputError, Range};
use serde::Deserialize;

/// Both widths under the exponential kernel, metres: as in public code of this family.
const EXPONENTIAL_WIDTH: f64 = 1.0;

/// Factors by which one number at a time is multiplied. The unchanged world always comes first.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Variations {
    /// Of σ_o.
    #[serde(default)]
    obstacle_width: Vec<f64>,
    /// Of the level fraction c.
    #[serde(default)]
    level: Vec<f64>,
    /// Of k1, k2 and k3 together.
    #[serde(default)]
    steepness: Vec<f64>,
    /// Of every length of region, paths and walls, while the model's lengths stay: channels get wider or narrower.
    #[serde(default)]
    world: Vec<f64>,
    /// Whether the exponential kernel is tried, both widths 1 m.
    #[serde(default)]
    exponential_kernel: bool,
}

/// Factors of one number, and what each changes.
struct Factors<'v> {
    name: &'static str,
    factors: &'v [f64],
    apply: fn(f64, &mut Changed),
}

/// A world with the model's lengths, which stay when the world is scaled.
struct Changed {
    world: Scenario,
    morphogen: Morphogen,
    ring: Ring,
}

/// Factors are few, since each makes every world and all its runs again.
const MOST_FACTORS: usize = 16;
const FACTOR: Range<f64> = Range::new(0.01, 100.0, "");

impl Variations {
    /// Checks the factors by themselves.
    ///
    /// # Errors
    /// A factor out of range or given twice, or too many.
    pub fn check(&self) -> Result<(), InputError> {
        for Factors { name, factors, .. } in self.factors() {
            if factors.len() > MOST_FACTORS {
                let expected = format!("at most {MOST_FACTORS} factors are possible; make several campaigns of it");
                return Err(InputError::new(format!("vary.{name}"), format!("{} factors", factors.len()), expected));
            }
            for (place, factor) in factors.iter().enumerate() {
                let key = format!("vary.{name}[{place}]");
                FACTOR.check(&key, *factor)?;
                if factors[..place].contains(factor) {
                    return Err(InputError::new(key, factor, "is there twice; remove one"));
                }
            }
        }
        Ok(())
    }

    fn factors(&self) -> [Factors<'_>; 4] {
        let Variations { obstacle_width, level, steepness, world, exponential_kernel: _ } = self;
        [
            Factors {
                name: "obstacle_width",
                factors: obstacle_width,
                apply: |factor, changed| changed.morphogen.obstacle_width *= factor,
            },
            Factors { name: "level", factors: level, apply: |factor, changed| changed.morphogen.level *= factor },
            Factors {
                name: "steepness",
                factors: steepness,
                apply: |factor, changed| changed.ring.steepness *= factor,
            },
            Factors {
                name: "world",
                factors: world,
                apply: |factor, changed| changed.world = changed.world.scaled(factor),
            },
        ]
    }

    /// The world and its variations; their names say what was changed.
    ///
    /// # Errors
    /// A factor that pushes a number of the world out of its range.
    pub fn of(&self, scenario: &Scenario) -> Result<Vec<Scenario>, InputError> {
        let (morphogen, ring) = (scenario.morphogen(), scenario.ring());
        let mut all = vec![scenario.clone()];
        for Factors { name, factors, apply } in self.factors() {
            for (place, &factor) in factors.iter().enumerate() {
                let called = format!("{}, {} x {factor}", scenario.name(), name.replace('_', " "));
                let mut changed = Changed { world: scenario.clone(), morphogen, ring };
                apply(factor, &mut changed);
                let Changed { world, morphogen, ring } = changed;
                let changed = world.with(&called, morphogen, ring);
                let key = format!("vary.{name}[{place}]");
                all.push(changed.map_err(|error| out_of_range(key, &factor.to_string(), scenario, &error))?);
            }
        }
        if self.exponential_kernel {
            let changed = Morphogen {
                kernel: Kernel::Exponential,
                target_width: EXPONENTIAL_WIDTH,
                obstacle_width: EXPONENTIAL_WIDTH,
                ..morphogen
            };
            let changed = scenario.with(&format!("{}, exponential kernel", scenario.name()), changed, ring);
            let key = "vary.exponential_kernel".to_owned();
            all.push(changed.map_err(|error| out_of_range(key, "true", scenario, &error))?);
        }
        Ok(all)
    }
}

fn out_of_range(key: String, factor: &str, scenario: &Scenario, error: &InputError) -> InputError {
    let made = format!("makes {} of {:?} {}, which {}", error.key(), scenario.name(), error.value(), error.expected());
    InputError::new(key, factor, made)
}
