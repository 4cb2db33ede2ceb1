//! Counts the instructions of a controller tick and of its parts, and the stack they take.
//!
//! The scene is that of [`scene`]: two targets, eight obstacle points and eight neighbours. Lines are `number model part
//! instructions`:
//!
//! | part | what it is |
//! |---|---|
//! | tick | targets and points are seen, every neighbour is heard once in eight ticks, as robots speak: the mean of 32 ticks |
//! | tick-largest | the costliest of these: the robot broadcasts, or sorts what it knows |
//! | tick-all-heard-at-once | the costliest if all neighbours are heard in every tick, which a radio hardly manages |
//! | tick-all-new-at-once | the same in a controller's first tick, when nothing is known yet |
//! | tick-all-displaced | the same when memory is full of obstacle points, all farther away than those it perceives |
//! | tick-nothing-perceived | all is remembered, nothing seen or heard: the mean without the update of knowledge |
//! | field | x1, x2 and their gradients |
//! | rest | all genes' steady states with their slopes: for the gradient and for the integration |
//! | gradient | that of the pattern error |
//! | rk4-step | one integration step, after `rest`; a tick of the shipped blobs has one |
//! | rk4-step-more | each further step in the same call |
//!
//! Then come those of the longest message on its way through the radio, 37 bytes: packed, unpacked, and cut into fragments
//! and put together again for payloads of 20 and of 2 bytes.
#![no_std]
#![no_main]

use core::hint::black_box;
use grn_core::blob::Blob;
use grn_core::dynamics::{Expression, Step};
use grn_core::geometry::{Point, Vector};
use grn_core::network::{DEFAULT_GENES, Network};
use grn_core::pattern::Pattern;
use grn_core::robot::radio::packed::{self, Packed};
use grn_core::robot::radio::{Assembler, Fragment, Fragments};
use grn_core::robot::{Controller, Heard, Percept};
use grn_core::scalar::{Dual, Q8_24, Scalar};
use grn_firmware::board::{counter, print, stack_used};
use grn_firmware::text::decimal;
use grn_trials::{models, scene};
use heapless::Vec;

grn_firmware::entry!(main);

const MODELS: [(&str, &[u8]); 3] =
    [("nand-xnor", models::NAND_XNOR), ("andn-nand-xnor", models::ANDN_NAND_XNOR), ("eh-grn-1", models::EH_GRN_1)];
const TICKS: u32 = 32;

fn main() -> u8 {
    counter::start();
    let all_measured = MODELS.iter().all(|(name, bytes)| {
        let Ok(blob) = Blob::decode(bytes) else { return false };
        measure::<f32>(name, &blob) && measure::<Q8_24>(name, &blob)
    });
    let all_measured = all_measured && measure_radio();
    print("stack ");
    decimal(stack_used());
    print(" bytes\n");
    u8::from(!all_measured)
}

/// Instructions of `work`, less those of counting.
fn instructions(work: &mut dyn FnMut()) -> u32 {
    let count = |work: &mut dyn FnMut()| {
        let work = black_box(work);
        let before = counter::read();
        work();
        counter::read().wrapping_sub(before)
    };
    count(work).wrapping_sub(count(&mut || ()))
}

/// The longest message's way through the radio; false if it does not arrive.
fn measure_radio() -> bool {
    let show = |part: &str, count: u32| {
        for word in ["message ", part, " "] {
            print(word);
        }
        decimal(count as usize);
        print("\n");
    };
    let everything = scene::everything();
    let Some(Heard { message, .. }) = everything.heard.first() else { return false };
    let mut packed = Packed::new();
    show("write", instructions(&mut || packed = black_box(packed::write(black_box(message)))));
    let mut unpacked = None;
    show("read", instructions(&mut || unpacked = black_box(packed::read(black_box(&packed)).ok())));
    let mut all_arrived = unpacked.as_ref() == Some(message);
    for (payload, cut, put_together) in [(20, "cut-20", "put-together-20"), (2, "cut-2", "put-together-2")] {
        let fragments = || Fragments::new(black_box(message), payload, 1).into_iter().flatten();
        show(cut, instructions(&mut || fragments().for_each(|piece| _ = black_box(piece))));
        let mut assembler = Assembler::new();
        let mut heard = None;
        let hearing =
            |piece: Fragment| instructions(&mut || heard = black_box(assembler.receive(0, black_box(&piece))));
        let count = fragments().map(hearing).sum();
        show(put_together, count);
        all_arrived &= heard.as_ref() == Some(message);
    }
    all_arrived
}

