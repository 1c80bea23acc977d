//! Operators against closed forms, hand arithmetic and small steps of their equations.

use super::*;

fn second_order_lag(time: &[f64], x: &mut [f64], shape: impl Fn(usize) -> (f64, f64)) {
    let (mut lag, mut last) = (SecondOrderLag::default(), Swing::default());
    for (t, (x, time)) in x.iter_mut().zip(time).enumerate() {
        *x = lag.step(*time, *x, shape(t), &mut last);
    }
}

fn delay(time: &[f64], x: &mut [f64], delay: impl Fn(usize) -> f64) {
    DelayLine::default().run(time, x, delay, 1.0);
}

fn rate_limit(time: &[f64], x: &mut [f64], slowness: impl Fn(usize) -> f64) {
    let mut limit = RateLimit::default();
    x.iter_mut().zip(time).enumerate().for_each(|(t, (x, time))| *x = limit.step(*time, *x, slowness(t)));
}

fn bouc_wen(x: &[f64], width: impl Fn(usize) -> f64, asymmetry: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut state = BoucWen::default();
    x.iter().enumerate().map(|(t, x)| state.step(*x, width(t), asymmetry(t))).collect()
}

fn dahl(x: &[f64], presliding: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut state = BoucWen::default();
    x.iter().enumerate().map(|(t, x)| state.dahl(*x, presliding(t))).collect()
}

/// Oracle: the differences themselves, of a clock of 10 ms; as they are they differ by rounding.
#[test]
fn intervals_of_a_regular_clock_are_the_same() {
    let time: Vec<f64> = (0..10_000).map(|k| 12.3 + 0.01 * f64::from(k)).collect();
    let mut found: Vec<f64> = time.windows(2).map(|t| super::interval(t[0], t[1])).collect();
    assert!(found.iter().zip(time.windows(2)).all(|(h, t)| (h / (t[1] - t[0]) - 1.0).abs() < 1.2e-10));
    found.dedup();
    assert!(time.windows(2).any(|t| t[1] - t[0] != time[1] - time[0]) && found.len() == 1, "{found:?}");
    assert_eq!(super::interval(3.0, 3.0), 0.0);
}

/// Irregular time stamps from 0 to 12 s.
fn stamps() -> Vec<f64> {
    (0..=120).map(|k| 0.1 * f64::from(k) + if k % 3 == 1 { 0.043 } else { 0.0 }).collect()
}

fn close(a: &[f64], b: &[f64], within: f64) {
    for (k, (a, b)) in a.iter().zip(b).enumerate() {
        assert!((a - b).abs() <= within, "sample {k}: {a} and not {b}");
    }
}

/// A path through several turning points, sampled so densely that sums are integrals.
fn path(samples: usize) -> Vec<f64> {
    let corners = [0.0, 1.3, -0.4, 0.5, 0.2, 2.0, -1.0];
    let each = samples / (corners.len() - 1);
    let leg = |k: usize| (0..each).map(move |i| corners[k] + (corners[k + 1] - corners[k]) * i as f64 / each as f64);
    (0..corners.len() - 1).flat_map(leg).chain([corners[corners.len() - 1]]).collect()
}

fn every(values: &[f64], n: usize) -> Vec<f64> {
    values.iter().step_by(n).copied().collect()
}

/// Oracle: the lag of a ramp m t is m (t − τ (1 − e^{−t/τ})).
#[test]
fn lag_of_a_ramp() {
    let (time, tau) = (stamps(), 0.7);
    let mut x: Vec<f64> = time.iter().map(|t| 3.0 * t).collect();
    lag(&time, &mut x, |_| tau);
    let exact: Vec<f64> = time.iter().map(|t| 3.0 * (t - tau * (1.0 - (-t / tau).exp()))).collect();
    close(&x, &exact, 1e-9);
}

/// Oracle: the classical ramp responses, under-damped, critical and over-damped, written for y(0) = ẏ(0) = 0.
#[test]
fn second_order_lag_of_a_ramp() {
    let (time, unit) = (stamps(), 0.4);
    let w = 1.0 / unit;
    let exact = |t: f64, z: f64| {
        let steady = t - 2.0 * z / w;
        if z < 1.0 {
            let d = w * (1.0 - z * z).sqrt();
            let swing = 2.0 * z / w * (d * t).cos() + (2.0 * z * z - 1.0) / d * (d * t).sin();
            steady + (-z * w * t).exp() * swing
        } else if z == 1.0 {
            steady + (-w * t).exp() * (2.0 / w + t)
        } else {
            let root = w * (z * z - 1.0).sqrt();
            let (p, q) = (-z * w + root, -z * w - root);
            // c1 + c2 = 2z/w and c1 p + c2 q = -1
            let c1 = (-1.0 - q * 2.0 * z / w) / (p - q);
            steady + c1 * (p * t).exp() + (2.0 * z / w - c1) * (q * t).exp()
        }
    };
    for z in [0.05, 0.3, 0.999_999_999, 1.0, 1.000_000_001, 1.5] {
        let mut x = time.clone();
        second_order_lag(&time, &mut x, |_| (unit, z));
        let as_if = if (z - 1.0f64).abs() < 1e-6 { 1.0 } else { z };
        close(&x, &time.iter().map(|&t| exact(t, as_if)).collect::<Vec<_>>(), 1e-8);
    }
}

