//! The nonlinear part of a recurrent step, with its slopes.
//!
//! Each function turns sums y into the new state and, where `TRAIN`, overwrites y with the slopes that the
//! backward pass multiplies with ∂L/∂h'.
//!
//! ```text
//! gated   β = 1 − α, c = b − a  (mode default)      β = 1, c = b  (mode no_gate)
//!         h' = a + α c
//!         ∂h'/∂N_1 = β(1 − a²),  ∂h'/∂N_2 = α(1 − b²),  ∂h'/∂N_b = c α(1 − α) =: q,  ∂h'/∂N_a = q Δt
//!
//! pure    E = exp(−Δt (|w_τ| + |N_1|)),   h' = A − A E N_1
//!         ∂h'/∂N_1 = −A E (1 − Δt |N_1|),  ∂h'/∂A = 1 − E N_1,  ∂h'/∂w_τ = A E N_1 Δt sign w_τ
//!
//! gru     r = σ(ρ), z = σ(ζ), n = tanh(a + r c),  h' = n + z(h − n)
//!         ∂h'/∂a = (1 − z)(1 − n²) =: q,  ∂h'/∂c = q r,  ∂h'/∂ρ = q c r(1 − r),  ∂h'/∂ζ = (h − n) z(1 − z),
//!         ∂h'/∂h = z
//! ```

use pulp::Simd;

use crate::vectors::functions::{exp, sigmoid, sigmoid_slope, tanh, tanh_slope};
use crate::vectors::row::{Row, vectors};

/// Computes h' from y = (N_1, N_2, N_a, N_b).
#[inline(always)]
pub(crate) fn gated<S: Simd, const TRAIN: bool, const DEFAULT: bool>(
    s: S,
    y: &mut [Row],
    elapsed: &Row,
    h: &mut [Row],
) {
    let [n_1, n_2, n_a, n_b] = blocks(y, h.len());
    let rows = n_1.iter_mut().zip(n_2).zip(n_a.iter_mut().zip(n_b)).zip(h);
    for (((n_1, n_2), (n_a, n_b)), h) in rows {
        let (n_1, n_2) = (n_1.vectors_mut::<S>(), n_2.vectors_mut::<S>());
        let (n_a, n_b) = (n_a.vectors_mut::<S>(), n_b.vectors_mut::<S>());
        for v in 0..vectors::<S>() {
            let elapsed = elapsed.vectors::<S>()[v];
            let (a, b) = (tanh(s, n_1[v]), tanh(s, n_2[v]));
            let alpha = sigmoid(s, s.mul_add_e_f32s(n_a[v], elapsed, n_b[v]));
            let c = if DEFAULT { s.sub_f32s(b, a) } else { b };
            h.vectors_mut::<S>()[v] = s.mul_add_e_f32s(alpha, c, a);
            if TRAIN {
                let slope = tanh_slope(s, a);
                n_1[v] = if DEFAULT { s.negate_mul_add_e_f32s(alpha, slope, slope) } else { slope };
                n_2[v] = s.mul_f32s(alpha, tanh_slope(s, b));
                let q = s.mul_f32s(c, sigmoid_slope(s, alpha));
                n_a[v] = s.mul_f32s(q, elapsed);
                n_b[v] = q;
            }
        }
    }
}

/// Computes h' from y = (N_1, –, –), with slopes by N_1, A and w_τ; `constants` are w_τ and A at a row and a vector of
/// it.
#[inline(always)]
pub(crate) fn pure<S: Simd, const TRAIN: bool>(
    s: S,
    y: &mut [Row],
    elapsed: &Row,
    constants: impl Fn(usize, usize) -> (S::f32s, S::f32s),
    h: &mut [Row],
) {
    let [n_1, by_level, by_rate] = blocks(y, h.len());
    let (zero, one) = (s.splat_f32s(0.0), s.splat_f32s(1.0));
    let rows = n_1.iter_mut().zip(by_level.iter_mut().zip(by_rate)).zip(h).enumerate();
    for (row, ((n_1, (by_level, by_rate)), h)) in rows {
        let (n_1, by_level, by_rate) =
            (n_1.vectors_mut::<S>(), by_level.vectors_mut::<S>(), by_rate.vectors_mut::<S>());
        for v in 0..vectors::<S>() {
            let ((rate, level), elapsed, sum) = (constants(row, v), elapsed.vectors::<S>()[v], n_1[v]);
            let size = s.abs_f32s(sum);
            let decay = exp(s, s.neg_f32s(s.mul_f32s(elapsed, s.add_f32s(s.abs_f32s(rate), size))));
            let (lasting, left) = (s.mul_f32s(level, decay), s.mul_f32s(decay, sum));
            h.vectors_mut::<S>()[v] = s.negate_mul_add_e_f32s(level, left, level);
            if TRAIN {
                n_1[v] = s.neg_f32s(s.mul_f32s(lasting, s.negate_mul_add_e_f32s(elapsed, size, one)));
                by_level[v] = s.sub_f32s(one, left);
                let slope = s.mul_f32s(s.mul_f32s(level, left), elapsed);
                let falling = s.select_f32s(s.less_than_f32s(rate, zero), s.neg_f32s(slope), zero);
                by_rate[v] = s.select_f32s(s.greater_than_f32s(rate, zero), slope, falling);
            }
        }
    }
}

/// Cuts y into blocks of `units` rows.
#[inline(always)]
fn blocks<const N: usize>(y: &mut [Row], units: usize) -> [&mut [Row]; N] {
    let mut blocks = y.chunks_mut(units);
    std::array::from_fn(|_| blocks.next().unwrap_or_default())
}

/// Replaces h by h', and y = (ρ, ζ, c, a) by the slopes with respect to them; `update` gets z = ∂h'/∂h.
#[inline(always)]
pub(crate) fn gru<S: Simd, const TRAIN: bool>(s: S, y: &mut [Row], update: &mut [Row], h: &mut [Row]) {
    let [reset, zeta, c, a] = blocks(y, h.len());
    let rows = reset.iter_mut().zip(zeta).zip(c.iter_mut().zip(a)).zip(update.iter_mut().zip(h));
    for (((reset, zeta), (c, a)), (update, h)) in rows {
        let (reset, zeta) = (reset.vectors_mut::<S>(), zeta.vectors_mut::<S>());
        let (c, a) = (c.vectors_mut::<S>(), a.vectors_mut::<S>());
        let (update, h) = (update.vectors_mut::<S>(), h.vectors_mut::<S>());
        for v in 0..vectors::<S>() {
            let (r, z) = (sigmoid(s, reset[v]), sigmoid(s, zeta[v]));
            let n = tanh(s, s.mul_add_e_f32s(r, c[v], a[v]));
            let over = s.sub_f32s(h[v], n);
            h[v] = s.mul_add_e_f32s(z, over, n);
            if TRAIN {
                let slope = tanh_slope(s, n);
                let q = s.negate_mul_add_e_f32s(z, slope, slope);
                reset[v] = s.mul_f32s(s.mul_f32s(q, c[v]), sigmoid_slope(s, r));
                zeta[v] = s.mul_f32s(over, sigmoid_slope(s, z));
                c[v] = s.mul_f32s(q, r);
                a[v] = q;
                update[v] = z;
            }
        }
    }
}
