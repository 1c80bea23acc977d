//! Files of torch, read and written.
//!
//! Oracle: the networks of `golden/torch_files.py`, whose numbers `golden/networks.json` has. What is written is read back
//! by torch itself, where `ACM_PYTHON`, or else `python3`, has it.

use std::path::{Path, PathBuf};
use std::process::Command;

use acm_models::burn::tensor::{Device, Tensor, TensorData};
use acm_models::torch::{self, ModuleSnapshot};
use acm_models::{Cfc, CfcConfig, CfcMode, Gru, GruConfig};
use serde_json::Value;

const BATCH: usize = 3;
const STEPS: usize = 6;
const CHANNELS: usize = 4;
const UNITS: usize = 5;

fn folder() -> PathBuf {
    std::path::absolute("tests/golden").unwrap()
}

fn golden(name: &str, key: &str) -> f64 {
    let text = std::fs::read_to_string(folder().join("networks.json")).expect("golden numbers");
    let all: Value = serde_json::from_str(&text).expect("golden numbers are JSON");
    all[name][key].as_f64().expect("a number")
}

fn inputs() -> Tensor<3> {
    let at = |i: usize| {
        let (b, t, f) = (i / (STEPS * CHANNELS), i / CHANNELS % STEPS, i % CHANNELS);
        (0.5 * (b as f64 + 1.0) + 0.3 * t as f64 + 0.9 * f as f64).sin() as f32
    };
    let values: Vec<f32> = (0..BATCH * STEPS * CHANNELS).map(at).collect();
    Tensor::from_data(TensorData::new(values, [BATCH, STEPS, CHANNELS]), &Device::flex())
}

fn elapsed() -> Tensor<2> {
    let at = |i: usize| 0.02 * (1.0 + ((3 * (i / STEPS) + 2 * (i % STEPS)) % 5) as f32);
    let values: Vec<f32> = (0..BATCH * STEPS).map(at).collect();
    Tensor::from_data(TensorData::new(values, [BATCH, STEPS]), &Device::flex())
}

fn cfcs() -> Vec<(&'static str, CfcConfig)> {
    let config = |mode, layers| CfcConfig::new(CHANNELS).with_units(UNITS).with_mode(mode).with_backbone(layers, 7);
    vec![
        ("cfc_default_L0", config(CfcMode::Default, 0)),
        ("cfc_default_L1", config(CfcMode::Default, 1)),
        ("cfc_default_L2", config(CfcMode::Default, 2)),
        ("cfc_no_gate_L1", config(CfcMode::NoGate, 1)),
        ("cfc_pure_L2", config(CfcMode::Pure, 2)),
    ]
}

fn grus() -> [(&'static str, GruConfig); 2] {
    [1, 2]
        .map(|layers| (["gru_1", "gru_2"][layers - 1], GruConfig::new(CHANNELS).with_units(UNITS).with_layers(layers)))
}

fn sum<const D: usize>(tensor: Tensor<D>) -> f64 {
    tensor.into_data().try_to_vec::<f32>().expect("f32").into_iter().map(f64::from).sum()
}

fn near(what: &str, found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-5, "{what}: {found} instead of {expected}");
}

fn check_cfc(name: &str, cfc: &Cfc) {
    let last = cfc.forward(inputs(), elapsed()).narrow(1, STEPS - 1, 1);
    near(name, sum(last), golden(name, "sum"));
}

fn check_gru(name: &str, gru: &Gru) {
    near(name, sum(gru.forward(inputs())), golden(name, "sum_zero"));
}

/// Loads from both files of torch, and complains of nothing.
fn load<M: ModuleSnapshot>(name: &str, new: impl Fn() -> M, check: impl Fn(&str, &M)) {
    let file = |end: &str| folder().join(format!("{name}.{end}"));
    let mut module = new();
    let result = module.load_from(&mut torch::pytorch(file("pt"))).expect("the file is read");
    assert!(result.missing.is_empty() && result.unused.is_empty() && result.errors.is_empty(), "{result:?}");
    check(name, &module);
    let mut module = new();
    let result = module.load_from(&mut torch::safetensors_in(file("safetensors"))).expect("the file is read");
    assert!(result.missing.is_empty() && result.unused.is_empty() && result.errors.is_empty(), "{result:?}");
    check(name, &module);
}

#[test]
fn files_of_torch_give_the_golden_numbers() {
    let device = Device::flex();
    for (name, config) in cfcs() {
        load(name, || config.init_seeded(9, &device), check_cfc);
    }
    for (name, config) in grus() {
        load(name, || config.init_seeded(9, &device), check_gru);
    }
}

/// Files for torch of all networks, with the committed values.
fn write(to: &Path) {
    let device = Device::flex();
    for (name, config) in cfcs() {
        let mut cfc = config.init_seeded(9, &device);
        cfc.load_from(&mut torch::pytorch(folder().join(format!("{name}.pt")))).expect("the file is read");
        cfc.save_into(&mut torch::safetensors_out(to.join(format!("{name}.safetensors"))))
            .expect("the file is written");
    }
    for (name, config) in grus() {
        let mut gru = config.init_seeded(9, &device);
        gru.load_from(&mut torch::pytorch(folder().join(format!("{name}.pt")))).expect("the file is read");
        gru.save_into(&mut torch::safetensors_out(to.join(format!("{name}.safetensors"))))
            .expect("the file is written");
    }
}

/// What is written has the names, shapes and values of torch's own file. burn-store reads it tensor by tensor here, without
/// any module or renaming.
#[test]
fn what_is_written_is_what_torch_wrote() {
    use burn_store::{ModuleStore, SafetensorsStore, bridge};
    let to = tempfile::tempdir().expect("a folder");
    write(to.path());
    let read = |path: PathBuf| {
        let mut store = SafetensorsStore::from_file(path);
        let all = store.get_all_tensors().expect("the file is read");
        all.iter().map(|(name, tensor)| (name.clone(), bridge::to_data(tensor).expect("f32"))).collect::<Vec<_>>()
    };
    let names = cfcs().iter().map(|(name, _)| *name).chain(grus().iter().map(|(name, _)| *name)).collect::<Vec<_>>();
    for name in names {
        let file = format!("{name}.safetensors");
        assert_eq!(read(to.path().join(&file)), read(folder().join(&file)), "{name}");
    }
}

#[test]
fn torch_reads_what_is_written() {
    let python = std::env::var("ACM_PYTHON").unwrap_or_else(|_| "python3".into());
    let has = Command::new(&python).args(["-c", "import torch, ncps, safetensors, numpy"]).output();
    if !has.is_ok_and(|output| output.status.success()) {
        eprintln!(
            "skipped torch_reads_what_is_written: {python} has no torch, ncps, safetensors and numpy; set ACM_PYTHON"
        );
        return;
    }
    let to = tempfile::tempdir().expect("a folder");
    write(to.path());
    let script = folder().join("torch_files.py");
    let output = Command::new(&python).arg(script).arg("check").arg(to.path()).output().expect("python runs");
    let (said, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{errors}");
    assert_eq!(said.lines().filter(|line| line.ends_with(" ok")).count(), cfcs().len() + grus().len(), "{said}");
}
