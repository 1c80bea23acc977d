//! C bodies of the effects.

mod actuators;
mod delays;
mod frames;
mod loads;
mod motions;
mod pieces;
mod rings;

use acm_core::effects::Rig;
use acm_core::effects::instance::Instance;

use super::Inputs;
use actuators::{SHARES, coupling, periodic, prandtl_ishlinskii, ranged, slipping, stops};
use delays::delay;
use frames::{base_tilt, turned};
use loads::{ground_effect, jet, load};
use motions::{following, motion};
use pieces::{array, carrier, each, plain_body, since_start, some, with};
pub use rings::Ring;

/// Effect to be written, with its rig and inputs.
pub struct Asked<'a> {
    pub number: usize,
    pub instance: &'a Instance,
    pub theta: &'a [f64],
    pub rig: &'a Rig,
    pub inputs: Inputs,
    /// Number of columns that it acts on: actuators, or outputs.
    pub columns: usize,
}

/// Parts of the C code of one effect.
#[derive(Default)]
pub struct Body {
    pub equation: &'static str,
    /// Members of the effect's memory.
    pub memory: String,
    pub code: String,
    pub needs: Vec<&'static str>,
    pub macros: String,
    /// Ring buffer of an effect that keeps samples.
    pub ring: Option<Ring>,
}

