//! Lists of bounded length, filled without a way to panic.

use heapless::Vec;

/// The items, as many as fit. Where all are known to fit this is `collect`, whose panic a compiler need not see through.
pub fn filled<T, const N: usize>(items: impl IntoIterator<Item = T>) -> Vec<T, N> {
    let mut list = Vec::new();
    for item in items {
        if list.push(item).is_err() {
            break;
        }
    }
    list
}

/// The first of the largest numbers: its index and itself; (0, 0) for none.
pub(crate) fn largest_of(numbers: impl Iterator<Item = u32>) -> (usize, u32) {
    (0..).zip(numbers).fold((0, 0), |best, next| if next.1 > best.1 { next } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_left_out() {
        let list: Vec<u8, 3> = filled(0..9);
        assert_eq!(list, [0, 1, 2]);
    }
}
