//! Training on the device that `ACM_DEVICE` names gives the errors that flex gives. `scripts/test-device` runs it.
#![cfg(any(feature = "ndarray", feature = "cuda", feature = "wgpu"))]

mod campaign;

use campaign::{Campaign, EXPERIMENT};

/// Bits differ, since sums are taken in another order.
#[test]
fn errors_are_those_of_flex() {
    let name = std::env::var("ACM_DEVICE").expect("ACM_DEVICE names the device, as in scripts/test-device");
    let campaign = Campaign::new();
    // Sizes are each network's own defaults.
    campaign.write("tiny.toml", &EXPERIMENT.replace("units = 4", ""));
    for network in ["mlp", "gru", "cfc"] {
        let train = |device: &str| {
            let edits =
                [format!("device=\"{device}\""), format!("network.kind=\"{network}\""), "protocol.seeds=[1]".into()];
            let arguments: Vec<&str> = edits.iter().flat_map(|edit| ["--set", edit]).collect();
            let records = campaign.learn(&format!("{network}-{device}"), &arguments);
            let losses: Vec<f64> = records[0].epochs.iter().map(|epoch| epoch.validation_loss).collect();
            let held_out = records[0].held_out.as_ref().expect("the final run has held-out trials");
            (losses, held_out.estimators[network].rmse_total)
        };
        let ((losses, error), (flex_losses, flex_error)) = (train(&name), train("flex"));
        assert!(losses.len() > 1, "{network} was trained");
        for (loss, flex) in losses.iter().zip(&flex_losses).chain([(&error, &flex_error)]) {
            assert!((loss / flex - 1.0).abs() < 1e-4, "{network}: {loss} on {name}, {flex} on flex");
        }
        println!("{network}: {:.4} mm on {name}, {:.4} mm on flex", 1e3 * error, 1e3 * flex_error);
    }
}
