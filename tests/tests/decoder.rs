//! The decoder under mutated blobs: many more inputs go through `cargo xtask fuzz`.

use grn_tests::decoder::{exercise, sealed};
use grn_tests::golden::shipped_models;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// `GRN_FUZZ_INPUTS` asks for more.
const INPUTS: usize = 300_000;

#[test]
fn mutated_blobs_are_refused_or_encode_to_themselves() -> Result<(), Box<dyn std::error::Error>> {
    let inputs = match std::env::var("GRN_FUZZ_INPUTS") {
        Ok(asked) => asked.parse()?,
        Err(_) => INPUTS,
    };
    let models = shipped_models()?;
    let mut rng = Pcg64::seed_from_u64(7);
    let mut accepted = 0;
    for _ in 0..inputs {
        let whole = &models[rng.random_range(0..models.len())].1;
        let sealed_alone = rng.random_bool(0.7);
        let mut data = if sealed_alone { whole[15..whole.len() - 4].to_vec() } else { whole.clone() };
        for _ in 0..rng.random_range(0..4) {
            mutate(&mut data, &mut rng);
        }
        accepted += usize::from(exercise(&data));
    }
    println!("{inputs} inputs, {accepted} accepted");
    assert!(accepted > inputs / 10 && accepted < inputs, "{accepted} of {inputs} accepted: the exercise has no edge");
    Ok(())
}

fn mutate(data: &mut Vec<u8>, rng: &mut Pcg64) {
    if data.is_empty() {
        data.push(rng.random());
        return;
    }
    let at = rng.random_range(0..data.len());
    match rng.random_range(0..6) {
        0 => data[at] ^= 1 << rng.random_range(0..8),
        1 => data[at] = rng.random(),
        2 => data.insert(at, rng.random()),
        3 => {
            data.remove(at);
        }
        4 => data.truncate(at),
        _ => {
            let from = rng.random_range(0..data.len());
            data[at] = data[from];
        }
    }
}

#[test]
fn the_envelope_written_by_hand_is_the_one_that_ships() -> Result<(), Box<dyn std::error::Error>> {
    for (path, bytes) in shipped_models()? {
        assert_eq!(sealed(&bytes[15..bytes.len() - 4]), bytes, "{}", path.display());
        assert!(exercise(&bytes));
    }
    Ok(())
}
