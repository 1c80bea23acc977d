//! Bars: error on each trial, fitted to it and as predicted by a fit to the others.

use acm_train::schedule::descriptive::nominal::{Errors, ModelRow};

use super::Study;
use crate::figures::Drawing;
use crate::figures::canvas::bars::{Bar, highest, keys, panel_of};
use crate::figures::canvas::{Panels, palette};
use crate::unit::total_name;

/// Caption title.
pub const QUESTION: &str = "How well does a nominal model know a trial that it has not seen?";

/// Draws a group per trial and one for all.
pub fn draw(study: &Study) -> Option<Drawing> {
    let models = &study.record.models;
    let find = |key: &str| models.iter().find(|model| model.key == key);
    let (polynomial, strain) = (find("polynomial")?, find("strain_joint").or(find("strain"))?);
    let bar = |label: String, colour, errors: &Errors| {
        let trials = errors.trials.iter().map(|trial| &trial.rms);
        let values = trials.chain([&errors.all]).map(|rms| rms.total * study.display.factor).collect();
        Bar { label, colour, values }
    };
    let pair = |model: &ModelRow, light, dark| -> Option<[Bar; 2]> {
        let left_out = model.left_out.as_ref()?;
        let label = |part: &str| format!("{}, {part}", model.label);
        Some([bar(label("fitted"), light, &model.fitted), bar(label("left out"), dark, left_out)])
    };
    let grey = palette::baseline;
    let bars: Vec<Bar> =
        [pair(polynomial, grey("polynomial"), grey("nominal"))?, pair(strain, palette::SKY, palette::BLUE)?]
            .into_iter()
            .flatten()
            .collect();
    let names = polynomial.fitted.trials.iter().map(|trial| trial.trial.clone());
    let groups: Vec<String> = names.chain(["all".to_string()]).collect();
    let y = study.display.label(&format!("{} RMSE", total_name(&study.record.data.unit, study.record.outputs.len())));
    let panel = panel_of("(j) Each trial left out in turn", "trial", &y, &groups, &bars, highest(&bars));
    let explanation = "Root mean square error on each calibration trial. Fitted: the model was fitted to all of them. Left \
                       out: it was fitted to the others. The trials differ in what the other actuators hold, so the one \
                       at the border of the workspace is extrapolated to, which is harder than anything the model is \
                       asked for within the calibrated domain."
        .to_string();
    let panels = Panels { columns: 1, panels: vec![panel], size: (860.0, 340.0), legend: keys(&bars) };
    Some(panels.draw(&study.record.data, bars.len() * groups.len(), explanation))
}
