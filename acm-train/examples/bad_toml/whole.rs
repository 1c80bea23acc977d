//! Configuration files in order, with every key written down, one a line: what is spoiled.

/// Command that reads a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reader {
    /// Reader of an experiment.
    Experiment,
    /// Reader of a list of experiments: ablation, comparison, sweep, search for the best model.
    List,
    /// Reader of the nominal study.
    Nominal,
    /// Reader of the residual study.
    Residual,
    /// Reader of a question about sequences.
    Sequences,
    /// Reader of the manifest of a data set.
    Manifest,
}

/// A file in order, and its name on the disk.
pub struct Whole {
    pub reader: Reader,
    pub file: &'static str,
    pub text: &'static str,
}

/// Files that together have every key that can be written.
pub const ALL: &[Whole] = &[
    Whole { reader: Reader::Experiment, file: "experiment.toml", text: EXPERIMENT },
    Whole { reader: Reader::Experiment, file: "carried.toml", text: CARRIED },
    Whole { reader: Reader::Experiment, file: "ridge.toml", text: RIDGE },
    Whole { reader: Reader::Experiment, file: "trees.toml", text: TREES },
    Whole { reader: Reader::List, file: "ablation.toml", text: ABLATION },
    Whole { reader: Reader::List, file: "sweep.toml", text: SWEEP },
    Whole { reader: Reader::List, file: "best.toml", text: BEST },
    Whole { reader: Reader::Nominal, file: "nominal.toml", text: NOMINAL },
    Whole { reader: Reader::Residual, file: "residual.toml", text: RESIDUAL },
    Whole { reader: Reader::Sequences, file: "streams.toml", text: STREAMS },
    Whole { reader: Reader::Sequences, file: "tables.toml", text: TABLES },
    Whole { reader: Reader::Manifest, file: "manifest.toml", text: MANIFEST },
    Whole { reader: Reader::Manifest, file: "manifest.toml", text: PREDICTED },
];

/// Experiment that lists of experiments name as their base.
pub const EXPERIMENT: &str = r#"question = "What does memory gain?"
data = "data"
device = "flex"
[nominal]
model = "strain"
length = 0.62
axis = "-z"
degree = 3
steps = 40
tolerance = 1e-9
comparator_degree = 3
[nominal.strain]
basis = "legendre"
order = 1
[inputs]
channels = ["q1", "q2"]
domain_filter = "hull"
learn_from = ["development"]
shuffled = ["q1"]
[windows]
length = 50
reach = 50
stride = 1
evaluation_stride = 1
max_gap = 0.5
target = "last"
elapsed = "measured"
[network]
kind = "cfc"
corrects = ["tip"]
units = 32
mode = "default"
backbone_units = 64
backbone_layers = 1
activation = "lecun_tanh"
[training]
epochs = 60
batch = 64
learning_rate = 1e-3
optimizer = "adam"
weight_decay = 0.0
warm_up = 0
clip_norm = 1.0
dropout = 0.1
patience = 10
output_layer = "zero"
ensemble = 2
imported = { file = "net.safetensors", sha256 = "00" }
[training.schedule]
kind = "plateau"
patience = 5
factor = 0.5
[protocol]
cross_validation = false
final = true
validation_fold = 0
seeds = [1, 2, 3]
folds = [["1", "4", "7"], ["2", "5", "8"]]
held_out = ["10"]
"#;

const CARRIED: &str = r#"question = "What does a state gain that is carried through trials?"
data = "data"
[inputs]
straight_path = true
[memory]
state = "trial"
length = 200
burn_in = 50
[network]
kind = "gru"
units = 8
layers = 1
[training]
epochs = 24
epoch_steps = 50
first_values = "lecun"
"#;

const RIDGE: &str = r#"question = "What does a line gain?"
data = "data"
[nominal]
augmented = "model.json"
augmented_sha256 = "00"
[baseline]
kind = "ridge"
lags = 25
penalties = [1e-3, 1.0]
[network]
kind = "mlp"
hidden = [64, 64]
activation = "relu"
[training.schedule]
kind = "cosine"
floor = 0.01
"#;

const TREES: &str = r#"question = "What do trees gain?"
data = "data"
[nominal.strain]
basis = "piecewise"
segments = 3
[baseline]
kind = "boosted_trees"
lags = [0, 1, 2]
rounds = 300
patience = 20
learning_rate = 0.1
depth = 5
leaf_windows = 20
penalty = 1.0
[network]
kind = "gru"
units = 32
layers = 1
[training.schedule]
kind = "step"
every = 20
factor = 0.5
[inputs]
select = true
chosen_from = ["q1", "q2"]
[protocol]
leave_out = "altitude"
"#;

const ABLATION: &str = r#"study = "ablation"
question = "Which inputs carry the estimate?"
[set]
protocol.seeds = [1, 2]
training.epochs = 20
[[base]]
name = "CfC"
experiment = "experiment.toml"
set.training.learning_rate = 2e-3
[[variant]]
name = "all inputs"
[[variant]]
name = "short windows"
only = ["CfC"]
set.windows.length = 25
set.windows.max_gap = 0.4
set.inputs.channels = ["q1"]
set.network.units = 16
"#;

