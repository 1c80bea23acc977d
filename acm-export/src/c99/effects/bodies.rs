//! What each effect does to a sample, in C.

use acm_core::effects::instance::Instance;
use acm_core::effects::{Carrier, Rig};

use super::{Inputs, place};
use crate::c99::text::double;

/// The effect that is asked for.
pub struct Asked<'a> {
    pub number: usize,
    pub instance: &'a Instance,
    pub theta: &'a [f64],
    pub rig: &'a Rig,
    pub inputs: Inputs,
    /// Number of columns that it acts on: actuators, or outputs.
    pub columns: usize,
}

/// One effect in pieces.
#[derive(Default)]
pub struct Body {
    pub equation: &'static str,
    /// Members of its memory.
    pub memory: String,
    pub code: String,
    pub needs: Vec<&'static str>,
    pub macros: String,
    /// Of an effect whose memory may be full: how far back it reaches, s.
    pub room: Option<f64>,
}

/// Samples per second that a delay has room for, at least.
const FASTEST: f64 = 1000.0;

/// Weight at the tip, own weight, wash, wash near the base, side loads: columns of loads; what tendons hold follows six later.
const HELD: usize = 6;

/// None where the effect cannot be written yet.
pub fn write(asked: &Asked) -> Option<Body> {
    let body = match asked.instance.effect().name() {
        "dead_time" => delay(asked, "q'(t) = q(t - v0)"),
        "measurement_delay" => delay(asked, "y'(t) = y(t - v0)"),
        "static_gain" => each(asked, "q'_j = (1 + g_j) q_j + o_j", "x[j] += v[j] * x[j] + v[@N + j];"),
        "gain_drift" => since_start(asked, "q' = q (1 + k (t - t_0))", "x[j] += x[j] * v[0] * (time - m->start);"),
        "zero_drift" => since_start(asked, "q'_j = q_j + k_j (t - t_0)", "x[j] += v[j] * (time - m->start);"),
        "measurement_drift" => since_start(asked, "y'_m = y_m + v_m (t - t_0)", "x[j] += v[j] * (time - m->start);"),
        "dead_zone" => each(
            asked,
            "q'_j = q_j - min(max(q_j, -w_j), w_j)",
            "const double least = x[j] < v[j] ? x[j] : v[j];\n        x[j] -= least > -v[j] ? least : -v[j];",
        ),
        "saturation" => each(
            asked,
            "q'_j = min(max(q_j, l_j + b_j), h_j - a_j)",
            "const double upper = v[j], lower = v[@N + j], high = v[2 * @N + j], low = v[3 * @N + j];\n        \
             if (lower > 0.0 && x[j] < low + lower) {\n            x[j] = low + lower;\n        }\n        \
             if (upper > 0.0 && x[j] > high - upper) {\n            x[j] = high - upper;\n        }",
        ),
        "rate_limit" => Body {
            memory: array("$name_lag", asked.columns),
            needs: vec!["rate_limit"],
            ..each(asked, "|dq'_j/dt| <= 1/s_j", "x[j] = rate_limit_step(time, x[j], v[j], &m->state[j]);")
        },
        "backlash" => Body {
            memory: array("$name_play", asked.columns),
            needs: vec!["play"],
            ..each(asked, "q'_k = min(max(q'_(k-1), q_k - w), q_k + w)", "x[j] = play_step(x[j], v[j], &m->state[j]);")
        },
        "actuator_lag" | "measurement_lag" => Body {
            memory: array("$name_lag", asked.columns),
            needs: vec!["lag"],
            ..each(asked, "tau dx'/dt = x - x'", "x[j] = lag_step(time, x[j], v[0], &m->state[j]);")
        },
        "creep" => Body {
            memory: array("$name_lag", asked.columns),
            needs: vec!["lag"],
            ..each(
                asked,
                "q' = q + c (L[q] - q),   tau dL/dt = q - L",
                "const double late = lag_step(time, x[j], v[1], &m->state[j]);\n        x[j] += v[0] * (late - x[j]);",
            )
        },
        "second_order_lag" | "measurement_second_order" => Body {
            memory: array("$name_spring", asked.columns),
            needs: vec!["second_order"],
            ..each(
                asked,
                "x'' + 2 z w x' + w^2 x = w^2 x_in,   w = 2 pi/P",
                "x[j] = second_order_step(time, x[j], v[0] / 6.283185307179586, v[1], &m->state[j]);",
            )
        },
        "viscous_slip" => Body {
            memory: array("$name_slope", asked.columns),
            needs: vec!["slope"],
            ..each(asked, "q'_j = q_j - c_j dq_j/dt", "x[j] -= v[j] * slope_step(time, x[j], &m->state[j]);")
        },
        "nonlinear_stiffness" => ranged(
            asked,
            4,
            "z'' + 2 d w z' + w^2 (z + k (z - c)^3) = w^2 x,   x = (q - m)/h,   q' = m + h z",
            "stiff_lag_step(time, z, v[0] / 6.283185307179586, v[1], v[2], v[3], &m->state[@J]) - z",
            Some(("$name_spring", "stiff_lag")),
        ),
        "state_dependent_lag" => ranged(
            asked,
            2,
            "tau (1 + b z) dq'/dt = q - q',   z = (q' - m)/h within -1 and 1",
            "bent_lag_step(time, z, v[0], v[1], &m->state[@J]) - z",
            Some(("$name_lag", "bent_lag")),
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
            memory: array("$name_lag", 1),
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
        "context_term" => {
            let signal = carrier(asked)?;
            each(asked, "y'_m = y_m + k_m (c - c_0)", &format!("x[j] += v[j] * (in[{signal}] - v[@N]);"))
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
            memory: array("$name_slip", 1),
            needs: vec!["bouc_wen"],
            ..with(
                asked,
                "y'_m = y_m + f_m d,   delta dd = (sgn v - d) |ds|",
                &format!("    const double d = bouc_wen_step(in[{}], v[@N], 1.0, &m->state[0]);\n", carrier(asked)?),
                "x[j] += v[j] * d;",
            )
        },
        "output_hysteresis" => Body {
            memory: array("$name_play", 1),
            needs: vec!["play"],
            ..with(
                asked,
                "y'_m = y_m + h_m (s - P_r(s)),   P_r the play of radius r",
                &format!("    const double d = in[{0}] - play_step(in[{0}], v[@N], &m->state[0]);\n", carrier(asked)?),
                "x[j] += v[j] * d;",
            )
        },
        _ => return None,
    };
    Some(body)
}

fn carrier(asked: &Asked) -> Option<usize> {
    place(asked.instance.carrier(), asked.inputs)
}

fn array(kind: &str, count: usize) -> String {
    format!("    {kind} state[{count}];\n")
}

fn plain_body(equation: &'static str, code: String) -> Body {
    Body { equation, code, ..Body::default() }
}

/// A line for every column j; `@N` is their number.
fn each(asked: &Asked, equation: &'static str, line: &str) -> Body {
    with(asked, equation, "", line)
}

fn with(asked: &Asked, equation: &'static str, before: &str, line: &str) -> Body {
    let text = format!("{before}    for (int j = 0; j < @N; ++j) {{\n        {line}\n    }}\n");
    plain_body(equation, text.replace("@N", &asked.columns.to_string()))
}

/// The same with the time of the first sample in `m->start`.
fn since_start(asked: &Asked, equation: &'static str, line: &str) -> Body {
    let before = "    if (!m->started) {\n        m->started = 1;\n        m->start = time;\n    }\n";
    Body { memory: "    int started;\n    double start;\n".into(), ..with(asked, equation, before, line) }
}

/// Actuators that move, by z = (x − m)/h with the middle m and the half width h of each one's range.
fn ranged(
    asked: &Asked,
    own: usize,
    equation: &'static str,
    change: &str,
    state: Option<(&'static str, &'static str)>,
) -> Body {
    let mut code = String::new();
    for j in 0..asked.columns {
        let (high, low) = (asked.theta[own + j], asked.theta[own + asked.columns + j]);
        let (middle, half) = (0.5 * (high + low), 0.5 * (high - low));
        // An actuator at rest has no range, and no memory of it is needed.
        if 2.0 * half <= 1e-9 * (middle.abs() + half) {
            continue;
        }
        let clamp = if change.contains('e') && state.is_none() {
            "        const double e = z < -1.0 ? -1.0 : (z > 1.0 ? 1.0 : z);\n"
        } else {
            ""
        };
        code += &format!(
            "    {{\n        const double z = (x[{j}] - {}) / {};\n{clamp}        x[{j}] += {} * ({});\n    }}\n",
            literal(middle),
            double(half),
            double(half),
            change.replace("@J", &j.to_string()).replace("@N", &asked.columns.to_string())
        );
    }
    let memory = state.map_or(String::new(), |(kind, _)| array(kind, asked.columns));
    Body { memory, needs: state.into_iter().map(|(_, need)| need).collect(), ..plain_body(equation, code) }
}

/// A number that may be negative, where an operator stands before it.
fn literal(value: f64) -> String {
    if value < 0.0 { format!("({})", double(value)) } else { double(value) }
}

/// What a length that all actuators share is multiplied with for actuator `j`.
fn unit(asked: &Asked, own: usize, j: usize) -> f64 {
    if asked.instance.own_parameters() > own { asked.theta[own + j] } else { 1.0 }
}

fn slipping(asked: &Asked, shapes: usize, equation: &'static str, size: &str) -> Body {
    let n = asked.columns;
    let line = |j: usize| {
        let width = format!("{} * v[{n}]", double(unit(asked, n + shapes, j)));
        let size = size.replace("@J", &j.to_string()).replace("@W", &width).replace("@N + 1", &(n + 1).to_string());
        format!("    x[{j}] -= {size};\n")
    };
    let code = (0..n).map(line).collect();
    Body { memory: array("$name_slip", n), needs: vec!["bouc_wen"], ..plain_body(equation, code) }
}

fn prandtl_ishlinskii(asked: &Asked) -> Body {
    const SHARES: [f64; 3] = [0.15, 0.4, 1.0];
    let mut code = String::from("    double before;\n");
    for j in 0..asked.columns {
        code += &format!("    before = x[{j}];\n");
        for (i, share) in SHARES.iter().enumerate() {
            let radius = format!("v[3] * {} * {}", double(unit(asked, 4, j)), double(*share));
            code +=
                &format!("    x[{j}] += v[{i}] * (play_step(before, {radius}, &m->state[{}]) - before);\n", 3 * j + i);
        }
    }
    let memory = array("$name_play", 3 * asked.columns);
    Body {
        memory,
        needs: vec!["play"],
        ..plain_body("q' = q + sum_i w_i (P_(r_i)[q] - q),   P_r the play of half-width r", code)
    }
}

fn coupling(asked: &Asked) -> Body {
    let n = asked.columns;
    let takes = |i: &usize| {
        matches!(asked.instance.carrier(), Carrier::Rig) || asked.instance.carrier() == Carrier::Actuator(*i)
    };
    let pairs = (0..n).filter(takes).flat_map(|i| (0..n).filter(move |&j| j != i).map(move |j| (i, j)));
    let mut code = format!("    double before[{n}];\n    memcpy(before, x, sizeof before);\n");
    code.extend(pairs.enumerate().map(|(k, (i, j))| format!("    x[{i}] += v[{k}] * before[{j}];\n")));
    plain_body("q'_i = q_i + sum_(j != i) c_ij q_j", code)
}

fn periodic(asked: &Asked) -> Option<Body> {
    let j = carrier(asked)?;
    let code = format!(
        "    double sine, cosine;\n    sin_cos_d(6.283185307179586 * v[2] * x[{j}], &sine, &cosine);\n    \
         x[{j}] += v[0] * sine + v[1] * cosine;\n"
    );
    Some(Body { needs: vec!["sin_cos_d"], ..plain_body("q'_j = q_j + a sin(2 pi N q_j) + b cos(2 pi N q_j)", code) })
}

/// Adds `size` to one load, and minus its share `held` to what tendons hold of it.
fn load(column: usize, size: &str, held: &str) -> String {
    format!("    x[{column}] += {size};\n    x[{}] -= {held} * ({size});\n", column + HELD)
}

fn jet(drag: &str, decay: &str, held: &str) -> String {
    let loads = load(2, &format!("drag * (1.0 - {decay})"), held) + &load(3, &format!("drag * {decay}"), held);
    format!("    const double drag = {drag};\n{loads}")
}

fn ground_effect(asked: &Asked) -> Option<Body> {
    let altitude = carrier(asked)?;
    let throttle = asked.inputs.actuators + asked.theta[4] as usize;
    let code = format!(
        "    const double height = in[{altitude}] > 0.0 ? in[{altitude}] : 0.0;\n{}",
        jet(&format!("v[0] * in[{throttle}] * exp_d(-height / v[1])"), "v[2]", "v[3]")
    );
    let equation = "g = b u exp(-max(h, 0)/h_0), wash = g (1 - d), near = g d, held = -c of them";
    Some(Body { needs: vec!["exp_d"], ..plain_body(equation, code) })
}

/// Every marker turned by the rotation vector `turn`, then moved by `shift` of each axis i.
fn turned(asked: &Asked, equation: &'static str, before: &str, turn: &str, shift: &str) -> Body {
    let code = format!(
        "{before}    const vector turn = {turn};\n    for (int j = 0; j + 2 < {}; j += 3) {{\n        \
         const vector p = rotate(turn, vector_of(x[j], x[j + 1], x[j + 2]));\n        \
         x[j] = p.x{};\n        x[j + 1] = p.y{};\n        x[j + 2] = p.z{};\n    }}\n",
        asked.columns,
        add(shift, 0),
        add(shift, 1),
        add(shift, 2)
    );
    plain_body(equation, code)
}

fn add(shift: &str, axis: usize) -> String {
    if shift.is_empty() { String::new() } else { format!(" + {}", shift.replace("3 + i", &(3 + axis).to_string())) }
}

fn base_tilt(asked: &Asked) -> Body {
    let first = asked.inputs.actuators + asked.inputs.contexts;
    let before = format!(
        "    const vector down = vector_of(v[1], v[2], v[3]);\n    \
         const vector lean = cross(down, vector_of(in[{}], in[{}], in[{}]));\n    const double k = -v[0] / 9.80665;\n",
        first,
        first + 1,
        first + 2
    );
    Body {
        needs: vec!["rotate"],
        ..turned(
            asked,
            "p' = exp(w) p,   w = -(k/g) (d x a)",
            &before,
            "vector_of(k * lean.x, k * lean.y, k * lean.z)",
            "",
        )
    }
}

/// Seconds that a delay may reach back.
fn longest(asked: &Asked) -> f64 {
    let value = if asked.instance.context().is_some() { asked.instance.parameters()[0].upper } else { asked.theta[0] };
    value.max(0.0)
}

fn delay(asked: &Asked, equation: &'static str) -> Body {
    let (number, n, longest) = (asked.number, asked.columns, longest(asked));
    let rate = FASTEST.max(4.0 / asked.rig.step.max(1e-6));
    let room = 8 + (rate * longest.min(60.0)).ceil() as usize;
    let macros = format!(
        "\n/* Samples that effect {number} has room for: those of {longest} s. A sample that finds no room is refused ($NAME_ROOM). */\n\
         #ifndef $NAME_EFFECT_{number}_ROOM\n#define $NAME_EFFECT_{number}_ROOM {room}\n#endif\n"
    );
    let memory = format!(
        "    int first, count, near;\n    double time[$NAME_EFFECT_{number}_ROOM];\n    double x[{n}][$NAME_EFFECT_{number}_ROOM];\n"
    );
    let code = DELAY.replace("@K", &number.to_string()).replace("@N", &n.to_string());
    Body { equation, memory, code, needs: vec![], macros, room: Some(longest) }
}

const DELAY: &str = "\
    const double then = time - v[0];
    const int newest = effect_@K_at(m, m->count);
    int k = m->near;
    m->time[newest] = time;
    for (int j = 0; j < @N; ++j) {
        m->x[j][newest] = x[j];
    }
    m->count += 1;
    while (k > 0 && m->time[effect_@K_at(m, k)] > then) {
        --k;
    }
    while (k + 2 < m->count && m->time[effect_@K_at(m, k + 1)] <= then) {
        ++k;
    }
    m->near = k;
    if (then < time) {
        const int a = effect_@K_at(m, k), b = effect_@K_at(m, k + 1);
        const double rests = m->count == 1 || then <= m->time[a] ? 0.0 : (then - m->time[a]) / (m->time[b] - m->time[a]);
        for (int j = 0; j < @N; ++j) {
            x[j] = rests > 0.0 ? m->x[j][a] + rests * (m->x[j][b] - m->x[j][a]) : m->x[j][a];
        }
    }
";

/// Functions of a ring of samples, with room for the next.
pub fn room(number: usize) -> String {
    ROOM.replace("@K", &number.to_string())
}

const ROOM: &str = "
/* Place of the k-th oldest sample. */
static int effect_@K_at(const $name_effect_@K *m, int k)
{
    const int place = m->first + k;
    return place < $NAME_EFFECT_@K_ROOM ? place : place - $NAME_EFFECT_@K_ROOM;
}

/* Lets go of what lies more than `longest` seconds back; whether there is room for one more sample then. */
static int effect_@K_has_room(double time, $name_effect_@K *m, double longest)
{
    while (m->count > 1 && m->time[effect_@K_at(m, 1)] <= time - longest) {
        m->first = effect_@K_at(m, 1);
        m->count -= 1;
        m->near = m->near > 0 ? m->near - 1 : 0;
    }
    return m->count < $NAME_EFFECT_@K_ROOM;
}
";
