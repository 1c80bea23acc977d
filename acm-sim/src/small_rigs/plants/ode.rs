//! Differential equations of the stages, for inputs that are linear between knots.
//!
//! First and second order advance by their exact solutions over a ramp `u + s·t`:
//!
//! ```text
//! lag     z = u + s(t − τ) + (z₀ − u + τs)·e^(−t/τ)
//! spring  z = u + s(t − 2ζ/ω) + e(t),   ë + 2ζω ė + ω² e = 0
//! ```
//!
//! A hardening spring and Torricelli's tank take Runge–Kutta steps of fourth order, a fortieth of their own time at most.

use std::f64::consts::TAU;

/// Share of a knot's step below which a time constant has no effect.
const NOTHING: f64 = 1e-6;

/// Applies a first-order lag of time constant `tau` (s), in place.
pub fn lag(time: &[f64], signal: &mut [f64], tau: f64) {
    if tau <= NOTHING * step(time) {
        return;
    }
    let mut value = signal[0];
    let mut before = signal[0];
    for k in 1..signal.len() {
        let (now, dt) = (signal[k], time[k] - time[k - 1]);
        let slope = (now - before) / dt;
        value = now - tau * slope + (value - before + tau * slope) * (-dt / tau).exp();
        before = now;
        signal[k] = value;
    }
}

/// Applies a linear spring of natural period `period` (s) and damping ratio `damping`, in place.
pub fn spring(time: &[f64], signal: &mut [f64], period: f64, damping: f64) {
    if period <= NOTHING * step(time) {
        return;
    }
    let omega = TAU / period;
    let (mut place, mut rate, mut before) = (signal[0], 0.0, signal[0]);
    for k in 1..signal.len() {
        let (now, dt) = (signal[k], time[k] - time[k - 1]);
        let slope = (now - before) / dt;
        let behind = 2.0 * damping * slope / omega;
        let [e, d] = free(omega, damping, dt, [place - before + behind, rate - slope]);
        (place, rate) = (now - behind + e, slope + d);
        before = now;
        signal[k] = place;
    }
}

/// Returns the free motion of a damped oscillator after `t`: deviation and its rate.
fn free(omega: f64, damping: f64, t: f64, [e, d]: [f64; 2]) -> [f64; 2] {
    // Nothing is left, and hyperbolic functions would overflow.
    if omega * t > 300.0 {
        return [0.0; 2];
    }
    let square = omega * omega * (1.0 - damping * damping);
    let root = square.abs().sqrt();
    let (cosine, sine) = match square {
        _ if root * t < 1e-7 => (1.0, t),
        square if square > 0.0 => ((root * t).cos(), (root * t).sin() / root),
        _ => ((root * t).cosh(), (root * t).sinh() / root),
    };
    let fade = (-damping * omega * t).exp();
    let (turn, pull) = (d + damping * omega * e, omega * omega * e + damping * omega * d);
    [fade * (e * cosine + turn * sine), fade * (d * cosine - pull * sine)]
}

/// Applies a spring whose stiffness grows with the square of its stretch: period, damping, hardening.
pub fn hardening(time: &[f64], signal: &mut [f64], [period, damping, cube]: [f64; 3]) {
    if period <= NOTHING * step(time) {
        signal.iter_mut().for_each(|u| *u = stretched(*u, cube));
        return;
    }
    let omega = TAU / period;
    let bend = |u: f64, [z, v]: [f64; 2]| {
        let force = u - z - cube * z * z * z;
        [v, omega * omega * force - 2.0 * damping * omega * v]
    };
    // The stiffness of the largest stretch sets the step.
    let largest = signal.iter().fold(0.0f64, |most, u| most.max(u.abs()));
    let stiff = (1.0 + 3.0 * cube.max(0.0) * largest * largest).sqrt();
    let start = [stretched(signal[0], cube), 0.0];
    march(time, signal, period / stiff / 40.0, start, bend);
}

