//! Compares an ONNX export with its recorded steps, by tract.
//!
//!     check-tract FOLDER [NAME]
//!
//! Exit code 0: equal within 1e-5 of the outputs' RMS; 1: not.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use serde_json::Value;
use tract_onnx::prelude::*;

type Answer<T> = Result<T, Box<dyn Error>>;

fn main() -> Answer<ExitCode> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("give the folder of the export")?;
    let name = arguments.next().unwrap_or_else(|| "estimator".into());
    let about = std::fs::read(Path::new(&folder).join(format!("{name}_onnx.json")))?;
    let about: Value = serde_json::from_slice(&about)?;
    let (steps, worst) = walk(&Path::new(&folder).join(format!("{name}.onnx")), &about)?;
    println!("{steps} steps: outputs within {worst:.1e} of their RMS");
    Ok(if worst <= 1e-5 { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

/// Returns the number of recorded steps, and the largest deviation over them, in units of the outputs' RMS.
fn walk(file: &Path, about: &Value) -> Answer<(usize, f64)> {
    let mut model = tract_onnx::onnx().model_for_path(file)?;
    let outlets = model.input_outlets()?.to_vec();
    let names: Vec<String> = outlets.iter().map(|outlet| model.node(outlet.node).name.clone()).collect();
    let widths: Vec<usize> = names.iter().map(|name| width(name, about)).collect();
    for (k, name) in names.iter().enumerate() {
        let kind = if name == "channels" { DatumType::F64 } else { DatumType::F32 };
        model.set_input_fact(k, InferenceFact::dt_shape(kind, tvec!(1, widths[k])))?;
    }
    let plan = model.into_optimized()?.into_runnable()?;
    let sizes = numbers(&about["self_test"]["output_rms"]);
    let steps = about["self_test"]["steps"].as_array().ok_or("no recorded steps")?;
    let (mut worst, mut state) = (0.0f64, None);
    for step in steps {
        if step["begins"] == true {
            state = None;
        }
        let input = |(name, width): (&String, &usize)| -> Answer<TValue> {
            Ok(match name.as_str() {
                "channels" => Tensor::from_shape(&[1, *width], &numbers(&step["channels"]))?.into(),
                "elapsed" => Tensor::from_shape(&[1, 1], &[step["elapsed"].as_f64().unwrap_or(0.0) as f32])?.into(),
                _ => state.clone().unwrap_or(Tensor::zero::<f32>(&[1, *width])?.into()),
            })
        };
        let inputs = names.iter().zip(&widths).map(input).collect::<Answer<TVec<TValue>>>()?;
        let found = plan.run(inputs)?;
        let residual = found[0].to_array_view::<f64>()?;
        let right = numbers(&step["residual"]);
        for ((found, right), size) in residual.iter().zip(&right).zip(&sizes) {
            worst = worst.max((found - right).abs() / size);
        }
        state = found.get(1).cloned();
    }
    Ok((steps.len(), worst))
}

/// Returns the number of columns of an input, whose rows are free.
fn width(input: &str, about: &Value) -> usize {
    let count = |value: &Value| value.as_u64().unwrap_or(1) as usize;
    match input {
        "channels" => about["channels"].as_array().map_or(0, Vec::len),
        "elapsed" => 1,
        _ => count(&about["network"]["units"]) * count(&about["network"]["layers"]),
    }
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().map(|values| values.iter().filter_map(Value::as_f64).collect()).unwrap_or_default()
}
