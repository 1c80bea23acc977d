//! Time of a training step over batch, window and units, and with a second core; and that of tips over samples.
//!
//! ```text
//! cargo run -p acm-eval --example scaling -- FILE.svg
//! ```
//!
//! Smallest of many runs of one point, by the clock; the numbers go to standard output as CSV.

use std::time::Instant;

use acm_models::burn::tensor::Device;
use acm_models::{CfcConfig, Engine, GruConfig, Keep, MlpConfig, Network, NetworkConfig};
use acm_train::learn::examples::batch::Batch;
use acm_train::learn::loss::mean_square;
use kuva::{
    backend::svg::SvgBackend,
    plot::LinePlot,
    render::{
        figure::Figure,
        layout::{Layout, TickFormat},
        plots::Plot,
    },
};

const CHANNELS: usize = 5;
const OUTPUTS: usize = 3;

/// A line of a panel: points (x, ms).
struct Line {
    name: &'static str,
    threads: usize,
    points: Vec<(f64, f64)>,
}

/// Networks with their colours.
const KINDS: [(&str, &str); 3] = [("cfc", "#0072b2"), ("gru", "#d55e00"), ("mlp", "#009e73")];

fn main() {
    let file = std::env::args().nth(1).unwrap_or_else(|| "scaling.svg".into());
    println!("panel,network,threads,x,ms");
    let batches = [8, 16, 32, 64, 128, 256, 512, 1024];
    let of_batch = |kind, threads| line(kind, threads, &batches, |batch| (batch, window(kind), 32));
    let of_window = |kind, threads| line(kind, threads, &[5, 10, 20, 40, 80, 160], |steps| (64, steps, 32));
    let of_units = |kind, threads| line(kind, threads, &[4, 8, 16, 32, 64, 128], |units| (64, window(kind), units));
    let both = |kinds: &[&'static str], line: &dyn Fn(&'static str, usize) -> Line| -> Vec<Line> {
        kinds.iter().flat_map(|&kind| [1, 2].map(|threads| line(kind, threads))).collect()
    };
    let panels = [
        ("batch (GRU 25 steps, CfC 50; 32 units)", both(&["cfc", "gru", "mlp"], &of_batch)),
        ("steps of the window (batch 64, 32 units)", both(&["cfc", "gru"], &of_window)),
        ("units (batch 64; GRU 25 steps, CfC 50)", both(&["cfc", "gru"], &of_units)),
    ];
    for (name, lines) in &panels {
        for line in lines {
            line.points.iter().for_each(|(x, ms)| println!("{name:?},{},{},{x},{ms:.4}", line.name, line.threads));
        }
    }
    std::fs::write(&file, drawn(panels)).expect("the file can be written");
}

/// Returns the default number of steps of a window.
fn window(kind: &str) -> usize {
    match kind {
        "cfc" => 50,
        "gru" => 25,
        _ => 1,
    }
}

/// Measures the times at each x; `sizes` gives batch, window and units there.
fn line(kind: &'static str, threads: usize, xs: &[usize], sizes: impl Fn(usize) -> (usize, usize, usize)) -> Line {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
    let at = |&x: &usize| {
        let (batch, steps, units) = sizes(x);
        (x as f64, pool.install(|| milliseconds(kind, batch, steps, units)))
    };
    Line { name: kind, threads, points: xs.iter().map(at).collect() }
}

/// Returns the loss and gradient of one batch.
fn milliseconds(kind: &str, count: usize, steps: usize, units: usize) -> f64 {
    let config = match kind {
        "cfc" => NetworkConfig::Cfc(CfcConfig { units, backbone_units: 2 * units, ..CfcConfig::default() }),
        "gru" => NetworkConfig::Gru(GruConfig { units, ..GruConfig::default() }),
        _ => NetworkConfig::Mlp(MlpConfig { hidden: vec![2 * units; 2], ..MlpConfig::default() }),
    };
    let network = Network::new(&config, CHANNELS, OUTPUTS, 1, &Device::flex());
    let (mut engine, weights) = (Engine::new(&network), network.values());
    let mut gradient = vec![0.0; weights.len()];
    let noise = |count: usize| (0..count).map(|i| (0.7 * i as f32).sin()).collect::<Vec<f32>>();
    let elapsed = vec![0.1; count * steps];
    let batch = Batch::new(noise(count * steps * CHANNELS), elapsed, noise(count * OUTPUTS), steps, Keep::Last);
    let mut once = || {
        let begun = Instant::now();
        engine.gradient(&weights, &batch.windows(), &mean_square(&batch.targets), &mut gradient);
        1e3 * begun.elapsed().as_secs_f64()
    };
    once();
    let (begun, mut least) = (Instant::now(), f64::INFINITY);
    while begun.elapsed().as_secs_f64() < 0.25 {
        least = least.min(once());
    }
    least
}

/// Draws panels side by side, both axes logarithmic.
fn drawn(panels: [(&'static str, Vec<Line>); 3]) -> String {
    let (mut plots, mut layouts) = (vec![], vec![]);
    for (k, (name, lines)) in panels.into_iter().enumerate() {
        let all = || lines.iter().flat_map(|line| line.points.iter());
        let range = |pick: fn(&(f64, f64)) -> f64| {
            all().map(pick).fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)))
        };
        let layout = Layout::new(range(|p| p.0), range(|p| p.1))
            .with_log_scale()
            .with_x_label(name)
            .with_y_label(if k == 0 { "forward and backward, ms" } else { "" })
            .with_tick_format(TickFormat::Auto)
            .with_label_size(14)
            .with_tick_size(13);
        plots.push(lines.into_iter().map(|line| plotted(&line, k == 0)).collect::<Vec<Plot>>());
        layouts.push(layout);
    }
    let scene = Figure::new(1, 3)
        .with_shared_legend_bottom()
        .with_cell_size(380.0, 330.0)
        .with_plots(plots)
        .with_layouts(layouts)
        .render();
    SvgBackend::new().render_scene(&scene)
}

fn plotted(line: &Line, named: bool) -> Plot {
    let colour = KINDS.iter().find(|(kind, _)| *kind == line.name).map_or("#000000", |(_, colour)| colour);
    let plot = LinePlot::new().with_data(line.points.clone()).with_color(colour).with_stroke_width(2.0);
    let plot = if line.threads == 2 { plot.with_dashed() } else { plot };
    let cores = if line.threads == 2 { "2 cores" } else { "1 core" };
    if named { plot.with_legend(format!("{}, {cores}", line.name)).into() } else { plot.into() }
}
