//! Operators with memory on irregular time stamps, shared by effects. Signals are straight between samples.

/// First-order lag, exact for a signal that is straight between samples: τ ẏ = x − y, at rest at the first sample.
///
/// ```text
/// y_k = x_k − m τ + (y_{k−1} − x_{k−1} + m τ) e^{−h/τ},   m = (x_k − x_{k−1})/h
/// ```
pub fn lag(time: &[f64], x: &mut [f64], tau: impl Fn(usize) -> f64) {
    let Some((&first, _)) = x.split_first() else { return };
    let (mut before, mut y) = (first, first);
    for t in 1..x.len() {
        let (h, tau, now) = (time[t] - time[t - 1], tau(t), x[t]);
        if tau > 1e-9 {
            let behind = (now - before) / h * tau;
            y = now - behind + (y - before + behind) * (-h / tau).exp();
        } else {
            y = now;
        }
        before = now;
        x[t] = y;
    }
}

/// Play: the output rests while the input moves within ±`width` of it, at first centred.
pub fn play(x: &mut [f64], width: impl Fn(usize) -> f64) {
    let Some((&first, _)) = x.split_first() else { return };
    let mut y = first;
    for (t, x) in x.iter_mut().enumerate() {
        let width = width(t);
        y = y.clamp(*x - width, *x + width);
        *x = y;
    }
}

/// The signal `delay` seconds ago; before the first sample it rests, and after the last it goes on resting.
pub fn delay(time: &[f64], x: &mut [f64], delay: impl Fn(usize) -> f64) {
    let original = x.to_vec();
    let mut k = 0;
    for t in 0..x.len() {
        let then = time[t] - delay(t);
        while k > 0 && time[k] > then {
            k -= 1;
        }
        while k + 2 < time.len() && time[k + 1] <= then {
            k += 1;
        }
        let last = time.len() - 1;
        x[t] = if then <= time[0] || last == 0 {
            original[0]
        } else if then >= time[last] {
            original[last]
        } else {
            let share = (then - time[k]) / (time[k + 1] - time[k]);
            original[k] + share * (original[k + 1] - original[k])
        };
    }
}
