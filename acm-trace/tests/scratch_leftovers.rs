//! Scratch.
#[allow(dead_code)]
#[path = "leftovers/campaign.rs"]
mod campaign;
use std::time::Instant;
use acm_trace::{autocorrelation::autocorrelation, events::events, noise_floor::noise_floor, probe::probe, symbolic::symbolic};
use campaign::{Campaign, LARGE, SMALL, Shape};

#[test]
fn speed() {
    for shape in [LARGE, Shape { actuators: 6, contexts: 4, samples: 1000, ..LARGE }, Shape { actuators: 12, contexts: 4, ..LARGE },
        Shape { trials: 1, samples: 20000, blocks: 10, step: 0.01, outputs: 1, ..LARGE }, Shape { trials: 40, samples: 2000, ..LARGE }] {
        let c = Campaign::new(shape, 1).noise(1e-3, 0.5).on_actuator(0, |_, r| r.actuators[0].iter().map(|q| 0.01 * q * q).collect());
        let r = c.remainder();
        let s = Instant::now(); noise_floor(&r); let a = s.elapsed();
        let s = Instant::now(); probe(&r, 1); let b = s.elapsed();
        let s = Instant::now(); symbolic(&r, &[]); let d = s.elapsed();
        let s = Instant::now(); events(&r); let e = s.elapsed();
        let s = Instant::now(); autocorrelation(&r, &r); let f = s.elapsed();
        println!("{} trials {} samples A {} E {} M {}: floor {a:?} probe {b:?} symbolic {d:?} events {e:?} autocorrelation {f:?}", shape.trials, shape.samples, shape.actuators, shape.contexts, shape.outputs);
    }
}

#[test]
fn alarms() {
    let small = Shape { trials: 6, samples: 100, outputs: 2, ..SMALL };
    let one = Shape { trials: 1, samples: 600, blocks: 8, outputs: 1, ..SMALL };
    let large = Shape { trials: 16, samples: 150, ..SMALL };
    for (name, shape, n) in [("6 trials", small, 100), ("1 record", one, 200), ("16 trials", large, 40)] {
        for phi in [0.0, 0.5, 0.9, 0.99] {
            let (mut p5, mut p1, mut ex, mut sym, mut ev) = (0, 0, 0.0f64, 0, 0); let mut kinds = std::collections::BTreeMap::new();
            for seed in 0..n {
                let c = Campaign::new(shape, 1000 + seed).noise(1e-3, phi);
                let r = c.remainder();
                let p = probe(&r, 7);
                p5 += usize::from(p.p <= 0.05); p1 += usize::from(p.p <= 0.01); if p.p <= 0.05 { ex = ex.max(p.explained); }
                sym += usize::from(symbolic(&r, &[]).is_some());
                let es = events(&r); for e in &es { if e.share > 0.1 { *kinds.entry(e.kind.clone()).or_insert(0) += 1; } }
                ev += usize::from(es.iter().any(|e| e.share > 0.1));
            }
            let f = |k: usize| k as f64 / n as f64;
            println!("{name} phi {phi}: p<=.05 {} p<=.01 {} largest explained among alarms {ex:.3} symbolic {} events>.1 {} {kinds:?}", f(p5), f(p1), f(sym), f(ev));
        }
    }
}
