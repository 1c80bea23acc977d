//! Bars: error of the models that were fitted to all calibration trials.

use acm_train::schedule::descriptive::{nominal::ModelRow, rms::Rms};

use super::Study;
use crate::figures::Drawing;
use crate::figures::canvas::bars::{Bar, highest, keys, panel_of};
use crate::figures::canvas::{Panels, palette};
use crate::unit::total_name;

/// Caption title.
pub const QUESTION: &str = "Does the strain model describe the arm at rest as well as a polynomial?";

/// Draws a panel by coordinate, one by trial.
pub fn draw(study: &Study) -> Option<Drawing> {
    let (record, factor) = (&study.record, study.display.factor);
    let first = record.models.first()?;
    let total = total_name(&record.data.unit, record.outputs.len());
    let bars = |values: &dyn Fn(&ModelRow) -> Vec<f64>| -> Vec<Bar> {
        let bar = |model: &ModelRow| {
            let label = format!("{} ({} parameters)", model.label, model.parameters.len());
            let values = values(model).iter().map(|value| value * factor).collect();
            Bar { label, colour: colour(&model.key), values }
        };
        record.models.iter().map(bar).collect()
    };
    let components = |rms: &Rms| [rms.components.clone(), vec![rms.total]].concat();
    let by_output = bars(&|model| components(&model.fitted.all));
    let by_trial = bars(&|model| model.fitted.trials.iter().map(|trial| trial.rms.total).collect());
    let outputs: Vec<String> = record.outputs.iter().cloned().chain([total.to_string()]).collect();
    let trials: Vec<String> = first.fitted.trials.iter().map(|trial| trial.trial.clone()).collect();
    let y = |of: &str| study.display.label(&format!("{of}RMSE"));
    let high = highest(&by_output).max(highest(&by_trial));
    let panels = vec![
        panel_of("(b) All calibration trials", "coordinate", &y(""), &outputs, &by_output, high),
        panel_of("(c) Trial by trial", "trial", &y(&format!("{total} ")), &trials, &by_trial, high),
    ];
    let explanation = "Root mean square error on the calibration trials, to which each model was fitted. In two steps: \
                       the actuation map first, then the strain parameters, as in the paper; joint polish: both together \
                       after that, which is what the experiments use."
        .to_string();
    let series = record.models.len() * (outputs.len() + trials.len());
    let panels = Panels { columns: 2, panels, size: (440.0, 320.0), legend: keys(&by_output) };
    Some(panels.draw(&record.data, series, explanation))
}

/// Returns the colour: grey for the polynomial, as in all figures; blues for the strain model.
pub fn colour(key: &str) -> &'static str {
    match key {
        "polynomial" => palette::baseline("polynomial"),
        "strain" => palette::SKY,
        _ => palette::BLUE,
    }
}
