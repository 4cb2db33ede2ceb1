//! Random numbers that a person can read: whole centimetres.

use crate::random::Stream;

/// Uniform in [least, most), metres, rounded to a centimetre.
pub(super) fn centimetres(stream: &mut Stream, [least, most]: [f64; 2]) -> f64 {
    rounded(least + (most - least) * stream.unit())
}

/// Metres rounded to a centimetre.
pub(super) fn rounded(metres: f64) -> f64 {
    (metres * 100.0).round() / 100.0
}

/// Metres rounded up to a millimetre.
pub(super) fn rounded_up(metres: f64) -> f64 {
    (metres * 1000.0).ceil() / 1000.0
}

/// A whole number from `least` to `most`, both included, all equally probable.
pub(super) fn whole(stream: &mut Stream, least: usize, most: usize) -> usize {
    least + (stream.unit() * (most - least + 1) as f64) as usize
}

/// True with this probability.
pub(super) fn chance(stream: &mut Stream, probability: f64) -> bool {
    stream.unit() < probability
}

/// +1 or -1.
pub(super) fn side(stream: &mut Stream) -> f64 {
    if chance(stream, 0.5) { 1.0 } else { -1.0 }
}