/// Writes the body of an effect; none where the effect cannot be written yet.
pub fn write(asked: &Asked) -> Option<Body> {
    let body = match asked.instance.effect().name() {
        "dead_time" => delay(asked, "q'(t) = q(t - v0)"),
        "measurement_delay" => delay(asked, "y'(t) = y(t - v0)"),
        "static_gain" => each(asked, "q'_j = (1 + g_j) q_j + o_j", "x[j] += v[j] * x[j] + v[@N + j];"),
        "gain_drift" => since_start(asked, "q' = q (1 + k (t - t_0))", "x[j] += x[j] * v[0] * (time - m->start);"),
        "zero_drift" => since_start(asked, "q'_j = q_j + k_j (t - t_0)", "x[j] += v[j] * (time - m->start);"),
        "measurement_drift" => since_start(asked, "y'_m = y_m + v_m (t - t_0)", "x[j] += v[j] * (time - m->start);"),
        "dead_zone" => Body {
            needs: vec!["corner"],
            ..each(
                asked,
                "q'_j = z_j + c(q_j - z_j - w_j) - c(z_j - q_j - w_j), c(d) = max(0, d) with a corner of the radius r w_j",
                "const double half = v[j], radius = v[@N] * half, rest = v[@N + 1 + j];\n        \
                 if (half > 0.0) {\n            x[j] = rest + (corner(x[j] - rest - half, radius) - corner(rest - x[j] - half, \
                 radius));\n        }",
            )
        },
        "saturation" => Body {
            needs: vec!["corner"],
            ..each(
                asked,
                "q'_j = q_j + c(l_j + b_j - q_j) - c(q_j - h_j + a_j), c(d) = max(0, d) with a corner",
                "const double upper = v[j], lower = v[@N + j], high = v[2 * @N + j], low = v[3 * @N + j];\n        \
                 if (lower > 0.0) {\n            x[j] += corner(low + lower - x[j], v[4 * @N] * lower);\n        }\n        \
                 if (upper > 0.0) {\n            x[j] -= corner(x[j] - (high - upper), v[4 * @N] * upper);\n        }",
            )
        },
        "rate_limit" => Body {
            memory: array("$whole_lag", asked.columns),
            needs: vec!["rate_limit"],
            ..each(asked, "|dq'_j/dt| <= 1/s_j", "x[j] = rate_limit_step(time, x[j], v[j], &m->state[j]);")
        },
        "backlash" => Body {
            memory: array("$whole_play", asked.columns),
            needs: vec!["play"],
            ..each(asked, "q'_k = min(max(q'_(k-1), q_k - w), q_k + w)", "x[j] = play_step(x[j], v[j], &m->state[j]);")
        },
        "actuator_lag" | "measurement_lag" => Body {
            memory: array("$whole_lag", asked.columns),
            needs: vec!["lag"],
            ..some(asked, "tau dx'/dt = x - x'", "x[j] = lag_step(time, x[j], v[0], &m->state[j]);")
        },
        "friction_lag" => Body {
            memory: array("$whole_lag", asked.columns),
            needs: vec!["stick_lag"],
            ..each(
                asked,
                "tau dq'_j/dt = q_j - q'_j - w_j sgn q'_j, at rest at 0 while |q_j| <= w_j",
                "x[j] = stick_lag_step(time, x[j], v[0], v[1 + j], &m->state[j]);",
            )
        },
        "asymmetric_lag" => Body {
            memory: array("$whole_lag", asked.columns),
            needs: vec!["asymmetric_lag"],
            ..some(
                asked,
                "tau e^a dx'/dt = x - x' where x > x', tau e^-a dx'/dt = x - x' where x < x'",
                "x[j] = asymmetric_lag_step(time, x[j], v[0] * exp_d(v[1]), v[0] * exp_d(-v[1]), &m->state[j]);",
            )
        },
        "creep" | "measurement_creep" => Body {
            memory: array("$whole_lag", asked.columns),
            needs: vec!["lag"],
            ..each(
                asked,
                "x' = x + c (L[x] - x),   tau dL/dt = x - L",
                "const double late = lag_step(time, x[j], v[1], &m->state[j]);\n        x[j] += v[0] * (late - x[j]);",
            )
        },
        "second_order_lag" | "measurement_second_order" => Body {
            memory: array("$whole_spring", asked.columns),
            needs: vec!["second_order"],
            ..each(
                asked,
                "x'' + 2 z w x' + w^2 x = w^2 x_in,   w = 2 pi/P",
                "x[j] = second_order_step(time, x[j], v[0] / 6.283185307179586, v[1], &m->state[j]);",
            )
        },
        "viscous_slip" => Body {
            memory: array("$whole_slope", asked.columns),
            needs: vec!["slope"],
            ..each(asked, "q'_j = q_j - c_j dq_j/dt", "x[j] -= v[j] * slope_step(time, x[j], &m->state[j]);")
        },
        "nonlinear_stiffness" => ranged(
            asked,
            4,
            "z'' + 2 d w z' + w^2 s(z) = w^2 x, s of the hardness k at c,   x = (q - m)/h,   q' = m + h z",
            "stiff_lag_step(time, z, v[0] / 6.283185307179586, v[1], v[2], v[3], 0.0, 1.0, &m->state[@J]) - z",
            Some(("$whole_spring", "stiff_lag")),
        ),
        "coulomb_damping" => ranged(
            asked,
            6,
            "z'' + 2 d w z' + w^2 (s(z) + f z'/sqrt(z'^2 + t^2 w^2)) = w^2 x,   x = (q - m)/h,   q' = m + h z",
            "stiff_lag_step(time, z, v[0] / 6.283185307179586, v[1], v[2], v[3], v[4], v[5] * 6.283185307179586 / v[0], \
             &m->state[@J]) - z",
            Some(("$whole_spring", "stiff_lag")),
        ),
        "state_dependent_lag" => ranged(
            asked,
            4,
            "tau (f + (1 - f) (1 + b z) (1 + |c| z^2)^sgn(c)) dq'/dt = q - q',   z = (q' - m)/h within -1 and 1",
            "varying_lag_step(time, z, v[0], bent_pace, v + 1, &m->state[@J]) - z",
            Some(("$whole_lag", "bent_pace")),
        ),
        "outflow" => ranged(
            asked,
            2,
            "tau (1 + b z) dz/dt = x - z,   x = (q - m)/h,   q' = m + h z",
            "varying_lag_step(time, z, v[0], flow_pace, v + 1, &m->state[@J]) - z",
            Some(("$whole_lag", "flow_pace")),
        ),
        "overflow" => ranged(
            asked,
            4,
            "v0 (1 + v1 z) dz/dt = x - z up to z = 1/v2 - 1,   x = (q - m)/h,   q' = m + h (z + v3 (x - z)) there, m + h z below",
            "overflow_step(time, z, v, &m->state[@J]) - z",
            Some(("$whole_lag", "overflow")),
        ),
        "input_nonlinearity" => ranged(
            asked,
            2 * asked.columns,
            "q'_j = q_j + h_j (a_j (z^2 - 1) + b_j (z^3 - z)),   z = (q_j - m_j)/h_j, straight beyond |z| = 1",
            "(e * e - 1.0) * (v[@J] + v[@N + @J] * e) + (z - e) * (2.0 * v[@J] * e + 2.0 * v[@N + @J])",
            None,
        ),
        "coupling" => coupling(asked),
        "encoder_periodic" => periodic(asked)?,
        "prandtl_ishlinskii" => prandtl_ishlinskii(asked),
        "dry_friction" => slipping(
            asked,
            1,
            "q'_j = q_j - f_j d_j,   d Dahl's state",
            "v[@J] * bouc_wen_step(x[@J], @W, 1.0, &m->state[@J])",
        ),
        "tendon_friction" => slipping(
            asked,
            1,
            "q'_j = q_j - f_j |q_j| d_j,   d Dahl's state",
            "v[@J] * (x[@J] < 0.0 ? -x[@J] : x[@J]) * bouc_wen_step(x[@J], @W, 1.0, &m->state[@J])",
        ),
        "bouc_wen" => slipping(
            asked,
            2,
            "q'_j = q_j - c_j z_j,   z the state of Bouc and Wen",
            "v[@J] * bouc_wen_step(x[@J], @W, v[@N + 1], &m->state[@J])",
        ),
        "tip_load" => plain_body("free = f, held = -c f", load(0, "v[0]", "v[1]")),
        "self_weight" => plain_body("free = f, held = -c f", load(1, "v[0]", "v[1]")),
        "side_wind" => plain_body("free_i = f_i, held_i = -c f_i", load(4, "v[0]", "v[2]") + &load(5, "v[1]", "v[2]")),
        "downwash" => plain_body(
            "wash = b u (1 - d), near = b u d, held = -c of them",
            jet(&format!("v[0] * in[{}]", carrier(asked)?), "v[1]", "v[2]"),
        ),
        "wake_lag" => Body {
            memory: array("$whole_lag", 1),
            needs: vec!["lag"],
            ..plain_body(
                "wash = b u' (1 - d), near = b u' d, held = -c of them,   tau du'/dt = u - u'",
                jet(&format!("v[0] * lag_step(time, in[{}], v[1], &m->state[0])", carrier(asked)?), "v[2]", "v[3]"),
            )
        },
        "ground_effect" => ground_effect(asked)?,
        "marker_offset" => plain_body(
            "p' = p + R(q) d",
            "    for (int j = 0; j < 3; ++j) {\n        x[12 + j] += v[j];\n    }\n".into(),
        ),
        "scale" => each(asked, "p' = (1 + s) p", "x[j] *= 1.0 + v[0];"),
        "misregistration" => Body {
            needs: vec!["rotate"],
            ..turned(asked, "p' = exp(r) p + d", "", "vector_of(v[0], v[1], v[2])", "v[3 + i]")
        },
        "base_tilt" => base_tilt(asked),
        "context_term" | "input_disturbance" => {
            let signal = carrier(asked)?;
            each(asked, "x'_j = x_j + k_j (c - c_0)", &format!("x[j] += v[j] * (in[{signal}] - v[@N]);"))
        }
        "context_lag" => Body {
            memory: array("$whole_lag", 1),
            needs: vec!["lag"],
            ..with(
                asked,
                "y'_m = y_m + k_m (c' - c_0),   tau dc'/dt = c - c'",
                &format!(
                    "    const double d = lag_step(time, in[{}], v[@N + 1], &m->state[0]) - v[@N];\n",
                    carrier(asked)?
                ),
                "x[j] += v[j] * d;",
            )
        },
        "context_gain" | "input_gain" => {
            let signal = carrier(asked)?;
            each(asked, "x'_j = x_j (1 + k (c - c_0))", &format!("x[j] += x[j] * v[0] * (in[{signal}] - v[1]);"))
        }
        "joint_gravity" => Body {
            needs: vec!["sin_cos_d"],
            ..with(
                asked,
                "y'_m = y_m + a_m sin s + b_m cos s",
                &format!("    double sine, cosine;\n    sin_cos_d(in[{}], &sine, &cosine);\n", carrier(asked)?),
                "x[j] += v[j] * sine + v[@N + j] * cosine;",
            )
        },
        "dahl_friction" => Body {
            memory: array("$whole_slip", 1),
            needs: vec!["bouc_wen"],
            ..with(
                asked,
                "y'_m = y_m + f_m d,   delta dd = (sgn v - d) |ds|",
                &format!("    const double d = bouc_wen_step(in[{}], v[@N], 1.0, &m->state[0]);\n", carrier(asked)?),
                "x[j] += v[j] * d;",
            )
        },
        "lugre_friction" => following(
            asked,
            "y'_m = y_m + f_m d,   delta d' = v - |v| d/g(v),   g = 1 + r exp(-(v/w)^2),   v = ds/dt",
            3,
            "lugre_step(time, d[0], v[@N], v[@N + 1], v[@N + 2], &m->state[0])",
            "lugre",
            "$whole_lag",
        )?,
        "output_hysteresis" => Body {
            memory: array("$whole_play", 1),
            needs: vec!["play"],
            ..with(
                asked,
                "y'_m = y_m + h_m (s - P_r(s)),   P_r the play of radius r",
                &format!("    const double d = in[{0}] - play_step(in[{0}], v[@N], &m->state[0]);\n", carrier(asked)?),
                "x[j] += v[j] * d;",
            )
        },
        "output_prandtl_ishlinskii" => Body {
            memory: array("$whole_play", SHARES.len()),
            needs: vec!["play"],
            ..with(
                asked,
                "y'_m = y_m + sum_i h_mi (s - P_ri(s)),   P_r the play of radius r",
                &stops(carrier(asked)?),
                &format!("for (int i = 0; i < {}; ++i) {{ x[j] += v[i * @N + j] * strain[i]; }}", SHARES.len()),
            )
        },
        "vibration_mode" => Body {
            memory: array("$whole_spring", 1),
            needs: vec!["second_order"],
            ..with(
                asked,
                "y'_m = y_m + a_m s + b_m s'/w,   s'' + 2 z w s' + w^2 s = w^2 q,   w = 2 pi/P",
                &format!(
                    "    const double unit = v[2 * @N] / 6.283185307179586;
    const double d = second_order_step(time, in[{}], unit, v[2 * @N + 1], &m->state[0]);
    const double rate = m->state[0].speed * unit;\n",
                    carrier(asked)?
                ),
                "x[j] += v[j] * d;\n        x[j] += v[@N + j] * rate;",
            )
        },
        "output_bouc_wen" => following(
            asked,
            "y'_m = y_m + f_m z,   delta dz = ds - (1 + a)/2 |ds| |z|^(n-1) z - (1 - a)/2 ds |z|^n",
            4,
            "bouc_wen_power_step(d[2], &v[@N], &m->state[0])",
            "bouc_wen_power",
            "$whole_slip",
        )?,
        "viscous_friction" => motion(asked, "y'_m = y_m + c_m ds/dt", 0, "d[0]", None)?,
        "inertia" => motion(asked, "y'_m = y_m + mu_m d^2s/dt^2", 0, "d[1]", None)?,
        "coulomb_friction" => {
            motion(asked, "y'_m = y_m + f_m tanh(ds/dt / w)", 1, "tanh_d(d[0] / v[@N])", Some("tanh_d"))?
        }
        "stribeck_friction" => motion(
            asked,
            "y'_m = y_m + s_m exp(-u^2) tanh(10 u),   u = ds/dt / w",
            1,
            "exp_d(-(d[0] / v[@N]) * (d[0] / v[@N])) * tanh_d(10.0 * d[0] / v[@N])",
            Some("tanh_d"),
        )?,
        _ => return None,
    };
    Some(body)
}
