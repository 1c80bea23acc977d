//! Time of one training step: forward, loss, backward, clip, Adam, as in a fit. The batch is given; the benchmark
//! `gather` measures the time to gather it.
//!
//! ```text
//! cargo run -p acm-train --example training_step -- [--plain] [--threads N] [--batches 64,256] [--only KIND] [--rounds N]
//! ```
//!
//! H = 32, 5 channels, 3 outputs; MLP [64, 64], GRU over 25 steps, CfC over 50 with a backbone of 64 units. `--plain` takes
//! tensor operations in the place of the fused kernels. Wall and processor time of each step; the smallest and the median.

use std::time::{Duration, Instant};

use acm_models::burn::tensor::Device;
use acm_models::optimizer::clip::clip;
use acm_models::optimizer::moments::Moments;
use acm_models::{Engine, Keep, Network, NetworkConfig};
use acm_train::config::OptimizerKind;
use acm_train::learn::examples::batch::Batch;
use acm_train::learn::loss::mean_square;
use acm_train::learn::optimizer::step;
use clap::Parser;
use cpu_time::ProcessTime;

const CHANNELS: usize = 5;
const OUTPUTS: usize = 3;

/// Steps before the clock starts, and the time after which no further round begins.
const WARM: usize = 5;
const BUDGET: Duration = Duration::from_secs(12);

#[derive(Parser)]
struct Asked {
    /// Tensor operations in the place of the fused kernels
    #[arg(long)]
    plain: bool,
    /// Threads of the fused kernels
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Windows in a batch
    #[arg(long, value_delimiter = ',', default_value = "64,256")]
    batches: Vec<usize>,
    /// One kind of network
    #[arg(long)]
    only: Option<String>,
    /// Steps that are timed
    #[arg(long, default_value_t = 200)]
    rounds: usize,
}

fn main() {
    let asked = Asked::parse();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(asked.threads).build().expect("threads can be started");
    for &batch in &asked.batches {
        for config in NetworkConfig::all() {
            if asked.only.as_ref().is_none_or(|kind| kind == config.kind()) {
                pool.install(|| time(&asked, &config, batch));
            }
        }
    }
}

fn time(asked: &Asked, config: &NetworkConfig, count: usize) {
    let steps = match config {
        NetworkConfig::Mlp(_) => 1,
        NetworkConfig::Gru(_) => 25,
        NetworkConfig::Cfc(_) => 50,
    };
    let network = Network::new(config, CHANNELS, OUTPUTS, 1, &Device::flex());
    let network = if asked.plain { network.plain() } else { network };
    let mut engine = Engine::new(&network);
    let mut weights = network.values();
    let (mut moments, mut gradient) = (Moments::new(weights.len()), vec![0.0; weights.len()]);
    let batch = Batch::new(
        noise(count * steps * CHANNELS, 2.0),
        noise(count * steps, 3.0).iter().map(|v| 0.1 + 0.05 * v).collect(),
        noise(count * OUTPUTS, 5.0),
        steps,
        Keep::Last,
    );
    let mut step = || {
        let loss = engine.gradient(&weights, &batch.windows(), &mean_square(&batch.targets), &mut gradient);
        clip(&mut gradient, 1.0);
        step(OptimizerKind::Adam, 0.0, 1e-3, &mut moments, &mut weights, &gradient);
        loss
    };
    let first = step();
    (0..WARM).for_each(|_| {
        step();
    });
    let (mut wall, mut processor, begun) = (vec![], vec![], Instant::now());
    let mut last = first;
    while wall.len() < asked.rounds && begun.elapsed() < BUDGET {
        let (clock, own) = (Instant::now(), ProcessTime::now());
        last = step();
        processor.push(1e3 * own.elapsed().as_secs_f64());
        wall.push(1e3 * clock.elapsed().as_secs_f64());
    }
    wall.sort_by(f64::total_cmp);
    processor.sort_by(f64::total_cmp);
    let way = if asked.plain { "burn" } else { "acm" };
    let (middle, rounds) = (wall.len() / 2, wall.len());
    println!(
        "{way}-{}t {} B={count} T={steps} wall min {:.3} med {:.3} ms | cpu min {:.3} med {:.3} ms | loss {first:.3}->{last:.3} \
         n={rounds}",
        asked.threads,
        config.kind(),
        wall[0],
        wall[middle],
        processor[0],
        processor[middle],
    );
}

/// Numbers in (−1, 1) without a pattern: the fractional parts of multiples of √2, √3, ….
fn noise(count: usize, root: f64) -> Vec<f32> {
    (1..=count).map(|i| (2.0 * (i as f64 * root.sqrt()).fract() - 1.0) as f32).collect()
}
