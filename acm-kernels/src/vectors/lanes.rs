//! Sums over the lanes of many vectors at once.
//!
//! ```text
//! a, b  →  (even lanes of a, odd lanes of b) + (odd lanes of a, even lanes of b) turned by one lane
//! ```
//!
//! So two vectors become one, whose even lanes hold sums of two lanes of a, and whose odd lanes those of b. The next
//! round does the same with every second pair of lanes, then with fours, until one vector holds the sums of as many
//! vectors as it has lanes, in their order. A vector costs two choices, a turn and an addition; its sum by itself
//! would cost a turn and an addition for every halving, and would be a single number to store.

use pulp::Simd;

/// Largest number of lanes of a vector.
const MOST: usize = 16;

/// Numbers of the lanes.
static LANES: [u32; MOST] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// Replaces the front of `vectors` by the sums over the lanes of each of them. N is a multiple of the number of lanes.
#[inline(always)]
pub(crate) fn pack_sums<S: Simd, const N: usize>(s: S, vectors: &mut [S::f32s; N]) {
    let (mut stretch, mut count) = (1, N);
    while stretch < S::F32_LANES {
        count /= 2;
        for i in 0..count {
            vectors[i] = fold(s, vectors[2 * i], vectors[2 * i + 1], stretch);
        }
        stretch *= 2;
    }
}

/// Merges two vectors into one: lanes whose number has the bit `stretch` are b's, the others a's.
#[inline(always)]
fn fold<S: Simd>(s: S, a: S::f32s, b: S::f32s, stretch: usize) -> S::f32s {
    let lanes = S::as_simd_u32s(&LANES).0[0];
    let bit = s.and_u32s(lanes, s.splat_u32s(stretch as u32));
    let of_b = s.greater_than_u32s(bit, s.splat_u32s(0));
    let (own, other) = (s.select_f32s(of_b, b, a), s.select_f32s(of_b, a, b));
    s.add_f32s(own, s.rotate_right_f32s(other, stretch))
}

#[cfg(test)]
mod tests {
    use pulp::{WithSimd, bytemuck};

    use super::*;
    use crate::vectors::level::{Level, run};

    struct Sums<'x>(&'x [[f32; MOST]; MOST]);

    impl WithSimd for Sums<'_> {
        type Output = Vec<f32>;

        fn with_simd<S: Simd>(self, s: S) -> Vec<f32> {
            let mut vectors = self.0.map(|values| S::as_simd_f32s(&values).0[0]);
            pack_sums(s, &mut vectors);
            bytemuck::cast_slice(&vectors[..MOST / S::F32_LANES]).to_vec()
        }
    }

    /// Oracle: whole numbers, whose sums are exact in any order.
    #[test]
    fn sums_come_in_the_order_of_their_vectors() {
        let values =
            std::array::from_fn(|i| std::array::from_fn(|lane| ((7 * i + 3) * (lane + 1) * (lane + 2)) as f32));
        for level in Level::available() {
            let found = run(level.arch().expect("it is available"), Sums(&values));
            let lanes = match level {
                Level::Avx512 => 16,
                Level::Avx2 => 8,
                Level::Neon => 4,
                Level::Scalar => 1,
            };
            for (i, (found, values)) in found.iter().zip(&values).enumerate() {
                assert_eq!(*found, values[..lanes].iter().sum::<f32>(), "{level:?}, vector {i}");
            }
        }
    }
}