const SWEEP: &str = r#"study = "sweep"
question = "Which window?"
[[base]]
name = "CfC"
experiment = "experiment.toml"
[sweep]
sampler = "grid"
count = 24
seed = 1
batch = 4
eta = 3
[sweep.space]
"windows.length" = [10, 25]
"training.learning_rate" = { low = 1e-4, high = 1e-2, log = true, steps = 3 }
"#;

const BEST: &str = r#"study = "best"
question = "Which model?"
[[base]]
name = "CfC"
experiment = "experiment.toml"
[best]
loop = "model.json"
loop_folds = ["1.json", "2.json"]
average = 2
robot = true
"#;

const NOMINAL: &str = r#"study = "nominal"
question = "How many orders?"
base = "experiment.toml"
[nominal_study]
trial = "17"
bins = 40
orders = [0, 1, 2, 3]
"#;

const RESIDUAL: &str = r#"study = "residual"
question = "What is missed?"
base = "experiment.toml"
[residual_study]
roles = ["development"]
altitude = "altitude"
altitude_tolerance = 0.1
bins = 24
least_in_bin = 10
slice_tolerance = 0.1
backbones = 5
"#;

const STREAMS: &str = r#"study = "sequences"
question = "Does time tell?"
device = "flex"
target = "last"
loss = "cross_entropy"
elapsed = "measured"
seeds = [1, 2]
[data]
kind = "bit_stream_xor"
training = 1000
validation = 0.05
test = 100
length = 32
step = 0.125
seed = 1
[control]
elapsed = "one"
epochs = 3
[network]
kind = "cfc"
units = 8
[training]
epochs = 2
"#;

const TABLES: &str = r#"study = "sequences"
question = "Where next?"
target = "every"
loss = "mean_square"
nominal = "persistence"
scale = "together"
test = true
[data]
kind = "table"
folder = "recordings"
files = ["*.csv"]
sequence = "name"
separator = ","
decimal = "."
time = "t"
time_unit = "ms"
inputs = ["x", "v"]
targets = ["x"]
ahead = 1
keep = "kept"
part = "part"
validation = 0.2
test = 0.2
seed = 1
[data.windows]
length = 64
stride = 16
spare = 1
"#;

/// Manifest of the smallest data set with an arm.
pub const MANIFEST: &str = r#"name = "arm"
title = "An arm"
licence = "CC0-1.0"
source = "a test"
provenance = ""
synthetic = true
obtain = "ask the authors"
[table]
files = ["*.csv"]
ignore = ["*.parquet"]
folder = "data/arm"
separator = ","
angles = []
counters = { h = 65536.0 }
quaternions = [["u", "h", "x", "y"]]
[table.trial]
file = "(.*)"
[table.time]
column = "t"
unit = "s"
[[actuator]]
column = "u"
unit = "rad"
name = "q1"
[[context]]
column = "h"
unit = "m"
quantity = "altitude"
fill = "previous"
[[measured]]
column = "x"
unit = "mm"
at = 1.0
[[measured]]
column = "y"
unit = "mm"
at = 1.0
[[measured]]
column = "z"
unit = "mm"
at = 1.0
[vehicle]
position = ["px", "py", "pz"]
unit = "m"
attitude = ["roll", "pitch", "yaw"]
attitude_unit = "deg"
[arm]
axis = "-z"
down = "-z"
steps = 40
tolerance = 1e-9
[arm.length]
value = 620.0
unit = "mm"
[arm.strain]
basis = "legendre"
order = 1
[arm.actuation]
degree = 3
[arm.registration]
kind = "fixed"
rotation = [0.0, 0.0, 0.0]
translation = [0.0, 0.0, 0.0]
[roles]
calibration = ["a"]
development = ["b", "c"]
held_out = ["d"]
excluded = ["e"]
[folds]
validation = [["b"], ["c"]]
[conditions.b]
payload = { value = 45.0, unit = "g" }
[cut.f]
head = { until = 5.0, role = "development" }
tail = { role = "held_out" }
"#;

/// Manifest of a data set that brings its own predictions.
const PREDICTED: &str = r#"[table]
files = ["all.parquet"]
[table.trial]
column = "trial"
[table.time]
rate_hz = 20.0
[[actuator]]
column = "u"
unit = "bar"
[[measured]]
column = "x"
unit = "m"
at = 1.0
[[measured]]
column = "y"
unit = "m"
at = 1.0
[[measured]]
column = "z"
unit = "m"
at = 1.0
[[predicted]]
column = "px"
unit = "m"
[[predicted]]
column = "py"
unit = "m"
[[predicted]]
column = "pz"
unit = "m"
[arm.length]
value = 0.3
unit = "m"
[arm.strain]
basis = "piecewise"
segments = 3
[arm.registration]
kind = "identified"
twist = true
[roles]
calibration = ["a"]
development = ["b"]
"#;
