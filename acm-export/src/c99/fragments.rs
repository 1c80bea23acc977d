//! C functions that several estimators share, included where they are needed.

/// Name, text and required fragments of each fragment, in the order of the source.
const FRAGMENTS: &[(&str, &str, &[&str])] = &[
    ("tanh_f", include_str!("runtime/tanh_f.c"), &[]),
    ("sigmoid_f", include_str!("runtime/sigmoid_f.c"), &["tanh_f"]),
    ("exp_f", include_str!("runtime/exp_f.c"), &[]),
    ("lecun_tanh", include_str!("runtime/lecun_tanh.c"), &["tanh_f"]),
    ("tanh_activation", include_str!("runtime/tanh.c"), &["tanh_f"]),
    ("relu", include_str!("runtime/relu.c"), &[]),
    ("silu", include_str!("runtime/silu.c"), &["exp_f"]),
    ("gelu", include_str!("runtime/gelu.c"), &["exp_f"]),
    ("affine", include_str!("runtime/affine.c"), &[]),
    ("exp_d", include_str!("runtime/exp_d.c"), &[]),
    ("expm1_d", include_str!("runtime/expm1_d.c"), &["exp_d"]),
    ("log1p_d", include_str!("runtime/log1p_d.c"), &[]),
    ("sqrt_d", include_str!("runtime/sqrt_d.c"), &[]),
    ("sin_cos_d", include_str!("runtime/sin_cos_d.c"), &[]),
    ("vector", include_str!("runtime/vector.c"), &[]),
    ("dot", include_str!("runtime/dot.c"), &["vector"]),
    ("coefficients", include_str!("runtime/coefficients.c"), &[]),
    ("rotate", include_str!("runtime/rotate.c"), &["vector", "coefficients"]),
    ("values", include_str!("runtime/values.c"), &[]),
    ("relax", include_str!("runtime/lag.c"), &["exp_d"]),
    ("corner", include_str!("runtime/corner.c"), &[]),
    ("lag", include_str!("runtime/lag_step.c"), &["relax"]),
    ("play", include_str!("runtime/play.c"), &[]),
    ("rate_limit", include_str!("runtime/rate_limit.c"), &[]),
    ("swing", include_str!("runtime/swing.c"), &["exp_d", "sqrt_d", "sin_cos_d"]),
    ("second_order", include_str!("runtime/second_order.c"), &["swing"]),
    ("stick_lag", include_str!("runtime/stick_lag.c"), &["relax"]),
    ("asymmetric_lag", include_str!("runtime/asymmetric_lag.c"), &["relax", "log1p_d"]),
    ("parts", include_str!("runtime/parts.c"), &[]),
    ("varying_lag", include_str!("runtime/varying_lag.c"), &["relax", "parts"]),
    ("bent_pace", include_str!("runtime/bent_pace.c"), &["varying_lag"]),
    ("flow_pace", include_str!("runtime/flow_pace.c"), &["varying_lag"]),
    ("overflow", include_str!("runtime/overflow.c"), &["flow_pace"]),
    ("bouc_wen", include_str!("runtime/bouc_wen.c"), &["expm1_d", "log1p_d"]),
    ("bouc_wen_power", include_str!("runtime/bouc_wen_power.c"), &["exp_d", "log1p_d"]),
    ("lugre", include_str!("runtime/lugre.c"), &["exp_d", "expm1_d"]),
    ("slope", include_str!("runtime/slope.c"), &[]),
    ("tanh_d", include_str!("runtime/tanh_d.c"), &["expm1_d"]),
    ("stiff_lag", include_str!("runtime/stiff_lag.c"), &["swing", "sqrt_d", "sin_cos_d", "parts"]),
    ("derivative", include_str!("runtime/derivative.c"), &[]),
];

/// Returns the text of all fragments in `needs`, and of those that they need, each once.
pub fn all(needs: &[&str]) -> String {
    let mut wanted = vec![false; FRAGMENTS.len()];
    // What a fragment rests on stands before it.
    for (k, (name, _, _)) in FRAGMENTS.iter().enumerate().rev() {
        let rests =
            FRAGMENTS[k + 1..].iter().zip(&wanted[k + 1..]).any(|((_, _, on), wanted)| *wanted && on.contains(name));
        wanted[k] = rests || needs.contains(name);
    }
    let texts = FRAGMENTS.iter().zip(&wanted).filter(|(_, wanted)| **wanted);
    texts.map(|((_, text, _), _)| format!("\n{text}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_fragment_rests_on_stands_before_it() {
        for (k, (name, _, on)) in FRAGMENTS.iter().enumerate() {
            for before in *on {
                assert!(FRAGMENTS[..k].iter().any(|(name, _, _)| name == before), "{before} of {name}");
            }
        }
        let text = all(&["second_order"]);
        assert!(text.contains("sqrt_d(double") && text.contains("swing(double") && !text.contains("log1p_d"));
    }
}
