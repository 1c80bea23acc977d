//! Time of a training step: forward, backward and Adam, beside the lower bound by the arithmetic.
//!
//! ```text
//! taskset -c 1 cargo bench --profile dev -p acm-kernels --bench train_step -- [ROUNDS] [NETWORK] [THREADS] [LEVEL]
//! ```
//!
//! H = 32, C = 5, O = 3; CfC over 50 steps with a backbone of 64 units (lecun tanh), GRU over 25, MLP [64, 64].
//! Times are of the processor for one thread, of the clock for two; smallest and median over all rounds. The
//! floor is 6 flops a weight, sample and step (two passes back for one forward) at the rate of a loop of
//! multiply-adds in registers, which is measured in the same run. Activations are not in it.

use std::hint::black_box;
use std::time::{Duration, Instant};

use acm_kernels::{Activation, Body, CfcMode, CfcShape, GruShape, Keep, Kernel, Level, MlpShape, Sequences, Shape};
use cpu_time::ThreadTime;
use pulp::{Simd, WithSimd};

const INPUTS: usize = 5;
const OUTPUTS: usize = 3;

/// A network, its window, and the weights that a sample is multiplied with.
struct Subject {
    name: &'static str,
    body: Body,
    steps: usize,
    weights: usize,
}

fn subjects() -> [Subject; 3] {
    let activation = Activation::LecunTanh;
    let cfc = CfcShape { units: 32, mode: CfcMode::Default, backbone_units: 64, backbone_layers: 1, activation };
    let mlp = MlpShape { hidden: vec![64, 64], activation: Activation::Relu };
    [
        Subject { name: "cfc", body: Body::Cfc(cfc), steps: 50, weights: 50 * ((5 + 1 + 32) * 64 + 65 * 128) },
        Subject {
            name: "gru",
            body: Body::Gru(GruShape { units: 32, layers: 1 }),
            steps: 25,
            weights: 25 * (5 + 1 + 32 + 1) * 96,
        },
        Subject { name: "mlp", body: Body::Mlp(mlp), steps: 1, weights: 6 * 64 + 65 * 64 },
    ]
}

/// Numbers in (−1, 1) without a pattern.
fn noise(count: usize, root: f64) -> Vec<f32> {
    (1..=count).map(|i| (2.0 * (i as f64 * root.sqrt()).fract() - 1.0) as f32).collect()
}

/// Adam with torch's defaults.
struct Adam {
    first: Vec<f32>,
    second: Vec<f32>,
    step: i32,
}

impl Adam {
    fn new(count: usize) -> Self {
        Self { first: vec![0.0; count], second: vec![0.0; count], step: 0 }
    }

    fn step(&mut self, parameters: &mut [f32], gradient: &[f32]) {
        self.step += 1;
        let (first, second) = (1.0 / (1.0 - 0.9f32.powi(self.step)), 1.0 / (1.0 - 0.999f32.powi(self.step)));
        let moments = self.first.iter_mut().zip(&mut self.second);
        for ((p, &g), (m, v)) in parameters.iter_mut().zip(gradient).zip(moments) {
            *m = 0.9 * *m + 0.1 * g;
            *v = 0.999 * *v + 0.001 * g * g;
            *p -= 1e-3 * *m * first / ((*v * second).sqrt() + 1e-8);
        }
    }
}

/// Mean squared error of one shard's predictions, and its derivatives.
fn squares(targets: &[f32], predictions: &[f32], derivatives: &mut [f32], all: usize) -> f64 {
    let scale = 1.0 / all as f32;
    let mut sum = 0.0;
    for ((d, &p), &t) in derivatives.iter_mut().zip(predictions).zip(targets) {
        *d = 2.0 * scale * (p - t);
        sum += scale * (p - t) * (p - t);
    }
    f64::from(sum)
}

/// Smallest and median.
fn order(mut times: Vec<Duration>) -> (f64, f64) {
    times.sort();
    (times[0].as_secs_f64() * 1e3, times[times.len() / 2].as_secs_f64() * 1e3)
}

/// Multiply-adds in registers.
struct Peak(usize);

impl WithSimd for Peak {
    type Output = f32;

    #[inline(always)]
    fn with_simd<S: Simd>(self, s: S) -> f32 {
        let (x, y) = (s.splat_f32s(black_box(0.999_999)), s.splat_f32s(black_box(1e-6)));
        let mut sums = [s.splat_f32s(0.0); 12];
        for (i, sum) in sums.iter_mut().enumerate() {
            *sum = s.splat_f32s(black_box(i as f32));
        }
        for _ in 0..self.0 {
            for sum in &mut sums {
                *sum = s.mul_add_e_f32s(*sum, x, y);
            }
        }
        sums.iter().map(|&sum| s.reduce_sum_f32s(sum)).sum()
    }
}

