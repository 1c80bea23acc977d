//! Nonlinear regression problems of the NIST Statistical Reference Datasets, from both starting points.
//!
//! Oracle: certified parameters, standard deviations and residual sums of squares,
//! <https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml> (public domain).

use std::ops::Range;

use acm_core::least_squares::Residuals;
use acm_core::levenberg_marquardt::{Bounds, Fit, Options, fit, minimiser};
use nalgebra::DMatrix;

/// Model value and its slopes at x.
type Model = fn(b: &[f64], x: f64, slopes: &mut [f64]) -> f64;

struct Problem {
    name: &'static str,
    model: Model,
    x: &'static [f64],
    y: &'static [f64],
    starts: [&'static [f64]; 2],
    certified: &'static [f64],
    deviations: &'static [f64],
    cost: f64,
}

impl Residuals for Problem {
    fn parameters(&self) -> usize {
        self.certified.len()
    }

    fn samples(&self) -> usize {
        self.x.len()
    }

    fn outputs(&self) -> usize {
        1
    }

    fn residuals(&self, b: &[f64], range: Range<usize>, out: &mut [f64]) {
        let mut unused = vec![0.0; b.len()];
        for (out, k) in out.iter_mut().zip(range) {
            *out = (self.model)(b, self.x[k], &mut unused) - self.y[k];
        }
    }

