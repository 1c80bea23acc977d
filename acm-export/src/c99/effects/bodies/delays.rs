//! Bodies of delays: linear interpolation between the two samples around the delayed time.

use super::rings::Ring;
use super::{Asked, Body};

/// Returns the longest delay in seconds.
fn longest(asked: &Asked) -> f64 {
    let value = if asked.instance.context().is_some() { asked.instance.parameters()[0].upper } else { asked.theta[0] };
    value.max(0.0)
}

/// Writes the delay of every column by `v[0]` seconds.
pub fn delay(asked: &Asked, equation: &'static str) -> Body {
    let (number, n, ring) = (asked.number, asked.columns, Ring::of_delay(longest(asked)));
    let memory = format!(
        "    int first, count, near;\n    double time[$NAME_EFFECT_{number}_ROOM];\n    double x[{n}][$NAME_EFFECT_{number}_ROOM];\n"
    );
    let code = DELAY.replace("@K", &number.to_string()).replace("@N", &n.to_string());
    Body { equation, memory, code, macros: ring.macros(asked), ring: Some(ring), ..Body::default() }
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