/// The parts of a tick and the whole; false if the blob makes no controller.
fn measure<S: Scalar>(model: &str, blob: &Blob) -> bool {
    let show = |part: &str, count: u32| {
        for word in [S::NAME, " ", model, " ", part, " "] {
            print(word);
        }
        decimal(count as usize);
        print("\n");
    };
    let Ok(mut controller) = Controller::<S>::new(blob, 0) else { return false };
    let everything = scene::everything();
    let first = instructions(&mut || _ = black_box(controller.tick(black_box(&everything))));
    let Ok(mut full) = Controller::<S>::new(blob, 0) else { return false };
    for north in [500, 1000] {
        let _ = black_box(full.tick(&scene::everything_farther(north)));
    }
    let displaced = instructions(&mut || _ = black_box(full.tick(black_box(&everything))));
    // The sum and the largest of several ticks.
    let mut ticks = |percept: fn(u32) -> Percept| {
        let cost = |tick| {
            let percept = percept(tick);
            instructions(&mut || _ = black_box(controller.tick(black_box(&percept))))
        };
        (0..TICKS).map(cost).fold((0, 0), |(sum, largest), cost| (sum + cost, cost.max(largest)))
    };
    let (_, all_heard) = ticks(|_| scene::everything());
    let (tick, largest) = ticks(scene::in_turn);
    // The memory still holds what the ticks before told.
    let (remembering, _) = ticks(|_| scene::nothing());
    show("tick", tick.div_ceil(TICKS));
    show("tick-largest", largest);
    show("tick-all-heard-at-once", all_heard);
    show("tick-all-new-at-once", first);
    show("tick-all-displaced", displaced);
    show("tick-nothing-perceived", remembering.div_ceil(TICKS));

    let network: Network<S> = blob.network.cast();
    let field = blob.field.field::<S>(blob.scale);
    let Ok(pattern) = Pattern::of(&network, S::from_f32(blob.level_fraction)) else { return false };
    let metres = |x: i32, y: i32| Vector::new(S::from_ratio(x, 1000), S::from_ratio(y, 1000));
    let targets = [metres(150, 60), metres(-220, 180)];
    let obstacles: [Point<S>; 8] = [0, 1, 2, 3, 4, 5, 6, 7].map(|number| metres(40 * number - 140, 300));
    let mut here = field.at(Vector::ZERO, targets, &obstacles[..]);
    show("field", instructions(&mut || here = black_box(field.at(black_box(Vector::ZERO), targets, &obstacles[..]))));
    let x = [here.x1, here.x2];
    let mut rest: Vec<Dual<S>, DEFAULT_GENES> = Vec::new();
    show(
        "rest",
        instructions(&mut || network.steady_levels([Dual::input(black_box(x[0]), 0), Dual::input(x[1], 1)], &mut rest)),
    );
    let slopes = rest.last().map_or([S::ZERO; 2], |morphogen| morphogen.gradient);
    let mut gradient = Vector::ZERO;
    show("gradient", instructions(&mut || gradient = black_box(pattern.error_gradient(black_box(slopes), &here))));
    let mut expression = Expression::<S, DEFAULT_GENES>::silent();
    let mut integrate =
        |steps: u8| instructions(&mut || expression.advance(&network, black_box(x), &rest, Step::DEFAULT, steps));
    let (one, two) = (integrate(1), integrate(2));
    show("rk4-step", one);
    show("rk4-step-more", two.saturating_sub(one));
    true
}