/// Solves z + h z³ = u for z by Newton's method; z = u where the spring softens.
fn stretched(u: f64, cube: f64) -> f64 {
    if cube <= 0.0 {
        return u;
    }
    (0..50).fold(u / (1.0 + cube * u * u).cbrt(), |z, _| z - (z + cube * z * z * z - u) / (1.0 + 3.0 * cube * z * z))
}

/// Applies the level of a tank with a hole: θ ż = b·u − √z.
pub fn outflow(time: &[f64], signal: &mut [f64], theta: f64, gain: f64) {
    let still = |u: f64| (gain * u.max(0.0)).powi(2);
    if theta <= NOTHING * step(time) {
        signal.iter_mut().for_each(|u| *u = still(*u));
        return;
    }
    let flow = |u: f64, [z, _]: [f64; 2]| [(gain * u.max(0.0) - z.max(0.0).sqrt()) / theta, 0.0];
    let start = [still(signal[0]), 0.0];
    // 2θ√z is the time of a small change; a low tank is the fastest.
    let lowest = signal.iter().fold(f64::INFINITY, |least, u| least.min(gain * u)).max(0.05 * gain.abs());
    march(time, signal, 2.0 * theta * lowest / 40.0, start, flow);
}

/// Integrates by Runge–Kutta of fourth order over a straight input; the first state is the output.
fn march(time: &[f64], signal: &mut [f64], longest: f64, start: [f64; 2], rate: impl Fn(f64, [f64; 2]) -> [f64; 2]) {
    let (mut state, mut before) = (start, signal[0]);
    signal[0] = start[0];
    for k in 1..signal.len() {
        let (now, dt) = (signal[k], time[k] - time[k - 1]);
        let steps = (dt / longest.max(NOTHING * dt)).ceil().clamp(1.0, 400.0);
        let h = dt / steps;
        for n in 0..steps as usize {
            let u = |part: f64| before + (now - before) * (n as f64 + part) / steps;
            state = classic(h, state, [u(0.0), u(0.5), u(1.0)], &rate);
        }
        before = now;
        signal[k] = state[0];
    }
}