/// Oracle: small steps of the equation itself, for a signal with corners.
#[test]
fn second_order_lag_follows_its_equation() {
    let (unit, damping, dense) = (0.35, 0.2, path(600_000));
    let n = 1_000;
    let time: Vec<f64> = (0..every(&dense, n).len()).map(|k| 0.02 * k as f64).collect();
    let h = 0.02 / n as f64;
    let (mut y, mut speed, mut slow) = (dense[0], 0.0, vec![]);
    for (k, x) in dense.iter().enumerate() {
        if k % n == 0 {
            slow.push(y);
        }
        speed += h * ((x - y) / (unit * unit) - 2.0 * damping / unit * speed);
        y += h * speed;
    }
    let mut x = every(&dense, n);
    second_order_lag(&time, &mut x, |_| (unit, damping));
    close(&x, &slow, 1e-3);
}

/// Oracle: by hand, a triangle 0 → 1 → −1 through a play of ±0.25.
#[test]
fn play_of_a_triangle() {
    let mut x = vec![0.0, 0.25, 0.5, 1.0, 0.75, 0.5, 0.25, 0.0, -1.0, -0.75];
    play(&mut x, |_| 0.25);
    close(&x, &[0.0, 0.0, 0.25, 0.75, 0.75, 0.75, 0.5, 0.25, -0.75, -0.75], 1e-15);
}

/// Oracle: a straight line moved in time, and rest before the first sample and after the last.
#[test]
fn delay_of_a_line() {
    let time = stamps();
    for by in [0.37, -0.37, 0.0] {
        let mut x: Vec<f64> = time.iter().map(|t| 1.0 + 2.0 * t).collect();
        delay(&time, &mut x, |_| by);
        let last = time[time.len() - 1];
        let exact: Vec<f64> = time.iter().map(|t| 1.0 + 2.0 * (t - by).clamp(0.0, last)).collect();
        close(&x, &exact, 1e-9);
    }
}

/// Oracle: from rest to x, d = 1 − e^{−x/δ}; back by x', d = −1 + (d + 1) e^{−x'/δ}.
#[test]
fn dahl_there_and_back() {
    let d = dahl(&[2.0, 2.3, 2.5, 2.5, 2.1], |_| 0.2);
    let there = 1.0 - (-0.5f64 / 0.2).exp();
    let back = -1.0 + (there + 1.0) * (-0.4f64 / 0.2).exp();
    close(&d, &[0.0, 1.0 - (-0.3f64 / 0.2).exp(), there, there, back], 1e-14);
}

/// Oracle: Euler steps of the classical equation ż = A v − β|v|z − γ v|z| with A = β + γ.
#[test]
fn bouc_wen_follows_its_equation() {
    let dense = path(600_000);
    for (beta, gamma) in [(2.0, 2.0), (4.0, 0.0), (3.0, 1.0), (3.0, -2.0)] {
        let (mut z, mut slow): (f64, Vec<f64>) = (0.0, vec![0.0]);
        for (k, pair) in dense.windows(2).enumerate() {
            let v = pair[1] - pair[0];
            z += (beta + gamma) * v - beta * v.abs() * z - gamma * v * z.abs();
            if (k + 1) % 2_500 == 0 {
                slow.push(z);
            }
        }
        let (width, a) = (1.0 / (beta + gamma), (beta - gamma) / (beta + gamma));
        close(&bouc_wen(&every(&dense, 2_500), |_| width, |_| a), &slow, 1e-4);
    }
}

/// Bouc–Wen differs from Dahl on the way back alone.
#[test]
fn bouc_wen_is_dahl_when_it_returns_as_it_came() {
    let x = every(&path(600), 10);
    close(&bouc_wen(&x, |_| 0.3, |_| 1.0), &dahl(&x, |_| 0.3), 0.0);
    let other = bouc_wen(&x, |_| 0.3, |_| 0.0);
    assert!((other[10] - dahl(&x, |_| 0.3)[10]).abs() < 1e-15);
    assert!(other.iter().zip(dahl(&x, |_| 0.3)).any(|(a, b)| (a - b).abs() > 0.2));
}