/// Flops a second of one core.
fn peak(level: Level) -> f64 {
    const TURNS: usize = 1_000_000;
    let lanes = match level {
        Level::Avx512 => 16,
        Level::Avx2 => 8,
        Level::Neon => 4,
        Level::Scalar => 1,
    };
    let once = |_| {
        let start = ThreadTime::now();
        black_box(dispatch(level, Peak(black_box(TURNS))));
        start.elapsed().as_secs_f64()
    };
    let best = (0..20).map(once).fold(f64::MAX, f64::min);
    (2 * 12 * lanes * TURNS) as f64 / best
}

fn dispatch<W: WithSimd>(level: Level, work: W) -> W::Output {
    match level {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => Simd::vectorize(pulp::x86::V4::try_new().expect("available"), work),
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => Simd::vectorize(pulp::x86::V3::try_new().expect("available"), work),
        _ => pulp::Arch::new().dispatch(work),
    }
}

fn main() {
    let mut arguments = std::env::args().skip(1).filter(|argument| !argument.starts_with("--"));
    let rounds: usize = arguments.next().map_or(200, |text| text.parse().expect("a number of rounds"));
    let filter = arguments.next().unwrap_or_default();
    let threads = arguments.next().map_or(vec![1, 2], |text| vec![text.parse().expect("a number of threads")]);
    let only = arguments.next();
    let asked = |level: &Level| only.as_ref().is_none_or(|only| *only == format!("{level:?}"));
    println!("| network | batch | level | threads | pass | min ms | median ms | floor ms | share of rate |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for subject in subjects().iter().filter(|subject| subject.name.contains(&filter)) {
        for batch in [64, 256] {
            for level in Level::available().filter(|&level| level != Level::Scalar).filter(asked) {
                for threads in threads.clone() {
                    for at_once in [true, false] {
                        measure(subject, batch, level, threads, at_once, rounds);
                    }
                }
            }
        }
    }
}

fn measure(subject: &Subject, batch: usize, level: Level, threads: usize, at_once: bool, rounds: usize) {
    let shape = Shape { body: subject.body.clone(), inputs: INPUTS, outputs: OUTPUTS };
    let kernel = Kernel::with_level(&shape, level).expect("sizes are positive");
    let inputs = noise(batch * subject.steps * INPUTS, 2.0);
    let elapsed: Vec<_> = noise(batch * subject.steps, 3.0).iter().map(|t| 0.1 + 0.05 * t).collect();
    let targets = noise(batch * OUTPUTS, 7.0);
    let mut parameters: Vec<_> = noise(kernel.parameters(), 5.0).iter().map(|p| 0.2 * p).collect();
    let (mut gradient, mut work) = (vec![0.0; parameters.len()], kernel.workspace());
    let (mut predictions, mut derivatives) = (targets.clone(), targets.clone());
    let mut adam = Adam::new(parameters.len());
    let sequences =
        Sequences { inputs: &inputs, elapsed: &elapsed, state: None, batch, steps: subject.steps, keep: Keep::Last };
    let mut step = || {
        let loss = |first: usize, p: &[f32], d: &mut [f32]| squares(&targets[first..], p, d, targets.len());
        if at_once {
            black_box(kernel.train(&parameters, &sequences, &loss, &mut work, &mut gradient));
        } else {
            kernel.forward(&parameters, &sequences, &mut work, &mut predictions);
            black_box(loss(0, &predictions, &mut derivatives));
            kernel.backward(&parameters, &sequences, &derivatives, &mut work, &mut gradient);
        }
        adam.step(&mut parameters, &gradient);
    };
    let mut times = Vec::new();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
    pool.install(|| {
        for round in 0..rounds + 5 {
            let (clock, processor) = (Instant::now(), ThreadTime::now());
            step();
            let time = if threads == 1 { processor.elapsed() } else { clock.elapsed() };
            if round >= 5 {
                times.push(time);
            }
        }
    });
    let (least, median) = order(times);
    let flops = (6 * subject.weights * batch) as f64;
    let floor = flops / peak(level) * 1e3 / threads as f64;
    let pass = if at_once { "train" } else { "forward, backward" };
    println!(
        "| {} | {batch} | {level:?} | {threads} | {pass} | {least:.4} | {median:.4} | {floor:.3} | {:.0} % |",
        subject.name,
        100.0 * floor / least
    );
}