fn classic(h: f64, x: [f64; 2], [u, v, w]: [f64; 3], rate: &impl Fn(f64, [f64; 2]) -> [f64; 2]) -> [f64; 2] {
    let moved = |k: [f64; 2], share: f64| [x[0] + share * h * k[0], x[1] + share * h * k[1]];
    let a = rate(u, x);
    let b = rate(v, moved(a, 0.5));
    let c = rate(v, moved(b, 0.5));
    let d = rate(w, moved(c, 1.0));
    [0, 1].map(|i| x[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
}

fn step(time: &[f64]) -> f64 {
    match time {
        [first, .., last] => (last - first) / (time.len() - 1) as f64,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(step: f64, many: usize) -> Vec<f64> {
        (0..many).map(|k| step * k as f64).collect()
    }

    /// Returns a step of one, after an instant so short that it is nearly none.
    fn stepped(time: &mut [f64], response: impl Fn(&[f64], &mut [f64])) -> Vec<f64> {
        time[1] = 1e-6;
        let mut signal = vec![1.0; time.len()];
        signal[0] = 0.0;
        response(time, &mut signal);
        signal
    }

    /// Oracle: 1 − e^(−t/τ).
    #[test]
    fn step_response_of_a_lag() {
        let mut time = grid(0.07, 40);
        let got = stepped(&mut time, |t, u| lag(t, u, 0.4));
        for (t, z) in time.iter().zip(got).skip(1) {
            assert!((z - (1.0 - (-t / 0.4f64).exp())).abs() < 1e-5, "{t} {z}");
        }
    }

    /// Oracle: overshoot e^(−πζ/√(1−ζ²)) at half the damped period; two real poles as partial fractions.
    #[test]
    fn step_response_of_a_spring() {
        let (period, damping) = (1.0, 0.3f64);
        let root = (1.0 - damping * damping).sqrt();
        let mut time = vec![0.0, 1e-6, 0.5 * period / root];
        let peak = stepped(&mut time, |t, u| spring(t, u, period, damping))[2];
        assert!((peak - 1.0 - (-std::f64::consts::PI * damping / root).exp()).abs() < 1e-5, "{peak}");
        // Poles 1/a and 1/b: z = 1 − (a e^(−t/a) − b e^(−t/b))/(a − b), ω² = 1/(ab), 2ζ/ω = a + b.
        let (a, b) = (0.5, 0.2f64);
        let (period, damping) = (TAU * (a * b).sqrt(), 0.5 * (a + b) / (a * b).sqrt());
        let mut time = grid(0.1, 30);
        let got = stepped(&mut time, |t, u| spring(t, u, period, damping));
        for (t, z) in time.iter().zip(got).skip(1) {
            let wanted = 1.0 - (a * (-t / a).exp() - b * (-t / b).exp()) / (a - b);
            assert!((z - wanted).abs() < 1e-5, "{t}: {z} {wanted}");
        }
    }

    /// Oracle: without hardening the spring is the exact linear one; undamped with it, ½v² + ω²(½z² + ¼hz⁴) is kept.
    #[test]
    fn hardening_spring_is_linear_without_it_and_keeps_its_energy() {
        let time = grid(0.02, 400);
        let input: Vec<f64> = time.iter().map(|t| (1.3 * t).sin()).collect();
        let (mut one, mut two) = (input.clone(), input);
        hardening(&time, &mut one, [0.8, 0.2, 0.0]);
        spring(&time, &mut two, 0.8, 0.2);
        assert!(one.iter().zip(&two).all(|(a, b)| (a - b).abs() < 1e-5));
        let (omega, cube) = (TAU, 3.0);
        let bend = |u: f64, [z, v]: [f64; 2]| [v, omega * omega * (u - z - cube * z * z * z)];
        let energy = |[z, v]: [f64; 2]| 0.5 * v * v + omega * omega * (0.5 * z * z + 0.25 * cube * z.powi(4));
        let mut state = [1.0, 0.0];
        let kept = energy(state);
        (0..2000).for_each(|_| state = classic(0.005, state, [0.0; 3], &bend));
        assert!((energy(state) / kept - 1.0).abs() < 1e-4, "{}", energy(state) / kept);
        assert!((stretched(0.9, 3.0) - 0.5).abs() > 0.0 && (stretched(0.5 + 0.375, 3.0) - 0.5).abs() < 1e-12);
    }

    /// Oracle: Torricelli's tank empties as √z = √z₀ − t/(2θ).
    #[test]
    fn tank_empties_as_torricelli_says() {
        let mut time = grid(0.05, 30);
        time[1] = 1e-9;
        let mut signal = vec![0.0; 30];
        signal[0] = 1.5;
        outflow(&time, &mut signal, 2.0, 1.0);
        for (t, z) in time.iter().zip(&signal).skip(1) {
            assert!((z.sqrt() - (1.5 - t / 4.0)).abs() < 1e-6, "{t}: {z}");
        }
    }

    /// Oracle: halving the knots of a straight input changes nothing.
    #[test]
    fn responses_do_not_depend_on_the_knots() {
        let (fine, coarse) = (grid(0.05, 81), grid(0.1, 41));
        let ramp = |time: &[f64]| time.iter().map(|t| 0.7 * t).collect::<Vec<f64>>();
        let responses: [&dyn Fn(&[f64], &mut [f64]); 3] =
            [&|t, u| lag(t, u, 0.3), &|t, u| spring(t, u, 0.9, 0.4), &|t, u| hardening(t, u, [0.9, 0.4, 0.5])];
        for response in responses {
            let (mut one, mut two) = (ramp(&fine), ramp(&coarse));
            response(&fine, &mut one);
            response(&coarse, &mut two);
            assert!(two.iter().enumerate().all(|(k, z)| (z - one[2 * k]).abs() < 1e-5));
        }
    }
}