/// Oracle: by hand. At speed 1 behind 0 → 2 in 1 s, then back down to −1 in 1 s: they meet after ¼ s at 1¼, and it goes
/// down by ¾.
#[test]
fn rate_limit_turns_where_it_meets_its_target() {
    let mut x = vec![0.0, 2.0, -1.0, -1.0, -1.0, -0.5];
    rate_limit(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0], &mut x, |_| 1.0);
    close(&x, &[0.0, 1.0, 0.5, -0.5, -1.0, -0.5], 1e-14);
}

/// Oracle: small steps.
#[test]
fn rate_limit_follows_its_equation() {
    let dense = path(600_000);
    let (n, h, speed) = (2_500, 2e-5, 0.55);
    let (mut y, mut slow) = (dense[0], vec![]);
    for (k, x) in dense.iter().enumerate() {
        y += (x - y).clamp(-speed * h, speed * h);
        if k % n == 0 {
            slow.push(y);
        }
    }
    let mut x = every(&dense, n);
    let time: Vec<f64> = (0..x.len()).map(|k| (n * k) as f64 * h).collect();
    rate_limit(&time, &mut x, |_| 1.0 / speed);
    close(&x, &slow, 1e-4);
}

type Operator = fn(&[f64], &[f64]) -> Vec<f64>;

fn after(x: &[f64], work: impl Fn(&mut [f64])) -> Vec<f64> {
    let mut x = x.to_vec();
    work(&mut x);
    x
}

/// One more sample on a straight piece changes nothing at the others.
#[test]
fn exact_on_any_time_stamps() {
    let time = stamps();
    let x: Vec<f64> = time.iter().map(|t| (1.3 * t).sin() + 0.3 * (4.1 * t).cos()).collect();
    let (mut finer, mut fine) = (vec![], vec![]);
    for k in 0..time.len() {
        if k > 0 {
            finer.push(time[k - 1] + 0.3 * (time[k] - time[k - 1]));
            fine.push(x[k - 1] + 0.3 * (x[k] - x[k - 1]));
        }
        finer.push(time[k]);
        fine.push(x[k]);
    }
    let operators: [Operator; 7] = [
        |time, x| after(x, |x| lag(time, x, |_| 0.5)),
        |time, x| after(x, |x| second_order_lag(time, x, |_| (0.3, 0.3))),
        |_, x| after(x, |x| play(x, |_| 0.2)),
        |time, x| after(x, |x| delay(time, x, |_| 0.234)),
        |_, x| dahl(x, |_| 0.2),
        |_, x| bouc_wen(x, |_| 0.2, |_| 0.3),
        |time, x| after(x, |x| rate_limit(time, x, |_| 1.0 / 0.8)),
    ];
    for operator in operators {
        close(&every(&operator(&finer, &fine), 2), &operator(&time, &x), 1e-9);
    }
}

/// Nothing to do, and nothing to fail on.
#[test]
fn empty_and_single() {
    for samples in [0, 1] {
        let (time, mut x) = (vec![5.0; samples], vec![2.0; samples]);
        lag(&time, &mut x, |_| 1.0);
        second_order_lag(&time, &mut x, |_| (1.0, 0.5));
        play(&mut x, |_| 1.0);
        delay(&time, &mut x, |_| 1.0);
        rate_limit(&time, &mut x, |_| 1.0);
        assert_eq!(x, vec![2.0; samples]);
        assert_eq!(dahl(&x, |_| 1.0), vec![0.0; samples]);
    }
}

/// Oracle: by hand. Among later samples the line is symmetric; without them it goes through the two before.
#[test]
fn slopes_of_a_parabola_with_and_without_the_future() {
    let (time, x): (Vec<f64>, Vec<f64>) = (0..8).map(|k| (0.5 * f64::from(k), 0.25 * f64::from(k * k))).unzip();
    let whole = Slopes::default().of(&time, &x).to_vec();
    close(&whole[2..6], &[2.0, 3.0, 4.0, 5.0], 1e-13);
    let mut slopes = Slopes::default();
    let each: Vec<f64> = time.iter().zip(&x).map(|(time, x)| slopes.of(&[*time], &[*x])[0]).collect();
    close(&each, &[0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 1e-13);
    slopes.restart();
    assert_eq!(slopes.of(&[9.0], &[5.0]), [0.0]);
}

/// Oracle: what rests at the first sample rests; a unit in the last place of a large signal would be an effect where nothing moves.
#[test]
fn what_rests_stays_to_the_last_bit() {
    let time: Vec<f64> = (0..500).map(|k| 0.05 * f64::from(k) + 0.01 * f64::from(k % 7)).collect();
    let (mut sprung, mut swing) = (SecondOrderLag::default(), Swing::default());
    let (mut lag, mut decay) = (Lag::default(), Decay::default());
    for time in time {
        assert_eq!(sprung.step(time, 6e5, (1.2, 0.015), &mut swing), 6e5);
        assert_eq!(lag.step(time, 6e5, 0.7, &mut decay), 6e5);
    }
}
