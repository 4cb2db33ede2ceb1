//! Fixed exercises of the controller, the same on every machine, and digests of every bit that comes out.
//!
//! What is exercised: the five printed models and [`RANDOM_NETWORKS`] random networks, in one number type. Equal digests
//! on two machines mean equal bits of steady states, gradients, integrations, commands and messages.
#![no_std]
#![forbid(unsafe_code)]

pub mod digest;
pub mod models;
pub mod random;
pub mod scene;
pub mod walk;

use core::fmt;
use digest::{Bits, Digest, Hasher};
use grn_core::blob::{Blob, max_encoded_size};
use grn_core::dynamics::{Expression, Step};
use grn_core::network::{DEFAULT_GENES, Network};
use grn_core::robot::{Controller, LoadError};
use grn_core::scalar::{Dual, Scalar};
use heapless::Vec;
use walk::Walk;

/// How many random networks are exercised besides the printed models.
pub const RANDOM_NETWORKS: u32 = 200;
/// Ticks that each model's controller is run for.
const TICKS: u32 = 32;
/// Ticks of the long run.
const LONG_RUN_TICKS: u32 = 1000;

/// What the exercises give in one number type; one digest a part, to tell where two machines part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digests {
    /// Blobs as encoded, decoded and encoded again; the same for every number type.
    pub blobs: Digest,
    /// Steady states and their gradients over a grid of inputs.
    pub steady_states: Digest,
    /// Levels of all genes after each RK4 step, over changing inputs.
    pub rk4: Digest,
    /// Commands, messages and morphogens over random percepts, or why the controller refused the model.
    pub commands: Digest,
    /// The first printed model's commands over a walk of 1,000 ticks.
    pub long_run: Digest,
}

impl Digests {
    /// Name and digest of every part.
    pub fn parts(&self) -> [(&'static str, Digest); 5] {
        [
            ("blobs", self.blobs),
            ("steady-states", self.steady_states),
            ("rk4", self.rk4),
            ("commands", self.commands),
            ("long-run", self.long_run),
        ]
    }

    /// A line `number part digest` for every part and for all, as in `tests/golden/digest.txt`.
    pub fn lines<S: Bits>(&self) -> impl fmt::Display {
        let digests = *self;
        fmt::from_fn(move |f| {
            let all = ("all", digests.all());
            let mut lines = digests.parts().into_iter().chain([all]);
            lines.try_for_each(|(part, digest)| writeln!(f, "{} {part} {digest}", S::NAME))
        })
    }

    /// One digest of them all.
    pub fn all(&self) -> Digest {
        let mut hasher = Hasher::default();
        for (_, part) in self.parts() {
            hasher.bytes(&part.0);
        }
        hasher.finish()
    }
}

/// Runs all exercises in the number type `S`.
pub fn digests<S: Bits>() -> Digests {
    let mut blobs = Hasher::default();
    let mut steady_states = Hasher::default();
    let mut rk4 = Hasher::default();
    let mut commands = Hasher::default();
    for number in 0..models::PRINTED as u32 + RANDOM_NETWORKS {
        // A model that is not valid shows in the digest, which then lacks it.
        let Some(blob) = model(number, &mut blobs) else { continue };
        let network = blob.network.cast::<S>();
        steady(&network, &mut steady_states);
        integrate(&network, &mut rk4);
        run::<S>(&blob, number, TICKS, &mut commands);
    }
    let mut long_run = Hasher::default();
    if let Some(blob) = model(0, &mut Hasher::default()) {
        run::<S>(&blob, 0, LONG_RUN_TICKS, &mut long_run);
    }
    Digests {
        blobs: blobs.finish(),
        steady_states: steady_states.finish(),
        rk4: rk4.finish(),
        commands: commands.finish(),
        long_run: long_run.finish(),
    }
}

/// Model number `number`, printed ones first, after a way through its encoded form.
fn model(number: u32, hasher: &mut Hasher) -> Option<Blob> {
    let made = match models::printed(number as usize) {
        Some(printed) => printed,
        None => random::blob(number),
    };
    let mut buffer = [0; max_encoded_size(DEFAULT_GENES)];
    let encoded = made.as_ref().and_then(|blob| blob.encode(&mut buffer).ok()).unwrap_or_default();
    hasher.bytes(encoded);
    Blob::decode(encoded).ok()
}

/// Eighths as a number: exact in every type.
fn eighths<S: Bits>(eighths: u8) -> S {
    S::from_ratio(i32::from(eighths), 8)
}

fn steady<S: Bits>(network: &Network<S>, hasher: &mut Hasher) {
    for x1 in (0..=20).step_by(2) {
        for x2 in (0..=8).step_by(2) {
            let (x1, x2) = (eighths(x1), eighths(x2));
            hasher.number(network.steady_state(x1, x2));
            let slope = network.steady_state_gradient(x1, x2);
            hasher.number(slope.value);
            let [d1, d2] = slope.gradient;
            hasher.number(d1);
            hasher.number(d2);
        }
    }
}

/// RK4 steps under constant inputs, as a controller does them.
fn advance<S: Scalar, const N: usize>(
    expression: &mut Expression<S, N>,
    network: &Network<S, N>,
    [x1, x2]: [S; 2],
    h: Step,
    steps: u8,
) {
    let mut rest = Vec::new();
    network.steady_levels([Dual::input(x1, 0), Dual::input(x2, 1)], &mut rest);
    expression.advance(network, [x1, x2], &rest, h, steps);
}

fn integrate<S: Bits>(network: &Network<S>, hasher: &mut Hasher) {
    let mut expression = Expression::<S, DEFAULT_GENES>::silent();
    for (x1, x2) in [(8, 0), (3, 7), (0, 0), (15, 8), (1, 1)] {
        for steps in [1, 1, 2, 8] {
            advance(&mut expression, network, [eighths(x1), eighths(x2)], Step::DEFAULT, steps);
            for &level in expression.levels(network) {
                hasher.number(level);
            }
        }
    }
}

fn run<S: Bits>(blob: &Blob, number: u32, ticks: u32, hasher: &mut Hasher) {
    let robot = number as u16;
    let mut controller = match Controller::<S>::new(blob, robot) {
        Ok(controller) => controller,
        Err(error) => return hasher.bytes(refusal(&error)),
    };
    let mut walk = Walk::new(number);
    for _ in 0..ticks {
        let Ok(command) = controller.tick(&walk.percept()) else { return hasher.bytes(b"percept") };
        hasher.command(&command);
        hasher.number(controller.morphogen());
        walk.follow(&command);
    }
}

fn refusal(error: &LoadError) -> &'static [u8] {
    match error {
        LoadError::NoPattern(_) => b"no pattern",
        LoadError::NoRing => b"no ring",
        LoadError::StepsPerTick(_) => b"steps per tick",
        _ => b"refused",
    }
}