    fn slopes(&self, b: &[f64], range: Range<usize>, out: &mut [f64], slopes: &mut DMatrix<f64>) {
        let mut row = vec![0.0; b.len()];
        for (k, sample) in range.enumerate() {
            out[k] = (self.model)(b, self.x[sample], &mut row) - self.y[sample];
            slopes.row_mut(k).copy_from_slice(&row);
        }
    }
}

/// b0 (1 − e^(−b1 x)): Misra1a and BoxBOD.
fn saturation(b: &[f64], x: f64, d: &mut [f64]) -> f64 {
    let e = (-b[1] * x).exp();
    d[0] = 1.0 - e;
    d[1] = b[0] * x * e;
    b[0] * d[0]
}

/// Cubic over cubic.
fn thurber(b: &[f64], x: f64, d: &mut [f64]) -> f64 {
    let under = 1.0 + x * (b[4] + x * (b[5] + x * b[6]));
    let value = (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) / under;
    for k in 0..4 {
        d[k] = x.powi(k as i32) / under;
    }
    for k in 1..4 {
        d[3 + k] = -value * x.powi(k as i32) / under;
    }
    value
}

/// b0 (x² + x b1)/(x² + x b2 + b3).
fn mgh09(b: &[f64], x: f64, d: &mut [f64]) -> f64 {
    let (over, under) = (x * x + x * b[1], x * x + x * b[2] + b[3]);
    let value = b[0] * over / under;
    d[0] = over / under;
    d[1] = b[0] * x / under;
    d[2] = -value * x / under;
    d[3] = -value / under;
    value
}

/// b0 e^(b1/(x + b2)).
fn mgh10(b: &[f64], x: f64, d: &mut [f64]) -> f64 {
    let place = x + b[2];
    let e = (b[1] / place).exp();
    d[0] = e;
    d[1] = b[0] * e / place;
    d[2] = -b[0] * e * b[1] / (place * place);
    b[0] * e
}

/// b0 + b1 e^(−b3 x) + b2 e^(−b4 x).
fn mgh17(b: &[f64], x: f64, d: &mut [f64]) -> f64 {
    d[0] = 1.0;
    d[1] = (-b[3] * x).exp();
    d[2] = (-b[4] * x).exp();
    d[3] = -b[1] * x * d[1];
    d[4] = -b[2] * x * d[2];
    b[0] + b[1] * d[1] + b[2] * d[2]
}

/// b0/(1 + e^(b1 − b2 x)).
fn rat42(b: &[f64], x: f64, d: &mut [f64]) -> f64 {
    let e = (b[1] - b[2] * x).exp();
    d[0] = 1.0 / (1.0 + e);
    d[1] = -b[0] * e * d[0] * d[0];
    d[2] = -x * d[1];
    b[0] * d[0]
}

/// b0/(1 + e^(b1 − b2 x))^(1/b3).
fn rat43(b: &[f64], x: f64, d: &mut [f64]) -> f64 {
    let e = (b[1] - b[2] * x).exp();
    d[0] = (1.0 + e).powf(-1.0 / b[3]);
    let value = b[0] * d[0];
    d[1] = -value * e / ((1.0 + e) * b[3]);
    d[2] = -x * d[1];
    d[3] = value * (1.0 + e).ln() / (b[3] * b[3]);
    value
}

/// b0/b1 e^(−((x − b2)/b1)²/2).
fn eckerle4(b: &[f64], x: f64, d: &mut [f64]) -> f64 {
    let z = (x - b[2]) / b[1];
    let value = b[0] / b[1] * (-0.5 * z * z).exp();
    d[0] = value / b[0];
    d[1] = value * (z * z - 1.0) / b[1];
    d[2] = value * z / b[1];
    value
}

#[rustfmt::skip]
const PROBLEMS: [Problem; 9] = [
    Problem {
        name: "Misra1a (lower)",
        model: saturation,
        x: &[77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0],
        y: &[10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78],
        starts: [&[500.0, 0.0001], &[250.0, 0.0005]],
        certified: &[2.3894212918E+02, 5.5015643181E-04],
        deviations: &[2.7070075241E+00, 7.2668688436E-06],
        cost: 1.2455138894E-01,
    },
    Problem {
        name: "MGH17 (average)",
        model: mgh17,
        x: &[0., 10., 20., 30., 40., 50., 60., 70., 80., 90., 100., 110., 120., 130., 140., 150., 160., 170., 180., 190., 200.,
            210., 220., 230., 240., 250., 260., 270., 280., 290., 300., 310., 320.],
        y: &[0.844, 0.908, 0.932, 0.936, 0.925, 0.908, 0.881, 0.850, 0.818, 0.784, 0.751, 0.718, 0.685, 0.658, 0.628, 0.603, 0.580,
            0.558, 0.538, 0.522, 0.506, 0.490, 0.478, 0.467, 0.457, 0.448, 0.438, 0.431, 0.424, 0.420, 0.414, 0.411, 0.406],
        starts: [&[50.0, 150.0, -100.0, 1.0, 2.0], &[0.5, 1.5, -1.0, 0.01, 0.02]],
        certified: &[3.7541005211E-01, 1.9358469127E+00, -1.4646871366E+00, 1.2867534640E-02, 2.2122699662E-02],
        deviations: &[2.0723153551E-03, 2.2031669222E-01, 2.2175707739E-01, 4.4861358114E-04, 8.9471996575E-04],
        cost: 5.4648946975E-05,
    },
    Problem {
        name: "Thurber (higher)",
        model: thurber,
        x: &[-3.067, -2.981, -2.921, -2.912, -2.840, -2.797, -2.702, -2.699, -2.633, -2.481, -2.363, -2.322, -1.501, -1.460, -1.274,
            -1.212, -1.100, -1.046, -0.915, -0.714, -0.566, -0.545, -0.400, -0.309, -0.109, -0.103, 0.010, 0.119, 0.377, 0.790, 0.963,
            1.006, 1.115, 1.572, 1.841, 2.047, 2.200],
        y: &[80.574, 84.248, 87.264, 87.195, 89.076, 89.608, 89.868, 90.101, 92.405, 95.854, 100.696, 101.060, 401.672, 390.724,
            567.534, 635.316, 733.054, 759.087, 894.206, 990.785, 1090.109, 1080.914, 1122.643, 1178.351, 1260.531, 1273.514,
            1288.339, 1327.543, 1353.863, 1414.509, 1425.208, 1421.384, 1442.962, 1464.350, 1468.705, 1447.894, 1457.628],
        starts: [&[1000.0, 1000.0, 400.0, 40.0, 0.7, 0.3, 0.03], &[1300.0, 1500.0, 500.0, 75.0, 1.0, 0.4, 0.05]],
        certified: &[1.2881396800E+03, 1.4910792535E+03, 5.8323836877E+02, 7.5416644291E+01, 9.6629502864E-01, 3.9797285797E-01,
            4.9727297349E-02],
        deviations: &[4.6647963344E+00, 3.9571156086E+01, 2.8698696102E+01, 5.5675370270E+00, 3.1333340687E-02, 1.4984928198E-02,
            6.5842344623E-03],
        cost: 5.6427082397E+03,
    },
    Problem {
        name: "MGH09 (higher)",
        model: mgh09,
        x: &[4.0, 2.0, 1.0, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625],
        y: &[0.1957, 0.1947, 0.1735, 0.16, 0.0844, 0.0627, 0.0456, 0.0342, 0.0323, 0.0235, 0.0246],
        starts: [&[25.0, 39.0, 41.5, 39.0], &[0.25, 0.39, 0.415, 0.39]],
        certified: &[1.9280693458E-01, 1.9128232873E-01, 1.2305650693E-01, 1.3606233068E-01],
        deviations: &[1.1435312227E-02, 1.9633220911E-01, 8.0842031232E-02, 9.0025542308E-02],
        cost: 3.0750560385E-04,
    },
    Problem {
        name: "MGH10 (higher)",
        model: mgh10,
        x: &[50., 55., 60., 65., 70., 75., 80., 85., 90., 95., 100., 105., 110., 115., 120., 125.],
        y: &[34780., 28610., 23650., 19630., 16370., 13720., 11540., 9744., 8261., 7030., 6005., 5147., 4427., 3820., 3307., 2872.],
        starts: [&[2.0, 400_000.0, 25_000.0], &[0.02, 4000.0, 250.0]],
        certified: &[5.6096364710E-03, 6.1813463463E+03, 3.4522363462E+02],
        deviations: &[1.5687892471E-04, 2.3309021107E+01, 7.8486103508E-01],
        cost: 8.7945855171E+01,
    },
    Problem {
        name: "Rat42 (higher)",
        model: rat42,
        x: &[9., 14., 21., 28., 42., 57., 63., 70., 79.],
        y: &[8.930, 10.800, 18.590, 22.330, 39.350, 56.110, 61.730, 64.620, 67.080],
        starts: [&[100.0, 1.0, 0.1], &[75.0, 2.5, 0.07]],
        certified: &[7.2462237576E+01, 2.6180768402E+00, 6.7359200066E-02],
        deviations: &[1.7340283401E+00, 8.8295217536E-02, 3.4465663377E-03],
        cost: 8.0565229338E+00,
    },
    Problem {
        name: "Rat43 (higher)",
        model: rat43,
        x: &[1., 2., 3., 4., 5., 6., 7., 8., 9., 10., 11., 12., 13., 14., 15.],
        y: &[16.08, 33.83, 65.80, 97.20, 191.55, 326.20, 386.87, 520.53, 590.03, 651.92, 724.93, 699.56, 689.96, 637.56, 717.41],
        starts: [&[100.0, 10.0, 1.0, 1.0], &[700.0, 5.0, 0.75, 1.3]],
        certified: &[6.9964151270E+02, 5.2771253025E+00, 7.5962938329E-01, 1.2792483859E+00],
        deviations: &[1.6302297817E+01, 2.0828735829E+00, 1.9566123451E-01, 6.8761936385E-01],
        cost: 8.7864049080E+03,
    },
    Problem {
        name: "Eckerle4 (higher)",
        model: eckerle4,
        x: &[400.0, 405.0, 410.0, 415.0, 420.0, 425.0, 430.0, 435.0, 436.5, 438.0, 439.5, 441.0, 442.5, 444.0, 445.5, 447.0, 448.5, 450.0,
            451.5, 453.0, 454.5, 456.0, 457.5, 459.0, 460.5, 462.0, 463.5, 465.0, 470.0, 475.0, 480.0, 485.0, 490.0, 495.0, 500.0],
        y: &[0.0001575, 0.0001699, 0.0002350, 0.0003102, 0.0004917, 0.0008710, 0.0017418, 0.0046400, 0.0065895, 0.0097302, 0.0149002,
            0.0237310, 0.0401683, 0.0712559, 0.1264458, 0.2073413, 0.2902366, 0.3445623, 0.3698049, 0.3668534, 0.3106727, 0.2078154,
            0.1164354, 0.0616764, 0.0337200, 0.0194023, 0.0117831, 0.0074357, 0.0022732, 0.0008800, 0.0004579, 0.0002345, 0.0001586,
            0.0001143, 0.0000710],
        starts: [&[1.0, 10.0, 500.0], &[1.5, 5.0, 450.0]],
        certified: &[1.5543827178E+00, 4.0888321754E+00, 4.5154121844E+02],
        deviations: &[1.5408051163E-02, 4.6803020753E-02, 4.6800518816E-02],
        cost: 1.4635887487E-03,
    },
    Problem {
        name: "BoxBOD (higher)",
        model: saturation,
        x: &[1., 2., 3., 5., 7., 10.],
        y: &[109., 149., 149., 191., 213., 224.],
        starts: [&[1.0, 1.0], &[100.0, 0.75]],
        certified: &[2.1380940889E+02, 5.4723748542E-01],
        deviations: &[1.2354515176E+01, 1.0455993237E-01],
        cost: 1.1680088766E+03,
    },
];

fn exact() -> Options {
    Options { iterations: 2000, cost: 1e-15, step: 1e-14, gradient: 1e-14, ..Options::default() }
}

/// −log10 of the largest relative error.
fn digits(mine: &[f64], certified: &[f64]) -> f64 {
    let errors = mine.iter().zip(certified).map(|(m, c)| ((m - c) / c).abs());
    -errors.fold(1e-16, f64::max).log10()
}

fn deviations(fit: &Fit) -> Vec<f64> {
    let found = fit.deviations();
    found.into_iter().map(|sd| sd.unwrap_or(f64::NAN)).collect()
}

#[test]
fn certified_values_from_both_starts() {
    let mut failures = Vec::new();
    for problem in &PROBLEMS {
        for (number, start) in problem.starts.iter().enumerate() {
            let found = fit(problem, start, &Bounds::none(start.len()), &exact());
            let (theta, sd) =
                (digits(&found.theta, problem.certified), digits(&deviations(&found), problem.deviations));
            let cost = digits(&[found.cost], &[problem.cost]);
            let line = format!(
                "{:18} start {}: {theta:4.1} digits, sd {sd:4.1}, sum of squares {cost:4.1}, {} iterations, {:?}",
                problem.name,
                number + 1,
                found.iterations,
                found.stopped
            );
            println!("{line}");
            let alone = minimiser(problem, start, &Bounds::none(start.len()), &exact());
            let passed = theta >= 6.0 && sd >= 5.0 && cost >= 8.0 && found.stopped.converged() && alone == found.theta;
            if !passed {
                failures.push(line);
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Oracle: with b0 held at or below 200 the best b1 solves a one-dimensional problem, found here by bisection
/// on its derivative.
#[test]
fn a_bound_that_binds_gives_the_constrained_minimum() {
    let problem = &PROBLEMS[8];
    let bounds = Bounds { lower: vec![0.0, 0.0], upper: vec![200.0, 10.0] };
    let found = fit(problem, &[100.0, 0.75], &bounds, &exact());
    let slope = |b1: f64| -> f64 {
        let b = [200.0, b1];
        let mut d = [0.0; 2];
        let terms = problem.x.iter().zip(problem.y).map(|(x, y)| {
            let value = saturation(&b, *x, &mut d);
            (value - y) * d[1]
        });
        terms.sum()
    };
    let (mut low, mut high) = (0.1, 3.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if slope(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    assert_eq!(found.theta[0], 200.0);
    assert!((found.theta[1] - low).abs() < 1e-7, "{} {low}", found.theta[1]);
    assert!(found.stopped.converged());
    assert_eq!(found.deviations()[0], None);
}

/// A fit that is cut short says so.
#[test]
fn too_few_iterations_are_reported() {
    let problem = &PROBLEMS[4];
    let options = Options { iterations: 3, ..exact() };
    let found = fit(problem, problem.starts[0], &Bounds::none(3), &options);
    assert!(!found.stopped.converged(), "{:?}", found.stopped);
}

/// A problem whose parameters are counted in other units: b = unit·c.
struct OtherUnits<'a> {
    problem: &'a Problem,
    units: &'a [f64],
}

impl OtherUnits<'_> {
    fn usual(&self, c: &[f64]) -> Vec<f64> {
        c.iter().zip(self.units).map(|(c, unit)| c * unit).collect()
    }
}

impl Residuals for OtherUnits<'_> {
    fn parameters(&self) -> usize {
        self.problem.parameters()
    }

    fn samples(&self) -> usize {
        self.problem.samples()
    }

    fn outputs(&self) -> usize {
        1
    }

    fn residuals(&self, c: &[f64], range: Range<usize>, out: &mut [f64]) {
        self.problem.residuals(&self.usual(c), range, out);
    }

    fn slopes(&self, c: &[f64], range: Range<usize>, out: &mut [f64], slopes: &mut DMatrix<f64>) {
        self.problem.slopes(&self.usual(c), range, out, slopes);
        for (mut column, unit) in slopes.column_iter_mut().zip(self.units) {
            column *= *unit;
        }
    }
}

/// Oracle: powers of two change no digit, so the search in other units takes the very same steps.
#[test]
fn units_of_the_parameters_do_not_matter() {
    let problem = &PROBLEMS[6];
    let units = [2f64.powi(30), 2f64.powi(-20), 2f64.powi(12), 0.5];
    let start = problem.starts[0];
    let usual = fit(problem, start, &Bounds::none(4), &exact());
    let other = OtherUnits { problem, units: &units };
    let scaled: Vec<f64> = start.iter().zip(units).map(|(b, unit)| b / unit).collect();
    let found = fit(&other, &scaled, &Bounds::none(4), &exact());
    assert_eq!(found.iterations, usual.iterations);
    for (mine, theirs) in other.usual(&found.theta).iter().zip(&usual.theta) {
        assert!((mine / theirs - 1.0).abs() < 1e-12);
    }
}
