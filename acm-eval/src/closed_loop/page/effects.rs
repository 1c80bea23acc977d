//! The effects that were found: meaning, place, values.

use acm_core::{display::with_symbol, effects::Site};
use acm_trace::finding::{Finding, FoundEffect, FoundParameter, MinorEffect, title::parameter_title};
use maud::{Markup, html};

use super::confirmation::{confidence, replaced_by};
use super::markup::{Column, cell, entry, heading, table};
use crate::closed_loop::quantity::{Quantity, of_parameter, significant};
use crate::closed_loop::words::{self, capitalized, effect_words, in_unit};

/// Writes the clock, a table of all effects, then one part for each, the largest first.
pub fn section(finding: &Finding) -> Markup {
    html! {
        (heading("effects", "What was found", &finding.data))
        @if let Some(clock) = clock(finding) {
            p { b { "Clock: " } (clock) ". This is no effect of the robot, since a correction looks ahead: the recorder \
                stamps actuators and outputs by different clocks." }
        }
        @if !finding.zero_order_hold.is_empty() {
            p {
                b { "Between samples: " } (finding.zero_order_hold.join(", ")) " held at each value until the next (zero-order hold). That predicts better than a \
                straight line from one to the next."
            }
        }
        @if !finding.quartic_interpolation.is_empty() {
            p {
                b { "Between samples: " } (finding.quartic_interpolation.join(", ")) " along a quartic through the last five samples. That predicts better \
                than a straight line from one to the next."
            }
        }
        @if finding.effects.is_empty() {
            p { "No effect was added to the model." }
        } @else {
            (overview(finding))
            p.note {
                "95 % intervals by a jackknife over blocks. They assume that the effect is the right one. In \
                simulations, fewer than 95 % of them contained the true value."
            }
        }
        @for effect in &finding.effects { (one(effect, &finding.errors.unit)) }
        @if !finding.minor.is_empty() { (minor(finding)) }
    }
}

/// Writes `the actuators' clock is 0.85 s late (0.83 to 0.87 s); shift their stamps`, capitalized.
fn clock(finding: &Finding) -> Option<String> {
    let interval = finding.clock_correction.as_ref()?.interval;
    let bounds = Quantity::of(0.0, interval, "s").interval;
    Some(format!("{} (95 % of the correction: {bounds})", acm_trace::finding::sentence::clock(finding)?))
}

/// Writes a row for each effect: its size, its confidence, and what was chosen instead.
fn overview(finding: &Finding) -> Markup {
    let columns: [Column; 4] = [("Effect", true), ("Size", false), ("Confidence", true), ("Chosen in its place", true)];
    let row = |effect: &FoundEffect| {
        let replaced = replaced_by(effect);
        vec![
            words::effect(&effect.name),
            cell(significant(effect.size, 3)),
            cell(confidence(effect, &finding.errors.unit)),
            cell(if replaced.is_empty() { "nothing else in 5 % or more" } else { &replaced }),
        ]
    };
    let rows: Vec<Vec<Markup>> = finding.effects.iter().map(row).collect();
    html! {
        p.note {
            "Size: root mean square of what the effect does to the outputs" (in_unit(&finding.errors.unit)) ". Confidence: \
            blocks of the development trials were drawn anew, and every candidate competed for the place of the effect; \
            sure is 95 % and more, likely half and more. It says how sure the name is; held-out trials say whether the model \
            as a whole is better."
        }
        (table("effects", "Effects, how sure they are", &columns, &rows))
    }
}

/// Writes a row for each minor effect.
fn minor(finding: &Finding) -> Markup {
    let columns: [Column; 4] = [("Minor effect", true), ("Carried by", true), ("Size", false), ("Values", true)];
    let value =
        |parameter: &FoundParameter| format!("{} {}", parameter_title(&parameter.name), of_parameter(parameter).value);
    let row = |effect: &MinorEffect| {
        let values: Vec<String> = effect.parameters.iter().map(value).collect();
        vec![
            words::effect(&effect.name),
            cell(effect.carrier.as_deref().unwrap_or("")),
            cell(significant(effect.size, 3)),
            cell(values.join("; ")),
        ]
    };
    let rows: Vec<Vec<Markup>> = finding.minor.iter().map(row).collect();
    html! {
        h3 { "Minor effects" }
        p.note {
            "The model predicts better with them, by too little to name them. Do not conclude from their names: each may \
            stand for another cause of that size."
        }
        (table("minor", "Minor effects", &columns, &rows))
    }
}

fn one(effect: &FoundEffect, unit: &str) -> Markup {
    let columns: [Column; 3] = [("Parameter", true), ("Value", false), ("95 % interval", false)];
    let rows: Vec<Vec<Markup>> = effect.parameters.iter().map(parameter).collect();
    let varies = effect.parameters.iter().rfind(|parameter| parameter.depends_on.is_some());
    html! {
        div.effect {
            h3 {
                (capitalized(&effect_words(&effect.name))) ": " (effect.meaning)
                " " code.identifier { (effect.name) }
            }
            dl {
                (entry("Acts", &cell(place(effect.site))))
                @if let Some(carrier) = &effect.carrier { (entry("Carried by", &html! { code { (carrier) } })) }
                (entry("Moves the outputs by", &html! {
                    (with_symbol(&significant(effect.size, 3), unit)) " root mean square"
                }))
                (entry("Confidence", &cell(confidence(effect, unit))))
                (entry("In calibration trials", &cell(in_calibration(effect.in_calibration))))
                (entry("Equation from", &cell(&effect.source)))
            }
            @if rows.is_empty() {
                p { "It has no parameters." }
            } @else {
                (table("parameters", &format!("Parameters of {}", effect_words(&effect.name)), &columns, &rows))
            }
            @if let Some(example) = varies { (dependence(example)) }
        }
    }
}

fn parameter(parameter: &FoundParameter) -> Vec<Markup> {
    let quantity = of_parameter(parameter);
    let [low, high] = parameter.interval;
    let name = words::parameter(&parameter.name);
    let interval = html! {
        (quantity.interval)
        @if !parameter.undetermined && low < 0.0 && high > 0.0 { span.aside { ", may be zero" } }
    };
    vec![name, cell(quantity.value), interval]
}

/// Writes θ = θ0 + θ1·c + θ2 (c − a)(c − b) in words, with the names of one parameter.
fn dependence(parameter: &FoundParameter) -> Markup {
    let context = parameter.depends_on.as_deref().unwrap_or_default();
    let (base, per) = parameter.name.split_once(" per ").unwrap_or((&parameter.name, ""));
    let (base, is_bowed) = (parameter_title(base), per.ends_with('²'));
    html! {
        p.note {
            "The value depends on the signal " code { (context) } ": at each moment it is (" (base) ") + (" (base)
            " per " (context) ") × " (context)
            @if is_bowed {
                " + (" (base) " per " (context) "²) × (" (context) " − a)(" (context) " − b), where a and b are the ends of its range"
            }
            ", with the signal in SI units."
        }
    }
}

/// Returns the site of an effect in words.
pub fn place(site: Site) -> &'static str {
    match site {
        Site::Actuation => "on the actuators, before their coordinates reach the model",
        Site::Load => "on the arm, as a load that bends it",
        Site::Marker => "on the place of the marker on the arm",
        Site::Frame => "on the frame in which markers are measured",
        Site::Output => "on the outputs, after the model",
    }
}

fn in_calibration(acts: Option<bool>) -> &'static str {
    match acts {
        Some(true) => "it acts there too, so the nominal model was calibrated with it",
        Some(false) => "it does not act there",
        None => "unknown: there are no calibration trials of their own",
    }
}
