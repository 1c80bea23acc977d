//! Second-order lag: ÿ + 2ζω ẏ + ω² y = ω² x, at rest at the first sample.
//!
//! A signal of slope m leaves the deviation e = y − x + 2ζm/ω to swing freely, with s = ω √(1 − ζ²):
//!
//! ```text
//! e_k = e^{−ζωh} ((cos sh + ζω sin(sh)/s) e_{k−1} + sin(sh)/s ė_{k−1})
//! ė_k = e^{−ζωh} ((cos sh − ζω sin(sh)/s) ė_{k−1} − ω² sin(sh)/s e_{k−1})
//! ```

use super::{Last, Point, State};

/// Solution of the free oscillation for the last angle ωh and damping ζ.
pub type Swing = Last<(f64, f64), (f64, f64)>;

/// See the head of this file.
#[derive(Debug, Clone, Copy, Default)]
pub struct SecondOrderLag {
    before: Option<Point>,
    y: f64,
    speed: f64,
}

impl State for SecondOrderLag {}

impl SecondOrderLag {
    /// The sprung signal at the next sample; `unit` is 1/ω, s, `damping` is ζ. Signals with the same
    /// time stamps share `last`.
    #[inline]
    pub fn step(&mut self, time: f64, x: f64, (unit, damping): (f64, f64), last: &mut Swing) -> f64 {
        let (h, past) = Point::since(self.before, time, x);
        let slope = if h > 0.0 { (x - past) / h } else { 0.0 };
        if h > 0.0 && unit > 1e-9 {
            let behind = 2.0 * damping * slope * unit;
            let (e, rate) = (self.y - past + behind, self.speed - slope);
            let (cosine, sine) = last.of((h / unit, damping), || swing(h / unit, damping));
            self.y = x - behind + (cosine + damping * sine) * e + sine * unit * rate;
            self.speed = slope + (cosine - damping * sine) * rate - sine / unit * e;
        } else {
            (self.y, self.speed) = (x, slope);
        }
        self.before = Some(Point { time, x });
        self.y
    }
}

/// e^{−ζa} cos(sa) and e^{−ζa} sin(sa)/s with s = √(1 − ζ²), continued through ζ = 1, where s is imaginary beyond.
pub(super) fn swing(angle: f64, damping: f64) -> (f64, f64) {
    let square = 1.0 - damping * damping;
    let s = square.abs().sqrt();
    let fade = (-damping * angle).exp();
    if s * angle < 1e-4 {
        let bent = square * angle * angle;
        (fade * (1.0 - bent / 2.0), fade * angle * (1.0 - bent / 6.0))
    } else if square > 0.0 {
        (fade * (s * angle).cos(), fade * (s * angle).sin() / s)
    } else {
        let (slow, fast) = ((-(damping - s) * angle).exp(), (-(damping + s) * angle).exp());
        (0.5 * (slow + fast), 0.5 * (slow - fast) / s)
    }
}
